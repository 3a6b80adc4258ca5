"""Balance of forces of a system whose contacts have given statuses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from ..arrays import Array
from ..checks import ArgumentError
from ..contact import FrictionLaw
from ..contact.stiffness import indentation_under, tangent_of
from .response import Factors, Response
from .structure import SEPARATED, SLIDING, STICKING, UNMOVED, Structure

# Relative size below which a force or an acceleration is round-off.
ROUND_OFF = 1e-9
# Largest number of iterations for the indentation of compliant contacts, and relative change of forces that counts as
# round-off.
YIELDING, SETTLED = 60, 1e-13
# Flexibility of rigid contacts that hold the same motion twice, relative to that of the bodies. It vanishes in the
# iteration; of the possible forces it selects the smallest.
SOFT = 1e-8
# Number of equations that are kept, each with matrices of all closed contacts.
KEPT = 8


@dataclass(frozen=True)
class Balance:
    """Balance of forces.

    Attributes
    ----------
    status : sequence of str
        Status of each contact.
    sense, ratio : ndarray, shape (contacts,)
        Sense of sliding, 0 where nothing moves a contact, and unsigned ratio of the forces of sliding contacts [1].
    normal_force, tangential_force, lateral_force : ndarray, shape (contacts,)
        Contact forces [N]: compressive, on the track along the slip, and across the tangent of sticking contacts.
    slip_velocity, slip_acceleration : ndarray, shape (contacts,)
        Slip velocities [m/s], 0 where unknown, and accelerations of the slip by free rigid motions [m/s²].
    opening, opening_acceleration : ndarray, shape (contacts,)
        Distance of the bodies at each contact [m], below zero where they overlap, and its acceleration by free rigid
        motions [m/s²].
    terms : ndarray, shape (contacts,)
        Sizes of the modal displacements by loads and contact forces of which the distance is the sum [m].
    place : ndarray, shape (2, contacts)
        Displacements along and across the tangents [m].
    determinant : float
        Sign of the determinant of the equations, 0 if they are singular.
    displacement : ndarray, shape (modes,)
        Modal displacements without free rigid motions; empty unless asked for.
    """

    status: Sequence[str]
    sense: Array
    ratio: Array
    normal_force: Array
    tangential_force: Array
    lateral_force: Array
    slip_velocity: Array
    slip_acceleration: Array
    opening: Array
    opening_acceleration: Array
    terms: Array
    place: Array
    determinant: float
    displacement: Array


@dataclass(frozen=True)
class About:
    """Forces about which rigid contacts are soft that hold the same motion twice.

    Attributes
    ----------
    forces : ndarray, shape (3, contacts)
        Forces along normals, along tangents and across them [N].
    stays : bool
        Whether contacts stay soft about these forces; if not, the forces approach those of rigid contacts.
    """

    forces: Array
    stays: bool = False


def balance_of(
    structure: Structure,
    status: Sequence[str],
    sense: Array,
    ratio: Array,
    anchors: Array,
    slip: Array,
    exact: bool = False,
    about: About | None = None,
) -> Balance:
    """Solve for displacement, accelerations of free rigid motions and contact forces simultaneously.

    Parameters
    ----------
    structure : Structure
        The system.
    status : sequence of str
        Status of each contact.
    sense, ratio : ndarray, shape (contacts,)
        Sense of sliding, and ratio of the forces of sliding contacts [1].
    anchors : ndarray, shape (2, contacts)
        Displacements along and across their tangents at which sticking contacts are held [m].
    slip : ndarray, shape (contacts,)
        Slip velocities [m/s], only passed on.
    exact : bool, optional
        Whether to compute the modal displacement, and to remove the rounding of soft supports.
    about : About, optional
        Forces about which rigid contacts that hold the same motion twice are soft; about none if left out.
    """
    count, share = len(status), sense * ratio
    load = structure.load - _braked(structure, structure.following(status))
    equations, right = _tangent_equations(structure, status, share, load, anchors, about or About(np.zeros((3, count))))
    displacement, loaded = np.zeros(0), equations.response.to(load)
    if exact:
        displacement, rigid, forces = equations.exact(load, *right)
        places = equations.response.rows @ displacement
    else:
        forces, rigid, places = equations.reduced(loaded, *right)
    closed, stuck = equations.closed, equations.stuck
    normal, tangential, lateral = np.zeros((3, count))
    normal[closed] = forces[: len(closed)]
    tangential[closed] = (share * normal)[closed]
    tangential[stuck] = forces[len(closed) : len(closed) + len(stuck)]
    lateral[equations.lateral] = forces[len(closed) + len(stuck) :]
    gains = equations.response.felt @ rigid
    terms = equations.response.terms(loaded[0], np.concatenate([normal, tangential, lateral]))
    if exact:
        terms = terms + np.abs(equations.response.rows[:count]) @ np.abs(displacement)
    return Balance(
        status,
        sense,
        ratio,
        normal,
        tangential,
        lateral,
        slip,
        gains[count : 2 * count],
        structure.gaps + places[:count],
        gains[:count],
        terms,
        places[count:].reshape(2, count),
        equations.determinant,
        displacement,
    )


def _braked(structure: Structure, velocity: Array) -> Array:
    """Return the modal forces that brake a steady motion with modal velocities.

    Raises
    ------
    ValueError
        If a dashpot by a table takes part in it.
    """
    springs = structure.arrays.springs
    dashpots = [number for number, bend in enumerate(springs.bends) if bend.of_rate]
    # Systems without residual shapes have other rows, and no tables.
    rows = springs.rows[dashpots] if dashpots else np.zeros((0, len(velocity)))
    # What follows nothing has velocities of rounding alone.
    rounding = UNMOVED * np.linalg.norm(rows, axis=1) * np.linalg.norm(velocity)
    if (np.abs(rows @ velocity) > rounding).any():
        words = "be linear where they brake a steady motion of bodies"
        raise ArgumentError("connections", words, got="a tabulated dashpot of a body that a contact carries along")
    return np.asarray(structure.damping @ velocity)


def at_statuses(
    structure: Structure, velocity: Array, status: Sequence[str], exact: bool = False, about: About | None = None
) -> tuple[Balance, Balance]:
    """Return the balance of forces without and with friction of sliding contacts.

    Where the slip is neither prescribed nor given, its sense is that of the motion without friction. Sticking contacts
    are held where they would rest without friction.

    Parameters
    ----------
    structure : Structure
        The system.
    velocity : ndarray, shape (contacts,)
        Slip velocity [m/s] of each contact where it is not prescribed; 0 where none is given.
    status : sequence of str
        Status of each contact.
    exact : bool, optional
        As for `balance_of`, for the balance with friction.
    about : About, optional
        As for `balance_of`.
    """
    nothing = np.zeros(len(status))
    anchors = np.zeros((2, len(status)))
    if STICKING in status:
        loose = [SLIDING if one == STICKING else one for one in status]
        anchors = balance_of(structure, loose, nothing, nothing, anchors, nothing, exact, about).place
        # Joints hold nothing where the system starts.
        anchors[:, [contact.tangential_stiffness is not None for contact in structure.system.contacts]] = 0.0
    slip = _slip_velocities(structure, velocity, status)
    plain = balance_of(structure, status, np.sign(slip), nothing, anchors, slip, about=about)
    least = ROUND_OFF * largest_acceleration(structure)
    moved = np.where(np.abs(plain.slip_acceleration) > least, plain.slip_acceleration, 0.0)
    slides = np.array([one == SLIDING for one in status])
    sense = slides * np.where(slip != 0.0, np.sign(slip), np.sign(moved))
    ratio = nothing.copy()
    contacts, found = structure.system.contacts, plain
    sliding = np.flatnonzero(slides).tolist()
    over_pressure = any(contacts[number].law.depends_on_pressure for number in sliding)
    for _ in range(YIELDING if over_pressure else 1):
        for number in sliding:
            speed = abs(float(slip[number])) or abs(float(velocity[number]))
            law = contacts[number].law.under(float(found.normal_force[number]))
            ratio[number] = _ratio_at(speed, law, structure.system.contact_names[number])
        before, found = found.normal_force, balance_of(structure, status, sense, ratio, anchors, slip, exact, about)
        if np.abs(found.normal_force - before).max(initial=0.0) <= SETTLED * np.abs(before).max(initial=0.0):
            break
    return plain, found


def _slip_velocities(structure: Structure, velocity: Array, status: Sequence[str]) -> Array:
    """Return the slip velocities [m/s]: prescribed ones, else given ones of contacts that are not held otherwise."""
    slip = np.where([one == SLIDING for one in status], structure.prescribed(status), 0.0)
    for k, given in enumerate(velocity):
        if given and not slip[k] and status[k] == SLIDING and not is_held(structure, status, k):
            slip[k] = given
    return slip


def _ratio_at(speed: float, law: FrictionLaw, contact: str) -> float:
    """Return the ratio of a law in sliding at a speed [m/s], which must be known if the law depends on it."""
    if law.depends_on_speed and not speed:
        raise ArgumentError(
            "velocity",
            f"be given for {contact}: its {law.law} friction depends on the slip speed, which nothing prescribes",
        )
    return float(law.coefficient_at(speed or 1.0))


def largest_acceleration(structure: Structure) -> float:
    """Return an upper bound of the acceleration of a contact by the loads [m/s²]."""

    def find() -> float:
        lines = structure.lines
        rows = np.array([line.tangent for line in lines] + [line.normal for line in lines])
        sizes = np.linalg.norm(rows * structure.mass, axis=1)
        return float(sizes.max() * np.linalg.norm(structure.load * structure.mass))

    return structure.once("acceleration", find)


def largest_force(structure: Structure) -> float:
    """Return an upper bound of the force of the loads on a contact [N]."""

    def find() -> float:
        rows = np.array([line.normal for line in structure.lines])
        return float(np.linalg.norm(structure.load) / np.linalg.norm(rows, axis=1).min())

    return structure.once("force", find)


def _tangent_equations(
    structure: Structure, status: Sequence[str], share: Array, load: Array, anchors: Array, about: About
) -> tuple[Equations, tuple[Array, Array]]:
    """Return the equations under a load, and the values of their constraints; iterated for compliant contacts."""
    rigid, soft = np.array([structure.is_rigid(k) for k in range(len(status))]), softness(structure, status)
    response = structure.once("response", lambda: Response(structure))
    moved, forces = response.to(load), about.forces.copy()
    normal = np.where(rigid, forces[0], largest_force(structure) or 1.0)
    iterates = not rigid.all() or (soft > 0.0 and not about.stays)
    before = np.zeros(0)
    for _ in range(YIELDING if iterates else 1):
        give, beyond = yielding_at(structure, normal)
        give[rigid], beyond[rigid] = soft, -soft * forces[0][rigid]
        equations = _equations(structure, status, share, give, soft)
        closed, stuck, lateral = equations.closed, equations.stuck, equations.lateral
        kept = anchors - soft * forces[1:]
        stays = np.concatenate([kept[0, stuck], kept[1, lateral]])
        right = -structure.gaps[closed] - beyond[closed], stays
        found = equations.reduced(moved, *right)[0]
        normal[closed] = found[: len(closed)]
        if not about.stays:
            forces[0][closed], forces[1][stuck] = np.split(found, [len(closed), len(closed) + len(stuck)])[:2]
            forces[2][lateral] = found[len(closed) + len(stuck) :]
        change = np.abs(found - before).max(initial=0.0) if before.size else np.inf
        before = found
        if change <= SETTLED * np.abs(found).max(initial=0.0) or not np.isfinite(found).all():
            break
    return equations, right


def _equations(structure: Structure, status: Sequence[str], share: Array, give: Array, soft: float) -> Equations:
    """Return the equations of some statuses; the last ones are kept, since passes over soft contacts repeat them."""
    kept: dict[Any, Equations] = structure.once("equations", dict)
    key = tuple(status), share.tobytes(), give.tobytes(), soft
    if key not in kept:
        if len(kept) >= KEPT:
            kept.pop(next(iter(kept)))
        kept[key] = Equations(structure, status, share, give, soft)
    return kept[key]


class Equations:
    """Balance of forces and constraints of contacts as equations for displacement, accelerations and forces.

    Parameters
    ----------
    structure : Structure
        The system.
    status : sequence of str
        Status of each contact.
    share : ndarray, shape (contacts,)
        Signed tangential over normal force of sliding contacts [1].
    give : ndarray, shape (contacts,), optional
        Flexibility of each contact along its normal [m/N].
    soft : float, optional
        Flexibility of sticking contacts along and across their tangents [m/N].
    """

    def __init__(
        self, structure: Structure, status: Sequence[str], share: Array, give: Array | None = None, soft: float = 0.0
    ) -> None:
        self.structure, count = structure, len(status)
        self.response: Response = structure.once("response", lambda: Response(structure))
        self.closed = [k for k, one in enumerate(status) if one != SEPARATED]
        self.stuck = [k for k in self.closed if status[k] == STICKING]
        self.lateral = held_across(structure, self.stuck)
        tangents = [*(count + k for k in self.stuck), *(2 * count + k for k in self.lateral)]
        self.held, sliding = [*self.closed, *tangents], [status[k] == SLIDING for k in self.closed]
        self._share = np.where(sliding, share[self.closed], 0.0)
        self._tangents = [count + k for k in self.closed]
        # The force of a sticking contact is that on the track, against the displacement.
        self.give = np.full(len(self.held), -soft)
        self.give[: len(self.closed)] = 0.0 if give is None else give[self.closed]
        self.give[len(self.closed) :] -= [structure.joint_give(k) for k in (*self.stuck, *self.lateral)]
        self.free, self._kept = self._split()
        self._moved = self._pushed(self.response.compliance)
        self._pulled = self._pushed(self.response.pull)
        corner = -self._kept.T @ self.response.opposed @ self._kept
        upper = [self._moved[self.held] + np.diag(self.give), self.response.moved[self.held] @ self._kept]
        matrix = np.vstack([np.hstack(upper), np.hstack([self._kept.T @ self._pulled, corner])])
        rows = np.abs(matrix).max(axis=1, initial=0.0)
        self._rows = np.where(rows > 0.0, rows, 1.0)[:, None]
        columns = np.abs(matrix / self._rows).max(axis=0, initial=0.0)
        self._columns = np.where(columns > 0.0, columns, 1.0)
        self._factors = Factors(matrix / self._rows / self._columns)
        self.determinant = self._factors.sign

    def _pushed(self, along: Array) -> Array:
        """Return the columns of the response to unit forces of the constraints, from those along rows."""
        slides = along[:, self.closed] - along[:, self._tangents] * self._share
        return np.hstack([slides, -along[:, self.held[len(self.closed) :]]])

    def _split(self) -> tuple[Array, Array]:
        """Return the rigid motions that contacts leave free and that they hold, orthonormal, (rigid, motions)."""
        count = self.structure.rigid.shape[1]
        if not count or not self.held:
            return np.eye(count), np.zeros((count, 0))
        sizes = np.linalg.norm(self.response.rows[self.held], axis=1, keepdims=True)
        felt = self.response.felt[self.held] / np.where(sizes > 0.0, sizes, 1.0)
        felt[np.abs(felt) < UNMOVED] = 0.0
        free = scipy.linalg.null_space(felt, rcond=UNMOVED)
        return free, scipy.linalg.null_space(free.T) if free.shape[1] else np.eye(count)

    def is_monotone(self) -> bool:
        """Return whether changes of contact forces that leave held rigid motions in balance do positive work."""
        null = scipy.linalg.null_space(self._kept.T @ self._pulled) if self._kept.size else np.eye(len(self.held))
        if self._kept.size and np.abs(null.T @ self.response.moved[self.held] @ self._kept).max(initial=0.0) > 0.0:
            # Friction also turns held rigid motions, so that the spaces of forces and of motions differ.
            same = scipy.linalg.null_space((self.response.moved[self.held] @ self._kept).T)
            if null.shape != same.shape or np.linalg.norm(null - same @ (same.T @ null)) > UNMOVED:
                return False
        work = null.T @ (self._moved[self.held] + np.diag(self.give)) @ null
        return bool(np.linalg.eigvalsh(0.5 * (work + work.T)).min(initial=1.0) > 0.0)

    def _forces(self, displacements: Array, accelerations: Array, values: Array) -> tuple[Array, Array]:
        """Return forces and places of held rigid motions, for displacements along rows and accelerations by loads."""
        right = np.concatenate([values - displacements[self.held], -self._kept.T @ accelerations])
        found = self._factors.solved(right / self._rows[:, 0]) / self._columns
        return found[: len(self.held)], self._kept @ found[len(self.held) :]

    def reduced(self, loaded: tuple[Array, Array], closed: Array, stuck: Array) -> tuple[Array, Array, Array]:
        """Return forces, accelerations of rigid motions, and displacements along the rows of all contacts.

        Parameters
        ----------
        loaded : tuple of ndarray
            Response to the load.
        closed, stuck : ndarray
            Values of the constraints.
        """
        moved = self.response.rows @ loaded[0]
        forces, places = self._forces(moved, loaded[1], np.concatenate([closed, stuck]))
        gains = loaded[1] + self._pulled @ forces - self.response.opposed @ places
        return forces, self.free @ (self.free.T @ gains), moved + self._moved @ forces + self.response.moved @ places

    def exact(self, load: Array, closed: Array, stuck: Array) -> tuple[Array, Array, Array]:
        """Return displacement, accelerations of rigid motions and forces, without the rounding of soft supports.

        Parameters
        ----------
        load : ndarray, shape (modes,)
            Modal forces.
        closed, stuck : ndarray
            Values of the constraints.
        """
        response, stiffness = self.response, self.structure.stiffness
        free = self.structure.rigid @ self.free
        held, pushes = response.rows[self.held], self._pushed(response.rows.T)
        values = np.concatenate([closed, stuck])
        displacement, rigid, forces = np.zeros(len(load)), np.zeros(len(self.free)), np.zeros(len(values))
        # The second pass solves for the rounding of the first.
        for _ in range(2):
            left = load + pushes @ forces - stiffness @ displacement - self.structure.rigid @ rigid
            missed = values - held @ displacement - self.give * forces
            moved, gains = response.to(left)
            pushed, places = self._forces(response.rows @ moved, gains, missed)
            moved, gains = response.to(left + pushes @ pushed - stiffness @ (self.structure.rigid @ places))
            displacement = displacement + moved + self.structure.rigid @ places
            displacement = displacement - free @ (free.T @ displacement)
            rigid = rigid + self.free @ (self.free.T @ gains)
            forces = forces + pushed
        return displacement, rigid, forces


def yielding_at(structure: Structure, normal: Array) -> tuple[Array, Array]:
    """Return slope and intercept of the indentation of contacts over the force, about normal forces, (contacts,)."""
    give, beyond = np.zeros((2, len(normal)))
    for k, contact in enumerate(structure.system.contacts):
        if contact.yields is not None:
            least = ROUND_OFF * (largest_force(structure) or 1.0)
            indented = indentation_under(contact.yields, max(float(normal[k]), least))
            give[k], beyond[k] = tangent_of(contact.yields, indented)
    return give, beyond


def held_rows(structure: Structure, status: Sequence[str], share: Array) -> tuple[Array, Array, list[int], list[int]]:
    """Return the constraints of closed contacts and the action of their forces.

    Parameters
    ----------
    structure : Structure
        The system.
    status : sequence of str
        Status of each contact.
    share : ndarray, shape (contacts,)
        Signed tangential over normal force of sliding contacts [1].

    Returns
    -------
    held, pushes : ndarray, shape (held, modes)
        Constraints of closed contacts along their normals, then of sticking ones along their tangents, then across them
        in space; modal forces of unit forces of each constraint.
    closed, stuck : list of int
        Numbers of the contacts of both kinds of rows.
    """
    closed = [k for k, one in enumerate(status) if one != SEPARATED]
    stuck = [k for k in closed if status[k] == STICKING]
    lines, size = structure.lines, (-1, structure.mode_count)
    lateral = [lines[k].across for k in held_across(structure, stuck)]
    tangents = [*(lines[k].tangent for k in stuck), *lateral]
    held = np.array([*(lines[k].normal for k in closed), *tangents]).reshape(size)
    slides = [share[k] if status[k] == SLIDING else 0.0 for k in closed]
    normals = [lines[k].normal - part * lines[k].tangent for k, part in zip(closed, slides, strict=True)]
    return held, np.array([*normals, *(-row for row in tangents)]).reshape(size), closed, stuck


def rigid_rows(structure: Structure, closed: Sequence[int], stuck: Sequence[int]) -> list[int]:
    """Return the rows of `held_rows` that are rigid: not normals of compliant contacts, nor tangents with a joint."""
    along = [*stuck, *held_across(structure, stuck)]
    rigid = [structure.is_rigid(k) for k in closed] + [structure.joint_give(k) == 0.0 for k in along]
    return [row for row, one in enumerate(rigid) if one]


def held_across(structure: Structure, stuck: Sequence[int]) -> list[int]:
    """Return the sticking contacts that are also held across their tangent: those in space that can move so."""
    return [k for k in stuck if np.abs(structure.lines[k].across).any()]


def is_held(structure: Structure, status: Sequence[str], contact: int) -> bool:
    """Return whether the constraints of other contacts also keep a contact from slipping."""
    return not moved_by(structure.lines[contact].tangent, motions_held(structure, status)).any()


def motions_held(structure: Structure, status: Sequence[str]) -> Array:
    """Return an orthonormal basis of the rows that rigid contacts and sticking ones hold, (held, modes)."""

    def find() -> Array:
        held, _, closed, stuck = held_rows(structure, status, np.zeros(len(status)))
        held = held[rigid_rows(structure, closed, stuck)]
        return np.linalg.svd(_normalised(held), full_matrices=False)[2][: rank(held)]

    return structure.once(("held", *status), find)


def moved_by(row: Array, held: Array) -> Array:
    """Return the part of a row, of norm 1, that held motions leave free; exactly zero if they leave none."""
    size = float(np.linalg.norm(row))
    if not size:
        return np.zeros_like(row)
    part = row / size
    for _ in range(2):
        part = part - held.T @ (held @ part)
    left = float(np.linalg.norm(part))
    return part / left if left > UNMOVED else np.zeros_like(row)


def _normalised(rows: Array) -> Array:
    sizes = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.asarray(rows / np.where(sizes > 0.0, sizes, 1.0))


def rank(rows: Array) -> int:
    """Return the number of linearly independent rows; each row counts as much as the others."""
    if not len(rows):
        return 0
    if len(rows) == 1:
        return int(rows.any())
    return int(np.sum(np.linalg.svd(_normalised(rows), compute_uv=False) >= UNMOVED))


def softness(structure: Structure, status: Sequence[str]) -> float:
    """Return the flexibility for rigid contacts, 0 unless some hold the same motion twice if all are closed [m/N]."""
    stuck = tuple(k for k, one in enumerate(status) if one == STICKING)
    return structure.once(("softness", *stuck), lambda: _softness(structure, stuck))


def _softness(structure: Structure, stuck: Sequence[int]) -> float:
    status = [STICKING if k in stuck else SLIDING for k in range(len(structure.lines))]
    held, _, closed, sticking = held_rows(structure, status, np.zeros(len(status)))
    held = held[rigid_rows(structure, closed, sticking)]
    if rank(held) == len(held):
        return 0.0
    response: Response = structure.once("response", lambda: Response(structure))
    stretch, moves = np.diag(response.compliance).max(initial=0.0), np.abs(response.felt).max(initial=0.0)
    return SOFT * float(stretch) if stretch > ROUND_OFF**2 * moves else float(moves)
