"""Orbit diagrams: extremes of the motion over a parameter that rises and falls, each run from the end of the last."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from ..analysis.regimes import regime_of
from ..arrays import Array
from ..checks import ArgumentError, choice, count, instance, positive, within
from ..cycles.drive_periods import drive_period, settled_at
from ..integration import Diverged, simulate
from ..integration.bars import bar
from ..integration.settings import settings_of
from ..lowering import assemble
from ..records import Probe
from ..records.probes import displacements_of_tip
from ..records.variables import PROBES, described
from ..system import System
from ..version import __version__
from .loci import Source, SystemOf, origin_of, rising, systems_over
from .measures import message_of
from .sources import name_of

UP, DOWN, ANEW = "up", "down", "anew"
SWEEPS = (UP, DOWN, ANEW)
MAXIMA, MINIMA, BOTH, STROBE = "maxima", "minima", "both", "strobe"
TAKES = (MAXIMA, MINIMA, BOTH, STROBE)
# Recorded samples of a run at most, unless a rate is given, and largest rate [Hz].
SAMPLES, HIGHEST_RATE = 20_000, 20e3
# Periods of the drives among which a run begins where their phase is nearest to that at the end of the last one.
NEAREST = 50
# Samples of a motion at least.
FEWEST = 3
WORDS = {MAXIMA: "maxima of the ", MINIMA: "minima of the ", BOTH: "extremes of the ", STROBE: "once a period: "}
RESULTS = ("orbit", "regime", "message", "sweep", "extreme")


def orbit_diagram(
    source: Source,
    key: str,
    values: Sequence[float] | Array,
    duration: float,
    *,
    units: str = "",
    overrides: Mapping[str, Any] | None = None,
    probe: Probe | Callable[[System], Probe] | None = None,
    take: str = MAXIMA,
    sweeps: Sequence[str] = (UP, DOWN),
    transient: float = 0.5,
    most: int = 200,
    progress: bool = False,
    **settings: Any,
) -> xr.Dataset:
    """Return the extremes of the motion over a parameter, with runs that continue each other up and down.

    The first run begins from the system's own start, each other from the end of the run at the neighbouring value:
    where motions coexist, the two sweeps show different ones, and the values at which they jump. Cycles have one
    point for each extreme in a period, tori and chaos bands of them. Where the period of the drives changes, their
    phase goes on, to a small part of a sample interval.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or callable
        A scenario, as for `load_scenario`, or a function that makes a system from a value.
    key : str
        The parameter: its key in the scenario, such as ``friction``; for a function only a name. In sweeps up and down
        only drives, friction and the motion of rigid tracks may change.
    values : sequence of float
        Values of the parameter, rising, at least 2, in `units`.
    duration : float
        Time to simulate at each value [s].
    units : str, optional
        Unit of the values as in scenarios, such as ``deg``; SI if left out.
    overrides : mapping, optional
        Other values to set in the scenario by key.
    probe : probe or callable, optional
        Quantity whose extremes are taken, or a function of the system that returns it. By default the displacement of
        the tip of the first contact along x, y or z, whichever varies most.
    take : {"maxima", "minima", "both", "strobe"}, optional
        Local extremes, or the value at each whole period of the drives. A motion without extremes has its last value.
    sweeps : sequence of {"up", "down", "anew"}, optional
        Order in which the values are passed. With ``anew`` each run begins from the system's own start, so that any
        parameter may change.
    transient : float, optional
        Share of each run that is left out [1].
    most : int, optional
        Most points of a run; the last ones are kept.
    progress : bool, optional
        Whether to show a bar on standard error with the runs done and the value of the parameter.
    **settings
        Settings of the runs, as of `simulate`, except for probes. Without a `sample_rate`, a run has at most 20 000
        samples.

    Returns
    -------
    xarray.Dataset
        ``orbit`` over the parameter, ``sweep`` and ``extreme``, in the unit of the probe, filled up with NaN; over the
        parameter and ``sweep`` the ``regime`` as of `analysis.regime` and the ``message`` of a failure, after which the
        next run begins from the system's own start.

    Raises
    ------
    ValueError
        If an argument is out of its range, a value gives no system, or the parameter is one that must not change in
        runs that continue each other.
    """
    system_of = systems_over(source, key, units, overrides)
    grid = rising(values)
    if key in RESULTS:
        raise ArgumentError("key", "not have the name of a result of the diagram", key)
    positive("duration", duration)
    choice("take", take, TAKES)
    if isinstance(sweeps, str) or not isinstance(sweeps, Sequence) or not sweeps:
        raise ArgumentError("sweeps", f"be a list of {', '.join(SWEEPS)}", sweeps)
    for number, one in enumerate(sweeps):
        choice(f"sweeps[{number}]", one, SWEEPS)
    if len(set(sweeps)) < len(sweeps):
        raise ArgumentError("sweeps", "have each sweep once", sweeps)
    within("transient", transient, 0.0, 1.0, ends=False)
    count("most", most)
    instance("progress", progress, bool)
    if "probes" in settings:
        raise ArgumentError("probes", "be left out: the diagram has one probe", settings["probes"])
    settings_of("orbit_diagram", settings).check()
    words = {"sample_rate": min(HIGHEST_RATE, SAMPLES / duration), **settings}
    runs = _Runs(system_of, key, duration, transient, take, probe, words)
    found: dict[str, list[_Taken]] = {}
    with _told(progress, key, len(sweeps) * grid.size) as tell:
        for sweep in sweeps:
            runs.is_anew = sweep == ANEW
            order = grid[::-1] if sweep == DOWN else grid
            passed = [tell(value, runs.at(value)) for value in order.tolist()]
            found[sweep] = passed[::-1] if sweep == DOWN else passed
    origin = {"function": name_of(source)} if callable(source) else origin_of(source, overrides)
    origin |= {"stridula_version": __version__, "parameter": key, "take": take}
    return _dataset(found, grid, key, units, most, WORDS[take]).assign_attrs(origin)


class _Taken(NamedTuple):
    """What is taken from a run.

    Attributes
    ----------
    points : dict of ndarray
        Extremes by the label of the probe.
    units, kind : str
        Unit of the probes and their kind.
    regime, message : str
        Regime of the run, and its failure, empty if none.
    """

    points: dict[str, Array]
    units: str
    kind: str
    regime: str
    message: str


@dataclass
class _Runs:
    """Runs over a parameter, each from the end of the last one; attributes as the arguments of `orbit_diagram`."""

    system_of: SystemOf
    key: str
    duration: float
    transient: float
    take: str
    probe: Any
    settings: dict[str, Any]
    is_anew: bool = False
    # The last record, and the period of the drives in it [s].
    last: xr.Dataset | None = None
    period: float | None = None

    def at(self, value: float) -> _Taken:
        """Return what is taken from the run at a value."""
        system = self.system_of(value)
        instance(f"source({value:g})", system, System)
        flat = assemble(system)
        period = drive_period(flat)
        if self.take == STROBE and period is None:
            raise ArgumentError("take", "be of extremes for a system without periodic drives", self.take)
        start = None if self.is_anew else self.last
        if start is not None and period is not None and self.period is not None and period != self.period:
            start = _in_phase(start, self.period, period, settled_at(flat))
        try:
            run = simulate(system, self.duration, start=start, probes=self._probes(system), **self.settings)
        except Diverged as error:
            self.last = None
            return _Taken({}, "", "", "", message_of(error))
        except ArgumentError as error:
            if start is None or error.argument != "start" or not error.allowed.startswith("have the same"):
                raise
            allowed = "change drives, friction or the motion of rigid tracks alone in sweeps up and down"
            raise ArgumentError("key", allowed, got=f"{self.key!r}: {error}; use sweeps=['anew']") from None
        self.last, self.period = run, period
        return self._taken(run, period)

    def _probes(self, system: System) -> list[Any]:
        if self.probe is None:
            return list(displacements_of_tip(system))
        return [self.probe if not callable(self.probe) else self.probe(system)]

    def _taken(self, run: xr.Dataset, period: float | None) -> _Taken:
        kind = next(name for name in PROBES if name in run)
        times = run["time"].values
        ignored = self.transient * float(times[-1] - times[0])
        late = times >= times[0] + ignored
        points = {}
        for number, label in enumerate(run[f"{kind}_probe"].values.tolist()):
            values = run[kind].values[late, number]
            if self.take == STROBE:
                points[label] = _at_periods(times[late], values, period or 1.0)
            else:
                points[label] = extremes(values, self.take)
        word = str(regime_of(run, start=ignored)["regime"])
        return _Taken(points, str(run[kind].attrs["units"]), kind, word, "")


def extremes(values: Array, take: str = BOTH) -> Array:
    """Return the local maxima, the minima or both of samples, by a parabola through three; the last value if none.

    Parameters
    ----------
    values : ndarray, shape (samples,)
        The samples.
    take : {"maxima", "minima", "both"}, optional
        Which of them.
    """
    if values.size < FEWEST:
        return np.asarray(values[-1:])
    before, here, after = values[:-2], values[1:-1], values[2:]
    highest, lowest = (before < here) & (here >= after), (before > here) & (here <= after)
    chosen = np.flatnonzero({MAXIMA: highest, MINIMA: lowest}.get(take, highest | lowest))
    if not chosen.size:
        return np.asarray(values[-1:])
    slope, bend = 0.5 * (after - before)[chosen], (after - 2.0 * here + before)[chosen]
    return np.asarray(here[chosen] - 0.5 * slope**2 / bend)


def _at_periods(times: Array, values: Array, period: float) -> Array:
    """Return samples at whole periods since time 0, by cubic splines."""
    at = np.arange(np.ceil(times[0] / period), np.floor(times[-1] / period) + 1.0) * period
    at = at[(at >= times[0]) & (at <= times[-1])]
    return np.asarray(CubicSpline(times, values)(at))


def _in_phase(start: xr.Dataset, before: float, period: float, settled: float) -> xr.Dataset:
    """Return a record moved in time so that drives of another period go on in the phase in which it ends."""
    step, last, ratio = (start.attrs[name] for name in ("step", "last_step", "steps_per_sample"))
    interval = step * ratio
    phase = last * step / before % 1.0
    first = np.ceil(settled / period)
    # Runs begin at a whole number of sample intervals.
    samples = (np.arange(first, first + NEAREST) + phase) * period / interval
    moved = ratio * int(np.round(samples[np.argmin(np.abs(samples - np.round(samples)))]))
    return start.assign_coords(time=start["time"].values + (moved - last) * step).assign_attrs(last_step=moved)


@contextmanager
def _told(progress: bool, key: str, runs: int) -> Iterator[Callable[[float, _Taken], _Taken]]:
    """Yield a function that shows the runs done and the value of the parameter, and returns what was taken."""
    if not progress:
        yield lambda value, taken: taken
        return
    with bar(f"orbits over {key}", asked=True) as show:
        done = 0

        def tell(value: float, taken: _Taken) -> _Taken:
            nonlocal done
            done += 1
            show(done, runs, f"{done} of {runs} runs, {key} {value:.5g}")
            return taken

        yield tell


def _dataset(found: Mapping[str, list[_Taken]], grid: Array, key: str, units: str, most: int, words: str) -> xr.Dataset:
    every = [one for passed in found.values() for one in passed]
    known = [one for one in every if one.points]
    if not known:
        raise ValueError(f"no run can be simulated: {every[0].message}")

    def spread(label: str) -> float:
        return float(np.ptp(np.concatenate([one.points[label] for one in known])))

    label = max(known[0].points, key=spread)
    longest = min(most, max(one.points[label].size for one in known))
    orbit = np.full((grid.size, len(found), longest), np.nan)
    for j, passed in enumerate(found.values()):
        for k, one in enumerate(passed):
            points = one.points.get(label, np.empty(0))[-longest:]
            orbit[k, j, : points.size] = points
    both = (key, "sweep")

    def texts(name: str) -> Array:
        return np.array([[getattr(one, name) for one in passed] for passed in found.values()], dtype=object).T

    return xr.Dataset(
        {
            "orbit": ((*both, "extreme"), orbit, described(known[0].units, f"{words}{known[0].kind} of {label}")),
            "regime": (both, texts("regime"), described("1", "regime of the run")),
            "message": (both, texts("message"), described("1", "message of a failure, empty if none")),
        },
        {key: (key, grid, {"units": units}), "sweep": list(found), "extreme": np.arange(longest)},
    )
