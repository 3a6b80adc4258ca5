"""Entries of one symmetric matrix, the result of the readers of all formats."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse

from ...arrays import Array

# A label (node, degree of freedom) as one integer that sorts as the pair does.
LABEL_BASE = 2**20
# Entries checked at once; a check of all together would double the memory.
PIECE = 2**20


@dataclass(frozen=True)
class Entries:
    """Entries of one symmetric matrix, both triangles.

    Attributes
    ----------
    rows, columns : ndarray of int, shape (entries,)
        Rows and columns, from 0.
    values : ndarray, shape (entries,)
        Values.
    size : int, optional
        Number of rows; None if the file does not give it.
    keys : ndarray of int, shape (rows,), optional
        Label of every row, see `key_of`; None where rows only have numbers.
    is_penalised : bool
        Whether constraints may be marked by a huge number on the diagonal.
    """

    rows: Array
    columns: Array
    values: Array
    size: int | None = None
    keys: Array | None = None
    is_penalised: bool = False

    @property
    def least_size(self) -> int:
        """Least number of rows."""
        named = 1 + max(int(part.max(initial=-1)) for part in (self.rows, self.columns))
        return max(named, self.size or 0)

    def labelled(self, labels: Array, name: str) -> Entries:
        """Return the same with labels of its rows, shape (rows, 2); `name` is its name in messages.

        Raises
        ------
        ValueError
            If there are not as many labels as rows.
        """
        rows, named = self.size or self.least_size, len(labels)
        if self.least_size > named or self.size not in (None, named):
            words = f"it must name {rows} rows, as many as {name} has, but names {named}"
            raise ValueError(words + (": a model of cyclic symmetry is not read" if rows == 2 * named else ""))
        return replace(self, size=named, keys=key_of(labels[:, 0], labels[:, 1]))

    def on(self, keys: Array | None, size: int) -> Any:
        """Return the sparse matrix on rows with the given rising labels, or on `size` rows without labels."""
        rows, columns = self.rows, self.columns
        if keys is not None and self.keys is not None:
            place = np.searchsorted(keys, self.keys).astype(np.int32)
            rows, columns = place[rows], place[columns]
        return scipy.sparse.coo_array((self.values, (rows, columns)), shape=(size, size)).tocsr()


def key_of(node: Array, dof: Array) -> Array:
    """Return labels of nodes and degrees of freedom as one integer each."""
    return np.asarray(node * LABEL_BASE + dof)


def labels_of(keys: Array) -> Array:
    """Return nodes and degrees of freedom, shape (n, 2), of labels."""
    return np.stack(np.divmod(keys, LABEL_BASE), axis=1)


def by_position(rows: Array, columns: Array) -> tuple[Array, Array, Array]:
    """Return rows and columns numbered from 0, and the original numbers, rising."""
    keys, number = np.unique(np.concatenate([rows, columns]), return_inverse=True)
    i, j = np.split(number.astype(np.int32).ravel(), 2)
    return i, j, keys


def both_triangles(rows: Array, columns: Array, values: Array, what: str) -> tuple[Array, Array, Array]:
    """Return a symmetric matrix in full from one triangle; `what` gives the reason to expect one, for messages.

    Raises
    ------
    ValueError
        If it holds entries of both.
    """
    if (rows < columns).any() and (rows > columns).any():
        raise ValueError(f"it must hold one triangle, {what}, but holds entries of both")
    return with_mirror_images(rows, columns, values)


def with_mirror_images(rows: Array, columns: Array, values: Array) -> tuple[Array, Array, Array]:
    """Return entries with the mirror images of those beside the diagonal."""
    beside = rows != columns
    both = np.append(rows, columns[beside]), np.append(columns, rows[beside])
    return *both, np.append(values, values[beside])


def check_full(rows: Array, columns: Array, size: int, what: str) -> None:
    """Raise ValueError if a matrix has only one of each pair of entries; `what` is the reason to expect both."""
    if (rows != columns).any() and not _has_mirror_images(rows, columns, np.sort(_places(rows, columns, size)), size):
        held = {-1: "the upper triangle", 1: "the lower triangle"}
        sides = {int(side) for side in np.sign(rows - columns)} - {0}
        got = held[sides.pop()] if len(sides) == 1 else "one of each pair of entries"
        raise ValueError(f"it must hold both triangles, {what}, but holds {got} only")


def filled_in(
    rows: Array, columns: Array, values: Array, size: int, called: Callable[[int], object]
) -> tuple[Array, Array, Array]:
    """Return all entries of a symmetric matrix given by one of each pair or in full.

    Parameters
    ----------
    rows, columns : ndarray of int
        Rows and columns, from 0.
    values : ndarray
        Values.
    size : int
        Number of rows.
    called : callable
        Returns the name of a row in messages, given its number.

    Raises
    ------
    ValueError
        If an entry appears twice.
    """
    place = _places(rows, columns, size)
    place.sort()
    twice = np.flatnonzero(np.diff(place) == 0)
    if twice.size:
        first, second = (called(int(k)) for k in divmod(int(place[twice[0]]), size))
        raise ValueError(f"each entry must occur once (assembled matrices), got two at {first}, {second}")
    if _has_mirror_images(rows, columns, place, size):
        return rows, columns, values
    return with_mirror_images(rows, columns, values)


def _places(rows: Array, columns: Array, size: int) -> Array:
    return np.asarray(rows.astype(np.int64) * size + columns)


def _has_mirror_images(rows: Array, columns: Array, places: Array, size: int) -> bool:
    """Return whether any entry beside the diagonal has its mirror image among the rising places of all."""
    for start in range(0, rows.size, PIECE):
        i, j = (part[start : start + PIECE] for part in (rows, columns))
        mirrored = _places(j, i, size)[i != j]
        found = np.minimum(np.searchsorted(places, mirrored), places.size - 1)
        if (places[found] == mirrored).any():
            return True
    return False
