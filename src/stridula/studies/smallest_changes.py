"""The smallest change of parameters with which no mode of sliding grows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, by_key, count, counted, finite, instance, non_negative, positive
from ..integration.bars import bar_if
from ..records.variables import described
from ..system import System
from .change_search import Search
from .changed_systems import Range, systems_of_function, systems_of_tables
from .mode_derivatives import Where
from .task import one_thread_each

SystemOf = Callable[..., System]
Source = str | Path | xr.Dataset | System | SystemOf
# Factor of the grid of conditions on which a result is checked; most times that the worst of these is added.
FINER, ROUNDS = 4, 6


def smallest_change(
    source: Source,
    ranges: Mapping[str, Range],
    over: Mapping[str, Range] | None = None,
    *,
    masses: Mapping[str, tuple[Where, float]] | None = None,
    start: Mapping[str, float] | None = None,
    margin: float = 0.0,
    points: int = 7,
    most: int = 1500,
    overrides: Mapping[str, Any] | None = None,
    velocity: float | Sequence[float] | None = None,
    seed: int = 0,
    progress: bool = False,
) -> xr.Dataset:
    """Return the smallest change of parameters with which no mode of sliding grows, over a range of conditions.

    The size of a change is the root of the sum of squares of the changes of the parameters, each relative to the
    width of its range. The largest growth over all modes and conditions has kinks where modes change places, and no
    slope where two of them merge without damping, so that the search compares sizes and growths alone: along directions
    all around and by differential evolution, then by a simplex search of the direction of the change, with the
    smallest size along each by bisection. The result is checked on a grid of conditions four times as fine; the worst
    of them are added and the search is repeated until the check holds. No global search is certain: a smaller change
    may exist in a narrow region.

    Parameters
    ----------
    source : str, Path, xarray.Dataset, System or callable
        A scenario, a system, or a function of the parameters and conditions by name that makes a system, such as one
        that calls `modify`, whose bodies keep their modes.
    ranges : mapping
        Lowest and highest value of each parameter, in SI, by key as for `mode_sensitivity`, or by name for a function.
    over : mapping, optional
        Lowest and highest value of each condition, such as the coefficient of friction or a load, by key or name; by
        default the conditions given.
    masses : mapping, optional
        Point masses that may be added to a scenario or a system, by name: a point, as for `mode_sensitivity`, and the
        largest mass [kg].
    start : mapping, optional
        Present value of each parameter of a function, for which it is needed.
    margin : float, optional
        Least decay of all modes that vibrate [1/s].
    points : int, optional
        Values of each condition on the first grid, at least 2.
    most : int, optional
        About the largest number of changes that are tried in each of the repetitions, each at all conditions.
    overrides : mapping, optional
        Values of other keys.
    velocity : float or sequence of float, optional
        Slip velocity where nothing prescribes it [m/s], as for `sliding_stability`.
    seed : int, optional
        Seed of the search: equal seeds give equal results.
    progress : bool, optional
        Whether a bar on standard error shows the changes tried.

    Returns
    -------
    xarray.Dataset
        Over ``parameter``: its ``given`` and ``changed`` value, ``low`` and ``high``, and ``units``. ``size`` [1] of
        the change; ``found``, whether no mode grows on the fine grid. Over ``condition``, that grid: the values of the
        conditions, ``given_growth_rate`` and ``growth_rate`` [1/s], the largest of the modes that vibrate, and
        ``equilibrium``. ``attrs["verdict"]`` says it in words, with the best that was reached where nothing was found.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used, or a key is not known or means several places.
    ValueError
        If an argument is out of its range, or a present value is outside of its range.
    """
    instance("progress", progress, bool)
    non_negative("margin", margin)
    count("points", points, low=2)
    count("most", most, low=50)
    count("seed", seed, low=0)
    asked, conditions = _ranges("ranges", ranges), _ranges("over", by_key("over", over))
    twice = next((name for name in asked if name in conditions), None)
    if twice is not None:
        raise ArgumentError("over", "have other keys than ranges", twice)
    lumps = {name: _lump(name, one) for name, one in by_key("masses", masses).items()}
    systems: Any = systems_of_function(source, asked, start, masses, overrides)
    if systems is None:
        systems = systems_of_tables(source, asked, conditions, lumps, by_key("overrides", overrides))
    if not systems.given:
        raise ArgumentError("ranges", "hold at least one key", ranges, got="none")
    with one_thread_each(), bar_if(progress, "smallest change") as show:
        return _found(Search(systems, conditions, margin, velocity, most, seed, show), points)


def _ranges(name: str, given: Any) -> dict[str, Range]:
    """Return ranges by key as pairs of numbers."""
    found = {}
    for key, one in by_key(name, given).items():
        where = f"{name}[{key!r}]"
        if isinstance(one, str) or not isinstance(one, Sequence) or len(one) != 2:
            raise ArgumentError(where, "be a lowest and a highest value", one)
        low, high = (finite(f"{where}[{number}]", value) for number, value in enumerate(one))
        if not high > low:
            raise ArgumentError(where, "rise", one)
        found[str(key)] = (low, high)
    return found


def _lump(name: str, one: Any) -> tuple[Any, float]:
    where = f"masses[{name!r}]"
    if not isinstance(one, tuple) or len(one) != 2:
        raise ArgumentError(where, "be a point and the largest mass", one)
    return one[0], positive(f"{where}[1]", one[1])


def _found(search: Search, points: int) -> xr.Dataset:
    """Return the result, with the worst conditions of the fine grid added until no mode grows there."""
    conditions, fine = search.grid(points), search.grid(FINER * (points - 1) + 1)
    change: Array | None = None
    for _ in range(ROUNDS):
        change, excess = search.smallest(conditions, change)
        over = [search.above(search.state(change, one), one) for one in fine]
        worst = int(np.argmax(over))
        if excess > 0.0 or over[worst] <= 0.0 or fine[worst] in conditions:
            break
        conditions.append(fine[worst])
    assert change is not None
    return _dataset(search, change, fine)


def _dataset(search: Search, change: Array, fine: Sequence[tuple[float, ...]]) -> xr.Dataset:
    systems, after = search.systems, [search.state(change, one) for one in fine]
    before = [search.before(one) for one in fine]
    quiet = all(search.above(state, one) <= 0.0 for state, one in zip(after, fine, strict=True))
    changed, size = search.values(change), float(np.linalg.norm(change))
    growth = described("1/s", "largest growth rate of the modes that vibrate")
    ends = np.array([systems.ranges[name] for name in search.names])
    data: dict[str, Any] = {
        "given": ("parameter", list(systems.given.values())),
        "changed": ("parameter", list(changed.values())),
        "low": ("parameter", ends[:, 0]),
        "high": ("parameter", ends[:, 1]),
        "size": ((), size, described("1", "size of the change, relative to the ranges")),
        "found": ((), quiet, described("1", "whether no mode grows")),
        "given_growth_rate": ("condition", [one.growth for one in before], growth),
        "growth_rate": ("condition", [one.growth for one in after], growth),
        "equilibrium": ("condition", [one.kind for one in after]),
    }
    places = np.array(fine).reshape(len(fine), len(search.over)).T
    conditions = {name: ("condition", column) for name, column in zip(search.over, places, strict=True)}
    units = {"units": ("parameter", list(systems.units.values()))}
    found = xr.Dataset(data, {"parameter": search.names, **units, **conditions})
    return found.assign_attrs(verdict=_verdict(found, search.margin), margin=search.margin)


def _verdict(found: xr.Dataset, margin: float) -> str:
    """Return the result in words."""
    growth, before = (float(found[name].max()) for name in ("growth_rate", "given_growth_rate"))
    at = f"at {counted(found.sizes['condition'], 'condition')}"
    rates = f"growth {growth:.4g} 1/s, {before:.4g} 1/s as given, {at}"
    if still := int((found["equilibrium"] != "sliding").sum()):
        rates += f", of which {still} {'does' if still == 1 else 'do'} not slide steadily"
    goal = f"every mode decays by {margin:g} 1/s or more" if margin else "no mode grows"
    if not bool(found["found"]):
        return f"no change within the ranges was found with which {goal}; at best {rates}"
    names = ("parameter", "given", "changed", "units")
    words = [
        f"{name} from {given:.4g} to {changed:.4g} {'' if units == '1' else units}".rstrip()
        for name, given, changed, units in zip(*(found[one].values for one in names), strict=True)
        if changed != given
    ]
    return f"{goal} with {', '.join(words)}; {rates}" if words else f"{goal} as given; {rates}"
