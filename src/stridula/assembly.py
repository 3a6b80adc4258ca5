"""The only bridge: a system becomes flat arrays of modes, traces, loads and probe rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .bodies import BodyPoint, FiniteElementBeam, ModalBeam
from .bodies.modes import Array
from .drives import Force, Gravity, ImposedVelocity, InitialVelocity
from .histories import Constant, History
from .records.probes import Acceleration, Displacement, Probe, Reaction, Velocity
from .system import System

Signal = Callable[[Array, float], Array]


@dataclass(frozen=True)
class ProbeRows:
    """What gives one probe: rows on modal motion, and shares of the signals and of the contact forces.

    Attributes
    ----------
    rows : ndarray, shape (3, modes)
        Rows on q, q' and q''.
    direct : ndarray, shape (signals,)
        Shares of the signals.
    contact : ndarray, shape (2,)
        Shares of the normal and of the tangential force.
    """

    rows: Array
    direct: Array
    contact: Array


@dataclass(frozen=True)
class Assembly:
    """A system as flat arrays: the slider's modes first, then the track's bending modes, then its axial ones.

    Attributes
    ----------
    sizes : tuple of int
        Numbers of slider modes, bending and axial modes of the track.
    angular_frequency, damping : ndarray, shape (modes,)
        Undamped angular frequencies [rad/s] and damping ratios.
    tip : ndarray, shape (2, slider modes)
        World displacement of the tip.
    loads : ndarray, shape (loads, modes)
        Modal forces of the drives for a unit signal.
    signals : list of callable
        Functions of time and step [s]: first one for each row of `loads`, then the imposed displacement, velocity and
        acceleration.
    imposed : callable
        Displacement imposed on the slider [m] over time and step [s].
    velocity : ndarray, shape (modes,)
        Modal velocities at the start.
    probes : list of ProbeRows
        One for each probe.
    """

    sizes: tuple[int, int, int]
    angular_frequency: Array
    damping: Array
    tip: Array
    loads: Array
    signals: list[Signal]
    imposed: Signal
    velocity: Array
    probes: list[ProbeRows]

    @property
    def mode_count(self) -> int:
        """Number of modes in all."""
        return int(self.angular_frequency.size)


def assemble(system: System, probes: Sequence[Probe] = ()) -> Assembly:
    """Turn a system and its probes into flat arrays."""
    held = system.imposed_velocity is not None
    slider, track = system.slider.modes(held), system.track.modes()
    sizes = (slider.count, *system.track.harmonics)
    rows = _Rows(system, held, slider.count, track.count)
    loads, signals = _loads(system, rows)
    return Assembly(
        sizes=sizes,
        angular_frequency=np.concatenate([slider.angular_frequency, track.angular_frequency]),
        damping=np.concatenate([slider.damping, track.damping]),
        tip=system.slider.trace(system.contact.tip.position, held),
        loads=np.array([load.modal for load in loads]).reshape(len(loads), slider.count + track.count),
        signals=signals,
        imposed=signals[-3],
        velocity=_initial_velocity(system, rows),
        probes=[_probe(probe, rows, loads) for probe in probes],
    )


@dataclass(frozen=True)
class _Rows:
    """Full-width rows of points of either body."""

    system: System
    held: bool
    slider_modes: int
    track_modes: int

    def trace(self, point: BodyPoint) -> Array:
        """Return the rows of the world displacement at a point, shape (2, modes)."""
        full = np.zeros((2, self.slider_modes + self.track_modes))
        if point.body == self.system.slider:
            full[:, : self.slider_modes] = self.system.slider.trace(point.position, self.held)
        else:
            full[:, self.slider_modes :] = self.system.track.trace(point.position)
        return full

    def translation(self, body: FiniteElementBeam | ModalBeam) -> Array:
        """Return what a uniform acceleration of a body along x and y drives, shape (2, modes)."""
        full = np.zeros((2, self.slider_modes + self.track_modes))
        if body == self.system.slider:
            full[:, : self.slider_modes] = self.system.slider.modes(self.held).translation
        else:
            full[:, self.slider_modes :] = self.system.track.modes().translation
        return full


@dataclass
class _Load:
    """Modal forces of one signal, and its balance about the slider's root: along x and y [N], moment [N m]."""

    modal: Array
    root: Array


def _factor(history: History) -> Signal:
    return lambda time, step: history.factor(time)


