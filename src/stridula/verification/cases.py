"""All cases, and those that wait for what the package does not have yet."""

from __future__ import annotations

from . import falling, frequencies, impacts, instabilities, jams, laws, orders, sensations, sliders, stability
from .case import Case

CASES: tuple[Case, ...] = (
    *sliders.CASES,
    *falling.CASES,
    *instabilities.CASES,
    *stability.CASES,
    *impacts.CASES,
    *jams.CASES,
    *laws.CASES,
    *frequencies.CASES,
    *orders.CASES,
    *sensations.CASES,
)

WAITING = (
    "Frequencies of the simply supported plate: wait for a plate",
    "Radiation of the baffled plate (Wallace 1972), the baffled piston and the baffled monopole: wait for radiation",
)
