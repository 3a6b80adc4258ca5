"""Checks of matrices, rows, points and damping from users, each returned as a new array."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse

from ..arrays import Array
from ..checks import ArgumentError, instance
from ..declared import DAMPING_RATIO
from .damping import DampingLaw, checked_damping, is_damping_law
from .limits import LARGEST_SIZE, LARGEST_SPARSE, check_size

SYMMETRY = 1e-8

# Rounding errors of the eigenvalues stay below 10 eps of the largest: see tests/unit/test_reduced_body.py.
ROUND_OFF = 64.0 * float(np.finfo(float).eps)


def smallest_eigenvalue(matrix: Array) -> float:
    """Return the smallest eigenvalue of a symmetric matrix."""
    return float(scipy.linalg.eigvalsh(matrix, subset_by_index=[0, 0])[0])


def check_mass(mass: Array) -> None:
    """Raise ValueError if a mass matrix, scaled to a unit diagonal, is not positive definite beyond rounding."""
    diagonal = np.diag(mass)
    if diagonal.min() > 0.0:
        scale = 1.0 / np.sqrt(diagonal)
        try:
            pivots = np.diag(np.linalg.cholesky(mass * np.outer(scale, scale))) ** 2
        except np.linalg.LinAlgError:
            pivots = np.zeros(1)
        if pivots.min() > ROUND_OFF:
            return
    raise ArgumentError(
        "mass",
        "be positive definite",
        mass,
        got=f"the smallest eigenvalue {smallest_eigenvalue(mass):.6g}; condense degrees of freedom without mass",
    )


def check_damping(matrix: Array) -> None:
    """Raise ValueError if a damping matrix is not positive semidefinite beyond rounding."""
    largest = np.where(np.diag(matrix) > 0.0, np.diag(matrix), 1.0)
    scale = 1.0 / np.sqrt(largest)
    values = scipy.linalg.eigvalsh(matrix * np.outer(scale, scale))
    if values[0] < -ROUND_OFF * np.abs(values).max():
        raise ArgumentError(
            "damping", "be positive semidefinite", got=f"the smallest eigenvalue {smallest_eigenvalue(matrix):.6g}"
        )


def numbers(name: str, value: Any) -> Array:
    """Return `value` as a new array of floats, or raise ValueError if it is not an array of real numbers."""
    if hasattr(value, "check_format"):
        # Making it dense with indices out of bounds would write outside of its memory.
        value.check_format(full_check=True)
    try:
        array = value.toarray() if scipy.sparse.issparse(value) else np.array(value)
    except (ValueError, TypeError) as error:
        kind = "a ragged" if isinstance(error, ValueError) else "a"
        raise ArgumentError(name, "be an array of numbers", value, got=f"{kind} {type(value).__name__}") from error
    if array.dtype.kind == "c":
        raise ArgumentError(name, "be real", value, got="complex numbers")
    if array.dtype.kind not in "iuf":
        raise ArgumentError(name, "be an array of numbers", value, got=f"a {type(value).__name__} of {array.dtype}")
    # Adding zero turns -0.0 into 0.0: equal arrays get the same digest.
    return np.asarray(array, dtype=float, order="C") + 0.0


def check_finite(name: str, array: Array) -> None:
    """Raise ValueError at the first entry that is not finite."""
    bad = np.argwhere(~np.isfinite(array))
    if bad.size:
        words = ("row", "column") if array.ndim == 2 else ("number",)
        where = ", ".join(f"{word} {index}" for word, index in zip(words, bad[0], strict=True))
        raise ArgumentError(name, "be finite", got=f"{array[tuple(bad[0])]} at {where} (from 0)")


def square(name: str, value: Any, size: int | None = None) -> Array:
    """Return a matrix as an array; its size is checked before anything large is allocated."""
    matrix = value if hasattr(value, "shape") else numbers(name, value)
    if len(matrix.shape) != 2 or matrix.shape[0] != matrix.shape[1]:
        raise ArgumentError(name, "be a square matrix", value, got=f"the shape {tuple(matrix.shape)}")
    if matrix.shape[0] == 0:
        raise ArgumentError(name, "have at least one degree of freedom", value, got="an empty matrix")
    check_size(name, matrix.shape[0])
    if size is not None and matrix.shape[0] != size:
        raise ArgumentError(name, f"have as many degrees of freedom as mass, {size}", value, got=matrix.shape[0])
    array = numbers(name, matrix)
    check_finite(name, array)
    return array


def symmetric(name: str, matrix: Array) -> Array:
    """Return a matrix made exactly symmetric, or raise ValueError if its relative asymmetry exceeds 1e-8."""
    skew = np.abs(matrix - matrix.T)
    if skew.max() > SYMMETRY * np.abs(matrix).max():
        row, column = np.unravel_index(np.argmax(skew), skew.shape)
        raise ArgumentError(
            name,
            "be symmetric",
            got=(
                f"{matrix[row, column]} at row {row}, column {column} (from 0) but {matrix[column, row]} at "
                f"row {column}, column {row}"
            ),
        )
    return 0.5 * (matrix + matrix.T)


def stays_sparse(matrix: Any) -> bool:
    """Return whether a matrix is sparse and too large to be made dense."""
    return scipy.sparse.issparse(matrix) and len(matrix.shape) == 2 and matrix.shape[0] > LARGEST_SIZE


def sparse_square(name: str, value: Any, size: int | None = None) -> Any:
    """Return a large sparse matrix as a new one in rows, without duplicates, all entries finite."""
    if not stays_sparse(value) or value.shape[0] != value.shape[1] or value.shape[0] != (size or value.shape[0]):
        wanted = f"be a sparse matrix of {size} degrees of freedom, as mass is" if size else "be a square matrix"
        raise ArgumentError(name, wanted, got=f"a {type(value).__name__} of the shape {getattr(value, 'shape', ())}")
    check_size(name, value.shape[0], LARGEST_SPARSE)
    if hasattr(value, "check_format"):
        value.check_format(full_check=True)
    if value.dtype.kind not in "iuf":
        raise ArgumentError(name, "be real", got=f"numbers of {value.dtype}")
    rows = scipy.sparse.csr_array(value.tocoo(), dtype=float)
    rows.sum_duplicates()
    rows.eliminate_zeros()
    check_finite(name, rows.data)
    return rows


def sparse_symmetric(name: str, matrix: Any) -> Any:
    """Return a sparse matrix made exactly symmetric, or raise ValueError if it is not so to a hundred-millionth."""
    skew = np.abs(matrix - matrix.T)
    if skew.nnz and skew.max() > SYMMETRY * np.abs(matrix).max():
        raise ArgumentError(
            name, "be symmetric", got=f"entries that differ by {skew.max():.6g} from their mirror images"
        )
    whole = scipy.sparse.csr_array(0.5 * (matrix + matrix.T))
    whole.eliminate_zeros()
    # The same bytes for matrices from a file and from memory.
    whole.indices, whole.indptr = whole.indices.astype(np.int32), whole.indptr.astype(np.int32)
    whole.sort_indices()
    for array in (whole.data, whole.indices, whole.indptr):
        array.flags.writeable = False
    return whole


def check_sparse_mass(mass: Any) -> None:
    """Raise ValueError where the diagonal of a sparse mass matrix shows that it is not positive definite."""
    diagonal = mass.diagonal()
    if diagonal.min() <= 0.0:
        number = int(np.argmin(diagonal))
        raise ArgumentError(
            "mass",
            "be positive definite",
            got=f"{diagonal[number]:.6g} at row and column {number} (from 0); condense degrees of freedom without mass",
        )


def rows_of(name: str, value: Any, size: int, directions: int | None = None) -> Array:
    """Return rows on the degrees of freedom, one each along x and y, or along x, y and z.

    `directions` is the required number of rows; 2 or 3 if left out.
    """
    rows = value if hasattr(value, "shape") else numbers(name, value)
    allowed = [(count, size) for count in (2, 3) if directions in (None, count)]
    if tuple(rows.shape) not in allowed:
        shapes = " or ".join(map(str, allowed))
        raise ArgumentError(name, f"have the shape {shapes}", value, got=tuple(rows.shape))
    array = numbers(name, rows)
    check_finite(name, array)
    return array


def points_of(points: Any, size: int) -> dict[str, Array]:
    """Return the rows of every point by its name."""
    instance("points", points, Mapping)
    if not points:
        raise ArgumentError("points", "have at least one point", points, got="none")
    rows = {}
    for name, value in points.items():
        if not isinstance(name, str) or not name:
            raise ArgumentError("points", "have names that are text", name)
        rows[name] = point_rows(f"points[{name!r}]", value, size)
        rows[name].flags.writeable = False
        first = next(iter(rows.values()))
        if len(rows[name]) != len(first):
            words = f"move along as many directions as the first point, {len(first)}"
            raise ArgumentError(f"points[{name!r}]", words, value, got=len(rows[name]))
    return rows


def point_rows(word: str, value: Any, size: int) -> Array:
    """Return the rows of a point, given by rows or by the numbers of two or three degrees of freedom."""
    if not is_labelled(value, Integral):
        return rows_of(word, value, size)
    rows = np.zeros((len(value), size))
    for row, number in zip(rows, value, strict=True):
        if number is not None:
            if isinstance(number, bool) or not 0 <= number < size:
                raise ArgumentError(word, f"name degrees of freedom from 0 to {size - 1}", number)
            row[int(number)] = 1.0
    return rows


def is_labelled(value: Any, kind: type | tuple[type, ...]) -> bool:
    """Return whether `value` is two or three entries of a kind, any of which may be None."""
    few = isinstance(value, (tuple, list)) or (isinstance(value, np.ndarray) and value.shape in ((2,), (3,)))
    return few and len(value) in (2, 3) and all(entry is None or isinstance(entry, kind) for entry in value)


def is_pair(value: Any, kind: type | tuple[type, ...]) -> bool:
    """Return whether `value` is a pair of entries of a kind, either of which may be None."""
    return is_labelled(value, kind) and len(value) == 2


def damping_of(value: Any, size: int) -> float | Array | DampingLaw:
    """Return damping as a ratio, ratios per mode, a law of frequency, or a symmetric matrix."""
    if is_damping_law(value):
        return value
    if isinstance(value, (Real, str)) or value is None:
        return DAMPING_RATIO.check("damping", value)
    damping = value if hasattr(value, "shape") else numbers("damping", value)
    if len(damping.shape) == 0:
        return DAMPING_RATIO.check("damping", damping.item())
    if len(damping.shape) == 1:
        return np.array(checked_damping(numbers("damping", damping)))
    matrix = symmetric("damping", square("damping", damping, size))
    check_damping(matrix)
    return matrix
