"""Factorisation of sparse symmetric positive definite matrices, with the best installed library."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from threadpoolctl import threadpool_limits

from ...arrays import Array
from ...checks import ArgumentError

# Nodes below which a part of a mesh is not cut further.
SMALLEST_PART = 60
# Degrees of freedom, and share of entries that are not zero, above which factors are dense.
MANY, FULL = 600, 0.1

Solve = Callable[[Array], Array]


def factorised(matrix: Any, order: Array | None = None) -> Solve:
    """Return a function that solves linear systems with a sparse symmetric positive definite matrix.

    CHOLMOD (scikit-sparse) or Pardiso (pypardiso) factorise it if they are installed, else SuperLU; LAPACK if it
    is large and a tenth of it is not zero.

    Parameters
    ----------
    matrix : scipy sparse, shape (n, n)
        The matrix.
    order : ndarray, shape (n,), optional
        Order of elimination for SuperLU, such as `dissection` gives; minimum degree if left out.

    Raises
    ------
    ValueError
        If the factors do not fit into memory.
    """
    size = matrix.shape[0]
    if size > MANY and matrix.nnz > FULL * size**2:
        return _dense(matrix)
    for package, make in LIBRARIES.items():
        if find_spec(package) is not None:
            # An installed package may lack its shared library.
            with suppress(ImportError):
                return make(matrix)
    return _superlu(matrix, order)


def dissection(graph: Any, places: Array) -> Array:
    """Return an order of elimination by nested dissection: halves of a mesh first, the nodes between them last.

    On meshes in space the factors have two thirds of the entries of those by minimum degree, in less than half the
    time.

    Parameters
    ----------
    graph : scipy sparse, shape (nodes, nodes)
        Adjacency of nodes that share an element.
    places : ndarray, shape (nodes, 3)
        Their coordinates [m].
    """
    graph = scipy.sparse.csr_array(graph)
    reached = np.zeros(len(places), dtype=bool)
    order: list[Array] = []
    # Filled from the end: the separator of two parts comes after both.
    parts = [np.arange(len(places))]
    while parts:
        part = parts.pop()
        if part.size <= SMALLEST_PART:
            order.append(part)
            continue
        coordinate = places[part, np.argmax(np.ptp(places[part], axis=0))]
        low = coordinate < np.median(coordinate)
        if not low.any():
            low = np.arange(part.size) < part.size // 2
        reached[:] = False
        reached[part[low]] = True
        high = part[~low]
        rows = graph[high]
        between = np.zeros(high.size, dtype=bool)
        between[np.repeat(np.arange(high.size), np.diff(rows.indptr))[reached[rows.indices]]] = True
        order.append(high[between])
        parts += [part[low], high[~between]]
    return np.concatenate(order[::-1])


def _dense(matrix: Any) -> Solve:
    factors = scipy.linalg.cho_factor(matrix.toarray(), lower=True, overwrite_a=True, check_finite=False)
    return lambda right: np.asarray(scipy.linalg.cho_solve(factors, right, check_finite=False))


def _superlu(matrix: Any, order: Array | None) -> Solve:
    columns = matrix.tocsc()
    if order is not None:
        columns = columns[order][:, order].tocsc()
    try:
        factors = scipy.sparse.linalg.splu(
            columns,
            permc_spec="MMD_AT_PLUS_A" if order is None else "NATURAL",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except MemoryError:
        raise ArgumentError(
            "mesh", "be small enough for its factors to fit into memory", got=f"{matrix.shape[0]} degrees of freedom"
        ) from None
    if order is None:
        return lambda right: np.asarray(factors.solve(right))

    def solve(right: Array) -> Array:
        solution = np.empty_like(right)
        solution[order] = factors.solve(right[order])
        return solution

    return solve


def _cholmod(matrix: Any) -> Solve:
    factorise = getattr(import_module("sksparse.cholmod"), "cholesky", None)
    factors = factorise(matrix.tocsc()) if factorise else None
    if not callable(factors):
        raise ImportError("scikit-sparse with another interface")
    return lambda right: np.asarray(factors(right))


def _pardiso(matrix: Any) -> Solve:
    # Matrix type 2: symmetric positive definite, upper triangle in rows.
    rows = scipy.sparse.csr_matrix(scipy.sparse.triu(matrix))
    rows.sort_indices()
    solver = import_module("pypardiso").PyPardisoSolver(mtype=2)
    # Its library is loaded only now, so that earlier limits of threads do not hold.
    with threadpool_limits(1):
        solver.factorize(rows)

    def solve(right: Array) -> Array:
        with threadpool_limits(1):
            return np.asarray(solver.solve(rows, np.asfortranarray(right))).reshape(right.shape)

    return solve


LIBRARIES = {"sksparse": _cholmod, "pypardiso": _pardiso}
