"""Table of sound levels, loudness, sharpness and roughness at each listener."""

from __future__ import annotations

import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..acoustics.level_words import level_columns, level_lines
from .consoles import wide_console


def print_levels(pressure: xr.DataArray) -> None:
    """Print a table of the sound at each listener, and the reasons for missing columns.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa].
    """
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    columns = level_columns(pressure)
    for number, head in enumerate(columns):
        table.add_column(escape(head), justify="right" if number else "left")
    for row in zip(*columns.values(), strict=True):
        table.add_row(*map(escape, row))
    console = wide_console()
    console.print(table)
    for line in level_lines(pressure):
        console.print(line, markup=False, highlight=False, soft_wrap=True)
