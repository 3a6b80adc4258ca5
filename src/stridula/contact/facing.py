"""The position on a body, or the plane, opposite a place of a face."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import AxisymmetricBody, SolidBody
from ..bodies.solids.opposite import opposite_place, place_words
from ..bodies.solids.places import FacePoints
from ..checks import ArgumentError
from .rigid_track import RigidTrack

# Relative tolerance at the ends of a side of a profile.
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
    met = opposite_place(body.mesh, face, place, normal)
    if met is None:
        raise ArgumentError(
            "track_face", "lie opposite the whole face", face, got=f"nothing opposite {place_words(place)}"
        )
    there, facing, far = met
    return there.tolist(), facing, far


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
        raise ArgumentError("track", "lie opposite the whole face", got=f"nothing opposite {place_words(place)}")
    side = int(met[np.abs(far[met]).argmin()])
    found = start[side] + np.clip(share[side], 0.0, 1.0) * along[side]
    # The profile is to the left of its outline.
    outward = np.array([along[side, 1], -along[side, 0]]) / np.hypot(*along[side])
    facing = outward @ np.stack(directions)
    return (float(found[0]), theta, float(found[1])), facing, float(far[side])


# Functions by the kind of the touched body.
BEFORE: dict[str, Callable[..., Met]] = {
    RigidTrack.kind: on_plane,
    SolidBody.kind: on_solid,
    AxisymmetricBody.kind: on_revolution,
}
