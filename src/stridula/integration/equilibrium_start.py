"""Start of a system, as flat arrays, in the equilibrium of an `InitialEquilibrium`."""

from __future__ import annotations

from dataclasses import replace

from ..linear.equilibrium import AT_LEAST_ONE, SEVERAL
from ..linear.starts import start_of
from ..lowering import Assembly
from ..system import System


def note_of_start(system: System) -> list[str]:
    """Return a note if a system started in one of several equilibria, or if there may be others."""
    start = system.kept.get("start")
    if start is None:
        return []
    words = {SEVERAL: "several equilibria exist", AT_LEAST_ONE: "other equilibria may exist"}
    return [f"start: {words[start.equilibria]}"] if start.equilibria in words else []


def in_equilibrium(system: System, arrays: Assembly) -> Assembly:
    """Return a system in the equilibrium of its `InitialEquilibrium`, with other initial drives added.

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
        friction_state=start.friction_state,
    )
