"""The place on a face of a mesh opposite a given place."""

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
# Steps of Newton's method on a curved facet, and the change of its coordinates at which it ends.
STEPS, ENDS = 20, 1e-13
# Corners of the unit square in the order of those of a facet; a triangle has the first two beside the origin.
SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
TRIANGLE = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])


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
    """Facets of a face: outward normals, whether each is curved, and triangles."""

    normal: Array
    curved: Array
    triangles: tuple[Triangles, ...]


def opposite_place(mesh: SolidMesh, face: str, place: Array, normal: Array) -> tuple[Array, Array, float] | None:
    """Return the place on a face that is nearest along a normal, the normal facing it, and the distance; None if none.

    The distance is negative behind the given place.
    """
    facets = facets_of(mesh, face)
    best: tuple[float, int, Array] | None = None
    for one in facets.triangles:
        toward = one.square @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            far = ((one.first - place) * one.square).sum(axis=1) / toward
            there = place + far[:, None] * normal - one.first
            u = (np.cross(there, one.across) * one.square).sum(axis=1) / (one.square**2).sum(axis=1)
            v = (np.cross(one.along, there) * one.square).sum(axis=1) / (one.square**2).sum(axis=1)
        beyond = np.where(facets.curved, NEAR, BEYOND)
        inside = (np.minimum(u, v) >= -beyond) & (u + v <= 1.0 + beyond) & (np.abs(toward) > 0.0)
        for number in np.flatnonzero(inside).tolist():
            found: tuple[Array, float] | None = (place + far[number] * normal, float(far[number]))
            if facets.curved[number]:
                begin = np.array([1.0 - u[number] - v[number], u[number], v[number]]) @ one.corners
                found = on_curved(mesh, mesh.faces[face][number], place, normal, begin, float(far[number]))
            if found is not None and (best is None or abs(found[1]) < abs(best[0])):
                best = found[1], number, found[0]
    if best is None:
        return None
    distance, number, there = best
    return there, -normal if facets.normal[number] @ normal < 0.0 else normal, distance


def on_curved(
    mesh: SolidMesh, facet: Array, place: Array, normal: Array, begin: Array, far: float
) -> tuple[Array, float] | None:
    """Return where a line through a place meets a curved facet, and its distance; None if it passes beside it."""
    unknowns = np.array([*begin, far])
    for _ in range(STEPS):
        at, first, second, _ = on_facet(mesh, facet, unknowns[None, :2])
        slopes = np.column_stack([first[0], second[0], -normal])
        if not np.linalg.det(slopes):
            return None
        change = np.linalg.solve(slopes, place + unknowns[2] * normal - at[0])
        unknowns += change
        if np.abs(change[:2]).max() < ENDS:
            break
    else:
        return None
    u, v = unknowns[:2]
    corners = len(mesh.element_kind.faces[0])
    if min(u, v) < -BEYOND or max(u, v, u + v if corners == 3 else 0.0) > 1.0 + BEYOND:
        return None
    at, *_ = on_facet(mesh, facet, unknowns[None, :2])
    return at[0], float(unknowns[2])


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
    return Facets(faces.normal, apart > CURVED * np.sqrt(faces.area), tuple(triangles))
