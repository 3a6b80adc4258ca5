"""Records in NetCDF files, written whole or not at all."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, at_least, in_one_line, instance
from ..disk import RECORDS, check_ending, check_writable, named, read, write
from ..extras import named_extras, require

MAGIC = b"\x89HDF\r\n\x1a\n"
# Largest size of all variables of a record together, unpacked [bytes].
LARGEST = 16 * 1024**3


def save(run: xr.Dataset, path: str | Path) -> None:
    """Write a record to a NetCDF file, compressed without loss.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    path : str or Path
        The file; an existing one is replaced once the new one is complete.

    Raises
    ------
    ValueError
        If `run` is no record, has more than 16 GiB or NetCDF cannot store it, or if `path` has the ending of another
        format, such as ``.csv``: `export` writes tables.
    OSError
        If the file cannot be written; no partial file is left.
    ImportError
        If the extra ``files`` is not installed.
    """
    instance("run", run, xr.Dataset)
    if run.nbytes > LARGEST:
        raise ArgumentError(
            "run", f"have at most {LARGEST // 1024**3} GiB", got=f"{at_least(run.nbytes / 1024**3, 3)} GiB"
        )
    check_ending("path", path, RECORDS, "NetCDF file", "export writes tables, plot figures")
    require("h5py")
    with named_extras():
        from h5netcdf.utils import CompatibilityError
    check_writable(path)
    plain = run.drop_encoding()
    numbers = [name for name, values in plain.variables.items() if values.dtype.kind in "fi" and values.size]
    encoding = {name: {"zlib": True, "shuffle": True, "complevel": 1} for name in numbers if plain[name].ndim}
    # Built in memory: on a full disk the HDF5 library crashes the process instead of raising.
    with _locks_of_this_process():
        try:
            content = plain.to_netcdf(engine="h5netcdf", encoding=encoding)
        except (TypeError, ValueError, NotImplementedError, CompatibilityError) as error:
            raise ArgumentError(
                "run", "hold only values that NetCDF can store", run, got=f"others: {in_one_line(error)}"
            ) from error
    # Released here because Python 3.13 and later complain if a file in memory is collected before its content.
    with content:
        write(path, content)


def load(path: str | Path) -> xr.Dataset:
    """Read a record back into memory.

    Parameters
    ----------
    path : str or Path
        A file written by `save`.

    Returns
    -------
    xarray.Dataset
        The record, equal to the one saved.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not a record, has more than 16 GiB when unpacked, or refers to data in other files.
    ImportError
        If the extra ``files`` is not installed.
    """
    origin_of(path)
    _check_size(path)
    with _readable(path):
        run = xr.load_dataset(path, engine="h5netcdf", decode_times=False)
    run.attrs = {name: value.item() if isinstance(value, np.generic) else value for name, value in run.attrs.items()}
    return run.drop_encoding()


def scenario_of(path: str | Path) -> tuple[str, str]:
    """Return the title and the scenario, as TOML, in a record file.

    Raises
    ------
    ValueError
        If it is not a record, or comes from a function, which has no scenario.
    """
    origin = origin_of(path)
    if "scenario" not in origin:
        got = f"{named(path)}, of the function {origin['function']}"
        raise ArgumentError("path", "be a record of a scenario", path, got=got)
    return origin.get("title", ""), origin["scenario"]


def origin_of(path: str | Path) -> dict[str, str]:
    """Return the origin of a record file: ``title``, and ``scenario`` or ``function``.

    Raises
    ------
    ValueError
        If it is not a record.
    """
    require("h5netcdf")
    with named_extras():
        import h5py
    found: dict[str, Any] = {}
    if is_record(path):
        with _readable(path), h5py.File(path, "r") as file:
            found = {name: file.attrs[name] for name in ("title", "scenario", "function") if name in file.attrs}
    origin = {name: value for name, value in found.items() if isinstance(value, str)}
    if not {"scenario", "function"} & set(origin):
        raise ArgumentError("path", "be a record that stridula wrote", path, got=named(path))
    return origin


def is_record(path: str | Path) -> bool:
    """Return whether a file is an HDF5 file, as records are."""
    return read(path, len(MAGIC)) == MAGIC


def _check_size(path: str | Path) -> None:
    """Raise ValueError if the variables of a file are too large when unpacked, or lie elsewhere."""
    with named_extras():
        import h5py
    size, elsewhere = 0, []
    with _readable(path), h5py.File(path, "r") as file:
        for name in file:
            # A link to another file is not followed.
            found = file[name] if isinstance(file.get(name, getlink=True), h5py.HardLink) else None
            if not isinstance(found, h5py.Dataset) or found.external or found.is_virtual:
                elsewhere.append(name)
            else:
                size += (found.size or 0) * found.dtype.itemsize
    if elsewhere:
        raise ArgumentError("path", "hold all its variables itself", path, got=f"{elsewhere[0]!r} of {named(path)}")
    if size > LARGEST:
        got = f"{at_least(size / 1024**3, 3)} GiB in {named(path)}"
        raise ArgumentError("path", f"have at most {LARGEST // 1024**3} GiB when unpacked", path, got=got)


@contextmanager
def _locks_of_this_process() -> Iterator[None]:
    """Keep xarray from asking the scheduler of a dask client for a lock on data in the memory of this process."""
    dask = sys.modules.get("dask")
    if dask is None:
        yield
        return
    with dask.config.set(scheduler="threads"):
        yield


@contextmanager
def _readable(path: str | Path) -> Iterator[None]:
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        raise ArgumentError(
            "path", "be a complete record", path, got=f"the damaged {named(path)}: {in_one_line(error)}"
        ) from error
