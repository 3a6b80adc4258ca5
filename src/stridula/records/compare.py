"""Comparison of two records: size and beginning of their differences."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, instance, listed, non_negative, positive
from .checked import check_times
from .export import Column, columns
from .variables import ENERGY, SOLVE, STATUS, described

# The dominant status, which follows from the shares, and the effort of the solver are not compared.
LEFT_OUT = (STATUS.name, *(variable.name for variable in SOLVE))
# Variables that are normally round-off are compared relative to others of their kind: the ledger's residual to the
# largest energy; gap and height, which are round-off on a rigid floor, to the largest length in the record.
ENERGIES = tuple(variable.name for variable in ENERGY)
DISTANCES = ("gap", "contact_height")
LENGTHS = (*DISTANCES, "displacement")
UNLIKE = ("compile_time", "wall_time", "scenario", "last_step", "largest_energy")
NOT_THERE = "not there"


def compare(a: xr.Dataset, b: xr.Dataset, tolerance: float = 1e-6) -> xr.Dataset:
    """Compare two records sample by sample over their common time.

    Parameters
    ----------
    a, b : xarray.Dataset
        Records of `simulate` with the same sample interval.
    tolerance : float, optional
        Difference, relative to the largest value of `a`, above which a variable counts as different [1].

    Returns
    -------
    xarray.Dataset
        Over ``variable`` (each contact, probe and status separately): ``difference``, the largest one, in ``units``;
        ``relative_difference`` to the largest value of `a`; for energies to the largest energy, for ``gap`` and
        ``contact_height`` to the largest length of `a` over all its contacts: heights, gaps, displacement probes and
        the range of ``contact_position``; ``first_time`` [s] at which it exceeds the tolerance, NaN if never. The
        dominant status and the sweeps of the solver are left out. Over ``variable`` and ``record`` (a, b): ``mean`` and
        ``rms``; the means of ``status_share`` are the shares of the states. Over ``attribute`` and ``record``:
        ``value``, for attributes and keys of the scenario that differ. Attributes: ``within_tolerance`` (1 or 0),
        ``samples``, the number of compared samples, ``samples_a`` and ``samples_b``.

    Raises
    ------
    ValueError
        If they are not records, have no samples, their sample intervals differ, or they have no time or no variable in
        common.
    """
    non_negative("tolerance", tolerance)
    first, second = _common(a, b)
    ours = {column.name: column for column in columns(first) if column.variable not in LEFT_OUT}
    theirs = {column.name: column for column in columns(second) if column.variable not in LEFT_OUT}
    names = [name for name in ours if name in theirs]
    if not names:
        raise ArgumentError("b", "have a variable in common with a", b, got=listed(theirs))
    scales = _scales(ours)
    time = first["time"].values
    rows = [_difference(ours[name], theirs[name], scales[name], time, tolerance) for name in names]
    difference, relative, since = (np.array(column) for column in zip(*rows, strict=True))
    result = xr.Dataset(coords={"variable": names, "record": ["a", "b"]})
    result["units"] = ("variable", [ours[name].units for name in names])
    result["difference"] = ("variable", difference, {"long_name": "largest difference"})
    result["relative_difference"] = ("variable", relative, described("1", "relative to a's largest"))
    result["first_time"] = ("variable", since, described("s", "first time above the tolerance"))
    for word, measure in (("mean", np.nanmean), ("rms", _rms)):
        values = [[_statistic(measure, side[name].values) for side in (ours, theirs)] for name in names]
        result[word] = (("variable", "record"), np.array(values))
    unlike = _unlike(a, b) | _one_sided(ours, theirs)
    result.coords["attribute"] = ("attribute", np.array(list(unlike), dtype=str))
    result["value"] = (("attribute", "record"), np.array(list(unlike.values()), dtype=str).reshape(-1, 2))
    result.attrs = {
        "tolerance": float(tolerance),
        "within_tolerance": int(bool(np.all(relative <= tolerance))),
        "samples": int(time.size),
        "samples_a": int(a.sizes["time"]),
        "samples_b": int(b.sizes["time"]),
    }
    return result


def _common(a: xr.Dataset, b: xr.Dataset) -> tuple[xr.Dataset, xr.Dataset]:
    """Return the two records over their common time."""
    numbers: list[Array] = []
    intervals = []
    for name, record in (("a", a), ("b", b)):
        instance(name, record, xr.Dataset)
        if "time" not in record.dims or "sample_interval" not in record.attrs:
            raise ArgumentError(name, "be a record of simulate", got=f"variables {listed(map(str, record))}")
        if not record.sizes["time"]:
            raise ArgumentError(name, "have samples to compare", got="a record without any")
        check_times(name, record["time"])
        intervals.append(positive(f"{name}.sample_interval", record.attrs["sample_interval"]))
        numbers.append(np.rint(record["time"].values / intervals[-1]).astype(np.int64))
    if abs(intervals[1] - intervals[0]) > 1e-9 * intervals[0]:
        raise ArgumentError(
            "b", f"have the same sample interval as a, {intervals[0]!r} s", intervals[1], got=f"{intervals[1]!r} s"
        )
    _, ours, theirs = np.intersect1d(numbers[0], numbers[1], return_indices=True)
    if ours.size == 0:
        spans = [f"{r['time'].values[0]:.6g} to {r['time'].values[-1]:.6g} s" for r in (a, b)]
        raise ArgumentError("b", f"overlap a in time, {spans[0]}", b, got=spans[1])
    return a.isel(time=ours), b.isel(time=theirs)


def _difference(
    ours: Column, theirs: Column, scale: float, time: Array, tolerance: float
) -> tuple[float, float, float]:
    """Return the largest difference, the same relative to the scale, and the time it first exceeds the tolerance."""
    first, second = (np.asarray(column.values, dtype=float) for column in (ours, theirs))
    same = (first == second) | (np.isnan(first) & np.isnan(second))
    apart = np.where(same, 0.0, np.abs(np.where(same, 0.0, second) - np.where(same, 0.0, first)))
    apart = np.where(np.isnan(apart), np.inf, apart)
    largest = float(apart.max())
    relative = np.divide(apart, scale, out=np.where(apart > 0.0, np.inf, 0.0), where=scale > 0.0)
    beyond = np.flatnonzero(relative > tolerance)
    return largest, float(relative.max()), float(time[beyond[0]]) if beyond.size else float("nan")


def _scales(table: Mapping[str, Column]) -> dict[str, float]:
    """Return the largest value of each column, or of its kind."""
    own = {name: _largest(column.values) for name, column in table.items()}
    energy = max((own[name] for name, column in table.items() if column.variable in ENERGIES), default=0.0)
    lengths = [own[name] for name, column in table.items() if column.variable in LENGTHS]
    lengths += [_range(column.values) for column in table.values() if column.variable == "contact_position"]
    length = max(lengths, default=0.0)
    kinds = dict.fromkeys(ENERGIES, energy) | dict.fromkeys(DISTANCES, length)
    return {name: kinds.get(column.variable, own[name]) for name, column in table.items()}


def _largest(values: Array) -> float:
    finite = values[np.isfinite(values)]
    return float(np.abs(finite).max(initial=0.0))


def _range(values: Array) -> float:
    finite = values[np.isfinite(values)]
    return float(np.ptp(finite)) if finite.size else 0.0


def _rms(values: Array) -> float:
    largest = _largest(values) or 1.0
    return largest * float(np.sqrt(np.nanmean(np.square(values / largest))))


def _statistic(measure: Any, values: Array) -> float:
    plain = np.asarray(values, dtype=float)
    return float("nan") if np.isnan(plain).all() else float(measure(plain))


def _unlike(a: xr.Dataset, b: xr.Dataset) -> dict[str, tuple[str, str]]:
    """Return the attributes and the keys of the scenarios that differ, with both values."""
    sides = [dict(record.attrs) for record in (a, b)]
    flat = [{str(k): v for k, v in side.items() if k not in UNLIKE} for side in sides]
    for one, side in zip(flat, sides, strict=True):
        one |= {f"scenario.{key}": value for key, value in _keys(_scenario(side))}
    names = dict.fromkeys((*flat[0], *flat[1]))
    missing = object()
    pairs = {name: (flat[0].get(name, missing), flat[1].get(name, missing)) for name in names}
    return {
        name: (_shown(first, missing), _shown(second, missing))
        for name, (first, second) in pairs.items()
        if first is missing or second is missing or first != second
    }


def _one_sided(ours: Mapping[str, Column], theirs: Mapping[str, Column]) -> dict[str, tuple[str, str]]:
    """Return the variables that only one of the records has."""
    only = {f"variable {name}": ("recorded", NOT_THERE) for name in ours if name not in theirs}
    return only | {f"variable {name}": (NOT_THERE, "recorded") for name in theirs if name not in ours}


def _scenario(attributes: Mapping[str, Any]) -> dict[str, Any]:
    try:
        return tomllib.loads(str(attributes.get("scenario", "")))
    except tomllib.TOMLDecodeError:
        return {}


def _keys(table: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Iterate over the values of nested tables and lists of tables, by their full keys."""
    if isinstance(table, dict):
        for name, value in table.items():
            yield from _keys(value, f"{path}.{name}" if path else name)
    elif isinstance(table, list) and table and all(isinstance(entry, dict) for entry in table):
        for number, value in enumerate(table):
            yield from _keys(value, f"{path}.{number}")
    else:
        yield path, table


def _shown(value: Any, missing: object) -> str:
    text = NOT_THERE if value is missing else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
