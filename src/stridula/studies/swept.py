"""Outcomes of the points of a sweep as one labelled Dataset."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError
from ..scenarios.varied import Varied
from .measures import OWN, Column
from .points import POINT, Layout
from .task import Outcome

# Text before the value in a message.
GOT = ", got "


def check_names(layout: Layout, columns: Sequence[Column]) -> None:
    """Raise ValueError if a key has the name of another variable of the sweep.

    Parameters
    ----------
    layout : Layout
        The points.
    columns : sequence of Column
        Variables of the measures.
    """
    taken = {*OWN, *(column.name for column in columns)} - ({POINT} if layout.is_grid else set())
    clash = next((key for key in layout.keys if key in taken), None)
    if clash is not None:
        raise ArgumentError(
            "key", "not have the name of a result of the sweep", clash, got=f"{clash!r}: write its full key"
        )


def swept(
    layout: Layout,
    keys: Sequence[Varied],
    values: Sequence[Sequence[Any]],
    columns: Sequence[Column],
    outcomes: Sequence[Outcome],
    attributes: dict[str, str],
) -> xr.Dataset:
    """Return the outcomes of the points as a Dataset.

    Parameters
    ----------
    layout : Layout
        Layout of the points in dimensions.
    keys : sequence of Varied
        Varied keys.
    values : sequence of sequence
        Values of the keys at each point.
    columns : sequence of Column
        Variables of the measures.
    outcomes : sequence of dict
        Outcome of each point.
    attributes : dict
        Attributes of the Dataset.
    """
    dimensions = tuple(layout.dimensions)
    shape = tuple(layout.dimensions.values())

    def laid(one_by_one: Any, kind: Any) -> np.ndarray:
        flat = np.empty(len(outcomes), dtype=kind)
        flat[:] = list(one_by_one)
        return flat.reshape(shape)

    data: dict[str, Any] = {}
    for column in columns:
        known = [outcome["values"].get(column.name) for outcome in outcomes]
        words = {"long_name": column.long_name} | ({"units": column.units} if column.units else {})
        if column.is_text or any(isinstance(value, str) for value in known):
            data[column.name] = (
                dimensions,
                laid(("" if value is None else str(value) for value in known), object),
                words,
            )
        else:
            numbers = (float("nan") if value is None else value for value in known)
            data[column.name] = (dimensions, laid(numbers, float), words)
    for name, meaning in (("ended", "ending of the run"), ("message", "message of a failure, empty if none")):
        data[name] = (dimensions, laid((outcome[name] for outcome in outcomes), object), {"long_name": meaning})
    return xr.Dataset(data, coordinates(layout, keys, values), attributes)


def coordinates(layout: Layout, keys: Sequence[Varied], values: Sequence[Sequence[Any]]) -> dict[str, Any]:
    """Return the coordinates of points: the varied keys, and the number of the point unless they form a grid."""
    columns = list(zip(*values, strict=True))
    if not layout.is_grid:
        points = {POINT: (POINT, np.arange(len(values)), {"long_name": "number of the point"})}
        return points | {key.key: _coordinate(POINT, key, column) for key, column in zip(keys, columns, strict=True)}
    found, step = {}, len(values)
    for key, column in zip(keys, columns, strict=True):
        size = layout.dimensions[key.key]
        step //= size
        found[key.key] = _coordinate(key.key, key, column[: step * size : step])
    return found


def _coordinate(dimension: str, key: Varied, values: Sequence[Any]) -> tuple[str, np.ndarray, dict[str, str]]:
    plain, words = key.coordinate(values)
    is_text = any(isinstance(value, str) for value in plain)
    return dimension, np.array(plain, dtype=object if is_text else None), words


def failures(found: xr.Dataset) -> list[str]:
    """Return the messages of the points of a sweep that failed."""
    return [str(message) for message in found["message"].values.ravel() if message]


def usual_failure(messages: Sequence[str]) -> str:
    """Return the most frequent message of the points that failed and its count in one line; empty if none failed.

    Messages that differ only in the value after "got" count as the same.
    """
    if not messages:
        return ""
    usual, times = Counter(message.partition(GOT)[0] for message in messages).most_common(1)[0]
    whole = {message for message in messages if message.partition(GOT)[0] == usual}
    return f"{times} of {len(messages)} failures: {whole.pop() if len(whole) == 1 else usual}"
