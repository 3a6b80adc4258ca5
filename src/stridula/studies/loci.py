"""Root loci: modes of sliding over one parameter, and the values at which they begin to grow."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from scipy.optimize import linear_sum_assignment

from ..analysis.stability import sliding_stability
from ..arrays import Array
from ..checks import ArgumentError, brief, by_key, finite, instance, positive
from ..records.provenance import toml
from ..records.variables import described
from ..scenarios import load_scenario
from ..scenarios.keys import overridden
from ..scenarios.read import read_tables
from ..system import System
from ..version import __version__
from .task import one_thread_each

# Names of the variables of root loci.
OWN = ("mode", "frequency", "growth_rate", "unstable", "unstable_modes", "equilibrium", "equilibria")
SystemOf = Callable[[float], System]
Source = str | Path | xr.Dataset | SystemOf


def root_loci(
    source: Source,
    key: str,
    values: Sequence[float] | Array,
    *,
    units: str = "",
    overrides: Mapping[str, Any] | None = None,
    highest: float | None = None,
    **options: Any,
) -> xr.Dataset:
    """Return frequencies and growth rates of the modes of sliding over a parameter.

    Modes are tracked from value to value: each continues as the mode whose exponent is nearest to the linear
    extrapolation of its last two. Two modes that lock in share a frequency from there on.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or callable
        A scenario, as for `load_scenario`, or a function that makes a system from a value.
    key : str
        The parameter: its key in the scenario, such as ``friction``, ``angle``, ``contact.at`` or ``damping``; for a
        function only a name.
    values : sequence of float
        Values of the parameter, rising, at least 2, in `units`.
    units : str, optional
        Unit of the values as in scenarios, such as ``deg``; SI if left out.
    overrides : mapping, optional
        Other values to set in the scenario by key.
    highest : float, optional
        Highest frequency of the tracked modes [Hz]; modes above it still count as unstable.
    **options
        Arguments of `sliding_stability` such as `status` and `velocity`.

    Returns
    -------
    xarray.Dataset
        Over the parameter and ``mode``: ``frequency`` [Hz], ``growth_rate`` [1/s] and whether ``unstable``, NaN and
        False where a mode does not exist; over the parameter ``equilibrium``, ``equilibria`` as in
        `sliding_stability`, and ``unstable_modes``, the number of all growing modes.

    Raises
    ------
    ValueError
        If an argument is out of its range, or a value gives no system.
    """
    modes_of = _modes_of(source, key, units, overrides, options)
    if key in OWN:
        raise ArgumentError(
            "key", "not have the name of a result of the loci", key, got=f"{brief(key)}: write its full key"
        )
    grid = rising(values)
    if highest is not None:
        positive("highest", highest)
    with one_thread_each():
        found = [modes_of(value) for value in grid.tolist()]
    exponents = [_exponents(one, highest) for one in found]
    followed = _followed(exponents)
    slack = np.array([one.attrs["round_off"] for one in found])
    both = (key, "mode")
    return xr.Dataset(
        {
            "frequency": (both, followed.imag / (2.0 * np.pi), described("Hz", "frequency of vibration")),
            "growth_rate": (both, followed.real, described("1/s", "rate at which the amplitude grows")),
            "unstable": (both, followed.real > slack[:, None], described("1", "whether the mode grows")),
            "unstable_modes": (
                key,
                [int(one.unstable.sum()) for one in found],
                described("1", "number of growing modes"),
            ),
            "equilibrium": (key, [one.attrs["equilibrium"] for one in found]),
            "equilibria": (key, [one.attrs["equilibria"] for one in found]),
        },
        {key: (key, grid, {"units": units}), "mode": np.arange(followed.shape[1])},
        origin_of(source, overrides),
    )


def critical_value(
    source: Source,
    key: str,
    low: float,
    high: float,
    *,
    tolerance: float = 1e-6,
    units: str = "",
    overrides: Mapping[str, Any] | None = None,
    **options: Any,
) -> xr.Dataset:
    """Return the value of a parameter at which sliding becomes unstable, by bisection.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or callable
        A scenario, as for `load_scenario`, or a function that makes a system from a value.
    key : str
        The parameter, as for `root_loci`.
    low, high : float
        Values between which stability changes, in `units`; stable at one end and not at the other.
    tolerance : float, optional
        Final width of the interval, relative to the larger magnitude of `low` and `high` [1].
    units : str, optional
        Unit of the values as in scenarios, such as ``deg``; SI if left out.
    overrides : mapping, optional
        Other values to set in the scenario by key.
    **options
        Arguments of `sliding_stability` such as `status` and `velocity`.

    Returns
    -------
    xarray.Dataset
        ``value``, the middle of ``stable`` and ``unstable``, the values closest to it on both sides; ``frequency`` [Hz]
        and ``growth_rate`` [1/s] of the mode that grows fastest at ``unstable``. ``attrs["beyond"]`` is ``stable``, or
        ``held``, ``lifted off`` or ``jammed`` if there is no sliding on that side.

    Raises
    ------
    ValueError
        If an argument is out of its range, or both ends are stable or both unstable.
    """
    modes_of = _modes_of(source, key, units, overrides, options)
    if finite("high", high) <= finite("low", low):
        raise ArgumentError("high", f"be above low ({brief(low)})", high)
    positive("tolerance", tolerance)
    low, high = float(low), float(high)
    with one_thread_each():
        return _bisected(key, modes_of, low, high, tolerance, units)


def _bisected(
    key: str, modes_of: Callable[[float], xr.Dataset], low: float, high: float, tolerance: float, units: str
) -> xr.Dataset:
    """Return the value between two others at which stability changes."""
    at = {value: modes_of(value) for value in (low, high)}
    grows = {value: bool(one.unstable.any()) for value, one in at.items()}
    if grows[low] == grows[high]:
        raise ArgumentError(
            "low and high",
            f"be stable and unstable in {key}",
            got=f"{_verdict(at[low])} at {low!r} and {_verdict(at[high])} at {high!r}",
        )
    width = tolerance * max(abs(low), abs(high))
    while high - low > width:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        at[middle] = modes_of(middle)
        grows[middle] = bool(at[middle].unstable.any())
        low, high = (middle, high) if grows[middle] == grows[low] else (low, middle)
    stable, unstable = (low, high) if grows[high] else (high, low)
    modes = at[unstable]
    fastest = modes.isel(mode=int(modes.growth_rate.values.argmax()))
    return xr.Dataset(
        {
            "value": (
                (),
                0.5 * (low + high),
                described(units, f"{key} at which sliding becomes unstable"),
            ),
            "stable": ((), stable, described(units, "nearest value that is stable")),
            "unstable": ((), unstable, described(units, "nearest value that is unstable")),
            "frequency": ((), float(fastest.frequency), described("Hz", "frequency of the mode that grows fastest")),
            "growth_rate": ((), float(fastest.growth_rate), described("1/s", "growth rate of that mode")),
        },
        attrs={"parameter": key, "tolerance": tolerance, "beyond": _verdict(at[stable])},
    )


def critical_values(loci: xr.Dataset, find: Callable[[float, float], xr.Dataset]) -> list[xr.Dataset]:
    """Return the values at which stability changes along root loci, each found by `find` between two of theirs.

    Parameters
    ----------
    loci : xarray.Dataset
        Result of `root_loci`.
    find : callable
        Function of two values with the result of `critical_value`.
    """
    key = parameter_of(loci)
    grows = loci["unstable_modes"].values > 0
    grid = loci[key].values
    return [find(float(grid[k]), float(grid[k + 1])) for k in np.flatnonzero(np.diff(grows))]


def parameter_of(loci: xr.Dataset) -> str:
    """Return the key of the parameter of root loci."""
    return str(loci["equilibrium"].dims[0])


def origin_of(source: Source, overrides: Mapping[str, Any] | None) -> dict[str, str]:
    """Return the attributes that record the origin of a result; nothing for a function."""
    if callable(source):
        return {}
    tables, _ = overridden(read_tables(source), by_key("overrides", overrides))
    words = {"title": str(tables.get("title", "")), "scenario": toml(tables)}
    return words | {"stridula_version": __version__}


def systems_over(source: Source, key: str, units: str, overrides: Mapping[str, Any] | None) -> SystemOf:
    """Return a function of a value of a parameter that returns the system."""
    instance("key", key, str)
    instance("units", units, str)
    given = dict(by_key("overrides", overrides))
    if key in given:
        raise ArgumentError("key", "be set or varied", key, got=f"both for {key!r}")

    def system_of(value: float) -> System:
        if callable(source):
            return source(value)
        # Keys of whole numbers accept only integers.
        number = int(value) if value.is_integer() else value
        return load_scenario(source, given | {key: f"{value!r} {units}" if units else number}).system

    return system_of


def _modes_of(
    source: Source, key: str, units: str, overrides: Mapping[str, Any] | None, options: Mapping[str, Any]
) -> Callable[[float], xr.Dataset]:
    """Return a function of a value that returns the modes."""
    system_of = systems_over(source, key, units, overrides)
    return lambda value: sliding_stability(system_of(value), **options)


def _verdict(modes: xr.Dataset) -> str:
    kind = str(modes.attrs["equilibrium"])
    return "unstable" if bool(modes.unstable.any()) else "stable" if kind == "sliding" else kind


def rising(values: Sequence[float] | Array) -> Array:
    """Return values of a parameter as an array; ArgumentError unless they are finite and rise."""
    try:
        grid = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        grid = np.empty(0)
    if grid.ndim != 1 or grid.size < 2 or not np.isfinite(grid).all() or (np.diff(grid) <= 0.0).any():
        raise ArgumentError("values", "be at least 2 increasing finite numbers", values)
    return grid


def _exponents(modes: xr.Dataset, highest: float | None) -> Array:
    exponents = modes.growth_rate.values + 2.0j * np.pi * modes.frequency.values
    return exponents if highest is None else exponents[modes.frequency.values <= highest]


def _followed(steps: Sequence[Array]) -> Array:
    """Return exponents by value and mode, with modes tracked; NaN where a mode does not exist."""
    rows = [np.asarray(steps[0], dtype=complex)]
    for step in steps[1:]:
        last = rows[-1]
        before = rows[-2][: last.size] if len(rows) > 1 else last
        lead = np.where(np.isfinite(before.real), 2.0 * last - before, last)
        row = np.full(last.size, complex(np.nan, np.nan))
        there = np.flatnonzero(np.isfinite(lead.real))
        taken, chosen = linear_sum_assignment(np.abs(lead[there, None] - step[None, :]))
        row[there[taken]] = step[chosen]
        new = np.delete(step, chosen)
        rows = [np.pad(old, (0, new.size), constant_values=complex(np.nan, np.nan)) for old in rows]
        rows.append(np.concatenate([row, new]))
    return np.array(rows)
