"""A system under a time scheme as arrays for the march."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from .._kernels.layout import columns as at
from .._kernels.layout.laws import STATIC
from .._kernels.modes.springs import STIFF
from ..arrays import Array
from ..bodies.paths import Path
from ..checks import ArgumentError, at_most
from ..connections.nonlinear import Bend
from .assembly import Assembly
from .contact_rows import ContactRows
from .heating import HeatBlocks, heat_blocks
from .own_laws import law_of_march, of_one_width
from .probed import ProbeRows
from .schemes import Scheme
from .springs import SpringRows
from .stepping import Stepping

# Largest phase by which waves may turn in a step [rad].
MOST_TURNED = 0.5
YIELDING = (
    "have tabulated dashpots only where residual shapes of contacts hardly yield: place them apart from the contacts,"
    " or join them through a point mass on a spring"
)


@dataclass(frozen=True)
class Recurrence:
    """The recurrence of the modes.

    Attributes
    ----------
    block : ndarray, shape (coefficients, modes)
        Coefficients of uncoupled modes.
    matrices : ndarray, shape (matrices, coupled, coupled)
        Coefficients of coupled modes.
    loads : ndarray, shape (loads, modes)
        Load increments for unit signals.
    forces : ndarray, shape (loads, modes)
        Modal forces for unit signals.
    """

    block: Array
    matrices: Array
    loads: Array
    forces: Array

    @property
    def coupled(self) -> int:
        """Number of coupled modes, which come first."""
        return int(self.matrices.shape[1])

    def mobility(self, rows: Array) -> Array:
        """Return the displacement of every mode at the end of a step for unit forces on rows, shape (..., modes)."""
        size = self.matrices.shape[1]
        moved = self.block[at.LOAD] * rows
        moved[..., :size] = rows[..., :size] @ self.matrices[at.MOBILITY].T
        return np.asarray(moved)

    def sawtooth(self, rows: Array) -> Array:
        """Return the size of a motion of every mode that changes its sign from step to step, under unit forces on rows.

        Shape (..., modes). It is above zero below the limit of the scheme.
        """
        size = self.matrices.shape[1]
        moved = self.block[at.LOAD] * rows / (2.0 * (1.0 + self.block[at.B]) - self.block[at.R])
        if size:
            kept, stiffness, mobility = (self.matrices[k] for k in (at.KEPT, at.STIFFNESS, at.MOBILITY))
            swung = np.linalg.solve(2.0 * (np.eye(size) + kept) - stiffness, mobility)
            moved[..., :size] = rows[..., :size] @ swung.T
        return np.asarray(moved)

    def free(self, position: Array, increment: Array) -> Array:
        """Return the next increments of free motion."""
        size = self.matrices.shape[1]
        moved = self.block[at.B] * increment - self.block[at.R] * position
        moved[:size] = self.matrices[at.KEPT] @ increment[:size] - self.matrices[at.STIFFNESS] @ position[:size]
        return np.asarray(moved)

    def stored_energy(self, modal: Array) -> float:
        """Return the energy [J] half a step ago of positions and increments, shape (2, modes).

        It is ``[(1+b)/2 d² + r q[n] q[n-1]] / (2 l)`` for every uncoupled mode.
        """
        (q, d), block, size = modal, self.block, self.coupled
        # Overflow ends the run later.
        with np.errstate(over="ignore", invalid="ignore"):
            alone = ((1.0 - block[at.HALF_LOSS]) * d * d + block[at.R] * q * (q - d)) * block[at.HALF_OVER_LOAD]
            q, d = q[:size], d[:size]
            together = d @ self.matrices[at.KINETIC] @ d + q @ self.matrices[at.ELASTIC] @ (q - d)
            return float(alone.sum() + together)

    def energy_of_loads(self) -> float:
        """Return the energy [J] that all unit loads give to modes at rest in one step."""
        size = self.matrices.shape[1]
        coupled = self.loads[:, :size]
        with np.errstate(over="ignore"):
            energy = np.sum(self.loads**2 * self.block[at.HALF_OVER_LOAD])
            return float(energy + np.sum(coupled @ self.matrices[at.IMPULSE] * coupled))


def recurrence(arrays: Assembly, scheme: Scheme, step: float) -> Recurrence:
    """Return the recurrence of a system under a scheme.

    Raises
    ------
    ValueError
        If the step is so long that coupled modes would move against an impulse.
    """
    stepping = Stepping(arrays, scheme)
    k = stepping.coefficients(step)
    block = np.zeros((at.COEFFICIENT_ROWS, arrays.mode_count))
    block[at.B], block[at.R], block[at.LOAD] = k.b, k.r, k.load
    block[at.HALF_OVER_LOAD] = 0.5 / block[at.LOAD]
    block[at.HALF_LOSS] = (1.0 - k.b) / 2.0
    size = arrays.coupled
    matrices, loads = np.zeros((at.MATRICES, size, size)), arrays.loads * k.load
    if size:
        c = stepping.coupled_coefficients(step)
        inverse = np.linalg.inv(c.load)
        kept = inverse @ c.b
        kinetic, lost, turned = _symmetric(inverse + kept), _symmetric(inverse - kept), inverse + kept
        if min(np.linalg.eigvalsh(form)[0] for form in (_symmetric(c.load), kinetic - 0.5 * arrays.stiffness)) <= 0.0:
            raise ArgumentError("step", "be shorter for the coupled modes of this system", step, got=f"{step!r} s")
        block[:, :size] = 0.0
        matrices[at.KEPT], matrices[at.STIFFNESS], matrices[at.MOBILITY] = c.b, c.r, c.load
        matrices[at.IMPULSE], matrices[at.ELASTIC] = inverse / 2.0, arrays.stiffness / 2.0
        matrices[at.KINETIC], matrices[at.LOSS] = kinetic / 4.0, lost / 4.0
        matrices[at.TURN] = (turned - turned.T) / 4.0
        loads[:, :size] = arrays.loads[:, :size] @ c.load.T
    return Recurrence(block, matrices, loads, arrays.loads)


def _symmetric(matrix: Array) -> Array:
    return np.asarray(0.5 * (matrix + matrix.T))


@dataclass(frozen=True)
class PathModes:
    """The modes of a body on whose path a contact moves.

    Attributes
    ----------
    path : Path
        Their traces along it.
    normal, tangential : slice
        Ranges of the modes along its normal and along its tangent.
    """

    path: Path
    normal: slice
    tangential: slice


@dataclass(frozen=True)
class TurningBlocks:
    """The modes of a body that turns.

    Attributes
    ----------
    pairs : ndarray of int, shape (pairs, 2)
        Numbers of the modes of each pair.
    turns : ndarray, shape (2, pairs)
        Phase by which each pair turns, and that of the material, for one radian of the body.
    others : ndarray of int, shape (others,)
        Numbers of its modes without waves round the axis if a contact moves round it; else empty.
    """

    pairs: Array
    turns: Array
    others: Array


@dataclass(frozen=True)
class ContactBlocks:
    """The contacts as arrays for the march.

    Attributes
    ----------
    constants : ndarray, shape (contacts, constants)
        Constants of each contact.
    codes : ndarray of int, shape (contacts,)
        Code of its friction law.
    laws : ndarray, shape (contacts, parameters)
        Parameters of its friction law.
    rows : ndarray, shape (rows, modes)
        Constant rows along normal and tangents of all contacts.
    first_rows : ndarray of int, shape (contacts + 1,)
        First row of each contact, that of its normal, and the end of the last.
    compliance : ndarray, shape (rows, rows)
        Relative displacements [m] of the constant rows for unit forces on each.
    paths : tuple of PathModes or None
        Path of each contact.
    circles : ndarray of int, shape (contacts,)
        The turning body that each contact moves round, -1 for none.
    profiles : ndarray, shape (contacts, numbers)
        Profile of its track; no numbers without any.
    """

    constants: Array
    codes: Array
    laws: Array
    rows: Array
    first_rows: Array
    compliance: Array
    paths: tuple[PathModes | None, ...]
    circles: Array
    profiles: Array


def contact_blocks(arrays: Assembly, modes: Recurrence) -> ContactBlocks:
    """Return the contacts as arrays for the march."""
    count = len(arrays.contacts)
    constants = np.zeros((count, at.CONTACT_CONSTANTS))
    marched = [law_of_march(one.contact.law) for one in arrays.contacts]
    codes, laws = np.array([code for code, _ in marched]), np.array(of_one_width([row for _, row in marched]))
    rows = np.concatenate([contact.fixed for contact in arrays.contacts])
    first_rows = np.cumsum([0, *(len(contact.fixed) for contact in arrays.contacts)])
    paths = tuple(_path_modes(one) for one in arrays.contacts)
    for i, (one, along) in enumerate(zip(arrays.contacts, paths, strict=True)):
        constants[i, [at.START, at.GAP]] = one.at, one.height
        if along is not None:
            path = along.path
            angles = np.stack([path.rate, path.phase], axis=1).ravel()
            constants[i, at.LOW : at.AT_REST] = (*path.ends, *angles)
        if one.circle is not None:
            constants[i, [at.ALONG, at.ALONG_PHASE]] = one.rate, -one.rate * one.contact.at
        constants[i, at.AT_REST] = laws[i, STATIC]
        if one.yields is not None:
            constants[i, at.YIELD_STIFFNESS : at.YIELD_REACH] = one.yields.numbers
        if not one.fixed[0].any() and along is None:
            raise ArgumentError(
                f"contact {one.contact.name or i + 1}",
                "have a tip or a track that moves along its normal",
                got="neither",
            )
    constants[:, at.YIELD_REACH] = _reach(arrays, modes)
    constant = rows.copy()
    circles = np.full(count, -1, dtype=np.int64)
    for i, one in enumerate(arrays.contacts):
        if one.circle is not None:
            circles[i] = next(k for k, body in enumerate(arrays.turning) if body.span == one.circle.span)
            constant[first_rows[i] : first_rows[i + 1], slice(*one.circle.span)] = 0.0
    compliance = np.ascontiguousarray(constant @ modes.mobility(constant).T)
    profiles = np.array(of_one_width([_profile_of_march(one) for one in arrays.contacts]))
    return ContactBlocks(constants, codes, laws, rows, first_rows, compliance, paths, circles, profiles)


def _reach(arrays: Assembly, modes: Recurrence) -> Array:
    """Return the largest sawtooth of each compliant contact under unit forces of either sign on all of them [m]."""
    reach = np.zeros(len(arrays.contacts))
    soft = [i for i, one in enumerate(arrays.contacts) if one.yields is not None]
    if soft:
        rows = np.array([arrays.contacts[i].rows_at(arrays.contacts[i].at)[0] for i in soft])
        reach[soft] = np.abs(rows @ modes.sawtooth(rows).T).sum(axis=1)
    return reach


def _profile_of_march(one: ContactRows) -> Array:
    """Return the numbers of the profile of a contact's track, none without one."""
    if one.profile is None:
        return np.zeros(0)
    pieces = one.profile.pieces
    return np.concatenate([[len(pieces), one.profile.periodic], one.profile.place, pieces.ravel()])


