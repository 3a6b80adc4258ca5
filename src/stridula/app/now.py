"""The present motion as text: the regime of the last second, its pitch and its level."""

from __future__ import annotations

import base64
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..acoustics.levels import REFERENCE, decibels
from ..arrays import Array

# Frequency above which a tone is described as a squeal [Hz].
SHRILL = 1000.0


def said(values: Array) -> dict[str, Any]:
    """Return an array in a form for JSON, in single precision."""
    plain = np.ascontiguousarray(values, dtype="<f4")
    return {"shape": plain.shape, "values": base64.b64encode(plain.tobytes()).decode("ascii")}


def heard(told: dict[str, Any]) -> Array:
    """Return the array encoded by `said`."""
    return np.frombuffer(base64.b64decode(told["values"]), dtype="<f4").reshape(told["shape"]).astype(float)


def measured(interval: float, contacts: Sequence[str], variables: dict[str, Any]) -> dict[str, Any]:
    """Return the regime of the last second and its measures.

    Parameters
    ----------
    interval : float
        Interval of the samples [s].
    contacts : sequence of str
        Names of the contacts.
    variables : dict
        Variables of a record by name, over time, and over contacts if there are several, encoded by `said`.

    Returns
    -------
    dict
        ``regime``, and ``frequency`` [Hz] and ``impact_rate`` [1/s], None if unknown.
    """
    from ..analysis import regime_of
    from ..records.plain import PlainRecord

    held = {name: heard(told) for name, told in variables.items()}
    time = interval * np.arange(1, len(held["normal_force"]) + 1)
    found = regime_of(PlainRecord(time, held, contacts, {}), start=0.0)
    numbers = {name: float(found[name]) for name in ("frequency", "impact_rate")}
    return {"regime": found["regime"]} | {name: one if math.isfinite(one) else None for name, one in numbers.items()}


def words(found: dict[str, Any], level: float | None) -> str:
    """Return the present motion in one line.

    Parameters
    ----------
    found : dict
        Result of `measured`.
    level : float or None
        Level of the sound pressure [dB], None if there is none.
    """
    told = _verb(found["regime"], found["frequency"], found["impact_rate"])
    return told if level is None else f"{told}, {level:.0f} dB"


def level_of(pressure: Array) -> float | None:
    """Return the level of a sound pressure [dB], None for silence."""
    mean = float(np.mean(np.square(pressure, dtype=float))) if len(pressure) else 0.0
    return float(decibels(np.asarray(mean))) if mean > REFERENCE**2 else None


def _verb(regime: str, frequency: float | None, impacts: float | None) -> str:
    pitch = "" if frequency is None else f" at {_pitch(frequency)}"
    if regime == "squeal":
        return f"{'squeals' if frequency is None or frequency >= SHRILL else 'sounds'}{pitch}"
    if regime == "stick-slip":
        return "sticks and slips" + ("" if frequency is None else f" {frequency:.3g} times a second")
    if regime == "judder":
        return "judders" + ("" if not impacts else f", {impacts:.3g} landings a second")
    return {"stable sliding": "slides steadily", "sticking": "sticks", "off the track": "has lifted off"}[regime]


def _pitch(frequency: float) -> str:
    return f"{frequency / 1000.0:.3g} kHz" if frequency >= 1000.0 else f"{frequency:.3g} Hz"
