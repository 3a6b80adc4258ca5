"""A system with small changes, on the modes that its bodies already have."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from ..bodies import BodyPoint, PointMass, RigidBody
from ..checks import ArgumentError, instance, positive
from ..connections import Connection, RigidJoint
from ..contact import FrictionLaw, PointContact
from ..system import System


def modify(
    system: System,
    *,
    masses: Iterable[tuple[BodyPoint, float]] = (),
    connections: Sequence[Connection] = (),
    friction: FrictionLaw | Mapping[str, FrictionLaw] | None = None,
    without: Sequence[str] = (),
) -> System:
    """Return a system with added masses and connections, other friction, or fewer contacts.

    Its bodies keep their modes, so that nothing is reduced again: a mass is joined rigidly to its point, and the modes
    below the cutoff move with it.

    Parameters
    ----------
    system : System
        The system.
    masses : sequence of (BodyPoint, float), optional
        Points, and the mass that is bolted to each [kg]. It does not turn.
    connections : sequence of Spring, Dashpot, Bushing, RigidJoint or another connection, optional
        Connections in addition to those of the system.
    friction : FrictionLaw or mapping of str to FrictionLaw, optional
        Law of all contacts, or laws by the name of a contact or of a surface.
    without : sequence of str, optional
        Names of contacts, or of surfaces, that are left out, such as the points of a chamfer.

    Returns
    -------
    System
        The system with the changes; the one given stays as it is.

    Raises
    ------
    ValueError
        If a name is not one of a contact or a surface, nothing is left in contact, or a mass cannot be joined.

    Examples
    --------
    >>> import stridula as st
    >>> mass = st.PointMass(1.0)
    >>> belt = st.System(st.PointContact(mass.centre, st.RigidTrack(velocity=0.5)))
    >>> heavier = st.modify(belt, masses=[(mass.centre, 0.2)])
    >>> len(heavier.bodies)
    2
    """
    instance("system", system, System)
    contact: Any = system.contact
    if friction is not None or without:
        contact = _contacts(system, friction, _names("without", without, system))
    added = [_bolted(number, *one, system) for number, one in enumerate(masses)]
    return System(contact, system.drives, [*system.connections, *added, *connections])


def _bolted(number: int, point: Any, mass: Any, system: System) -> RigidJoint:
    """Return the joint of an added mass to its point."""
    instance(f"masses[{number}][0]", point, BodyPoint)
    positive(f"masses[{number}][1]", mass)
    if point.body not in system.bodies:
        raise ArgumentError(f"masses[{number}][0]", "be on a body of the system", point)
    name = f"mass {number + 1} on {system.body_name(point.body)}"
    lump: Any = RigidBody(mass, name=name) if system.is_spatial else PointMass(mass, name)
    return RigidJoint(lump.centre, point)


def _contacts(system: System, friction: Any, without: set[str]) -> list[PointContact]:
    """Return the contacts that are left, point by point, with their laws."""
    laws = friction if isinstance(friction, Mapping) else dict.fromkeys(_known(system), friction)
    _names("friction", laws, system)
    kept = []
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        law = laws.get(name, laws.get(contact.surface))
        if name not in without and contact.surface not in without:
            kept.append(contact if law is None else replace(contact, friction=law))
    if not kept:
        raise ArgumentError("without", "leave at least one contact", sorted(without))
    return kept


def _known(system: System) -> list[str]:
    return list(dict.fromkeys((*system.contact_names, *(name for name in system.surface_names if name))))


def _names(argument: str, names: Iterable[str], system: System) -> set[str]:
    """Return names of contacts or surfaces as a set."""
    known = _known(system)
    for name in names:
        if name not in known:
            raise ArgumentError(argument, f"name contacts or surfaces ({', '.join(known[:8])})", name)
    return set(names)
