"""Limit cycles near the end of a run, found directly."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import xarray as xr

from ..checks import ArgumentError
from ..cycles.limit_cycle import NoCycle, recorded_cycle
from ..cycles.starts import Asked
from ..integration.settings import Settings
from ..records import Probe
from ..scenarios.load import Scenario

# Periods marched after which the search takes no further step.
MOST = 500.0


def cycle_after(
    scenario: Scenario, run: xr.Dataset, frequency: float, probes: Sequence[Probe], watch: Callable[[], None]
) -> xr.Dataset | None:
    """Return the limit cycle near the end of a run, as of `limit_cycle`; None if none is found.

    Parameters
    ----------
    scenario : Scenario
        System of the run, and settings of its simulation.
    run : xarray.Dataset
        The run.
    frequency : float
        Expected frequency [Hz].
    probes : sequence of probes
        Quantities to record.
    watch : callable
        Called at each step of the search; an exception that it raises ends it.
    """
    settings = Settings(scheme=scenario.scheme, probes=probes, contact_solve=scenario.contact_solve)
    asked = Asked(run, settings, frequency, None, most=MOST)
    try:
        return recorded_cycle(scenario.system, asked, lambda *_: watch())
    except (NoCycle, ArgumentError):
        # Tips that travel along a track, and drives without a common period, have no cycle.
        return None
