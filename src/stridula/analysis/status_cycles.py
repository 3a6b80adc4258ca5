"""Cycles of the contact status: slips from one stick phase to the next, their rate, rhythm and bursts."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..arrays import Array
from .phases import ROUND_OFF, moving_mean
from .recurrences import recurrence
from .status_changes import prevailing, regularity, slips, vibrations

# Sticks and slips that last at most this number of time steps may be noise.
NOISY_STEPS = 2.0
# From this number on, slips that soon follow each other are cycles, not the chatter of one slip.
CYCLES = 5
# Slips that are more than this number of periods apart belong to different bursts.
MISSED = 2.5
# Lengths in periods of the lowest tone: of the window over which the share of sticking in a stop is averaged, and of
# the shortest burst.
STOP, BURST = 1.5, 1.0


class StatusCycles:
    """Slips of a contact, or of several together, in samples.

    Parameters
    ----------
    sticking : ndarray, shape (samples,)
        Share of sticking in each sample.
    step : float
        Time step [samples], 0 if unknown.
    lowest : float
        Period of the lowest tone [samples].
    """

    def __init__(self, sticking: Array, step: float, lowest: float) -> None:
        self.size, self.lowest, self._sticking = sticking.size, lowest, sticking
        noise = NOISY_STEPS * step * (1.0 + ROUND_OFF)
        # Starts and ends of the slips with their chatter, and of each slip by itself.
        self.slips = slips(sticking, noise, lowest)
        self._each = slips(sticking, noise, 0.0)

    @cached_property
    def caught(self) -> Array:
        """Slips that end in a stick phase, as starts and ends, shape (slips, 2)."""
        return self._caught(self.slips)

    @cached_property
    def cycles(self) -> Array:
        """Slips of each cycle of stick and slip, shape (cycles, 2): all slips of a vibration, else whole slips."""
        inside = np.searchsorted(self.slips[:, 0], self._each[:, 0] + 0.5, side="right") - 1
        counts = np.bincount(inside[inside >= 0], minlength=len(self.slips))
        vibrates = counts >= CYCLES
        found = np.concatenate([self._each[vibrates[inside]], self.slips[~vibrates]])
        return self._caught(found[np.argsort(found[:, 0])])

    @cached_property
    def rhythm(self) -> float:
        """Period of the slips [samples], their mean distance if they do not recur; NaN for fewer than two."""
        found, _ = recurrence(self.caught)
        ends = self.caught[:, 1]
        return float(np.diff(ends).mean()) if np.isnan(found) and ends.size > 1 else found

    @cached_property
    def period(self) -> float:
        """Period of the cycles [samples], NaN if they do not recur."""
        return self._recurrence[0]

    @property
    def recurrence(self) -> float:
        """Share of the cycles that recur after the period [1], 0 if they do not recur."""
        return self._recurrence[1]

    @cached_property
    def _recurrence(self) -> tuple[float, float]:
        return recurrence(self.cycles)

    @property
    def periodicity(self) -> float:
        """Regularity of the slips [1], of the cycles where these recur within slips; NaN for fewer than three."""
        return regularity((self.caught if len(self.caught) > 2 else self.cycles)[:, 1])

    @cached_property
    def prevailing_vibration(self) -> float:
        """Length of the vibrations that make up half of the slip time [samples], infinite if it always slips."""
        return prevailing(np.diff(vibrations(self.slips, self.lowest), axis=1)[:, 0])

    @cached_property
    def bursts(self) -> Array:
        """Starts and ends of the bursts between stops, shape (bursts, 2); all samples if there are no stops.

        Cycles that recur fill a burst, however long they stick. Without such cycles it sticks for less than half of the
        time in a burst.
        """
        found = self._filled() if self.period < self.lowest else self._restless()
        found = found[found[:, 1] - found[:, 0] >= BURST * self.lowest]
        return found if len(found) else np.array([[0, self.size]])

    def _filled(self) -> Array:
        """Return the intervals filled with cycles."""
        each, longest = self._each, MISSED * self.period
        apart = np.flatnonzero(each[1:, 0] - each[:-1, 1] > longest)
        starts, ends = each[np.append(0, apart + 1), 0], each[np.append(apart, len(each) - 1), 1]
        starts[0] = starts[0] if starts[0] > longest else 0.0
        ends[-1] = ends[-1] if self.size - ends[-1] > longest else self.size
        return np.stack([starts, ends], axis=1)

    def _restless(self) -> Array:
        """Return the intervals in which it sticks for less than half of the time."""
        moves = moving_mean(self._sticking, 2 * round(STOP * self.lowest / 2.0) + 1) < 0.5
        return np.flatnonzero(np.diff(np.concatenate([[False], moves, [False]]))).reshape(-1, 2)

    def _caught(self, found: Array) -> Array:
        """Return the slips that the end of the record does not cut."""
        return found[found[:, 1] < self.size * (1.0 - ROUND_OFF)]
