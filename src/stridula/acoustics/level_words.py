"""Levels, loudness, sharpness and roughness at each listener in words: columns of a table, and the lines below it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..checks import at_least, at_most
from ..extras import missing
from . import levels, sensation
from .levels import equivalent_level, sound_level
from .pressures import channels, is_enough, positions
from .sensation import is_available, loudness_over_time, roughness, sharpness


class Column(NamedTuple):
    """A column of the table: heading, decimals, measure, shortest duration [s] and lowest sample rate [Hz] for it."""

    head: str
    digits: int
    measure: Callable[[xr.DataArray], xr.DataArray]
    shortest: float
    lowest_rate: float

    @property
    def name(self) -> str:
        """Name of the measure, without its unit."""
        return self.head.partition(" [")[0]

    def lacks(self, lasts: float, rate: float) -> str:
        """Return the duration or rate needed if a sound of `lasts` [s] at `rate` [Hz] is too little, else nothing."""
        words = [] if is_enough(lasts, self.shortest) else [f"{at_least(self.shortest)} s"]
        words += [] if is_enough(rate, self.lowest_rate) else [f"{at_least(self.lowest_rate / 1e3)} kHz"]
        return " and ".join(words)


LEVELS = (
    Column("Leq [dB]", 1, equivalent_level, levels.SHORTEST, 0.0),
    Column("LAeq [dB]", 1, lambda pressure: equivalent_level(pressure, "A"), levels.SHORTEST, levels.LOWEST_RATE),
    Column("LAFmax [dB]", 1, lambda pressure: sound_level(pressure).max("time"), levels.SHORTEST, levels.LOWEST_RATE),
)
# These need MoSQITo.
SENSATIONS = (
    Column(
        "loudness N5 [sone]",
        2,
        lambda pressure: loudness_over_time(pressure).quantile(0.95, "time"),
        sensation.SHORTEST_VARYING,
        sensation.LOWEST_RATE,
    ),
    Column("sharpness [acum]", 2, sharpness, sensation.SHORTEST_STEADY, sensation.LOWEST_RATE),
    Column(
        "roughness [asper]",
        2,
        lambda pressure: roughness(pressure).mean("time"),
        sensation.FRAME,
        sensation.LOWEST_RATE,
    ),
)


def loudest(pressure: xr.DataArray) -> str:
    """Return the levels at the loudest listener as text; empty if the sound is too short or too coarse for them."""
    values, rate = channels(pressure)
    known = [column for column in LEVELS if not column.lacks(len(values) / rate, rate)]
    levels = [(column, float(column.measure(pressure).max())) for column in known]
    words = [f"{column.name} {level:.{column.digits}f} dB" for column, level in levels if np.isfinite(level)]
    return f"at the louder ear: {', '.join(words)}" if words else ""


def level_columns(pressure: xr.DataArray) -> dict[str, list[str]]:
    """Return the columns of a table with a row for each listener, by their headings.

    Levels are re 20 µPa; loudness is the value exceeded 5 % of the time (ISO 532-1), sharpness that of the whole sound
    (DIN 45692), roughness the mean over its frames (Daniel & Weber).

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa].
    """
    lasts, rate = _size(pressure)
    columns = {"listener": _names(pressure)}
    for column in _measures():
        if not column.lacks(lasts, rate):
            numbers = np.atleast_1d(column.measure(pressure).values)
            columns[column.head] = [f"{one:.{column.digits}f}" if np.isfinite(one) else "-" for one in numbers]
    return columns


def level_lines(pressure: xr.DataArray) -> list[str]:
    """Return the reasons for missing columns, and the limit of the band if it is below the audible range."""
    lasts, rate = _size(pressure)
    left_out = [column for column in _measures() if column.lacks(lasts, rate)]
    lines = []
    reach = equivalent_level(pressure).attrs.get("bandwidth") if len(left_out) < len(_measures()) else None
    if reach is not None:
        lines.append(f"the levels are of sound up to {at_most(reach / 1e3, 4)} kHz")
    if left_out:
        lines.append(_too_little(left_out, lasts, rate))
    return lines if is_available() else [*lines, str(missing("mosqito"))]


def _measures() -> tuple[Column, ...]:
    return (*LEVELS, *(SENSATIONS if is_available() else ()))


def _size(pressure: xr.DataArray) -> tuple[float, float]:
    """Return the duration [s] and the sample rate [Hz] of a sound."""
    values, rate = channels(pressure)
    return len(values) / rate, rate


def _too_little(left_out: Sequence[Column], lasts: float, rate: float) -> str:
    """Return in one line which measures a sound is too short or too coarse for, and the least they need."""
    parts = []
    for lacks, alike in groupby(left_out, lambda column: column.lacks(lasts, rate)):
        *names, last = (column.name for column in alike)
        parts.append(f"{', '.join(names) + ' and ' if names else ''}{last} (at least {lacks})")
    return f"{at_most(lasts, 3)} s of sound at {at_most(rate / 1e3, 4)} kHz are too little for {', '.join(parts)}"


def _names(pressure: xr.DataArray) -> list[str]:
    """Return a label for each listener: its name or number, and its position if known."""
    if "listener" not in pressure.dims:
        return ["1"]
    names = [str(name) for name in pressure["listener"].values]
    if "listener" not in pressure.coords:
        names = [str(number + 1) for number in range(len(names))]
    places = positions(pressure)
    if places is None:
        return names
    return [f"{name} at ({', '.join(f'{x:.4g}' for x in place)}) m" for name, place in zip(names, places, strict=True)]
