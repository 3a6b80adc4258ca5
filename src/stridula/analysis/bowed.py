"""Motion of a bowed string: Helmholtz motion, several slips per period, or no periodic motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import positive, within
from .regimes import LIMITS, signals_of
from .several_contacts import loads, together
from .status_changes import slips

MOTIONS = ("Helmholtz", "double slip", "multiple slip", "anomalous low", "raucous", "sticking", "sliding")
HELMHOLTZ, DOUBLE, MULTIPLE, LOW, RAUCOUS, STICKING, SLIDING = MOTIONS
# Fraction of the record that is ignored by default: the attack of a note.
ATTACK = 0.5
# Sticks and slips that last at most this number of time steps may be noise.
NOISY_STEPS = 2.0
# Successive slips that are less than this number of periods apart count as one.
SHORTEST_CYCLE = 0.25
# Largest number of slips in a repeating pattern.
LONGEST_PATTERN = 6
# Numbers of slips per period at which the count changes from less than one to one, to two, and to more.
FEW, MANY, SEVERAL = 0.75, 1.5, 2.5


@dataclass(frozen=True)
class Slips:
    """Slips of all contacts of a string together.

    Attributes
    ----------
    ends : ndarray, shape (slips,)
        End of each slip [periods].
    sticking : float
        Share of the time in which the string sticks [1].
    """

    ends: Array
    sticking: float

    @property
    def rate(self) -> float:
        """Slips per period [1], NaN for fewer than two."""
        return (self.ends.size - 1) / float(self.ends[-1] - self.ends[0]) if self.ends.size > 1 else float("nan")

    def pattern(self, steady: float) -> tuple[int, float]:
        """Return the number of slips after which the motion repeats, and its period [periods]; 0 and NaN if none."""
        for count in range(1, min(LONGEST_PATTERN, self.ends.size - 2) + 1):
            apart = self.ends[count:] - self.ends[:-count]
            if apart.std() <= steady * apart.mean():
                return count, float(apart.mean())
        return 0, float("nan")


def bowed_motion(
    run: xr.Dataset, frequency: float, *, start: float | None = None, tolerance: float = 0.1, steady: float = 0.05
) -> xr.Dataset:
    """Return the kind of motion of a bowed string, from the slips of all contacts together.

    Helmholtz motion has one slip in each period of the string and repeats every period. Two or more slips per period
    are double and multiple slip, a period of several of the string's is anomalous low, and motion that does not
    repeat is raucous (Schelleng 1973; Guettler 2002, Acustica united with Acta Acustica 88).

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate` whose contacts are all of one string.
    frequency : float
        Fundamental frequency of the string [Hz].
    start : float, optional
        Time at the beginning that is ignored [s]; half of the record if left out.
    tolerance : float, optional
        Relative difference allowed between the periods of Helmholtz motion and of the string [1].
    steady : float, optional
        Standard deviation of the periods over their mean up to which a motion is periodic [1].

    Returns
    -------
    xarray.Dataset
        Scalars: ``motion``, one of `MOTIONS`; ``slips_per_period`` of the string [1]; ``frequency`` at which the motion
        repeats [Hz], NaN if it does not; ``slip_share`` of the time [1]; ``unsteadiness``, standard deviation of
        the times between slips over their mean [1].

    Raises
    ------
    ValueError
        If the record is too short or lacks a variable, or an argument is out of its range.
    """
    positive("frequency", frequency)
    within("tolerance", tolerance, 0.0, 0.5)
    within("steady", steady, 0.0, 1.0)
    found = _slips(run, frequency, start)
    count, period = found.pattern(steady)
    distances = np.diff(found.ends)
    values: dict[str, tuple[float | str, str, str]] = {
        "motion": (_motion(found, count, period, tolerance), "1", "motion of the bowed string"),
        "slips_per_period": (found.rate, "1", "slips in a period of the string"),
        "frequency": (frequency / period, "Hz", "frequency at which the motion repeats"),
        "slip_share": (1.0 - found.sticking, "1", "share of the time in which the string slips"),
        "unsteadiness": (
            float(distances.std() / distances.mean()) if distances.size > 1 else float("nan"),
            "1",
            "deviation of the times between slips over their mean",
        ),
    }
    return xr.Dataset(
        {name: ((), value, {"units": units, "long_name": words}) for name, (value, units, words) in values.items()}
    )


def _slips(run: xr.Dataset, frequency: float, start: float | None) -> Slips:
    signals = signals_of(run)
    length = signals.interval * len(signals.share)
    left_aside = ATTACK * length if start is None else within("start", start, 0.0, length)
    first = min(round(left_aside / signals.interval), len(signals.share) - 1)
    sticking = together(signals.share[first:, :, 1], loads(signals.normal[first:], LIMITS.rare))
    period = 1.0 / (frequency * signals.interval)
    found = slips(sticking, NOISY_STEPS * signals.step / signals.interval, SHORTEST_CYCLE * period)
    caught = found[found[:, 1] < sticking.size, 1]
    return Slips(caught / period, float(sticking.mean()))


def _motion(found: Slips, count: int, period: float, tolerance: float) -> str:
    if found.ends.size < 2:
        return STICKING if found.sticking > 0.5 else SLIDING
    if not count:
        return RAUCOUS
    rate = count / period
    if count == 1 and abs(period - 1.0) <= tolerance:
        return HELMHOLTZ
    if rate >= MANY:
        return DOUBLE if rate < SEVERAL else MULTIPLE
    return LOW if rate <= FEW else RAUCOUS
