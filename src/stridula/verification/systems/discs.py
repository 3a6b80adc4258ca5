"""A disc held at its bore and a thin ring, both of steel, that turn round and that nothing touches."""

from __future__ import annotations

from typing import Any

from ...bodies import AxisymmetricBody, Held, Material, RectangleProfile, RigidBody
from ...contact import PointContact
from ...drives import Force
from ...histories import Sampled
from ...system import System

STEEL = Material(2.1e11, 7850.0, 0.3)
PLATE = RectangleProfile({"disc": ((0.03, 0.15), (0.0, 0.01))})
# A place on the face of the disc, and one on top of the ring: radius [m], angle [rad], height [m].
HERE = (0.14, 0.3, 0.01)
ON_THE_RING = (0.088, 0.0, 0.02)
# Half the duration of a blow [s], and its force in time, a triangle of 1.
HALF = 2e-4
BLOW = Sampled((0.0, HALF, 2.0 * HALF), (0.0, 1.0, 0.0))


def disc(turning: float = 0.0, cutoff: float = 4000.0, **words: Any) -> AxisymmetricBody:
    """Return the disc, its modes below a cutoff [Hz]."""
    return AxisymmetricBody(PLATE, STEEL, cutoff, "inner", turning=turning, **words)


def ring(turning: float) -> AxisymmetricBody:
    """Return a free ring of 176 mm."""
    middle, thickness = 0.088, 0.00088
    section = (middle - thickness / 2.0, middle + thickness / 2.0), (0.0, 0.02)
    return AxisymmetricBody(RectangleProfile({"ring": section}), STEEL, 900.0, Held("bottom", "z"), turning=turning)


def untouched(body: AxisymmetricBody, *forces: Force, place: tuple[float, float, float] = HERE) -> System:
    """Return the system of one of them under forces, with a mass a metre above a place."""
    apart = RigidBody(1.0)
    contact = PointContact(apart.centre, body.at(place), gap=1.0, normal=(0.0, 0.0, 1.0))
    return System(contact, forces)


def struck(turning: float, **words: Any) -> tuple[System, AxisymmetricBody]:
    """Return the disc struck at a place along its axis, and its body."""
    plate = disc(turning, **words)
    return untouched(plate, Force(plate.at(HERE), z=1.0, history=BLOW)), plate
