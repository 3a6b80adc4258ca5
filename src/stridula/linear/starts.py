"""Starts in equilibrium, alone or with a mode of vibration on top."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, listed
from ..contact import FrictionLaw
from ..drives import MOST_UNSTABLE, InitialEquilibrium
from ..system import System
from .equilibrium import HELD, JAMMED, LIFTED_OFF, Equilibrium, find_equilibrium, open_words, travelling
from .given import given_status, given_velocity
from .modes import modes_of, round_off
from .structure import SEPARATED, STICKING, UNMOVED, Structure
from .vibration import vibration

# Largest number of iterations for the places of contact points in the deflected system.
PASSES = 30
# Relative change of a contact point's shift that counts as round-off.
SETTLED = 1e-13
# Relative force below zero, or beyond friction, that counts as round-off.
ROUND_OFF = 1e-9
WAYS_OUT = {
    HELD: "is held by friction: status='sticking' starts it so, another velocity or a larger push lets it slide",
    LIFTED_OFF: "is lifted off: press it down, or status='separated' starts it open",
    JAMMED: "is jammed, can neither slide nor open: reduce friction or change the angle",
}


@dataclass(frozen=True)
class Start:
    """Initial positions, velocities and friction states of a system.

    Attributes
    ----------
    position, velocity : ndarray, shape (modes,)
        Modal positions and velocities.
    friction_state : ndarray, shape (contacts, 2)
        Internal states of the friction laws along both tangents; only bristles in space have a second one.
    equilibria : str
        Number of equilibria in words, as in `Equilibrium.found`.
    exponent : complex, optional
        Exponent of the mode on top [1/s]; 0 without one.
    """

    position: Array
    velocity: Array
    friction_state: Array
    equilibria: str
    exponent: complex = 0j


def start_of(system: System, asked: InitialEquilibrium) -> Start:
    """Return the start of a system in the equilibrium of `asked`.

    The equilibrium is that under the drives at the start. Contact points on beams and plates are those of the deflected
    system, and the deflection of their tracks travels steadily with them.

    Raises
    ------
    ValueError
        If there is no such equilibrium or no such mode.
    """
    whole, structure, at = at_rest(system, asked)
    moves = structure.sliding(at.status, at.slip_velocity)
    along = np.array([line.along for line in structure.lines])
    slides = np.array([one != STICKING for one in at.status])
    # On a circle the prescribed slip is due to the turning of the body, which does not carry the tip.
    carried = [
        0.0 if contact.circle else rate for contact, rate in zip(system.contacts, structure.rates[0], strict=True)
    ]
    velocity = moves + travelling(structure, at, slides * (carried + along @ moves))
    position, states, exponent = at.displacement, np.zeros((len(structure.lines), 2)), 0j
    if asked.mode is not None:
        shape, exponent, changes = _mode(structure, at, asked)
        position = position + shape.real
        velocity = velocity + (exponent * shape).real
        states = changes.real
    laws = [contact.law.under(float(at.normal_force[k])) for k, contact in enumerate(system.contacts)]
    slips, ways = at.slip_velocity.tolist(), structure.ways.tolist()
    friction_state = [_states(*one) for one in zip(laws, slips, ways, states.tolist(), strict=True)]
    for k, contact in enumerate(system.contacts):
        if contact.tangential_stiffness is not None and at.status[k] == STICKING:
            give = structure.joint_give(k)
            friction_state[k] = _along(ways[k], (give * at.tangential_force[k], give * at.lateral_force[k]))
    return Start(_closed(whole, at.status, position), velocity, np.array(friction_state), at.found, exponent)


def at_rest(system: System, asked: InitialEquilibrium) -> tuple[Structure, Structure, Equilibrium]:
    """Return a system about its start, the same with its contact points in equilibrium, and the equilibrium.

    Raises
    ------
    ValueError
        If there is no such equilibrium.
    """
    soft = all(one.yields is not None for one in system.contacts if one.relief is not None)
    whole = Structure(system, 0.0, on_profiles=soft)
    status = given_status(asked.status, system)
    structure, at = _settled(whole, given_velocity(asked.velocity, whole, status), status)
    _check(structure, at, status)
    return whole, structure, at


def _settled(whole: Structure, velocity: Array, status: Sequence[str] | None) -> tuple[Structure, Equilibrium]:
    """Return a system with its contact points shifted to the equilibrium, and the equilibrium."""
    along = np.array([line.along for line in whole.lines])
    places = np.array([contact.at for contact in whole.system.contacts])
    shift, structure = np.zeros(len(along)), whole
    for _ in range(PASSES):
        found = find_equilibrium(structure, velocity, status)
        before, shift = shift, along @ found.displacement
        if not np.isfinite(shift).all() or (np.abs(shift - before) <= SETTLED * (np.abs(places) + np.abs(shift))).all():
            return structure, found
        structure = whole.shifted(shift)
    raise ArgumentError("drives", "bend the track less: no equilibrium of its contact points was found")


def _check(structure: Structure, at: Equilibrium, status: Sequence[str] | None) -> None:
    """Raise unless a system can start in this equilibrium."""
    names = structure.system.contact_names
    if at.kind == JAMMED or (status is None and at.kind in WAYS_OUT):
        wrong = {HELD: STICKING, LIFTED_OFF: SEPARATED}.get(at.kind)
        which = dict.fromkeys(
            contact.surface or name
            for name, contact, one in zip(names, structure.system.contacts, at.status, strict=True)
            if wrong in (None, one)
        )
        far = open_words(structure, at) if at.kind == LIFTED_OFF else []
        got = f"one in which {listed(which)} {WAYS_OUT[at.kind]}" + (f"; {listed(far)}" if far else "")
        raise ArgumentError("initial equilibrium", "slide", got=got)
    largest = ROUND_OFF * float(np.abs([at.normal_force, at.tangential_force]).max())
    for k, contact in enumerate(structure.system.contacts):
        if at.normal_force[k] < -largest:
            raise ArgumentError(
                "status",
                f"leave {names[k]} open, which would pull with {-float(at.normal_force[k]):.3g} N",
                at.status[k],
            )
        if at.status[k] == STICKING:
            most = float(contact.law.under(float(at.normal_force[k])).coefficient_at(0.0)) * float(at.normal_force[k])
            pulled = float(np.hypot(at.tangential_force[k], at.lateral_force[k]))
            if pulled > most + largest:
                raise ArgumentError(
                    "status",
                    f"let {names[k]} slide, which would stick with {pulled:.3g} N of at most {most:.3g} N",
                    at.status[k],
                )


def _mode(structure: Structure, at: Equilibrium, asked: InitialEquilibrium) -> tuple[Array, complex, Array]:
    """Return the displacements of a mode with the given amplitude, its exponent, and changes of friction states.

    The latter have the shape (contacts, 2), along the slip and across it.
    """
    motion = vibration(structure, at)
    found = modes_of(structure, motion)
    number = _number(found.values, asked.mode, round_off(structure))
    exponent, shape = complex(found.values[number]), found.shapes[:, number]
    largest = largest_displacement(structure, shape)
    if not largest:
        raise ArgumentError("mode", "be one that moves a contact point", got=f"{number}, which moves none")
    shape = shape * (asked.amplitude * np.exp(1.0j * asked.phase) / largest)
    states = np.zeros((len(structure.lines), 2), dtype=complex)
    rates = motion.from_velocity @ (exponent * shape) + motion.from_displacement @ shape
    for owner, change in zip(motion.owners, rates / (exponent - motion.state), strict=True):
        states[owner[0], int(owner[1])] = change
    return shape, exponent, states


def largest_displacement(structure: Structure, shape: Array) -> complex:
    """Return the largest displacement of a contact point in a mode [m], 0 if none moves."""
    points = np.array([line.points for line in structure.lines])
    moved = (points @ shape).ravel()
    largest = complex(moved[np.abs(moved).argmax()])
    return largest if abs(largest) > UNMOVED * np.linalg.norm(points, axis=-1).max() else 0.0j


def _number(exponents: Array, mode: int | str | None, least: float) -> int:
    """Return the number of a mode; most unstable is the one with the largest growth among those that vibrate."""
    if mode != MOST_UNSTABLE:
        if not isinstance(mode, int) or mode >= exponents.size:
            raise ArgumentError("mode", f"be below {exponents.size}, the number of modes", mode)
        return mode
    counts = (exponents.imag > 0.0) | (exponents.real > least)
    if not counts.any():
        raise ArgumentError("mode", "be left out: nothing vibrates", mode)
    return int(np.where(counts, exponents.real, -np.inf).argmax())


def _closed(whole: Structure, status: Sequence[str], position: Array) -> Array:
    """Return positions with rigid contacts exactly closed, also with contact points shifted along bent tracks."""
    closed = np.array([one != SEPARATED and whole.is_rigid(k) for k, one in enumerate(status)])
    if not closed.any():
        return position
    along = np.array([line.along for line in whole.lines])
    for _ in range(PASSES):
        rows = np.array([line.normal for line in whole.shifted(along @ position).lines])[closed]
        gaps = whole.gaps[closed] + rows @ position
        nearer = position - rows.T @ np.linalg.solve(rows @ rows.T, gaps)
        if (np.abs(nearer - position) <= SETTLED * np.abs(position).max()).all():
            return np.asarray(nearer)
        position = nearer
    return position


def _states(law: FrictionLaw, slip: float, way: Sequence[float], change: Sequence[float]) -> tuple[float, float]:
    """Return the internal states of a law in steady sliding at a slip velocity [m/s] along a direction of the tangents.

    Changes along and across this direction are added.
    """
    if not slip:
        return law.states_at_start
    along = law.state_in_sliding(slip, change[0])
    return _along(way, (along, change[1])) if law.state_is_vector else (along, 0.0)


def _along(way: Sequence[float], vector: Sequence[float]) -> tuple[float, float]:
    """Return a vector, given along a direction of the tangents and across it, along both tangents."""
    return way[0] * vector[0] - way[1] * vector[1], way[1] * vector[0] + way[0] * vector[1]
