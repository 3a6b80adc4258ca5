"""The wall of a glass that sings at a wanted pitch: by linear theory, and then played."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ..checks import ArgumentError
from ..records.by_surface import groups
from ..scenarios.keys import overridden
from ..scenarios.load import scenario_of_tables
from ..scenarios.outline import look_up
from . import now
from .instrument import RATE, Instrument
from .playable import Playable

# Ends of the factor on the thickness of the wall, between which the fastest growing mode stays the same.
THINNEST, THICKEST = 0.65, 1.6
# A mode belongs to the one at another thickness if its frequency is as expected to this factor.
FOLLOWED = 1.15
# Largest logarithm of the factor between two trials, so that modes can be followed.
STRIDE = 0.2
# Error at which the search ends, relative to the frequency, and largest number of trials.
CLOSE, TRIALS = 5e-4, 12
# Factors on the forces with which the result is played in turn, since a thin wall under a large force sings otherwise;
# time played [s], and greatest error of its pitch, relative to it.
PRESSED, PLAYED, TRUE = (1.0, 0.5, 0.3), 3.0, 0.01


def walls_of(tables: dict[str, Any]) -> dict[str, float]:
    """Return the thickness of the wall of the only body with a line as its profile, in SI by key, else nothing.

    Places where the line is a solid stem, as thick as its diameter, are no wall.

    Parameters
    ----------
    tables : dict
        Complete tables of a scenario.
    """
    found = [
        {
            f"bodies.{name}.profile.thickness.{number}": float(one)
            for number, (one, (radius, _)) in enumerate(zip(profile["thickness"], profile["points"], strict=True))
            if one < 2.0 * radius
        }
        for name, body in (tables.get("bodies") or {}).items()
        if (profile := look_up(body, ("profile",))) and isinstance(profile.get("thickness"), list)
    ]
    return found[0] if len(found) == 1 else {}


def fitted(tables: dict[str, Any], frequency: float, above: float = 1.0) -> dict[str, Any]:
    """Return the values with which a system sings at a frequency.

    Parameters
    ----------
    tables : dict
        Complete tables of a scenario.
    frequency : float
        Wanted frequency [Hz].
    above : float, optional
        Frequency of the motion that plays over that of linear theory.

    Returns
    -------
    dict
        ``overrides``, the thicknesses [m] and forces [N] by key, empty without a result, and ``words``.
    """
    walls, forces = walls_of(tables), _forces_of(tables)

    def growing(factor: float) -> list[tuple[float, float]]:
        return _growing(overridden(tables, _times(factor, walls))[0])

    try:
        factor, _ = _searched(growing, frequency / above)
    except ArgumentError as error:
        return {"overrides": {}, "words": f"{error}."}
    wall = f"A wall {factor:.2f} times as thick"
    sung = None
    for press in PRESSED:
        overrides = _times(factor, walls) | (_times(press, forces) if press != 1.0 else {})
        sung = _sung(overridden(tables, overrides)[0])
        if sung is not None and abs(sung / frequency - 1.0) < TRUE:
            pressed = "" if press == 1.0 else f", pressed with {press:g} times the force,"
            return {"overrides": overrides, "words": f"{wall}{pressed} sings at {sung:.0f} Hz."}
    told = "does not squeal" if sung is None else f"squeals at {sung:.0f} Hz"
    return {"overrides": {}, "words": f"{wall} has this pitch by linear theory, but played it {told}."}


def _forces_of(tables: dict[str, Any]) -> dict[str, float]:
    """Return the components of the forces that drive a system [N] by key."""
    drives = tables.get("drives") or []
    return {
        f"drives.{number}.{axis}": float(drive[axis])
        for number, drive in enumerate(drives)
        for axis in "xyz"
        if drive.get("kind") == "force" and drive.get(axis)
    }


def _times(factor: float, values: dict[str, float]) -> dict[str, float]:
    return {key: float(f"{factor * one:.6g}") for key, one in values.items()}


def _sung(tables: dict[str, Any]) -> float | None:
    """Return the frequency at which a system squeals when played, as the page names it [Hz], None if it does not."""
    instrument = Instrument(Playable(scenario_of_tables(tables), tables, "", tables))
    for _ in range(round(100 * PLAYED)):
        list(instrument.play(RATE // 100))
    variables, _ = instrument.last_seconds.moment(now.MOMENT)
    system = instrument.played.system
    members = groups(system.contact_names, system.surface_names)
    names = [system.contact_names[those[0]] for those in members]
    found = now.measured(1.0 / RATE, names, {name: now.said(values) for name, values in variables.items()})
    return found["frequency"] if found["regime"] == "squeal" else None


def _growing(tables: dict[str, Any]) -> list[tuple[float, float]]:
    """Return frequency [Hz] and growth rate [1/s] of the growing modes of a scenario, the fastest first."""
    from .beside_worker import theory

    return [(one["frequency"], one["growth_rate"]) for one in theory(tables)["modes"]]


def _searched(growing: Callable[[float], list[tuple[float, float]]], wanted: float) -> tuple[float, float]:
    """Return the factor on the wall at which the fastest growing mode has a frequency [Hz], and that frequency.

    Raises
    ------
    ArgumentError
        If the frequency is out of reach, or another mode grows faster there.
    """
    known = [(0.0, math.log(_fastest(growing(1.0))))]
    goal, slope = math.log(wanted), 1.0
    for _ in range(TRIALS):
        place, level = min(known, key=lambda one: abs(one[1] - goal))
        if abs(level - goal) < CLOSE:
            return math.exp(place), math.exp(level)
        stride = min(max((goal - level) / slope, -STRIDE), STRIDE)
        step = min(max(place + stride, math.log(THINNEST)), math.log(THICKEST))
        if any(abs(step - one) < 1e-9 for one, _ in known):
            break
        found = math.log(_fastest(growing(math.exp(step)), math.exp(level + slope * (step - place))))
        known.append((step, found))
        if step != place and (found - level) / (step - place) > 0.0:
            slope = (found - level) / (step - place)
    level = min(known, key=lambda one: abs(one[1] - goal))[1]
    told = (
        f"be within reach of walls from {THINNEST} to {THICKEST} times as thick, the nearest {math.exp(level):.0f} Hz"
    )
    raise ArgumentError("pitch", told, got=f"{wanted:.0f} Hz")


def _fastest(modes: list[tuple[float, float]], expected: float | None = None) -> float:
    """Return the frequency of the mode that grows fastest, which must be near the expected one [Hz]."""
    if not modes:
        raise ArgumentError("pitch", "be that of a mode that grows", got="none: with such a wall it does not sing")
    fastest = modes[0][0]
    if expected is not None and not 1.0 / FOLLOWED < fastest / expected < FOLLOWED:
        told = f"one at {fastest:.0f} Hz, while {expected:.0f} Hz was expected"
        raise ArgumentError("pitch", "be that of the mode that grows fastest with such a wall", got=told)
    return fastest
