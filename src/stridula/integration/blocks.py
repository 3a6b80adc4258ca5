"""A system under a scheme as the arrays that the march reads."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .._kernels import layout as at
from ..assembly import Assembly
from ..bodies import ModalPlate, Track
from ..bodies.modes import Array
from ..checks import ArgumentError
from ..contact import FrictionLaw
from .schemes import Scheme


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
    """

    block: Array
    matrices: Array
    loads: Array

    def mobility(self, rows: Array) -> Array:
        """Return the displacement of every mode at the end of a step for unit forces on rows, shape (..., modes)."""
        size = self.matrices.shape[1]
        moved = self.block[at.LOAD] * rows
        moved[..., :size] = rows[..., :size] @ self.matrices[at.MOBILITY].T
        return np.asarray(moved)

    def free(self, position: Array, increment: Array) -> Array:
        """Return the next increments of motion without any force."""
        size = self.matrices.shape[1]
        moved = self.block[at.B] * increment - self.block[at.R] * position
        moved[:size] = self.matrices[at.KEPT] @ increment[:size] - self.matrices[at.STIFFNESS] @ position[:size]
        return np.asarray(moved)

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
        If the step is too long for coupled modes to answer an impulse in its own sense.
    """
    k = scheme.coefficients(arrays.angular_frequency, arrays.damping_rate, step)
    block = np.zeros((at.COEFFICIENT_ROWS, arrays.mode_count))
    block[at.B], block[at.R], block[at.LOAD] = k.b, k.r, k.load
    block[at.HALF_OVER_LOAD] = 0.5 / block[at.LOAD]
    block[at.HALF_LOSS] = (1.0 - k.b) / 2.0
    size = arrays.coupled
    matrices, loads = np.zeros((at.MATRICES, size, size)), arrays.loads * k.load
    if size:
        c = scheme.coupled_coefficients(arrays.stiffness, arrays.dissipation, step)
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
    return Recurrence(block, matrices, loads)


def _symmetric(matrix: Array) -> Array:
    return np.asarray(0.5 * (matrix + matrix.T))


@dataclass(frozen=True)
class ContactBlocks:
    """The contacts as the march reads them.

    Attributes
    ----------
    constants : ndarray, shape (contacts, constants)
        Numbers of each contact.
    laws : ndarray, shape (contacts, parameters)
        Parameters of its law of friction.
    spans : ndarray, shape (contacts, spans)
        Spans of modes that each contact sees.
    half_waves : ndarray, shape (2, modes)
        Where the sines of the modes of plates lie, by their half-waves along the two sides.
    shares : ndarray, shape (4, modes)
        What products of sines and cosines give of the modes in the plane of plates.
    rows : ndarray, shape (contacts, 2, modes)
        Rows along normal and tangent; harmonic spans are filled by the march.
    compliance : ndarray, shape (2 contacts, 2 contacts)
        Relative displacements [m] of the fixed rows for unit forces on each.
    """

    constants: Array
    laws: Array
    spans: Array
    half_waves: Array
    shares: Array
    rows: Array
    compliance: Array


def contact_blocks(arrays: Assembly, modes: Recurrence) -> ContactBlocks:
    """Return the contacts as the march reads them."""
    count = len(arrays.contacts)
    constants, laws = np.zeros((count, at.CONTACT_CONSTANTS)), np.zeros((count, at.LAW_PARAMETERS))
    # Unsigned, so that the march need not look for indices below zero.
    spans = np.zeros((count, at.SPANS), dtype=np.uint64)
    rows = np.array([contact.fixed for contact in arrays.contacts])
    half_waves, shares = np.zeros((2, arrays.mode_count), dtype=np.uint64), np.zeros((4, arrays.mode_count))
    for i, one in enumerate(arrays.contacts):
        used = np.flatnonzero(one.fixed.any(axis=0))
        fixed = (used[0], used[-1] + 1) if used.size else (0, 0)
        spans[i, : at.WAVES] = (*fixed, *one.bending, *one.axial)
        constants[i, [at.START, at.GAP]] = one.contact.at, one.contact.gap
        if isinstance(one.contact.track, Track):
            constants[i, at.LOW :], spans[i, at.WAVES :] = _waves(one.contact.track)
        if isinstance(one.contact.track, ModalPlate):
            plate, in_plane = one.contact.track, slice(*one.axial)
            half_waves[:, slice(*one.bending)] = plate.numbers.T - 1
            numbers = plate.in_plane_numbers.T
            half_waves[:, in_plane] = np.where(numbers == 0, 2 * arrays.mode_count, numbers - 1)
            shares[:, in_plane] = plate.in_plane_shares
        constants[i, at.LAW], laws[i] = _law(one.contact.friction)
        if not one.fixed[0].any() and one.bending[0] == one.bending[1]:
            raise ArgumentError(
                f"contact {one.contact.name or i + 1}",
                "be between bodies of which one moves along its normal",
                got="a tip that does not",
            )
    flat = rows.reshape(2 * count, -1)
    compliance = np.ascontiguousarray(flat @ modes.mobility(flat).T)
    return ContactBlocks(constants, laws, spans, half_waves, shares, rows, compliance)


def _waves(track: Track) -> tuple[tuple[float, ...], tuple[int, int]]:
    """Return the constants of a track that the tip moves along, and how many half-waves its modes have."""
    if not isinstance(track, ModalPlate):
        return (*track.ends, 0.0, np.pi / track.length, 0.0, 0.0, track.amplitude), (max(track.harmonics), 0)
    (x, y), (cosine, sine) = track.track_line.origin, track.track_line.tangent
    along, across = np.pi / track.length, np.pi / track.width
    most = np.concatenate([track.numbers, track.in_plane_numbers]).max(axis=0)
    return (*track.ends, along * x, along * cosine, across * y, across * sine, track.amplitude), (most[0], most[1])


def _law(law: FrictionLaw) -> tuple[int, Array]:
    """Return the code of a law of friction and its parameters, the state of a new contact last."""
    found, own = np.zeros(at.LAW_PARAMETERS), list(law.parameters().values())
    found[: len(own)], found[-1] = own, law.state_at_landing
    return getattr(at, law.kernel_code), found


@dataclass(frozen=True)
class ProbeBlocks:
    """The probes as the march reads them.

    Attributes
    ----------
    kinds : ndarray, shape (probes,)
        Whether each sees positions, centred velocities or second differences.
    rows : ndarray, shape (probes, 3, modes)
        Rows on positions, sums and differences of increments, all but that of its kind zero.
    spans : ndarray, shape (probes, 3, 2)
        Modes that each row sees.
    direct : ndarray, shape (probes, signals)
        Shares of the signals.
    contact : ndarray, shape (probes, contacts, 2)
        Shares of the normal and tangential forces.
    """

    kinds: Array
    rows: Array
    spans: Array
    direct: Array
    contact: Array

    @property
    def row(self) -> Array:
        """The row of each probe, shape (probes, modes)."""
        return np.asarray(self.rows.sum(axis=1))


def probe_blocks(arrays: Assembly, step: float) -> ProbeBlocks:
    """Return the probes as the march reads them."""
    count = len(arrays.probes)
    rows = np.zeros((count, 3, arrays.mode_count))
    spans = np.zeros((count, 3, 2), dtype=np.uint64)
    direct = np.zeros((count, len(arrays.signals)))
    contact = np.zeros((count, len(arrays.contacts), 2))
    scale = np.array([1.0, 0.5 / step, 1.0 / step**2])
    for p, probe in enumerate(arrays.probes):
        rows[p] = probe.rows * scale[:, None]
        direct[p], contact[p] = probe.direct, probe.contact
        for kind in range(3):
            used = np.flatnonzero(rows[p, kind])
            if used.size:
                spans[p, kind] = used[0], used[-1] + 1
    kinds = np.argmax(rows.any(axis=2), axis=1).astype(np.int64)
    return ProbeBlocks(kinds, rows, spans, direct, contact)


@dataclass(frozen=True)
class Blocks:
    """A system under a scheme as the march reads it.

    Attributes
    ----------
    modes : Recurrence
        The recurrence of the modes.
    contacts : ContactBlocks
        The contacts.
    probes : ProbeBlocks
        The probes.
    """

    modes: Recurrence
    contacts: ContactBlocks
    probes: ProbeBlocks

    @property
    def is_simple(self) -> bool:
        """Whether there is one contact, between bodies of uncoupled modes, and not on a plate."""
        on_a_plate = self.contacts.spans[:, at.CROSS_WAVES].any()
        return len(self.contacts.constants) == 1 and not self.modes.matrices.size and not on_a_plate

    @cached_property
    def heard(self) -> tuple[int, ...]:
        """Signals that a load or a probe takes; the others need not be known."""
        taken = np.flatnonzero(self.probes.direct.any(axis=0))
        return tuple(sorted({*range(len(self.modes.loads)), *(int(j) for j in taken)}))


def blocks_of(arrays: Assembly, scheme: Scheme, step: float) -> Blocks:
    """Return a system under a scheme as the march reads it."""
    modes = recurrence(arrays, scheme, step)
    return Blocks(modes, contact_blocks(arrays, modes), probe_blocks(arrays, step))
