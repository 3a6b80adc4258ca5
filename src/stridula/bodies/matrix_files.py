"""Files of matrices: NumPy, MATLAB, Matrix Market and the text output of Abaqus."""

from __future__ import annotations

import io
import itertools
import math
import os
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import numpy as np
import scipy.io
import scipy.sparse

from ..arrays import Array
from ..checks import ArgumentError, at_least, in_one_line, listed
from ..disk import one_line, write
from .matlab import read_matlab

LARGEST_FILE = 2 * 1024**3
LARGEST_SIZE = 4000
# Of sparse matrices: what the factors of meshes can number, in some 20 GB.
LARGEST_SPARSE = 300_000
# Readers of the headers of NumPy's arrays, by version; of version 3 are arrays with named fields only.
HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
LONGEST_HEADER = 10_000
VERSION_5 = b"MATLAB 5.0"

# Abaqus marks a constrained degree of freedom by 1e36 on the diagonal of the stiffness; no body is as stiff as this.
PENALTY = 1e30

MATRICES = ("mass", "stiffness", "damping")
OTHERS = ("translation", "rayleigh", "cutoff", "residual_flexibility", "name")
SYNONYMS = {"M": "mass", "K": "stiffness", "C": "damping"}
POINT = "point_"

# A label (node, degree of freedom) as one integer that sorts as the pair does.
LABEL_BASE = 2**20
LARGEST_NUMBER = 2**40


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


def check_size(name: str, size: int, most: int = LARGEST_SIZE) -> None:
    """Raise ValueError if a matrix of `size` rows is too large, by default to be made dense."""
    if size > most:
        raise ArgumentError(name, f"have at most {most} degrees of freedom", got=f"{size}: reduce the model first")


