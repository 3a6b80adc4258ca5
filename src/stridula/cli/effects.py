"""`stridula stability --by`: effects of parameters on the mode of sliding that grows fastest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..analysis.mode_effects import mode_of, what_helps
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
    found = mode_sensitivity(name, None if ALL in keys else list(keys), overrides=overrides, **options)
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
    one, effects = mode_of(found, None), what_helps(found)
    frequency, growth = float(one["frequency"]), float(one["growth_rate"])
    kind = str(one["kind"].item())
    words = "" if kind == "alone" else f", {kind}"
    title = f"mode at {frequency:.5g} Hz, growth {growth:.5g} 1/s{words}; {100.0 * found.attrs['change']:g} % more:"
    table = Table(title=escape(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("parameter", overflow="fold")
    for head in ("value", "growth rate [1/s]", "frequency [Hz]", "for less growth"):
        table.add_column(head, justify="right", overflow="fold")
    for number in range(effects.sizes["parameter"]):
        row = effects.isel(parameter=number)
        units = str(row["units"].item())
        value = f"{float(row['value']):.5g} {'' if units == '1' else units}".rstrip()
        changes = [float(row[word]) for word in ("growth_rate_change", "frequency_change")]
        cells = [f"{change:+.4g}" if np.isfinite(change) else "" for change in changes]
        table.add_row(escape(str(row["parameter"].item())), value, *cells, str(row["better"].item()))
    return table
