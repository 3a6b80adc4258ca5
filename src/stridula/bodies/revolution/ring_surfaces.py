"""The outer surface of a body of revolution as rings: its outline, cut as finely as thickness and sound require."""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from ..body_surfaces import inscribed_radius
from .profile_mesh import SAME_PLACE, ProfileMesh

# Cosine of the angle between sides of the outline below which they form a corner.
CORNER = 0.9
# Length of a part over the radius of the inscribed ball there, and least length over the least thickness: air flows
# round edges, so that parts become shorter towards them as far as that matters.
PART_OF_BALL, LEAST_PART = 0.6, 1e-3
# Length of a part over its distance from a reentrant corner, and least length there over the least thickness: sources
# under both sides of the corner are far apart, so that only shallow ones represent its vicinity.
PART_OF_WAY, LEAST_WITHIN = 0.6, 0.03
# Samples of a line.
SAMPLES = 400


def cut_outline(mesh: ProfileMesh, largest: float) -> tuple[Array, Array, Array]:
    """Return rings all over the outer surface, two over each part of the outline.

    Parts are proportional to the radius of the largest circle that fits into the profile there, and to the distance
    from reentrant corners; they are at most `largest`.

    Parameters
    ----------
    mesh : ProfileMesh
        The cells of the profile.
    largest : float
        Largest length of a part [m].

    Returns
    -------
    places, normals : ndarray, shape (rings, 2)
        r and z of the rings [m], and outward unit normals.
    widths : ndarray, shape (rings,)
        Lengths of outline that they represent [m].
    """
    runs, least = _runs(mesh), min(LEAST_PART * mesh.thinnest, largest)
    inner = _inner_corners(runs)
    fine = [_samples(run) for run in runs]
    every = np.concatenate([places for _, places, _ in fine])
    every = np.concatenate([every, every * np.array([-1.0, 1.0])])
    found = []
    for run, (lengths, places, normals) in zip(runs, fine, strict=True):
        size = PART_OF_BALL * inscribed_radius(places, normals, every)
        for corner in inner[(inner == run[0]).all(axis=1) | (inner == run[-1]).all(axis=1)]:
            away = np.linalg.norm(places - corner, axis=1)
            size = np.minimum(size, np.maximum(PART_OF_WAY * away, LEAST_WITHIN * mesh.thinnest))
        size = np.clip(size, least, largest)
        found.append(_graded(run, lengths, size))
    places, normals, widths = (np.concatenate(one) for one in zip(*found, strict=True))
    return places, normals, widths


def _runs(mesh: ProfileMesh) -> list[Array]:
    """Return the outline without the axis as smooth lines of points, each of shape (points, 2)."""
    on_axis = mesh.nodes[:, 0] <= SAME_PLACE * mesh.size
    sides = {int(start): int(end) for start, end in mesh.outline if not (on_axis[start] and on_axis[end])}
    ways = {start: mesh.nodes[end] - mesh.nodes[start] for start, end in sides.items()}
    ways = {start: way / np.linalg.norm(way) for start, way in ways.items()}
    before = {end: start for start, end in sides.items()}
    is_first = {start: start not in before or ways[start] @ ways[before[start]] < CORNER for start in sides}
    starts = [start for start, first in is_first.items() if first] or [next(iter(sides))]
    runs = []
    for start in starts:
        nodes = [start, sides[start]]
        while nodes[-1] in sides and not is_first[nodes[-1]] and nodes[-1] != start:
            nodes.append(sides[nodes[-1]])
        runs.append(mesh.nodes[nodes])
    return runs


def _inner_corners(runs: list[Array]) -> Array:
    """Return the reentrant corners of the outline, shape (corners, 2)."""
    ends = {tuple(run[-1]): run[-1] - run[-2] for run in runs}
    found = [np.empty((0, 2))]
    for run in runs:
        before, after = ends.get(tuple(run[0]), np.zeros(2)), run[1] - run[0]
        is_corner = before @ after < CORNER * np.linalg.norm(before) * np.linalg.norm(after)
        # The body is to the left of its outline.
        if is_corner and before[0] * after[1] < before[1] * after[0]:
            found.append(run[:1])
    return np.concatenate(found)


def _length(run: Array) -> float:
    return float(np.linalg.norm(np.diff(run, axis=0), axis=1).sum())


def _samples(run: Array) -> tuple[Array, Array, Array]:
    """Return lengths along a line, denser towards its ends, with their places and normals to the right."""
    lengths = 0.5 * _length(run) * (1.0 - np.cos(np.linspace(0.0, np.pi, SAMPLES)))
    return lengths, *_along(run, lengths)


def _graded(run: Array, lengths: Array, sizes: Array) -> tuple[Array, Array, Array]:
    """Return two rings for each part of a line, with normals and widths; sizes are given at lengths along it."""
    rate = 1.0 / sizes
    parts = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(lengths))])
    count = 2 * max(1, int(np.ceil(parts[-1])))
    ends = np.interp(np.linspace(0.0, parts[-1], count + 1), parts, lengths)
    return *_along(run, 0.5 * (ends[1:] + ends[:-1])), np.diff(ends)


def _along(run: Array, lengths: Array) -> tuple[Array, Array]:
    """Return points at lengths along a line, and unit normals to the right of it."""
    steps = np.diff(run, axis=0)
    sizes = np.linalg.norm(steps, axis=1)
    ends = np.concatenate([[0.0], np.cumsum(sizes)])
    side = np.clip(np.searchsorted(ends, lengths, side="right") - 1, 0, len(steps) - 1)
    way = steps[side] / sizes[side, None]
    return run[side] + (lengths - ends[side])[:, None] * way, np.stack([way[:, 1], -way[:, 0]], axis=1)
