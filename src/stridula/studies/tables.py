"""Surveys as tables for other programs, with one row for each mode of each point."""

from __future__ import annotations

import csv
import io
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, instance, listed
from .surveyed import NUMBERS, OF_POINTS, WORDS

COLUMNS = (*(name for name in OF_POINTS if name != "message"), "mode", *NUMBERS, *WORDS, "tone_frequency", "message")


def survey_table(found: xr.Dataset) -> str:
    """Return a survey as comma-separated values, in SI except for the keys, which keep their units.

    A point without a growing mode has one row. ``tone_frequency`` is that of the strongest tone. A survey with
    derivatives has two more columns for each parameter, such as ``d_growth_rate by friction``, per unit in SI.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `squeal_survey`.

    Raises
    ------
    ValueError
        If it is anything else.
    """
    instance("found", found, xr.Dataset)
    if any(name not in found for name in (*OF_POINTS, *NUMBERS, *WORDS, "mode", "tone_frequency")):
        raise ArgumentError("found", "be a survey", found, got=f"variables {listed(map(str, found))}")
    dims, keys = found["verdict"].dims, [str(name) for name in found["verdict"].coords if name != "point"]
    by = found["parameter"].values.tolist() if "d_growth_rate" in found else []
    slopes = [(name, key) for key in by for name in ("d_growth_rate", "d_frequency")]
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    writer.writerow([*keys, *COLUMNS, *(f"{name} by {key}" for name, key in slopes)])
    for place in np.ndindex(found["verdict"].shape):
        point = found.isel(dict(zip(dims, place, strict=True)))
        there = np.flatnonzero(np.isfinite(point["frequency"].values)).tolist()
        for mode in there if there else (None,):
            cells = [_plain(point[key]) for key in keys] + [_cell(point, name, mode) for name in COLUMNS]
            of_parameters = [point[name].sel(parameter=key) for name, key in slopes]
            cells += ["" if mode is None else _plain(one.isel(mode=mode)) for one in of_parameters]
            writer.writerow(cells)
    return lines.getvalue()


def _cell(point: xr.Dataset, name: str, mode: int | None) -> Any:
    if name in OF_POINTS:
        return _plain(point[name])
    if mode is None:
        return ""
    one = point[name].isel(mode=mode) if name != "mode" else point["mode"][mode]
    return _plain(one.isel(tone=0) if "tone" in one.dims else one)


def _plain(one: xr.DataArray) -> Any:
    """Return a value as text or number, an empty text for NaN."""
    value = one.item()
    return "" if isinstance(value, float) and np.isnan(value) else value
