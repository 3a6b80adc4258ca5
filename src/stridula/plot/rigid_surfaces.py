"""Surfaces to draw for rigid bodies in space: the hull of their points, or a small ball."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ..arrays import Array
from ..bodies import BodyPoint
from ..bodies.drawn_surfaces import DrawnSurface
from ..connections import ends
from ..system import System

# Radius of the ball for a rigid body whose points enclose no volume, as a share of the extent of the others.
BALL = 0.03
# Points of a ball.
POINTS = 80
# Angle about the axis from one point to the next, the golden angle [rad].
GOLDEN = np.pi * (3.0 - np.sqrt(5.0))


def rigid_surfaces(system: System, others: Iterable[DrawnSurface]) -> dict[Any, DrawnSurface]:
    """Return the surfaces of the rigid bodies that touch, or are joined to, a point whose place is known.

    A rigid body that has a surface counts as a known place for the next one.

    Parameters
    ----------
    system : System
        A system in space.
    others : iterable of DrawnSurface
        Surfaces of the other bodies, which set the scale of the balls.
    """
    radius = BALL * float(np.ptp(np.concatenate([surface.place for surface in others]), axis=0).max())
    found: dict[Any, DrawnSurface] = {}
    for body, (centre, away) in _placed(system).items():
        points = np.array(list(body.points.values())).reshape(-1, 3)
        # A ball touches the other body and does not penetrate it.
        polygons, offsets = _hull(points, radius * (_ball() + away))
        found[body] = DrawnSurface(centre + offsets, polygons, body.shapes_at(offsets))
    return found


def centres_of(system: System) -> dict[Any, Array]:
    """Return where the centres of these rigid bodies are [m], by the body."""
    return {body: centre for body, (centre, _) in _placed(system).items()}


def _placed(system: System) -> dict[Any, tuple[Array, Array]]:
    """Return centres of rigid bodies, and the direction from what each touches first."""
    found: dict[Any, tuple[Array, Array]] = {}

    def known(point: BodyPoint) -> Array | None:
        body: Any = point.body
        return found[body][0] + body.offset(point.position) if body in found else point.place

    left = [one for one in _joined(system) if hasattr(one[0].body, "shapes_at")]
    while ready := [one for one in left if one[0].body not in found and known(one[1]) is not None]:
        ours, other, away = ready[0]
        body: Any = ours.body
        found[body] = np.asarray(known(other)) - body.offset(ours.position), away
    return found


def _joined(system: System) -> Iterator[tuple[BodyPoint, BodyPoint, Array]]:
    """Yield both points of each contact and connection and the normal away from the second, then the reverse."""
    for contact in system.contacts:
        if contact.touched_point is not None:
            normal = np.array(contact.normal or (0.0, 0.0, 0.0))
            normal = normal / (np.linalg.norm(normal) or 1.0)
            yield contact.tip, contact.touched_point, normal
            yield contact.touched_point, contact.tip, -normal
    for first, *second in map(ends, system.connections):
        for other in second:
            yield first, other, np.zeros(3)
            yield other, first, np.zeros(3)


def _hull(points: Array, ball: Array) -> tuple[Array, Array]:
    """Return triangles of a convex hull, with outward orientation, and its corners; a ball where there is no hull."""
    try:
        hull = ConvexHull(np.vstack([points, np.zeros(3)]))
    except (QhullError, ValueError):
        hull = ConvexHull(ball)
    used, triangles = np.unique(hull.simplices, return_inverse=True)
    corners, triangles = hull.points[used], triangles.reshape(-1, 3)
    first, second, third = corners[triangles].transpose(1, 0, 2)
    inward = np.einsum("pi,pi->p", np.cross(second - first, third - first), hull.equations[:, :3]) < 0.0
    triangles[inward] = triangles[inward, ::-1]
    return triangles, corners


def _ball() -> Array:
    """Return points spread over the unit sphere."""
    height = 1.0 - (2.0 * np.arange(POINTS) + 1.0) / POINTS
    angle, across = GOLDEN * np.arange(POINTS), np.sqrt(1.0 - height**2)
    return np.column_stack([across * np.cos(angle), height, across * np.sin(angle)])
