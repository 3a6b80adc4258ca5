"""Modes of a body of revolution, order by order round its axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg
import scipy.sparse
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from threadpoolctl import threadpool_limits

from ...arrays import Array
from ...long_tasks import check_wanted, tell_done
from ...ordinary import check_mode_count
from .fourier_elements import FourierElements, U, V, W

# Frequency of the negative shift, as a share of the cutoff: far enough from rigid motions for the factorisation.
SHIFT = 0.1
# Modes of an order in the first search, beyond the number of the order before.
MORE = 2
# Most degrees of freedom for dense matrices.
DENSE = 150
# Size of a rigid motion at held points, relative to the motion, below which it is not held.
UNHELD = 1e-9
COSINE, SINE = 0, 1
# Modes left out lie above the cutoff: each step reduces the error to at most SHIFT² of it.
STATIC_STEPS = 8
# Share of the energy of static responses in a shape below which it is round-off.
INDEPENDENT = 1e-12


class Kind(NamedTuple):
    """Motions with the same dependence on the angle.

    Attributes
    ----------
    order : int
        Number of waves n round the axis.
    components : tuple of int
        Components that move, of U, V and W.
    sides : tuple of int
        Members of the pair that it represents: both for n above 0; for n = 0 the cosine, motion without twist, or the
        sine, torsion.
    """

    order: int
    components: tuple[int, ...]
    sides: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Family:
    """Modes of one kind, residual shapes last.

    Attributes
    ----------
    kind : Kind
        Kind of all its modes.
    squared : ndarray, shape (modes,)
        Squared angular frequencies [1/s²], rising; zero for rigid modes, infinite for residual shapes.
    shapes : ndarray, shape (3, points, modes)
        U, V and W of unit modal mass; of unit stiffness for residual shapes.
    lowest : float
        Lowest frequency of all modes, kept or not [Hz].
    """

    kind: Kind
    squared: Array
    shapes: Array
    lowest: float = math.inf


@dataclass(frozen=True, eq=False)
class Constraint:
    """A set of held degrees of freedom.

    Attributes
    ----------
    components : tuple of int
        Held components: 0, 1, 2 for r, theta and z.
    points : ndarray of int
        Numbers of the points.
    """

    components: tuple[int, ...]
    points: Array


def families(
    elements: FourierElements,
    held: Sequence[Constraint],
    cutoff: float,
    orders: Sequence[int],
    residual_at: Sequence[tuple[float, float]] = (),
) -> list[Family]:
    """Return the modes up to a cutoff [Hz] of some orders, and residual shapes for forces at places (r, z) [m]."""
    found: list[Family] = []
    modes, expected = 0, 0
    for number, order in enumerate(orders):
        tell_done(number, len(orders))
        kinds = [Kind(order, (U, V, W), (COSINE, SINE))]
        if order == 0:
            kinds = [Kind(0, (U, W), (COSINE,)), Kind(0, (V,), (SINE,))]
        for kind in kinds:
            check_wanted()
            with threadpool_limits(1):
                found.append(_family(elements, held, cutoff, kind, expected, residual_at))
            expected = int(np.isfinite(found[-1].squared).sum())
            modes += len(kind.sides) * found[-1].squared.size
            check_mode_count(modes, cutoff)
    return found


def _family(
    elements: FourierElements,
    held: Sequence[Constraint],
    cutoff: float,
    kind: Kind,
    expected: int,
    residual_at: Sequence[tuple[float, float]],
) -> Family:
    angle = 2.0 * math.pi if kind.order == 0 else math.pi
    free = _free(elements, held, kind)
    count, size = elements.count, free.shape[1]
    if not size:
        return Family(kind, np.zeros(0), np.zeros((3, count, 0)))
    whole = scipy.sparse.block_diag([elements.mass] * 3, format="csr")
    mass = (angle * (free.T @ whole @ free)).tocsc()
    stiffness = (angle * (free.T @ elements.stiffness_of(kind.order) @ free)).tocsc()
    # Exactly symmetric, as the factorisation assumes.
    mass, stiffness = 0.5 * (mass + mass.T), 0.5 * (stiffness + stiffness.T)
    rigid = _unheld(elements, held, kind)
    # Every row of `free` has at most one entry, and every column has one +1.
    rigid = np.asarray(scipy.sparse.csr_matrix(free > 0.0).astype(float).T @ rigid)
    shifted = Shifted(stiffness, mass, -((SHIFT * 2.0 * math.pi * cutoff) ** 2))
    squared, vectors = _lowest_modes(shifted, rigid, cutoff, expected)
    lowest, below = math.sqrt(squared[0]) / (2.0 * math.pi), np.sqrt(squared) <= 2.0 * math.pi * cutoff
    squared, vectors = squared[below], vectors[:, below]
    if residual_at:
        residual = _residual_shapes(shifted, vectors, free.T @ _loads(elements, kind.order, whole, residual_at))
        squared = np.append(squared, np.full(residual.shape[1], math.inf))
        vectors = np.hstack([vectors, residual])
    vectors = vectors * np.sign(vectors[np.abs(vectors).argmax(axis=0), np.arange(vectors.shape[1])])
    return Family(kind, squared, np.asarray(free @ vectors).reshape(3, count, -1), lowest)


def _free(elements: FourierElements, held: Sequence[Constraint], kind: Kind) -> Any:
    """Return the matrix from the free degrees of freedom to all, shape (3 points, free).

    On the axis the displacement is the same for all angles: only W for n = 0, only U = -V for n = 1, none above.
    """
    order, components, _ = kind
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


def _unheld(elements: FourierElements, held: Sequence[Constraint], kind: Kind) -> Array:
    """Return the rigid motions of an order that are not held, shape (3 points, motions)."""
    order, components, _ = kind
    numbers = _RIGID.get((order, components))
    if numbers is None:
        return np.zeros((3 * elements.count, 0))
    motions = _rigid(elements, order)[:, :, list(numbers)]
    rows = [motions[_block(one.components, one.points)].reshape(-1, len(numbers)) for one in held]
    if rows:
        # As many rows of zeros as there are motions, so that each has a singular value.
        at_held = np.concatenate([*rows, np.zeros((len(numbers), len(numbers)))])
        _, sizes, basis = scipy.linalg.svd(at_held, full_matrices=False)
        motions = motions @ basis[sizes <= UNHELD * math.sqrt(len(at_held))].T
    return np.asarray(motions.reshape(3 * elements.count, -1))


# Numbers of the motions of `_rigid` in each family.
_RIGID = {(0, (U, W)): (0,), (0, (V,)): (1,), (1, (U, V, W)): (0, 1)}


def _rigid(elements: FourierElements, order: int) -> Array:
    """Return rigid motions of at most a unit of length, shape (3, points, 2).

    For n = 0 along the axis and about it; for n = 1 across the axis, and about a line across it.
    """
    (r, z), one = elements.places, np.ones(elements.count)
    size, none = elements.profile.size, np.zeros(elements.count)
    z = (z - z.mean()) / size
    if order == 0:
        return np.array([[none, none], [none, r / size], [one, none]]).transpose(0, 2, 1)
    return np.array([[one, z], [-one, -z], [none, -r / size]]).transpose(0, 2, 1)


@dataclass(frozen=True, eq=False)
class Shifted:
    """Matrices of a kind and their factors with a shift.

    Attributes
    ----------
    stiffness, mass : sparse
        Stiffness K and mass M, shape (free, free).
    shift : float
        Shift s of squared frequencies, below zero [1/s²].
    """

    stiffness: Any
    mass: Any
    shift: float

    @cached_property
    def solve(self) -> Callable[[Array], Array]:
        """Solver of ``(K - s M) x = f``, factorised once."""
        matrix = (self.stiffness - self.shift * self.mass).tocsc()
        options = {"SymmetricMode": True}
        found: Callable[[Array], Array] = splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options
        ).solve
        return found


def _lowest_modes(shifted: Shifted, rigid: Array, cutoff: float, expected: int) -> tuple[Array, Array]:
    """Return squared frequencies, rising, and vectors of unit mass: all up to a cutoff [Hz] and one more.

    The first are the given rigid motions, the others are orthogonal to them.
    """
    stiffness, mass = shifted.stiffness, shifted.mass
    size, count = stiffness.shape[0], rigid.shape[1]
    rigid = _orthonormal(rigid, mass)
    limit, wanted = (2.0 * math.pi * cutoff) ** 2, count + expected + MORE
    while True:
        if size <= max(DENSE, 2 * wanted):
            squared, vectors = scipy.linalg.eigh(stiffness.toarray(), mass.toarray())
        else:

            def solved(vector: Array) -> Array:
                check_wanted()
                return shifted.solve(vector)

            inverse = LinearOperator(stiffness.shape, matvec=solved)
            start = np.random.default_rng(0).standard_normal(size)
            squared, vectors = eigsh(stiffness, wanted, mass, sigma=shifted.shift, OPinv=inverse, v0=start)
        order = np.argsort(squared)[count:]
        squared, vectors = squared[order], vectors[:, order]
        if len(squared) + count == size or (len(squared) and squared[-1] > limit):
            break
        wanted = min(2 * wanted, size)
    beyond = int(np.searchsorted(squared, limit, side="right"))
    squared, vectors = squared[: beyond + 1], vectors[:, : beyond + 1]
    vectors = vectors - rigid @ (rigid.T @ (mass @ vectors))
    return np.concatenate([np.zeros(count), squared]), np.hstack([rigid, _orthonormal(vectors, mass)])


def _loads(elements: FourierElements, order: int, mass: Any, places: Sequence[tuple[float, float]]) -> Array:
    """Return unit forces along r, theta and z at places of the profile, and gravity, shape (3 points, forces)."""
    found = np.zeros((3, elements.count, 3 * len(places)))
    for number, (r, z) in enumerate(places):
        points, values = elements.shape_functions(r, z)
        for component in range(3):
            found[component, points, 3 * number + component] = values
    uniform = _rigid(elements, order)[:, :, :1] if order < 2 else np.zeros((3, elements.count, 0))
    forces = (found, (mass @ uniform.reshape(3 * elements.count, -1)).reshape(uniform.shape))
    return np.concatenate(forces, axis=2).reshape(3 * elements.count, -1)


def _residual_shapes(shifted: Shifted, kept: Array, forces: Array) -> Array:
    """Return the static responses of the modes left out to forces, orthonormal in the stiffness (MacNeal 1971).

    Without the modes kept, the shift is small compared to the remaining stiffness, so that its share is computed from
    the response of the previous step.
    """
    carried = shifted.mass @ kept
    forces = forces - carried @ (kept.T @ forces)
    answers = np.zeros_like(forces)
    for _ in range(STATIC_STEPS):
        answers = shifted.solve(forces - shifted.shift * (shifted.mass @ answers))
        answers = answers - kept @ (carried.T @ answers)
    energies = np.sqrt(np.maximum((answers * (shifted.stiffness @ answers)).sum(axis=0), 0.0))
    answers = answers[:, energies > 0.0] / energies[energies > 0.0]
    if not answers.size:
        return np.zeros((len(forces), 0))
    shares, basis = scipy.linalg.eigh(answers.T @ (shifted.stiffness @ answers))
    lasting = shares > INDEPENDENT * shares[-1]
    return np.asarray(answers @ (basis[:, lasting] / np.sqrt(shares[lasting])))


def _orthonormal(vectors: Array, mass: Any) -> Array:
    """Return vectors of unit mass, each orthogonal to those before it."""
    if not vectors.shape[1]:
        return vectors
    factor = scipy.linalg.cholesky(vectors.T @ (mass @ vectors))
    return np.asarray(scipy.linalg.solve_triangular(factor, vectors.T, trans="T").T)
