"""Kicks that start a squeal where no mode grows: the smallest amplitude of a mode, and the unstable cycle behind it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..drives import InitialEquilibrium
from ..records import Displacement
from .cycle_ends import cycle_after
from .fates import BENT, SETTLING, Runs, last, length_of, liveliest_signal
from .swings import relative, swing
from .tones_of_modes import tones_of

# First and largest kick over the reach of the mode; factor from one to the next.
FIRST, LARGEST, FACTOR = 0.25, 8.0, 2.0
# Relative accuracy of the smallest kick.
ACCURACY = 0.01
# Ratio of the swings in two successive windows up to which a squeal is steady.
STEADY = 1.02
# The same, if a run has reached its longest time, from which its motion counts as dying.
FADING = 1.25
# Difference of the runs on both sides of the smallest kick, relative to their swing, up to which both are near the
# unstable cycle; fewest periods that they take to get there.
NEAR, FEWEST = 0.1, 3.0


def smallest_kick(runs: Runs, number: int, reach: float) -> dict[str, Any]:
    """Return the smallest kick that starts a squeal by names of variables of a survey, nothing if none was found.

    Parameters
    ----------
    runs : Runs
        Runs of a point where no mode grows.
    number : int
        Number of a decaying mode.
    reach : float
        Amplitude up to which linear theory holds [m].
    """
    return _Kicks(runs, number, reach).smallest()


@dataclass(frozen=True)
class _Kicks:
    """Runs from equilibrium that begin with a decaying mode of some amplitude.

    Attributes
    ----------
    runs : Runs
        Runs of the point.
    number : int
        Number of the mode.
    reach : float
        Amplitude up to which linear theory holds [m].
    """

    runs: Runs
    number: int
    reach: float

    def smallest(self) -> dict[str, Any]:
        """Return the smallest kick that starts a squeal, its tone, and the unstable cycle."""
        low, high, squeal = 0.0, FIRST * self.reach, None
        while squeal is None and high <= LARGEST * self.reach:
            squeal = self._squeal(high)
            low, high = (low, high) if squeal is not None else (high, FACTOR * high)
        if squeal is None:
            return {}
        least = self.runs.options.amplitude * self.reach
        while high > max((1.0 + ACCURACY) * low, least):
            middle = float(np.sqrt(low * high)) if low > 0.0 else high / FACTOR
            found = self._squeal(middle)
            low, high, squeal = (middle, high, squeal) if found is None else (low, middle, found)
        told: dict[str, Any] = {"kick": high, "kicked_mode": 1.0 / self.period, "kick_tone": self._tone(squeal)}
        return told | (self._unstable(low, high) if low > 0.0 else {})

    @property
    def exponent(self) -> complex:
        """Exponent of the mode [1/s]."""
        return complex(self.runs.rest.exponents[self.number])

    @property
    def period(self) -> float:
        """Period of the mode [s]."""
        return 2.0 * np.pi / self.exponent.imag

    @property
    def slowest(self) -> float:
        """Growth rate of the mode that decays most slowly [1/s]."""
        growth = self.runs.rest.exponents.real
        return float(growth[growth < -self.runs.rest.round_off].max())

    @property
    def settling(self) -> float:
        """Time of a run before its motion may count as lasting [s]."""
        settles = SETTLING / abs(self.exponent.real)
        return min(self.runs.options.longest, max(settles, 2.0 * self.runs.window_of(self.number)))

    def _start(self, amplitude: float) -> InitialEquilibrium:
        return replace(self.runs.start, mode=self.number, amplitude=amplitude)

    def _squeal(self, amplitude: float) -> xr.Dataset | None:
        """Return the run after a kick if it squeals, None if its motion dies away."""
        runs, number, start = self.runs, self.number, self._start(amplitude)
        longest = runs.options.longest
        run = runs.simulate(start, min(longest, 2.0 * runs.window_of(number)))
        while not self._dies(run):
            (before, after), lasted = runs.swings(run, number), length_of(run)
            has_settled = lasted > 0.999 * self.settling
            is_steady = has_settled and abs(np.log(after / before)) < np.log(STEADY)
            wanted = min(longest, 2.0 * lasted if has_settled else self.settling)
            longer = run if is_steady else runs.longer(run, start, wanted - lasted)
            if longer is run:
                return run if run.attrs["ended"] == "finished" and after * FADING > before else None
            run = longer
        return None

    def _dies(self, run: xr.Dataset) -> bool:
        """Return whether a motion has died, or decays as by linear theory without any change of its contacts."""
        runs, number = self.runs, self.number
        if runs.is_dead(run, number):
            return True
        before, after = runs.swings(run, number)
        window = runs.window(run, number)
        shares = last(run, 2.0 * window)["status_share"].values
        if not after > 0.0:
            return True
        return not np.ptp(shares, axis=0).any() and bool(np.log(after / before) < BENT * self.slowest * window)

    def _tone(self, run: xr.Dataset) -> float:
        """Return the frequency of the strongest tone of a squeal [Hz]."""
        runs = self.runs
        end = last(run, 2.0 * runs.window(run, self.number))
        found = tones_of(
            liveliest_signal(end, runs.rest), runs.rest.exponents, np.array([], dtype=int), runs.options.resolution
        )
        return float(found[0].frequency) if found else float("nan")

    def _unstable(self, low: float, high: float) -> dict[str, Any]:
        """Return frequency and amplitude of the unstable cycle between two kicks, nothing if none is found."""
        runs = self.runs
        dying, squealing = (runs.simulate(self._start(one), self.settling) for one in (low, high))
        periods = self._together(relative(dying, runs.rest), relative(squealing, runs.rest), dying)
        if periods < FEWEST:
            return {}
        hovering = runs.simulate(self._start(low), periods * self.period)
        tips = dict.fromkeys(contact.tip for contact in runs.scenario.system.contacts)
        probes = [Displacement(tip, axis) for tip in tips for axis in "xyz"[: 3 if tip.body.is_spatial else 2]]
        cycle = cycle_after(runs.scenario, hovering, 1.0 / self.period, probes, runs.watch)
        if cycle is None or bool(cycle["stable"]):
            return {}
        amplitude = float(cycle["displacement_amplitude"].max())
        return {"unstable_frequency": float(cycle["frequency"]), "unstable_amplitude": amplitude}

    def _together(self, one: Array, other: Array, run: xr.Dataset) -> int:
        """Return the number of periods for which two motions stay near each other."""
        samples = max(2, round(self.period / float(run.attrs["sample_interval"])))
        count = min(len(one), len(other)) // samples
        for period in range(count):
            piece = slice(period * samples, (period + 1) * samples)
            if swing(one[piece] - other[piece]) > NEAR * swing(one[piece]):
                return period
        return count
