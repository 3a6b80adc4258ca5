"""The outer surface of a meshed body as points: faces of one element only, each cut into patches."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import scipy  # its parts are imported on first use
import scipy.sparse

from ...arrays import Array
from ..body_surfaces import PointSurface, inscribed_radius
from .elements import shape_functions
from .kinds import ElementKind

if TYPE_CHECKING:
    from .solid_mesh import SolidMesh

# Side of a patch over the median radius of inscribed balls, and over the largest part for sound.
PATCH_OF_BALL, PATCH_OF_PART = 1.0, 0.8
# Approximate largest number of points of a surface.
MOST = 1000
# Approximate number of points at which the thickness is measured.
SAMPLES = 300
# Least angle between normals at a sharp edge [rad], and the share of a patch that is cut off along it, as pressures
# vary strongly there.
SHARP, AT_EDGE = 0.25 * np.pi, 0.3


def cut_faces(mesh: SolidMesh, shapes: Array, largest: float) -> PointSurface:
    """Return points all over the outer surface, as fine as sound and thickness require.

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
    """Return the middles of patches with sides of about a given size, finer along sharp edges."""
    kind, found = mesh.element_kind, []
    outer = mesh.outer_faces
    for (element, side), sharp in zip(outer, _sharp_sides(mesh, outer).tolist(), strict=True):
        nodes = mesh.elements[element]
        ends = mesh.nodes[nodes[list(kind.faces[side])]]
        lengths = np.linalg.norm(ends - np.roll(ends, -1, axis=0), axis=1)
        lengths = np.maximum(lengths[:2], lengths[2:]) if len(ends) == 4 else lengths.max(keepdims=True)
        counts = tuple(np.maximum(1, np.round(lengths / size)).astype(int).tolist())
        values, slopes, apart = _patches(kind, int(side), counts, tuple(sharp) if len(ends) == 4 else ())
        jacobian = np.einsum("pni,nj->pij", slopes, mesh.nodes[nodes])
        corners = np.einsum("pci,pij->pcj", apart, jacobian)
        vectors = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        areas = np.linalg.norm(vectors, axis=1)
        normals, middles = vectors / areas[:, None], values @ mesh.nodes[nodes]
        moved = np.einsum("pn,nxm,px->pm", values, shapes[nodes], normals)
        found.append((middles, normals, areas, moved, (middles[:, None] + corners).reshape(-1, 12)))
    return PointSurface(*(np.concatenate(one) for one in zip(*found, strict=True)))


def _sharp_sides(mesh: SolidMesh, outer: Array) -> Array:
    """Return a mask of the sides of outer faces, from a corner to the next, that are sharp edges, (faces, sides)."""
    kind = mesh.element_kind
    element, number = outer.T
    corners = np.array(kind.faces)[number]
    normals = np.empty((*corners.shape, 3))
    for face, ours in enumerate(kind.faces):
        places = kind.nodes[list(ours)]
        _, slopes = shape_functions(kind, 0.5 * (places + np.roll(places, -1, axis=0)))
        jacobian = np.einsum("sni,enj->esij", slopes, mesh.nodes[mesh.elements[element[number == face]]])
        first, second = (np.einsum("i,esij->esj", place - places[0], jacobian) for place in (places[1], places[-1]))
        across = np.cross(first, second)
        normals[number == face] = across / np.linalg.norm(across, axis=2, keepdims=True)
    ends = mesh.elements[element[:, None], corners]
    pairs = np.sort(np.stack([ends, np.roll(ends, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    _, which, times = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    which = which.ravel()
    mean = np.stack([np.bincount(which, one) for one in normals.reshape(-1, 3).T], axis=1) / times[:, None]
    return np.asarray((np.linalg.norm(mean, axis=1) < np.cos(0.5 * SHARP))[which].reshape(corners.shape))


def _merged(surface: PointSurface, size: float) -> PointSurface:
    """Return one point for all points in a cube of a given size that face the same way."""
    facing = np.abs(surface.normals).argmax(axis=1)
    sign = np.take_along_axis(surface.normals, facing[:, None], axis=1)[:, 0] > 0.0
    cubes = np.floor(surface.points / size).astype(np.int64)
    _, which = np.unique(np.column_stack([cubes, facing, sign]), axis=0, return_inverse=True)
    share = scipy.sparse.csr_array((surface.areas, (which.ravel(), np.arange(which.size))))
    areas = np.asarray(share.sum(axis=1))
    points, normals, shapes = (
        share @ one / areas[:, None] for one in (surface.points, surface.normals, surface.shapes)
    )
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    owners = which.ravel()
    # A mean that lies on the patch of another point is replaced by the nearest middle of its own patches.
    astray = np.flatnonzero(owners[scipy.spatial.cKDTree(surface.points).query(points)[1]] != np.arange(len(points)))
    for number in astray.tolist():
        own = np.flatnonzero(owners == number)
        points[number] = surface.points[own[np.linalg.norm(surface.points[own] - points[number], axis=1).argmin()]]
    return PointSurface(points, normals, areas, shapes, surface.corners, owners)


@lru_cache(maxsize=1024)
def _patches(
    kind: ElementKind, side: int, counts: tuple[int, ...], sharp: tuple[bool, ...]
) -> tuple[Array, Array, Array]:
    """Return the patches of a face of the unit element.

    Shape functions at their middles, their slopes, and the corners of the patches relative to their middles, shape
    (patches, 4, 3); the last one twice for triangles.
    """
    corners = kind.nodes[list(kind.faces[side])]
    first, second = corners[1] - corners[0], corners[-1] - corners[0]
    if len(corners) == 4:
        one, other = _cuts(counts[0], sharp[3], sharp[1]), _cuts(counts[1], sharp[0], sharp[2])
        u, v = (part.ravel() for part in np.meshgrid(one[:-1], other[:-1]))
        wide, high = (part.ravel() for part in np.meshgrid(np.diff(one), np.diff(other)))
        ends = np.stack([np.stack([u, u + wide, u + wide, u]), np.stack([v, v, v + high, v + high])])
        middles = ends.mean(axis=1)
    else:
        # Upright triangles and inverted ones.
        (count,) = counts
        i, j = (one.ravel() for one in np.meshgrid(np.arange(count), np.arange(count)))
        up, down = i + j < count, i + j < count - 1
        standing, turned = np.array([[0, 1, 0, 0], [0, 0, 1, 1]]), np.array([[1, 1, 0, 0], [0, 1, 1, 1]])
        places = [np.stack([i, j])[:, those].T[:, :, None] + shape for those, shape in ((up, standing), (down, turned))]
        ends = np.concatenate(places).transpose(1, 2, 0) / count
        middles = ends[:, :3].mean(axis=1)
    values, slopes = shape_functions(kind, corners[0] + np.einsum("ip,ij->pj", middles, np.stack([first, second])))
    apart = np.einsum("icp,ij->pcj", ends - middles[:, None], np.stack([first, second]))
    return values, slopes, apart


def _cuts(count: int, low: bool, high: bool) -> Array:
    """Return the cuts of a side of length 1 into parts; the first and last part are cut in two at sharp edges."""
    cuts = np.arange(count + 1.0)
    return np.unique(np.concatenate([cuts, [AT_EDGE] if low else [], [count - AT_EDGE] if high else []])) / count
