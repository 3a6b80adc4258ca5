"""Values of a system that are allowed but probably mistaken, as when the prefix of a unit is left out."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import Any

from ..bodies.cards import materials_of
from ..scenarios.errors import ScenarioError
from ..scenarios.load import load_scenario
from ..system import System
from .exits import GOOD, say

# From soft rubber to diamond [Pa], from foam to osmium [kg/m3].
YOUNG = (1e5, 2e12)
DENSITY = (10.0, 3e4)
# Values above the first are probably in MPa, below the second in t/mm3: aluminium has 7e4 and 2.7e-9.
MEGA, TONNES = 2e3, 1e-6
MOST_MODES = 5000


def doubts(system: System) -> list[str]:
    """Return a line about each value that is probably a mistake."""
    return [line for body in system.bodies for line in _of(system.body_name(body), body)]


def say_doubts(name: str) -> None:
    """Print a line on standard error about each doubtful value of a scenario that can be loaded."""
    # A scenario that cannot be loaded can still be shown; `stridula run` reports why it cannot run.
    with suppress(ScenarioError, OSError):
        for line in doubts(load_scenario(name).system):
            say(f"doubtful: {line}", GOOD)


def _of(name: str, body: Any) -> Iterator[str]:
    for region, one in materials_of(body).items():
        whose = f"{name}, {region}" if region else name
        if not YOUNG[0] <= one.young <= YOUNG[1]:
            unit = "MPa" if MEGA <= one.young < YOUNG[0] else "GPa"
            yield f"{whose}: Young's modulus of {one.young:.4g} Pa; did you mean {unit}?"
        if not DENSITY[0] <= one.density <= DENSITY[1]:
            unit = "t/mm3, as in finite-element programs" if one.density < TONNES else "g/cm3"
            yield f"{whose}: density of {one.density:.4g} kg/m3; did you mean {unit}?"
    if hasattr(body, "section"):
        across = getattr(body.section, "height", getattr(body.section, "diameter", 0.0))
        if across > 0.5 * body.length:
            yield f"{name}: {across:.4g} m thick and {body.length:.4g} m long; beams are slender here"
    if (modes := sum(getattr(body, "harmonics", ()))) > MOST_MODES:
        yield f"{name}: {modes} modes below its cutoff; a lower cutoff is faster"
