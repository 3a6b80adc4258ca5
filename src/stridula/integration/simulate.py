"""Simulation of a system: check the arguments, flatten, march, label."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import xarray as xr

from ..checks import ArgumentError
from ..system import System
from .bars import time_shown
from .marches import March
from .preparation import Preparation
from .settings import Given, settings_of, shows_settings
from .stops import Diverged, Interrupted
from .together import march_together
from .watchers import Watcher


@shows_settings
def simulate(
    system: System,
    duration: float,
    *,
    start: xr.Dataset | None = None,
    watchers: Sequence[Watcher] = (),
    title: str = "",
    progress: bool = False,
    **settings: Unpack[Given],
) -> xr.Dataset:
    """Simulate a system in time and return its record.

    Parameters
    ----------
    system : System
        System to simulate; initially at rest unless a drive or `start` sets another state.
    duration : float
        Time to simulate [s], rounded to whole sample intervals.
    **settings
        Settings of the run.
    start : xarray.Dataset, optional
        A record to continue; the new record begins at its end. Bodies, contact point, gap, probes, scheme, step and
        sampling must be the same; friction, drives and the motion of rigid tracks may change. A belt continues from its
        present position.
    watchers : sequence of callable, optional
        Called with the `Progress` between chunks of the march.
    title : str, optional
        Title of the record.
    progress : bool, optional
        Whether to show a bar on standard error with the simulated time, the speed and the time left, in terminals,
        notebooks and logs.

    Returns
    -------
    xarray.Dataset
        Forces (means over each sample interval), contact, energies and probes over ``time`` [s], with units and
        meanings in the attributes. ``attrs["ended"]`` is ``finished`` or ``off the track``; ``attrs["scenario"]`` is
        TOML that repeats the run. ``attrs["notes"]`` has, separated by semicolons, the parts that the model describes
        only roughly: bending with waves under six thicknesses, bodies that turn near a critical speed, contacts that
        vibrate near a cutoff, contacts and tracks without friction. Normal forces are compressive, tangential forces
        act on the track along its tangent.
        Variables of the contact have the dimension ``contact`` if there are several. Each surface is one contact,
        unless `surface_rate` is ``"all"``: forces and counts are sums over its points, all other variables are means;
        ``surface_force`` and the other resultants of `analysis.surface` are over ``face``; variables that begin with
        ``map_``, means over the interval, are over ``map_time`` [s] and ``point``; without a `surface_rate`, those that
        begin with ``point_`` are over ``time`` and ``point``, in reduced precision.

    Raises
    ------
    ValueError
        If an argument is out of its range, such as a step at or beyond the limit of the scheme.
    Interrupted
        On Ctrl-C, with the record so far.
    Diverged
        If the result is not valid: the state is not finite, contact forces did not converge, energy was created, or
        the step is too long for a nonlinear spring. The message has the time, the last state of the contacts and the
        likely cause; the exception has the record so far.
    """
    asked = settings_of("simulate", settings)
    if not isinstance(watchers, Sequence):
        raise ArgumentError("watchers", "be a list of callables", watchers)
    preparation = Preparation(duration, asked)
    with time_shown(progress, title or "simulate") as more:
        run = preparation.run(preparation.arrays(system), start, title)
        march = March([run.blocks], [run.state], run.timing.step, run.timing.ratio, asked.solve)
        interrupted = march_together([run], march, [*watchers, *more])
    record = run.record(interrupted)
    if interrupted:
        raise Interrupted(record)
    if run.has_diverged:
        raise Diverged(record, run.why_diverged())
    return record
