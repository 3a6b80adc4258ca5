"""Small vibration about an equilibrium under exact constraints, as a first-order matrix."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg

from ..arrays import Array
from ..checks import ArgumentError
from ..contact.linearised import Linearised
from ..contact.stiffness import slopes_at
from .balance import held_across, held_rows, rank, rigid_rows
from .equilibrium import Equilibrium
from .structure import SLIDING, STICKING, Structure

# Relative imaginary part of an exponent that counts as round-off of a real one.
ROUND_OFF = 1e-9
# Dense matrices are used if more than this share of the entries of stiffness and damping is not zero.
DENSE = 0.1


@dataclass(frozen=True)
class Vibration:
    """Small motions q about an equilibrium, with multipliers m of the constraints and states z of the friction laws.

    ::

        mass q'' + damping q' + stiffness q + by_state z = pushes^T m,    held q = 0,
        z' = from_velocity q' + from_displacement q + state z

    Attributes
    ----------
    mass : ndarray, shape (modes,)
        Modal masses: 1, and 0 for residual shapes.
    stiffness, damping : ndarray, shape (modes, modes)
        Including the terms of friction and of the shift of contact points.
    held, pushes : ndarray, shape (constraints, modes)
        Independent constraints of contacts, and modal forces of their multipliers.
    spread : ndarray, shape (rows, constraints)
        Forces on the rigid rows of `held_rows` by unit multipliers.
    by_state, from_velocity, from_displacement : ndarray, shape (modes, states), (states, modes) twice
        Modal forces of states, and rates of states by motion.
    state : ndarray, shape (states,)
        Rate of each state due to itself [1/s].
    owners : tuple of (int, bool)
        Contact of each state, and whether the state is the one across the slip.
    free : ndarray, shape (modes, motions)
        Free rigid motions, orthonormal: only their velocity matters, since the contact point is considered fixed.
    """

    mass: Array
    stiffness: Array
    damping: Array
    held: Array
    pushes: Array
    spread: Array
    by_state: Array
    from_velocity: Array
    from_displacement: Array
    state: Array
    owners: tuple[tuple[int, bool], ...]
    free: Array


def vibration(structure: Structure, equilibrium: Equilibrium, spread: Array | None = None) -> Vibration:
    """Return the small motions of a system about an equilibrium.

    In addition to the terms without load, a contact point shifts along a deflected track: the gap changes with its
    slope, and the contact forces act on other points of it.

    Parameters
    ----------
    structure : Structure
        The system.
    equilibrium : Equilibrium
        The equilibrium.
    spread : ndarray, shape (rows, constraints), optional
        Combinations of rigid rows that are taken as the independent constraints; found if left out.
    """
    stiffness, damping = structure.stiffness.copy(), structure.damping.copy()
    share, passing = equilibrium.sense * (equilibrium.ratio + _rises(structure, equilibrium)), structure.passing
    held, pushes, closed, stuck = held_rows(structure, equilibrium.status, share)
    held, answers, carries = held.copy(), list[_Answer](), bool(passing.any())
    shifted, shifts = list[Array](), list[Array]()
    for row, k in enumerate(closed):
        line, shape = structure.lines[k], equilibrium.displacement
        held[row] -= (line.normal_slope @ shape) * line.along
        normal, tangential = equilibrium.normal_force[k], equilibrium.tangential_force[k]
        if line.along.any():
            shifted.append(normal * line.normal_slope - tangential * line.tangent_slope)
            shifts.append(line.along)
        slip = line.tangent - (line.slip_slope @ shape) * line.along
        if k in stuck:
            if carries and (slip @ passing).any():
                name = structure.system.contact_names[k]
                raise ArgumentError(
                    "status", f"not let {name} stick to a body that turns: it would be carried away", STICKING
                )
            held[len(closed) + stuck.index(k)] = slip
        answers += _answers(structure, equilibrium, k, slip)
    pulls, slips = ([getattr(one, word) for one in answers] for word in ("pull", "slip"))
    rates = [one.normal * one.near.slope for one in answers]
    _add(stiffness, [1.0] * len(shifts), shifted, shifts)
    _add(damping, rates, pulls, slips)
    if carries and answers:
        _add(stiffness, rates, pulls, np.array(slips) @ passing)
    free = structure.free_motions(held)
    every = [structure.system.contacts[k].yields for k in closed]
    forces = equilibrium.normal_force[closed].tolist()
    slopes = [slopes_at(one, at) if one else (0.0, 0.0) for one, at in zip(every, forces, strict=True)]
    for matrix, column in zip((stiffness, damping), zip(*slopes, strict=True), strict=False):
        _add(matrix, column, pushes[: len(closed)], held[: len(closed)])
    joints = [structure.system.contacts[k] for k in (*stuck, *held_across(structure, stuck))]
    joined = [(one.tangential_stiffness or 0.0, one.tangential_damping) for one in joints]
    for matrix, column in zip((stiffness, damping), zip(*joined, strict=True), strict=False):
        _add(matrix, column, -pushes[len(closed) :], held[len(closed) :])
    rigid = rigid_rows(structure, closed, stuck)
    spread = _independent(held[rigid]) if spread is None else spread
    held, pushes = spread.T @ held[rigid], spread.T @ pushes[rigid]
    by_state, from_velocity, state = _states(kept := [one for one in answers if one.near.state_by_state], structure)
    moved, owners = (from_velocity, from_velocity @ passing), tuple(one.owner for one in kept)
    return Vibration(structure.mass, stiffness, damping, held, pushes, spread, by_state, *moved, state, owners, free)


def _rises(structure: Structure, equilibrium: Equilibrium) -> Array:
    """Return the change of friction per normal force that is due to that of the coefficient, (contacts,)."""
    found = np.zeros(len(structure.lines))
    for k, contact in enumerate(structure.system.contacts):
        if contact.law.depends_on_pressure and equilibrium.status[k] == SLIDING:
            normal, speed = float(equilibrium.normal_force[k]), abs(float(equilibrium.slip_velocity[k]))
            found[k] = normal * contact.law.slope_over_normal(speed or 1.0, normal)
    return found


def _add(matrix: Array, factors: Sequence[float], columns: Any, rows: Any) -> None:
    """Add the outer product of each column and row, times its factor, to a matrix: all at once, as they may be many."""
    used = np.flatnonzero(factors)
    if used.size:
        matrix += (np.array(columns)[used].T * np.array(factors)[used]) @ np.array(rows)[used]


def _independent(rows: Array) -> Array:
    """Return an orthonormal basis of combinations of rows that are independent, the rows themselves if they are."""
    size = rank(rows)
    return np.eye(len(rows)) if size == len(rows) else np.linalg.svd(rows, full_matrices=False)[0][:, :size]


@dataclass(frozen=True)
class _Answer:
    """Linearised friction along the slip of a contact, or across it.

    Attributes
    ----------
    owner : tuple of (int, bool)
        Number of the contact, and whether across.
    near : Linearised
        Linearised law, in the sense of sliding.
    sense, normal : float
        Sense of sliding, and normal force [N].
    pull, slip : ndarray, shape (modes,)
        Modal force of the tangential force, and row of the slip.
    """

    owner: tuple[int, bool]
    near: Linearised
    sense: float
    normal: float
    pull: Array
    slip: Array


def _answers(structure: Structure, equilibrium: Equilibrium, k: int, slip: Array) -> list[_Answer]:
    """Return the linearised friction of contact `k` across its slip, where it can move so, and along it."""
    speed, normal = abs(float(equilibrium.slip_velocity[k])), float(equilibrium.normal_force[k])
    line, law = structure.lines[k], structure.system.contacts[k].law.under(normal)
    found = []
    if speed and equilibrium.status[k] == SLIDING and line.across.any():
        found.append(_Answer((k, True), law.linearised_across(speed), 1.0, normal, line.across, line.across))
    if speed and law.depends_on_speed:
        sense = float(equilibrium.sense[k])
        found.append(_Answer((k, False), law.linearised_at(speed), sense, normal, line.tangent, slip))
    return found


def _states(answers: list[_Answer], structure: Structure) -> tuple[Array, Array, Array]:
    """Return the modal forces of internal states, their rates by motion, and their rates by themselves."""
    size = structure.mode_count, len(answers)
    by_state = np.array([one.sense * one.normal * one.near.by_state * one.pull for one in answers])
    moved = np.array([one.sense * one.near.state_by_velocity * one.slip for one in answers])
    own = np.array([one.near.state_by_state for one in answers])
    return by_state.reshape(size[::-1]).T, moved.reshape(size[::-1]), own


@dataclass(frozen=True)
class Exponents:
    """Exponents s of small motions ``exp(s t)``, one from each conjugate pair.

    Attributes
    ----------
    values : ndarray of complex, shape (count,)
        The exponents [1/s].
    shapes : ndarray of complex, shape (modes, count)
        Modal displacements.
    """

    values: Array
    shapes: Array


def all_exponents(motion: Vibration, shapes: bool = True) -> Exponents:
    """Return all exponents by a dense solver; shapes are empty if not wanted."""
    basis, first = _first_order(motion)
    if not shapes:
        values = scipy.linalg.eigvals(first, check_finite=False, overwrite_a=True)
        return Exponents(values[values.imag >= 0.0], np.empty((len(basis), 0)))
    values, vectors = scipy.linalg.eig(first, check_finite=False, overwrite_a=True)
    chosen = values.imag >= 0.0
    values, vectors = values[chosen], vectors[:, chosen]
    rigid, motions = motion.free.shape[1], basis.shape[1]
    moved = vectors[: motions - rigid]
    drift = vectors[motions - rigid : motions]
    turning = np.where(values == 0.0, 1.0, values)
    return Exponents(values, motion.free @ (drift / turning) + basis[:, rigid:] @ moved)


def _first_order(motion: Vibration) -> tuple[Array, Array]:
    """Return a basis of the motions that the contacts allow, free rigid ones first, and the first-order matrix.

    Its vector has displacements along all but the free ones, velocities along all, and states.
    """
    free, states = motion.free, len(motion.state)
    rigid, fixed = free.shape[1], np.vstack([free.T, motion.held])
    basis = scipy.linalg.qr(fixed.T)[0] if len(fixed) else np.eye(len(free))
    basis = np.hstack([free, basis[:, len(fixed) :]])
    motions = basis.shape[1]
    elastic = motions - rigid
    # Forces without the part that the constraints balance: projected along the pushes onto allowed motions.
    answer = basis.T - (basis.T @ motion.pushes.T) @ np.linalg.solve(motion.held @ motion.pushes.T, motion.held)
    first = np.zeros((elastic + motions + states,) * 2)
    velocities, own = slice(elastic, elastic + motions), slice(elastic + motions, None)
    first[:elastic, elastic + rigid : elastic + motions] = np.eye(elastic)
    first[velocities, :elastic] = -answer @ motion.stiffness @ basis[:, rigid:]
    first[velocities, velocities] = -answer @ motion.damping @ basis
    first[velocities, own] = -answer @ motion.by_state
    first[own, velocities] = motion.from_velocity @ basis
    first[own, :elastic] = motion.from_displacement @ basis[:, rigid:]
    first[own, own] = np.diag(motion.state)
    return basis, first


def nearest_exponents(motion: Vibration, count: int, shift: complex) -> Exponents:
    """Return the exponents nearest to a shift, by Arnoldi's method with the inverse about it.

    The constraints stay in the equations as borders, so that sparse matrices stay sparse.
    """
    modes, states = len(motion.stiffness), len(motion.state)
    # The displacement along a free rigid motion has no effect, see `Vibration`.
    stiffness = motion.stiffness - (motion.stiffness @ motion.free) @ motion.free.T
    inner = 1.0 / (motion.state - shift)
    moving = motion.damping - motion.by_state @ (inner[:, None] * motion.from_velocity)
    stiffness = stiffness - motion.by_state @ (inner[:, None] * motion.from_displacement)
    solve = _bordered(stiffness + shift * moving + shift**2 * np.diag(motion.mass), motion)

    def still(place: Array) -> Array:
        return np.asarray(place - motion.free @ (motion.free.T @ place))

    def inverse(vector: Array) -> Array:
        place, speed, own = np.split(vector, [modes, 2 * modes])
        right = -motion.mass * (speed + shift * place) - moving @ place - motion.by_state @ (inner * own)
        moved = solve(right)
        velocity = place + shift * moved
        driven = motion.from_velocity @ velocity + motion.from_displacement @ moved
        return np.concatenate([still(moved), velocity, inner * (own - driven)])

    size = 2 * modes + states
    operator = scipy.sparse.linalg.LinearOperator((size, size), matvec=inverse, dtype=complex)
    start = np.random.default_rng(0).standard_normal(size) + 0.0j
    found, vectors = scipy.sparse.linalg.eigs(operator, k=count, which="LM", v0=inverse(start))
    values = shift + 1.0 / found
    least = ROUND_OFF * np.maximum(np.abs(values), np.abs(shift))
    values = np.where(np.abs(values.imag) < least, values.real, values)
    chosen = values.imag >= 0.0
    values, vectors = values[chosen], vectors[modes : 2 * modes, chosen]
    return Exponents(values, vectors / np.where(values == 0.0, 1.0, values))


def _bordered(dynamic: Array, motion: Vibration) -> Callable[[Array], Array]:
    """Return a function that solves ``dynamic q - pushes^T m = f, held q = 0`` for q."""
    modes, count = len(dynamic), len(motion.held)
    corner = np.zeros((count, count))
    if np.count_nonzero(dynamic) < DENSE * dynamic.size:
        whole: Any = scipy.sparse.bmat(
            [[scipy.sparse.csc_matrix(dynamic), -motion.pushes.T], [motion.held, scipy.sparse.csc_matrix(corner)]],
            format="csc",
        )
        solve = scipy.sparse.linalg.splu(whole).solve
    else:
        parts = scipy.linalg.lu_factor(np.block([[dynamic, -motion.pushes.T], [motion.held, corner]]))
        solve = partial(scipy.linalg.lu_solve, parts)
    return lambda force: solve(np.concatenate([force, np.zeros(count)]))[:modes]
