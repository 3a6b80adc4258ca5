"""Branches of limit cycles over a parameter, with their stability and bifurcations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import xarray as xr

from ..checks import ArgumentError, brief, count, finite, instance, within
from ..cycles.branch import Branch, NotFound, Point, followed
from ..cycles.branch_record import events_of_branch, orbit_of_branch, point_of_branch
from ..cycles.cycle_record import cycle_record
from ..cycles.events import Event, birth, events_between
from ..cycles.floquet import Multipliers, multipliers_of
from ..cycles.limit_cycle import cycle_near
from ..cycles.starts import Asked
from ..drives import InitialEquilibrium
from ..integration.bars import bar
from ..integration.contact_solve import GaussSeidel
from ..integration.settings import Settings
from ..lowering import Assembly, assemble
from ..lowering.schemes import Scheme
from ..records import Probe
from ..records.files import load, save
from ..system import System
from ..version import __version__
from .loci import Source, origin_of, systems_over
from .sources import name_of

# Distance from the first point to the second, and longest distance of two points, relative to the range.
FIRST, LONGEST = 0.01, 1.0 / 15.0
# Size of a motion, relative to that at the start, below which it is steady sliding.
FAINT = 0.02
SLIDING, LIMIT, MOST = "steady sliding", "end of the range", "most points"


def follow_cycle(
    source: Source,
    key: str,
    low: float,
    high: float,
    start: xr.Dataset | InitialEquilibrium | None = None,
    *,
    value: float,
    units: str = "",
    overrides: Mapping[str, Any] | None = None,
    points: int = 100,
    frequency: float | None = None,
    settle: int | None = None,
    tolerance: float = 1e-9,
    scheme: Scheme | None = None,
    step: float | None = None,
    probes: Sequence[Probe] | None = None,
    contact_solve: GaussSeidel | None = None,
    out: str | Path | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Follow a limit cycle over a parameter in both directions, through folds, with its stability and bifurcations.

    Each point of the branch is a cycle as of `limit_cycle`, found by Newton's method in the plane across the line
    through the last two points, so that the parameter may turn back. Where two branches meet at an angle, as at a
    grazing, the other one is searched among motions of another size.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or callable
        A scenario, as for `load_scenario`, or a function that makes a system from a value.
    key : str
        The parameter: its key in the scenario, such as ``friction``; for a function only a name.
    low, high : float
        Range of the parameter, in `units`.
    start : xarray.Dataset or InitialEquilibrium, optional
        Start of the search for the first cycle, as for `limit_cycle`.
    value : float
        Value of the parameter at the first cycle, in `units`.
    units : str, optional
        Unit of the parameter as in scenarios, such as ``deg``; SI if left out.
    overrides : mapping, optional
        Other values to set in the scenario by key.
    points : int, optional
        Most points in each direction.
    frequency : float, optional
        Expected frequency of the first cycle [Hz], as for `limit_cycle`.
    settle : int, optional
        Periods that are marched before the search for it.
    tolerance : float, optional
        Largest residual of each cycle [1].
    scheme : CentralDifference or ExactModal, optional
        Time scheme; the exact modal one if left out.
    step : float, optional
        Longest time step [s], a whole division of the period; by default that of the record, or of a run.
    probes : sequence of probes, optional
        Quantities whose amplitudes are kept; by default those of `limit_cycle`.
    contact_solve : GaussSeidel, optional
        Settings of the simultaneous solution of several contacts.
    out : str or Path, optional
        NetCDF file that is written after every point. A branch that has been begun in it is continued, also one that
        ended at the most points, with more of them.
    progress : bool, optional
        Whether to show a bar on standard error with the points found and the value of the parameter.

    Returns
    -------
    xarray.Dataset
        Over ``point``, along the branch: the parameter, under its key; ``period`` [s], ``frequency`` [Hz], ``stable``,
        ``leading_multiplier`` with real and imaginary ``part``, ``second_frequency`` [Hz]; for each kind of probe its
        amplitude, such as ``displacement_amplitude``; ``mean_status_share``, the share of each ``contact_status``,
        a mean over the contacts. Over ``event``: ``event_value``, ``event_kind`` (``fold``, ``period doubling``,
        ``Neimark-Sacker``, ``grazing``) and ``event_frequency`` [Hz]. ``attrs["begins"]`` and ``attrs["ends"]`` tell
        where the branch ends: at the ``end of the range``, in ``steady sliding``, at the ``most points``, or why it
        could not be followed.

    Raises
    ------
    ValueError
        If an argument is out of its range, or the parameter changes the number of modes.
    NoCycle
        If there is no cycle near the start.
    """
    system_of = systems_over(source, key, units, overrides)
    if finite("high", high) <= finite("low", low):
        raise ArgumentError("high", f"be above low ({brief(low)})", high)
    within("value", value, low, high)
    count("points", points)
    settings = Settings(scheme=scheme, step=step, probes=probes, contact_solve=contact_solve)  # type: ignore[arg-type]
    asked = Asked(start, settings, frequency, settle, tolerance)
    asked.check()
    with _told(progress, key) as tell:
        begun = _begun(_Systems(system_of, settings), asked, float(value), float(low), float(high))
        origin = (
            (origin_of(source, overrides) if not callable(source) else {"function": name_of(source)})
            | {"stridula_version": __version__, "parameter": key}
            | {"low": float(low), "high": float(high), "tolerance": tolerance}
        )
        following = _Following(begun, key, units, origin, out, tell)
        if out is not None and Path(out).exists():
            following.resume()
        for side in (1.0, -1.0):
            following.follow(side, points)
    return following.dataset()


