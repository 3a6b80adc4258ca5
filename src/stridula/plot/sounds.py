"""Common parts of figures of sounds: one signal, and the reference of its levels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..acoustics.levels import REFERENCE
from ..analysis.signals import samples
from ..arrays import Array
from ..checks import ArgumentError, instance

# Level of silence [dB] re the reference, in place of minus infinity, which has no colour.
SILENCE = -200.0


@dataclass(frozen=True)
class Reference:
    """Reference of levels.

    Attributes
    ----------
    value : float
        The reference, in the unit of the signal.
    words : str
        The unit of the levels.
    """

    value: float
    words: str

    def decibels(self, squares: Array) -> Array:
        """Return the levels of mean squares [dB], silence at -200."""
        return np.asarray(10.0 * np.log10(np.maximum(squares / self.value**2, 10.0 ** (SILENCE / 10.0))))


def reference(signal: xr.DataArray, per: str = "") -> Reference:
    """Return the reference of the levels of a signal: 20 µPa for a sound pressure, else its own unit."""
    units = str(signal.attrs.get("units", "Pa" if "listener" in signal.dims else "1"))
    if units == "Pa":
        return Reference(REFERENCE, f"dB re (20 µPa)²{per}" if per else "dB re 20 µPa")
    unit = units.replace("m/s2", "m/s²")
    return Reference(1.0, f"dB re ({unit})²{per}" if per else f"dB re 1 {unit}")


def one_signal(signal: xr.DataArray) -> tuple[Array, float]:
    """Return the samples of one signal and their interval [s].

    Raises
    ------
    ValueError
        If there are several listeners, contacts or probes.
    """
    instance("signal", signal, xr.DataArray)
    if "listener" in signal.dims and signal.sizes["listener"] > 1:
        raise ArgumentError(
            "signal",
            "be of one listener",
            signal,
            got=f"{signal.sizes['listener']}: choose one with isel(listener=...)",
        )
    return samples(signal.squeeze("listener") if "listener" in signal.dims else signal)
