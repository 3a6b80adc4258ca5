"""A system as flat arrays of modes, contact rows, loads and probe rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..ordinary import of_ordinary_size
from ..records.probes import Probe
from ..system import System
from .contact_rows import ContactRows, contact_rows
from .coordinates import Coordinates, are_uncoupled
from .loads import Load, loads_of
from .motion import Prescribed, motion_of, prescribed_of
from .own_laws import check_law
from .probe_rows import probe_rows
from .probed import ProbeRows
from .signals import Signal, Signals
from .springs import SpringRows, spring_rows
from .turning_modes import TurningModes, turning_modes


@dataclass(frozen=True)
class Assembly:
    """A system as flat arrays, body by body, bodies with coupled modes first.

    Attributes
    ----------
    angular_frequency, damping_rate : ndarray, shape (modes,)
        Undamped angular frequencies w [rad/s] and ``2 zeta w`` [1/s]; zero for coupled modes.
    massless : ndarray of bool, shape (modes,)
        Mask of the residual shapes, of unit stiffness and no mass, and of coordinates that move nothing.
    shapes_of_bodies : ndarray of bool, shape (modes,)
        Mask of the residual shapes among the coordinates of the bodies, which rigid joints mix.
    rigid : ndarray of bool, shape (modes,)
        Mask of the rigid motions of the bodies, one by one or joined by rigid joints.
    lumped : ndarray of bool, shape (modes,)
        Mask of the motions of lumped bodies, and of the rigid motions of others.
    stiffness, dissipation : ndarray, shape (coupled, coupled)
        Stiffness [1/s²] and damping matrix [1/s] of the coupled modes, which come first.
    contacts : list of ContactRows
        One for each contact.
    motion : callable
        Motions imposed on the contacts [m] as a function of time and step: of the tip and of the track along the
        tangents, of the gap; shape (times, contacts, motions).
    loads : ndarray, shape (loads, modes)
        Modal forces of the drives for a unit signal.
    signals : Signals
        Factors of the loads, and the motion imposed on a root.
    springs : SpringRows
        Nonlinear springs.
    position, velocity : ndarray, shape (modes,)
        Modal positions and velocities at the start.
    friction_state : ndarray, shape (contacts, 2)
        Internal states of the friction laws at the start; only vectors have the latter.
    probes : list of ProbeRows
        One for each probe.
    prescribed : Prescribed
        Descriptions that determine signals and motion over time.
    spans : dict
        First mode of each body and end of its range, by the body's name.
    relaxing : tuple of int
        First of the inner motions of viscoelastic springs, and end of their range.
    blend : ndarray, shape (joined, joined)
        Matrix from the first coordinates to those of joined bodies, if they have residual shapes or rigid joints; else
        empty.
    turning : tuple of TurningModes
        Bodies that turn, or round which contacts move.
    """

    angular_frequency: Array
    damping_rate: Array
    massless: Array
    shapes_of_bodies: Array
    rigid: Array
    lumped: Array
    stiffness: Array
    dissipation: Array
    contacts: list[ContactRows]
    motion: Signal
    loads: Array
    signals: Signals
    springs: SpringRows
    position: Array
    velocity: Array
    friction_state: Array
    probes: list[ProbeRows]
    prescribed: Prescribed
    spans: dict[str, tuple[int, int]]
    relaxing: tuple[int, int]
    blend: Array
    turning: tuple[TurningModes, ...]

    @property
    def all_stiffness(self) -> Array:
        """Stiffness matrix of all modes [1/s²], shape (modes, modes)."""
        matrix = np.diag(np.where(self.massless, 1.0, self.angular_frequency) ** 2)
        matrix[: self.coupled, : self.coupled] = self.stiffness
        return matrix

    @property
    def mode_count(self) -> int:
        """Number of modes in all."""
        return int(self.angular_frequency.size)

    @property
    def coupled(self) -> int:
        """Number of coupled modes."""
        return len(self.stiffness)


@of_ordinary_size("system")
def assemble(system: System, probes: Sequence[Probe] = ()) -> Assembly:
    """Return a system and its probes as flat arrays; those of the system are cached and must not be changed."""
    if "assembly" not in system.kept:
        system.kept["assembly"] = _assembled(system)
    flat, coordinates, loads = system.kept["assembly"]
    rows = [one for probe in probes for one in probe_rows(probe, coordinates, loads)]
    return replace(flat, probes=rows) if rows else flat


def _assembled(system: System) -> tuple[Assembly, Coordinates, list[Load]]:
    """Return a system as flat arrays without probes, with the coordinates and loads for those of probes."""
    _check_laws(system)
    coordinates = Coordinates(system)
    stiffness, dissipation = coordinates.matrices
    modes = [coordinates.modes(body) for body in coordinates.order]
    angular = np.concatenate([one.angular_frequency for one in modes])
    rate = np.concatenate([one.damping_rate for one in modes])
    massless, size = coordinates.massless, len(stiffness)
    if size and are_uncoupled(stiffness, dissipation):
        angular[:size] = np.where(massless[:size], np.inf, np.sqrt(np.diag(stiffness)))
        rate[:size] = np.diag(dissipation)
        size = 0
    # Coupled modes march with matrices; their own coefficients are zero.
    angular[:size] = rate[:size] = 0.0
    loads, signals, histories = loads_of(system, coordinates)
    position, velocity = _start(system, coordinates)
    turning = turning_modes(coordinates)
    flat = Assembly(
        angular_frequency=angular,
        damping_rate=rate,
        massless=massless,
        shapes_of_bodies=coordinates.shapes_of_bodies,
        rigid=coordinates.rigid,
        lumped=coordinates.lumped,
        stiffness=stiffness[:size, :size],
        dissipation=dissipation[:size, :size],
        contacts=[contact_rows(contact, coordinates, turning) for contact in system.contacts],
        motion=motion_of(system, signals.displacement),
        loads=np.array([load.modal for load in loads]).reshape(len(loads), coordinates.size),
        signals=signals,
        springs=spring_rows(coordinates),
        position=position,
        velocity=velocity,
        friction_state=np.array([one.law.states_at_start for one in system.contacts]),
        probes=[],
        prescribed=prescribed_of(system, histories),
        spans={system.body_name(body): coordinates.spans[body] for body in system.bodies},
        relaxing=coordinates.relaxing_span,
        blend=coordinates.blend,
        turning=turning,
    )
    return flat, coordinates, loads


def _check_laws(system: System) -> None:
    """Raise ValueError if the friction law of a contact is not the one that is marched."""
    first = {id(contact.friction): number for number, contact in reversed(list(enumerate(system.contacts)))}
    for number in first.values():
        try:
            check_law(system.contacts[number].friction)
        except ArgumentError as error:
            raise error.inside(system.contact_names[number]) from None


def with_travel(arrays: Assembly, system: System, travel: float) -> Assembly:
    """Return a system whose root has already moved by a distance [m] in addition to its imposed velocity."""
    described = arrays.signals.displacement

    def displacement(time: Array, step: float) -> Array:
        return described(time, step) + travel

    signals = replace(arrays.signals, displacement=displacement)
    return replace(arrays, signals=signals, motion=motion_of(system, displacement))


def with_motion_so_far(arrays: Assembly, offset: Array, start: float, before: Array | None = None) -> Assembly:
    """Return a system whose contacts have already moved in addition to their imposed motion.

    Parameters
    ----------
    arrays : Assembly
        The system.
    offset : ndarray, shape (contacts, motions)
        Additional displacement [m].
    start : float
        Time from which it applies [s].
    before : ndarray, shape (contacts, motions), optional
        Imposed displacements before that time [m], if they differ.
    """
    described = arrays.motion

    def motion(time: Array, step: float) -> Array:
        values = described(time, step) + offset
        if before is not None:
            values[time < start - step / 2.0] = before
        return values

    return replace(arrays, motion=motion, prescribed=replace(arrays.prescribed, turns=before is not None))


def _start(system: System, coordinates: Coordinates) -> tuple[Array, Array]:
    """Return modal positions and velocities at the start."""
    position, velocity = np.zeros(coordinates.size), np.zeros(coordinates.size)
    for drive in system.drives:
        if drive.uniform_velocity is not None:
            # Residual shapes have no velocity: they depend on forces alone.
            modes = coordinates.modes(drive.acted_on)
            speeds = drive.uniform_velocity[: len(modes.translation)]
            moved = np.where(modes.massless, 0.0, speeds @ modes.translation)
            velocity += coordinates.full(drive.acted_on, moved)
        for name, given in drive.vectors.items():
            values = {"displacement": position, "velocity": velocity}[name]
            values += coordinates.full(drive.acted_on, drive.acted_on.modal_coordinates(given))
    return coordinates.start(position), coordinates.start(velocity)
