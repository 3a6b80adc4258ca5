"""Masses that friction acts on in two directions: thrown along a slope, and swinging across a slip."""

from __future__ import annotations

from math import atan, cos, sin, sqrt

from ...bodies import RigidBody
from ...connections import Spring
from ...contact import Coulomb, PointContact, RigidTrack
from ...drives import Force, Gravity, InitialVelocity
from ...system import System

GRAVITY, FRICTION, THROWN = 9.81, 0.5, 1.0
SLOPE = atan(FRICTION)
MASS, STIFFNESS, PRESSED, SPEED = 8.0, 315.0, 1.0, 10.0
# Damping ratio of swinging across the slip, as closed form and as printed by Ansys VM274.
RATIO = FRICTION * PRESSED / (2.0 * SPEED * sqrt(STIFFNESS * MASS))
PRINTED_RATIO = 0.000498012


def thrown_on_a_slope() -> System:
    """Return a particle thrown horizontally on a slope whose tangent is the coefficient of friction; downhill is -z."""
    mass = RigidBody(1.0)
    weight = Gravity(GRAVITY, direction=(0.0, -cos(SLOPE), -sin(SLOPE)))
    contact = PointContact(mass.centre, RigidTrack(), friction=Coulomb(FRICTION))
    return System(contact, [weight, InitialVelocity(mass, x=THROWN)])


def swinging(direction: tuple[float, float] = (1.0, 0.0), across: float = 0.0) -> System:
    """Return 8 kg on springs of 315 N/m along both tangents, pressed with 1 N on a belt at 10 m/s.

    Parameters
    ----------
    direction : tuple of float, optional
        Direction of the slip along both tangents, of length 1.
    across : float, optional
        Velocity along the second tangent at the start [m/s].
    """
    mass = RigidBody(MASS)
    belt = RigidTrack(velocity=-SPEED * direction[0], lateral_velocity=-SPEED * direction[1])
    contact = PointContact(mass.centre, belt, friction=Coulomb(FRICTION))
    springs = [Spring(mass.centre, stiffness=STIFFNESS, direction=way) for way in ("x", "z")]
    start = [InitialVelocity(mass, z=across)] if across else []
    return System(contact, [Force(mass.centre, y=-PRESSED), *start], springs)
