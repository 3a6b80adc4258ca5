"""Motions imposed on contacts, and the descriptions that determine them over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .._kernels.layout import columns as at
from ..arrays import Array
from ..bodies.turning import Turning
from ..contact import PointContact
from ..histories import Constant, History
from ..system import System
from .signals import Signal

# Columns of the motions of the tip and of the track along both tangents.
TIP, TRACK = (at.TIP_MOTION, at.TIP_MOTION_B), (at.TRACK_MOTION, at.TRACK_MOTION_B)


@dataclass(frozen=True)
class Prescribed:
    """Descriptions that determine signals and motions over time: systems with equal ones have the same.

    Attributes
    ----------
    histories : tuple of History
        Histories of the loads.
    velocity : tuple of float and History, or None
        The imposed velocity.
    contacts : tuple
        For each contact its frame, whether its tip and its track are held, its rigid track, and velocities of the
        touched surface.
    turning : tuple of Turning
        Turning of bodies.
    turns : bool
        Whether it continues other motions.
    """

    histories: tuple[History, ...]
    velocity: tuple[float, History] | None
    contacts: tuple[Any, ...]
    turning: tuple[Turning, ...] = ()
    turns: bool = False

    @property
    def is_steady(self) -> bool:
        """Whether nothing varies in time."""
        still = all((track is None or track.is_still) and not any(moved) for *_, track, moved in self.contacts)
        return (
            still
            and not self.turns
            and self.velocity is None
            and all(type(one.history) is Constant for one in self.turning)
            and all(type(history) is Constant for history in self.histories)
        )


def prescribed_of(system: System, histories: tuple[History, ...]) -> Prescribed:
    """Return the descriptions that determine signals and motions of a system over time."""
    contacts = []
    for contact in system.contacts:
        held = system.is_held(contact.tip.body), touches_held(contact, system)
        passing = [speed for turning, speeds in contact.turning_velocities for speed in (turning.history, *speeds)]
        if contact.circle is not None and contact.circle.velocity:
            passing += [contact.circle.history, contact.circle.velocity]
        moved = (*contact.surface_velocities, *passing)
        contacts.append((contact.frame.tobytes(), *held, contact.rigid_track, moved))
    imposed = system.imposed_velocity
    bodies = [body.modes().turning for body in system.bodies if not system.is_held(body)]
    turning = tuple(one for one in bodies if one is not None)
    return Prescribed(histories, (imposed.velocity, imposed.history) if imposed else None, tuple(contacts), turning)


def touches_held(contact: PointContact, system: System) -> bool:
    """Return whether a contact touches a point of a body whose root follows an imposed velocity."""
    return contact.touched_point is not None and system.is_held(contact.touched_point.body)


def motion_of(system: System, imposed: Signal) -> Signal:
    """Return the motions imposed on every contact: by a body under an imposed velocity, by a moving rigid track."""

    alongs = [contact.frame[:, 0].tolist() for contact in system.contacts]
    # Computed once, since locating a point on a body takes long.
    turnings = [contact.turning_velocities for contact in system.contacts]

    def motion(time: Array, step: float) -> Array:
        values = np.zeros((time.size, len(alongs), at.MOTIONS))
        for own, contact, along, passing in zip(
            np.moveaxis(values, 1, 0), system.contacts, alongs, turnings, strict=True
        ):
            normal_x, *tangents_x = along
            held = [(TIP, 1.0)] if system.is_held(contact.tip.body) else []
            held += [(TRACK, -1.0)] if touches_held(contact, system) else []
            for columns, sign in held:
                moved = imposed(time, step)
                for column, tangent_x in zip(columns, tangents_x, strict=False):
                    own[:, column] += tangent_x * moved
                own[:, at.GAP_MOTION] += sign * normal_x * moved
            for column, speed in zip(TRACK, contact.surface_velocities, strict=False):
                if speed:
                    own[:, column] += speed * time
            if contact.circle is not None:
                own[:, at.TIP_MOTION] += contact.circle.travel(time)
            for turning, speeds in passing:
                for column, speed in zip(TRACK, speeds, strict=False):
                    own[:, column] += speed * turning.history.integral(time)
            if contact.rigid_track is not None:
                own[:, at.TRACK_MOTION] += contact.rigid_track.travel(time)
                own[:, at.GAP_MOTION] -= contact.rigid_track.normal_travel(time)
                if contact.is_spatial:
                    own[:, at.TRACK_MOTION_B] += contact.rigid_track.lateral_travel(time)
        return values

    return motion