def read_container(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return what an .npz or .mat file holds, by the words of `ReducedBody`; points lie in a dictionary.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is damaged, too large, of another kind, or lacks the mass or the stiffness.
    """
    kind = _kind(path)
    if kind not in ("npz", "mat"):
        raise ArgumentError(
            "path",
            "be an .npz or .mat file",
            os.fspath(path),
            got=f"{os.fspath(path)!r}; files of one matrix each are given as mass and stiffness",
        )
    with _whole(path):
        arrays = _npz(path) if kind == "npz" else _mat(path)
    contents = {name: arrays[name] for name in (*MATRICES, *OTHERS) if name in arrays}
    contents["points"] = {name[len(POINT) :]: rows for name, rows in arrays.items() if name.startswith(POINT)}
    return contents


def read_matrices(paths: Mapping[str, str | os.PathLike[str]]) -> AlignedMatrices:
    """Read files of one matrix each and bring them to the same degrees of freedom.

    Parameters
    ----------
    paths : mapping
        Path by the name of the matrix; each is Matrix Market or Abaqus text.

    Raises
    ------
    OSError
        If a file cannot be read.
    ValueError
        If a file is damaged, too large, of another kind, or if only some have labels.
    """
    files = {name: _one_matrix(name, path) for name, path in paths.items()}
    labelled = {file.labelled for file in files.values()}
    if len(labelled) > 1:
        raise ArgumentError(
            "mass, stiffness and damping",
            "all be with labels (Abaqus FORMAT=MATRIX INPUT) or all without",
            got=", ".join((f"{name} with" + ("" if f.labelled else "out") for name, f in files.items())),
        )
    every = np.concatenate([np.append(file.rows, file.columns) for file in files.values()])
    if labelled == {True}:
        keys = np.unique(every)
        labels = np.stack(np.divmod(keys, LABEL_BASE), axis=1)
        matrices = {name: file.on(keys, keys.size) for name, file in files.items()}
    else:
        labels = None
        size = max(int(every.max(initial=-1)) + 1, *(file.size or 0 for file in files.values()))
        if size > every.size:
            # Rows that no file names; those that Abaqus constrains, and are left out, stand in one.
            check_size("stiffness", size, LARGEST_SPARSE)
        matrices = {name: file.on(None, file.size or size) for name, file in files.items()}
    for name, matrix in matrices.items():
        if matrix.shape != matrices["stiffness"].shape:
            wanted, got = matrices["stiffness"].shape[0], matrix.shape[0]
            raise ArgumentError(name, f"have as many degrees of freedom as stiffness, {wanted}", got=got)
    free = np.ones(matrices["stiffness"].shape[0], dtype=bool)
    if files["stiffness"].size is None:
        diagonal = matrices["stiffness"].diagonal()
        free = ~(np.isfinite(diagonal) & (diagonal >= PENALTY))
    return AlignedMatrices(matrices, labels, free)


def write_npz(path: str | os.PathLike[str], arrays: Mapping[str, Any]) -> None:
    """Write arrays to an .npz file, whole or not at all."""
    content = io.BytesIO()
    plain: dict[str, Any] = dict(arrays)
    np.savez(content, **plain)
    write(path, content.getbuffer())


@dataclass(frozen=True)
class _Entries:
    """Entries of one symmetric matrix, both triangles; size is None where the file does not say it."""

    rows: Array
    columns: Array
    values: Array
    size: int | None
    labelled: bool

    def on(self, keys: Array | None, size: int) -> Any:
        rows, columns = (self.rows, self.columns) if keys is None else np.searchsorted(keys, (self.rows, self.columns))
        return scipy.sparse.coo_array((self.values, (rows, columns)), shape=(size, size)).tocsr()


def _kind(path: str | os.PathLike[str]) -> str:
    """Return the kind of a file from its first bytes, after a check of its size."""
    with one_line(f"cannot read {os.fspath(path)!r}"):
        size = os.stat(path).st_size
        with open(path, "rb") as file:
            head = file.read(1024)
    if size > LARGEST_FILE:
        raise ValueError(f"cannot read {os.fspath(path)!r}: {at_least(size / 1024**3, 3)} GiB, at most 2 GiB are read")
    if not head:
        raise ValueError(f"cannot read {os.fspath(path)!r}: the file is empty")
    if head.startswith(b"PK"):
        return "npz"
    if head.startswith(b"MATLAB 7.3") or head.startswith(b"\x89HDF"):
        raise ValueError(f"cannot read {os.fspath(path)!r}: a MATLAB file of version 7.3, save it with '-v7'")
    if head.startswith(VERSION_5) or Path(path).suffix.lower() == ".mat":
        return "mat"
    return "matrix market" if head.startswith(b"%%MatrixMarket") else "abaqus"


def _npz(path: str | os.PathLike[str]) -> dict[str, Any]:
    with zipfile.ZipFile(path) as archive:
        unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > LARGEST_FILE:
            raise ValueError(f"{at_least(unpacked / 1024**3, 3)} GiB when unpacked, at most 2 GiB are read")
        entries = _arrays_in(archive)
        for name, entry in entries.items():
            _check_header(name, archive, entry)
    with np.load(path, allow_pickle=False) as file:
        return _by_words({name: file[name] for name in entries})


def _arrays_in(archive: zipfile.ZipFile) -> dict[str, zipfile.ZipInfo]:
    """Return where the arrays that have a meaning lie, by name."""
    entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
    known = (*SYNONYMS, *MATRICES, *OTHERS)
    return {name: entry for name, entry in entries.items() if name in known or name.startswith(POINT)}


def _check_header(name: str, archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> None:
    """Raise ValueError unless the header of an array announces numbers, or a text, that its file holds."""
    with archive.open(entry) as file:
        try:
            version = np.lib.format.read_magic(file)
        except ValueError:
            raise ArgumentError(name, "be an array of numbers", got="other bytes") from None
        if version not in HEADERS:
            raise ArgumentError(name, "be an array of numbers", got=f"one of version {version} of its format")
        shape, _, kind = HEADERS[version](file, max_header_size=LONGEST_HEADER)
    if kind.kind not in "fiubcSU":
        raise ArgumentError(name, "be an array of numbers", got=f"one of kind {kind}")
    check_size(name, max(shape, default=0))
    if math.prod(shape) * kind.itemsize > entry.file_size:
        raise ArgumentError(name, f"hold the {math.prod(shape)} numbers that its header says, it holds less")


def _by_words(held: Mapping[str, Any]) -> dict[str, Any]:
    """Return arrays by the words of `ReducedBody`; a matrix may stand under both its names only if both are equal."""
    arrays = {name: array for name, array in held.items() if name not in SYNONYMS}
    for symbol, word in SYNONYMS.items():
        if symbol not in held:
            continue
        if word in held and not _equal(held[symbol], held[word]):
            raise ValueError(f"it must hold {word} once, it holds {word} and {symbol}, which differ")
        arrays[word] = held[symbol]
    for name in MATRICES[:2]:
        if name not in arrays:
            raise ValueError(f"it must hold {name}, it holds {listed(sorted(arrays) or ['nothing known'])}")
    return arrays


def _equal(one: Any, other: Any) -> bool:
    first, second = (part.toarray() if scipy.sparse.issparse(part) else np.asarray(part) for part in (one, other))
    return np.array_equal(first, second)


def _mat(path: str | os.PathLike[str]) -> dict[str, Any]:
    with open(path, "rb") as file:
        # A file of version 4 begins with a number below 5000.
        is_of_version_5 = 0 not in file.read(4)
    arrays = _by_words((read_matlab if is_of_version_5 else _of_version_4)(path, _is_matrix, _check_shape))
    damping = arrays.get("damping")
    if isinstance(damping, np.ndarray) and 1 in damping.shape and damping.shape != arrays["mass"].shape:
        # MATLAB keeps numbers and lists as matrices: one number is a ratio, a row or a column a list of them.
        arrays["damping"] = damping.ravel() if damping.size > 1 else damping.ravel()[0]
    return arrays


def _is_matrix(name: str) -> bool:
    return name in (*SYNONYMS, *MATRICES, "translation") or name.startswith(POINT)


def _check_shape(name: str, shape: tuple[int, ...]) -> None:
    check_size(name, max(shape, default=0))


def _of_version_4(path: str | os.PathLike[str], is_wanted: Any, check_shape: Any) -> dict[str, Any]:
    shapes = {name: shape for name, shape, _ in scipy.io.whosmat(os.fspath(path), appendmat=False)}
    wanted = [name for name in shapes if is_wanted(name)]
    for name in wanted:
        check_shape(name, shapes[name])
    held = scipy.io.loadmat(os.fspath(path), appendmat=False, variable_names=wanted)
    return {name: held[name] for name in wanted}


def _one_matrix(name: str, path: str | os.PathLike[str]) -> _Entries:
    kind = _kind(path)
    if kind in ("npz", "mat"):
        raise ArgumentError(
            name,
            "be a Matrix Market file or Abaqus text",
            os.fspath(path),
            got=f"{os.fspath(path)!r}; a file with all matrices is given as path",
        )
    with _whole(path):
        return _matrix_market(name, path) if kind == "matrix market" else _abaqus(path)


def _matrix_market(name: str, path: str | os.PathLike[str]) -> _Entries:
    """Read a Matrix Market file; SciPy sees only its header: on one that is cut it may bring the process down."""
    rows, columns, entries, layout, field, symmetry = scipy.io.mminfo(os.fspath(path))
    if rows != columns:
        raise ArgumentError(name, "be square", got=f"{rows} x {columns}")
    check_size(name, rows, LARGEST_SIZE if layout == "array" else LARGEST_SPARSE)
    if field not in ("real", "integer", "unsigned-integer") or entries > rows * columns:
        raise ValueError(f"the header must announce at most {rows * columns} real entries, it says {entries} {field}")
    if symmetry not in ("general", "symmetric"):
        raise ValueError(f"the header must announce a general or symmetric matrix, it says {symmetry}")
    symmetric = symmetry == "symmetric"
    if layout == "array":
        count = rows * (rows + 1) // 2 if symmetric else entries
        values = _market_numbers(path, 1, count)[:, 0]
        # Column by column, of a symmetric matrix the lower triangle.
        j, i = np.triu_indices(rows) if symmetric else np.divmod(np.arange(count), max(rows, 1))
    else:
        table = _market_numbers(path, 3, entries)
        i, j = table[:, :2].T.astype(np.int64) - 1
        values = table[:, 2]
        if not ((i >= 0) & (i < rows) & (j >= 0) & (j < rows)).all():
            raise ValueError(f"rows and columns must be numbered from 1 to {rows}, got {_beyond(i + 1, j + 1, rows)}")
    kept = values != 0.0
    i, j, values = i[kept], j[kept], values[kept]
    if symmetric:
        beside = i != j
        i, j = np.append(i, j[beside]), np.append(j, i[beside])
        values = np.append(values, values[beside])
    return _Entries(i, j, values, rows, False)


def _beyond(rows: Array, columns: Array, size: int) -> int:
    numbers = np.append(rows, columns)
    return int(numbers[(numbers < 1) | (numbers > size)][0])


def _market_numbers(path: str | os.PathLike[str], width: int, count: int) -> Array:
    """Return the numbers below the header of a Matrix Market file, which must be as many as it announces."""
    if not count:
        return np.empty((0, width))
    try:
        with _below_market_header(path) as (file, _):
            # A line more than announced is enough to see that there are more.
            lines = itertools.islice((line for line in file if line.partition("%")[0].strip()), count + 1)
            first = next(lines, None)
            if first is None:
                raise ValueError(f"it must hold {count} entries, as its header says, it holds none")
            table = np.loadtxt(itertools.chain([first], lines), comments="%", ndmin=2)
    except ValueError as error:
        raise ValueError(_bad_market_line(path, width) or str(error)) from error
    if table.shape[1] != width or not _are_numbers(table[:, :-1]):
        raise ValueError(_bad_market_line(path, width) or "it is no matrix")
    if len(table) != count:
        held = "more" if len(table) > count else len(table)
        raise ValueError(f"it must hold {count} entries, as its header says, it holds {held}")
    return table


@contextmanager
def _below_market_header(path: str | os.PathLike[str]) -> Iterator[tuple[TextIO, int]]:
    """Open a Matrix Market file at its first entry; give it with the number of lines above."""
    with open(path, encoding="latin-1") as file:
        lines = enumerate(iter(file.readline, ""), 1)
        yield file, next(number for number, line in lines if line.partition("%")[0].strip())


def _bad_market_line(path: str | os.PathLike[str], width: int) -> str:
    with _below_market_header(path) as (file, above):
        return _first_bad(file, above, "%", None, width, "one number" if width == 1 else "'row column value'")


def _abaqus(path: str | os.PathLike[str]) -> _Entries:
    table = _numbers(path)
    labelled = table.shape[1] == 5
    integers = table[:, :-1].astype(np.int64)
    if labelled:
        if not np.isin(integers[:, [1, 3]] // LABEL_BASE, 0).all():
            raise ValueError(f"degrees of freedom of a node must be numbered from 0 to {LABEL_BASE - 1}")
        rows, columns = (integers[:, k] * LABEL_BASE + integers[:, k + 1] for k in (0, 2))
    else:
        rows, columns = integers.T - 1
        if integers.min() < 1:
            raise ValueError(f"rows and columns must be numbered from 1, got {integers.min()}")
    return _Entries(*_both_triangles(rows, columns, table[:, -1], labelled), None, labelled)


def _numbers(path: str | os.PathLike[str]) -> Array:
    """Return the table of a text file, five columns with labels, three without; lines with ``*`` are left out."""
    with open(path, encoding="latin-1") as file:
        first = next((line for line in file if line.strip() and not line.lstrip().startswith("*")), "")
    if not first:
        raise ValueError("it holds no number")
    comma = "," if "," in first else None
    width = 5 if len(first.split(comma)) == 5 else 3
    try:
        with open(path, encoding="latin-1") as file:
            table = np.loadtxt(file, delimiter=comma, comments="*", ndmin=2)
    except ValueError as error:
        raise ValueError(_bad_line(path) or str(error)) from error
    numbers = table[:, :-1]
    if table.shape[1] != width or not _are_numbers(numbers):
        raise ValueError(_bad_line(path) or "it is no matrix")
    return table


def _bad_line(path: str | os.PathLike[str]) -> str:
    """Return what is wrong with the first line that is no entry of a matrix, nothing if all are."""
    comma, width = _layout(path)
    wanted = "'node, dof, node, dof, value'" if width == 5 else "'row column value'"
    with open(path, encoding="latin-1") as file:
        return _first_bad(file, 0, "*", comma, width, wanted)


def _first_bad(lines: Iterable[str], above: int, remark: str, comma: str | None, width: int, wanted: str) -> str:
    for number, line in enumerate(lines, above + 1):
        text = line.partition(remark)[0].strip()
        if text and not _is_entry(text.split(comma), width):
            return f"line {number} must be {wanted}, got {text[:60]!r}"
    return ""


def _are_numbers(table: Array) -> bool:
    """Return whether what numbers rows and columns is whole and not too large."""
    return bool(((table == np.round(table)) & (np.abs(table) < LARGEST_NUMBER)).all())


def _layout(path: str | os.PathLike[str]) -> tuple[str | None, int]:
    """Return the separator and the number of columns that a text file is meant to have, some lines damaged."""
    counts: Counter[tuple[str | None, int]] = Counter()
    with open(path, encoding="latin-1") as file:
        for line in file:
            text, _, remark = line.partition("*")
            if not text.strip() and remark.upper().startswith("MATRIX INPUT"):
                return ",", 5
            if text.strip():
                comma = "," if "," in text else None
                counts[comma, len(text.split(comma))] += 1
    known = [layout for layout, _ in counts.most_common() if layout[1] in (3, 5)]
    # Where no line is whole, commas are those of MATRIX INPUT.
    return known[0] if known else (",", 5) if any(comma for comma, _ in counts) else (None, 3)


def _is_entry(words: list[str], width: int) -> bool:
    try:
        values = [float(word) for word in words]
    except ValueError:
        return False
    return len(words) == width and all(v.is_integer() and abs(v) < LARGEST_NUMBER for v in values[:-1])


def _both_triangles(rows: Array, columns: Array, values: Array, labelled: bool) -> tuple[Array, Array, Array]:
    """Return the entries of a symmetric matrix given by one triangle or in full, in full."""
    keys, number = np.unique(np.append(rows, columns), return_inverse=True)
    i, j = np.split(number.astype(np.int64), 2)
    place, mirrored = i * keys.size + j, j * keys.size + i
    order = np.argsort(place, kind="stable")
    twice = np.flatnonzero(np.diff(place[order]) == 0)
    if twice.size:
        key = rows[order[twice[0]]], columns[order[twice[0]]]
        where = [divmod(int(k), LABEL_BASE) if labelled else int(k) + 1 for k in key]
        raise ValueError(f"each entry must stand once (assembled matrices), got two at {where[0]}, {where[1]}")
    beside = i != j
    if np.isin(mirrored[beside], place).any():
        return rows, columns, values
    both = np.append(rows, columns[beside]), np.append(columns, rows[beside])
    return *both, np.append(values, values[beside])


@contextmanager
def _whole(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn whatever a reader raises on a damaged file into one line with its path; readers raise almost anything."""
    try:
        yield
    except Exception as error:
        raise ValueError(f"cannot read {os.fspath(path)!r}: {in_one_line(error)}") from error
