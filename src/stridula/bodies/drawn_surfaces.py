"""Outer surfaces of bodies in space: polygons, and how modes move their corners."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .profile_mesh import ProfileMesh
from .solid_kinds import outer_faces
from .solid_mesh import SolidMesh


@dataclass(frozen=True, eq=False)
class DrawnSurface:
    """The surface of a body as polygons.

    Attributes
    ----------
    place : ndarray, shape (points, 3)
        World places of the corners at rest [m].
    polygons : ndarray of int, shape (polygons, corners)
        Corners of each, round its outward normal.
    shapes : ndarray, shape (points, 3, modes)
        World displacement of each corner for unit modes [kg^(-1/2)].
    """

    place: Array
    polygons: Array
    shapes: Array

    @property
    def normals(self) -> Array:
        """Outward unit normals of the polygons at rest, shape (polygons, 3); zero of one without an area."""
        corners = self.place[self.polygons]
        # Seen from a corner the products do not cancel.
        apart = corners - corners[:, :1]
        vectors = np.cross(apart, np.roll(apart, -1, axis=1)).sum(axis=1)
        size = np.linalg.norm(vectors, axis=1, keepdims=True)
        return np.asarray(vectors / np.where(size > 0.0, size, 1.0))


def surface_of_mesh(mesh: SolidMesh, shapes: Array) -> DrawnSurface:
    """Return the faces of elements that no other element shares, with the middles of their edges.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh.
    shapes : ndarray, shape (3 nodes, modes)
        Shapes of the modes at its nodes.
    """
    kind = mesh.element_kind
    corners = len(kind.faces[0])
    element, side = outer_faces(kind, mesh.elements).T
    outer = mesh.elements[element[:, None], kind.face_nodes[side]]
    if kind.middles:
        # Round the face: corner, middle of the next edge, corner.
        outer = np.stack([outer[:, :corners], outer[:, corners : 2 * corners]], axis=2).reshape(len(outer), -1)
    used, polygons = np.unique(outer, return_inverse=True)
    moved = shapes.reshape(len(mesh.nodes), 3, -1)[used]
    return DrawnSurface(mesh.nodes[used], polygons.reshape(outer.shape), moved)


def surface_of_revolution(
    mesh: ProfileMesh,
    angles: Array,
    at: Callable[[float, Array, float], tuple[Array, Array]],
) -> DrawnSurface:
    """Return the outline of a profile swept round the axis.

    Parameters
    ----------
    mesh : ProfileMesh
        Its cells.
    angles : ndarray, shape (angles,)
        Rising angles of a whole turn, its end left out [rad].
    at : callable
        World places, shape (angles, 3), and shapes of the modes, shape (angles, 3, modes), at r, angles and z.
    """
    used, sides = np.unique(mesh.outline, return_inverse=True)
    first, second = sides.reshape(-1, 2).T
    found = [at(float(r), angles, float(z)) for r, z in mesh.nodes[used]]
    count = len(angles)
    here, there = np.arange(count), np.roll(np.arange(count), -1)
    start, end = count * first[:, None], count * second[:, None]
    # The profile is to the left of its outline.
    polygons = np.stack([start + here, start + there, end + there, end + here], axis=2).reshape(-1, 4)
    on_axis = mesh.nodes[mesh.outline][..., 0].max(axis=1) <= 0.0
    return DrawnSurface(
        np.concatenate([place for place, _ in found]),
        polygons[~np.repeat(on_axis, count)],
        np.concatenate([shapes for _, shapes in found]),
    )