@dataclass(frozen=True)
class _Systems:
    """Systems over a parameter, and how their cycles are recorded.

    Attributes
    ----------
    system_of : callable
        Function of a value that returns a system.
    settings : Settings
        Settings of the records.
    """

    system_of: Callable[[float], System]
    settings: Settings

    def assembly(self, value: float) -> Assembly:
        """Return the system at a value as flat arrays."""
        return assemble(self.system_of(value))


@dataclass(frozen=True)
class _Begun:
    """The first point of a branch.

    Attributes
    ----------
    systems : _Systems
        Systems over the parameter.
    branch : Branch
        The branch.
    first : Point
        Its first point.
    low, high : float
        Range of the parameter.
    """

    systems: _Systems
    branch: Branch
    first: Point
    low: float
    high: float


def _begun(systems: _Systems, asked: Asked, value: float, low: float, high: float) -> _Begun:
    found, is_driven = cycle_near(systems.system_of(value), asked, lambda *_: None)
    cycle = found.best
    branch = Branch(systems.assembly, high - low, asked.tolerance, is_driven, cycle.step, cycle.size)
    return _Begun(systems, branch, Point(value, cycle), low, high)


@dataclass
class _Following:
    """A branch as far as it has been followed, in both directions.

    Attributes
    ----------
    begun : _Begun
        Its first point.
    key, units : str
        Parameter and its unit.
    origin : dict
        Attributes that record its origin.
    out : str, Path or None
        File that is written after every point.
    tell : callable
        Called with the number of points and the value of the last.
    """

    begun: _Begun
    key: str
    units: str
    origin: dict[str, Any]
    out: str | Path | None
    tell: Callable[[int, float], None]
    rows: dict[float, list[xr.Dataset]] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)
    ends: dict[float, str] = field(default_factory=dict)
    kept: dict[int, tuple[Point, Multipliers]] = field(default_factory=dict)

    def resume(self) -> None:
        """Take the points of a file, if they are of the same branch.

        Raises
        ------
        ValueError
            If they are not.
        """
        found = load(str(self.out))
        for name, value in self.origin.items():
            if found.attrs.get(name) != value:
                got = f"{brief(found.attrs.get(name))} in {self.out}"
                raise ArgumentError(
                    "out", f"be a new file, or that of the same branch with {name} {brief(value)}", got=got
                )
        rows = [found.isel(point=k).drop_dims("event") for k in range(found.sizes["point"])]
        first = int(found.attrs["first_point"])
        self.rows = {-1.0: rows[:first][::-1], 1.0: rows[first:]}
        ends = {-1.0: str(found.attrs["begins"]), 1.0: str(found.attrs["ends"])}
        # More points may be asked for now.
        self.ends = {side: end for side, end in ends.items() if end != MOST}
        events = zip(
            found["event_kind"].values, found["event_value"].values, found["event_frequency"].values, strict=True
        )
        self.events = [Event(str(kind), float(value), float(frequency)) for kind, value, frequency in events]

    def follow(self, side: float, most: int) -> None:
        """Follow the branch to one side, from its first point or from where it was left."""
        if self.ends.get(side):
            return
        begun, branch = self.begun, self.begun.branch
        rows = self.rows.setdefault(side, [])
        if not any(self.rows.values()):
            rows.append(self._row(begun.first))
        if len(rows) > most:
            self.ends[side] = MOST
            return
        points = self._points(side)
        end = ""
        try:
            if len(points) == 1:
                near = begun.first.value + side * FIRST * branch.scale
                if not begun.low <= near <= begun.high:
                    self.ends[side] = LIMIT
                    self._write()
                    return
                points.append(branch.at(near, begun.first.cycle))
                rows.append(self._row(points[-1]))
            for point in followed(branch, points, LONGEST):
                end = self._end(points)
                if end == SLIDING:
                    points.pop()
                    break
                if end == LIMIT:
                    edge = begun.high if point.value > begun.high else begun.low
                    points[-1] = branch.at(edge, point.cycle)
                self.events += events_between(branch, points[-4:], self._multipliers)
                self._add(side, points[-1])
                if end or len(rows) > most:
                    break
            self.ends[side] = end or MOST
        except NotFound as error:
            is_faint = points[-1].cycle.size < LONGEST * branch.size
            self.ends[side] = SLIDING if is_faint else f"not followed any farther: {error}"
        if self.ends[side] == SLIDING and len(points) > 2:
            self.events.append(birth(points))
        self._write()

    def _add(self, side: float, point: Point) -> None:
        self.rows[side].append(self._row(point))
        self.tell(sum(map(len, self.rows.values())), point.value)
        self._write()

    def _write(self) -> None:
        if self.out is not None:
            save(self.dataset(), self.out)

    def _points(self, side: float) -> list[Point]:
        """Return the points from which the branch is followed on: the last four, or the first one alone."""
        begun = self.begun
        found = [begun.first]
        for one in self.rows[side][-4:]:
            value = float(one[self.key])
            if value != begun.first.value:
                found.append(orbit_of_branch(one, self.key, begun.systems.assembly(value), begun.first.cycle))
        return found

    def _end(self, points: list[Point]) -> str:
        """Return the kind of end that the last point is, empty for none."""
        begun, (*_, before, last) = self.begun, points
        counted = last.cycle.vectors.counted
        is_through = counted(before.cycle.swing) @ counted(last.cycle.swing) < 0.0
        if last.cycle.size < FAINT * begun.branch.size or is_through:
            return SLIDING
        return "" if begun.low <= last.value <= begun.high else LIMIT

    def _multipliers(self, point: Point) -> Multipliers:
        number = id(point.cycle)
        if number not in self.kept:
            # The point is kept, too, so that no other one gets its number.
            self.kept[number] = point, multipliers_of(point.cycle, self.begun.branch.is_driven)
        return self.kept[number][1]

    def _row(self, point: Point) -> xr.Dataset:
        systems, multipliers = self.begun.systems, self._multipliers(point)
        record = cycle_record(systems.system_of(point.value), point.cycle, multipliers, systems.settings, "")
        return point_of_branch(self.key, self.units, point, multipliers, record)

    def dataset(self) -> xr.Dataset:
        """Return the branch so far."""
        down, up = self.rows.get(-1.0, [])[::-1], self.rows.get(1.0, [])
        whole = xr.concat([*down, *up], "point", data_vars="all", coords=[self.key], compat="override", join="override")
        ends = {"begins": self.ends.get(-1.0, ""), "ends": self.ends.get(1.0, ""), "first_point": len(down)}
        whole = whole.assign(events_of_branch(self.events, self.key, self.units))
        return whole.assign_attrs({**self.origin, **ends})


@contextmanager
def _told(progress: bool, key: str) -> Any:
    """Yield a function that shows the points found and the value of the parameter."""
    instance("progress", progress, bool)
    if not progress:
        yield lambda found, value: None
        return
    with bar(f"follow over {key}", asked=True) as show:
        yield lambda found, value: show(found, found + 1, f"{found} points, {key} {value:.5g}")
