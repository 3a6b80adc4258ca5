"""Which bodies of a system can be heard."""

from __future__ import annotations

from typing import Any

from ..checks import ArgumentError, listed
from ..system import System
from .free_bodies import bodies_heard
from .plane_sound import check_plane, plane_bodies


def hearable(system: System) -> list[Any]:
    """Return the bodies of a system that `radiate` can hear.

    In space those with a surface, plates and beams among them, in the plane tracks that are flat, and slim beams.
    """
    return bodies_heard(system) if system.is_spatial else plane_bodies(system)


def check_hearable(system: System, surface_rate: float | str | None = None) -> None:
    """Raise ValueError if nothing can be heard of a system.

    Parameters
    ----------
    system : System
        The system.
    surface_rate : float or str, optional
        What is to be recorded of its surfaces, as for `simulate`: maps alone have no sound.
    """
    if not hearable(system):
        names = [system.body_name(body) for body in system.bodies]
        raise ArgumentError("system", "have a body with a surface to be heard", got=f"none of {listed(names)}")
    if not system.is_spatial:
        check_plane(system)
    if surface_rate is not None and not isinstance(surface_rate, str):
        raise ArgumentError("surface_rate", "be left out, or all, to be heard", surface_rate)


def body_named(system: System, name: str) -> Any:
    """Return the body of a name among those that can be heard.

    Raises
    ------
    ValueError
        If none of them has this name.
    """
    known = {system.body_name(body): body for body in hearable(system)}
    if name not in known:
        raise ArgumentError("body", f"be one that can be heard: {listed(list(known)) or 'none'}", name)
    return known[name]
