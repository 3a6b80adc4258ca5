"""Points, faces and lines that the demonstration draws of a system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import stridula as st

Array = np.ndarray[Any, np.dtype[Any]]

# Points round a body of revolution, and along a string.
ROUND, ALONG = 40, 97


@dataclass(frozen=True)
class Drawn:
    """What is drawn of a system.

    Attributes
    ----------
    place : ndarray, shape (points, 3)
        Places at rest [m]; the third axis is up, the first to the right.
    traces : dict of str to ndarray, shape (points, 3, modes)
        Displacement of the points for unit modes of each body.
    faces : list of list of int
        Corners of faces, counter-clockwise from outside.
    lines : list of list of int
        Points of lines.
    marks : list of int
        Points of contacts that are marked.
    extent : float
        Length to scale by [m].
    reach : float
        Length as which the largest motion of a case is drawn [m].
    """

    place: Array
    traces: dict[str, Array]
    faces: list[list[int]]
    lines: list[list[int]]
    marks: list[int]
    extent: float
    reach: float


def rings(count: int) -> list[list[int]]:
    """Return the faces between a number of rings of points."""
    found = []
    for ring in range(count - 1):
        for k in range(ROUND):
            after = (k + 1) % ROUND
            corners = [(ring, k), (ring, after), (ring + 1, after), (ring + 1, k)]
            found.append([row * ROUND + column for row, column in corners])
    return found


def round_points(body: Any, profile: list[tuple[float, float]]) -> tuple[Array, Array]:
    """Return places and traces of the points of rings of a body of revolution."""
    at = [(r, 2.0 * np.pi * k / ROUND, z) for r, z in profile for k in range(ROUND)]
    return np.array([body.place(one) for one in at]), np.array([body.trace(one) for one in at])


def body_named(system: st.System, name: str) -> Any:
    """Return a body of a system."""
    return next(body for body in system.bodies if system.body_name(body) == name)


def of_glass(system: st.System) -> Drawn:
    """The wall of the bowl, the stem at rest, and the place of the finger on the rim."""
    glass = body_named(system, "glass")
    profile = [(r, z) for r, z in glass.profile.points if z >= 0.07]
    place, trace = round_points(glass, profile)
    stem = [*place[:ROUND:10], *(place[:ROUND:10] * (1.0, 1.0, 0.0))]
    still = np.zeros((len(stem), *trace.shape[1:]))
    base, n = len(place), ROUND // 10
    lines = [[base + k, base + n + k] for k in range(n)]
    places, traces = np.concatenate([place, stem]), np.concatenate([trace, still])
    return Drawn(places, {"glass": traces}, rings(len(profile)), lines, [base - ROUND // 8], 0.17, 0.03)


def of_string(system: st.System) -> Drawn:
    """The string, whose transverse motion is drawn upwards."""
    string = body_named(system, "string")
    along = np.linspace(0.0, string.length, ALONG)
    trace = np.zeros((ALONG, 3, string.modes().count))
    trace[:, 2] = [string.trace(float(x))[1] for x in along]
    place = np.stack([along - 0.5 * string.length, 0.0 * along, 0.0 * along], axis=1)
    bow = int(np.abs(along - system.contacts[2].track.position).argmin())
    return Drawn(place, {"string": trace}, [], [list(range(ALONG))], [bow], string.length, 0.4 * string.length)
