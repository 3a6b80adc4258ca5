"""What is played, part by part, and how a part goes to the page."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array
from ..integration.live import LiveChunk, LiveMarch
from ..records.variables import dominant_status

# Samples that become one in the pictures of the forces and of the phase portrait.
THINNED = 4


@dataclass(frozen=True)
class Shapes:
    """Where the bodies are.

    Attributes
    ----------
    place, height : float
        Where the first tip is, along its track and above it where it is straight [m].
    slider : ndarray, shape (nodes, 2)
        Displacements along x and y [m]: of two beams those of the slider's nodes less that of its tip, tip first; of
        other systems, line by line, the travel that is to scale and then what departs from it at each point.
    track : ndarray, shape (points,)
        Of two beams the deflections at equal distances along the track [m]; of systems in space the numbers that tell
        where each body is, body by body, then how fast these change.
    contacts : ndarray, shape (contacts, 2)
        Of other systems the status of each contact, and how far what it slides on has moved along itself [m].
    """

    place: float
    height: float
    slider: Array
    track: Array
    contacts: Array = field(default_factory=lambda: np.zeros((0, 2)))


@dataclass(frozen=True)
class Part:
    """A part of what is played.

    Attributes
    ----------
    revision : int
        Number of the change that is heard in it.
    clock : float
        Time played at its end [s].
    sound : ndarray, shape (samples,)
        What is heard, in the unit of the source.
    chunk : LiveChunk
        Record of the contacts and of the probes.
    shapes : Shapes
        Where the bodies are at its end.
    stroke : int
        Number of the stroke.
    """

    revision: int
    clock: float
    sound: Array
    chunk: LiveChunk
    shapes: Shapes
    stroke: int


@dataclass(frozen=True)
class Stop:
    """The end of a stroke.

    Attributes
    ----------
    why : str
        What ended it.
    goes_on : bool
        Whether another stroke begins.
    """

    why: str
    goes_on: bool


def packed(part: Part) -> bytes:
    """Return a part as the page reads it.

    Nine numbers in double precision: revision, clock, stroke, samples, samples of the pictures, nodes, points of the
    track, contacts, place of the first tip. Then in single precision the sound; for the pictures normal force,
    tangential force, status, place of the tip and its velocity; height of the tip, displacements of the nodes,
    deflections of the track, status and travel of each contact. All little-endian; a zero at the end where they are odd
    in number, so that parts can lie one after the other.
    """
    samples = len(part.sound)
    thinned = THINNED if samples % THINNED == 0 else 1
    contact, shapes = part.chunk.contact, part.shapes
    shares = part.chunk.status_share.reshape(-1, thinned, 3).mean(axis=1)
    seen = [_means(contact["normal_force"], thinned), _means(contact["tangential_force"], thinned)]
    seen += [dominant_status(shares)]
    seen += [contact["contact_position"][thinned - 1 :: thinned] - shapes.place, contact["slip_velocity"][::thinned]]
    counts = [samples, samples // thinned, len(shapes.slider), len(shapes.track), len(shapes.contacts)]
    head = np.array([part.revision, part.clock, part.stroke, *counts, shapes.place], dtype="<f8")
    moved = [shapes.slider.ravel(), shapes.track, shapes.contacts.ravel()]
    body = np.concatenate([part.sound, *seen, [shapes.height], *moved])
    odd = np.zeros(len(body) % 2)
    return head.tobytes() + np.concatenate([body, odd]).astype("<f4").tobytes()


def contacts_now(live: LiveMarch, chunk: LiveChunk) -> Array:
    """Return the status of each contact at the end of a chunk, and how far what it slides on has moved [m]."""
    return np.stack([dominant_status(chunk.status_shares[:, -1]), live.passed], axis=1)


def _means(values: Array, count: int) -> Array:
    return np.asarray(values.reshape(-1, count).mean(axis=1))
