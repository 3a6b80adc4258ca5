"""Checks of the connections of a system."""

from __future__ import annotations

from typing import Any

from .checks import ArgumentError
from .connections import elements_of, ends, held_motions
from .connections.elements import Motion

# Relative size of a component of a direction that is round-off.
NONE = 1e-12


def check_connections(system: Any) -> None:
    """Raise ArgumentError unless every connection of a system acts, and on bodies that it may act on."""
    tracks = [contact.path_body or contact.track_body for contact in system.contacts if _moves_along(contact)]
    for number, connection in enumerate(system.connections):
        name, bodies = f"connections[{number}]", [point.body for point in ends(connection)]
        motions = [one.motion for one in elements_of(connection)] + list(held_motions(connection))
        if not system.is_spatial:
            _check_plane(name, connection, motions)
        for body in bodies:
            _check_body(name, system.body_name(body), body, motions)
            if system.is_held(body) and (held_motions(connection) or any(abs(one.way[0]) > NONE for one in motions)):
                words = "not act along x on a body under an imposed velocity, which prescribes its x"
                raise ArgumentError(name, words, got=str(connection))
            if held_motions(connection):
                _check_yields(name, system, connection)
            if body in tracks and held_motions(connection):
                words = "not be a rigid joint of a body along which a contact moves; a stiff spring may join it"
                raise ArgumentError(name, words, got=f"one to {system.body_name(body)}")


def _check_yields(name: str, system: Any, joint: Any) -> None:
    """Raise if a rigid joint takes its flexibility from the contacts of a body, which does not yield at its place.

    A mass joined to a single place rides on the flexibility that the body has.
    """
    joints = [{point.body for point in ends(one)} for one in system.connections if held_motions(one)]
    points = ends(joint)
    for point, other in zip(points, reversed(points), strict=True):
        body: Any = point.body
        is_mass = getattr(other.body, "is_lumped", False) and sum(other.body in one for one in joints) == 1
        if not (is_mass and len(points) > 1) and not getattr(body, "yields_at", lambda _: True)(point.position):
            words = f"be at points at which {system.body_name(body)} yields: name them in its {body.yields_by}"
            raise ArgumentError(name, words, got=f"one at ({point.label})")


def _moves_along(contact: Any) -> bool:
    return contact.path_body is not None or contact.circle is not None


def _check_plane(name: str, connection: Any, motions: list[Motion]) -> None:
    """Raise if a connection acts where nothing moves in the plane: along z, or about x or y."""
    acts = [(abs(one.way[2]) > 1.0 - NONE) == one.turns for one in motions]
    if not (any(acts) if held_motions(connection) else all(acts)):
        words = "act along x and y and about z alone where no body is in space"
        raise ArgumentError(name, words, got=str(connection))


def _check_body(name: str, called: str, body: Any, motions: list[Motion]) -> None:
    """Raise if a connection cannot act on a body."""
    turning = getattr(body, "turning", None)
    if getattr(turning, "velocity", turning):
        raise ArgumentError(name, "not act on a body that turns", got=f"one to {called}")
    if any(one.turns for one in motions) and not getattr(body, "has_rotations", False):
        words = "act on rotations only of beams and of rigid bodies with an inertia; join others at several points"
        raise ArgumentError(name, words, got=f"one to {called}, a {body.kind}")
