"""`stridula stability --by`: effects of parameters on the mode of sliding that grows fastest."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..analysis.mode_effects import effect_columns, effects_title
from ..records.files import save as save_file
from ..studies.mode_derivatives import mode_sensitivity
from .consoles import wide_console
from .outputs import check_outputs, check_record

# Word that stands for every parameter.
ALL = "all"


def print_effects(
    name: str, keys: Sequence[str], overrides: dict[str, Any], out: str | None, plot: str | None, **options: Any
) -> None:
    """Print what each parameter does to the mode that grows fastest, and optionally draw or write all modes."""
    check_outputs(out, plot)
    check_record(out)
    asked, shown = None if ALL in keys else list(keys), sys.stderr.isatty()
    found = mode_sensitivity(name, asked, overrides=overrides, progress=shown, **options)
    console = wide_console()
    console.print(_table(found))
    for words in filter(None, str(found.attrs["left_out"]).split("; ")):
        console.print(escape(f"Left out: {words}"), highlight=False)
    if out is not None:
        save_file(found, out)
    if plot is not None:
        from ..plot import mode_sensitivity as draw
        from ..plot import save

        save(draw(found), plot)


def _table(found: xr.Dataset) -> Table:
    table = Table(title=escape(effects_title(found)), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    columns = effect_columns(found)
    for number, head in enumerate(columns):
        table.add_column(head, justify="right" if number else "left", overflow="fold")
    for cells in zip(*columns.values(), strict=True):
        table.add_row(*map(escape, cells))
    return table
