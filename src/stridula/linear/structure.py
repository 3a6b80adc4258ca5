"""A system about its start as matrices, from which equilibrium and vibration are computed."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeVar

import numpy as np
import scipy.linalg

from ..arrays import Array
from ..checks import STATUS_WORDS, ArgumentError
from ..contact import PointContact, RigidTrack
from ..histories import History
from ..lowering import Assembly, ContactRows, assemble
from ..system import System

Found = TypeVar("Found")
SEPARATED, STICKING, SLIDING = STATUS_WORDS
CLOSED = (STICKING, SLIDING)
# Relative size below which a motion does not move a row.
UNMOVED = 1e-9
# Time so short that residual shapes respond and modes hardly do, times the highest angular frequency.
SHORT = 1e-3
# Relative squared angular frequency below which rigid motions of the bodies do not strain connections.
UNSTRAINED = 1e-13


@dataclass(frozen=True)
class ContactLine:
    """One contact at its abscissa, as rows on the modes, each of shape (modes,).

    Attributes
    ----------
    normal, tangent, across : ndarray
        Displacement of the tip minus that of the track, along the normal, along the slip and across it, which is zero
        in the plane; also the modal forces of contact forces.
    along : ndarray
        Shift of the contact point along a beam, a plate or a circle; zero on other tracks, which are uniform.
    normal_slope, tangent_slope : ndarray
        Derivative along the track of its displacement along normal and tangent [1/m].
    slip_slope : ndarray
        Share of `tangent_slope` in the slip: zero on a circle, where the slip is relative to the material under the
        tip.
    points : ndarray, shape (2, 2, modes) or (2, 3, modes)
        Displacement of the tip, then of the point of the track that it touches, each along world x, y and, in space, z.
    """

    normal: Array
    tangent: Array
    across: Array
    along: Array
    normal_slope: Array
    tangent_slope: Array
    slip_slope: Array
    points: Array


class Structure:
    """A system about its start as matrices.

    Parameters
    ----------
    system : System
        The system.
    time : float, optional
        Time at which drives are evaluated [s]; if left out, after they have become constant.
    on_profiles : bool, optional
        Whether tracks may have profiles, which then stand still: their heights are in the gaps.

    Attributes
    ----------
    arrays : Assembly
        The system as flat arrays.
    lines : list of ContactLine
        One for each contact.
    stiffness, damping : ndarray, shape (modes, modes)
        Stiffness [1/s²] and damping matrix [1/s]; for bodies that turn, with convection and Coriolis forces.
    passing : ndarray, shape (modes, modes)
        Velocities of the material of turning bodies for unit displacements [1/s], in addition to those of the modes.
    mass : ndarray, shape (modes,)
        Modal masses: 1, and 0 for residual shapes.
    rigid : ndarray, shape (modes, motions)
        Motions without strain, orthonormal.
    load : ndarray, shape (modes,)
        Modal forces of the drives.
    gaps : ndarray, shape (contacts,)
        Gaps of the undeformed system [m].
    rates : ndarray, shape (2, contacts)
        Velocities of the tip relative to the track prescribed by drives and tracks, along slip and normal [m/s].
    ways : ndarray, shape (contacts, 2)
        Directions of the slip in both tangents: that of the prescribed slip in space, else the first tangent.

    Raises
    ------
    ValueError
        If no time is given and a history never becomes constant.
    """

    def __init__(self, system: System, time: float | None = None, on_profiles: bool = False) -> None:
        _check_circles(system)
        if not on_profiles:
            check_flat(system, "in linear theory, and in equilibrium unless its contact has a stiffness")
        self.system, self.arrays = system, assemble(system)
        self._known: dict[Any, Any] = {}
        settled = settled_time(system) if time is None else time
        # Later times are equivalent, and avoid the kink at which a history becomes constant.
        now = np.array([2.0 * settled + 1.0 if time is None else settled])
        arrays, size = self.arrays, self.arrays.coupled
        rates = [_prescribed_rates(contact, system, now) for contact in system.contacts]
        self.ways, self.rates = _along_the_slip(np.array(rates))
        self.lines = self._lines(np.zeros(len(system.contacts)))
        self.stiffness, self.damping = arrays.all_stiffness, np.diag(arrays.damping_rate)
        self.damping[:size, :size] = arrays.dissipation
        if arrays.springs.bends:
            self.damping = self.damping + arrays.springs.damping()
        self.mass = np.where(arrays.massless, 0.0, 1.0)
        self.rigid = _rigid_motions(self)
        self.passing = self._turn(now)
        factors = arrays.signals.factors(now, 1e-6)[:, 0]
        self._unstretched = self.stiffness, factors @ arrays.loads
        self.stiffness, self.load = self._unstretched
        if arrays.springs.bends:
            self._take(*arrays.springs.steepest())
        moved = arrays.motion(np.array([settled]), 1e-6)[0, :, 2]
        self.gaps = moved + [contact.gap for contact in system.contacts]
        if time is None:
            self._check_steady()

    def stretch_to(self, displacement: Array) -> None:
        """Take the stiffness and the force of nonlinear springs about modal displacements, shape (modes,)."""
        self._take(*self.arrays.springs.tangents(displacement))

    def _take(self, added: Array, pulls: Array) -> None:
        """Add a stiffness and modal forces of nonlinear springs, in place of those before."""
        stiffness, load = self._unstretched
        self.stiffness, self.load, self._known = stiffness + added, load + pulls, {}
        self.rigid = _rigid_motions(self)

    def _turn(self, now: Array) -> Array:
        """Add the turning of bodies at a given time, and return the velocities of their material.

        With a momentum ``p = q' + G q`` of each pair, ``p' + G p + damping p + stiffness q = f``.
        """
        passing, carried = np.zeros((2, self.mode_count, self.mode_count))
        if not self.arrays.turning:
            return passing
        for one in self.arrays.turning:
            rate, (first, second) = float(one.turning.rate(now)[0]), one.pairs.T
            for matrix, factor in ((passing, one.turning.order), (carried, one.turning.drag)):
                matrix[first, second], matrix[second, first] = rate * np.array(factor), -rate * np.array(factor)
        # Residual shapes have no momentum, and are most of many coordinates.
        moving = np.flatnonzero(self.mass)
        carried *= self.mass
        self.stiffness = self.stiffness + carried[:, moving] @ carried[moving]
        self.stiffness[:, moving] += self.damping @ carried[:, moving]
        self.damping = self.damping + 2.0 * carried
        return passing

    @property
    def mode_count(self) -> int:
        """Number of modes."""
        return len(self.mass)

    @property
    def promptness(self) -> Array:
        """Displacement of each mode for a unit force of short duration, in a common unit, shape (modes,)."""
        if self.mass.all():
            return self.mass
        highest = float(np.diag(self.stiffness)[self.mass > 0.0].max(initial=1.0))
        return np.where(self.mass > 0.0, SHORT**2 / highest, 1.0)

    def is_rigid(self, contact: int) -> bool:
        """Return whether a contact is rigid."""
        return self.system.contacts[contact].yields is None

    def joint_give(self, contact: int) -> float:
        """Return the flexibility of a sticking contact along its tangents [m/N], 0 without a joint there."""
        stiffness = self.system.contacts[contact].tangential_stiffness
        return 0.0 if stiffness is None else 1.0 / stiffness

    def shifted(self, shifts: Array) -> Structure:
        """Return the system with its contact points shifted along their tracks by distances [m], shape (contacts,)."""
        other = copy(self)
        other.forget()
        other.lines = self._lines(shifts)
        return other

    def _lines(self, shifts: Array) -> list[ContactLine]:
        """Return the contacts as rows, their points shifted along their tracks by distances [m]."""
        lines = []
        for one, way, shift in zip(self.arrays.contacts, self.ways, shifts.tolist(), strict=True):
            line = _line(one, self.system, self.arrays, shift)
            lines.append(_turned(line, way, *_aside(one, shift)) if one.contact.is_spatial else line)
        return lines

    def prescribed(self, status: Sequence[str]) -> Array:
        """Return the slip velocities [m/s] prescribed by drives and tracks; rigid motions follow closed contacts.

        Parameters
        ----------
        status : sequence of str
            Status of each contact.
        """
        tangents, *_ = self._rigid_rows()
        slips = self.rates[0] + tangents @ self._following(status)
        stuck = np.array([one == STICKING for one in status])
        return np.where(stuck | (np.abs(slips) <= UNMOVED * np.abs(self.rates).max()), 0.0, slips)

    def following(self, status: Sequence[str]) -> Array:
        """Return the modal velocities of rigid motions that follow closed contacts, shape (modes,)."""
        return np.asarray(self.rigid @ self._following(status))

    def sliding(self, status: Sequence[str], slip_velocity: Array) -> Array:
        """Return the modal velocities of the least rigid motion with given slips of closed contacts, shape (modes,).

        Raises
        ------
        ValueError
            If no rigid motion has the slip of a contact, or follows the track of a sticking contact or a rising track.
        """
        tangents, normals, acrosses = self._rigid_rows()
        slips, openings = self.rates
        closed = np.array([one in CLOSED for one in status])
        rows = np.vstack([normals[closed], tangents[closed], acrosses[closed]])
        wanted = np.concatenate([-openings[closed], (slip_velocity - slips)[closed], 0.0 * slips[closed]])
        found = np.linalg.pinv(rows, rcond=UNMOVED) @ wanted
        missed = np.abs(rows @ found - wanted)
        if missed.size and missed.max() > UNMOVED * np.abs(wanted).max():
            contact = int(np.flatnonzero(closed)[int(missed.argmax()) % int(closed.sum())])
            name = self.system.contact_names[contact]
            if int(missed.argmax()) < int(closed.sum()):
                raise ArgumentError("drives", f"let bodies follow the motion along the normal of {name}")
            if status[contact] == STICKING:
                raise ArgumentError("status", f"let {name} slide: nothing can follow its track", STICKING)
            raise ArgumentError(
                "velocity",
                "be one at which bodies move as a whole",
                float(slip_velocity[contact]),
                got=(
                    f"{float(slip_velocity[contact])!r} m/s for {name}, which cannot keep sliding: move its "
                    "track or its root"
                ),
            )
        return np.asarray(self.rigid @ found)

    def forget(self, but: Sequence[Hashable] = ()) -> None:
        """Forget cached results except those of some keys."""
        self._known = {key: one for key, one in self._known.items() if key in but}

    def once(self, key: Hashable, find: Callable[[], Found]) -> Found:
        """Return a cached result for the present places of the contacts.

        Parameters
        ----------
        key : hashable
            Key of the result.
        find : callable
            Computes the result.
        """
        if key not in self._known:
            self._known[key] = find()
        found: Found = self._known[key]
        return found

    def _following(self, status: Sequence[str]) -> Array:
        return self.once(("following", *status), partial(self._follow, status))

    def _follow(self, status: Sequence[str]) -> Array:
        tangents, normals, acrosses = self._rigid_rows()
        slips, openings = self.rates
        closed, stuck = (np.array([one in kinds for one in status]) for kinds in (CLOSED, (STICKING,)))
        wanted = np.concatenate([openings[closed], slips[stuck], 0.0 * slips[stuck]])
        if not wanted.any():
            return np.zeros(self.rigid.shape[1])
        rows = np.vstack([normals[closed], tangents[stuck], acrosses[stuck]])
        return -np.linalg.pinv(rows, rcond=UNMOVED) @ wanted

    def _rigid_rows(self) -> tuple[Array, Array, Array]:
        """Return contact rows on rigid motions, along slips, along normals and across slips, (contacts, motions)."""
        return self.once("rigid rows", self._find_rigid_rows)

    def _find_rigid_rows(self) -> tuple[Array, Array, Array]:
        def felt(word: str) -> Array:
            rows = np.array([getattr(line, word) for line in self.lines])
            moved = rows @ self.rigid
            return np.where(np.abs(moved) < UNMOVED * np.linalg.norm(rows, axis=1, keepdims=True), 0.0, moved)

        return felt("tangent"), felt("normal"), felt("across")

    def _check_steady(self) -> None:
        _, openings = self.rates
        if not openings.any():
            return
        _, normals, _ = self._rigid_rows()
        left = np.abs(openings - normals @ (np.linalg.pinv(normals, rcond=UNMOVED) @ openings))
        if left.max() > UNMOVED * np.abs(openings).max():
            name = self.system.contact_names[int(left.argmax())]
            raise ArgumentError("time", f"be given: no body can follow the motion along the normal of {name}", None)

    def free_motions(self, rows: Array) -> Array:
        """Return the rigid motions in the null space of some rows, orthonormal, shape (modes, motions)."""
        return self.once(("free", rows.tobytes()), partial(self._find_free_motions, rows))

    def _find_free_motions(self, rows: Array) -> Array:
        if not self.rigid.shape[1] or not len(rows):
            return self.rigid
        felt = rows @ self.rigid / np.linalg.norm(rows, axis=1, keepdims=True)
        felt[np.abs(felt) < UNMOVED] = 0.0
        return np.asarray(self.rigid @ scipy.linalg.null_space(felt, rcond=UNMOVED))


def settled_time(system: System) -> float:
    """Return the time from which drives and tracks are constant [s].

    Raises
    ------
    ValueError
        If one always varies.
    """
    histories: list[tuple[str, History]] = []
    for number, drive in enumerate(system.drives):
        if hasattr(drive, "history"):
            histories.append((f"drives[{number}]", drive.history))
    for number, connection in enumerate(system.connections):
        if connection.moved_by:
            histories.append((f"connections[{number}]", connection.history))
    for body in system.bodies:
        if getattr(body, "turning_history", None) is not None:
            histories.append((f"the turning of {system.body_name(body)}", body.turning_history))
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        if contact.rigid_track is not None:
            histories += [(f"the track of {name}", history) for history in _varying(contact.rigid_track, name)]
    for name, history in histories:
        if history.settled is None:
            raise ArgumentError("time", f"be given for {name}, which never stops varying", history)
    return max((history.settled or 0.0 for _, history in histories), default=0.0)


def _varying(track: RigidTrack, name: str) -> list[History]:
    """Return the histories that move a rigid track."""
    moved = (
        (track.velocity, track.acceleration, track.history),
        (track.normal_velocity, track.normal_acceleration, track.normal_history),
    )
    for _, acceleration, history in moved:
        if acceleration and history.settled is not None and history.factor(np.array([history.settled + 1.0]))[0]:
            raise ArgumentError("time", f"be given for the track of {name}, which keeps accelerating")
    return [history for velocity, acceleration, history in moved if velocity or acceleration]


def _line(one: ContactRows, system: System, arrays: Assembly, shift: float = 0.0) -> ContactLine:
    nothing = np.zeros(one.fixed.shape[1])
    touched, track = one.contact.touched_point, one.contact.path_body
    points = np.zeros((2, 3 if system.is_spatial else 2, nothing.size))

    def place(side: int, body: Any, position: Any) -> None:
        rows = body.trace(position, system.is_held(body))
        first, end = arrays.spans[system.body_name(body)]
        if end <= len(arrays.blend):
            points[side][: len(rows), : len(arrays.blend)] = rows @ arrays.blend[first:end]
        else:
            points[side][: len(rows), first:end] = rows

    place(0, one.contact.tip.body, one.contact.tip.position)
    if touched is not None:
        place(1, touched.body, touched.position)
    if one.circle is not None:
        rows, slopes = one.round_at(one.contact.at + shift), -one.slopes_round_at(one.contact.at + shift)
        return ContactLine(rows[0], rows[1], nothing, one.travel[0], slopes[0], slopes[1], nothing, points)
    if track is None:
        return ContactLine(one.fixed[0], one.fixed[1], nothing, nothing, nothing, nothing, nothing, points)
    at = one.contact.at + shift
    place(1, track, at)
    slope = np.zeros((2, nothing.size))
    slope[:, one.bending[0] : one.axial[1]] = track.path().traces(at)[1]
    trace = track.axes @ points[1][: track.axes.shape[1]]
    normal, tangent = one.fixed[0] - trace[1], one.fixed[1] - trace[0]
    return ContactLine(normal, tangent, nothing, one.fixed[1], slope[1], slope[0], slope[0], points)


def _check_circles(system: System) -> None:
    """Raise if a tip is carried along a circle: its body would then turn under it."""
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        if contact.circle is not None and (contact.circle.velocity or system.is_held(contact.tip.body)):
            words = (
                f"not be carried along its circle by {name} in linear theory: let the body turn the other way instead"
            )
            raise ArgumentError("track", words, got=f"a velocity of {contact.circle.velocity!r} m/s")


def check_flat(system: System, where: str) -> None:
    """Raise if a track has a profile, over which no sliding is steady."""
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        if contact.relief is not None:
            got = f"a profile under {name}, over which no sliding is steady"
            argument = "track.profile" if contact.rigid_track else "run_out" if contact.surface else "profile"
            raise ArgumentError(argument, f"be left out {where}", got=got)


def _aside(one: ContactRows, shift: float) -> tuple[Array, Array]:
    """Return the row of the second tangent of a contact in space, and the derivative of its track's part along it."""
    if one.circle is None:
        return one.fixed[2], np.zeros_like(one.fixed[2])
    place = one.contact.at + shift
    return one.round_at(place)[2], -one.slopes_round_at(place)[2]


