"""What a sound comes to: levels, loudness, sharpness and roughness of each listener, as a table."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..acoustics.levels import equivalent_level, sound_level
from ..acoustics.pressures import positions
from ..acoustics.sensation import is_available, loudness_over_time, roughness, sharpness
from .consoles import wide_console

Measure = Callable[[xr.DataArray], xr.DataArray]
# Heads, digits after the point, and what stands below; those of the second group take MoSQITo.
LEVELS: tuple[tuple[str, int, Measure], ...] = (
    ("Leq [dB]", 1, equivalent_level),
    ("LAeq [dB]", 1, lambda pressure: equivalent_level(pressure, "A")),
    ("LAFmax [dB]", 1, lambda pressure: sound_level(pressure).max("time")),
)
SENSATIONS: tuple[tuple[str, int, Measure], ...] = (
    ("loudness N5 [sone]", 2, lambda pressure: loudness_over_time(pressure).quantile(0.95, "time")),
    ("sharpness [acum]", 2, sharpness),
    ("roughness [asper]", 2, lambda pressure: roughness(pressure).mean("time")),
)


def print_levels(pressure: xr.DataArray) -> None:
    """Print a table of what each listener hears, and why where something cannot be said.

    Levels are re 20 µPa; loudness is that exceeded in 5 % of the time (ISO 532-1), sharpness that of the whole sound
    (DIN 45692), roughness the mean over its frames (Daniel & Weber).

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa].
    """
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("listener")
    columns, reasons = [_names(pressure)], []
    for head, digits, measure in (*LEVELS, *(SENSATIONS if is_available() else ())):
        try:
            numbers = np.atleast_1d(measure(pressure).values)
        except ValueError as error:
            reasons.append(f"no {head.partition(' [')[0]}: {error}")
            continue
        table.add_column(escape(head), justify="right")
        columns.append([f"{number:.{digits}f}" if np.isfinite(number) else "-" for number in numbers])
    if not is_available():
        reasons.append("no loudness, sharpness and roughness: they take mosqito (pip install stridula[psycho])")
    for row in zip(*columns, strict=True):
        table.add_row(*row)
    console = wide_console()
    console.print(table)
    for reason in reasons:
        console.print(reason, markup=False, highlight=False)


def _names(pressure: xr.DataArray) -> list[str]:
    """Return what to call each listener: its name or number, and its place where that is known."""
    if "listener" not in pressure.dims:
        return ["1"]
    names = [str(name) for name in pressure["listener"].values]
    if "listener" not in pressure.coords:
        names = [str(number + 1) for number in range(len(names))]
    places = positions(pressure)
    if places is None:
        return names
    return [f"{name} at ({', '.join(f'{x:.4g}' for x in place)}) m" for name, place in zip(names, places, strict=True)]