def _path_modes(one: ContactRows) -> PathModes | None:
    if one.bending == one.axial:
        return None
    track: Any = one.contact.track
    return PathModes(track.path(), slice(*one.bending), slice(*one.axial))


@dataclass(frozen=True)
class ProbeBlocks:
    """The probes as arrays for the march.

    Attributes
    ----------
    kinds : ndarray, shape (probes,)
        Whether each records positions, centred velocities or second differences.
    rows : ndarray, shape (probes, modes)
        Rows on positions, sums or differences of increments.
    direct : ndarray, shape (probes, signals)
        Shares of the signals.
    contact : ndarray, shape (probes, rows)
        Shares of the normal and tangential forces.
    sums : tuple of Part, optional
        The probe that each row is a part of; empty if each is a probe of its own.
    """

    kinds: Array
    rows: Array
    direct: Array
    contact: Array
    sums: tuple[Part, ...] = ()

    def summed(self, raw: Array) -> Array:
        """Return values of the rows at steps as those of the probes, shape (steps, probes)."""
        if not self.sums:
            return raw
        found = np.zeros((len(raw), self.sums[-1].probe + 1))
        for values, part in zip(raw.T, self.sums, strict=True):
            found[:, part.probe] += values if part.bend is None else part.share * part.bend.pulls(values)
        return found


