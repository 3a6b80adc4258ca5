"""Equilibrium in steady sliding, or in the accelerating frame of a slider that a force drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from .balance import (
    ROUND_OFF,
    About,
    Balance,
    Equations,
    at_statuses,
    held_across,
    held_rows,
    rank,
    rigid_rows,
    softness,
    yielding_at,
)
from .complementarity import all_sets, searched
from .conditions import beyond_friction, broken, fits, is_leaving, margins_of, slides_on, stopping
from .free_motions import carried_along, normals_of, not_held, words_of
from .held_twice import held_twice
from .structure import SEPARATED, SLIDING, STICKING, Structure

# Largest number of contacts with which all sets of closed contacts are tried.
MOST_CONTACTS = 8
# Two equilibria are the same if their forces differ by less than this, relative to their size.
SAME = 1e-6
# Largest number of iterations for the forces of contacts that hold the same motion twice, and relative change that ends
# them.
PASSES, SETTLED = 60, 1e-10
# Largest number of steps of Newton's method for the stretch of nonlinear springs, and relative change that ends them.
STRETCHES, STRETCHED = 200, 1e-12
HELD, LIFTED_OFF, JAMMED = "held", "lifted off", "jammed"
ONE, SEVERAL, NONE, AT_LEAST_ONE, NONE_FOUND = "one", "several", "none", "at least one", "none found"


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
        Contact forces [N], the tangential ones on the track along the slip; NaN if no forces balance.
    lateral_force : ndarray, shape (contacts,)
        Forces on sticking contacts in space across their tangent [N].
    slip_velocity : ndarray, shape (contacts,)
        Slip velocities [m/s], prescribed by drives and tracks or given; 0 where unknown.
    slip_acceleration : ndarray, shape (contacts,)
        Accelerations of the slip [m/s²] by free rigid motions.
    opening : ndarray, shape (contacts,)
        Distance of the bodies at each contact [m], below zero by the indentation of contacts with a stiffness.
    displacement : ndarray, shape (modes,)
        Modal displacements, without those motions.
    found : str
        Number of equilibria: ``one``, ``several``, or ``none`` if bodies leave or jam; ``at least one`` or ``none
        found`` if not all sets of closed contacts were tried and no criterion decides; empty for given statuses.
    violated : tuple of str
        Inequalities that the equilibrium violates, in words; empty unless its statuses are given or it is jammed.
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
    opening: Array
    displacement: Array
    found: str
    violated: tuple[str, ...]


def find_equilibrium(structure: Structure, velocity: Array, status: Sequence[str] | None = None) -> Equilibrium:
    """Return the equilibrium of a system, for given statuses of its contacts if there are any.

    Every closed contact pushes, every open one has a gap, every sliding one slides on. With few contacts all sets of
    closed contacts are tried, with many sets are searched. Of several equilibria, one in which no contact jams is
    returned, and of these the one nearest to that without friction. Where the slip is neither prescribed nor given, its
    sense is that of the motion without friction. A held contact sticks where it would come to rest without friction:
    its previous history is unknown. The structure takes the stiffness that nonlinear springs have in it.

    Parameters
    ----------
    structure : Structure
        The system.
    velocity : ndarray, shape (contacts,)
        Slip velocity [m/s] of each contact where it is not prescribed; 0 where none is given.
    status : sequence of str, optional
        Statuses of the contacts, used unchanged; inequalities that they violate are in the result.

    Raises
    ------
    ValueError
        If a law depends on a slip speed that is unknown, or if contacts constrain the same motion twice so that forces
        and friction remain undetermined.
    """
    found = _found(structure, velocity, status)
    if not structure.arrays.springs.bends:
        return found
    rows = structure.arrays.springs.rows
    for _ in range(STRETCHES):
        if not np.isfinite(found.displacement).all():
            return found
        structure.stretch_to(found.displacement)
        before, found = rows @ found.displacement, _found(structure, velocity, status)
        after = rows @ found.displacement
        if (np.abs(after - before) <= STRETCHED * np.abs(after).max()).all():
            return found
    words = "nonlinear springs between whose stiffnesses the search goes to and fro"
    raise ArgumentError("connections", "have an equilibrium", got=words)


def _found(structure: Structure, velocity: Array, status: Sequence[str] | None) -> Equilibrium:
    """Return the equilibrium with the present stiffness of nonlinear springs."""
    if status is not None:
        return _judged(structure, velocity, list(status), "")
    _check_moved(structure, range(len(structure.lines)))
    _check_carried(structure, velocity)
    search = _Search(structure, velocity)
    chosen, found = search.result()
    if chosen is None:
        return _without(structure, found)
    closed = [k for k, one in enumerate(chosen) if one != SEPARATED]
    _check_not_carried(structure, closed, [k for k in closed if chosen[k] == STICKING])
    return _judged(structure, velocity, chosen, found, search.about)


class _Search:
    """Search for the statuses of the contacts."""

    def __init__(self, structure: Structure, velocity: Array) -> None:
        self.structure, self.velocity, self.count = structure, velocity, len(structure.lines)
        self.about: About | None = None
        self._known: dict[bytes, tuple[list[str], Balance, Balance]] = {}

    def result(self) -> tuple[list[str] | None, str]:
        """Return the statuses of the equilibrium, None if there is none, and the number of equilibria in words."""
        if self.count > MOST_CONTACTS:
            return self._of_many()
        first = searched(self._margins, np.ones(self.count, dtype=bool))
        # A set that friction cannot hold gives no information on those that slide.
        if first is not None and self._persists(first) and self._is_unique():
            return self._at(first)[0], ONE
        sets = self._distinct(list(all_sets(self._margins_if_known, self.count)))
        if not sets:
            return None, NONE
        kept = [closed for closed in sets if self._persists(closed)]
        return self._at(min(kept or sets, key=self._order))[0], {0: NONE, 1: ONE}.get(len(kept), SEVERAL)

    def _of_many(self) -> tuple[list[str] | None, str]:
        """Return the same with many contacts, which are searched from all closed, or from those without friction."""
        whole = np.ones(self.count, dtype=bool)
        if softness(self.structure, [SLIDING] * self.count):
            _check_friction(self.structure)
            first = self._softly(whole)
        else:
            first = searched(self._margins, whole)
        if first is None:
            start = searched(lambda closed: margins_of(self.structure, self._at(closed)[1]), whole)
            first = None if start is None else searched(self._margins, start)
        if first is None:
            return None, NONE_FOUND
        persists = self._persists(first)
        if self._is_unique() and (persists or STICKING not in self._at(first)[0]):
            return self._at(first)[0], ONE if persists else NONE
        return self._at(first)[0], AT_LEAST_ONE if persists else NONE_FOUND

    def _softly(self, closed: Array) -> Array | None:
        """Return a set of rigid contacts that hold the same motion twice, at first soft, then ever less.

        Forces of soft contacts are unique. Those about which they are soft follow, until the contacts are rigid
        (proximal point method, Rockafellar 1976).
        """
        forces, found = np.zeros((3, self.count)), None
        for _ in range(PASSES):
            self.about, self._known = About(forces, stays=True), {}
            found = searched(self._margins, closed)
            if found is None:
                break
            closed, at = found, self._at(found)[2]
            before, forces = forces, np.array([at.normal_force, at.tangential_force, at.lateral_force])
            if np.abs(forces - before).max() <= SETTLED * np.abs(forces).max():
                break
        self.about, self._known = About(forces), {}
        return found

    def _persists(self, closed: Array) -> bool:
        """Return whether no contact leaves, and friction holds those that stick."""
        at = self._at(closed)[2]
        return not is_leaving(self.structure, at) and not beyond_friction(self.structure, at)

    def _at(self, closed: Array) -> tuple[list[str], Balance, Balance]:
        """Return statuses, with contacts that stop held one after the other, and balances without and with friction."""
        key = closed.tobytes()
        if key not in self._known:
            status = [SLIDING if one else SEPARATED for one in closed.tolist()]
            while True:
                plain, at = at_statuses(self.structure, self.velocity, status, about=self.about)
                stops = stopping(self.structure, at)
                if not stops:
                    break
                for k in stops:
                    status[k] = STICKING
            self._known[key] = status, plain, at
        return self._known[key]

    def _margins(self, closed: Array) -> Array:
        return margins_of(self.structure, self._at(closed)[2])

    def _margins_if_known(self, closed: Array) -> Array:
        """Do `_margins`; a set whose contacts follow the bodies, with no slip speed for their law, is none."""
        try:
            return self._margins(closed)
        except ArgumentError:
            return -np.ones(self.count)

    def _is_unique(self) -> bool:
        """Return whether the work of contact forces on the gaps is positive for every change of the forces.

        There is then a single equilibrium at most, since indentations increase with the forces.
        """
        whole = np.ones(self.count, dtype=bool)
        status, _, at = self._at(whole)
        if STICKING in status or not (at.slip_velocity[at.ratio > 0.0] != 0.0).all():
            return False
        give, _ = yielding_at(self.structure, at.normal_force)
        # Only a linear stiffness has the same flexibility under all forces; for others, zero is a lower bound.
        linear = [one.yields is not None and one.yields.numbers[1] == 1.0 for one in self.structure.system.contacts]
        equations = Equations(self.structure, status, at.sense * at.ratio, np.where(linear, give, 0.0))
        return equations.is_monotone()

    def _distinct(self, sets: list[Array]) -> list[Array]:
        """Return sets in different places, of those in equal ones that with more closed contacts."""
        kept: list[Array] = []
        for closed in sets:
            place = self._at(closed)[2].opening
            others = [self._at(one)[2].opening for one in kept]
            size = SAME * float(np.abs([place - self.structure.gaps, *others]).max())
            if not any(np.abs(place - other).max() <= size for other in others):
                kept.append(closed)
        return kept

    def _order(self, closed: Array) -> tuple[bool, bool, int]:
        status, plain, at = self._at(closed)
        jams = not slides_on(self.structure, status, at.sense * at.ratio)
        wrong = int(np.sum(margins_of(self.structure, plain) < 0.0))
        return jams, at.determinant != plain.determinant, wrong


def _judged(
    structure: Structure, velocity: Array, status: list[str], found: str, about: About | None = None
) -> Equilibrium:
    """Return the equilibrium with some statuses, with every inequality checked."""
    _check_moved(structure, [k for k, one in enumerate(status) if one != SEPARATED])
    plain, at = at_statuses(structure, velocity, status, exact=True, about=about)
    share = at.sense * at.ratio
    _check_determined(structure, status, share)
    violated = broken(structure, at)
    pulls = any(
        one != SEPARATED and margin < 0.0 for one, margin in zip(status, margins_of(structure, at), strict=True)
    )
    digs_in = pulls and at.determinant != plain.determinant
    if not fits(structure, at) or (SLIDING in status and (digs_in or not slides_on(structure, status, share))):
        kind = JAMMED
    elif pulls or is_leaving(structure, at) or _lifted(structure, status):
        kind = LIFTED_OFF
    elif STICKING in status or stopping(structure, at):
        kind = HELD
    else:
        kind = SLIDING
    return _equilibrium(kind, at, found, violated)


def _equilibrium(kind: str, at: Balance, found: str, violated: Sequence[str]) -> Equilibrium:
    return Equilibrium(
        kind,
        tuple(at.status),
        at.sense,
        at.ratio,
        at.normal_force,
        at.tangential_force,
        at.lateral_force,
        at.slip_velocity,
        at.slip_acceleration,
        at.opening,
        at.displacement,
        found,
        tuple(violated),
    )


def _without(structure: Structure, found: str) -> Equilibrium:
    """Return the result if no equilibrium exists, or none was found."""
    unknown = np.full(len(structure.lines), np.nan)
    nothing, modes = np.zeros(len(unknown)), np.full(structure.mode_count, np.nan)
    status = (SLIDING,) * len(unknown)
    forces = (unknown, unknown, nothing)
    return Equilibrium(
        JAMMED, status, nothing, nothing, *forces, nothing, unknown, unknown, modes, found, ("no forces balance",)
    )


def _lifted(structure: Structure, status: Sequence[str]) -> bool:
    """Return whether a single contact, or a surface as a whole, is open."""
    surfaces = [contact.surface for contact in structure.system.contacts]
    closed = {name for name, one in zip(surfaces, status, strict=True) if name and one != SEPARATED}
    return any(one == SEPARATED and name not in closed for name, one in zip(surfaces, status, strict=True))


def open_words(structure: Structure, at: Equilibrium) -> list[str]:
    """Return the least distance of each open contact, and of each surface that is open as a whole, in words."""
    contacts, names = structure.system.contacts, structure.system.contact_names
    of_name: dict[str, list[int]] = {}
    for k, name in enumerate(names):
        of_name.setdefault(contacts[k].surface or name, []).append(k)
    return [
        f"{name} is open by {max(min(float(at.opening[k]) for k in those), 0.0):.3g} m"
        for name, those in of_name.items()
        if all(at.status[k] == SEPARATED for k in those)
    ]


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
    soft = softness(structure, at.status)
    give = np.where([structure.is_rigid(k) for k in range(len(give))], soft, give)
    equations = Equations(structure, at.status, at.sense * at.ratio, give, soft)
    pull, opening = np.zeros(structure.mode_count), np.zeros(len(speed))
    for k, line in enumerate(structure.lines):
        pull -= speed[k] * (at.normal_force[k] * line.normal_slope - at.tangential_force[k] * line.tangent_slope)
        opening[k] = speed[k] * line.normal_slope @ at.displacement
    held = np.zeros(len(equations.held) - len(equations.closed))
    return equations.exact(pull, opening[equations.closed], held)[0]


def _check_moved(structure: Structure, closed: Sequence[int]) -> None:
    """Raise unless bodies can move at each closed contact."""
    for k in closed:
        if not structure.lines[k].normal.any():
            name = structure.system.contact_names[k]
            raise ArgumentError("contact", "be between points that move", got=f"{name}, whose points are both held")


def _check_carried(structure: Structure, velocity: Array) -> None:
    """Raise if, with all contacts closed, friction carries a body along with a track that turns."""
    count = len(structure.lines)
    if carried_along(structure, range(count), structure.free_motions(normals_of(structure))).shape[1]:
        _, at = at_statuses(structure, velocity, [SLIDING] * count)
        if np.isfinite(at.slip_acceleration).all():
            _check_not_carried(structure, range(count), stopping(structure, at))


def _check_not_carried(structure: Structure, closed: Sequence[int], stuck: Sequence[int]) -> None:
    """Raise if contacts on a track that turns stick, and nothing but their friction holds a motion of the bodies."""
    free = structure.free_motions(normals_of(structure, closed))
    if carried_along(structure, stuck, free).shape[1]:
        raise not_held(structure, carried_along(structure, closed, free))


def _check_determined(structure: Structure, status: Sequence[str], share: Array) -> None:
    """Raise if forces that the constraints leave open move the bodies, or if a free motion is braked."""
    held, pushes, closed, stuck = held_rows(structure, status, share)
    _check_unbraked(structure, structure.free_motions(held))
    rigid = rigid_rows(structure, closed, stuck)
    held, pushes = held[rigid], pushes[rigid]
    if rank(held) == len(held) or rank(np.hstack([held, pushes])) == rank(held):
        return
    who = [*closed, *stuck, *held_across(structure, stuck)]
    raise held_twice(structure.system, [who[row] for row in rigid])


def _check_friction(structure: Structure) -> None:
    """Raise if friction depends on forces that contacts share arbitrarily when all are closed and slide."""
    ratio = [float(contact.law.under(0.0).coefficient_at(1.0)) for contact in structure.system.contacts]
    _check_determined(structure, [SLIDING] * len(ratio), np.array(ratio))


def _check_unbraked(structure: Structure, free: Array) -> None:
    braked = structure.damping @ free
    least = ROUND_OFF * max(float(np.abs(structure.damping).max()), 1e-300)
    if braked.size and np.abs(braked).max() > least:
        _, share, ways = np.linalg.svd(braked, full_matrices=False)
        raise ArgumentError(
            "connections",
            "not brake a rigid motion that is otherwise free, which has no steady state: impose a velocity instead",
            got=words_of(structure, free @ ways[share > least].T),
        )
