"""Places of bodies at rest, determined from contacts and connections."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import Array, in_space
from .bodies import BodyPoint
from .connections import ends
from .contact import PointContact


@dataclass(frozen=True, eq=False)
class Joint:
    """Two points that touch or are joined.

    Attributes
    ----------
    first, second : BodyPoint
        The points; the second is None if the first touches a rigid track.
    away : ndarray, shape (3,)
        Offset at rest of the first from the second, or from the origin of the world [m].
    """

    first: BodyPoint
    second: BodyPoint | None
    away: Array


def touched_at_rest(contact: PointContact) -> BodyPoint | None:
    """Return the point that a contact touches at rest, None for a rigid track."""
    return contact.touched_point if contact.path_body is None else BodyPoint(contact.path_body, contact.at)


def joints_of(system: Any) -> Iterator[Joint]:
    """Yield the contacts of a system and its connections between two points."""
    for contact in system.contacts:
        normal, tangent = contact.frame[:2]
        along = 0.0 if contact.rigid_track is None else contact.at
        yield Joint(contact.tip, touched_at_rest(contact), in_space(along * tangent + contact.gap * normal))
    for first, *second in map(ends, system.connections):
        for other in second:
            yield Joint(first, other, np.zeros(3))


def origins_of(
    joints: Iterator[Joint],
    thing: Callable[[BodyPoint], Any],
    offset: Callable[[BodyPoint], Array],
    known: dict[Any, Array],
) -> dict[Any, Array]:
    """Return the places of all things connected by joints [m], shape (3,) each.

    Parameters
    ----------
    joints : iterator of Joint
        The joints. Without any known place, the first thing touched is at the origin of the world.
    thing : callable
        Takes a point and returns the thing to which it belongs: its body, or the point itself.
    offset : callable
        Takes a point and returns its place relative to that of its thing [m], shape (3,).
    known : dict
        Places known in advance [m].
    """
    found, left = dict(known), list(joints)
    while left:
        # A group without a joint to a placed thing starts at the place that it would have alone.
        ready = (
            k
            for k, one in enumerate(left)
            if one.second is None or {thing(one.first), thing(one.second)} & found.keys()
        )
        joint = left.pop(next(ready, 0) if found else 0)
        away = joint.away + (0.0 if joint.second is None else offset(joint.second)) - offset(joint.first)
        if joint.second is None:
            found.setdefault(thing(joint.first), away)
        elif thing(joint.first) in found:
            found.setdefault(thing(joint.second), found[thing(joint.first)] - away)
        else:
            found[thing(joint.first)] = found.setdefault(thing(joint.second), np.zeros(3)) + away
    return found


def origins_in_space(system: Any) -> dict[Any, Array]:
    """Return the world places of the origins of the bodies of a system in space [m], shape (3,) each.

    The origin of bodies with places in the world is the origin of the world. Bodies that touch them, or are joined to
    them by springs and dashpots, are placed beside them, and so on. If no body has a place in the world, the track of
    the first contact is at the origin. For bodies without places or offsets of their points, the keys are these points.
    """
    joints = list(joints_of(system))
    points = [point for joint in joints for point in (joint.first, joint.second) if point is not None]
    known = {point.body: np.zeros(3) for point in points if point.place is not None}

    def has_points(point: BodyPoint) -> bool:
        return point.body in known or hasattr(point.body, "offset")

    def offset(point: BodyPoint) -> Array:
        body: Any = point.body
        if not has_points(point):
            return np.zeros(3)
        return np.asarray(point.place if body in known else body.offset(point.position))

    return origins_of(iter(joints), lambda point: point.body if has_points(point) else point, offset, known)