class Part(NamedTuple):
    """A row of a probe.

    Attributes
    ----------
    probe : int
        Number of the probe.
    kind : int
        Whether the row records positions, centred velocities or second differences.
    row : ndarray, shape (modes,)
        Row on modal motion.
    bend : Bend or None
        Pull of a nonlinear spring over the row; None if the row itself counts.
    share : float
        Share of the pull [1].
    """

    probe: int
    kind: int
    row: Array
    bend: Bend | None = None
    share: float = 1.0


def probe_blocks(arrays: Assembly, step: float) -> ProbeBlocks:
    """Return the probes as arrays for the march."""
    parts = [part for number, probe in enumerate(arrays.probes) for part in _parts(number, probe, arrays.springs)]
    count, first = len(parts), {part.probe: k for k, part in reversed(list(enumerate(parts)))}
    rows, kinds = np.zeros((count, arrays.mode_count)), np.zeros(count, dtype=np.int64)
    direct, contact_rows = np.zeros((count, len(arrays.signals))), sum(len(one.fixed) for one in arrays.contacts)
    contact = np.zeros((count, contact_rows))
    scale = np.array([1.0, 0.5 / step, 1.0 / step**2])
    for k, part in enumerate(parts):
        kinds[k], rows[k] = part.kind, part.row * scale[part.kind]
    for number, probe in enumerate(arrays.probes):
        direct[first[number]], contact[first[number]] = probe.direct, probe.contact
    has_sums = count > len(arrays.probes) or any(part.bend is not None for part in parts)
    return ProbeBlocks(kinds, rows, direct, contact, tuple(parts) if has_sums else ())


