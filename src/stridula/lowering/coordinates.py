"""Ranges of the modes of each body among all modes, and the coupling of joined bodies."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint
from ..bodies.modes import Modes
from ..checks import ArgumentError
from ..connections import ends, held_motions
from ..connections.elements import Motion, elements_of
from ..ordinary import check_coupled_count
from ..system import System
from .joints import JointModes, joint_modes
from .relaxing import Relaxing

# Largest difference of a start from the motion that a rigid joint allows, relative to it.
APART = 1e-9
# Relative size of off-diagonal terms below which modes are not coupled.
UNCOUPLED = 1e-13


@dataclass(frozen=True)
class Coordinates:
    """Ranges of the modes of each body, and full-width rows of its points.

    Attributes
    ----------
    system : System
        The system.
    known : dict
        Modes of each body used so far, by its identity.
    """

    system: System
    # The key is the identity: comparing bodies would take longer than all other work here.
    known: dict[int, Modes] = field(default_factory=dict)

    @cached_property
    def joined(self) -> tuple[Any, ...]:
        """The bodies whose modes may be coupled: by connections, or by a damping matrix of their own."""
        named = [point.body for connection in self.system.connections for point in ends(connection)]
        bodies = self.system.bodies
        return tuple(body for body in bodies if body in named or self.modes(body).damping_matrix is not None)

    @cached_property
    def relaxing(self) -> Relaxing:
        """The inner motions of viscoelastic springs."""
        return Relaxing(self.system)

    @property
    def coupled(self) -> tuple[Any, ...]:
        """What may be coupled: joined bodies, and the inner motions of their springs."""
        return (*self.joined, *([self.relaxing] if self.relaxing.branches else []))

    @cached_property
    def order(self) -> tuple[Any, ...]:
        """The bodies and inner motions, those that may be coupled first."""
        return (*self.coupled, *(body for body in self.system.bodies if body not in self.joined))

    @cached_property
    def spans(self) -> dict[Any, tuple[int, int]]:
        """First mode of each body, and end of its range."""
        found, start = {}, 0
        for body in self.order:
            found[body] = (start, start + self.modes(body).count)
            start = found[body][1]
        return found

    @property
    def relaxing_span(self) -> tuple[int, int]:
        """First of the inner motions, and end of their range; empty without viscoelastic springs."""
        return self.spans.get(self.relaxing, (0, 0))

    @cached_property
    def size(self) -> int:
        """Number of modes."""
        return max(end for _, end in self.spans.values())

    @cached_property
    def contact_rows(self) -> int:
        """Number of rows of all contacts, one for each normal and tangent."""
        return sum(len(contact.frame) for contact in self.system.contacts)

    def modes(self, body: Any) -> Modes:
        """Return the modes of a body."""
        if id(body) not in self.known:
            try:
                self.known[id(body)] = body.modes(self.system.is_held(body))
            except ArgumentError as error:
                raise error.inside(self.system.body_name(body)) from None
        return self.known[id(body)]

    def full(self, body: Any, numbers: Array) -> Array:
        """Return values of a body's modes as values of all modes, zero for others."""
        first, end = self.spans[body]
        out = np.zeros((*numbers.shape[:-1], self.size))
        out[..., first:end] = numbers
        return out

    def body_trace(self, point: BodyPoint) -> Array:
        """Return the rows of the world displacement at a point on the coordinates of the bodies, shape (3, modes).

        A body in the plane is rigid along z.
        """
        body: Any = point.body
        return _in_space(self.full(body, body.trace(point.position, self.system.is_held(body))))

    def blended(self, body: Any, numbers: Array) -> Array:
        """Return rows on a body's own modes as rows on the coordinates of the march."""
        (first, end), size = self.spans[body], len(self.blend)
        if end > size:
            return self.full(body, numbers)
        out = np.zeros((*numbers.shape[:-1], self.size))
        out[..., :size] = numbers @ self.blend[first:end]
        return out

    def start(self, moved: Array) -> Array:
        """Return coordinates of the bodies at the start as those of the march, shape (modes,).

        Raises
        ------
        ValueError
            If a rigid joint does not allow them.
        """
        found = moved.copy()
        for numbers, modes in self.joints:
            moving = ~self.shapes_of_bodies[numbers]
            found[numbers] = (modes.blend[moving].T @ moved[numbers][moving]) * ~modes.massless
            back = modes.blend @ found[numbers] - moved[numbers]
            if np.linalg.norm(back[moving]) > APART * np.linalg.norm(moved[numbers]):
                words = "move bodies with a rigid joint together at the start, so that their joined points do not part"
                raise ArgumentError("drives", words, got="a motion of one against the other")
        return found

    def trace(self, point: BodyPoint) -> Array:
        """Return the rows of the world displacement at a point, shape (3, modes)."""
        body: Any = point.body
        return _in_space(self.blended(body, body.trace(point.position, self.system.is_held(body))))

    def translation(self, body: Any) -> Array:
        """Return the drive of the modes by a uniform acceleration of a body along x, y and z, shape (3, modes)."""
        return _in_space(self.blended(body, self.modes(body).translation))

    def body_translation(self, body: Any) -> Array:
        """Return the same on the coordinates of the bodies, shape (3, modes)."""
        return _in_space(self.full(body, self.modes(body).translation))

    def on_march(self, rows: Array) -> Array:
        """Return rows on the coordinates of the bodies as rows on those of the march, shape (..., modes)."""
        size = len(self.blend)
        return np.concatenate([rows[..., :size] @ self.blend, rows[..., size:]], axis=-1) if size else rows

    def motion(self, point: BodyPoint, motion: Motion) -> Array:
        """Return the row of a displacement or rotation at a point on the coordinates of the bodies, shape (modes,)."""
        if not motion.turns:
            return motion.way @ self.body_trace(point)
        body: Any = point.body
        rows = body.rotation(point.position, self.system.is_held(body))
        return motion.way @ self.full(body, rows)

    @cached_property
    def joints(self) -> tuple[tuple[Array, JointModes], ...]:
        """Numbers of the coordinates of bodies that rigid joints join, with their natural modes."""
        found = []
        for group in _grouped(self.system):
            bodies = [body for body in self.joined if body in group.bodies]
            numbers = np.concatenate([np.arange(*self.spans[body]) for body in bodies])
            rows = [self.between(one, motion) for one in group.joints for motion in held_motions(one)]
            squared = np.concatenate([self.modes(body).stiffness for body in bodies])
            massless = np.concatenate([self.modes(body).massless for body in bodies])
            found.append((numbers, joint_modes(np.array(rows)[:, numbers], squared, massless)))
        return tuple(found)

    def between(self, connection: Any, motion: Motion) -> Array:
        """Return the row of a motion of the first end of a connection relative to the other, shape (modes,)."""
        row = self.motion(connection.first, motion)
        return row if connection.second is None else row - self.motion(connection.second, motion)

    @cached_property
    def shapes_of_bodies(self) -> Array:
        """Mask of the residual shapes among the coordinates of the bodies."""
        return np.concatenate([self.modes(body).massless for body in self.order])

    @cached_property
    def massless(self) -> Array:
        """Mask of the coordinates without mass: residual shapes, and what rigid joints prevent."""
        found = self.shapes_of_bodies.copy()
        for numbers, modes in self.joints:
            found[numbers] = modes.massless
        return found

    @cached_property
    def rigid(self) -> Array:
        """Mask of the rigid motions of the bodies, and of those that rigid joints join."""
        return self._with_joints([self.modes(body).angular_frequency == 0.0 for body in self.order])

    @property
    def lumped(self) -> Array:
        """Mask of the motions of lumped bodies, and of the rigid motions of others."""
        return self._with_joints(
            [(self.modes(body).angular_frequency == 0.0) | getattr(body, "is_lumped", False) for body in self.order]
        )

    def _with_joints(self, of_bodies: list[Array]) -> Array:
        """Return a mask of motions of the bodies, with those of joined bodies where it has not all of theirs."""
        found = np.concatenate(of_bodies)
        for numbers, modes in self.joints:
            found[numbers] = found[numbers].all() | (modes.stiffness == 0.0)
        return found & ~self.massless

    @cached_property
    def of_bodies(self) -> tuple[Array, Array]:
        """Stiffness and damping matrix of joined bodies and their connections, before rigid joints."""
        own, stiffness, dissipation = _matrices(self)
        return stiffness + np.diag(own), dissipation

    @property
    def matrices(self) -> tuple[Array, Array]:
        """Stiffness and damping matrix of the modes of joined bodies, which come first."""
        return self._coupling[0], self._coupling[1]

    @property
    def blend(self) -> Array:
        """Matrix from the coordinates of the march to those of joined bodies."""
        return self._coupling[2]

    @cached_property
    def _coupling(self) -> tuple[Array, Array, Array]:
        own, stiffness, dissipation = _matrices(self)
        massless, size = self.massless[: len(own)], len(own)
        if not self.joints:
            return without_massless_coupling(stiffness + np.diag(own), dissipation, massless)
        blend = np.eye(size)
        for numbers, modes in self.joints:
            blend[np.ix_(numbers, numbers)] = modes.blend
            own[numbers] = modes.stiffness
        stiffness, dissipation = blend.T @ stiffness @ blend + np.diag(own), blend.T @ dissipation @ blend
        nowhere = massless & (own == 0.0)
        stiffness[nowhere, nowhere] = 1.0
        stiffness, dissipation, further = without_massless_coupling(stiffness, dissipation, massless)
        return stiffness, dissipation, blend @ further


