"""Parts of the played motion, and their encoding for the page."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..integration.live import LiveChunk, LiveMarch
from ..records.variables import dominant_status

# Samples averaged to one in the pictures of the forces and of the phase portrait.
THINNED = 4


@dataclass(frozen=True)
class Shapes:
    """Positions of the bodies.

    Attributes
    ----------
    place, height : float
        Position of the first tip along its track, and its height above the undeflected track [m].
    slider : ndarray, shape (nodes, 2)
        Displacements along x and y [m]: for two beams those of the slider's nodes relative to its tip, tip first; for
        other systems, line by line, the travel, drawn to scale, and then the deviation from it at each point.
    track : ndarray, shape (points,)
        For two beams the deflections at equal distances along the track [m]; for systems in space the coordinates of
        all bodies, then their rates of change.
    contacts : ndarray, shape (contacts, 2)
        For other systems the status of each contact, and the travel of its track along itself [m].
    """

    place: float
    height: float
    slider: Array
    track: Array
    contacts: Array = field(default_factory=lambda: np.zeros((0, 2)))


@dataclass(frozen=True)
class Part:
    """A part of the played motion.

    Attributes
    ----------
    revision : int
        Number of the change that it includes.
    clock : float
        Time played at its end [s].
    sound : ndarray, shape (samples,)
        Sound, in the unit of the source.
    chunk : LiveChunk
        Record of the contacts and of the probes.
    shapes : Shapes
        Positions of the bodies at its end.
    stroke : int
        Number of the stroke.
    """

    revision: int
    clock: float
    sound: Array
    chunk: LiveChunk
    shapes: Shapes
    stroke: int

    @property
    def samples(self) -> int:
        """Number of its samples."""
        return len(self.sound)


@dataclass(frozen=True)
class Stop:
    """The end of a stroke.

    Attributes
    ----------
    why : str
        Reason for the end.
    goes_on : bool
        Whether another stroke begins.
    """

    why: str
    goes_on: bool
    # A part without sound.
    samples: ClassVar[int] = 0


def packed(part: Part) -> bytes:
    """Return a part encoded for the page.

    Nine numbers in double precision: revision, clock, stroke, samples, samples of the pictures, nodes, points of the
    track, contacts, place of the first tip. Then in single precision the sound; for the pictures normal force,
    tangential force, status, place of the tip and its velocity; height of the tip, displacements of the nodes,
    deflections of the track, status and travel of each contact. All are little-endian, with a zero at the end if their
    number is odd, so that parts can be joined. Forces are those of all contacts together, and the status is the one in
    which they carry most of their load; place and velocity are those of the first tip.
    """
    samples = part.samples
    thinned = THINNED if samples % THINNED == 0 else 1
    contact, shapes = part.chunk.contact, part.shapes
    forces = [part.chunk.contacts[name].sum(axis=0) for name in ("normal_force", "tangential_force")]
    shares = _together(part.chunk).reshape(-1, thinned, 3).mean(axis=1)
    seen = [*(_means(force, thinned) for force in forces), dominant_status(shares)]
    seen += [contact["contact_position"][thinned - 1 :: thinned] - shapes.place, contact["slip_velocity"][::thinned]]
    counts = [samples, samples // thinned, len(shapes.slider), len(shapes.track), len(shapes.contacts)]
    head = np.array([part.revision, part.clock, part.stroke, *counts, shapes.place], dtype="<f8")
    moved = [shapes.slider.ravel(), shapes.track, shapes.contacts.ravel()]
    body = np.concatenate([part.sound, *seen, [shapes.height], *moved])
    odd = np.zeros(len(body) % 2)
    return head.tobytes() + np.concatenate([body, odd]).astype("<f4").tobytes()


def contacts_now(live: LiveMarch, chunk: LiveChunk) -> Array:
    """Return the status of each contact at the end of a chunk, and the travel of its track [m]."""
    return np.stack([dominant_status(chunk.status_shares[:, -1]), live.passed], axis=1)


def _together(chunk: LiveChunk) -> Array:
    """Return the share of each status over the samples, weighted by the load of each contact."""
    loads = np.maximum(chunk.contacts["normal_force"], 0.0)
    total = loads.sum(axis=0)
    loads = np.where(total > 0.0, loads, 1.0)
    return np.asarray(np.einsum("ct,cts->ts", loads, chunk.status_shares) / loads.sum(axis=0)[:, None])


def _means(values: Array, count: int) -> Array:
    return np.asarray(values.reshape(-1, count).mean(axis=1))
