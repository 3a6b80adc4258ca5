"""The position on a body, or the plane, opposite a place of a face."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import AxisymmetricBody, SolidBody, SolidMesh
from ..bodies.solids.places import FacePoints
from ..checks import ArgumentError
from .rigid_track import RigidTrack

# Relative tolerance at the ends of a side of a profile, or at the edges of a face.
BEYOND = 1e-9
# The opposite position on the body (None for a plane), the outward normal there, and the distance to it [m].
Met = tuple[Any, Array, float]


def on_plane(track: RigidTrack, _: str, place: Array, normal: Array, points: FacePoints) -> Met:
    """Return the plane through the foremost points of a face, perpendicular to its mean normal."""
    facing = -(points.area @ points.normal)
    facing = facing / np.linalg.norm(facing)
    return None, facing, float(place @ facing - (points.place @ facing).min())


def on_solid(body: SolidBody, face: str, place: Array, normal: Array, _: FacePoints) -> Met:
    """Return the place on a face of a meshed body opposite a place, along the normal there."""
    normals, triangles = _triangles(body.mesh, face)
    best: tuple[float, int] | None = None
    for first, along, across, square in triangles:
        toward = square @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            far = ((first - place) * square).sum(axis=1) / toward
            there = place + far[:, None] * normal - first
            u = (np.cross(there, across) * square).sum(axis=1) / (square**2).sum(axis=1)
            v = (np.cross(along, there) * square).sum(axis=1) / (square**2).sum(axis=1)
        inside = (np.minimum(u, v) >= -BEYOND) & (u + v <= 1.0 + BEYOND) & (np.abs(toward) > 0.0)
        for number in np.flatnonzero(inside).tolist():
            if best is None or abs(far[number]) < abs(best[0]):
                best = float(far[number]), number
    if best is None:
        raise ArgumentError(
            "track_face", "lie opposite the whole face", face, got=f"nothing opposite {words_of(place)}"
        )
    far, number = best
    return (place + far * normal).tolist(), -normal if normals[number] @ normal < 0.0 else normal, far


@lru_cache(maxsize=8)
def _triangles(mesh: SolidMesh, face: str) -> tuple[Array, list[tuple[Array, Array, Array, Array]]]:
    """Return the normals of facets, and one triangle of each at a time: corner, both sides, their product."""
    faces, corners = mesh.face(face), len(mesh.element_kind.faces[0])
    nodes = mesh.nodes[faces.nodes[:, :corners]]
    found = []
    for second in range(1, corners - 1):
        first, along, across = nodes[:, 0], nodes[:, second] - nodes[:, 0], nodes[:, second + 1] - nodes[:, 0]
        found.append((first, along, across, np.cross(along, across)))
    return faces.normal, found


def on_revolution(body: AxisymmetricBody, _: str, place: Array, normal: Array, points: FacePoints) -> Met:
    """Return the position on the surface of a body of revolution opposite a place, along the normal there."""
    frame, mesh = body.frame, body.mesh
    x, y, z = frame @ (place - np.asarray(body.origin))
    r, theta = float(np.hypot(x, y)), float(np.arctan2(y, x))
    directions = np.array([np.cos(theta), np.sin(theta), 0.0]) @ frame, frame[2]
    way = np.array([one @ normal for one in directions])
    start, along = mesh.nodes[mesh.outline[:, 0]], mesh.nodes[mesh.outline[:, 1]] - mesh.nodes[mesh.outline[:, 0]]
    toward = along[:, 0] * way[1] - along[:, 1] * way[0]
    apart = start - np.array([r, z])
    with np.errstate(divide="ignore", invalid="ignore"):
        far = (along[:, 0] * apart[:, 1] - along[:, 1] * apart[:, 0]) / toward
        share = (way[0] * apart[:, 1] - way[1] * apart[:, 0]) / toward
    met = np.flatnonzero((share >= -BEYOND) & (share <= 1.0 + BEYOND) & (np.abs(toward) > 0.0) & np.isfinite(far))
    if not met.size:
        raise ArgumentError("track", "lie opposite the whole face", got=f"nothing opposite {words_of(place)}")
    side = int(met[np.abs(far[met]).argmin()])
    found = start[side] + np.clip(share[side], 0.0, 1.0) * along[side]
    # The profile is to the left of its outline.
    outward = np.array([along[side, 1], -along[side, 0]]) / np.hypot(*along[side])
    facing = outward @ np.stack(directions)
    return (float(found[0]), theta, float(found[1])), facing, float(far[side])


def words_of(place: Array) -> str:
    """Return a place in words."""
    return f"({', '.join(f'{one:.4g}' for one in place)})"


# Functions by the kind of the touched body.
BEFORE: dict[str, Callable[..., Met]] = {
    RigidTrack.kind: on_plane,
    SolidBody.kind: on_solid,
    AxisymmetricBody.kind: on_revolution,
}
