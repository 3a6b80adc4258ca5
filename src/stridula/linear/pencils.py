"""Small vibration as a matrix pencil, and its derivatives by parameters of the system."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import scipy.linalg

from ..arrays import Array
from ..bodies import BodyPoint
from ..connections import ends, held_motions
from ..lowering.coordinates import Coordinates
from .structure import Structure
from .vibration import Vibration

# Relative distance of angular frequencies below which modes of a body may be any combinations of each other.
EQUAL = 1e-6
# Weight, relative to points, of modes that stay as they are: it decides where no point moves.
UNTURNED = 1e-6


class Pencil(NamedTuple):
    """Small motions as the pencil of `Vibration`, whose entries are smooth in the parameters of a system.

    ::

        mass v' + damping v + stiffness q + by_state z = pushes^T m,    held q = 0
        q' = v,    z' = from_velocity v + from_displacement q + state z

    Attributes
    ----------
    mass, stiffness, damping : ndarray, shape (modes, modes)
        Matrices; displacements along free rigid motions have no effect.
    held, pushes : ndarray, shape (constraints, modes)
        Constraints, and forces of their multipliers.
    by_state, from_velocity, from_displacement : ndarray, shape (modes, states), (states, modes) twice
        Forces of internal states, and their rates.
    state : ndarray, shape (states,)
        Rate of each state due to itself [1/s].
    """

    mass: Array
    stiffness: Array
    damping: Array
    held: Array
    pushes: Array
    by_state: Array
    from_velocity: Array
    from_displacement: Array
    state: Array


def pencil_of(motion: Vibration, turn: Array | None = None) -> Pencil:
    """Return small motions as a pencil, on other coordinates if a matrix from these to those of the motion is given."""
    own = Pencil(
        mass=np.diag(motion.mass),
        stiffness=motion.stiffness - (motion.stiffness @ motion.free) @ motion.free.T,
        damping=motion.damping,
        held=motion.held,
        pushes=motion.pushes,
        by_state=motion.by_state,
        from_velocity=motion.from_velocity,
        from_displacement=motion.from_displacement - (motion.from_displacement @ motion.free) @ motion.free.T,
        state=motion.state,
    )
    return own if turn is None else turned_by(own, turn)


def turned_by(pencil: Pencil, turn: Array) -> Pencil:
    """Return a pencil on other coordinates, by the matrix from these to its own."""
    return Pencil(
        mass=turn.T @ pencil.mass @ turn,
        stiffness=turn.T @ pencil.stiffness @ turn,
        damping=turn.T @ pencil.damping @ turn,
        held=pencil.held @ turn,
        pushes=pencil.pushes @ turn,
        by_state=turn.T @ pencil.by_state,
        from_velocity=pencil.from_velocity @ turn,
        from_displacement=pencil.from_displacement @ turn,
        state=pencil.state,
    )


def combined(pencils: Sequence[Pencil], weights: Sequence[float]) -> Pencil:
    """Return a linear combination of pencils of the same shape."""
    return Pencil(*(sum(w * one for w, one in zip(weights, each, strict=True)) for each in zip(*pencils, strict=True)))


def by_mass(pencil: Pencil, rows: Array) -> Pencil:
    """Return the derivative of a pencil by a point mass [1/kg], from the rows of the displacement of its point."""
    nothing = Pencil(*map(np.zeros_like, pencil))
    return nothing._replace(mass=rows.T @ rows)


def rows_of(structure: Structure) -> Array:
    """Return the displacements of all points by which bodies act on each other, shape (rows, modes)."""
    points = [point for connection in structure.system.connections for point in ends(connection)]
    lines = structure.lines
    contacts = [row for one in lines for row in (one.normal, one.tangent, one.across, one.normal_slope)]
    coordinates = Coordinates(structure.system)
    return np.vstack([contacts, *map(coordinates.trace, points)])


def displacement_rows(structure: Structure, point: BodyPoint) -> Array:
    """Return the rows of the world displacement at a point, shape (3, modes)."""
    return Coordinates(structure.system).trace(point)


def turned_onto(structure: Structure, other: Structure) -> Array | None:
    """Return the matrix from the coordinates of a system to those of a slightly different one, shape (modes, modes).

    None if all points move alike in both.

    Modes have an arbitrary sign, modes of equal frequency and residual shapes any orientation among each other: those
    of the other system are combined so that points move as nearly as possible as in the first (orthogonal Procrustes
    problem, Schönemann 1966).
    """
    here, there = rows_of(structure), rows_of(other)
    if np.array_equal(here, there):
        return None
    turn = np.eye(structure.mode_count)
    for group in _alike(structure):
        moved = there[:, group].T @ here[:, group]
        left, _, right = scipy.linalg.svd(moved + UNTURNED * np.linalg.norm(moved) * np.eye(group.size))
        turn[np.ix_(group, group)] = left @ right
    return turn


def _alike(structure: Structure) -> Iterator[Array]:
    """Yield groups of modes that may be any combinations of each other: of one body and frequency, or residual."""
    system, massless = structure.system, structure.mass == 0.0
    joined = len(structure.arrays.blend)
    yield np.flatnonzero(massless[:joined])
    # A joint turns the modes of its bodies into each other in an arbitrary way.
    mixed = {point.body for one in filter(held_motions, system.connections) for point in ends(one)}
    if mixed:
        numbers = [np.arange(*structure.arrays.spans[system.body_name(body)]) for body in mixed]
        yield np.array([k for k in np.sort(np.concatenate(numbers)) if not massless[k]])
    for body in (one for one in system.bodies if one not in mixed):
        first, end = structure.arrays.spans[system.body_name(body)]
        modes = body.modes(system.is_held(body))
        if first >= joined:
            yield first + np.flatnonzero(massless[first:end])
        moving = np.flatnonzero(~modes.massless)
        angular = modes.angular_frequency[moving]
        order = np.argsort(angular, kind="stable")
        gaps = np.diff(angular[order]) > EQUAL * angular[order][1:]
        yield from (first + moving[part] for part in np.split(order, np.flatnonzero(gaps) + 1))
