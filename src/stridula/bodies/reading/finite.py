"""Numbers from files that are not finite, named with the file and the line."""

from __future__ import annotations

import os

import numpy as np

from ...arrays import Array
from ...disk import line_not_finite, named


def check_finite_in(path: str | os.PathLike[str], name: str, array: Array) -> None:
    """Raise ValueError if an array from a file has numbers that are not finite.

    The message names the line of a text file, and otherwise the place in the array. Arrays of texts are not checked.
    """
    if array.dtype.kind not in "fc" or np.isfinite(array).all():
        return
    first = np.argwhere(~np.isfinite(array))[0].tolist()
    line = line_not_finite(path)
    words = {0: (), 1: ("number",), 2: ("row", "column")}.get(array.ndim, ("place",) * array.ndim)
    place = ", ".join(f"{word} {index}" for word, index in zip(words, first, strict=True))
    where = f" at {place} (from 0)" if place and not line else ""
    raise ValueError(f"cannot read {named(path)}: {line}{name} must be finite, got {array[tuple(first)]}{where}")
