"""Given statuses and slip velocities of contacts: one for all, or one for each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..bodies import SolidBody
from ..checks import STATUS_WORDS, ArgumentError, choice, finite, one_or_each
from ..system import System
from .structure import SLIDING, Structure

Status = str | Sequence[str]
Velocity = float | Sequence[float]


def given_status(status: Status | None, system: System) -> tuple[str, ...] | None:
    """Return the status of each contact, None if none is given.

    Raises
    ------
    ValueError
        If there is not one for each, or a contact cannot have it.
    """
    if status is None:
        return None
    contacts = system.contacts
    found = one_or_each("status", status, lambda name, word: choice(name, word, STATUS_WORDS), len(contacts))
    each = (found,) * len(contacts) if isinstance(found, str) else found
    for word, contact in zip(each, contacts, strict=True):
        if word == "sticking" and contact.friction.has_state:
            raise ArgumentError(
                "status",
                f"be sliding or separated under {contact.friction.law} friction, which does not stick exactly",
                word,
            )
    return each


def given_velocity(velocity: Velocity | None, structure: Structure, status: Sequence[str] | None = None) -> Array:
    """Return the given slip velocity [m/s] of each contact, 0 where drives and tracks prescribe it.

    Parameters
    ----------
    velocity : float or sequence of float, optional
        Slip velocity [m/s] of the contacts where it is not prescribed, or one for each contact, 0 for the others.
    structure : Structure
        The system.
    status : sequence of str, optional
        Status of each contact; all slide if left out.

    Raises
    ------
    ValueError
        If there is not one for each, or it does not apply to any contact.
    """
    count = len(structure.lines)
    if velocity is None:
        return np.zeros(count)
    words = [SLIDING] * count if status is None else list(status)
    prescribed = structure.prescribed(words)
    takes = np.array([word == SLIDING for word in words]) & (prescribed == 0.0)
    found = one_or_each("velocity", velocity, finite, count)
    asked = np.broadcast_to(np.array(found, dtype=float) != 0.0, count)
    _check_told(structure.system, np.flatnonzero(takes & asked).tolist())
    if not isinstance(found, tuple):
        if not found:
            raise ArgumentError("velocity", "not be 0", velocity)
        if not takes.any():
            raise ArgumentError("velocity", f"be left out: {_why(bool(prescribed.all()))}", velocity)
        return np.where(takes, found, 0.0)
    for k, one in enumerate(found):
        if one and not takes[k]:
            raise ArgumentError(f"velocity[{k}]", f"be 0: {_why(bool(prescribed[k]))}", one)
    return np.array(found)


def _check_told(system: System, numbers: Sequence[int]) -> None:
    """Raise ValueError if points of a surface on a mesh would slide along a tangent that nobody has chosen."""
    for number in numbers:
        one = system.contacts[number]
        touched = one.touched_point
        if one.surface and one.tangent is None and touched is not None and touched.body.kind == SolidBody.kind:
            raise ArgumentError(
                "velocity",
                f"be left out for {one.surface}, whose points would all slide in one direction",
                got="no direction; give its SurfaceContact turning=(axis, origin, speed), or a tangent",
            )


def _why(is_prescribed: bool) -> str:
    return "drives and tracks prescribe the slip" if is_prescribed else "a contact that does not slide has none"
