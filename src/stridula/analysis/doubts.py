"""Values of a system that are allowed but probably mistaken, as when the prefix of a unit is left out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..bodies.cards import materials_of
from ..doubtful import doubts_of_size
from ..system import System

MOST_MODES = 5000


def doubts(system: System) -> list[str]:
    """Return a line about each value that is probably a mistake."""
    return [line for body in system.bodies for line in _of(system.body_name(body), body)] + system.doubts


def _of(name: str, body: Any) -> Iterator[str]:
    for region, one in materials_of(body).items():
        whose = f"{name}, {region}" if region else name
        yield from (f"{whose}: {words}" for words in one.doubts)
    yield from (f"{name}: {words}" for words in doubts_of_size(getattr(body, "largest_side", 0.0)))
    if hasattr(body, "section"):
        across = getattr(body.section, "height", getattr(body.section, "diameter", 0.0))
        if across > 0.5 * body.length:
            yield f"{name}: {across:.4g} m thick and {body.length:.4g} m long; beams are slender here"
    if (modes := sum(getattr(body, "harmonics", ()))) > MOST_MODES:
        yield f"{name}: {modes} modes below its cutoff; a lower cutoff is faster"
