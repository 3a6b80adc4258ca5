"""Directions of sliding before a run, from the descriptions alone: no modes are computed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..cards import spoken
from ..contact import PointContact
from ..system import System

# Velocities that may be due to rounding, relative to the largest.
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Sliding:
    """Sliding of the tip of a contact on its track.

    Attributes
    ----------
    way : ndarray, shape (2,) or (3,)
        World components of its direction, a unit vector.
    words : str
        Speed, empty if only forces push the tip in that direction.
    """

    way: Array
    words: str


def sliding_of(contact: PointContact, system: System) -> Sliding | None:
    """Return the sliding of a contact from prescribed velocities, else initial ones, else forces on the tip.

    None if it does not slide, or if that is unknown.
    """
    for found, after in ((_prescribed(contact, system), ""), (_at_start(contact, system), " at the start")):
        speed = float(np.linalg.norm(found))
        if speed > 0.0:
            return Sliding(found / speed, f"{spoken(speed, 'm/s')}{after}")
    pushed = _along(contact, _pushes(contact.tip.body, system))
    size = float(np.linalg.norm(pushed))
    return Sliding(pushed / size, "") if size > 0.0 else None


def _along(contact: PointContact, vector: Array) -> Array:
    """Return the part of a vector along the tangents of a contact, without rounding."""
    tangents = contact.frame[1:]
    along = np.asarray(tangents.T @ (tangents @ vector[: len(contact.frame)]))
    return along if np.linalg.norm(along) > ROUND_OFF * np.linalg.norm(vector) else np.zeros_like(along)


def _prescribed(contact: PointContact, system: System) -> Array:
    """Return the prescribed velocity of the tip relative to the track [m/s]."""
    size, tangents = len(contact.frame), contact.frame[1:]
    against = np.zeros(size)
    imposed = system.imposed_velocity
    if imposed is not None:
        for body, sign in ((contact.tip.body, 1.0), (contact.track_body, -1.0)):
            against[0] += sign * imposed.velocity * (body is not None and system.is_held(body))
    against += contact.tip.turning_velocity[:size]
    if contact.touched_point is not None:
        against -= contact.touched_point.turning_velocity[:size]
    if contact.circle is not None:
        against += contact.circle.velocity * tangents[0]
    moved = contact.surface_velocities
    track = contact.rigid_track
    if track is not None:
        moved = track.velocity or track.acceleration, track.lateral_velocity
    against -= tangents.T @ np.array(moved)[: len(tangents)]
    return _along(contact, against)


def _at_start(contact: PointContact, system: System) -> Array:
    """Return the initial velocity of the tip relative to the track [m/s]."""
    against = np.zeros(3)
    for drive in system.drives:
        if drive.uniform_velocity is not None:
            for body, sign in ((contact.tip.body, 1.0), (contact.track_body, -1.0)):
                against += sign * drive.uniform_velocity * (drive.acted_on == body)
    return _along(contact, against)


def _pushes(body: Any, system: System) -> Array:
    """Return the sum of the forces on a body [N], shape (3,), including its weight if its mass is available."""
    found = np.zeros(3)
    for drive in system.drives:
        if drive.push is not None and drive.push[1].body == body:
            found += drive.push[2]
        if drive.fall is not None and getattr(body, "has_mass_at_hand", True):
            found += drive.fall * body.total_mass
    return found