def _parts(number: int, probe: ProbeRows, springs: SpringRows) -> list[Part]:
    """Return the rows of a probe: the first takes its shares of signals and of contact forces."""
    kinds = np.flatnonzero(probe.rows.any(axis=1)).tolist() or [0]
    bends = [(springs.bends[k], springs.rows[k], share) for k, share in probe.springs.items()]
    own = [Part(number, kind, probe.rows[kind]) for kind in kinds]
    return own + [Part(number, int(bend.of_rate), row, bend, share) for bend, row, share in bends]


@dataclass(frozen=True)
class SpringBlocks:
    """The nonlinear springs as arrays for the march.

    Attributes
    ----------
    pulls : ndarray, shape (springs, modes)
        Increments of the modes for a unit force along each.
    stretches : ndarray, shape (springs, modes)
        Stretch of each for a unit of the modes.
    numbers : ndarray, shape (springs, numbers)
        Numbers of each, with as many kinks for all.
    """

    pulls: Array
    stretches: Array
    numbers: Array

    @property
    def kinks(self) -> int:
        """Number of the kinks of each."""
        return (self.numbers.shape[1] - at.OF_SPRING) // at.OF_KINK


def spring_blocks(springs: SpringRows, modes: Recurrence, massless: Array, step: float) -> SpringBlocks:
    """Return the nonlinear springs as arrays for the march.

    Raises
    ------
    ValueError
        If a dashpot acts where residual shapes yield much: the shorter the step, the larger their rate.
    """
    rows, kinks = springs.rows, max((bend.place.size for bend in springs.bends), default=0)
    numbers = np.zeros((len(rows), at.OF_SPRING + at.OF_KINK * kinks))
    reach = rows * modes.sawtooth(rows)
    numbers[:, at.SPRING_REACH] = np.sum(reach, axis=1)
    for own, each, bend in zip(numbers, reach, springs.bends, strict=True):
        if bend.of_rate:
            own[at.PER_RATE] = 0.5 / step
            # A sawtooth has this velocity, by the increments of two steps.
            own[at.SPRING_REACH] *= 4.0 / step
            if bend.steepest(0.0) * 4.0 / step * each[massless].sum() > STIFF:
                raise ArgumentError("connections", YIELDING, got="one at which residual shapes yield in a step")
        own[: at.SPRING_REACH] = bend.constant, bend.linear, bend.cubic
        own[at.OF_SPRING : at.OF_SPRING + at.OF_KINK * bend.place.size] = np.stack(
            [bend.place, bend.right, bend.left], axis=1
        ).ravel()
    return SpringBlocks(modes.mobility(rows), rows, numbers)


@dataclass(frozen=True)
class Blocks:
    """A system under a time scheme as arrays for the march.

    Attributes
    ----------
    modes : Recurrence
        The recurrence of the modes.
    contacts : ContactBlocks
        The contacts.
    probes : ProbeBlocks
        The probes.
    springs : SpringBlocks
        The nonlinear springs.
    heat : HeatBlocks
        The temperatures of the contacts.
    turning : tuple of TurningBlocks
        The bodies that turn.
    """

    modes: Recurrence
    contacts: ContactBlocks
    probes: ProbeBlocks
    springs: SpringBlocks
    heat: HeatBlocks
    turning: tuple[TurningBlocks, ...] = ()

    @cached_property
    def used(self) -> tuple[int, ...]:
        """Signals that a load or a probe uses; the others stay zero."""
        taken = np.flatnonzero(self.probes.direct.any(axis=0))
        return tuple(sorted({*range(len(self.modes.loads)), *(int(j) for j in taken)}))


def _check_turned(rate: float, step: float, words: str) -> None:
    """Raise if waves at a rate [rad/s] turn by too much in a step."""
    if rate * step > MOST_TURNED:
        limit = f"be at most {at_most(MOST_TURNED / rate)} s: {words} at most {MOST_TURNED} rad"
        raise ArgumentError("step", limit, step)


def blocks_of(arrays: Assembly, scheme: Scheme, step: float) -> Blocks:
    """Return a system under a time scheme as arrays for the march."""
    modes = recurrence(arrays, scheme, step)
    for one in arrays.turning:
        _check_turned(abs(one.turning.velocity) * max(one.turning.order), step, "the waves of a body turn by")
    for own in arrays.contacts:
        if own.circle is not None and own.contact.circle is not None:
            passed = abs(own.contact.circle.velocity) * own.rate * max(own.circle.turning.order)
            _check_turned(passed, step, "a contact passes over waves by")
    turning = tuple(
        TurningBlocks(
            one.pairs,
            np.array([one.turning.drag, one.turning.order]),
            one.others if one.has_circle else one.pairs[:0, 0],
        )
        for one in arrays.turning
    )
    probes, springs = probe_blocks(arrays, step), spring_blocks(arrays.springs, modes, arrays.massless, step)
    return Blocks(modes, contact_blocks(arrays, modes), probes, springs, heat_blocks(arrays.contacts, step), turning)