def _matrices(coordinates: Coordinates) -> tuple[Array, Array, Array]:
    """Return the stiffness of each mode of joined bodies, that of connections as a matrix, and the damping matrix."""
    size = sum(coordinates.modes(body).count for body in coordinates.coupled)
    check_coupled_count(size)
    own, stiffness, dissipation = np.zeros(size), np.zeros((size, size)), np.zeros((size, size))
    for body in coordinates.coupled:
        modes, span = coordinates.modes(body), slice(*coordinates.spans[body])
        own[span] = modes.stiffness
        damped = np.diag(modes.damping_rate)
        dissipation[span, span] = damped if modes.damping_matrix is None else modes.damping_matrix
    inner = iter(range(*coordinates.relaxing_span))
    for connection in coordinates.system.connections:
        for element in elements_of(connection):
            row = coordinates.between(connection, element.motion)[:size]
            for matrix, rate in ((stiffness, element.stiffness), (dissipation, element.damping)):
                if rate:
                    matrix += rate * np.outer(row, row)
            for branch in element.branches:
                # Its spring acts between the ends and the inner motion, of unit mass.
                number, across = next(inner), -np.sqrt(branch.stiffness) * branch.angular_frequency * row
                stiffness[number] += across
                stiffness[:, number] += across
    return own, stiffness, dissipation


