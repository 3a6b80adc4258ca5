"""Outcomes of the points of a survey as one labelled Dataset, with modes matched from point to point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from scipy.optimize import linear_sum_assignment

from ..arrays import Array
from ..checks import ArgumentError
from ..records.variables import described
from ..scenarios.varied import Varied
from .fates import FATES, LIVES
from .points import Layout
from .survey_slopes import slopes_over_modes
from .swept import coordinates
from .task import Outcome
from .tones_of_modes import MOST

# Largest ratio of the frequencies of one mode at two neighbouring points.
SAME = 1.2
# Frequency [Hz] assigned to modes that do not vibrate.
STILL = 1e-3
OF_POINTS = {
    "verdict": ("", "verdict of linear theory: stable, unstable, held, lifted off, jammed, or the step that failed"),
    "equilibrium": ("", "kind of the equilibrium"),
    "equilibria": ("", "number of equilibria in words"),
    "unstable_modes": ("1", "number of modes that grow"),
    "living_modes": ("1", "number of modes that persist in their own limit cycle"),
    "kick": ("m", "smallest displacement of a contact point in a mode from which a quiet point squeals"),
    "kicked_mode": ("Hz", "frequency of that mode by linear theory"),
    "kick_tone": ("Hz", "frequency of the strongest tone of that squeal"),
    "unstable_amplitude": ("m", "amplitude of the tips in the unstable cycle between steady sliding and that squeal"),
    "unstable_frequency": ("Hz", "frequency of the unstable cycle"),
    "message": ("", "message of a failure, empty if none"),
}
NUMBERS = {
    "frequency": ("Hz", "frequency of the mode by linear theory"),
    "growth_rate": ("1/s", "growth rate of the mode by linear theory"),
    "seen_frequency": ("Hz", "frequency of the mode during its growth in the run"),
    "seen_growth_rate": ("1/s", "growth rate of the mode in the run"),
    "amplitude": ("m", "largest initial displacement of a contact point"),
    "duration": ("s", "time simulated"),
    "reached": ("1", "whether the run left linear theory"),
    "steady": ("1", "whether the swings in the last two windows of the run are similar"),
    "joined": ("1", "mode of the strongest tone if the mode joins another"),
    "confidence": ("1", "confidence in the regime, 0.5 at a threshold"),
    "normal_force_rms": ("N", "root mean square fluctuation of the normal force, at the contact where it is largest"),
    "slip_velocity_rms": ("m/s", "root mean square fluctuation of the slip velocity of that contact"),
    "separated_share": ("1", "share of the time in which contacts are separated"),
    "sticking_share": ("1", "share of the time in which contacts stick"),
    "sliding_share": ("1", "share of the time in which contacts slide"),
    "cycle_frequency": ("Hz", "frequency of the limit cycle near the end of the run"),
    "cycle_stable": ("1", "whether that limit cycle is stable"),
    "leading_multiplier": ("1", "size of its largest Floquet multiplier"),
    "sound_level": ("dB", "sound level LAeq a metre above the track at the louder ear, re 20 µPa"),
}
OF_KICKS = ("kick", "kicked_mode", "kick_tone", "unstable_amplitude", "unstable_frequency")
WORDS = {
    "fate": f"fate of the mode: {', '.join(FATES)}",
    "regime": "regime of the contact whose normal force fluctuates most",
}
TONES = {
    "tone_frequency": ("frequency", "Hz", "frequency of a tone of the limit cycle, the strongest first"),
    "tone_level": ("level", "dB", "level of the tone below the strongest"),
    "tone_mode": ("mode", "Hz", "frequency by linear theory of the mode of the tone"),
    "tone_order": ("order", "1", "frequency of the tone over that of its fundamental tone"),
}
# Names that keys of the points must not have.
OF_SLOPES = ("d_growth_rate", "d_frequency", "parameter", "parameter_value", "parameter_units")
OWN = {*OF_POINTS, *NUMBERS, *WORDS, *TONES, *OF_SLOPES, "mode", "tone", "point"}


def check_names(layout: Layout) -> None:
    """Raise ValueError if a key has the name of a variable of a survey."""
    taken = OWN - ({"point"} if layout.is_grid else set())
    clash = next((key for key in layout.keys if key in taken), None)
    if clash is not None:
        words = "not have the name of a result of the survey"
        raise ArgumentError("key", words, clash, got=f"{clash!r}: write its full key")


def surveyed(
    layout: Layout,
    keys: Sequence[Varied],
    values: Sequence[Sequence[Any]],
    outcomes: Sequence[Outcome],
    attributes: dict[str, str],
    by: Sequence[str] = (),
) -> xr.Dataset:
    """Return the outcomes of the points as a Dataset.

    Parameters
    ----------
    layout : Layout
        Layout of the points in dimensions.
    keys : sequence of Varied
        Varied keys.
    values : sequence of sequence
        Values of the keys at each point.
    outcomes : sequence of dict
        Outcome of each point.
    attributes : dict
        Attributes of the Dataset.
    by : sequence of str, optional
        Parameters by which modes are differentiated.
    """
    shape, dimensions = tuple(layout.dimensions.values()), tuple(layout.dimensions)
    modes = [outcome["values"].get("modes", []) for outcome in outcomes]
    places = coordinates(layout, keys, values)
    names = followed(modes, neighbours(layout, places))
    count = 1 + max((max(row, default=-1) for row in names), default=-1)
    rows: list[dict[int, Mapping[str, Any]]] = []
    for row, known in zip(names, modes, strict=True):
        name_of = {mode["number"]: name for name, mode in zip(row, known, strict=True)}
        told = [mode | {"joined": name_of.get(mode["joined"])} for mode in known]
        rows.append(dict(zip(row, told, strict=True)))

    def over_modes(name: str, nothing: Any, kind: Any) -> Array:
        filled = np.full((len(rows), count), nothing, dtype=kind)
        for at, row in enumerate(rows):
            for mode, told in row.items():
                value = told.get(name)
                filled[at, mode] = nothing if value is None else value
        return filled.reshape(*shape, count)

    data: dict[str, Any] = {}
    for name, one in _of_points(outcomes).items():
        units, meaning = OF_POINTS[name]
        data[name] = (dimensions, one.reshape(shape), _described(units, meaning))
    over = (*dimensions, "mode")
    for name, (units, meaning) in NUMBERS.items():
        data[name] = (over, over_modes(name, np.nan, float), described(units, meaning))
    for name, meaning in WORDS.items():
        data[name] = (over, over_modes(name, "", object), _described("", meaning))
    for name, (word, units, meaning) in TONES.items():
        data[name] = (
            (*over, "tone"),
            _tones(rows, word, count).reshape(*shape, count, MOST),
            described(units, meaning),
        )
    at = places | {
        "mode": ("mode", np.arange(count), {"long_name": "mode, tracked from point to point"}),
        "tone": ("tone", np.arange(MOST), {"long_name": "tone, the strongest first"}),
    }
    found = xr.Dataset(data, at, attributes)
    if not by:
        return found
    points = [outcome["values"] for outcome in outcomes]
    return found.merge(slopes_over_modes(points, rows, by, layout.dimensions, count))


def _described(units: str, meaning: str) -> dict[str, str]:
    return described(units, meaning) if units else {"long_name": meaning}


def _of_points(outcomes: Sequence[Outcome]) -> dict[str, Array]:
    """Return the variables of the points."""
    known = [outcome["values"] for outcome in outcomes]
    living = [sum(mode["fate"] == LIVES for mode in one["modes"]) if "modes" in one else np.nan for one in known]
    return {
        "verdict": np.array([outcome["ended"] for outcome in outcomes], dtype=object),
        "equilibrium": np.array([one.get("equilibrium", "") for one in known], dtype=object),
        "equilibria": np.array([one.get("equilibria", "") for one in known], dtype=object),
        "unstable_modes": np.array([one.get("unstable_modes", np.nan) for one in known], dtype=float),
        "living_modes": np.array(living, dtype=float),
        **{name: np.array([one.get(name, np.nan) for one in known], dtype=float) for name in OF_KICKS},
        "message": np.array([outcome["message"] for outcome in outcomes], dtype=object),
    }


def _tones(rows: Sequence[Mapping[int, Mapping[str, Any]]], word: str, count: int) -> Array:
    filled = np.full((len(rows), count, MOST), np.nan)
    for at, row in enumerate(rows):
        for mode, told in row.items():
            for number, tone in enumerate(told["tones"]):
                filled[at, mode, number] = np.nan if tone[word] is None else tone[word]
    return filled


def neighbours(layout: Layout, places: Mapping[str, Any]) -> list[list[int]]:
    """Return the earlier neighbours of each point: in a grid one step back on each axis, else the nearest point.

    Parameters
    ----------
    layout : Layout
        The points.
    places : mapping
        Their coordinates: dimension, values and attributes by key.
    """
    if layout.is_grid:
        numbers = np.arange(len(layout.values)).reshape(tuple(layout.dimensions.values()))
        found: list[list[int]] = [[] for _ in layout.values]
        for axis in range(numbers.ndim):
            ahead, behind = np.moveaxis(numbers, axis, 0)[1:], np.moveaxis(numbers, axis, 0)[:-1]
            for one, other in zip(ahead.ravel().tolist(), behind.ravel().tolist(), strict=True):
                found[one].append(other)
        return found
    columns = []
    for key in layout.keys:
        values = places[key][1]
        if values.dtype.kind in "fiu" and np.ptp(values) > 0.0:
            columns.append((values - values.min()) / np.ptp(values))
    if not columns:
        return [[at - 1] if at else [] for at in range(len(layout.values))]
    at = np.stack(columns, axis=1)
    return [[int(np.linalg.norm(at[:k] - at[k], axis=1).argmin())] if k else [] for k in range(len(at))]


def followed(modes: Sequence[Sequence[Mapping[str, Any]]], before: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the name of each mode of each point: the same for modes of about the same frequency at neighbours.

    Names are numbers, by increasing frequency at the first point of each mode.

    Parameters
    ----------
    modes : sequence of sequence of mapping
        Modes of each point, with their frequencies [Hz].
    before : sequence of sequence of int
        Earlier neighbours of each point.
    """
    heights = [np.log([max(mode["frequency"], STILL) for mode in point]) for point in modes]
    names: list[list[int]] = []
    last_seen: dict[int, float] = {}
    for heard, near in zip(heights, before, strict=True):
        # A mode that a neighbour lacks is compared with that of the last point that had it.
        known = last_seen | {name: f for at in near for name, f in zip(names[at], heights[at], strict=True)}
        labels, row = list(known), [-1] * len(heard)
        if labels and len(heard):
            away = np.abs(np.array([known[name] for name in labels])[:, None] - heard[None, :])
            far = np.log(SAME)
            for one, other in zip(*linear_sum_assignment(np.minimum(away, 10.0 * far)), strict=True):
                if away[one, other] <= far:
                    row[other] = labels[one]
        for number, name in enumerate(row):
            row[number] = name if name >= 0 else len(last_seen)
            last_seen[row[number]] = float(heard[number])
        names.append(row)
    order = sorted(last_seen, key=lambda name: _first(name, names, heights))
    return [[order.index(name) for name in row] for row in names]


def _first(name: int, names: Sequence[Sequence[int]], heights: Sequence[Any]) -> float:
    """Return the logarithm of the frequency of a mode at its first point."""
    return next(float(height[row.index(name)]) for row, height in zip(names, heights, strict=True) if name in row)
