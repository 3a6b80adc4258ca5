"""Limit cycles: periodic motions, found directly, with their stability."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from math import log10

import numpy as np
import xarray as xr

from ..checks import instance
from ..drives import InitialEquilibrium
from ..integration.bars import bar
from ..integration.contact_solve import GaussSeidel
from ..integration.period_map import MarchEnded
from ..integration.settings import Settings
from ..lowering.schemes import Scheme
from ..records import ModalMotion, Probe
from ..system import System
from .cycle_record import cycle_record, probes_of
from .departures import departure
from .floquet import multipliers_of
from .newton import Found, Tell, closed_orbit
from .starts import Asked, Beginning, beginning_of

# Rate of departure over a period above which a motion is chaotic, and below which it is a torus.
CHAOTIC = 0.05


class NoCycle(RuntimeError):
    """No periodic motion was found near the start; the message has what was found instead."""


def limit_cycle(
    system: System,
    start: xr.Dataset | InitialEquilibrium | None = None,
    *,
    frequency: float | None = None,
    settle: int | None = None,
    tolerance: float = 1e-9,
    scheme: Scheme | None = None,
    step: float | None = None,
    probes: Sequence[Probe] | None = None,
    contact_solve: GaussSeidel | None = None,
    motion: bool = False,
    title: str = "",
    progress: bool = False,
) -> xr.Dataset:
    """Find a periodic motion of a system directly, with its stability.

    The unknowns are the state at one instant and, unless drives prescribe it, the period T. Newton's method makes the
    state after a period, marched as by `simulate` with a fixed number of steps, equal to that at its start; belts and
    turning bodies go on. Each step of the method solves linear equations by products of the derivative with vectors,
    which are marches of a period from states next to it. The result is a motion of the scheme itself to round-off, with
    sticking, sliding and separation, also where it is unstable and no run would find it.

    Parameters
    ----------
    system : System
        The system. Its drives are constant in the end, or have a common period.
    start : xarray.Dataset or InitialEquilibrium, optional
        Start of the search: the end of a record of `simulate`, another cycle, or a mode of linear theory with an
        amplitude. By default the end of a run from the system's own start.
    frequency : float, optional
        Expected frequency of a system without periodic drives [Hz]; by default that of the start: the pitch of the
        record, or the frequency of the mode.
    settle : int, optional
        Periods that are marched before the search: by default 300 without a `start`, else none.
    tolerance : float, optional
        Largest residual: the distance of the motion from itself a period later, relative to its size, both in the norm
        of energy [1].
    scheme : CentralDifference or ExactModal, optional
        Time scheme; the exact modal one if left out.
    step : float, optional
        Longest time step [s], a whole division of the period; by default that of the record, or of a run.
    probes : sequence of probes, optional
        Further quantities to record; by default those of `simulate`, and the displacements of the tip of the first
        contact.
    contact_solve : GaussSeidel, optional
        Settings of the simultaneous solution of several contacts.
    motion : bool, optional
        Whether to record the motion of all bodies, from which `radiate` computes their sound; see `repeat_cycle`.
    title : str, optional
        Title of the record.
    progress : bool, optional
        Whether to show a bar on standard error with the steps of the method, the residual and the periods marched.

    Returns
    -------
    xarray.Dataset
        The record of one period, with a sample at every step, as of `simulate`, and

        - ``period`` [s] and ``frequency`` [Hz]; ``residual`` [1];
        - for each kind of probe, such as ``displacement``, ``displacement_amplitude``, half its range, and
          ``displacement_harmonic`` over ``harmonic``, the amplitude of each;
        - ``multiplier``, real and imaginary ``part`` of the Floquet multipliers, the factors of neighbouring motions
          in a period, the largest first: all of them for systems of few modes, else those that are known to 1e-3.
          ``trivial`` marks the one along the cycle, whose distance from 1 is the ``accuracy`` [1] of the others.
          ``stable`` tells whether no neighbouring motion departs, ``attrs["verdict"]`` the same in words.
          ``second_frequency`` [Hz] is that of the largest if it is one of a pair: beyond the unit circle it adds tones
          above and below each harmonic;
        - ``period_energy`` over ``energy_term`` [J]: work of drives and of moving tracks less the losses to friction,
          impacts and damping in a period, and their sum, which is zero up to the residual;
        - ``periods_marched`` in the search, multipliers included, and ``newton_steps``.

    Raises
    ------
    ValueError
        If an argument is out of its range or does not fit the system, if drives have no common period, or if a contact
        travels along a track with ends.
    NoCycle
        If there is no periodic motion near the start; the message tells whether the motion is a torus, with a second
        frequency, or chaos.

    Notes
    -----
    A contact that breaks from sticking under friction that falls with speed may jump; a jump takes place at a step.
    The residual then stays near the part of a period that a step is; give a larger `tolerance`, or a smaller `step`.
    """
    instance("system", system, System)
    settings = Settings(scheme=scheme, step=step, probes=probes, contact_solve=contact_solve)  # type: ignore[arg-type]
    asked = Asked(start, settings, frequency, settle, tolerance)
    asked.check()
    instance("motion", motion, bool)
    if motion:
        settings = replace(settings, probes=(*probes_of(system, settings), *map(ModalMotion, system.bodies)))
    with _told(progress, title or "limit cycle", tolerance) as tell:
        return recorded_cycle(system, replace(asked, settings=settings), tell, title)


def recorded_cycle(system: System, asked: Asked, tell: Tell, title: str = "") -> xr.Dataset:
    """Return the record of a periodic motion near a start, as of `limit_cycle`.

    Raises
    ------
    NoCycle
        If there is none.
    """
    found, is_driven = cycle_near(system, asked, tell)
    multipliers = multipliers_of(found.best, is_driven)
    return cycle_record(system, found.best, multipliers, asked.settings, title, len(found.residuals) - 1)


def cycle_near(system: System, asked: Asked, tell: Tell) -> tuple[Found, bool]:
    """Return a periodic motion near a start, and whether drives prescribe its period.

    Raises
    ------
    NoCycle
        If there is none.
    """
    try:
        begun = beginning_of(system, asked)
        found = closed_orbit(
            begun.of_period, begun.vectors, begun.orbit, begun.is_driven, asked.tolerance, tell, most=asked.most
        )
    except MarchEnded as error:
        raise NoCycle(f"no cycle: {error} within a period near the start") from None
    if not found.is_periodic:
        raise NoCycle(_what_was_found(begun, found))
    return found, begun.is_driven


@contextmanager
def _told(progress: bool, title: str, tolerance: float) -> Iterator[Tell]:
    """Yield a function that shows the steps of the method, the residual and the periods marched."""
    instance("progress", progress, bool)
    if not progress:
        yield lambda step, residual, marched: None
        return
    with bar(title, asked=True) as show:
        first = 0.0

        def tell(step: int, residual: float, marched: float) -> None:
            nonlocal first
            first = first or residual
            whole = max(log10(first / tolerance), 1.0)
            done = min(max(log10(first / max(residual, tolerance)), 0.0), whole)
            show(done, whole, f"step {step}, residual {residual:.1e}, {marched:.0f} periods marched")

        yield tell


def _what_was_found(begun: Beginning, found: Found) -> str:
    """Return what a search without result found, in words."""
    best = found.best
    words = (
        f"no cycle near the start: {found.reason}; after {best.of_period.counter.marched:.0f} periods marched the "
        f"motion comes back to {best.residual:.2g} of its size in {best.orbit.period:.6g} s, at the start to "
        f"{found.residuals[0]:.2g}"
    )
    try:
        rate = departure(begun.of_period, begun.vectors, begun.orbit) * begun.orbit.period
    except MarchEnded:
        return words
    factor = np.exp(min(rate, 700.0))
    if rate > CHAOTIC:
        return f"{words}; the motion at the start is chaotic: neighbours part by a factor of {factor:.2g} in a period"
    if rate > -CHAOTIC:
        return f"{words}; the motion at the start is a torus or settles slowly: neighbours neither part nor meet"
    return f"{words}; neighbours of the motion at the start meet: let it settle for longer"
