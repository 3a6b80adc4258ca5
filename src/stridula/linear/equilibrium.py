"""Equilibrium in steady sliding, or in the accelerating frame of a slider that a force drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

from ..arrays import Array
from ..checks import ArgumentError
from ..contact import FrictionLaw
from ..contact.stiffness import indentation_under, tangent_of
from .held_twice import held_twice
from .structure import SEPARATED, SLIDING, STICKING, UNMOVED, Structure

# Relative size below which a force or an acceleration is round-off.
ROUND_OFF = 1e-9
# Most iterations of the indentation of compliant contacts, and the relative change of forces that is round-off.
YIELDING, SETTLED = 60, 1e-13
# Largest number of contacts with which all minors are checked.
MOST_CONTACTS = 10
HELD, LIFTED_OFF, JAMMED = "held", "lifted off", "jammed"


@dataclass(frozen=True)
class Equilibrium:
    """Equilibrium of a system.

    Attributes
    ----------
    kind : str
        ``sliding``; ``held``: friction stops a contact; ``lifted off``: a contact, or a surface as a whole, is open;
        ``jammed``: a contact can neither slide nor open.
    status : tuple of str
        Status of each contact.
    sense : ndarray, shape (contacts,)
        Sense of sliding of each, +1 or -1; 0 where nothing moves it.
    ratio : ndarray, shape (contacts,)
        Tangential over normal force of each in sliding, unsigned [1].
    normal_force, tangential_force : ndarray, shape (contacts,)
        Contact forces [N], the tangential ones on the track along the slip.
    lateral_force : ndarray, shape (contacts,)
        Forces on sticking contacts in space across their tangent [N].
    slip_velocity : ndarray, shape (contacts,)
        Slip velocities [m/s], prescribed by drives and tracks or given; 0 where unknown.
    slip_acceleration : ndarray, shape (contacts,)
        Accelerations of the slip [m/s²] by free rigid motions.
    displacement : ndarray, shape (modes,)
        Modal displacements, without those motions.
    """

    kind: str
    status: tuple[str, ...]
    sense: Array
    ratio: Array
    normal_force: Array
    tangential_force: Array
    lateral_force: Array
    slip_velocity: Array
    slip_acceleration: Array
    displacement: Array


def find_equilibrium(structure: Structure, velocity: Array, status: Sequence[str] | None = None) -> Equilibrium:
    """Return the equilibrium of a system, for given statuses of its contacts if there are any.

    All contacts slide at first. Contacts with a tensile force are opened and contacts that stop are held, until all are
    consistent. Where the slip is neither prescribed nor given, its sense is that of the motion without friction. A held
    contact sticks where it would come to rest without friction: its previous history is unknown.

    Parameters
    ----------
    structure : Structure
        The system.
    velocity : ndarray, shape (contacts,)
        Slip velocity [m/s] of each contact where it is not prescribed; 0 where none is given.
    status : sequence of str, optional
        Statuses of the contacts, used unchanged.

    Raises
    ------
    ValueError
        If a law depends on a slip speed that is unknown, or if contacts constrain the same motion twice.
    """
    tried = [SLIDING] * len(structure.lines) if status is None else list(status)
    while True:
        found = _at(structure, velocity, tried)
        wrong = _wrong(structure, found)
        if wrong is None:
            kind = LIFTED_OFF if _lifted(structure, tried) else HELD if STICKING in tried else SLIDING
            return _equilibrium(kind, tried, found)
        contact, kind = wrong
        if status is not None or kind == JAMMED:
            return _equilibrium(kind, tried, found)
        tried[contact] = STICKING if kind == HELD else SEPARATED


def _lifted(structure: Structure, status: Sequence[str]) -> bool:
    """Return whether a single contact, or a surface as a whole, is open."""
    surfaces = [contact.surface for contact in structure.system.contacts]
    closed = {name for name, one in zip(surfaces, status, strict=True) if name and one != SEPARATED}
    return any(one == SEPARATED and name not in closed for name, one in zip(surfaces, status, strict=True))


@dataclass(frozen=True)
class _Balance:
    """Balance of forces: attributes as in `Equilibrium`, and the sign of the determinant of the equations."""

    status: Sequence[str]
    sense: Array
    ratio: Array
    normal_force: Array
    tangential_force: Array
    lateral_force: Array
    slip_velocity: Array
    slip_acceleration: Array
    displacement: Array
    determinant: float


def _equilibrium(kind: str, status: Sequence[str], found: tuple[_Balance, _Balance]) -> Equilibrium:
    _, it = found
    return Equilibrium(
        kind,
        tuple(status),
        it.sense,
        it.ratio,
        it.normal_force,
        it.tangential_force,
        it.lateral_force,
        it.slip_velocity,
        it.slip_acceleration,
        it.displacement,
    )


def _at(structure: Structure, velocity: Array, status: Sequence[str]) -> tuple[_Balance, _Balance]:
    """Return the balance of forces without and with friction of sliding contacts."""
    nothing = np.zeros(len(status))
    anchors = nothing
    if STICKING in status:
        loose = [SLIDING if one == STICKING else one for one in status]
        rest = _balance(structure, loose, nothing, nothing, nothing, nothing)
        anchors = np.array([line.tangent @ rest.displacement for line in structure.lines])
    slip = _slip_velocities(structure, velocity, status)
    plain = _balance(structure, status, np.sign(slip), nothing, anchors, slip)
    moved = np.where(np.abs(plain.slip_acceleration) > ROUND_OFF * _acceleration(structure), plain.slip_acceleration, 0)
    slides = np.array([one == SLIDING for one in status])
    sense = slides * np.where(slip != 0.0, np.sign(slip), np.sign(moved))
    ratio = nothing.copy()
    for number, contact in enumerate(structure.system.contacts):
        if status[number] == SLIDING:
            speed = abs(float(slip[number])) or abs(float(velocity[number]))
            ratio[number] = _ratio_at(speed, contact.friction, structure.system.contact_names[number])
    return plain, _balance(structure, status, sense, ratio, anchors, slip)


def _slip_velocities(structure: Structure, velocity: Array, status: Sequence[str]) -> Array:
    """Return the slip velocities [m/s]: prescribed ones, else given ones of contacts that are not held otherwise."""
    slip = np.where([one == SLIDING for one in status], structure.prescribed(status), 0.0)
    for k, given in enumerate(velocity):
        if given and not slip[k] and status[k] == SLIDING and not _is_held(structure, status, k):
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


def _acceleration(structure: Structure) -> float:
    """Return an upper bound of the acceleration of a contact by the loads [m/s²]."""
    return structure.once("acceleration", lambda: _largest_acceleration(structure))


def _largest_acceleration(structure: Structure) -> float:
    rows = np.array([line.tangent for line in structure.lines])
    return float(np.linalg.norm(rows * structure.mass, axis=1).max() * np.linalg.norm(structure.load * structure.mass))


def _force(structure: Structure) -> float:
    """Return an upper bound of the force of the loads on a contact [N]."""
    return structure.once("force", lambda: _largest_force(structure))


def _largest_force(structure: Structure) -> float:
    rows = np.array([line.normal for line in structure.lines])
    return float(np.linalg.norm(structure.load) / np.linalg.norm(rows, axis=1).min())


def _balance(
    structure: Structure, status: Sequence[str], sense: Array, ratio: Array, anchors: Array, slip: Array
) -> _Balance:
    """Solve for displacement, accelerations of free rigid motions and contact forces simultaneously.

    Sticking contacts are held at their anchors, which are displacements along their tangents.
    """
    load = structure.load - structure.damping @ structure.following(status)
    equations, (displacement, acceleration, forces) = _solved(structure, status, sense * ratio, load, anchors)
    closed, stuck = equations.closed, equations.stuck
    normal, tangential = np.zeros((2, len(status)))
    normal[closed] = forces[: len(closed)]
    tangential[closed] = (sense * ratio * normal)[closed]
    tangential[stuck] = forces[len(closed) : len(closed) + len(stuck)]
    lateral = np.zeros(len(status))
    lateral[equations.lateral] = forces[len(closed) + len(stuck) :]
    slips = np.array([line.tangent @ equations.free @ acceleration for line in structure.lines])
    return _Balance(status, sense, ratio, normal, tangential, lateral, slip, slips, displacement, equations.determinant)


def _solved(
    structure: Structure, status: Sequence[str], share: Array, load: Array, anchors: Array
) -> tuple[_Equations, list[Array]]:
    """Solve the equations under a load, iteratively for compliant contacts."""
    yields = not all(structure.is_rigid(k) for k in range(len(status)))
    normal = np.full(len(status), (_force(structure) if yields else 0.0) or 1.0)
    for _ in range(YIELDING if yields else 1):
        give, beyond = yielding_at(structure, normal)
        equations = _Equations(structure, status, share, give)
        closed, stuck = equations.closed, equations.stuck
        found = equations.solved(load, -structure.gaps[closed] - beyond[closed], anchors[stuck])
        before, normal[closed] = normal[closed], found[2][: len(closed)]
        if np.abs(normal[closed] - before).max(initial=0.0) <= SETTLED * np.abs(before).max(initial=0.0):
            break
        if not np.isfinite(normal).all():
            break
    return equations, found


class _Equations:
    """Balance of forces and constraints of contacts as equations for displacement, accelerations and forces."""

    def __init__(self, structure: Structure, status: Sequence[str], share: Array, give: Array | None = None) -> None:
        held, pushes, self.closed, self.stuck = held_rows(structure, status, share)
        self.lateral = held_across(structure, self.stuck)
        who = [*self.closed, *self.stuck, *self.lateral]
        rigid = rigid_rows(structure, self.closed, len(held))
        structure.once(("checked", *status), lambda: _check_held(structure, held[rigid], [who[row] for row in rigid]))
        self.free, modes = structure.free_motions(held), structure.mode_count
        _check_unbraked(structure, self.free)
        self.parts = modes, modes + self.free.shape[1]
        size = self.parts[1] + len(held)
        matrix = np.zeros((size, size))
        matrix[:modes] = np.hstack([structure.stiffness, self.free, -pushes.T])
        matrix[modes:, :modes] = np.vstack([self.free.T, held])
        rows = self.parts[1] + np.arange(len(self.closed))
        matrix[rows, rows] = 0.0 if give is None else give[self.closed]
        self.scale = np.sqrt(np.maximum(np.abs(np.diag(matrix)), 1.0))
        self._factors = _Factors(matrix / np.outer(self.scale, self.scale))
        self.determinant = self._factors.sign

    def solved(self, load: Array, closed: Array, stuck: Array) -> list[Array]:
        """Return displacement, accelerations of free motions and forces for a load and given values of constraints."""
        free, lateral = np.zeros(self.parts[1] - self.parts[0]), np.zeros(len(self.lateral))
        right = np.concatenate([load, free, closed, stuck, lateral])
        if self.determinant:
            found = self._factors.solved(right / self.scale) / self.scale
        else:
            found = np.full(right.size, np.nan)
        first, second = self.parts
        return [found[:first], found[first:second], found[second:]]


class _Factors:
    """The LU factors of a square matrix, and the sign of its determinant, 0 if it is singular."""

    def __init__(self, matrix: Array) -> None:
        self._factors: Array
        self._pivots: Array
        self._factors, self._pivots, _ = dgetrf(matrix) if matrix.size else (matrix, np.zeros(0, np.int32), 0)
        swaps = int(np.count_nonzero(self._pivots != np.arange(len(matrix))))
        self.sign = float(np.prod(np.sign(np.diag(self._factors))) * (-1.0) ** swaps)

    def solved(self, right: Array) -> Array:
        """Return the solution for a right-hand side, of a matrix that is not singular."""
        return np.asarray(dgetrs(self._factors, self._pivots, right)[0]) if right.size else right


def travelling(structure: Structure, at: Equilibrium, speed: Array) -> Array:
    """Return the modal velocities by which an equilibrium follows contact points that travel along bent tracks.

    Parameters
    ----------
    structure : Structure
        The system.
    at : Equilibrium
        Its equilibrium.
    speed : ndarray, shape (contacts,)
        Velocities of the contact points along their tracks [m/s].
    """
    give, _ = yielding_at(structure, at.normal_force)
    equations = _Equations(structure, at.status, at.sense * at.ratio, give)
    pull, opening = np.zeros(structure.mode_count), np.zeros(len(speed))
    for k, line in enumerate(structure.lines):
        pull -= speed[k] * (at.normal_force[k] * line.normal_slope - at.tangential_force[k] * line.tangent_slope)
        opening[k] = speed[k] * line.normal_slope @ at.displacement
    return equations.solved(pull, opening[equations.closed], np.zeros(len(equations.stuck)))[0]


def yielding_at(structure: Structure, normal: Array) -> tuple[Array, Array]:
    """Return slope and intercept of the indentation of contacts over the force, about normal forces, (contacts,)."""
    give, beyond = np.zeros((2, len(normal)))
    for k, contact in enumerate(structure.system.contacts):
        if contact.yields is not None:
            least = ROUND_OFF * (_force(structure) or 1.0)
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


def rigid_rows(structure: Structure, closed: Sequence[int], count: int) -> list[int]:
    """Return the rows of `held_rows`, `count` in all, that are rigid: all but the normals of compliant contacts."""
    return [row for row in range(count) if row >= len(closed) or structure.is_rigid(closed[row])]


def held_across(structure: Structure, stuck: Sequence[int]) -> list[int]:
    """Return the sticking contacts that are also held across their tangent: those in space that can move so."""
    return [k for k in stuck if np.abs(structure.lines[k].across).any()]


def _check_held(structure: Structure, held: Array, contacts: Sequence[int]) -> None:
    """Raise unless contacts constrain possible motions, each once."""
    sizes = np.linalg.norm(held, axis=1)
    for size, contact in zip(sizes, contacts, strict=True):
        if size == 0.0:
            name = structure.system.contact_names[contact]
            raise ArgumentError("contact", "be between points that move", got=f"{name}, whose points are both held")
    if len(held) and _rank_is_short(held):
        raise held_twice(structure.system, contacts)


def _check_unbraked(structure: Structure, free: Array) -> None:
    braked = structure.damping @ free
    if braked.size and np.abs(braked).max() > ROUND_OFF * max(float(np.abs(structure.damping).max()), 1e-300):
        raise ArgumentError(
            "connections",
            "not brake a rigid motion that is otherwise free, which has no steady state: impose a velocity instead",
        )


def _wrong(structure: Structure, found: tuple[_Balance, _Balance]) -> tuple[int, str] | None:
    """Return the first contact with an inconsistent status, and the kind of its error; None if all are consistent."""
    plain, it = found
    closed = [k for k, one in enumerate(it.status) if one != SEPARATED]
    scale = ROUND_OFF * max(float(np.abs(plain.normal_force).max()), _force(structure))
    for k in closed:
        if plain.normal_force[k] < -scale:
            return k, LIFTED_OFF
    sliding = [k for k in closed if it.status[k] == SLIDING]
    if sliding and (it.determinant != plain.determinant or not slides_on(structure, it.status, it.sense * it.ratio)):
        return sliding[0], JAMMED
    for k in closed:
        if it.normal_force[k] < -scale:
            return k, LIFTED_OFF
    least = ROUND_OFF * _acceleration(structure)
    for k in sliding:
        gains = it.slip_acceleration[k] * it.sense[k]
        stops = gains < -least if it.slip_velocity[k] else gains <= least
        if stops and it.ratio[k] > 0.0 and not _is_held(structure, it.status, k):
            return k, HELD
    return None


def _is_held(structure: Structure, status: Sequence[str], contact: int) -> bool:
    """Return whether the constraints of other contacts also keep a contact from slipping."""
    held, _, closed, _ = held_rows(structure, status, np.zeros(len(status)))
    rigid = rigid_rows(structure, closed, len(held))
    return _rank_is_short(np.vstack([held[rigid], structure.lines[contact].tangent]))


def _rank_is_short(rows: Array) -> bool:
    """Return whether rows are linearly dependent."""
    sizes = np.linalg.norm(rows, axis=1, keepdims=True)
    if not sizes.all() or len(rows) > rows.shape[1]:
        return True
    if len(rows) == 1:
        return False
    return bool(np.linalg.svd(rows / sizes, compute_uv=False)[-1] < UNMOVED)


def slides_on(structure: Structure, status: Sequence[str], share: Array) -> bool:
    """Return whether contact forces exist for every motion: no impulse on a sliding contact jams it (Painlevé).

    With the instantaneous compliance W of the contacts, ``W_NN - share W_NT`` must have positive principal minors. If
    residual shapes respond instantaneously, the response of modes is negligible.
    """
    held, pushes, closed, _ = held_rows(structure, status, share)
    # Compliant contacts respond to any impulse.
    rigid = rigid_rows(structure, closed, len(held))
    held, pushes, size = held[rigid], pushes[rigid], sum(structure.is_rigid(k) for k in closed)
    whole = held * structure.promptness @ pushes.T
    compliance = whole[:size, :size]
    if len(held) > size:
        compliance = compliance - whole[:size, size:] @ np.linalg.solve(whole[size:, size:], whole[size:, :size])
    # With many contacts only the smallest minors and the determinant are checked, as their number doubles with each.
    sizes = range(1, size + 1) if size <= MOST_CONTACTS else (1, size)
    chosen = [list(some) for count in sizes for some in combinations(range(size), count)]
    return all(np.linalg.det(compliance[np.ix_(some, some)]) > 0.0 for some in chosen)
