"""Reduction of sparse matrices to mass-normalised modes up to a cutoff and residual shapes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
from threadpoolctl import threadpool_limits

from ...arrays import Array
from ...checks import ArgumentError, at_least
from ...long_tasks import check_wanted, tell_done
from ..damping import check_damping_count, damping_rates
from ..limits import LARGEST_SIZE
from ..matrix_input import ROUND_OFF
from ..modes import Modes
from .block_lanczos import LONGEST, SETTLED, WIDTH, Inverse, lowest
from .dense_reduction import RESIDUAL, Reduction, damping_in_modes, reduce_body, reduction_of
from .factorisation import Solve, factorised

# Degrees of freedom up to which a dense solution for all modes is faster than a search for some.
DENSE = 600
# Negative shift as a share of the squared cutoff: far enough from zero for accuracy of rigid modes, near enough for a
# fast search. Where rigid motions are known, a smaller one, with which static responses take half as many steps.
SHIFT, SMALL_SHIFT = 0.01, 1e-4
# Beyond one in so many of all modes a dense solution is faster, where it is possible.
DENSE_SHARE = 8
# Most modes in a search; a thousand take minutes.
MOST_MODES = 2000
# Vectors of a search for each mode that may be found before another way is taken.
VECTORS = 4
# Largest error of the static compliance at a patch that is due to residual shapes left out, relative to that of all
# elastic modes.
COMPLIANCE = 1e-3
# Forces whose responses are computed at a time, which bounds the memory.
AT_ONCE = 128
# Most steps of the static responses; they usually end after some ten.
MOST_STEPS = 200


@dataclass(frozen=True)
class SparseReduction:
    """Modes of sparse matrices.

    Attributes
    ----------
    angular_frequency : ndarray, shape (modes,)
        Angular frequencies [rad/s], rising; zero for rigid modes, infinite for residual shapes, which come last.
    shapes : ndarray, shape (n, modes)
        Mass-normalised shapes; residual shapes have unit stiffness.
    """

    angular_frequency: Array
    shapes: Array


@dataclass(frozen=True)
class SparseProblem:
    """Matrices whose modes are to be computed.

    Attributes
    ----------
    mass, stiffness : scipy sparse, shape (n, n)
        Mass matrix, positive definite, and stiffness matrix, positive semidefinite.
    forces : ndarray, shape (n, forces)
        Forces to which the modes left out respond statically.
    patches : ndarray, shape (n, patches), optional
        Forces to which they respond up to `COMPLIANCE` of the compliance of each.
    rigid : ndarray, shape (n, rigid), optional
        Motions without stiffness, mass-normalised; computed with the modes if left out.
    order : ndarray, shape (n,), optional
        Order of elimination.
    """

    mass: Any
    stiffness: Any
    forces: Array
    patches: Array | None = None
    rigid: Array | None = None
    order: Array | None = None

    @property
    def every_force(self) -> Array:
        """All forces, those on patches last."""
        return self.forces if self.patches is None else np.hstack([self.forces, self.patches])


def reduce_sparse_body(body: Any) -> Reduction:
    """Return the modes of a `ReducedBody` of sparse matrices and their shapes."""
    rows = list(body.points.values()) if body.residual_flexibility else []
    if body.residual_flexibility and body.translation is not None:
        rows.append(body.translation @ body.mass)
    forces = np.concatenate(rows).T if rows else np.zeros((body.mass.shape[0], 0))
    found = reduce_sparse(SparseProblem(body.mass, body.stiffness, forces), body.cutoff)
    found.shapes.flags.writeable = False
    moved = np.zeros((2, found.angular_frequency.size))
    if body.translation is not None:
        moved = body.translation @ body.mass @ found.shapes
    return Reduction(modes_of(found, body.damping, moved), found.shapes)


def reduce_large_body(body: Any) -> Reduction:
    """Return the modes of a `ReducedBody` with a cutoff whose matrices are dense, by a search for these modes alone.

    Matrices that are not positive semidefinite are left to the solution for all modes, which explains the error.
    """
    scale = 1.0 / np.sqrt(np.diag(body.mass))
    both = np.outer(scale, scale)
    with np.errstate(over="ignore", invalid="ignore"):
        mass, stiffness = body.mass * both, body.stiffness * both
    highest = (2.0 * np.pi * body.cutoff) ** 2
    if not (np.isfinite(stiffness).all() and _is_definite(stiffness + SHIFT * highest * mass)):
        return reduce_body(body)
    rows = list(body.points.values()) if body.residual_flexibility else []
    if body.residual_flexibility and body.translation is not None:
        rows.append(body.translation @ body.mass)
    forces = scale[:, None] * np.concatenate(rows).T if rows else np.zeros((len(mass), 0))
    problem = SparseProblem(scipy.sparse.csr_array(mass), scipy.sparse.csr_array(stiffness), forces)
    found = reduce_sparse(problem, body.cutoff)
    massless, shapes = np.isinf(found.angular_frequency), scale[:, None] * found.shapes
    angular, kept = found.angular_frequency[~massless], shapes[:, ~massless]
    damped = isinstance(body.damping, np.ndarray) and body.damping.ndim == 2
    largest = float(np.max(np.diag(body.damping) * scale**2)) if damped else 0.0
    damping = damping_in_modes(body.damping, angular, kept, np.ones(angular.size, dtype=bool), largest)
    return reduction_of(body, angular, kept, shapes[:, massless], *damping)


def _is_definite(matrix: Array) -> bool:
    try:
        np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        return False
    return True


def modes_of(found: SparseReduction, damping: Any, translation: Array, loss_factor: float | Array = 0.0) -> Modes:
    """Return modes with their damping and the loss factors of their materials; residual shapes have none."""
    angular = found.angular_frequency
    massless = np.isinf(angular)
    check_damping_count(damping, int((~massless).sum()))
    lost = np.broadcast_to(loss_factor, angular.shape)[~massless]
    rates = np.append(damping_rates(damping, angular[~massless], lost), np.zeros(int(massless.sum())))
    return Modes(angular, rates, translation)


def reduce_sparse(problem: SparseProblem, cutoff: float | None) -> SparseReduction:
    """Return the modes up to a cutoff [Hz], all modes without one, and the residual shapes of the forces.

    One factorisation of ``K + s M`` serves the search for the modes (shift-invert Lanczos) and the static responses.

    Raises
    ------
    ValueError
        If no mode is left, or if a frequency is zero where no motion is rigid.
    """
    # Threads slow down the many small blocks of the factors, and a single thread gives the same bits on every machine.
    with threadpool_limits(1):
        return _reduced(problem, cutoff)


def _reduced(problem: SparseProblem, cutoff: float | None) -> SparseReduction:
    size = problem.mass.shape[0]
    highest = np.inf if cutoff is None else 2.0 * np.pi * cutoff
    largest = float(np.max(problem.stiffness.diagonal() / problem.mass.diagonal()))
    solve: Solve | None = None
    # A smaller shift would be lost in the rounding of the largest frequencies.
    share = SHIFT if problem.rigid is None else SMALL_SHIFT
    shift = max(share * highest**2, 1e3 * ROUND_OFF * largest) if cutoff is not None else 0.0
    if cutoff is None or size <= DENSE:
        squared, shapes = _all_modes(problem)
    else:
        solve = factorised(problem.stiffness + shift * problem.mass, problem.order)
        squared, shapes = _modes_up_to(problem, solve, shift, highest)
    angular, shapes = _with_rigid(problem, squared, shapes, ROUND_OFF * largest)
    kept = angular <= highest
    if not kept.any():
        first = angular[0] / (2.0 * np.pi)
        raise ArgumentError(
            "cutoff", f"leave at least one mode (first at {at_least(first)} Hz)", cutoff, got=f"{cutoff!r} Hz"
        )
    angular, shapes = angular[kept], shapes[:, kept]
    if cutoff is None or not problem.every_force.size or shapes.shape[1] == size:
        return SparseReduction(angular, shapes)
    if solve is None:
        solve = factorised(problem.stiffness + shift * problem.mass, problem.order)
    residual = residual_shapes(problem, solve, shapes)
    if problem.patches is not None:
        residual = _compressed(problem, angular, shapes, residual)
    angular = np.append(angular, np.full(residual.shape[1], np.inf))
    return SparseReduction(angular, np.hstack([shapes, residual]))


def residual_shapes(problem: SparseProblem, solve: Solve, kept: Array) -> Array:
    """Return the static responses to the forces without the share of the modes kept, orthonormal in the stiffness.

    ``Psi Psi^T`` is the flexibility of the modes left out wherever these forces act (MacNeal 1971). Rigid modes are
    among those kept, so the response of a free body includes the inertia of its rigid motion.
    """
    forces = problem.every_force
    moved = problem.mass @ kept
    first = solve(forces)
    sizes = np.sqrt(np.maximum(np.sum(forces * first, axis=0), 0.0))
    felt = sizes > 0.0
    forces, first = forces[:, felt] / sizes[felt], first[:, felt] / sizes[felt]
    forces = forces - moved @ (kept.T @ forces)
    parts = [slice(start, start + AT_ONCE) for start in range(0, forces.shape[1], AT_ONCE)]
    found = []
    for part in parts:
        if len(parts) > 1:
            tell_done(part.start, forces.shape[1])
        found.append(_static_answers(problem.stiffness, solve, forces[:, part], kept, moved, first[:, part]))
    answers = np.hstack(found or [forces])
    own = np.sqrt(np.maximum(np.sum(answers * (problem.stiffness @ answers), axis=0), 0.0))
    # If the modes kept give the whole response to a force, only rounding remains.
    answers = answers[:, own > RESIDUAL] / own[own > RESIDUAL]
    if not answers.size:
        return np.zeros((len(kept), 0))
    basis, factor = _orthonormal_in(problem.stiffness, answers)
    turned, share, _ = scipy.linalg.svd(factor, full_matrices=False)
    return np.asarray(basis @ turned[:, share > RESIDUAL * share[0]])


def _compressed(problem: SparseProblem, angular: Array, shapes: Array, residual: Array) -> Array:
    """Return the combinations of residual shapes that forces on patches need.

    The response to all other forces is kept. Of the remaining compliance at the patches, scaled so that that of all
    elastic modes is 1 at each, the eigenvectors below `COMPLIANCE` are left out.
    """
    exact = residual.T @ problem.forces
    kept, size, _ = scipy.linalg.svd(exact, full_matrices=True)
    rank = int(np.sum(size > RESIDUAL * size[0])) if size.size else 0
    kept, others = kept[:, :rank], kept[:, rank:]
    at_patches = residual.T @ problem.patches
    elastic = angular > 0.0
    modal = (shapes[:, elastic].T @ problem.patches) / angular[elastic, None]
    total = np.sum(modal**2, axis=0) + np.sum(at_patches**2, axis=0)
    seen = total > 0.0
    scaled = (others.T @ at_patches[:, seen]) / np.sqrt(total[seen])
    ways, share, _ = scipy.linalg.svd(scaled, full_matrices=False)
    return np.asarray(residual @ np.hstack([kept, others @ ways[:, share**2 > COMPLIANCE]]))


def _static_answers(stiffness: Any, solve: Solve, forces: Array, kept: Array, moved: Array, first: Array) -> Array:
    """Solve ``K a = f`` for forces orthogonal to the modes kept, by conjugate gradients with the shifted factors.

    Orthogonal to these modes ``(K + s M)^-1 K`` lies between ``1 / (1 + s / w²)`` and 1, so that a few steps reach
    round-off. The `first` responses of the factors may include those of the modes kept, which are removed.
    """
    answers, left = np.zeros_like(forces), forces.copy()
    way, before = np.zeros_like(forces), np.ones(forces.shape[1])
    goal = float(np.finfo(float).eps) * np.linalg.norm(forces, axis=0)
    best = np.full(forces.shape[1], np.inf)
    for step in range(MOST_STEPS):
        check_wanted()
        guess = solve(left) if step else first
        guess = guess - kept @ (moved.T @ guess)
        now = np.sum(left * guess, axis=0)
        way = guess + way * (now / before)
        against = stiffness @ way
        work = np.sum(way * against, axis=0)
        going = work > 0.0
        length = np.divide(now, work, out=np.zeros_like(now), where=going)
        answers += way * length
        left -= against * length
        left -= moved @ (kept.T @ left)
        size, before = np.linalg.norm(left, axis=0), np.where(now > 0.0, now, 1.0)
        if not going.any() or np.all((size <= goal) | (size >= 0.5 * best)):
            break
        best = np.minimum(best, size)
    answers -= kept @ (moved.T @ answers)
    return answers


def _orthonormal_in(stiffness: Any, vectors: Array) -> tuple[Array, Array]:
    """Return Q and R with ``Q R = vectors`` and ``Q^T K Q = 1``."""
    count = vectors.shape[1]
    basis, stiff = np.zeros_like(vectors), np.zeros_like(vectors)
    factor = np.zeros((count, count))
    taken = 0
    for number in range(count):
        vector = vectors[:, number].copy()
        # Once is not enough if vectors are nearly parallel; twice is.
        for _ in range(2):
            part = stiff[:, :taken].T @ vector
            vector -= basis[:, :taken] @ part
            factor[:taken, number] += part
        against = stiffness @ vector
        length = float(np.sqrt(max(vector @ against, 0.0)))
        if length > ROUND_OFF:
            basis[:, taken], stiff[:, taken] = vector / length, against / length
            factor[taken, number] = length
            taken += 1
    return basis[:, :taken], factor[:taken]


def _all_modes(problem: SparseProblem) -> tuple[Array, Array]:
    """Return all squared frequencies, rising, and their shapes, without the given rigid modes."""
    squared, shapes = scipy.linalg.eigh(problem.stiffness.toarray(), problem.mass.toarray())
    rigid = 0 if problem.rigid is None else problem.rigid.shape[1]
    return squared[rigid:], shapes[:, rigid:]


def _modes_up_to(problem: SparseProblem, solve: Solve, shift: float, highest: float) -> tuple[Array, Array]:
    """Return squared frequencies and shapes of the modes up to an angular frequency, and perhaps of some beyond.

    A last search beside the modes found shows that none was missed.
    """
    size = problem.mass.shape[0]
    known = np.zeros((size, 0)) if problem.rigid is None else problem.rigid
    found, rigid = known, known.shape[1]
    most = size // DENSE_SHARE if size <= LARGEST_SIZE else MOST_MODES
    # The same start in each run, so that the modes of a body are always identical.
    random = np.random.default_rng(rigid)
    block = solve(problem.mass @ random.standard_normal((size, WIDTH)))
    tolerance = SETTLED
    while True:
        inverse = Inverse(problem.mass, solve, shift, found)
        longest = min(LONGEST, VECTORS * (most + WIDTH - found.shape[1]))
        part = lowest(inverse, block, highest**2, 1 if found.shape[1] == rigid else 0, longest, tolerance)
        found = _beside(problem.mass, np.hstack([found, part.shapes]), found.shape[1])
        if found.shape[1] > most:
            if size <= LARGEST_SIZE:
                return _all_modes(problem)
            raise ArgumentError(
                "cutoff", f"leave at most {MOST_MODES} modes of a mesh", got=f"{highest / (2.0 * np.pi):.6g} Hz"
            )
        if part.is_complete:
            if not part.squared.size or part.squared[-1] > highest**2 or found.shape[1] == size:
                break
            block = random.standard_normal((size, WIDTH))
        else:
            block = part.following
            # A search that finds nothing has reached the rounding of the factors.
            tolerance = SETTLED if part.squared.size else 10.0 * tolerance
    vectors = found[:, rigid:]
    squared, turned = scipy.linalg.eigh(vectors.T @ (problem.stiffness @ vectors))
    return squared, vectors @ turned


def _beside(mass: Any, vectors: Array, exact: int) -> Array:
    """Return vectors made orthonormal in the mass; the first `exact` ones already are and do not change."""
    first, others = vectors[:, :exact], vectors[:, exact:]
    # Twice is enough, as above.
    for _ in range(2):
        others = others - first @ ((mass @ first).T @ others)
        factor = np.linalg.cholesky(others.T @ (mass @ others))
        others = scipy.linalg.solve_triangular(factor, others.T, lower=True).T
    return np.hstack([first, others])


def _with_rigid(problem: SparseProblem, squared: Array, shapes: Array, rounding: float) -> tuple[Array, Array]:
    """Return angular frequencies and shapes of rigid and elastic modes, rising."""
    if problem.rigid is None:
        if squared[0] < -rounding:
            raise ArgumentError("stiffness", "be positive semidefinite", got=f"a squared frequency of {squared[0]:.6g}")
        return np.sqrt(np.where(squared <= rounding, 0.0, squared)), shapes
    if squared.size and squared[0] <= rounding:
        zero = int(np.sum(squared <= rounding))
        raise ArgumentError(
            "mesh",
            "be rigidly connected",
            got=f"{zero} motions without stiffness: parts are joined at a node or an edge only",
        )
    rigid = problem.rigid
    shapes = shapes - rigid @ ((problem.mass @ rigid).T @ shapes)
    return np.append(np.zeros(rigid.shape[1]), np.sqrt(squared)), np.hstack([rigid, shapes])
