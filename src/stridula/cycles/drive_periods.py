"""The time from which the drives of a system are constant, and the period of those that vary for ever."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import lcm
from typing import Any

from ..checks import ArgumentError
from ..histories import History
from ..lowering import Assembly

# Largest numerator and denominator of the ratio of two frequencies with a common period.
LARGEST_RATIO, ROUND_OFF = 64, 1e-9


def histories_of(arrays: Assembly) -> Iterator[History]:
    """Yield the histories of all loads, imposed motions and turning bodies that act."""
    prescribed = arrays.prescribed
    yield from prescribed.histories
    if prescribed.velocity is not None:
        yield prescribed.velocity[1]
    for *_, track, moved in prescribed.contacts:
        yield from (one for one in moved if hasattr(one, "settled"))
        if track is not None:
            along = track.velocity or track.lateral_velocity or track.acceleration
            if along:
                yield track.history
            if track.normal_velocity or track.normal_acceleration:
                yield track.normal_history
    yield from (turning.history for turning in prescribed.turning)


def settled_at(arrays: Assembly) -> float:
    """Return the time [s] from which all drives that ever settle are constant."""
    return max((one.settled for one in histories_of(arrays) if one.settled is not None), default=0.0)


def drive_period(arrays: Assembly) -> float | None:
    """Return the common period [s] of the drives that never settle, None without any.

    Raises
    ------
    ValueError
        If they have none.
    """
    frequencies = sorted({_frequency(one) for one in histories_of(arrays) if one.settled is None})
    if not frequencies:
        return None
    ratios = [Fraction(one / frequencies[0]).limit_denominator(LARGEST_RATIO) for one in frequencies]
    for one, ratio in zip(frequencies, ratios, strict=True):
        if abs(float(ratio) * frequencies[0] / one - 1.0) > ROUND_OFF or ratio.numerator > LARGEST_RATIO:
            words = f"{frequencies[0]:.6g} and {one:.6g} Hz, which have none"
            raise ArgumentError("system", "have drives with a common period", got=words)
    return lcm(*(ratio.denominator for ratio in ratios)) / frequencies[0]


def _frequency(history: Any) -> float:
    return float(history.frequency)
