"""Records in NetCDF files, written whole or not at all."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr
from h5netcdf.utils import CompatibilityError

from ..checks import ArgumentError, in_one_line, instance
from ..disk import check_writable, named, read, write

MAGIC = b"\x89HDF\r\n\x1a\n"


def save(run: xr.Dataset, path: str | Path) -> None:
    """Write a record to a NetCDF file, compressed without loss.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    path : str or Path
        The file; one that is there is replaced once the new one is complete.

    Raises
    ------
    OSError
        If the file cannot be written; nothing half-written is left under its name.
    """
    instance("run", run, xr.Dataset)
    check_writable(path)
    plain = run.drop_encoding()
    numbers = [name for name, values in plain.variables.items() if values.dtype.kind in "fi" and values.size]
    encoding = {name: {"zlib": True, "shuffle": True, "complevel": 1} for name in numbers if plain[name].ndim}
    # Built in memory: on a full disk the HDF5 library brings the process down instead of raising.
    with _locks_of_this_process():
        try:
            content = plain.to_netcdf(engine="h5netcdf", encoding=encoding)
        except (TypeError, ValueError, NotImplementedError, CompatibilityError) as error:
            raise ArgumentError(
                "run", "hold what NetCDF can keep", run, got=f"other things: {in_one_line(error)}"
            ) from error
    write(path, content)


def load(path: str | Path) -> xr.Dataset:
    """Read a record back into memory.

    Parameters
    ----------
    path : str or Path
        A file that `save` wrote.

    Returns
    -------
    xarray.Dataset
        The record, equal to the one saved.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not a record.
    """
    scenario_of(path)
    with _readable(path):
        run = xr.load_dataset(path, engine="h5netcdf", decode_times=False)
    run.attrs = {name: value.item() if isinstance(value, np.generic) else value for name, value in run.attrs.items()}
    return run.drop_encoding()


def scenario_of(path: str | Path) -> tuple[str, str]:
    """Return the title and the scenario, as TOML, that a record file carries."""
    attributes: dict[str, Any] = {}
    if is_record(path):
        with _readable(path), h5py.File(path, "r") as file:
            attributes = {name: file.attrs[name] for name in ("title", "scenario") if name in file.attrs}
    if not isinstance(attributes.get("scenario"), str):
        raise ArgumentError("path", "be a record that stridula wrote", path, got=named(path))
    title = attributes.get("title")
    return (title if isinstance(title, str) else ""), attributes["scenario"]


def is_record(path: str | Path) -> bool:
    """Return whether a file is of the kind that records are kept in."""
    return read(path, len(MAGIC)) == MAGIC


@contextmanager
def _locks_of_this_process() -> Iterator[None]:
    """Keep xarray from asking the scheduler of a dask client for a lock on what is in the memory of this process."""
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
            "path", "be a whole record", path, got=f"the damaged {named(path)}: {in_one_line(error)}"
        ) from error
