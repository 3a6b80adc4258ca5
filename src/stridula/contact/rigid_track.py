"""A rigid track: floor, wall, belt, disc or shaken plane, flat or with a profile."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..checks import instance
from ..declared import Acceleration, Velocity, check_declared
from ..histories import HISTORIES, Constant, Harmonic, History, Ramp, Sampled
from .profile import Profile


@dataclass(frozen=True)
class RigidTrack:
    """An endless rigid plane, fixed or moving with a prescribed velocity or acceleration.

    Along its tangent it moves at ``velocity`` times its history. If an ``acceleration`` is given, the history applies
    to it, and ``velocity`` is the initial one: a shaken belt, or the ground of an accelerogram. The same holds along
    its normal.

    Parameters
    ----------
    velocity : float, optional
        Velocity along its tangent [m/s], as of a belt or a disc; initial velocity if an acceleration is given.
    normal_velocity : float, optional
        Velocity along its normal, towards the tip [m/s], as of a shaken plane; initial velocity if an acceleration is
        given.
    history, normal_history : Constant, Ramp, Harmonic or Sampled, optional
        Factors over time on the velocities, or on the accelerations if these are given.
    name : str, optional
        Name in records.
    lateral_velocity : float, optional
        Velocity along its second tangent [m/s], in space, with the history of `velocity`.
    acceleration : float, optional
        Acceleration along its tangent [m/s²].
    normal_acceleration : float, optional
        Acceleration along its normal, towards the tip [m/s²], as of shaken ground.
    profile : Profile, optional
        Height of its surface over the place along its tangent, in its material; flat if left out.
    """

    kind: ClassVar[str] = "rigid"
    velocity: Velocity = 0.0
    normal_velocity: Velocity = 0.0
    history: Constant | Ramp | Harmonic | Sampled = field(default_factory=Constant)
    normal_history: Constant | Ramp | Harmonic | Sampled = field(default_factory=Constant)
    name: str = ""
    lateral_velocity: Velocity = 0.0
    acceleration: Acceleration = 0.0
    normal_acceleration: Acceleration = 0.0
    profile: Profile | None = None

    def __post_init__(self) -> None:
        check_declared(self)
        instance("history", self.history, HISTORIES)
        instance("normal_history", self.normal_history, HISTORIES)
        instance("name", self.name, str)
        if self.profile is not None:
            instance("profile", self.profile, Profile)

    @property
    def words(self) -> str:
        """The track in a few words."""
        return "a rigid track" if self.profile is None else "a rigid track with a profile"

    @property
    def is_still(self) -> bool:
        """Whether it does not move."""
        moving = self.velocity or self.normal_velocity or self.lateral_velocity
        return not (moving or self.acceleration or self.normal_acceleration)

    def travel(self, time: Array) -> Array:
        """Return the distance moved along its tangent [m]."""
        return _travel(self.velocity, self.acceleration, self.history, time)

    def lateral_travel(self, time: Array) -> Array:
        """Return the distance moved along its second tangent [m]."""
        return _travel(self.lateral_velocity, 0.0, self.history, time)

    def lateral_speed(self, time: Array) -> Array:
        """Return its velocity along its second tangent [m/s]."""
        return _speed(self.lateral_velocity, 0.0, self.history, time)

    def normal_travel(self, time: Array) -> Array:
        """Return the distance moved along its normal, towards the tip [m]."""
        return _travel(self.normal_velocity, self.normal_acceleration, self.normal_history, time)

    def speed(self, time: Array) -> Array:
        """Return its velocity along its tangent [m/s]."""
        return _speed(self.velocity, self.acceleration, self.history, time)

    def normal_speed(self, time: Array) -> Array:
        """Return its velocity along its normal, towards the tip [m/s]."""
        return _speed(self.normal_velocity, self.normal_acceleration, self.normal_history, time)


def _travel(velocity: float, acceleration: float, history: History, time: Array) -> Array:
    if acceleration:
        return np.asarray(velocity * time + acceleration * history.second_integral(time))
    return np.asarray(velocity * history.integral(time))


def _speed(velocity: float, acceleration: float, history: History, time: Array) -> Array:
    if acceleration:
        return np.asarray(velocity + acceleration * history.integral(time))
    return np.asarray(velocity * history.factor(time))
