"""The steady sound of a limit cycle: one period, once what its beginning caused has died away."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import Any

import numpy as np
import xarray as xr

from ..records.repeated import repeat_cycle

# Time after which the sound of a cycle is first compared from period to period [s], and longest time.
FIRST, LONGEST = 0.05, 1.6
# Difference of two periods, relative to the largest pressure, up to which a sound is steady.
STEADY = 1e-4


def steady_sound(cycle: xr.Dataset, sound_of: Callable[[xr.Dataset], xr.DataArray]) -> xr.DataArray:
    """Return one period of the sound of a limit cycle, marched on until it repeats.

    Parameters
    ----------
    cycle : xarray.Dataset
        Result of `limit_cycle`.
    sound_of : callable
        Function of a record that returns its sound.
    """
    period, steps = float(cycle["period"]), cycle.sizes["time"]
    lasts = max(FIRST, 4.0 * period)
    while True:
        sound = sound_of(repeat_cycle(cycle, ceil(lasts / period) * period))
        before, last = sound.values[-2 * steps : -steps], sound.values[-steps:]
        largest = float(np.abs(last).max())
        left = float(np.abs(last - before).max()) / largest if largest > 0.0 else 0.0
        if left <= STEADY or lasts >= LONGEST:
            break
        lasts *= 2.0
    one = sound.isel(time=slice(-steps, None))
    words: dict[str, Any] = {"period": period}
    if left > STEADY:
        note = f"after {lasts:.2g} s the sound still changes by {left:.1g} of its largest pressure in a period"
        words["notes"] = "; ".join(filter(None, [str(one.attrs.get("notes", "")), note]))
    return one.assign_coords(time=("time", cycle["time"].values, one["time"].attrs)).assign_attrs(words)
