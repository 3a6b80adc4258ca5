"""Bodies in open air by their closed surface: modes that sound, their responses, and notes on doubtful ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..bodies import Modes
from ..bodies.body_surfaces import BodySurface
from .air import Air
from .delays import Response, Sampling
from .distances import distances_to
from .free_responses import LEFT, Sent, free_responses
from .sheets import Sheet

# Largest bandwidth of a sound [Hz], the limit of hearing.
HIGHEST = 20e3
# Error of a fit at a mode's own frequency above which a note states it.
SAID = 0.05
# Fraction of the largest normal motion of all modes below which a mode makes no sound.
STILL = 1e-9


@dataclass(frozen=True)
class Heard:
    """Sound of a body at listeners.

    Attributes
    ----------
    numbers : ndarray of int, shape (modes,)
        The modes of the body that sound.
    responses : list of Response
        Their impulse responses at each listener, from acceleration to pressure.
    error : float
        Largest relative error of the fit of a mode at its own frequency; nan without a fit.
    notes : list of str
        Notes on doubtful responses.
    """

    numbers: Array
    responses: list[Response]
    error: float = float("nan")
    notes: Sequence[str] = ()

    def only(self, modes: Array) -> Heard:
        """Return it with some of its modes, by number in the body."""
        kept = np.flatnonzero(np.isin(self.numbers, modes))
        if kept.size == self.numbers.size:
            return self
        return replace(
            self, numbers=self.numbers[kept], responses=[replace(one, taps=one.taps[:, kept]) for one in self.responses]
        )


@dataclass(frozen=True)
class OpenSurface:
    """A body in open air by its closed surface.

    Attributes
    ----------
    name : str
        Name of the body.
    surface : PointSurface or RingSurface
        Its surface with the modes that sound.
    numbers : ndarray of int, shape (modes,)
        Their numbers.
    frequency : ndarray, shape (modes,)
        Their frequencies [Hz].
    origin : ndarray, shape (3,)
        Place of the origin of the surface in the world [m].
    """

    most: ClassVar[float] = HIGHEST
    wall: ClassVar[None] = None
    is_line: ClassVar[bool] = False
    name: str
    surface: BodySurface
    numbers: Array
    frequency: Array
    origin: Array

    @property
    def points(self) -> Array:
        """The points of its surface."""
        return np.asarray(self.origin + self.surface.as_points.points)

    def distances(self, places: Array) -> Array:
        """Return the distances to its surface."""
        return distances_to(self.surface, places, self.origin)

    def heard(self, moving: Array, places: Array, air: Air, sampling: Sampling) -> Heard:
        """Return its sound, by fits at frequencies, for all its modes, as these fits are cached for the next run."""
        own, distances = places - self.origin, self.distances(places)
        sent = by_fits(self.name, self.surface, self.numbers, self.frequency, own, distances, air, sampling)
        return sent.only(moving)


def by_fits(
    name: str,
    surface: BodySurface | Sheet,
    numbers: Array,
    frequency: Array,
    places: Array,
    distances: Array,
    air: Air,
    sampling: Sampling,
) -> Heard:
    """Return the sound of the modes of a body in open air, by fits at frequencies.

    Parameters
    ----------
    name : str
        Name of the body.
    surface : PointSurface, RingSurface or Sheet
        Its surface.
    numbers : ndarray of int, shape (modes,)
        Numbers in the body of the modes of the surface.
    frequency : ndarray, shape (modes,)
        Their frequencies [Hz].
    places : ndarray, shape (listeners, 3)
        Places of the listeners in the axes of the surface [m].
    distances : ndarray, shape (listeners,)
        Distances to the nearest points of the surface [m].
    air : Air
        The air.
    sampling : Sampling
        Sampling of the responses.
    """
    if not numbers.size:
        return Heard(numbers, [])
    # A body that does not vibrate moves as a rigid one at any frequency.
    highest = float(frequency.max(initial=0.0)) or np.inf
    sent = free_responses(surface, places, distances, air, sampling, highest)
    notes, worst = _doubts(name, frequency, sent)
    return Heard(numbers, sent.responses, worst, notes)


def open_surface(name: str, surface: BodySurface, modes: Modes, origin: Array, highest: float = np.inf) -> OpenSurface:
    """Return a body by its closed surface, with its modes of normal motion up to a frequency [Hz]."""
    frequency = modes.frequency[~modes.massless]
    moved = np.abs(surface.shapes).max(axis=0)
    sounds = (moved > STILL * moved.max(initial=0.0)) & (frequency <= highest)
    numbers = np.flatnonzero(sounds)
    return OpenSurface(
        name,
        _only(surface, tuple(numbers.tolist())),
        np.flatnonzero(~modes.massless)[numbers],
        frequency[numbers],
        origin,
    )


@lru_cache(maxsize=8)
def _only(surface: BodySurface, numbers: tuple[int, ...]) -> BodySurface:
    """Return a surface with some of its modes; the same object each time, as fits are cached by surface."""
    return surface if len(numbers) == surface.shapes.shape[1] else surface.only(list(numbers))


def _doubts(name: str, frequency: Array, sent: Sent) -> tuple[list[str], float]:
    """Return notes on doubtful responses of a body, and the largest error of a mode at its own frequency."""
    within = np.flatnonzero(frequency <= sent.frequencies[-1])
    own = np.array([np.interp(frequency[k], sent.frequencies, sent.errors[:, k]) for k in within])
    worst, notes = float(own.max(initial=0.0)), []
    if worst > SAID:
        at = frequency[within[int(own.argmax())]]
        notes.append(f"{name}: error of {100.0 * worst:.2g} % in {sent.error_in} at {at:.4g} Hz")
    if sent.left > LEFT:
        notes.append(f"{name}: {100.0 * sent.left:.2g} % of its response lasts longer than is included")
    return notes, worst