def without_massless_coupling(stiffness: Array, dissipation: Array, massless: Array) -> tuple[Array, Array, Array]:
    """Return stiffness and damping matrix in coordinates with uncoupled residual shapes, and the transformation.

    Connections also act on residual shapes: their static response to the modes becomes part of these, the rest has
    unit stiffness. Damping acts on the modes including that response.
    """
    if not massless.any():
        return stiffness, dissipation, np.eye(0)
    blend = np.eye(len(stiffness))
    moving = ~massless
    own, across = stiffness[np.ix_(massless, massless)], stiffness[np.ix_(massless, moving)]
    root = np.linalg.cholesky(own)
    blend[np.ix_(massless, moving)] = -np.linalg.solve(own, across)
    blend[np.ix_(massless, massless)] = np.linalg.inv(root).T
    stiffness, dissipation = blend.T @ stiffness @ blend, blend.T @ dissipation @ blend
    stiffness[massless] = dissipation[massless] = 0.0
    stiffness[:, massless] = dissipation[:, massless] = 0.0
    stiffness[massless, massless] = 1.0
    return 0.5 * (stiffness + stiffness.T), 0.5 * (dissipation + dissipation.T), blend


def are_uncoupled(stiffness: Array, dissipation: Array) -> bool:
    """Return whether the modes are uncoupled oscillators after all."""
    return _is_diagonal(stiffness) and _is_diagonal(dissipation)


def _is_diagonal(matrix: Array) -> bool:
    diagonal = np.diag(matrix)
    scale = np.sqrt(np.outer(diagonal, diagonal))
    return bool(np.all(np.abs(matrix - np.diag(diagonal)) <= UNCOUPLED * scale))


def _in_space(rows: Array) -> Array:
    """Return rows of a body along x, y and z; a body in the plane is rigid along z."""
    return rows if len(rows) == 3 else np.concatenate([rows, np.zeros((1, rows.shape[1]))])


class _Group(NamedTuple):
    """Bodies that rigid joints join, and these joints."""

    bodies: list[Any]
    joints: list[Any]


def _grouped(system: System) -> list[_Group]:
    """Return the groups of bodies that rigid joints join, in the order of the joints."""
    groups: list[_Group] = []
    for one in filter(held_motions, system.connections):
        bodies = [point.body for point in ends(one)]
        reached = [group for group in groups if any(body in group.bodies for body in bodies)]
        apart = [group for group in groups if group not in reached]
        together = [*(body for group in reached for body in group.bodies), *bodies]
        joints = [*(joint for group in reached for joint in group.joints), one]
        groups = [*apart, _Group(list(dict.fromkeys(together)), joints)]
    return groups
