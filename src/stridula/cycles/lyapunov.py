"""The largest Lyapunov exponent of the motion that a system settles to."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import xarray as xr

from ..analysis.stability import sliding_stability
from ..arrays import Array
from ..checks import ArgumentError, count, instance
from ..drives import InitialEquilibrium
from ..integration.bars import bar
from ..integration.contact_solve import GaussSeidel
from ..integration.period_map import MarchEnded
from ..integration.settings import Settings
from ..lowering.schemes import Scheme
from ..records.variables import described
from ..system import System
from .departures import growths
from .starts import Asked, Beginning, beginning_of

# Blocks of periods from which the error follows, and the share of all periods in which directions settle.
BLOCKS, SETTLING = 20, 0.2
# Errors by which an exponent differs from zero.
SURE = 3.0


def lyapunov_exponent(
    system: System,
    start: xr.Dataset | InitialEquilibrium | None = None,
    *,
    frequency: float | None = None,
    settle: int | None = None,
    periods: int = 400,
    scheme: Scheme | None = None,
    step: float | None = None,
    contact_solve: GaussSeidel | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Return the largest Lyapunov exponent of the motion that a system settles to, with its standard error.

    It is the rate at which neighbouring motions depart from each other: above zero in chaos, zero for cycles and tori
    whose phase is free, below zero for equilibria and for stable cycles of driven systems. By Benettin's method: a
    neighbour is marched like the motion itself, with the same exact contact, and brought back to its first distance,
    1e-6 of the motion, after each period.

    Parameters
    ----------
    system : System
        The system. Its drives are constant in the end, or have a common period.
    start : xarray.Dataset or InitialEquilibrium, optional
        Start of the motion: the end of a record of `simulate`, a cycle of `limit_cycle`, or a mode of linear theory
        with an amplitude. By default the end of a run from the system's own start.
    frequency : float, optional
        Inverse of the period after which neighbours are brought back, for systems without periodic drives [Hz]; by
        default that of the start: the pitch of the record, or the frequency of the mode. It has no effect on the
        exponent.
    settle : int, optional
        Periods of the transient that are marched before: by default 300 without a `start`, else none.
    periods : int, optional
        Periods over which departure is measured, at least 40, after a fifth as many in which the direction of the
        neighbour settles.
    scheme : CentralDifference or ExactModal, optional
        Time scheme; the exact modal one if left out.
    step : float, optional
        Longest time step [s], a whole division of the period; by default that of the record, or of a run.
    contact_solve : GaussSeidel, optional
        Settings of the simultaneous solution of several contacts.
    progress : bool, optional
        Whether to show a bar on standard error with the periods marched and the exponent so far.

    Returns
    -------
    xarray.Dataset
        ``exponent`` [1/s] and ``error`` [1/s], its standard error from the means of 20 blocks,
        at least the inverse of the duration: a factor of e over the whole time is not resolved; ``block_exponent``
        [1/s] over ``block``, which shows whether the motion had settled; ``period`` [s] and ``duration`` [s], the time
        over which it is measured. ``attrs["verdict"]`` says in words whether neighbours depart, by 3 errors.
        Where neighbours meet exactly, as bodies that stick do, the exponent is minus infinity and the error NaN.

    Raises
    ------
    ValueError
        If an argument is out of its range or does not fit the system, if drives have no common period, or if a contact
        travels along a track with ends.
    RuntimeError
        If a march ends, as when its contact forces are not found.
    """
    instance("system", system, System)
    count("periods", periods, low=2 * BLOCKS)
    instance("progress", progress, bool)
    settings = Settings(scheme=scheme, step=step, contact_solve=contact_solve)  # type: ignore[arg-type]
    asked = Asked(start, settings, frequency, settle)
    asked.check()
    try:
        begun = _begun(system, asked)
        grown = _grown(begun, periods, progress)
    except MarchEnded as error:
        raise RuntimeError(f"no exponent: {error} within a period") from None
    return _dataset(grown, periods, begun.orbit.period)


def _begun(system: System, asked: Asked) -> Beginning:
    """Return the motion whose neighbours are marched; without a pitch, in periods of the mode that decays slowest."""
    try:
        return beginning_of(system, asked)
    except ArgumentError as error:
        if error.argument != "frequency":
            raise
        slowest = _slowest(system)
        if slowest is None:
            raise
        return beginning_of(system, replace(asked, frequency=slowest))


def _slowest(system: System) -> float | None:
    """Return the frequency [Hz] of the mode about the equilibrium that decays slowest, None without any."""
    try:
        modes = sliding_stability(system)
    except ValueError:
        return None
    found = modes.isel(mode=modes["frequency"].values > 0.0)
    return float(found["frequency"][int(found["growth_rate"].values.argmax())]) if found.sizes["mode"] else None


def _grown(begun: Beginning, periods: int, progress: bool) -> Array:
    """Return the logarithmic growth in each period that is measured; fewer if neighbours meet."""
    settling = round(SETTLING * periods)
    every = islice(growths(begun.of_period, begun.vectors, begun.orbit), settling + periods)
    if not progress:
        return np.array(list(every)[settling:])
    found: list[float] = []
    with bar("Lyapunov exponent", asked=True) as show:
        for one in every:
            found.append(one)
            rate = np.mean(found[settling:] or found) / begun.orbit.period
            show(len(found), settling + periods, f"{len(found)} of {settling + periods} periods, {rate:.4g} 1/s")
    return np.array(found[settling:])


def _dataset(grown: Array, periods: int, period: float) -> xr.Dataset:
    have_met = len(grown) < periods
    blocks = np.full(BLOCKS, -np.inf)
    if not have_met:
        blocks = np.array([one.mean() for one in np.array_split(grown, BLOCKS)]) / period
    exponent = -np.inf if have_met else float(grown.mean()) / period
    # Less than a factor of e over the whole time is not resolved: the norm itself varies along the motion.
    error = np.nan if have_met else max(float(blocks.std(ddof=1)) / np.sqrt(BLOCKS), 1.0 / (periods * period))
    found = xr.Dataset(
        {
            "exponent": ((), exponent, described("1/s", "largest Lyapunov exponent")),
            "error": ((), error, described("1/s", "standard error of the exponent")),
            "block_exponent": ("block", blocks, described("1/s", "exponent over a part of the time")),
            "period": ((), period, described("s", "time after which neighbours are brought back")),
            "duration": ((), periods * period, described("s", "time over which departure is measured")),
        }
    )
    return found.assign_attrs(verdict=_verdict(exponent, error))


def _verdict(exponent: float, error: float) -> str:
    if np.isinf(exponent):
        return "neighbours meet exactly: they stick, or are stopped, at the same place"
    if abs(exponent) < SURE * error:
        return "neighbours neither depart nor meet: a cycle or a torus whose phase is free"
    if exponent > 0.0:
        return f"chaos: neighbours depart by a factor of e in {1.0 / exponent:.4g} s"
    return f"stable: neighbours meet by a factor of e in {-1.0 / exponent:.4g} s"
