"""Basins of attraction: the motion to which a system settles, over two coordinates of its start."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ..analysis.regimes import TAKEN, regime_of
from ..arrays import Array
from ..bodies import Body
from ..checks import ArgumentError, brief, by_key, count, listed, positive, within
from ..drives import InitialState
from ..integration import simulate_many
from ..integration.settings import settings_of
from ..records.plain import PlainRecord
from ..records.variables import described
from ..scenarios.load import Scenario
from ..system import System
from .measures import message_of
from .points import Range, ranges_of
from .sources import check_takes, in_si, made_once
from .task import one_thread_each

# Recorded samples of a run at most, unless a rate is given, and largest rate [Hz].
SAMPLES, HIGHEST_RATE = 5000, 20e3
# Difference of the amplitudes of two classes, and change within the time evaluated, relative to the largest amplitude.
APART, CHANGING = 0.1, 0.02
DISPLACEMENT, VELOCITY = "displacement", "velocity"
AXES = "xyz"
MOST = 1000
FAILED = "failed"
# Positions of contacts whose ranges are amplitudes.
MOTIONS = ("contact_position", "contact_height")


def basin(
    source: System | str | Path | xr.Dataset | Callable[..., Any],
    ranges: Mapping[str, Any],
    duration: float | None = None,
    *,
    points: int | tuple[int, int] = 40,
    body: Body | None = None,
    overrides: Mapping[str, Any] | None = None,
    transient: float = 0.75,
    apart: float = APART,
    workers: int | None = None,
    progress: bool = False,
    **settings: Any,
) -> xr.Dataset:
    """Return the motions to which a system settles, over two coordinates of its start.

    Runs from every start of a grid are computed side by side, and classified at their end by regime and amplitude.
    Starts near the bound between two basins take long to leave it: they count as not settled until the run is longer.

    Parameters
    ----------
    source : System, str, Path, xarray.Dataset or callable
        A system, or a scenario as for `load_scenario`, whose start is varied. Or a function of two values by name that
        returns a `System`, a `Scenario`, or a `System` and a dictionary of arguments of `simulate`.
    ranges : mapping
        A `Range` or its two ends for each of two coordinates. Of a system ``displacement.x`` [m], ``velocity.y`` [m/s]
        and the like, or with the number of a degree of freedom such as ``displacement.0``: an `InitialState` of `body`,
        added to an `InitialEquilibrium` if the system has one. For a function the names of its parameters.
    duration : float, optional
        Time to simulate [s]; that of the scenario or the function if left out.
    points : int or pair of int, optional
        Number of values of both coordinates, or of each.
    body : PointMass, ReducedBody or RigidBody, optional
        Body whose start is varied; that of the tip of the first contact if left out.
    overrides : mapping, optional
        Values to set in the scenario by key, or further arguments of the function.
    transient : float, optional
        Share of each run that is left out [1]: the rest is evaluated.
    apart : float, optional
        Difference of two amplitudes, relative to the largest, from which they are of different motions [1].
    workers : int, optional
        Runs or groups of them at a time; the number of processors if left out.
    progress : bool, optional
        Whether to show a bar on standard error with the simulated time of all runs.
    **settings
        Settings of the runs, as of `simulate`, in place of those of the scenario or the function. Without a
        `sample_rate`, a run has at most 5000 samples.

    Returns
    -------
    xarray.Dataset
        Over both coordinates: ``regime`` as of `analysis.regime`; ``amplitude`` [m], half the range of the position of
        a contact along or across its track, the largest of all; ``attractor``, the number of the motion, by regime and
        rising amplitude, -1 if the run failed or had not settled; ``settled``, whether the amplitude no longer changed;
        ``message`` of a failure. Over ``attractor_number``: ``attractor_regime``, ``attractor_amplitude`` [m], the
        median, and ``share``, the part of the starts that lead there.

    Raises
    ------
    ValueError
        If an argument is out of its range, if the body has no such coordinate, or if no start can be simulated.
    """
    named = ranges_of("ranges", ranges)
    if len(named) != 2:
        raise ArgumentError("ranges", "have two coordinates", got=listed(named))
    within("transient", transient, 0.0, 1.0, ends=False)
    within("apart", apart, 0.0, 1.0, ends=False)
    if workers is not None:
        count("workers", workers)
    sizes = _sizes(points)
    asked = vars(settings_of("basin", settings))
    given = {name: value for name, value in asked.items() if name in settings}
    scales = [
        [one.value(share) for share in np.linspace(0.0, 1.0, size)]
        for one, size in zip(named.values(), sizes, strict=True)
    ]
    starts = [dict(zip(named, pair, strict=True)) for pair in _pairs(*scales)]
    with one_thread_each():
        made = _Made.of(source, starts, duration, body, by_key("overrides", overrides), given)
        ends = made.ends(transient, workers, progress)
    if all(one.message for one in ends):
        raise ValueError(f"no start can be simulated: {ends[0].message}")
    coordinates = {
        key: (key, [_in_si(key, value) for value in scale], _described(key, named[key]))
        for key, scale in zip(named, scales, strict=True)
    }
    return _dataset(coordinates, ends, apart).assign_attrs({"title": made.title, "duration": made.duration})


def _sizes(points: Any) -> tuple[int, int]:
    pair = points if isinstance(points, Sequence) and not isinstance(points, str) else (points, points)
    if len(pair) != 2:
        raise ArgumentError("points", "be a number, or one for each coordinate", points)
    first, second = (count("points", one, low=2, high=MOST) for one in pair)
    return first, second


def _pairs(first: Sequence[Any], second: Sequence[Any]) -> list[tuple[Any, Any]]:
    return [(one, other) for one in first for other in second]


def _in_si(key: str, value: Any) -> Any:
    return in_si({key: value})[key]


def _described(key: str, given: Range) -> dict[str, str]:
    kind = key.partition(".")[0]
    units = {DISPLACEMENT: "m", VELOCITY: "m/s"}.get(kind, "")
    return described(units, f"{kind} at the start") if units and "." in key else {}


class _End(NamedTuple):
    """The end of a run.

    Attributes
    ----------
    regime : str
        Its regime.
    amplitude, change : float
        Amplitude over the time evaluated, and its difference between the two halves [m].
    message : str
        Failure, empty if none.
    """

    regime: str
    amplitude: float
    change: float
    message: str


@dataclass(frozen=True)
class _Made:
    """Systems with their starts, and how they are simulated.

    Attributes
    ----------
    systems : dict of System
        Systems by the number of their start.
    duration : float
        Time to simulate [s].
    settings : dict
        Settings of the runs.
    title : str
        Name of the scenario or the function.
    messages : dict of str
        Messages of why there is no system, by the number of the start.
    """

    systems: dict[int, System]
    duration: float
    settings: dict[str, Any]
    title: str = ""
    messages: dict[int, str] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        source: Any,
        starts: Sequence[Mapping[str, Any]],
        duration: float | None,
        body: Body | None,
        fixed: Mapping[str, Any],
        given: Mapping[str, Any],
    ) -> _Made:
        """Return the systems of a source at each start; arguments as of `basin`."""
        timing = {} if duration is None else {"duration": positive("duration", duration)}
        if hasattr(source, "contacts"):
            if fixed:
                raise ArgumentError("overrides", "be left out for a system", dict(fixed))
            if duration is None:
                raise ArgumentError("duration", "be given for a system", got="none")
            return cls(_started(source, starts, body), duration, cls._settings({}, given, duration))
        if not callable(source) and not isinstance(source, (str, Path, xr.Dataset)):
            raise ArgumentError("source", "be a System, a scenario or a function of two values", source)
        if not callable(source):
            one = made_once(source, fixed, timing)
            words = cls._settings(vars(one.settings), given, one.duration)
            return cls(_started(one.system, starts, body), one.duration, words, one.title)
        if body is not None:
            raise ArgumentError("body", "be left out for a function, which sets the start", body)
        check_takes(source, [*fixed, *starts[0]])
        made: dict[int, Scenario] = {}
        messages: dict[int, str] = {}
        for number, values in enumerate(starts):
            try:
                made[number] = made_once(source, {**fixed, **values}, timing)
            except ValueError as error:
                messages[number] = message_of(error)
        if not made:
            raise ValueError(messages[0])
        first = next(iter(made.values()))
        systems = {number: one.system for number, one in made.items()}
        return cls(
            systems, first.duration, cls._settings(vars(first.settings), given, first.duration), first.title, messages
        )

    @staticmethod
    def _settings(own: Mapping[str, Any], given: Mapping[str, Any], duration: float) -> dict[str, Any]:
        rate = min(own.get("sample_rate", HIGHEST_RATE), HIGHEST_RATE, SAMPLES / duration)
        return {**own, "sample_rate": rate, **given, "probes": ()}

    def ends(self, transient: float, workers: int | None, progress: bool) -> list[_End]:
        """Return the end of each run."""
        start = transient * self.duration

        def ended(record: PlainRecord) -> _End:
            message = str(record.attrs.get("message", ""))
            if message:
                return _failed(message)
            late = record.time > record.time[0] + start
            half = np.count_nonzero(late) // 2
            motions = [record.by_contact(name).reshape(late.size, -1)[late] for name in MOTIONS]
            halves = [_amplitude(part) for one in motions for part in (one[:half], one[half:])]
            change = max(abs(halves[0] - halves[1]), abs(halves[2] - halves[3]))
            length = float(record.time[-1] - record.time[0])
            word = str(regime_of(record, start=min(start, 0.999 * length))["regime"])
            return _End(word, max(map(_amplitude, motions)), change, "")

        found: list[Any] = simulate_many(
            [*self.systems.values()],
            self.duration,
            reduce=ended,
            workers=workers,
            errors="return",
            labelled=False,
            provenance=False,
            variables=(*TAKEN, *MOTIONS),
            progress=progress,
            **self.settings,
        )
        ends = {number: _failed(words) for number, words in self.messages.items()}
        for number, one in zip(self.systems, found, strict=True):
            ends[number] = _failed(message_of(one)) if isinstance(one, Exception) else one
        return [ends[number] for number in range(len(ends))]


def _failed(words: str) -> _End:
    return _End(FAILED, np.nan, np.nan, words)


def _amplitude(motions: Array) -> float:
    return 0.5 * float(np.ptp(motions, axis=0).max(initial=0.0)) if len(motions) else np.nan


def _started(system: System, starts: Sequence[Mapping[str, Any]], body: Body | None) -> dict[int, System]:
    """Return a system with each start of a body."""
    chosen: Any = system.contacts[0].tip.body if body is None else body
    if chosen not in system.bodies:
        raise ArgumentError("body", "be one of the system", body)
    blank = InitialState(chosen)
    before: Any = next((one for one in system.drives if one.vectors and one.acted_on == chosen), blank)
    kept = [one for one in system.drives if one is not before]
    places = {key: _place(chosen, key) for key in starts[0]}
    states = (_state(before, places, in_si(values)) for values in starts)
    return {number: System(system.contact, [*kept, one], system.connections) for number, one in enumerate(states)}


def _place(body: Any, key: str) -> tuple[str, int]:
    """Return the vector of a start and the number of its entry that a coordinate names."""
    kind, _, name = key.partition(".")
    size = _freedoms(body)
    axes = "" if hasattr(body, "shapes") else AXES[:size]
    known = [*axes, *map(str, range(size))]
    if kind not in (DISPLACEMENT, VELOCITY) or name not in known:
        words = [f"{DISPLACEMENT}.{one}" for one in axes or known]
        raise ArgumentError("ranges", f"be of {listed(words)} or the same of {VELOCITY}", got=brief(key))
    return kind, axes.index(name) if name in axes else int(name)


def _freedoms(body: Any) -> int:
    """Return the number of degrees of freedom of a body that has an initial state."""
    return int(body.mass.shape[0]) if np.ndim(body.mass) else int(body.modes().count)


def _state(before: InitialState, places: Mapping[str, tuple[str, int]], values: Mapping[str, float]) -> InitialState:
    """Return the start of a body with some of its components set."""
    size = _freedoms(before.body)
    vectors = {name: np.zeros(size) for name in (DISPLACEMENT, VELOCITY)}
    vectors |= {name: np.array(given) for name, given in before.vectors.items()}
    for key, (kind, number) in places.items():
        vectors[kind][number] = values[key]
    return InitialState(before.body, vectors[DISPLACEMENT].tolist(), vectors[VELOCITY].tolist())


def _dataset(coordinates: Mapping[str, Any], ends: Sequence[_End], apart: float) -> xr.Dataset:
    dimensions = tuple(coordinates)
    shape = tuple(len(one[1]) for one in coordinates.values())
    regimes = np.array([one.regime for one in ends], dtype=object)
    amplitudes, changes = np.array([[one.amplitude, one.change] for one in ends]).T
    largest = float(np.nanmax(amplitudes))
    settled = changes <= CHANGING * largest
    numbers = np.full(len(ends), -1)
    found: list[tuple[str, float]] = []
    for regime in dict.fromkeys(sorted(set(regimes[settled]))):
        members = np.flatnonzero(settled & (regimes == regime))
        for group in _groups(members, amplitudes, apart * largest):
            numbers[group] = len(found)
            found.append((regime, float(np.median(amplitudes[group]))))
    order = np.argsort([amplitude for _, amplitude in found], kind="stable")
    rank = np.append(np.argsort(order, kind="stable"), -1)
    numbers = rank[numbers]
    count_of = np.bincount(numbers[numbers >= 0], minlength=len(found))

    def laid(values: Array, units: str, meaning: str) -> Any:
        return dimensions, values.reshape(shape), described(units, meaning)

    data = {
        "regime": laid(regimes, "1", "regime at the end"),
        "amplitude": laid(amplitudes, "m", "largest half range of the position of a contact"),
        "attractor": laid(numbers, "1", "number of the motion, -1 for none"),
        "settled": laid(settled, "1", "whether the amplitude no longer changes"),
        "message": laid(np.array([one.message for one in ends], dtype=object), "1", "message of a failure"),
        "attractor_regime": ("attractor_number", [found[k][0] for k in order]),
        "attractor_amplitude": (
            "attractor_number",
            [found[k][1] for k in order],
            described("m", "median amplitude of the motion"),
        ),
        "share": ("attractor_number", count_of / len(ends), described("1", "share of the starts that lead there")),
    }
    return xr.Dataset(data, {**coordinates, "attractor_number": np.arange(len(found))})


def _groups(members: Array, amplitudes: Array, apart: float) -> list[Array]:
    """Return members in groups of similar amplitude, in rising order."""
    rising = members[np.argsort(amplitudes[members], kind="stable")]
    return np.split(rising, np.flatnonzero(np.diff(amplitudes[rising]) > apart) + 1)
