"""Cases of the demonstration: what is varied, from which place it is heard, and what is drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

import stridula as st

from .drawn import Drawn, of_glass, of_string

HAIRS = 5
HAIR = 1.6e-3  # Distance between strips of hair [m].
LENGTH, FUNDAMENTAL = 0.325, 196.0  # Of the string [m, Hz].


@dataclass(frozen=True)
class Axis:
    """A value that is varied.

    Attributes
    ----------
    label, unit : str
        As shown.
    values : tuple of float
        Values in this unit, in their order.
    """

    label: str
    unit: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Instrument:
    """A case of the demonstration.

    Attributes
    ----------
    name, title : str
        Name of the case, and what is shown.
    x, y : Axis
        What is varied.
    changes : callable
        Keys of the scenario with their values, from the values of both axes.
    moving : tuple of str
        Bodies whose motion is recorded.
    at_bridge : bool
        Whether the force of the first of them on its left support is recorded as well.
    part, longest, heard, loop : float
        Times [s]: runs are continued by the first until they are steady, up to the second; the third is analysed for a
        cycle; without one, a stretch of the fourth is repeated.
    highest : float
        Frequency up to which lines are kept [Hz].
    pressure : callable
        Sound pressure of a record of a system [Pa], shape (time,).
    drawn : callable
        What is drawn of a system.
    regime : callable
        Regime of a record and its pitch [Hz].
    motion : str
        Words for what moves.
    view : tuple of float
        Elevation and azimuth of the eye [degrees].
    start : tuple of int
        Numbers of the values with which the page begins.
    """

    name: str
    title: str
    x: Axis
    y: Axis
    changes: Callable[[float, float], Mapping[str, Any]]
    moving: tuple[str, ...]
    at_bridge: bool
    part: float
    longest: float
    heard: float
    loop: float
    highest: float
    pressure: Callable[[xr.Dataset, st.System], Any]
    drawn: Callable[[st.System], Drawn]
    regime: Callable[[xr.Dataset], tuple[str, float]]
    motion: str
    view: tuple[float, float]
    start: tuple[int, int]

    def scenario(self, x: float, y: float) -> st.Scenario:
        """Return the scenario of a setting."""
        return st.load_scenario(self.name, dict(self.changes(x, y)))


def glass_changes(speed: float, force: float) -> Mapping[str, Any]:
    """Speed of the rim [cm/s] and force of the finger [N]."""
    return {"bodies.glass.turning": 0.01 * speed / 0.0325, "drives.0.z": -force, "drives.1.amplitude": 5e-6}


def violin_changes(place: float, force: float) -> Mapping[str, Any]:
    """Place of the bow [lengths of the string from the bridge] and its force [N]."""
    places = place * LENGTH + HAIR * (np.arange(HAIRS) - HAIRS // 2)
    loads = {f"drives.{k}.x": force / HAIRS for k in range(HAIRS)}
    return loads | {f"contacts.{k}.track.point": float(at) for k, at in enumerate(places)}


def beside_the_glass(run: xr.Dataset, system: st.System) -> Any:
    """A metre beside the rim, where it vibrates most."""
    return st.radiate(run, system, (1.0325, 0.0, 0.17)).values[:, 0]


def above_the_violin(run: xr.Dataset, _system: st.System) -> Any:
    """A metre above a flat top of spruce, at the place of the bridge, that the string drives."""
    top = st.ModalPlate(st.Material(8e9, 430.0, 0.3), 3e-3, 0.35, 0.2, cutoff=10e3, damping=0.01, name="top")
    return st.radiate(run, st.Bridge(top.at((0.19, 0.1))), (0.19, 0.1, 1.0)).values[:, 0]


def regime_of(run: xr.Dataset) -> tuple[str, float]:
    """Return the regime of a record and its pitch."""
    found = st.regime(run, start=0.0)
    return str(found.regime.item()), float(found.frequency)


def motion_of_string(run: xr.Dataset) -> tuple[str, float]:
    """Return the kind of motion of the string in what is heard and its frequency, or that of the string."""
    lasts = run.sizes["time"] * float(run.attrs["sample_interval"])
    found = st.analysis.bowed_motion(run, FUNDAMENTAL, start=lasts - VIOLIN.heard)
    frequency = float(found.frequency)
    return str(found.motion.item()), frequency if np.isfinite(frequency) else FUNDAMENTAL


GLASS = Instrument(
    "glass",
    "Wine glass",
    Axis("Speed of the rim", "cm/s", (3.0, 5.0, 7.0, 10.0, 14.0, 20.0, 30.0)),
    Axis("Force of the finger", "N", (0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.6, 2.5)),
    glass_changes,
    ("glass",),
    False,
    2.0,
    8.0,
    0.5,
    0.125,
    4.2e3,
    beside_the_glass,
    of_glass,
    regime_of,
    "Vibration of the glass under the finger, the dot",
    (28.0, 0.0),
    (3, 5),
)
VIOLIN = Instrument(
    "violin",
    "Violin string",
    Axis("Place of the bow", "of the string", (0.07, 0.09, 0.12, 0.17)),
    Axis("Force of the bow", "N", (0.2, 0.5, 1.1, 2.0, 4.0, 8.0)),
    violin_changes,
    ("string",),
    True,
    1.0,
    1.0,
    0.25,
    0.1,
    10e3,
    above_the_violin,
    of_string,
    motion_of_string,
    "Vibration of the string under the bow, the dot",
    (0.0, 0.0),
    (2, 2),
)
INSTRUMENTS = {one.name: one for one in (GLASS, VIOLIN)}
