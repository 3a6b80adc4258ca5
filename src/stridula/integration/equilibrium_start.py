"""A system as flat arrays whose start is the equilibrium that a drive asks for."""

from __future__ import annotations

from dataclasses import replace

from ..linear.starts import start_of
from ..lowering import Assembly
from ..system import System


def in_equilibrium(system: System, arrays: Assembly) -> Assembly:
    """Return a system in the equilibrium that an `InitialEquilibrium` asks for, other initial drives added to it.

    Raises
    ------
    ValueError
        If there is no such equilibrium.
    """
    asked = system.initial_equilibrium
    if asked is None:
        return arrays
    if "start" not in system.kept:
        system.kept["start"] = start_of(system, asked)
    start = system.kept["start"]
    return replace(
        arrays,
        position=arrays.position + start.position,
        velocity=arrays.velocity + start.velocity,
        friction_state=start.friction_state[arrays.contact_numbers, (~arrays.firsts).astype(int)],
    )