def _turned(line: ContactLine, way: Array, aside: Array, slope_aside: Array) -> ContactLine:
    """Return a contact in space with its tangent along the slip, from the rows of both tangents."""
    c, s = way.tolist()
    line = replace(line, tangent_slope=c * line.tangent_slope + s * slope_aside, slip_slope=c * line.slip_slope)
    across = c * aside - s * line.tangent
    size = np.linalg.norm(line.normal) + np.linalg.norm(line.tangent)
    if np.linalg.norm(across) < UNMOVED * size:
        across = np.zeros_like(across)
    return replace(line, tangent=c * line.tangent + s * aside, across=across)


def _along_the_slip(rates: Array) -> tuple[Array, Array]:
    """Return directions of slip in both tangents, (contacts, 2), and velocities along slip and normal."""
    slips, openings = rates[:, :2], rates[:, 2]
    ways = np.zeros_like(slips)
    ways[:, 0] = 1.0
    size = np.hypot(*slips.T)
    in_space = slips[:, 1] != 0.0
    ways[in_space] = slips[in_space] / size[in_space, None]
    return ways, np.array([np.where(in_space, size, slips[:, 0]), openings])


def _rigid_motions(structure: Structure) -> Array:
    rigid = structure.arrays.rigid
    motions = np.eye(structure.mode_count)[:, rigid]
    if not rigid.any():
        return motions
    # Only rigid motions of the bodies are considered, so that a fast mode cannot hide a soft connection.
    squared, shapes = np.linalg.eigh(structure.stiffness[np.ix_(rigid, rigid)])
    return np.asarray(motions @ shapes[:, np.abs(squared) <= UNSTRAINED * np.abs(squared).max()])


