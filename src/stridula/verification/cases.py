"""All cases."""

from __future__ import annotations

from . import (
    clockwork,
    falling,
    frequencies,
    impacts,
    indentation,
    instabilities,
    jams,
    laws,
    linings,
    open_air,
    orders,
    partial_slip,
    plates,
    radiation,
    sensations,
    sliders,
    sounding_spheres,
    space,
    stability,
    strings,
    surfaces,
    turning,
)
from .case import Case

CASES: tuple[Case, ...] = (
    *sliders.CASES,
    *falling.CASES,
    *instabilities.CASES,
    *stability.CASES,
    *impacts.CASES,
    *indentation.CASES,
    *linings.CASES,
    *partial_slip.CASES,
    *jams.CASES,
    *laws.CASES,
    *clockwork.CASES,
    *frequencies.CASES,
    *plates.CASES,
    *strings.CASES,
    *space.CASES,
    *surfaces.CASES,
    *turning.CASES,
    *orders.CASES,
    *radiation.CASES,
    *open_air.CASES,
    *sounding_spheres.CASES,
    *sensations.CASES,
)
