"""Bodies of a system that can be heard."""

from __future__ import annotations

from typing import Any

from ..checks import ArgumentError, listed
from ..system import System
from .free_bodies import bodies_heard
from .plane_sound import check_plane, plane_bodies

# Ends of runs that can be heard.
WHOLE = ("finished", "off the track")


def hearable(system: System) -> list[Any]:
    """Return the bodies of a system whose sound `radiate` can compute.

    In space these have a surface, plates and beams among them; in the plane they are flat tracks and slim beams.
    """
    return bodies_heard(system) if system.is_spatial else plane_bodies(system)


def check_hearable(system: System, surface_rate: float | str | None = None) -> None:
    """Raise ValueError if no body of a system can be heard.

    Parameters
    ----------
    system : System
        The system.
    surface_rate : float or str, optional
        Rate of the maps of its surfaces, as for `simulate`: a record of maps alone has no sound.
    """
    if not hearable(system):
        names = [system.body_name(body) for body in system.bodies]
        raise ArgumentError(
            "system", "have a body with a surface, which radiates sound", got=f"none of {listed(names)}"
        )
    if not system.is_spatial:
        check_plane(system)
    if surface_rate is not None and not isinstance(surface_rate, str):
        raise ArgumentError("surface_rate", "be left out, or all, for sound", surface_rate)


def why_silent(system: System, surface_rate: float | str | None = None) -> str:
    """Return the reason why a system cannot be heard, in words; empty if it can.

    Parameters
    ----------
    system : System
        The system.
    surface_rate : float or str, optional
        As for `check_hearable`.
    """
    if not hearable(system):
        return "no body of the system radiates sound"
    try:
        check_hearable(system, surface_rate)
    except ArgumentError as error:
        return f"{error.argument} must {error.allowed}"
    return ""


def body_named(system: System, name: str) -> Any:
    """Return the body of a name among those that can be heard.

    Raises
    ------
    ValueError
        If none of them has this name.
    """
    known = {system.body_name(body): body for body in hearable(system)}
    if name not in known:
        raise ArgumentError("body", f"be a body that radiates sound: {listed(list(known)) or 'none'}", name)
    return known[name]
