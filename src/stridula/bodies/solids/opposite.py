"""The place on a face of a mesh opposite a given place.

A curved facet is met where its shape functions are, by Newton's method from the triangles of its corners.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from .places import on_facet
from .solid_mesh import SolidMesh

# Relative tolerance at the edges of a facet, and how far beyond them the plane of a curved facet may be met.
BEYOND, NEAR = 1e-9, 0.3
# Distance of the nodes from the plane of the corners, relative to the size of a facet, from which it is curved.
CURVED = 1e-9
# Steps of Newton's method on a curved facet, and the last change of its coordinates: the error is of its square.
STEPS, LAST = 20, 1e-8
# Corners of the unit square in the order of those of a facet; a triangle has the first two beside the origin.
SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
TRIANGLE = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
# Powers of both coordinates on a facet, which are also twice the coordinates of nodes on it.
OF_SQUARE = np.array([(i, j) for i in range(3) for j in range(3)])
OF_TRIANGLE = np.array([(i, j) for i in range(3) for j in range(3 - i)])


class Triangles(NamedTuple):
    """One triangle of each facet.

    Attributes
    ----------
    first, along, across, square : ndarray, shape (facets, 3)
        A corner, both sides from it, and their product.
    corners : ndarray, shape (3, 2)
        Coordinates of the corners in the unit triangle or square.
    """

    first: Array
    along: Array
    across: Array
    square: Array
    corners: Array


class Facets(NamedTuple):
    """Facets of a face.

    Attributes
    ----------
    normal : ndarray, shape (facets, 3)
        Outward unit normals.
    size : ndarray, shape (facets,)
        Roots of the areas [m].
    curved : ndarray of bool, shape (facets,)
        Whether nodes lie beside the plane of the corners.
    surface : ndarray, shape (facets, powers, 3)
        Coefficients of the place [m] for the powers of the coordinates in the unit triangle or square, of curved ones.
    powers : ndarray of int, shape (powers, 2)
        These powers.
    triangles : tuple of Triangles
        Triangles of the corners of each facet.
    """

    normal: Array
    size: Array
    curved: Array
    surface: Array
    powers: Array
    triangles: tuple[Triangles, ...]


def opposite_place(mesh: SolidMesh, face: str, place: Array, normal: Array) -> tuple[Array, Array, float] | None:
    """Return the place on a face that is nearest along a normal, the normal facing it, and the distance; None if none.

    The distance is negative behind the given place.
    """
    facets = facets_of(mesh, face)
    best: tuple[float, int, Array] | None = None
    for number, far, begin in candidates(facets, place, normal):
        found: tuple[Array, float] | None = (place + far * normal, far)
        if facets.curved[number]:
            # A facet meets the line within its size of where the plane of its corners does.
            if best is not None and abs(far) > abs(best[0]) - facets.size[number]:
                continue
            found = on_curved(facets, number, place, normal, begin, far)
        if found is not None and (best is None or abs(found[1]) < abs(best[0])):
            best = found[1], number, found[0]
    if best is None:
        return None
    distance, number, there = best
    return there, -normal if facets.normal[number] @ normal < 0.0 else normal, distance


def candidates(facets: Facets, place: Array, normal: Array) -> list[tuple[int, float, Array]]:
    """Return facets that a line may meet, those first whose triangle it meets.

    Each has its number, the distance to its triangle, and the coordinates of the point there.
    """
    found = []
    beyond = np.where(facets.curved, NEAR, BEYOND)
    for one in facets.triangles:
        toward = one.square @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            far = ((one.first - place) * one.square).sum(axis=1) / toward
            there = place + far[:, None] * normal - one.first
            u = (np.cross(there, one.across) * one.square).sum(axis=1) / (one.square**2).sum(axis=1)
            v = (np.cross(one.along, there) * one.square).sum(axis=1) / (one.square**2).sum(axis=1)
        outside = -np.minimum(np.minimum(u, v), 1.0 - u - v)
        for number in np.flatnonzero((outside <= beyond) & (np.abs(toward) > 0.0)).tolist():
            begin = np.array([1.0 - u[number] - v[number], u[number], v[number]]) @ one.corners
            found.append((max(float(outside[number]), 0.0), number, float(far[number]), begin))
    return [one[1:] for one in sorted(found, key=lambda one: one[0])]


def on_curved(
    facets: Facets, number: int, place: Array, normal: Array, begin: Array, far: float
) -> tuple[Array, float] | None:
    """Return where a line through a place meets a curved facet, and its distance; None if it passes beside it."""
    surface, ones, others = facets.surface[number], facets.powers[:, 0], facets.powers[:, 1]
    u, v, distance = float(begin[0]), float(begin[1]), far
    for _ in range(STEPS):
        along = ones * u ** np.maximum(ones - 1, 0) * v**others
        across = others * u**ones * v ** np.maximum(others - 1, 0)
        slopes = np.column_stack([along @ surface, across @ surface, -normal])
        if not np.linalg.det(slopes):
            return None
        missed = place + distance * normal - (u**ones * v**others) @ surface
        more, further, beyond = np.linalg.solve(slopes, missed).tolist()
        u, v, distance = u + more, v + further, distance + beyond
        if max(abs(more), abs(further)) < LAST:
            break
    else:
        return None
    ends = u + v if len(facets.powers) == len(OF_TRIANGLE) else max(u, v)
    if min(u, v) < -BEYOND or ends > 1.0 + BEYOND:
        return None
    return (u**ones * v**others) @ surface, distance


def place_words(place: Array) -> str:
    """Return a place in words."""
    return f"({', '.join(f'{one:.4g}' for one in place)})"


@lru_cache(maxsize=8)
def facets_of(mesh: SolidMesh, face: str) -> Facets:
    """Return the facets of a face."""
    faces, corners = mesh.face(face), len(mesh.element_kind.faces[0])
    nodes = mesh.nodes[faces.nodes]
    apart = np.abs(np.einsum("fni,fi->fn", nodes - nodes[:, :1], faces.normal)).max(axis=1)
    triangles = []
    for second in range(1, corners - 1):
        first, along, across = nodes[:, 0], nodes[:, second] - nodes[:, 0], nodes[:, second + 1] - nodes[:, 0]
        unit = (TRIANGLE if corners == 3 else SQUARE)[[0, second, second + 1]]
        triangles.append(Triangles(first, along, across, np.cross(along, across), unit))
    powers = OF_TRIANGLE if corners == 3 else OF_SQUARE
    places = 0.5 * powers
    # The shape functions of elements of first and second order are these powers on a facet.
    inverse = np.linalg.inv(np.prod(places[:, None, :] ** powers, axis=2))
    size, surface = np.sqrt(faces.area), np.zeros((len(faces.area), len(powers), 3))
    curved = apart > CURVED * size
    for number in np.flatnonzero(curved).tolist():
        surface[number] = inverse @ on_facet(mesh, mesh.faces[face][number], places)[0]
    return Facets(faces.normal, size, curved, surface, powers, tuple(triangles))
