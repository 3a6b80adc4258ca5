"""Springs and dashpots whose tables are in text files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from ..checks import ArgumentError, positive
from ..columns import read_rising

Made = TypeVar("Made")


def table_of_file(
    make: Callable[..., Made], path: str | Path, columns: Sequence[str | int], units: Mapping[str, float]
) -> Made:
    """Return a spring or dashpot made of the columns of a text file, such as a CSV.

    Parameters
    ----------
    make : callable
        Makes it from its lists by name.
    path : str or Path
        The file.
    columns : sequence of str or int
        Column of each list.
    units : mapping
        Size of 1 of each list in SI, by its name.

    Raises
    ------
    ValueError
        If the file has no such table; the message names file and line.
    """
    found = read_rising(path, columns)
    try:
        lists = {
            name: (column * positive(f"{name}_unit", unit)).tolist()
            for (name, unit), column in zip(units.items(), found, strict=True)
        }
        return make(**lists)
    except ArgumentError as error:
        raise error.inside(str(path)) from None