def _loads(system: System, rows: _Rows) -> tuple[list[_Load], list[Signal]]:
    """Return the loads, drives of the same history together, and the signals."""
    by_history: dict[History, _Load] = {}

    def add(history: History, modal: Array, root: Array) -> None:
        if history in by_history:
            by_history[history].modal += modal
            by_history[history].root += root
        else:
            by_history[history] = _Load(modal, root)

    reaction = system.slider.root_reaction(rows.held)
    for drive in system.drives:
        if isinstance(drive, Force):
            add(drive.history, *_force(drive.point, _components(drive), rows))
        elif isinstance(drive, ImposedVelocity):
            add(Constant(), *_force(drive.point, np.array([0.0, -drive.normal_load]), rows))
        elif isinstance(drive, Gravity):
            for body in (system.slider, system.track):
                own = -drive.acceleration * reaction.inertia[:, 1] * (body == system.slider)
                add(Constant(), -drive.acceleration * rows.translation(body)[1], own)
    felt = {history: load for history, load in by_history.items() if load.modal.any() or load.root.any()}
    loads = list(felt.values())
    signals = [_factor(history) for history in felt]

    imposed = system.imposed_velocity
    history, velocity = (imposed.history, imposed.velocity) if imposed else (Constant(), 0.0)

    def displacement(time: Array, step: float) -> Array:
        return velocity * history.integral(time)

    def speed(time: Array, step: float) -> Array:
        return velocity * history.factor(time)

    def acceleration(time: Array, step: float) -> Array:
        # A difference, not the rate: its impulses add up to the change of velocity, kinks or not.
        return velocity * (history.factor(time + step / 2.0) - history.factor(time - step / 2.0)) / step

    if imposed and not isinstance(history, Constant):
        loads.append(_Load(-rows.translation(system.slider)[0], -reaction.inertia[:, 0]))
        signals.append(acceleration)
    return loads, [*signals, displacement, speed, acceleration]


def _components(force: Force) -> Array:
    """Return the world components of a force [N], shape (2,)."""
    along, across = force.point.body.axes  # type: ignore[attr-defined]
    return force.axial * along + force.transverse * across + np.array([force.x, force.y])


def _force(point: BodyPoint, components: Array, rows: _Rows) -> tuple[Array, Array]:
    slider = rows.system.slider
    root = slider.root_lever(point.position) @ components if point.body == slider else np.zeros(3)
    return components @ rows.trace(point), root


def _initial_velocity(system: System, rows: _Rows) -> Array:
    velocity = np.zeros(rows.slider_modes + rows.track_modes)
    for drive in system.drives:
        if isinstance(drive, InitialVelocity):
            velocity += np.array([drive.x, drive.y]) @ rows.translation(drive.body)
    return velocity


def _probe(probe: Probe, rows: _Rows, loads: list[_Load]) -> ProbeRows:
    body = probe.body if isinstance(probe, Reaction) else probe.point.body
    allowed = (rows.system.slider,) if isinstance(probe, Reaction) else (rows.system.slider, rows.system.track)
    if body not in allowed:
        words = "slider" if isinstance(probe, Reaction) else "slider or the track"
        raise ValueError(f"probe must be on the {words} of this system, got {probe!r}")
    direct = np.zeros(len(loads) + 3)
    if isinstance(probe, Reaction):
        return _reaction_rows(probe, rows, loads, direct)
    kind = (Displacement, Velocity, Acceleration).index(type(probe))
    along, across = probe.point.body.axes  # type: ignore[attr-defined]
    direction = {"x": np.array([1.0, 0.0]), "y": np.array([0.0, 1.0]), "axial": along, "transverse": across}
    unit = direction[probe.direction]
    matrix = np.zeros((3, rows.slider_modes + rows.track_modes))
    matrix[kind] = unit @ rows.trace(probe.point)
    if probe.point.body == rows.system.slider:
        direct[len(loads) + kind] = unit[0]
    return ProbeRows(matrix, direct, np.zeros(2))


def _reaction_rows(probe: Reaction, rows: _Rows, loads: list[_Load], direct: Array) -> ProbeRows:
    component = ("x", "y", "moment").index(probe.component)
    if probe.body.tip_support != "free":
        raise ValueError(f"tip_support must be free where a Reaction is recorded, got {probe.body.tip_support!r}")
    reaction = rows.system.slider.root_reaction(rows.held)
    matrix = np.zeros((3, rows.slider_modes + rows.track_modes))
    matrix[2, : rows.slider_modes] = reaction.mass[component]
    direct[: len(loads)] = [-reaction.held[component] * load.root[component] for load in loads]
    # The contact pushes the slider with (-tangential, normal).
    lever = rows.system.slider.root_lever(rows.system.contact.tip.position)[component]
    return ProbeRows(matrix, direct, reaction.held[component] * np.array([-lever[1], lever[0]]))
