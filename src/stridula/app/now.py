"""The present motion as text: the regime of the last moments, its pitch and its level."""

from __future__ import annotations

import base64
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import Array

# Shortest and longest time that decides a regime [s], and number of periods in it.
MOMENT, LONGEST, PERIODS = 1.0, 10.0, 3.0
# Share of a second that a stroke must have lasted to be judged, and number of reports that wait for it.
LASTED, REPORTS = 0.9, 3


class Headline:
    """The motion that is named, judged over a second, or over longer if it is slower or not the same each second.

    A regime is named as soon as it is found after a change, later once it is found twice in succession. The vibration
    of the start of a stroke does not count, unless strokes are shorter than a second.
    """

    def __init__(self) -> None:
        self._begin(-1)

    def _begin(self, revision: int) -> None:
        self.window = MOMENT
        self._revision, self._last, self._waited = revision, "", 0
        self._named: dict[str, Any] = {}

    @property
    def pause(self) -> float:
        """Time until the next report [s]: longer records take longer to judge."""
        return max(MOMENT, self.window / 4.0)

    def seconds(self, steady: float) -> float:
        """Return the time to judge [s], for a setting that has not changed for a time [s]."""
        return min(self.window, max(MOMENT, steady))

    def takes(self, seconds: float, revision: int) -> bool:
        """Return whether a record of a time [s] at a revision is long enough to be judged."""
        is_long = seconds > LASTED * MOMENT
        self._waited = 0 if is_long else self._waited + 1
        return is_long or revision != self._revision or self._waited > REPORTS

    def after(self, found: dict[str, Any], revision: int) -> dict[str, Any]:
        """Return the motion to name, one that `measured` returned, after another was found at a revision."""
        if revision != self._revision:
            self._begin(revision)
        is_same = found["regime"] == self._last
        if is_same or not self._last:
            self._named = found
        else:
            self.window = min(LONGEST, 2.0 * self.window)
        if found["frequency"]:
            self.window = min(LONGEST, max(MOMENT, PERIODS / found["frequency"]))
        self._last = found["regime"]
        return self._named


def said(values: Array) -> dict[str, Any]:
    """Return an array in a form for JSON, in single precision."""
    plain = np.ascontiguousarray(values, dtype="<f4")
    return {"shape": plain.shape, "values": base64.b64encode(plain.tobytes()).decode("ascii")}


def heard(told: dict[str, Any]) -> Array:
    """Return the array encoded by `said`."""
    return np.frombuffer(base64.b64decode(told["values"]), dtype="<f4").reshape(told["shape"]).astype(float)


def measured(interval: float, contacts: Sequence[str], variables: dict[str, Any]) -> dict[str, Any]:
    """Return the regime of a record and its measures.

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
    # Its package takes a third of the time until the process of the present motion answers, and this has no sound.
    from ..acoustics.levels import REFERENCE, decibels

    mean = float(np.mean(np.square(pressure, dtype=float))) if len(pressure) else 0.0
    return float(decibels(np.asarray(mean))) if mean > REFERENCE**2 else None


def _verb(regime: str, frequency: float | None, impacts: float | None) -> str:
    pitch = "" if frequency is None else f" at {_pitch(frequency)}"
    if regime == "squeal":
        return f"squeals{pitch}"
    if regime == "stick-slip":
        return f"sticks and slips{_often(frequency)}"
    if regime == "judder":
        return "judders" + ("" if not impacts else f", {impacts:.3g} landings a second")
    return {"stable sliding": "slides steadily", "sticking": "sticks", "off the track": "has lifted off"}[regime]


def _often(frequency: float | None) -> str:
    if frequency is None:
        return ""
    return f" {frequency:.3g} times a second" if frequency >= 1.0 else f", once in {1.0 / frequency:.2g} s"


def _pitch(frequency: float) -> str:
    return f"{frequency / 1000.0:.3g} kHz" if frequency >= 1000.0 else f"{frequency:.3g} Hz"
