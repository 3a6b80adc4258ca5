"""The error of contacts that hold the same motion twice, with the ways out."""

from __future__ import annotations

from collections.abc import Sequence

from ..checks import ArgumentError, listed
from ..contact import PointContact
from ..system import System

ELASTIC = "use elastic bodies or another status"


def held_twice(system: System, contacts: Sequence[int]) -> ArgumentError:
    """Return the error of contacts, given by their numbers, whose forces are undetermined; surfaces are named once."""
    held = [(system.contacts[k], system.contact_names[k]) for k in contacts]
    names = list(dict.fromkeys(one.surface or name for one, name in held))
    ways = dict.fromkeys(_way_out(one) for one, _ in held if one.surface)
    return ArgumentError(
        "contacts",
        "not hold the same motion twice, which leaves forces undetermined",
        contacts,
        got=f"{listed(names)}; {listed(ways or [ELASTIC], ' or ')}",
    )


def _way_out(contact: PointContact) -> str:
    """Return what to change at a point of a surface: its stiffness, or the flexibility that its body keeps there."""
    body = contact.tip.body
    if getattr(body, "cutoff", None) is None or getattr(body, "contact_faces", True):
        return "give the SurfaceContact a stiffness"
    return "give the SurfaceContact a stiffness, or name its face in contact_faces of the body"
