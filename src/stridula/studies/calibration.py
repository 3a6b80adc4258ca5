"""Calibration: search for parameters whose run meets targets, by differential evolution."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.optimize
import scipy.stats
import xarray as xr

from ..analysis.regimes import REGIMES
from ..arrays import Array
from ..checks import (
    ArgumentError,
    brief,
    by_key,
    choice,
    count,
    finite,
    instance,
    listed,
    non_negative,
    positive,
    suggestion,
)
from ..integration.bars import bar
from ..linear.equilibrium import HELD, JAMMED, LIFTED_OFF
from ..linear.structure import SLIDING
from ..records.provenance import toml
from ..scenarios.load import with_matrices
from ..scenarios.read import read_tables
from ..version import __version__
from .measures import MEASURES, Value, value_of
from .parts import Parts
from .points import Range, ranges_of
from .sources import SystemOf, check_takes, takes, takes_one
from .sweeps import sweep

Point = dict[str, Any]
Evaluate = Callable[[Sequence[Point]], Sequence[Mapping[str, Value]]]
# Miss that is assigned to a failed run, or to a measure that is not a number. Other misses are smaller.
WORST = 10.0
MOST_GENERATIONS = 100_000
LARGEST_POPULATION = 10_000
# Kind of study in a file.
STUDY = "calibration"
# Names of other results of a calibration.
OWN = ("miss", "met", "target", "generation", "parameter", "best_miss", "best_parameters")
COLUMNS = {column.name: column for measure in MEASURES.values() for column in measure.columns}
# Possible values of measures that are words.
WORDS = {"regime": tuple(REGIMES), "equilibrium": (SLIDING, HELD, LIFTED_OFF, JAMMED)}


@dataclass(frozen=True)
class Target:
    """Target of a measure.

    Parameters
    ----------
    low, high : float, optional
        Bounds between which the target is met; a bound that is left out is infinite.
    scale : float, optional
        Distance outside the bounds that counts as a miss of 1, in the unit of the measure: by default half the width,
        or a tenth of the only bound. Misses above 5 are compressed to stay below 10, the miss of a failed run.

    Raises
    ------
    ValueError
        If there is no bound, `low` is above `high`, or there is no scale.
    """

    low: float = -math.inf
    high: float = math.inf
    scale: float | None = None

    def __post_init__(self) -> None:
        for name in ("low", "high"):
            value = getattr(self, name)
            if not isinstance(value, (int, float)) or isinstance(value, bool) or value != value:
                raise ArgumentError(name, "be a number", value)
            if isinstance(value, int):
                finite(name, value)
        if self.low > self.high or (math.isinf(self.low) and math.isinf(self.high)):
            raise ArgumentError(
                "low and high",
                "be bounds in order, at least one of them finite",
                self.low,
                got=f"{brief(self.low)} and {brief(self.high)}",
            )
        if self.scale is not None:
            positive("scale", self.scale)
        elif self._scale <= 0.0:
            raise ArgumentError(
                "scale", "be given for a target at one value", self.low, got=f"{self.low!r} to {self.high!r}"
            )

    @property
    def _scale(self) -> float:
        if self.scale is not None:
            return self.scale
        if math.isinf(self.low) or math.isinf(self.high):
            return 0.1 * abs(self.high if math.isinf(self.low) else self.low)
        return (self.high - self.low) / 2.0

    def miss(self, value: Value) -> float:
        """Return the distance of a measure from the bounds, in units of the scale; below `WORST` for finite numbers."""
        if isinstance(value, str) or not math.isfinite(value):
            return WORST
        miss = max(0.0, self.low - value, value - self.high) / self._scale
        # The function is smooth and always rises, so that a search can compare misses even if the bounds are narrow.
        return miss if miss <= WORST / 2.0 else WORST - (WORST / 2.0) ** 2 / miss


@dataclass(frozen=True)
class CalibrationProgress:
    """Progress of a calibration.

    Attributes
    ----------
    generation, generations : int
        Number of generations done, and in total.
    miss : float
        Miss of the best parameters so far.
    best : dict
        Best parameters so far.
    resumed : int
        Number of generations computed in earlier calls.
    """

    generation: int
    generations: int
    miss: float
    best: Point
    resumed: int = 0


def calibrate(
    source: str | Path | xr.Dataset | SystemOf | Evaluate,
    ranges: Mapping[str, Range | tuple[Any, Any]],
    targets: Mapping[str, Target | tuple[float, float] | str],
    *,
    measures: Mapping[str, Callable[[xr.Dataset], Value]] | None = None,
    population: int = 32,
    generations: int = 50,
    seed: int = 0,
    start: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None = None,
    spread: float = 0.02,
    out: str | Path | None = None,
    watchers: Sequence[Callable[[CalibrationProgress], None]] = (),
    progress: bool = False,
    **options: Any,
) -> xr.Dataset:
    """Find parameters whose run meets targets.

    Differential evolution (Storn & Price 1997; ``scipy.optimize.differential_evolution``) over the ranges; the runs of
    a generation are computed side by side. The search minimises the sum of the squared misses of the targets and ends
    once all are met. Equal seeds give equal searches.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or callable
        A scenario, or a function of the parameters by name that makes a system, as for `sweep`. Or, for targets that
        need several runs, a function of a list of points (values by key) that returns the measures of each point by
        name, including those of the targets.
    ranges : mapping
        Search range of each parameter: a `Range` or its two ends.
    targets : mapping
        Target of each measure, by the name of its variable in a sweep: a `Target`, its two bounds, or the required
        word.
    measures : mapping, optional
        Functions of a record by name, for targets that are not measures of a sweep.
    population : int, optional
        Parameter sets in each generation, from 5 to 10 000.
    generations : int, optional
        Generations after the first.
    seed : int, optional
        Seed of the search.
    start : mapping or sequence of mapping, optional
        Initial parameters: one set, around which the others are spread, or several sets, such as the best of a sweep,
        around which the rest are spread in turn.
    spread : float, optional
        Standard deviation of the other sets around `start`, as a fraction of the ranges.
    out : str or Path, optional
        NetCDF file to write. Finished generations are kept in a folder beside it, ``<out>.parts``; the same call
        resumes from there.
    watchers : sequence of callable, optional
        Called with a `CalibrationProgress` after each generation.
    progress : bool, optional
        Whether a bar on standard error shows how many generations are done, the miss of the best set so far and the
        time left.
    **options
        Arguments of `sweep` such as `overrides`, `duration`, `sample_rate`, `workers` and `client`.

    Returns
    -------
    xarray.Dataset
        The best set: each parameter and each measure, by name; ``miss``, the root of the sum of squared misses, and
        ``met``, whether each ``target`` is met; over ``generation`` the ``best_miss`` so far and, by ``parameter``, the
        ``best_parameters``. For a scenario also ``step`` and ``sample_interval``: sets that run side by side share a
        step, which reproduces the run of the best set alone.

    Raises
    ------
    ScenarioError
        If the scenario is invalid, or a key is unknown.
    ValueError
        If an argument is out of its range, no set of the first generation can be run, or `out` is another file or that
        of another calibration. Functions are distinguished by their names only.
    OSError
        If the file or a generation cannot be written; finished generations are kept.
    """
    searched = ranges_of("ranges", ranges)
    aimed = _targets(targets)
    if count("population", population, low=5) > LARGEST_POPULATION:
        raise ArgumentError("population", f"be at most {LARGEST_POPULATION}", population)
    count("generations", generations, high=MOST_GENERATIONS)
    count("seed", seed, low=0)
    non_negative("spread", spread)
    names = [*searched, *by_key("overrides", options.get("overrides"))]
    is_evaluation = callable(source) and not takes(source, names)
    evaluate = _evaluation(source, names) if is_evaluation else _sweeping(source, aimed, measures or {}, options)
    random = np.random.default_rng(seed)
    first = _first_population(searched, population, random, start, spread)
    asked = {"ranges": searched, "targets": aimed, "measures": list(measures or {}), "population": population}
    asked |= {"generations": generations, "seed": seed, "start": first.tolist(), "options": options}
    store = None if out is None else Parts(out, _identity(source, asked), STUDY)
    if store is not None and store.finished is not None:
        store.clear()
        return store.finished
    with _generations_shown(progress) as more, suppress(_Met), _own_errors():
        search = _Search(searched, aimed, evaluate, generations, [*watchers, *more], store)
        scipy.optimize.differential_evolution(
            search.misses,
            [(0.0, 1.0)] * len(searched),
            init=first,
            maxiter=generations,
            mutation=(0.4, 1.0),
            recombination=0.9,
            rng=random,
            polish=False,
            tol=0.0,
            atol=-1.0,
            vectorized=True,
            updating="deferred",
        )
    found = search.dataset()
    if store is not None:
        found.attrs |= store.identity
        store.finish(found)
    return found


def _identity(source: Any, asked: Mapping[str, Any]) -> dict[str, str]:
    """Return attributes that distinguish a calibration from others."""

    def words(value: Any) -> str:
        return f"{value.__module__}.{value.__qualname__}" if hasattr(value, "__qualname__") else repr(value)

    of = {"function": words(source)}
    if not callable(source):
        tables = read_tables(source)
        # The scenario is stored with the content of the files that it names.
        of = {"scenario": toml(with_matrices(tables, tables))}
    machines = ("workers", "client")
    options = {name: value for name, value in asked["options"].items() if name not in machines}
    text = json.dumps({**asked, "options": options}, ensure_ascii=False, default=words)
    return {**of, STUDY: text, "stridula_version": __version__}


@contextmanager
def _generations_shown(progress: bool) -> Iterator[list[Callable[[CalibrationProgress], None]]]:
    """Give the watchers of a search that show a bar, none unless it is asked for."""
    instance("progress", progress, bool)
    if not progress:
        yield []
        return
    with bar("calibration", asked=True) as show:

        def watch(reached: CalibrationProgress) -> None:
            words = f"generation {reached.generation} of {reached.generations}, miss {reached.miss:.4g}"
            show(reached.generation + 1, reached.generations + 1, words, reached.resumed)

        yield [watch]


class _Met(Exception):
    """All targets are met."""


class _Failed(Exception):
    """An error of an evaluation, hidden from scipy, which handles some errors as its own."""


@contextmanager
def _kept_from_scipy() -> Iterator[None]:
    try:
        yield
    except Exception as error:
        raise _Failed(error) from None


@contextmanager
def _own_errors() -> Iterator[None]:
    try:
        yield
    except _Failed as failed:
        raise failed.args[0] from None


def _targets(targets: Any) -> dict[str, Target | str]:
    if not isinstance(targets, Mapping) or not targets:
        raise ArgumentError("targets", "be targets by the names of measures", targets)
    found: dict[str, Target | str] = {}
    for name, given in targets.items():
        if name in OWN:
            raise ArgumentError("targets", "not have the name of a result of the calibration", name)
        if isinstance(given, (Target, str)):
            found[str(name)] = given
        elif isinstance(given, (tuple, list)) and len(given) == 2:
            try:
                found[str(name)] = Target(*given)
            except ArgumentError as error:
                raise error.inside(f"targets[{name!r}]") from None
        else:
            raise ArgumentError(f"targets[{name!r}]", "be a Target, its two bounds or a word", given)
    return found


def miss_of(target: Target | str, value: Value) -> float:
    """Return the miss of a target; 0 or 1 for a word."""
    return float(value != target) if isinstance(target, str) else target.miss(value)


def _evaluation(function: Any, names: Sequence[str]) -> Evaluate:
    """Return a function after checking that it may take a list of points.

    Raises
    ------
    ValueError
        If it does not take one argument.
    """
    if not takes_one(function):
        check_takes(function, names)
    evaluate: Evaluate = function
    return evaluate


def _sweeping(
    scenario: Any,
    targets: Mapping[str, Target | str],
    functions: Mapping[str, Callable[[xr.Dataset], Value]],
    options: Mapping[str, Any],
) -> Evaluate:
    """Return a function that runs a scenario at many points and measures the quantities of the targets."""
    instance("measures", functions, Mapping)
    for name, target in targets.items():
        if name not in functions:
            _check_target(name, target, list(functions))
    homes = {column.name: measure.name for measure in MEASURES.values() for column in measure.columns}
    names = dict.fromkeys([*(homes[name] for name in targets if name not in functions), "step"])
    asked = [*names, *([dict(functions)] if functions else [])]
    shown = [*targets, *(name for name in ("step", "sample_interval") if name not in targets)]

    def evaluate(points: Sequence[Point]) -> list[dict[str, Value]]:
        found = sweep(scenario, points, asked, **options)
        if (found["message"].values != "").all() and not evaluated:
            example = found["message"].values[0]
            raise ArgumentError("ranges", "contain sets that can be run", got=f"{len(points)} that cannot: {example}")
        evaluated.append(len(points))
        return [{name: found[name].values[k] for name in shown} for k in range(len(points))]

    evaluated: list[int] = []
    return evaluate


def _check_target(name: str, target: Target | str, functions: Sequence[str]) -> None:
    """Raise ValueError if a target is of an unknown measure, or a word for a number or the reverse."""
    known = [*functions, *COLUMNS]
    if name not in COLUMNS:
        raise ArgumentError(
            "targets", f"be among {', '.join(known)}", name, got=f"{brief(name)}{suggestion(name, known)}"
        )
    if isinstance(target, str) and name in WORDS:
        choice(f"target of {name}", target, WORDS[name])
    elif COLUMNS[name].is_text != isinstance(target, str):
        kind = f"one of {', '.join(WORDS[name])}" if name in WORDS else "bounds"
        raise ArgumentError(f"target of {name}", f"be {kind}", target)


def _first_population(
    ranges: Mapping[str, Range],
    population: int,
    random: np.random.Generator,
    start: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None,
    spread: float,
) -> Array:
    """Return the first generation as fractions of the ranges, shape (population, parameters)."""
    if start is None:
        return np.asarray(scipy.stats.qmc.LatinHypercube(len(ranges), rng=random).random(population))
    given = [start] if isinstance(start, Mapping) else start
    if not isinstance(given, Sequence) or not 0 < len(given) <= population:
        raise ArgumentError("start", f"be a set of parameters or a list of 1 to {population}", start)
    centres = np.array([_shares_of(one, ranges) for one in given])
    around = centres[np.arange(population) % len(centres)]
    around += random.normal(size=around.shape) * spread
    around[: len(centres)] = centres
    return np.clip(around, 0.0, 1.0)


def _shares_of(start: Any, ranges: Mapping[str, Range]) -> list[float]:
    """Return a set of parameters as fractions of the ranges."""
    instance("start", start, Mapping)
    if set(start) != set(ranges):
        raise ArgumentError("start", f"have the keys of ranges, {listed(ranges)}", start, got=listed(map(str, start)))
    shares = [one.share(start[key]) for key, one in ranges.items()]
    outside = [key for key, share in zip(ranges, shares, strict=True) if not -1e-9 <= share <= 1.0 + 1e-9]
    if outside:
        raise ArgumentError("start", "lie in the ranges", start, got=f"{outside[0]} = {start[outside[0]]!r}")
    return shares


class _Search:
    """State of a search: the best set so far, by generation."""

    def __init__(
        self,
        ranges: Mapping[str, Range],
        targets: Mapping[str, Target | str],
        evaluate: Evaluate,
        generations: int,
        watchers: Sequence[Callable[[CalibrationProgress], None]],
        store: Parts | None,
    ) -> None:
        self.ranges, self.targets, self.evaluate = ranges, targets, evaluate
        self.generations, self.watchers = generations, watchers
        self.shares: Array = np.full(len(ranges), np.nan)
        self.measured: Mapping[str, Value] = {}
        self.miss = math.inf
        self.history: list[tuple[float, Array]] = []
        self.store, self.resumed = store, 0

    def point(self, shares: Array) -> Point:
        """Return the parameters at fractions of the ranges."""
        return {key: one.value(float(share)) for (key, one), share in zip(self.ranges.items(), shares, strict=True)}

    def misses(self, columns: Array) -> Array:
        """Return the sum of squared misses of each set of parameters, from shape (parameters, sets) to (sets,)."""
        sets = np.atleast_2d(columns.T)
        with _kept_from_scipy():
            found = self._kept([self.point(shares) for shares in sets])
        totals = np.array(
            [sum(miss_of(target, one[name]) ** 2 for name, target in self.targets.items()) for one in found]
        )
        best = int(np.argmin(totals))
        if totals[best] < self.miss:
            self.miss, self.shares, self.measured = float(totals[best]), sets[best].copy(), found[best]
        self.history.append((self.miss, self.shares))
        for watch in self.watchers:
            point = self.point(self.shares)
            with _kept_from_scipy():
                reached = len(self.history) - 1, self.generations, math.sqrt(self.miss), point
                watch(CalibrationProgress(*reached, self.resumed))
        if self.miss == 0.0:
            raise _Met
        return totals

    def _kept(self, points: Sequence[Point]) -> list[dict[str, Value]]:
        """Return the measures of each set of the next generation, those of an earlier call if it has computed them."""
        number = len(self.history)
        if self.store is None:
            return self.measured_at(points)
        # Equal seeds give equal searches, so that the sets of an earlier call are the same.
        known = self.store.done({number: len(points)}).get(number)
        if known is not None:
            self.resumed += 1
            return [dict(one["values"]) for one in known]
        found = self.measured_at(points)
        self.store.keep(number, [{"ended": "", "message": "", "values": one} for one in found])
        return found

    def measured_at(self, points: Sequence[Point]) -> list[dict[str, Value]]:
        """Return the measures of each set of parameters, checked."""
        found = self.evaluate(points)
        if not isinstance(found, Sequence) or len(found) != len(points):
            raise ArgumentError("source", f"return the measures of each of {len(points)} points", found)
        for one in found:
            lacking = next((name for name in self.targets if not isinstance(one, Mapping) or name not in one), None)
            if lacking is not None:
                raise ArgumentError("source", f"return {lacking!r} for each point", one)
            clash = next((name for name in one if name in self.ranges or name in OWN), None)
            if clash is not None:
                raise ArgumentError("measures", "not have the name of a parameter or a result", clash)
        return [{name: value_of(value) for name, value in one.items()} for one in found]

    def dataset(self) -> xr.Dataset:
        """Return the results of the search."""
        keys = list(self.ranges)
        numbers = np.array([self._numbers(shares) for _, shares in self.history])
        data: dict[str, Any] = {
            key: ((), numbers[-1, k], {"units": one.unit}) for k, (key, one) in enumerate(self.ranges.items())
        }
        for name, value in self.measured.items():
            known = COLUMNS.get(name)
            data[name] = ((), value, {"units": known.units, "long_name": known.long_name} if known else {})
        data["miss"] = ((), math.sqrt(self.miss), {"units": "1", "long_name": "root of the sum of squared misses"})
        met = [miss_of(target, self.measured[name]) == 0.0 for name, target in self.targets.items()]
        data["met"] = ("target", met, {"long_name": "whether the target is met"})
        data["best_miss"] = ("generation", [math.sqrt(miss) for miss, _ in self.history], {"units": "1"})
        data["best_parameters"] = (("generation", "parameter"), numbers)
        return xr.Dataset(data, {"target": list(self.targets), "parameter": keys})

    def _numbers(self, shares: Array) -> list[float]:
        return [one.number(float(share)) for one, share in zip(self.ranges.values(), shares, strict=True)]
