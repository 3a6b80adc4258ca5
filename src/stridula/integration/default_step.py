"""The default step, from the time scales of a system alone."""

from __future__ import annotations

import numpy as np

from ..lowering import Assembly
from ..lowering.schemes import Scheme
from ..lowering.stepping import Stepping
from ..lowering.time_scales import fastest_passage, fastest_vibration

# Steps in a period of the fastest vibration of lumped masses on springs and contacts, and of waves of profiles.
PER_PERIOD = 40
# Longest step [s] with lumped masses that do not vibrate, and most steps that it may cause.
LONGEST, MOST_STEPS = 1e-5, 1e7
# Steps below this are whole divisions of it [s], so that they do not depend on the usual sample rates.
DIVIDED = 1e-5


def default_step(arrays: Assembly, scheme: Scheme, duration: float) -> float:
    """Return the longest default step of a system [s]; a run shortens it to a whole division of its sample interval.

    It is the scheme's fraction of its limit for the modes kept, and at most a fortieth of the shortest period of lumped
    masses on their springs and closed contacts, and of waves of profiles that pass under the tips. Impacts and stops of
    masses that do not vibrate have no time scale: with them it is at most 10 µs, unless that takes more than ten
    million steps.
    """
    step = scheme.default_fraction * Stepping(arrays, scheme).limit
    if arrays.lumped.any():
        fastest = fastest_vibration(arrays, duration)
        longest = 2.0 * np.pi / (PER_PERIOD * fastest) if fastest > 0.0 else max(LONGEST, duration / MOST_STEPS)
        step = min(step, longest)
    passage = fastest_passage(arrays, duration)
    if passage > 0.0:
        step = min(step, 2.0 * np.pi / (PER_PERIOD * passage))
    return float(step if step >= DIVIDED else DIVIDED / np.ceil(DIVIDED / step - 1e-9))
