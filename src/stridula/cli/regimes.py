"""The table of regimes against what linear theory says."""

from __future__ import annotations

import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..studies.verdicts import agreement
from .consoles import wide_console


def print_agreement(found: xr.Dataset) -> None:
    """Print how often each regime was seen under each verdict of linear theory, and how often the two agree."""
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
    # A title of the table would be folded to its width.
    console.print("Runs by linear theory and regime")
    console.print(table)
    agree, compared, missed, false = (int(counts[word]) for word in ("agree", "compared", "missed", "false_alarms"))
    if compared:
        console.print("Vibration seen in the runs, growth by linear theory")
        console.print(_comparison(compared, agree, missed, false))


def _comparison(compared: int, agree: int, missed: int, false: int) -> Table:
    """Return how many runs vibrate as linear theory says, and how many do not."""
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
