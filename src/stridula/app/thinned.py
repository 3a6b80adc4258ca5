"""Surfaces with fewer corners, so that a page can draw them many times per second."""

from __future__ import annotations

from dataclasses import replace
from functools import singledispatch
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies.drawn_surfaces import Drawn, DrawnRings, DrawnSurface

# Largest numbers of corners that are drawn: of a surface, and of the outline of a body of revolution.
MOST_CORNERS, MOST_OF_OUTLINE = 5000, 160
# Largest number of values in the mode shapes of a body.
MOST_NUMBERS = 1_000_000
# Factor by which cells grow until there are few enough.
GROWS = 1.2


@singledispatch
def thinned(drawn: Any) -> Drawn:
    """Return a surface with at most as many corners as the page can draw."""
    raise TypeError(type(drawn))


@thinned.register
def _surface(drawn: DrawnSurface) -> Drawn:
    return clustered(drawn, MOST_CORNERS)


@thinned.register
def _rings(drawn: DrawnRings) -> Drawn:
    return with_fewer_corners(drawn, min(MOST_OF_OUTLINE, MOST_NUMBERS // (3 * max(1, drawn.orders.size))))


def clustered(surface: DrawnSurface, most: int) -> DrawnSurface:
    """Return a surface with at most `most` corners: in each cell of space, the corner nearest to their mean.

    Parameters
    ----------
    surface : DrawnSurface
        The surface.
    most : int
        Largest number of corners.
    """
    place = surface.place
    if len(place) <= most:
        return surface
    size = float(np.ptp(place, axis=0).max()) / np.sqrt(most)
    cell = _cells(place, size)
    while cell.max() >= most:
        size *= GROWS
        cell = _cells(place, size)
    middle = np.stack([np.bincount(cell, along) for along in place.T], axis=1) / np.bincount(cell)[:, None]
    apart = np.linalg.norm(place - middle[cell], axis=1)
    nearest = np.lexsort((apart, cell))
    kept = nearest[np.searchsorted(cell[nearest], np.arange(cell.max() + 1))]
    polygons = cell[surface.polygons]
    # Merged corners count once; a polygon needs at least three.
    has_area = np.array([len(set(corners)) > 2 for corners in polygons.tolist()])
    return DrawnSurface(place[kept], polygons[has_area], surface.shapes[kept])


def _cells(place: Array, size: float) -> Array:
    """Return the number of the cell of each place."""
    return np.unique(np.floor(place / size).astype(int), axis=0, return_inverse=True)[1].ravel()


def with_fewer_corners(rings: DrawnRings, most: int) -> DrawnRings:
    """Return a body of revolution whose outline has at most `most` corners, removing those at which it bends least.

    Parameters
    ----------
    rings : DrawnRings
        The body.
    most : int
        Largest number of corners.
    """
    sides = rings.sides
    corners = np.unique(sides)
    while len(corners) > most:
        before, after = _neighbours(sides, len(rings.place))
        inner = corners[(before[corners] >= 0) & (after[corners] >= 0)]
        # An outline needs at least three sides.
        if len(inner) < 4:
            break
        (x, y), (u, v) = ((rings.place[beside[inner]] - rings.place[inner]).T for beside in (before, after))
        gone = inner[np.argmin(np.abs(x * v - y * u))]
        sides = np.concatenate([sides[(sides != gone).all(axis=1)], [[before[gone], after[gone]]]])
        corners = np.unique(sides)
    used, numbers = np.unique(sides, return_inverse=True)
    return replace(rings, place=rings.place[used], sides=numbers.reshape(-1, 2), shapes=rings.shapes[used])


def _neighbours(sides: Array, count: int) -> tuple[Array, Array]:
    """Return the previous and the next corner of each along an outline, -1 where there is none."""
    before, after = np.full(count, -1), np.full(count, -1)
    before[sides[:, 1]], after[sides[:, 0]] = sides.T
    return before, after
