"""Ensembles: runs of one system from slightly different starts, and the means of their measures."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
import scipy.special
import xarray as xr

from ..analysis import status_share
from ..arrays import Array
from ..checks import ArgumentError, brief, by_key, count, instance, positive, within
from ..drives import Drive, InitialVelocity
from ..drives import InitialState as State
from ..integration import simulate_many
from ..system import System

Measure = Callable[[xr.Dataset], float]
MOST_RUNS = 100_000
OWN = ("perturbation", "ended", "message", "run", "bound")


def ensemble(
    system: System | str | Path | xr.Dataset | Callable[..., Any],
    duration: float | None,
    measures: Mapping[str, Measure],
    *,
    overrides: Mapping[str, Any] | None = None,
    runs: int = 8,
    perturbation: float = 1e-6,
    seed: int = 0,
    confidence: float = 0.95,
    workers: int | None = None,
    progress: bool = False,
    **options: Any,
) -> xr.Dataset:
    """Run a system from slightly different starts and return the mean of each measure with its confidence interval.

    Run 0 starts unchanged. The others are perturbed by shares s drawn uniformly from ``-perturbation`` to
    ``perturbation``: if the first contact starts open, its gap becomes ``gap (1 + s)``; if it starts closed or in
    equilibrium, its slider gets the velocity ``s v`` along the track, with v the largest velocity prescribed by drives
    and rigid tracks, or 1 m/s if there is none. A slider that cannot move along the track gets the velocity across it,
    a slider without a known translation gets it in every degree of freedom.

    Parameters
    ----------
    system : System, str, Path, xarray.Dataset or callable
        A system, a scenario as for `load_scenario`, or a function that makes one, as for `sweep`.
    duration : float or None
        Time to simulate [s]; that of the scenario or the function if None.
    measures : mapping
        Functions of a record that return a number, by name. They run in threads.
    overrides : mapping, optional
        Values to set in the scenario by key, or the arguments of the function.
    runs : int, optional
        Number of runs, at least 2.
    perturbation : float, optional
        Largest relative change of the start [1], from 0 to 0.1.
    seed : int, optional
        Seed of the shares: equal seeds give equal ensembles for any number of workers.
    confidence : float, optional
        Level of the interval [1], strictly between 0 and 1.
    workers : int, optional
        Runs at a time; default: one per processor.
    progress : bool, optional
        Whether a bar on standard error shows how far the runs are and how long they will still take.
    **options
        Arguments of `simulate_many` such as `scheme`, `step`, `sample_rate`, `probes` and `device`, in place of those
        of the scenario or the function.

    Returns
    -------
    xarray.Dataset
        For each measure its value over ``run``, its mean ``<name>_mean`` and Student's interval ``<name>_interval``
        over ``bound`` (low, high), both of the finite values; the interval needs at least 2. In addition
        ``perturbation``, ``ended`` and ``message`` over ``run``. A run that diverged has NaN and its message.

    Raises
    ------
    ValueError
        If an argument is out of its range, a measure does not return a number, or a function takes other parameters,
        raises an exception or returns anything else.
    """
    system, duration, options = _made(system, duration, by_key("overrides", overrides), options)
    positive("duration", duration)
    named = _checked(measures)
    count("runs", runs, low=2, high=MOST_RUNS)
    within("perturbation", perturbation, 0.0, 0.1)
    within("confidence", confidence, 0.0, 1.0, ends=False)
    count("seed", seed, low=0)
    if workers is not None:
        count("workers", workers)
    for word in ("start", "watchers", "reduce"):
        if word in options:
            raise ArgumentError(word, "be left out of an ensemble, which sets its own", options[word])
    shares = _shares(runs, perturbation, seed)
    systems = [_perturbed(system, float(share)) for share in shares]
    results = _run_all(systems, duration, named, options | {"progress": progress}, workers or os.cpu_count() or 1)
    return _dataset(named, shares, results, confidence)


def perturbed_starts(system: System, runs: int, perturbation: float = 1e-6, seed: int = 0) -> list[System]:
    """Return copies of a system with the starts of an ensemble, the first unchanged."""
    return [_perturbed(system, float(share)) for share in _shares(runs, perturbation, seed)]


def share_of(status: str, contact: str | None = None) -> Measure:
    """Return a measure: the share of the time in which a contact has a status.

    Parameters
    ----------
    status : {"separated", "sticking", "sliding"}
        Status of the contact.
    contact : str, optional
        Name of the contact if there are several.
    """

    def share(run: xr.Dataset) -> float:
        return status_share(run if contact is None else run.sel(contact=contact), status)

    return share


def mean_and_interval(values: Sequence[float] | Array, confidence: float = 0.95) -> tuple[float, float]:
    """Return the mean of the finite values and the half width of Student's interval, NaN if there are too few.

    Parameters
    ----------
    values : array_like
        The values.
    confidence : float, optional
        Level of the interval [1].
    """
    given = np.asarray(values, dtype=float)
    known = given[np.isfinite(given)]
    if known.size < 2:
        return (float(known[0]) if known.size else float("nan")), float("nan")
    quantile = scipy.special.stdtrit(known.size - 1, 0.5 + confidence / 2.0)
    return float(known.mean()), float(quantile * known.std(ddof=1) / np.sqrt(known.size))


def median_and_interval(values: Sequence[float] | Array, confidence: float = 0.95) -> tuple[float, float, float]:
    """Return the median of the finite values and the ends of its interval, NaN if there are too few.

    Order statistics of the binomial distribution, which make no assumption about the values (Conover 1999, Practical
    Nonparametric Statistics, section 3.2).

    Parameters
    ----------
    values : array_like
        The values.
    confidence : float, optional
        Level of the interval [1].
    """
    given = np.asarray(values, dtype=float)
    known = np.sort(given[np.isfinite(given)])
    nan = float("nan")
    if not known.size:
        return nan, nan, nan
    chances = scipy.special.bdtr(np.arange(known.size + 1), known.size, 0.5)
    below = int(np.searchsorted(chances, (1.0 - confidence) / 2.0))
    low, high = (known[below - 1], known[-below]) if below else (nan, nan)
    return float(np.median(known)), float(low), float(high)


def _made(
    given: Any, duration: float | None, values: Mapping[str, Any], options: dict[str, Any]
) -> tuple[System, Any, dict[str, Any]]:
    """Return the system given or made, its duration, and the other arguments of its simulation."""
    if isinstance(given, System) or not (callable(given) or isinstance(given, (str, Path, xr.Dataset))):
        instance("system", given, System)
        if values:
            raise ArgumentError("overrides", "be left out of an ensemble of a system", dict(values))
        return given, duration, options
    # Imported here because an ensemble of a system needs no scenarios.
    from .sources import made_once

    scenario = made_once(given, values, {} if duration is None else {"duration": duration})
    return scenario.system, scenario.duration, vars(scenario.settings) | options


def _checked(measures: Any) -> dict[str, Measure]:
    instance("measures", measures, Mapping)
    if not measures:
        raise ArgumentError("measures", "hold at least one function of a record", measures, got="none")
    for name, measure in measures.items():
        if not isinstance(name, str) or not name or not callable(measure):
            raise ArgumentError(
                "measures", "be functions of a record by name", name, got=f"{brief(name)}: {brief(measure)}"
            )
    taken = {*OWN, *(f"{name}{end}" for name in measures for end in ("_mean", "_interval"))}
    clash = next((name for name in measures if name in taken), None)
    if clash is not None:
        raise ArgumentError("measures", f"have names other than {', '.join(OWN)} and results of others", clash)
    return dict(measures)


def _shares(runs: int, perturbation: float, seed: int) -> Array:
    shares = np.random.default_rng(seed).uniform(-perturbation, perturbation, runs)
    shares[0] = 0.0
    return shares


def _perturbed(system: System, share: float) -> System:
    """Return the system with its start perturbed by a share."""
    if share == 0.0:
        return system
    first, *others = system.contacts
    if first.gap > 0.0 and system.initial_equilibrium is None:
        moved = replace(first, gap=first.gap * (1.0 + share))
        return replace(system, contact=(moved, *others) if others else moved)
    return replace(system, drives=(*system.drives, _push(system, share * _prescribed(system))))


def _prescribed(system: System) -> float:
    """Return the largest prescribed velocity [m/s], 1 if there is none."""
    found = [velocity for drive in system.drives for velocity in drive.velocities] or [0.0]
    for contact in system.contacts:
        if contact.rigid_track is not None:
            track = contact.rigid_track
            found += [track.velocity, track.normal_velocity, track.lateral_velocity]
        found += contact.surface_velocities
    return max(abs(velocity) for velocity in found) or 1.0


def _push(system: System, velocity: float) -> Drive:
    """Return a drive that gives the slider a small initial velocity."""
    slider = system.slider
    if not slider.has_translation:
        return State(slider, velocity=(velocity,) * slider.mass.shape[0])
    held, translation = system.is_held(slider), slider.modes().translation
    normal, tangent, *_ = (axis[: len(translation)] for axis in system.contacts[0].frame)
    # Under an imposed velocity, the x of its root is prescribed and only y is free.
    direction = np.array([0.0, 1.0]) if held else tangent
    if not held and not np.any(direction @ translation):
        direction = normal
    return InitialVelocity(slider, **dict(zip("xyz", (velocity * direction).tolist(), strict=False)))


def _run_all(
    systems: Sequence[System], duration: float, measures: Mapping[str, Measure], options: dict[str, Any], workers: int
) -> list[tuple[list[float], str, str]]:
    """Return the measures, the ending and the message of each run."""

    def measured(record: xr.Dataset) -> tuple[list[float], str, str]:
        ended, message = str(record.attrs["ended"]), str(record.attrs.get("message", ""))
        if message:
            return [float("nan")] * len(measures), ended, message
        return [_number(name, measure(record)) for name, measure in measures.items()], ended, ""

    return simulate_many(systems, duration, measured, workers=workers, **options)


def _number(name: str, value: Any) -> float:
    plain = value.item() if getattr(value, "size", 0) == 1 and hasattr(value, "item") else value
    if isinstance(plain, bool) or not isinstance(plain, Real):
        raise ArgumentError(f"measures[{name!r}]", "return a number", got=f"a {type(value).__name__}")
    return float(plain)


def _dataset(
    measures: Mapping[str, Measure], shares: Array, results: list[tuple[list[float], str, str]], confidence: float
) -> xr.Dataset:
    found = xr.Dataset(coords={"run": np.arange(len(results)), "bound": ["low", "high"]})
    for number, name in enumerate(measures):
        values = np.array([result[0][number] for result in results])
        mean, half = mean_and_interval(values, confidence)
        found[name] = ("run", values)
        found[f"{name}_mean"] = ((), mean)
        found[f"{name}_interval"] = ("bound", [mean - half, mean + half], {"confidence": confidence})
    found["perturbation"] = ("run", shares, {"units": "1", "long_name": "relative change of the start"})
    found["ended"] = ("run", [result[1] for result in results])
    found["message"] = ("run", [result[2] for result in results])
    return found
