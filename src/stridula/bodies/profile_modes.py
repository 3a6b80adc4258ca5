"""Modes of a body of revolution, order by order round its axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from threadpoolctl import threadpool_limits

from ..arrays import Array
from .fourier_elements import FourierElements, U, V, W
from .ordinary import check_mode_count

# Frequency of the shift, below zero, as a share of the cutoff: far enough from rigid motions for the factorisation.
SHIFT = 0.1
# Modes of an order asked for at first, beyond as many as the order before it has.
MORE = 2
# Up to so many degrees of freedom matrices are dense.
DENSE = 150
# Share of the size of rigid motions at held points below which they are not held.
UNHELD = 1e-9
COSINE, SINE = 0, 1


@dataclass(frozen=True, eq=False)
class Family:
    """Modes of one order that have their angle in common.

    Attributes
    ----------
    order : int
        Number of waves n round the axis.
    sides : tuple of int
        Which of the pair it stands for: both for n above 0; for n = 0 the cosine, motion without twist, or the sine,
        torsion.
    squared : ndarray, shape (modes,)
        Squared angular frequencies [1/s²], rising; zero for rigid modes.
    shapes : ndarray, shape (3, points, modes)
        U, V and W of unit modal mass.
    """

    order: int
    sides: tuple[int, ...]
    squared: Array
    shapes: Array


@dataclass(frozen=True, eq=False)
class Constraint:
    """A set of degrees of freedom that are held.

    Attributes
    ----------
    components : tuple of int
        Those that are: 0, 1, 2 for r, theta and z.
    points : ndarray of int
        Numbers of the points.
    """

    components: tuple[int, ...]
    points: Array


def families(
    elements: FourierElements, held: Sequence[Constraint], cutoff: float, orders: Sequence[int]
) -> tuple[list[Family], float]:
    """Return the modes up to a cutoff [Hz] of some orders, and the lowest frequency of all [Hz]."""
    found, lowest, modes, expected = [], math.inf, 0, 0
    for order in orders:
        kinds = [((U, W), (COSINE,)), ((V,), (SINE,))] if order == 0 else [((U, V, W), (COSINE, SINE))]
        for components, sides in kinds:
            with threadpool_limits(1):
                family = _family(elements, held, cutoff, order, components, sides, expected)
            if family.squared.size:
                lowest = min(lowest, math.sqrt(family.squared[0]) / (2.0 * math.pi))
            below = np.sqrt(family.squared) <= 2.0 * math.pi * cutoff
            expected = int(below.sum())
            modes += len(sides) * expected
            check_mode_count(modes, cutoff)
            if below.any():
                found.append(Family(order, sides, family.squared[below], family.shapes[..., below]))
    return found, lowest


def _family(
    elements: FourierElements,
    held: Sequence[Constraint],
    cutoff: float,
    order: int,
    components: tuple[int, ...],
    sides: tuple[int, ...],
    expected: int,
) -> Family:
    angle = 2.0 * math.pi if order == 0 else math.pi
    free = _free(elements, held, order, components)
    count, size = elements.count, free.shape[1]
    if not size:
        return Family(order, sides, np.zeros(0), np.zeros((3, count, 0)))
    whole = scipy.sparse.block_diag([elements.mass] * 3, format="csr")
    mass = (angle * (free.T @ whole @ free)).tocsc()
    stiffness = (angle * (free.T @ elements.stiffness_of(order) @ free)).tocsc()
    # Symmetric to the last bit, which the factorisation takes for granted.
    mass, stiffness = 0.5 * (mass + mass.T), 0.5 * (stiffness + stiffness.T)
    rigid = _unheld(elements, held, order, components)
    # Every row of `free` has one entry at most, and every column one that is +1.
    rigid = np.asarray(scipy.sparse.csr_matrix(free > 0.0).astype(float).T @ rigid)
    squared, vectors = _lowest_modes(stiffness, mass, rigid, cutoff, expected)
    vectors = vectors * np.sign(vectors[np.abs(vectors).argmax(axis=0), np.arange(vectors.shape[1])])
    return Family(order, sides, squared, np.asarray(free @ vectors).reshape(3, count, -1))


def _free(elements: FourierElements, held: Sequence[Constraint], order: int, components: tuple[int, ...]) -> Any:
    """Return what the degrees of freedom are made of those left free, shape (3 points, free).

    On the axis the displacement has one value for all angles: only W for n = 0, only U = -V for n = 1, none above.
    """
    count, axis = elements.count, elements.axis_points
    kept = np.zeros((3, count), dtype=bool)
    kept[list(components)] = True
    for one in held:
        kept[_block(one.components, one.points)] = False
    single = {0: (W,), 1: (U, V)}.get(order, ())
    kept[_block([k for k in range(3) if k not in single], axis)] = False
    tied = axis[:0]
    if order == 1:
        tied = axis[kept[U, axis] & kept[V, axis]]
        kept[_block([U, V], axis)] = False
        kept[U, tied] = True
    columns = np.full(3 * count, -1)
    rows = np.flatnonzero(kept.ravel())
    columns[rows] = np.arange(rows.size)
    entries = np.concatenate([np.ones(rows.size), -np.ones(tied.size)])
    places = np.concatenate([rows, V * count + tied]), columns[np.concatenate([rows, U * count + tied])]
    return scipy.sparse.csr_matrix((entries, places), shape=(3 * count, rows.size))


def _block(components: Sequence[int], points: Array) -> tuple[Array, Array]:
    """Return the indices of some components of some points."""
    return np.array(components, dtype=int)[:, None], points[None]


def _unheld(elements: FourierElements, held: Sequence[Constraint], order: int, components: tuple[int, ...]) -> Array:
    """Return the rigid motions of an order that nothing holds, shape (3 points, motions)."""
    numbers = _RIGID.get((order, components))
    if numbers is None:
        return np.zeros((3 * elements.count, 0))
    motions = _rigid(elements, order)[:, :, list(numbers)]
    rows = [motions[_block(one.components, one.points)].reshape(-1, len(numbers)) for one in held]
    if rows:
        # As many rows of nothing as there are motions, so that each has a size.
        at_held = np.concatenate([*rows, np.zeros((len(numbers), len(numbers)))])
        _, sizes, basis = scipy.linalg.svd(at_held, full_matrices=False)
        motions = motions @ basis[sizes <= UNHELD * math.sqrt(len(at_held))].T
    return np.asarray(motions.reshape(3 * elements.count, -1))


# Numbers of the motions of `_rigid` that each family has.
_RIGID = {(0, (U, W)): (0,), (0, (V,)): (1,), (1, (U, V, W)): (0, 1)}


def _rigid(elements: FourierElements, order: int) -> Array:
    """Return rigid motions by a unit of length at most, shape (3, points, 2).

    For n = 0 along the axis and about it; for n = 1 across the axis, and about a line across it.
    """
    (r, z), one = elements.places, np.ones(elements.count)
    size, none = elements.profile.size, np.zeros(elements.count)
    z = (z - z.mean()) / size
    if order == 0:
        return np.array([[none, none], [none, r / size], [one, none]]).transpose(0, 2, 1)
    return np.array([[one, z], [-one, -z], [none, -r / size]]).transpose(0, 2, 1)


def _lowest_modes(stiffness: Any, mass: Any, rigid: Array, cutoff: float, expected: int) -> tuple[Array, Array]:
    """Return squared frequencies, rising, and vectors of unit mass: all up to a cutoff [Hz] and one more.

    The first are the rigid motions as they are, the others orthogonal to them.
    """
    size, count = stiffness.shape[0], rigid.shape[1]
    rigid = _orthonormal(rigid, mass)
    limit, wanted = (2.0 * math.pi * cutoff) ** 2, count + expected + MORE
    solve = None
    while True:
        if size <= max(DENSE, 2 * wanted):
            squared, vectors = scipy.linalg.eigh(stiffness.toarray(), mass.toarray())
        else:
            shift = -(SHIFT**2) * limit
            solve = solve or _solver(stiffness - shift * mass)
            start = np.random.default_rng(0).standard_normal(size)
            squared, vectors = eigsh(stiffness, wanted, mass, sigma=shift, OPinv=solve, v0=start)
        order = np.argsort(squared)[count:]
        squared, vectors = squared[order], vectors[:, order]
        if len(squared) + count == size or (len(squared) and squared[-1] > limit):
            break
        wanted = min(2 * wanted, size)
    beyond = int(np.searchsorted(squared, limit, side="right"))
    squared, vectors = squared[: beyond + 1], vectors[:, : beyond + 1]
    vectors = vectors - rigid @ (rigid.T @ (mass @ vectors))
    return np.concatenate([np.zeros(count), squared]), np.hstack([rigid, _orthonormal(vectors, mass)])


def _solver(matrix: Any) -> LinearOperator:
    factors = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return LinearOperator(matrix.shape, matvec=factors.solve)


def _orthonormal(vectors: Array, mass: Any) -> Array:
    """Return vectors of unit mass, each orthogonal to those before it."""
    if not vectors.shape[1]:
        return vectors
    factor = scipy.linalg.cholesky(vectors.T @ (mass @ vectors))
    return np.asarray(scipy.linalg.solve_triangular(factor, vectors.T, trans="T").T)
