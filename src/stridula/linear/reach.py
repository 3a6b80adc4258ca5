"""Modes about the initial equilibrium of a run, and the amplitude of each up to which linear theory holds."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..connections import pushes
from ..contact.stiffness import slopes_at
from ..drives import InitialEquilibrium
from ..system import System
from .equilibrium import Equilibrium, find_equilibrium
from .given import given_status, given_velocity
from .modes import modes_of, round_off
from .starts import at_rest, largest_displacement
from .structure import SEPARATED, SLIDING, STICKING, Structure
from .vibration import Exponents, Vibration, vibration

# Change of a force or a velocity, relative to the largest one of the mode, that counts as round-off.
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class ModesAtRest:
    """Modes of vibration about the initial equilibrium of a run, by increasing frequency.

    Attributes
    ----------
    exponents : ndarray of complex, shape (modes,)
        Growth and angular frequency [1/s].
    round_off : float
        Growth up to which a mode does not count as unstable [1/s].
    reach : dict
        For each growing mode, by its number, the largest displacement of a contact point [m] at which a contact opens,
        lands, sticks or slips by linear theory; 0 if the least motion is enough, NaN for modes that move no contact
        point.
    quiet : dict
        The same for some modes that decay, those that decay least in a period first; without modes whose reach is 0 or
        NaN, or that do not vibrate.
    normal_force, slip_velocity : ndarray, shape (contacts,)
        Normal forces [N] and slip velocities [m/s] in equilibrium.
    """

    exponents: Array
    round_off: float
    reach: dict[int, float]
    quiet: dict[int, float]
    normal_force: Array
    slip_velocity: Array


def equilibrium_at_start(system: System, asked: InitialEquilibrium) -> Equilibrium:
    """Return the equilibrium under the drives at the start.

    Parameters
    ----------
    system : System
        The system.
    asked : InitialEquilibrium
        Given statuses and slip velocities; the kind is the result of these statuses.

    Raises
    ------
    ValueError
        If a slip velocity is needed, or contacts constrain the same motion twice.
    """
    structure = Structure(system, 0.0)
    pressed = any(drive.push is not None for drive in system.drives) or any(map(pushes, system.connections))
    if pressed and not structure.load.any():
        raise ArgumentError(
            "drives", "press from the start, because runs begin in equilibrium", got="loads that rise later"
        )
    status = given_status(asked.status, system)
    return find_equilibrium(structure, given_velocity(asked.velocity, structure, status), status)


def modes_at_rest(
    system: System, asked: InitialEquilibrium, quiet: int = 0, highest: float = np.inf, least: float = 0.0
) -> ModesAtRest:
    """Return the modes about the initial equilibrium of a run, numbered as in `InitialEquilibrium`.

    Parameters
    ----------
    system : System
        The system.
    asked : InitialEquilibrium
        The equilibrium.
    quiet : int, optional
        Number of decaying modes whose reach is returned.
    highest : float, optional
        Highest angular frequency of these [rad/s].
    least : float, optional
        Rate at which these decay at least [1/s].

    Raises
    ------
    ValueError
        If there is no such equilibrium.
    """
    whole, structure, at = at_rest(system, asked)
    motion = vibration(structure, at)
    found = modes_of(structure, motion)
    grows = np.flatnonzero(found.values.real > round_off(structure)).tolist()
    reach = {number: _reach(whole, structure, at, motion, found, number) for number in grows}
    vibrates = (found.values.imag > 0.0) & (found.values.imag <= highest)
    decays = np.flatnonzero(vibrates & (found.values.real < -max(least, round_off(structure))))
    ordered = decays[np.argsort(-found.values.real[decays] / found.values.imag[decays], kind="stable")].tolist()
    reaches = ((number, _reach(whole, structure, at, motion, found, number)) for number in ordered)
    kept = dict(islice(((number, one) for number, one in reaches if 0.0 < one < np.inf), quiet))
    return ModesAtRest(found.values, round_off(structure), reach, kept, at.normal_force, at.slip_velocity)


def _reach(
    whole: Structure, structure: Structure, at: Equilibrium, motion: Vibration, found: Exponents, number: int
) -> float:
    """Return the amplitude of a mode up to which linear theory holds [m]."""
    exponent, shape = complex(found.values[number]), found.shapes[:, number]
    largest = abs(largest_displacement(structure, shape))
    if not largest:
        return float("nan")
    normal, stuck = _forces(structure, motion, at, exponent, shape)
    rooms = [_room(float(room), abs(change)) for room, change in _slides(structure, at, exponent, shape)]
    moved = np.abs([line.normal @ shape for line in structure.lines])
    for k, status in enumerate(at.status):
        if status == SEPARATED:
            gap = float(whole.gaps[k] + structure.lines[k].normal @ at.displacement)
            rooms.append(_room(gap, moved[k]))
            continue
        rooms.append(_room(float(at.normal_force[k]), abs(normal[k]), ROUND_OFF * np.abs(normal).max()))
        if status == STICKING:
            hold = float(structure.system.contacts[k].law.under(float(at.normal_force[k])).coefficient_at(0.0))
            kept = float(np.hypot(at.tangential_force[k], at.lateral_force[k]))
            rooms.append(_room(hold * float(at.normal_force[k]) - kept, abs(stuck[k]) + hold * abs(normal[k])))
    return min(rooms) * largest


def _room(room: float, change: float, least: float = 0.0) -> float:
    """Return the ratio of a margin to a change, infinite for a change of at most `least`."""
    return max(room, 0.0) / change if change > least else float("inf")


def _forces(
    structure: Structure, motion: Vibration, at: Equilibrium, exponent: complex, shape: Array
) -> tuple[Array, Array]:
    """Return the normal forces of all contacts, and the tangential forces of sticking ones, in a mode [N]."""
    states = motion.from_velocity @ (exponent * shape) / (exponent - motion.state)
    moving = motion.mass * exponent**2 * shape + exponent * (motion.damping @ shape) + motion.stiffness @ shape
    forces = motion.spread @ np.linalg.lstsq(motion.pushes.T, moving + motion.by_state @ states, rcond=None)[0]
    normal, stuck = np.zeros((2, len(at.status)), dtype=complex)
    closed = [k for k, status in enumerate(at.status) if status != SEPARATED]
    held = [k for k in closed if at.status[k] == STICKING]
    rigid = [k for k in closed if structure.is_rigid(k)]
    normal[rigid] = forces[: len(rigid)]
    stuck[held] = forces[len(rigid) : len(rigid) + len(held)]
    for k in closed:
        yields, line = structure.system.contacts[k].yields, structure.lines[k]
        if yields is not None:
            slope, rate = slopes_at(yields, float(at.normal_force[k]))
            opens = line.normal - (line.normal_slope @ at.displacement) * line.along
            normal[k] = -(slope + rate * exponent) * (opens @ shape)
    return normal, stuck


def _slides(structure: Structure, at: Equilibrium, exponent: complex, shape: Array) -> list[tuple[float, float]]:
    """Return slip velocity and its change in a mode [m/s] for sliding contacts whose slip changes."""
    found = []
    for k, line in enumerate(structure.lines):
        slip = line.tangent - (line.slip_slope @ at.displacement) * line.along
        change = float(abs(exponent * (slip @ shape)))
        if at.status[k] == SLIDING and change > ROUND_OFF * abs(exponent) * np.linalg.norm(slip):
            found.append((abs(float(at.slip_velocity[k])), change))
    return found