def _prescribed_rates(contact: PointContact, system: System, now: Array) -> tuple[float, float, float]:
    """Return the prescribed velocities of the tip relative to the track, along both tangents and the normal."""
    imposed, (normal, *tangents) = system.imposed_velocity, contact.frame
    root = imposed.velocity * float(imposed.history.factor(now)[0]) if imposed else 0.0
    held = float(system.is_held(contact.tip.body))
    if contact.touched_point is not None:
        held -= float(system.is_held(contact.touched_point.body))
    slips = [held * tangent[0] * root for tangent in tangents]
    slips = [slip - speed for slip, speed in zip(slips, contact.surface_velocities, strict=False)]
    for turning, passing in contact.turning_velocities:
        factor = float(turning.history.factor(now)[0])
        slips = [slip - factor * speed for slip, speed in zip(slips, passing.tolist(), strict=True)]
    opening = held * normal[0] * root
    if contact.rigid_track is not None:
        speeds = [contact.rigid_track.speed(now)[0], contact.rigid_track.lateral_speed(now)[0]]
        slips = [slip - float(speed) for slip, speed in zip(slips, speeds, strict=False)]
        opening -= float(contact.rigid_track.normal_speed(now)[0])
    return float(slips[0]), float(slips[-1]) if len(slips) == 2 else 0.0, float(opening)
