"""The outer surface of a meshed body as points: faces of one element alone, each cut into patches."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse

from ..arrays import Array
from .body_surfaces import PointSurface, inscribed_radius
from .solid_elements import shape_functions
from .solid_kinds import ElementKind, outer_faces

if TYPE_CHECKING:
    from .solid_mesh import SolidMesh

# Side of a patch over the radius of the ball that fits into most of the body, and over the largest part for sound.
PATCH_OF_BALL, PATCH_OF_PART = 1.0, 0.8
# Points that a surface has, about, at most.
MOST = 1000
# Points at which thickness is looked for, about.
SAMPLES = 300


def cut_faces(mesh: SolidMesh, shapes: Array, largest: float) -> PointSurface:
    """Return points all over the outer surface, as fine as sound and thickness ask for.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh.
    shapes : ndarray, shape (nodes, 3, modes)
        Displacements of the nodes.
    largest : float
        Largest part of the surface for sound [m].
    """
    coarse = _cut(mesh, shapes[:, :, :0], largest)
    some = slice(None, None, max(1, len(coarse.areas) // SAMPLES))
    ball = float(np.median(inscribed_radius(coarse.points[some], coarse.normals[some], coarse.points)))
    least = float(np.sqrt(coarse.areas.sum() / MOST))
    size = max(least, min(PATCH_OF_BALL * ball, PATCH_OF_PART * largest))
    found = _cut(mesh, shapes, size)
    return found if len(found.areas) <= 2 * MOST else _merged(found, least)


def _cut(mesh: SolidMesh, shapes: Array, size: float) -> PointSurface:
    """Return the middles of patches whose sides are about as long as a size."""
    kind, found = mesh.element_kind, []
    for element, side in outer_faces(kind, mesh.elements):
        nodes = mesh.elements[element]
        ends = mesh.nodes[nodes[list(kind.faces[side])]]
        lengths = np.linalg.norm(ends - np.roll(ends, -1, axis=0), axis=1)
        lengths = np.maximum(lengths[:2], lengths[2:]) if len(ends) == 4 else lengths.max(keepdims=True)
        counts = tuple(np.maximum(1, np.round(lengths / size)).astype(int).tolist())
        values, slopes, first, second, area = _patches(kind, int(side), counts)
        jacobian = np.einsum("pni,nj->pij", slopes, mesh.nodes[nodes])
        vectors = area * np.cross(np.einsum("i,pij->pj", first, jacobian), np.einsum("i,pij->pj", second, jacobian))
        areas = np.linalg.norm(vectors, axis=1)
        normals = vectors / areas[:, None]
        found.append(
            (values @ mesh.nodes[nodes], normals, areas, np.einsum("pn,nxm,px->pm", values, shapes[nodes], normals))
        )
    return PointSurface(*(np.concatenate(one) for one in zip(*found, strict=True)))


def _merged(surface: PointSurface, size: float) -> PointSurface:
    """Return one point for all that lie in a cube of a size and face the same way."""
    facing = np.abs(surface.normals).argmax(axis=1)
    sign = np.take_along_axis(surface.normals, facing[:, None], axis=1)[:, 0] > 0.0
    cubes = np.floor(surface.points / size).astype(np.int64)
    _, which = np.unique(np.column_stack([cubes, facing, sign]), axis=0, return_inverse=True)
    share = scipy.sparse.csr_array((surface.areas, (which.ravel(), np.arange(which.size))))
    areas = np.asarray(share.sum(axis=1))
    points, normals, shapes = (
        share @ one / areas[:, None] for one in (surface.points, surface.normals, surface.shapes)
    )
    return PointSurface(points, normals / np.linalg.norm(normals, axis=1)[:, None], areas, shapes)


@lru_cache(maxsize=256)
def _patches(kind: ElementKind, side: int, counts: tuple[int, ...]) -> tuple[Array, Array, Array, Array, float]:
    """Return the patches of a face of the unit element.

    Shares of the nodes in their middles, their slopes, the two sides of the face, and the area of a patch.
    """
    corners = kind.nodes[list(kind.faces[side])]
    first, second = corners[1] - corners[0], corners[-1] - corners[0]
    if len(corners) == 4:
        one, other = counts
        u, v = (part.ravel() for part in np.meshgrid((np.arange(one) + 0.5) / one, (np.arange(other) + 0.5) / other))
        area = 1.0 / (one * other)
    else:
        # Triangles that stand and triangles on their heads.
        (count,) = counts
        i, j = (one.ravel() for one in np.meshgrid(np.arange(count), np.arange(count)))
        up, down = i + j < count, i + j < count - 1
        u = np.concatenate([i[up] + 1.0 / 3.0, i[down] + 2.0 / 3.0]) / count
        v = np.concatenate([j[up] + 1.0 / 3.0, j[down] + 2.0 / 3.0]) / count
        area = 0.5 / count**2
    values, slopes = shape_functions(kind, corners[0] + u[:, None] * first + v[:, None] * second)
    return values, slopes, first, second, area
