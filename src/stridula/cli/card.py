"""The closing card of a run."""

from __future__ import annotations

import xarray as xr
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..analysis.record_card import facts_of
from ..system import System


def print_card(
    record: xr.Dataset, title: str, files: list[str], doubtful: list[str], system: System, level: str
) -> None:
    """Print the result of a run, its sound level (or how to compute it), and which values are doubtful."""
    table = Table(title=escape(title), show_header=False, title_justify="left")
    for name, words in facts_of(record, system, level).items():
        table.add_row(name, escape(words))
    if doubtful:
        table.add_row("doubtful", escape("\n".join(doubtful)))
    if files:
        table.add_row("written", escape("\n".join(files)))
    Console().print(table)
