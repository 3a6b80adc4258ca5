"""Squeal surveys: growing modes of sliding over parameters, and their fates in time."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from ..checks import ArgumentError, by_key, count, finite, instance, one_or_each, positive, within
from ..scenarios.quantities import quantity
from ..version import __version__
from .computed import Plan, Watcher, check_options, computed
from .fates import Options
from .mode_derivatives import keys_of
from .points import Grid, LatinHypercube, Values, laid_out, plain_python
from .sources import SystemOf, Varying, varying
from .survey_task import SurveyTask
from .surveyed import check_names, surveyed
from .task import Outcome
from .values_by_key import value_of

# Number of points computed together; each needs several runs.
POINTS_OF_A_PART = 1


def squeal_survey(
    scenario: str | Path | xr.Dataset | SystemOf,
    points: Grid | LatinHypercube | Mapping[str, Values] | Sequence[Mapping[str, Any]],
    *,
    overrides: Mapping[str, Any] | None = None,
    duration: float | str | None = None,
    longest: float | str = 1.0,
    amplitude: float = 1e-3,
    resolution: float = 0.1,
    highest: float | str | None = None,
    velocity: float | Sequence[float] | None = None,
    cycles: bool = True,
    kicks: int = 1,
    by: Sequence[str] = (),
    sample_rate: float | str | None = None,
    out: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    watchers: Sequence[Watcher] = (),
    progress: bool = False,
) -> xr.Dataset:
    """Find the growing modes of steady sliding over parameters, and simulate each in time to its fate.

    At each point linear theory finds the equilibrium and its complex modes, as `sliding_stability` does at the start,
    with the contact points of the loaded system. For each growing mode a run starts in this equilibrium, perturbed by
    the mode, and lasts until its limit cycle is found by `limit_cycle` or steady. A run without the mode, from the same
    start, is subtracted to measure growth. Where no mode grows, the smallest kick that starts a squeal is searched.
    Starts defined by the scenario are ignored, except for statuses and slip velocity of its initial equilibrium.

    Points are computed and kept as those of a `sweep`; each is a separate part.

    Parameters
    ----------
    scenario : str, Path, xarray.Dataset or callable
        A scenario, or a function that makes a system from values by name, as for `sweep`. Its duration is ignored.
    points : Grid, LatinHypercube, mapping or sequence of mapping
        Values by key, as for `sweep`.
    overrides : mapping, optional
        Values of other keys, the same at every point.
    duration : float or str, optional
        Time of each run [s]. If left out, it follows from the growth rate: the time for the mode to grow to its reach,
        five times the inverse of the growth rate, and two windows of 100 periods or 0.1 s; then it is doubled until the
        limit cycle is steady.
    longest : float or str, optional
        Longest time of a run whose duration is left out [s].
    amplitude : float, optional
        Initial amplitude of the mode over its reach [1], below 0.1. The reach is the displacement at which
        a contact opens, stops, sticks, slips or lands by linear theory.
    resolution : float, optional
        Largest distance of a tone from its mode, relative to the mode's frequency [1].
    highest : float or str, optional
        Modes above this frequency [Hz] are counted, but not simulated.
    velocity : float or sequence of float, optional
        Slip velocity where nothing prescribes it [m/s], as for `sliding_stability`.
    cycles : bool, optional
        Whether limit cycles at the ends of runs are searched directly, unless `duration` is given. Where none is found,
        or an unstable one or one of another size, the run goes on until it is steady.
    kicks : int, optional
        Number of decaying modes, those that decay least in a period first, from which a squeal is searched where no
        mode grows, among those that decay by a factor of 150 within `longest`: runs begin with a quarter of the reach
        of the mode, and with more until one squeals, up to eight times the reach; then the smallest kick is found to 1
        %. 0 for none.
    by : sequence of str, optional
        Keys of parameters, as for `mode_sensitivity`, by which frequency and growth rate of the growing modes are
        differentiated at each point.
    sample_rate : float or str, optional
        Samples per second recorded [Hz]; by default that of the scenario, or fewer if enough for the highest mode and
        there is no sound.
    out : str or Path, optional
        NetCDF file to write. Finished points are kept in a folder beside it, ``<out>.parts``; the same call
        resumes from there.
    workers : int, optional
        Points at a time; default: one per processor.
    client : distributed.Client, optional
        Machines that compute the points, in place of this one.
    watchers : sequence of callable, optional
        Called with a `SweepProgress` after each point.
    progress : bool, optional
        Whether a bar on standard error shows how many points are done and how long the others will take.

    Returns
    -------
    xarray.Dataset
        Over the points: ``verdict`` (stable, unstable, held, lifted off, jammed, not built, not started),
        ``equilibrium``, ``equilibria`` (their number in words, as in `sliding_stability`), ``unstable_modes``,
        ``living_modes`` and ``message``; where no mode grows, ``kick`` [m], the smallest displacement of a contact
        point in the mode at ``kicked_mode`` [Hz] from which it squeals, NaN if none was found, ``kick_tone`` [Hz] of
        that squeal, and ``unstable_amplitude`` [m] and ``unstable_frequency`` [Hz] of the unstable cycle between it and
        steady sliding. Over the points and ``mode``, NaN or empty where a mode does not grow: ``frequency`` [Hz] and
        ``growth_rate`` [1/s] by linear theory, ``seen_frequency`` and ``seen_growth_rate`` in the run, ``fate``,
        ``regime``, ``cycle_frequency`` [Hz], ``cycle_stable`` and ``leading_multiplier`` of the limit cycle near the
        end of the run, levels, shares, ``sound_level`` [dB] and more; additionally over ``tone`` the
        tones of the limit cycle and their modes. With `by`, over the points, ``mode`` and ``parameter`` also
        ``d_growth_rate`` [1/s] and ``d_frequency`` [Hz] per unit of the parameter, NaN where there is no derivative,
        and over the points and ``parameter`` its ``parameter_value``, with ``parameter_units`` over ``parameter``. A
        derivative grows without bound where modes merge.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used, or a key is not known, means several places or takes values of another kind.
    ValueError
        If another argument is invalid, a function takes other parameters or fails at both the first and the last
        point, or `out` is another file or that of another survey, which is not changed.
    OSError
        If the file or a part cannot be written; finished parts are kept.
    RuntimeError
        If a part fails on other machines; finished parts are kept.
    """
    check_options(workers, client, watchers, progress)
    instance("cycles", cycles, bool)
    options = Options(
        duration=None if duration is None else _positive("duration", duration, "s"),
        longest=_positive("longest", longest, "s"),
        amplitude=within("amplitude", plain_python(amplitude), 1e-6, 0.1),
        resolution=within("resolution", plain_python(resolution), 0.0, 0.5),
        highest=math.inf if highest is None else _positive("highest", highest, "Hz"),
        cycles=cycles,
        kicks=count("kicks", kicks, low=0),
        velocity=None if velocity is None else one_or_each("velocity", plain_python(velocity), finite),
    )
    rate = None if sample_rate is None else _positive("sample_rate", sample_rate, "Hz")
    plan = _planned(scenario, points, by_key("overrides", overrides), options, rate, keys_of("by", by))
    return computed(plan, out, workers, client, watchers, progress)


def _positive(name: str, given: Any, unit: str) -> float:
    """Return a number above 0 in SI, from a number or a text."""
    try:
        return positive(name, quantity(plain_python(given), unit))
    except ArgumentError as error:
        raise error.renamed(name) from None


def _check_keys(by: Sequence[str], found: Varying) -> None:
    """Raise ScenarioError if a key is not known at the first point; points that cannot be built have messages."""
    values = found.values[0]
    try:
        tables = found.source.tables(values, found.source.scenario(values))
    except ValueError:
        return
    for key in by:
        try:
            value_of(key, tables)
        except ArgumentError as error:
            if error.argument == "parameters" and "0 for" not in error.got:
                raise error.renamed("by") from None


def _planned(
    scenario: Any,
    points: Any,
    overrides: Mapping[str, Any],
    options: Options,
    sample_rate: float | None,
    by: tuple[str, ...],
) -> Plan:
    """Return a checked survey."""
    layout = laid_out(points)
    check_names(layout)
    fixed = {key: plain_python(value) for key, value in overrides.items()}
    rate = {} if sample_rate is None else {"sample_rate": sample_rate}
    # Required by functions without a duration; the runs last as long as their modes need.
    timing = {"duration": options.duration or options.longest, **rate}
    found = varying(scenario, fixed, timing, layout, highest_rate=math.inf)
    asked = vars(options) | {"points": layout.asked, "overrides": fixed, "sample_rate": sample_rate}
    if by:
        _check_keys(by, found)
        asked["by"] = by
    attributes = found.attributes | {
        "stridula_version": __version__,
        "survey": json.dumps(asked, ensure_ascii=False, default=str),
    }

    def labelled(outcomes: Sequence[Outcome]) -> xr.Dataset:
        return surveyed(layout, found.keys, found.values, outcomes, attributes, by)

    return Plan("survey", SurveyTask(found.source, options, by), found.values, POINTS_OF_A_PART, attributes, labelled)
