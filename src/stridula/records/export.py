"""Records as tables for other programs: CSV and MATLAB."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Hashable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_least, instance
from ..disk import check_writable, named, write
from .checked import check_real, record

SUFFIXES = (".csv", ".mat")
# Limits of MATLAB's version 5 files: bytes of a variable, characters of a name.
LARGEST_VARIABLE = 2**31 - 1024
LONGEST_NAME = 63
KEYWORDS = (
    "break",
    "case",
    "catch",
    "classdef",
    "continue",
    "else",
    "elseif",
    "end",
    "for",
    "function",
    "global",
    "if",
)
MORE_KEYWORDS = ("otherwise", "parfor", "persistent", "return", "spmd", "switch", "try", "while")


@dataclass(frozen=True)
class Column:
    """One series of a record over time.

    Attributes
    ----------
    variable : str
        Name of the recorded variable.
    labels : tuple of str
        Names of its contact, probe and status, where there are several.
    units : str
        Unit.
    values : ndarray, shape (time,)
        Samples.
    """

    variable: str
    labels: tuple[str, ...]
    units: str
    values: Array

    @property
    def name(self) -> str:
        """Variable with its labels, such as ``acceleration [track centre y]``."""
        return f"{self.variable} [{'; '.join(self.labels)}]" if self.labels else self.variable


def columns(run: xr.Dataset) -> list[Column]:
    """Return every variable of a record over time, one column for each contact, probe and status."""
    record("run", run)
    found = []
    for name, variable in run.data_vars.items():
        if "time" not in variable.dims:
            continue
        check_real("run", str(name), variable)
        ordered = variable.transpose("time", ...)
        units = str(variable.attrs.get("units", "1"))
        for places in np.ndindex(ordered.shape[1:]):
            chosen = zip(ordered.dims[1:], places, strict=True)
            labels = tuple(str(run[word].values[k]) if _names(run, word) else str(k) for word, k in chosen)
            found.append(Column(str(name), labels, units, ordered.values[(slice(None), *places)]))
    return found


def _names(run: xr.Dataset, dimension: Hashable) -> bool:
    """Return whether there is a name for each place along a dimension."""
    return dimension in run.coords and run[dimension].dims == (dimension,)


def export(run: xr.Dataset, path: str | Path) -> None:
    """Write a record as a table for other programs; the ending of the name selects the format.

    - ``.csv``: lines of attributes and units that start with ``#``, a line of names, and one row per sample with all
      digits. ``pandas.read_csv(path, comment="#")`` reads it.
    - ``.mat``: MATLAB, version 5. Every variable as an array over time, and the structs ``units``, ``long_name``,
      ``labels`` (of contacts, probes and states) and ``attributes``.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    path : str or Path
        The file; an existing one is replaced once the new one is complete.

    Raises
    ------
    ValueError
        If `run` is not a record, the name has another ending, or a variable is too large for the format.
    OSError
        If the file cannot be written; no partial file is left.
    """
    instance("path", path, (str, Path))
    kind = Path(path).suffix.lower()
    if kind not in SUFFIXES:
        raise ArgumentError("path", f"end in {' or '.join(SUFFIXES)}", path, got=named(path))
    table = columns(run)
    check_writable(path)
    write(path, _csv(run, table) if kind == ".csv" else _mat(run))


def _csv(run: xr.Dataset, table: list[Column]) -> bytes:
    text = io.StringIO(newline="")
    for name, value in run.attrs.items():
        lines = str(value).splitlines() or [""]
        for line in [f"{name}: {lines[0]}", *(f"{name}| {line}" for line in lines[1:])]:
            text.write(f"# {line}\n")
    units = [str(run["time"].attrs.get("units", "s")), *(column.units for column in table)]
    text.write(f"# units: {','.join(units)}\n")
    lines_of = csv.writer(text, lineterminator="\n")
    lines_of.writerow(["time", *(" ".join(column.name.replace("#", " ").split()) for column in table)])
    # Python writes floats with as many digits as are needed to read them back equal.
    series = [run["time"].values.tolist(), *(column.values.tolist() for column in table)]
    lines_of.writerows(zip(*series, strict=True))
    return text.getvalue().encode("utf-8")


def _mat(run: xr.Dataset) -> memoryview:
    kept = {str(name): run[name] for name in run.data_vars if "time" in run[name].dims}
    names = _matlab_names(["time", *kept], taken=("units", "long_name", "labels", "attributes"))
    contents: dict[str, Any] = {}
    for name, variable in {"time": run["time"], **kept}.items():
        values = variable.transpose("time", ...).values
        if values.nbytes > LARGEST_VARIABLE:
            raise ArgumentError(name, "be below 2 GiB for a .mat file", got=f"{at_least(values.nbytes / 2**30, 3)} GiB")
        contents[names[name]] = values
    everything = {"time": run["time"], **kept}
    for word in ("units", "long_name"):
        contents[word] = {names[name]: str(variable.attrs.get(word, "")) for name, variable in everything.items()}
    dimensions = dict.fromkeys(word for variable in kept.values() for word in variable.dims[1:] if word in run.coords)
    contents["labels"] = _labels(run, [str(word) for word in dimensions])
    attributes = _matlab_names([str(name) for name in run.attrs])
    contents["attributes"] = {attributes[str(name)]: value for name, value in run.attrs.items()}
    file = io.BytesIO()
    filled = {name: value for name, value in contents.items() if not isinstance(value, dict) or value}
    scipy.io.savemat(file, filled, long_field_names=True, oned_as="column", do_compression=True)
    return file.getbuffer()


def _labels(run: xr.Dataset, dimensions: list[str]) -> dict[str, Any]:
    """Return the labels of each dimension as a cell array of texts."""
    names = _matlab_names(dimensions)
    return {names[word]: np.array([str(label) for label in run[word].values], dtype=object) for word in dimensions}


def _matlab_names(names: list[str], taken: tuple[str, ...] = ()) -> dict[str, str]:
    """Return a valid MATLAB name for each name: letters, digits and underscores, a letter first, all different."""
    given: dict[str, str] = {}
    for name in names:
        plain = re.sub(r"\W", "_", name, flags=re.ASCII)
        if not plain[:1].isalpha() or plain in (*KEYWORDS, *MORE_KEYWORDS) or plain in taken:
            plain = f"x_{plain}"
        plain, number = plain[:LONGEST_NAME], 1
        while plain in given.values():
            number += 1
            plain = f"{plain[: LONGEST_NAME - len(str(number)) - 1]}_{number}"
        given[name] = plain
    return given
