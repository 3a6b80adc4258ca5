"""Matrices of several files, brought to the same degrees of freedom."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import issparse

from ...arrays import Array
from ...checks import ArgumentError
from ..limits import LARGEST_SPARSE, check_size
from ..reading.finite import check_finite_in
from .entries import Entries, labels_of
from .formats import PathLike, format_of, whole_file
from .labels import beside, read_labels

# Abaqus marks a constrained degree of freedom by 1e36 on the diagonal of the stiffness; no body is as stiff.
PENALTY = 1e30


@dataclass(frozen=True)
class AlignedMatrices:
    """Matrices of several files on the same degrees of freedom.

    Attributes
    ----------
    matrices : dict
        Sparse matrices by name, shape (n, n) each.
    labels : ndarray, shape (n, 2), or None
        Node and degree of freedom of every row, rising; None if the files number their rows.
    free : ndarray, shape (n,)
        False where Abaqus marks the row as constrained.
    """

    matrices: dict[str, Any]
    labels: Array | None
    free: Array


def read_container(path: PathLike) -> dict[str, Any] | None:
    """Return the content of a file with a whole body by the parameters of `ReducedBody`; points are a dictionary.

    Returns
    -------
    dict or None
        None for a file of matrices alone; see `files_of`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is damaged, too large, or lacks the mass or the stiffness.
    """
    kind = format_of(path)
    if kind.whole is None:
        return None
    with whole_file(path):
        found = kind.whole(path)
    for name, value in (found | {f"points[{point!r}]": rows for point, rows in found["points"].items()}).items():
        if name != "points":
            check_finite_in(path, name, np.asarray(getattr(value, "data", value) if issparse(value) else value))
    return found


def files_of(path: PathLike) -> dict[str, PathLike]:
    """Return the files of mass, stiffness and perhaps damping that belong to a given one.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is damaged, or has a single matrix and a name from which the other files cannot be found.
    """
    files = format_of(path).files(path)
    if not files:
        raise ArgumentError(
            "path",
            "be a file with all matrices: .npz, .mat, Nastran or CalculiX",
            os.fspath(path),
            got=f"{os.fspath(path)!r}; give files of single matrices as mass and stiffness",
        )
    return files


def read_matrices(paths: Mapping[str, PathLike], labels: PathLike | None = None) -> AlignedMatrices:
    """Read files of one matrix each and bring them to the same degrees of freedom.

    Parameters
    ----------
    paths : mapping
        Path by the name of the matrix; in any format of single matrices.
    labels : str or path-like, optional
        File with the node and degree of freedom of each row; searched beside the matrices if left out.

    Raises
    ------
    OSError
        If a file cannot be read.
    ValueError
        If a file is damaged, too large, of another format, or if only some have labels.
    """
    files = _with_labels({name: _one_matrix(name, path) for name, path in paths.items()}, paths, labels)
    labelled = {file.keys is not None for file in files.values()}
    if len(labelled) > 1:
        raise ArgumentError(
            "mass, stiffness and damping",
            "all have labels (node and degree of freedom of every row) or none",
            got=", ".join((f"{name} with" + ("" if f.keys is not None else "out") for name, f in files.items())),
        )
    if labelled == {True}:
        keys = np.unique(np.concatenate([file.keys for file in files.values() if file.keys is not None]))
        named = labels_of(keys)
        matrices = {name: file.on(keys, keys.size) for name, file in files.items()}
    else:
        named = None
        size = max(file.least_size for file in files.values())
        if size > sum(2 * file.rows.size for file in files.values()):
            # Rows that no file names; those that Abaqus constrains, and that are left out, are in one of them.
            check_size("stiffness", size, LARGEST_SPARSE)
        matrices = {name: file.on(None, file.size or size) for name, file in files.items()}
    for name, matrix in matrices.items():
        if matrix.shape != matrices["stiffness"].shape:
            wanted, got = matrices["stiffness"].shape[0], matrix.shape[0]
            raise ArgumentError(name, f"have as many degrees of freedom as stiffness, {wanted}", got=got)
    free = np.ones(matrices["stiffness"].shape[0], dtype=bool)
    if files["stiffness"].is_penalised:
        diagonal = matrices["stiffness"].diagonal()
        free = ~(np.isfinite(diagonal) & (diagonal >= PENALTY))
    return AlignedMatrices(matrices, named, free)


def _one_matrix(name: str, path: PathLike) -> Entries:
    kind = format_of(path)
    if kind.matrix is None:
        raise ArgumentError(
            name,
            "be a file of matrices alone",
            os.fspath(path),
            got=f"{os.fspath(path)!r}; give a file with all matrices as path",
        )
    with whole_file(path):
        found = kind.matrix(name, path)
    check_finite_in(path, name, found.values)
    return found


def _with_labels(
    files: dict[str, Entries], paths: Mapping[str, PathLike], given: PathLike | None
) -> dict[str, Entries]:
    """Return the matrices, with labels where a file of labels is given or lies beside one of the matrices."""
    numbered = [name for name, file in files.items() if file.keys is None]
    if given is not None and not numbered:
        raise ArgumentError("labels", "be left out where matrices name their rows themselves", os.fspath(given))
    found = {name: given or beside(paths[name], format_of(paths[name]).labels) for name in numbered}
    # All matrices have the same rows, so that one file of labels is enough.
    shared = next((path for path in found.values() if path is not None), None)
    read: dict[PathLike, Array] = {}
    named = dict(files)
    for name, own in found.items():
        path = own or shared
        if path is None:
            continue
        if path not in read:
            format_of(path)
            with whole_file(path):
                read[path] = read_labels(path)
        with whole_file(path):
            named[name] = files[name].labelled(read[path], name)
    return named
