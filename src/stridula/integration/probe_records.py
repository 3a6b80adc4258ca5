"""Records of probes: each low-passed from the steps of a march to its own samples."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from .decimation import Decimator
from .timing import Timing


class ProbeRecords:
    """The probes of a run, chunk by chunk: single quantities at every sample, motion of bodies at its own rate.

    Parameters
    ----------
    of_bodies : ndarray of bool, shape (probes,)
        Mask of the velocities of modes that `ModalMotion` records. There are many, and sound takes no more digits: they
        are kept in single precision.
    timing : Timing
        Step and sampling of the run.
    before : ndarray, shape (memory, probes), optional
        The tail of a run that this one continues.

    Attributes
    ----------
    tail : ndarray, shape (memory, probes), or None
        Values at the last steps, from which another run can continue.
    """

    def __init__(self, of_bodies: Array, timing: Timing, before: Array | None = None) -> None:
        # A run that was interrupted at once has none.
        self.tail = before = None if before is None or not len(before) else before
        self._memory, self._probes = memory_of(timing), len(of_bodies)
        self._single = _Samples(~of_bodies, timing, 1, np.float64, before)
        self._motion = _Samples(of_bodies, timing, timing.motion_every, np.float32, before)

    def take(self, raw: Array) -> None:
        """Record values at the next steps, shape (steps, probes)."""
        if self.tail is None:
            self.tail = np.repeat(raw[:1], self._memory, axis=0)
        kept = np.concatenate([self.tail, raw[max(0, len(raw) - self._memory) :]])
        self.tail = kept[len(kept) - self._memory :]
        for one in (self._single, self._motion):
            one.take(raw)

    def ahead(self, done: int) -> int:
        """Return the number of steps beyond the end that the low-passes need after `done` samples."""
        return max(one.ahead(done) for one in (self._single, self._motion))

    def finish(self, done: int, beyond: Array | None) -> None:
        """Complete the record after `done` samples from values beyond the end, or from the last value."""
        for one in (self._single, self._motion):
            one.finish(done, beyond)

    def values(self, done: int) -> tuple[Array, Array]:
        """Return the records of single quantities and of motions up to `done` samples, shape (samples, probes)."""
        return self._single.values(done), self._motion.values(done)

    @property
    def state(self) -> Array:
        """Values at the last steps, none before the first step."""
        return np.empty((0, self._probes)) if self.tail is None else self.tail


class _Samples:
    """Some of the probes, at the ends of intervals of `every` samples of the run."""

    def __init__(self, chosen: Array, timing: Timing, every: int, kind: Any, before: Array | None) -> None:
        self._chosen, self._every = np.flatnonzero(chosen), every
        self._steps = timing.ratio * every
        own = None
        if before is not None:
            own = self._own(before[len(before) - min(len(before), _memory(self._steps)) :])
        self._decimator = Decimator(self._steps, own)
        self._record = np.empty((timing.samples // every, int(chosen.sum())), dtype=kind)
        self._filled = 0

    def take(self, raw: Array) -> None:
        if self._record.shape[1]:
            self._keep(self._own(raw))

    def _own(self, raw: Array) -> Array:
        # In the order of memory in which sums are the same to the last bit wherever a run is cut.
        return raw.take(self._chosen, axis=1)

    def _keep(self, raw: Array) -> None:
        samples = self._decimator.feed(raw)
        count = min(len(samples), len(self._record) - self._filled)
        self._record[self._filled : self._filled + count] = samples[:count]
        self._filled += count

    def ahead(self, done: int) -> int:
        lacks = self._record.shape[1] and self._filled < done // self._every
        return self._decimator.lookahead if lacks else 0

    def finish(self, done: int, beyond: Array | None) -> None:
        if not self.ahead(done):
            return
        count = self._record.shape[1]
        raw = np.empty((0, count)) if beyond is None else self._own(beyond)
        missing = self._decimator.lookahead - len(raw)
        if missing > 0:
            last = raw[-1:] if len(raw) else self._decimator.last
            last = np.zeros((1, count)) if last is None else last
            raw = np.concatenate([raw, np.repeat(last, missing + self._steps, axis=0)])
        self._keep(raw)

    def values(self, done: int) -> Array:
        return self._record[: done // self._every]


def memory_of(timing: Timing) -> int:
    """Return the number of steps from whose probes another run continues."""
    return _memory(timing.ratio * timing.motion_every)


def _memory(steps: int) -> int:
    return Decimator(steps).memory
