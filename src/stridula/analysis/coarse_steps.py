"""Whether the numbers of a record show that its step is coarse."""

from __future__ import annotations

from collections.abc import Mapping

from ..checks import listed

# A time step is coarse if a cycle, a contact or a stick lasts less than this number of steps.
FEWEST = 10.0


def coarse(found: Mapping[str, float | str], step: float) -> str:
    """Return the events that last few steps in words, nothing if all of them last longer.

    Parameters
    ----------
    found : mapping
        The measures of `regime`: ``frequency``, ``impact_rate``, ``slip_rate``, ``separated`` and ``sticking``.
    step : float
        Time step [s].
    """
    frequency, impacts, slips, separated, sticking = (
        float(found[name]) for name in ("frequency", "impact_rate", "slip_rate", "separated", "sticking")
    )
    # Mean duration of each event [s].
    events = {}
    if frequency > 0.0:
        events["period"] = 1.0 / frequency
    if impacts > 0.0:
        events["contact"] = (1.0 - separated) / impacts
    if slips > 0.0 and sticking > 0.0:
        events["stick"] = sticking / slips
    few = [f"{time / step:.2g} steps in a {name}" for name, time in events.items() if time < FEWEST * step]
    return listed(few) if few else ""
