"""Table of the regimes against the verdicts of linear theory."""

from __future__ import annotations

import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..studies.verdicts import agreement
from .consoles import wide_console


def print_agreement(found: xr.Dataset) -> None:
    """Print the number of runs in each regime by verdict of linear theory, and how often the two agree."""
    counts = agreement(found)
    seen = [str(word) for word in counts["regime"].values if int(counts["runs"].sel(regime=word).sum())]
    if not seen:
        return
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("linear theory")
    for word in seen:
        table.add_column(word, justify="right")
    for verdict in counts["verdict"].values:
        row = counts["runs"].sel(verdict=verdict)
        if int(row.sum()):
            table.add_row(escape(str(verdict)), *(str(int(row.sel(regime=word))) for word in seen))
    console = wide_console()
    # A table title would be wrapped to the width of the table.
    console.print("Runs by linear theory and regime")
    console.print(table)
    agree, compared, missed, false = (int(counts[word]) for word in ("agree", "compared", "missed", "false_alarms"))
    if compared:
        console.print("Vibration seen in the runs, growth by linear theory")
        console.print(_comparison(compared, agree, missed, false))


def _comparison(compared: int, agree: int, missed: int, false: int) -> Table:
    """Return a table of the runs in which vibration agrees with linear theory or not."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    rows = {
        "runs compared": compared,
        "both agree": agree,
        "vibration, no growth": missed,
        "growth, no vibration": false,
    }
    for head in rows:
        table.add_column(head, justify="right")
    table.add_row(*map(str, rows.values()))
    return table
