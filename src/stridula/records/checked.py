"""Checks of records and signals as arguments: required variables are there, in the form of `simulate`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, brief, instance, listed
from .variables import ENERGY, STATUS_SHARE, STATUS_WORDS

NUMBERS = "fiu"
ENERGIES = frozenset(variable.name for variable in ENERGY)
# Upper bound of times of records [s].
LATEST = 1e9


def record(name: str, value: Any, *needed: str, least: int = 0) -> xr.Dataset:
    """Return a value if it is a record of `simulate`.

    Parameters
    ----------
    name : str
        Name of the argument.
    value : xarray.Dataset
        The record.
    *needed : str
        Required variables, numbers over ``time``.
    least : int, optional
        Least number of samples.

    Raises
    ------
    ValueError
        If it is something else, such as the name of a file, lacks a variable or samples, or its times do not increase.
    """
    if not isinstance(value, xr.Dataset):
        way = ": read a file with load" if isinstance(value, (str, Path)) else ""
        raise ArgumentError(name, "be a record of simulate, a Dataset", value, got=f"{brief(value)}{way}")
    lacking = [word for word in ("time", *needed) if word not in value.variables]
    if lacking:
        raise ArgumentError(name, f"be a record with {listed(lacking)}", value, got=f"one with {_held(value)}")
    check_times(name, value["time"])
    for word in needed:
        _check_variable(name, word, value[word])
    if value.sizes["time"] < least:
        raise ArgumentError(name, f"have at least {least} samples", value, got=value.sizes["time"])
    return value


def signal(name: str, value: Any) -> xr.DataArray:
    """Return a value if it is a signal over time: real numbers, with any other dimensions.

    Raises
    ------
    ValueError
        If it is something else, or its times do not increase.
    """
    instance(name, value, xr.DataArray)
    if "time" not in value.dims or "time" not in value.coords:
        raise ArgumentError(name, "be over time", value, got=f"the dimensions {listed(map(str, value.dims))}")
    check_real(name, str(value.name or "value"), value)
    check_times(name, value["time"])
    return value


def check_times(name: str, times: xr.DataArray) -> None:
    """Raise ValueError unless times are finite and increasing."""
    values = times.values
    if times.dims != ("time",) or values.dtype.kind not in NUMBERS:
        raise ArgumentError(
            name, "have a time of each sample in s", got=f"{times.dtype} over {listed(map(str, times.dims))}"
        )
    if not (np.abs(values) < LATEST).all() or (values[1:] <= values[:-1]).any():
        raise ArgumentError(name, "have finite, increasing times", got="others")


def check_real(name: str, word: str, variable: xr.DataArray) -> None:
    """Raise ValueError unless a variable holds real numbers."""
    if variable.dtype.kind not in NUMBERS + "b":
        raise ArgumentError(name, f"have a {word} of real numbers", got=variable.dtype)


def _check_variable(name: str, word: str, variable: xr.DataArray) -> None:
    if variable.dims[:1] != ("time",) or variable.dtype.kind not in NUMBERS:
        dimensions = listed(map(str, variable.dims))
        raise ArgumentError(name, f"have a {word} of numbers over time", got=f"{variable.dtype} over {dimensions}")
    if word in ENERGIES and variable.dims != ("time",):
        dimensions = listed(map(str, variable.dims))
        raise ArgumentError(name, f"have a {word} over time alone", got=f"one over {dimensions}")
    if word == STATUS_SHARE.name and variable.shape[1:][-1:] != (len(STATUS_WORDS),):
        wanted = ", ".join(STATUS_WORDS)
        raise ArgumentError(name, f"have a {word} of each of {wanted}", got=f"the shape {variable.shape}")


def _held(run: xr.Dataset) -> str:
    return listed(map(str, run.variables))
