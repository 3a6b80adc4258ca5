"""Intersections of flat faces of two meshes, and points of integration on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError
from .places import FacePoints

if TYPE_CHECKING:
    from .solid_mesh import Face, SolidMesh

# Largest deviation from 1 of the cosine between normals of flat faces.
FLAT = 1e-9
# Largest area of a piece, relative to that of a face, that is due to rounding.
NOTHING = 1e-9
# Points of integration of a triangle, exact for polynomials of second degree.
_SHARES = np.array([(4.0, 1.0, 1.0), (1.0, 4.0, 1.0), (1.0, 1.0, 4.0)]) / 6.0


def overlaid(first: Face, first_mesh: SolidMesh, second: Face, second_mesh: SolidMesh) -> FacePoints:
    """Return points of integration on the pieces of faces that overlap those of another mesh.

    Raises
    ------
    ValueError
        If faces are not flat, or if a part of the first is not opposite the other.
    """
    normal = first.area @ first.normal
    normal = normal / np.linalg.norm(normal)
    if max(np.abs(1.0 - first.normal @ normal).max(), np.abs(1.0 + second.normal @ normal).max()) > FLAT:
        raise ArgumentError("overlay", "be False where faces are not flat and parallel", True)
    frame = np.linalg.svd(normal[None])[2]
    # Counter-clockwise seen against the normal.
    frame = frame if np.linalg.det(frame) * (frame[0] @ normal) > 0.0 else frame * np.array([[1.0], [1.0], [-1.0]])
    height = float(np.mean(first_mesh.nodes[first.nodes] @ normal))
    ours, theirs = (_flat(face, mesh, frame[1:]) for face, mesh in ((first, first_mesh), (second, second_mesh)))
    places, areas = [], []
    for face, polygon in zip(range(len(ours)), ours, strict=True):
        covered = 0.0
        for other in theirs:
            piece = _clipped(polygon, other)
            for k in range(1, len(piece) - 1):
                triangle = piece[[0, k, k + 1]]
                area = 0.5 * _cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
                if area > NOTHING * first.area[face]:
                    covered += area
                    places.append(_SHARES @ triangle @ frame[1:] + height * normal)
                    areas += [area / 3.0] * 3
        if covered < (1.0 - 1e-6) * first.area[face]:
            share = 1.0 - covered / first.area[face]
            raise ArgumentError(
                "track_face", "lie opposite the whole face", got=f"{share:.1%} of face {face} opposite nothing"
            )
    found = np.concatenate(places)
    return FacePoints(found, np.array(areas), np.tile(normal, (len(found), 1)))


def _flat(face: Face, mesh: SolidMesh, axes: Array) -> list[Array]:
    """Return the corners of faces in a plane, counter-clockwise."""
    corners = mesh.nodes[face.nodes[:, : len(mesh.element_kind.faces[0])]] @ axes.T
    found = []
    for one in corners:
        around = sum(_cross(a, b) for a, b in zip(one, np.roll(one, -1, axis=0), strict=True))
        found.append(one if around > 0.0 else one[::-1])
    return found


def _clipped(polygon: Array, window: Array) -> Array:
    """Return the part of a convex polygon within another one (Sutherland & Hodgman 1974)."""
    for start, end in zip(window, np.roll(window, -1, axis=0), strict=True):
        polygon = half(polygon, np.array([_cross(end - start, one - start) for one in polygon]))
    return polygon


def half(polygon: Array, inside: Array) -> Array:
    """Return the part of a convex polygon on one side of a line, from signed distances of its corners, inside above 0.

    Corners may have further columns, which are linear along the sides.
    """
    kept = []
    for k in range(len(polygon)):
        before, here = float(inside[k - 1]), float(inside[k])
        if before * here < 0.0:
            kept.append(polygon[k - 1] + before / (before - here) * (polygon[k] - polygon[k - 1]))
        if here >= 0.0:
            kept.append(polygon[k])
    return np.array(kept).reshape(-1, polygon.shape[1])


def _cross(first: Array, second: Array) -> float:
    return float(first[0] * second[1] - first[1] * second[0])
