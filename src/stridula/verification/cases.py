"""All cases, and those that wait for what the package does not have yet."""

from __future__ import annotations

from . import falling, frequencies, impacts, instabilities, jams, laws, orders, plates, radiation, sliders
from .case import Case

CASES: tuple[Case, ...] = (
    *sliders.CASES,
    *falling.CASES,
    *instabilities.CASES,
    *impacts.CASES,
    *jams.CASES,
    *laws.CASES,
    *frequencies.CASES,
    *plates.CASES,
    *orders.CASES,
    *radiation.CASES,
)

WAITING = (
    "Sliding stability of the paper's pair and its onsets: wait for eigenvalues of the sliding pair",
    "Loudness of 1 kHz at 40 dB: waits for loudness",
)
