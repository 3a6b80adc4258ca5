"""The only bridge: a system becomes flat arrays of modes, traces, loads and probe rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, singledispatch
from typing import Any

import numpy as np

from .arrays import Array
from .bodies import BodyPoint, has_root
from .bodies.modes import Modes
from .bodies.ordinary import check_coupled_count, of_ordinary_size
from .bodies.turning import Turning
from .checks import ArgumentError, brief
from .connections import ends, pushes, unit
from .contact import PointContact
from .histories import Constant, History
from .records.probes import Probe, Reaction, SupportForce
from .system import System

Signal = Callable[[Array, float], Array]
# Off-diagonal terms, relative to the diagonal ones, below which modes are not coupled.
UNCOUPLED = 1e-13


@dataclass(frozen=True)
class ProbeRows:
    """What gives one probe: rows on modal motion, and shares of the signals and of the contact forces.

    Attributes
    ----------
    rows : ndarray, shape (3, modes)
        Rows on q, q' and q''.
    direct : ndarray, shape (signals,)
        Shares of the signals.
    contact : ndarray, shape (contacts, 2)
        Shares of the normal and of the tangential force of each contact.
    """

    rows: Array
    direct: Array
    contact: Array


@dataclass(frozen=True)
class TurningModes:
    """The modes of a body that turns.

    Attributes
    ----------
    turning : Turning
        How it turns.
    pairs : ndarray of int, shape (pairs, 2)
        Numbers of the modes of each pair.
    span : tuple of int
        First mode of the body and the one after its last.
    has_circle : bool
        Whether a contact moves round it.
    """

    turning: Turning
    pairs: Array
    span: tuple[int, int] = (0, 0)
    has_circle: bool = False

    @property
    def orders(self) -> Array:
        """Number of waves round the axis of each pair, shape (pairs,)."""
        return np.array(self.turning.order)

    @property
    def others(self) -> Array:
        """Numbers of the modes of the body that are the same all round."""
        return np.setdiff1d(np.arange(*self.span), self.pairs)

    def turned(self, modal: Array, by: Array) -> Array:
        """Return what turning pairs by angles [rad], shape (pairs,), adds to numbers of the modes, shape (modes,)."""
        (first, second), added = self.pairs.T, np.zeros_like(modal)
        sine, versine = np.sin(by), 2.0 * np.sin(0.5 * by) ** 2
        added[first] = -versine * modal[first] - sine * modal[second]
        added[second] = sine * modal[first] - versine * modal[second]
        return added


@dataclass(frozen=True)
class ContactRows:
    """One contact as rows on the modes; in space two pairs of rows in a row.

    Attributes
    ----------
    contact : PointContact
        The contact.
    fixed : ndarray, shape (2, modes)
        Displacement of the tip, less that of a frozen track, along normal and tangent.
    bending, axial : tuple of int
        First mode and the one after the last of each kind of a track that the tip moves along.
    is_second : bool
        Whether the tangent is the second of a contact in space; the normal is zero then.
    circle : TurningModes or None
        The modes of the body round which the tip moves; its rows in `fixed` are those where the tip is at the start.
    """

    contact: PointContact
    fixed: Array
    bending: tuple[int, int] = (0, 0)
    axial: tuple[int, int] = (0, 0)
    is_second: bool = False
    circle: TurningModes | None = None

    @property
    def travel(self) -> Array:
        """Row of what moves the contact point along the tangent, shape (modes,): on a circle that of the tip alone."""
        if self.circle is None:
            return self.fixed[1]
        row = self.fixed[1].copy()
        row[slice(*self.circle.span)] = 0.0
        return row

    def round_at(self, place: float) -> Array:
        """Return the rows where the tip is at an abscissa [m] of its circle."""
        assert self.circle is not None
        angle = (place - self.contact.at) * self.rate
        return self.fixed + [self.circle.turned(row, angle * self.circle.orders) for row in self.fixed]

    def slopes_round_at(self, place: float) -> Array:
        """Return the derivatives of these rows along the circle [1/m], shape (2, modes)."""
        assert self.circle is not None
        rows, (first, second) = self.round_at(place), self.circle.pairs.T
        slopes = np.zeros_like(rows)
        slopes[:, first] = -self.rate * self.circle.orders * rows[:, second]
        slopes[:, second] = self.rate * self.circle.orders * rows[:, first]
        return slopes

    @property
    def rate(self) -> float:
        """Angle about the axis for a distance along the circle [rad/m]."""
        assert self.contact.circle is not None
        return 1.0 / self.contact.circle.radius

    @property
    def at(self) -> float:
        """Abscissa along the tangent at the start [m]."""
        return 0.0 if self.is_second else self.contact.at

    @property
    def gap(self) -> float:
        """Gap at the start [m]."""
        return 0.0 if self.is_second else self.contact.gap


@dataclass(frozen=True)
class Assembly:
    """A system as flat arrays, body by body, those whose modes are coupled first.

    Attributes
    ----------
    angular_frequency, damping_rate : ndarray, shape (modes,)
        Undamped angular frequencies w [rad/s] and ``2 zeta w`` [1/s]; zero for coupled modes.
    massless : ndarray of bool, shape (modes,)
        Which are residual shapes, of unit stiffness and no mass.
    stiffness, dissipation : ndarray, shape (coupled, coupled)
        Stiffness [1/s²] and damping matrix [1/s] of the coupled modes, which come first.
    contacts : list of ContactRows
        One for each contact, and another one after it for its second tangent in space: pairs of rows.
    motion : callable
        Motions imposed on the contacts [m] over time and step: of the tip and of the track along the tangent, of the
        gap; shape (times, pairs, 3).
    loads : ndarray, shape (loads, modes)
        Modal forces of the drives for a unit signal.
    signals : list of callable
        Functions of time and step [s]: first one for each row of `loads`, then the imposed displacement, velocity and
        acceleration.
    position, velocity : ndarray, shape (modes,)
        Modal positions and velocities at the start.
    friction_state : ndarray, shape (pairs,)
        Internal states of the laws of friction at the start.
    probes : list of ProbeRows
        One for each probe.
    prescribed : Prescribed
        What decides how signals and motion go in time.
    spans : dict
        First mode of each body and the one after its last, by the body's name.
    blend : ndarray, shape (joined, joined)
        How the first coordinates make those of joined bodies, whose residual shapes connections hold; empty without.
    turning : tuple of TurningModes
        The bodies that turn, or round which contacts move.
    """

    angular_frequency: Array
    damping_rate: Array
    massless: Array
    stiffness: Array
    dissipation: Array
    contacts: list[ContactRows]
    motion: Signal
    loads: Array
    signals: list[Signal]
    position: Array
    velocity: Array
    friction_state: Array
    probes: list[ProbeRows]
    prescribed: Prescribed
    spans: dict[str, tuple[int, int]]
    blend: Array
    turning: tuple[TurningModes, ...]

    @property
    def all_stiffness(self) -> Array:
        """Stiffness matrix of all modes [1/s²], shape (modes, modes)."""
        matrix = np.diag(np.where(self.massless, 1.0, self.angular_frequency) ** 2)
        matrix[: self.coupled, : self.coupled] = self.stiffness
        return matrix

    @property
    def firsts(self) -> Array:
        """Which pairs of rows are the first of their contact, shape (pairs,)."""
        return np.array([not one.is_second for one in self.contacts])

    @property
    def contact_numbers(self) -> Array:
        """Number of the contact that each pair of rows belongs to, shape (pairs,)."""
        return np.cumsum(self.firsts) - 1

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
    """Turn a system and its probes into flat arrays; those of the system are made once, and not to be changed."""
    if "assembly" not in system.kept:
        system.kept["assembly"] = _assembled(system)
    flat, layout, loads = system.kept["assembly"]
    return replace(flat, probes=[_probe(probe, layout, loads) for probe in probes]) if probes else flat


def _assembled(system: System) -> tuple[Assembly, _Layout, list[_Load]]:
    """Return a system as flat arrays without probes, and what these are made of."""
    layout = _Layout(system)
    stiffness, dissipation = layout.matrices
    modes = [layout.modes(body) for body in layout.order]
    angular = np.concatenate([one.angular_frequency for one in modes])
    rate = np.concatenate([one.damping_rate for one in modes])
    massless, size = layout.massless, len(stiffness)
    if size and _uncoupled(stiffness, dissipation):
        angular[:size] = np.where(massless[:size], np.inf, np.sqrt(np.diag(stiffness)))
        rate[:size] = np.diag(dissipation)
        size = 0
    # Coupled modes march by matrices; alone they would not.
    angular[:size] = rate[:size] = 0.0
    loads, signals, histories = _loads(system, layout)
    position, velocity = _start(system, layout)
    turning = _turning(layout)
    flat = Assembly(
        angular_frequency=angular,
        damping_rate=rate,
        massless=massless,
        stiffness=stiffness[:size, :size],
        dissipation=dissipation[:size, :size],
        contacts=[pair for contact in system.contacts for pair in _contact(contact, layout, turning)],
        motion=_motion(system, signals[-3]),
        loads=np.array([load.modal for load in loads]).reshape(len(loads), layout.size),
        signals=signals,
        position=position,
        velocity=velocity,
        friction_state=np.array(
            [state for one in system.contacts for state in one.friction.states_at_start[: _pairs(one)]]
        ),
        probes=[],
        prescribed=_prescribed(system, histories),
        spans={system.body_name(body): layout.spans[body] for body in system.bodies},
        blend=layout.blend,
        turning=turning,
    )
    return flat, layout, loads


def with_travel(arrays: Assembly, system: System, travel: float) -> Assembly:
    """Return a system whose root has already been moved by a distance [m] beyond what its imposed velocity says."""
    described = arrays.signals[-3]

    def displacement(time: Array, step: float) -> Array:
        return described(time, step) + travel

    signals = [*arrays.signals[:-3], displacement, *arrays.signals[-2:]]
    return replace(arrays, signals=signals, motion=_motion(system, displacement))


def going_on(arrays: Assembly, offset: Array, start: float, before: Array | None = None) -> Assembly:
    """Return a system whose contacts have already been moved beyond what is imposed on them.

    Parameters
    ----------
    arrays : Assembly
        The system.
    offset : ndarray, shape (contacts, 3)
        By how much [m].
    start : float
        Time from which that holds [s].
    before : ndarray, shape (contacts, 3), optional
        Where they were before [m], if that was other motion.
    """
    described = arrays.motion

    def motion(time: Array, step: float) -> Array:
        values = described(time, step) + offset
        if before is not None:
            values[time < start - step / 2.0] = before
        return values

    return replace(arrays, motion=motion, prescribed=replace(arrays.prescribed, turns=before is not None))


@dataclass(frozen=True)
class Prescribed:
    """What decides how signals and motions go in time: systems that share it have the same.

    Attributes
    ----------
    histories : tuple of History
        Histories of the loads.
    velocity : tuple of float and History, or None
        The imposed velocity.
    contacts : tuple
        For each contact its frame, whether its tip and its track are held, its rigid track, and velocities of the
        surface that it touches.
    turning : tuple of Turning
        How bodies turn.
    turns : bool
        Whether it goes on from other motions.
    """

    histories: tuple[History, ...]
    velocity: tuple[float, History] | None
    contacts: tuple[Any, ...]
    turning: tuple[Turning, ...] = ()
    turns: bool = False

    @property
    def is_steady(self) -> bool:
        """Whether nothing varies in time."""
        still = all((track is None or track.is_still) and not any(moved) for *_, track, moved in self.contacts)
        return (
            still
            and not self.turns
            and self.velocity is None
            and all(type(one.history) is Constant for one in self.turning)
            and all(type(history) is Constant for history in self.histories)
        )


def _prescribed(system: System, histories: tuple[History, ...]) -> Prescribed:
    contacts = []
    for contact in system.contacts:
        held = system.is_held(contact.tip.body), _touches_held(contact, system)
        passing = [speed for turning, speeds in contact.turning_velocities for speed in (turning.history, *speeds)]
        if contact.circle is not None and contact.circle.velocity:
            passing += [contact.circle.history, contact.circle.velocity]
        moved = (*contact.surface_velocities, *passing)
        contacts.append((contact.frame.tobytes(), *held, contact.rigid_track, moved))
    imposed = system.imposed_velocity
    bodies = [body.modes().turning for body in system.bodies if not system.is_held(body)]
    turning = tuple(one for one in bodies if one is not None)
    return Prescribed(histories, (imposed.velocity, imposed.history) if imposed else None, tuple(contacts), turning)


def _touches_held(contact: PointContact, system: System) -> bool:
    """Return whether a contact is against a point of a body whose root follows an imposed velocity."""
    return contact.touched_point is not None and system.is_held(contact.touched_point.body)


@dataclass(frozen=True)
class _Layout:
    """Where the modes of each body lie, and full-width rows of its points."""

    system: System
    # By the body itself: comparing bodies takes longer than anything that is asked of them here.
    known: dict[int, Modes] = field(default_factory=dict)

    @cached_property
    def joined(self) -> tuple[Any, ...]:
        """The bodies whose modes may be coupled: by connections, or by a damping matrix of their own."""
        named = [point.body for connection in self.system.connections for point in ends(connection)]
        bodies = self.system.bodies
        return tuple(body for body in bodies if body in named or self.modes(body).damping_matrix is not None)

    @cached_property
    def order(self) -> tuple[Any, ...]:
        """The bodies, joined ones first."""
        return (*self.joined, *(body for body in self.system.bodies if body not in self.joined))

    @cached_property
    def spans(self) -> dict[Any, tuple[int, int]]:
        """First mode of each body, and the one after its last."""
        found, start = {}, 0
        for body in self.order:
            found[body] = (start, start + self.modes(body).count)
            start = found[body][1]
        return found

    @cached_property
    def size(self) -> int:
        """Number of modes."""
        return max(end for _, end in self.spans.values())

    @cached_property
    def pairs(self) -> int:
        """Number of pairs of rows of all contacts."""
        return sum(map(_pairs, self.system.contacts))

    def modes(self, body: Any) -> Modes:
        """Return the modes of a body."""
        if id(body) not in self.known:
            self.known[id(body)] = body.modes(self.system.is_held(body))
        return self.known[id(body)]

    def full(self, body: Any, numbers: Array) -> Array:
        """Return numbers of a body's modes among those of all."""
        first, end = self.spans[body]
        out = np.zeros((*numbers.shape[:-1], self.size))
        out[..., first:end] = numbers
        return out

    def body_trace(self, point: BodyPoint) -> Array:
        """Return the rows of the world displacement at a point on the coordinates of the bodies, shape (3, modes).

        A body in the plane is rigid along z.
        """
        body: Any = point.body
        return _in_space(self.full(body, body.trace(point.position, self.system.is_held(body))))

    def blended(self, rows: Array) -> Array:
        """Return rows on the coordinates of the bodies as rows on those that march."""
        size = len(self.blend)
        rows[..., :size] = rows[..., :size] @ self.blend
        return rows

    def trace(self, point: BodyPoint) -> Array:
        """Return the rows of the world displacement at a point, shape (3, modes)."""
        return self.blended(self.body_trace(point))

    def translation(self, body: Any) -> Array:
        """Return what a uniform acceleration of a body along x, y and z drives, shape (3, modes)."""
        return self.blended(_in_space(self.full(body, self.modes(body).translation)))

    @cached_property
    def massless(self) -> Array:
        """Which modes are residual shapes."""
        return np.concatenate([self.modes(body).massless for body in self.order])

    @property
    def matrices(self) -> tuple[Array, Array]:
        """Stiffness and damping matrix of the modes of joined bodies, which come first."""
        return self._coupling[0], self._coupling[1]

    @property
    def blend(self) -> Array:
        """How the coordinates that march make those of joined bodies."""
        return self._coupling[2]

    @cached_property
    def _coupling(self) -> tuple[Array, Array, Array]:
        stiffness, dissipation = _matrices(self)
        return without_massless_coupling(stiffness, dissipation, self.massless[: len(stiffness)])


def _matrices(layout: _Layout) -> tuple[Array, Array]:
    """Return the stiffness and the damping matrix of the modes of joined bodies."""
    size = sum(layout.modes(body).count for body in layout.joined)
    check_coupled_count(size)
    stiffness, dissipation = np.zeros((size, size)), np.zeros((size, size))
    for body in layout.joined:
        modes, span = layout.modes(body), slice(*layout.spans[body])
        stiffness[span, span] = np.diag(modes.stiffness)
        own = np.diag(modes.damping_rate)
        dissipation[span, span] = own if modes.damping_matrix is None else modes.damping_matrix
    for connection in layout.system.connections:
        row = unit(connection) @ layout.body_trace(connection.first)[:, :size]
        if connection.second is not None:
            row = row - unit(connection) @ layout.body_trace(connection.second)[:, :size]
        for matrix, rate in zip((stiffness, dissipation), connection.rates, strict=True):
            if rate:
                matrix += rate * np.outer(row, row)
    return stiffness, dissipation


def without_massless_coupling(stiffness: Array, dissipation: Array, massless: Array) -> tuple[Array, Array, Array]:
    """Return stiffness and damping matrix in coordinates in which residual shapes stand alone, and their blend.

    Connections hold residual shapes, too: what follows the modes statically becomes part of these, what is left has
    unit stiffness. Damping acts on the modes and on what follows them.
    """
    if not massless.any():
        return stiffness, dissipation, np.eye(0)
    blend = np.eye(len(stiffness))
    moving = ~massless
    own, across = stiffness[np.ix_(massless, massless)], stiffness[np.ix_(massless, moving)]
    root = np.linalg.cholesky(own)
    blend[np.ix_(massless, moving)] = -np.linalg.solve(own, across)
    blend[np.ix_(massless, massless)] = np.linalg.inv(root).T
    stiffness, dissipation = blend.T @ stiffness @ blend, blend.T @ dissipation @ blend
    stiffness[massless] = dissipation[massless] = 0.0
    stiffness[:, massless] = dissipation[:, massless] = 0.0
    stiffness[massless, massless] = 1.0
    return 0.5 * (stiffness + stiffness.T), 0.5 * (dissipation + dissipation.T), blend


def _turning(layout: _Layout) -> tuple[TurningModes, ...]:
    found = []
    tracks = [contact.track_body for contact in layout.system.contacts if contact.circle is not None]
    for body in layout.order:
        turning = body.waves_round if body in tracks else layout.modes(body).turning
        if body in tracks:
            _check_round(layout, body, turning)
        if turning is not None and turning.pairs:
            span = layout.spans[body]
            found.append(TurningModes(turning, span[0] + np.array(turning.pairs), span, body in tracks))
    return tuple(found)


def _check_round(layout: _Layout, body: Any, turning: Any) -> None:
    """Raise unless a body is the same all round."""
    name, modes = layout.system.body_name(body), layout.modes(body)
    if not turning.pairs:
        raise ArgumentError("track", f"have waves round its axis: {name} has none below its cutoff", got="a circle")
    if body in layout.joined and len(layout.blend):
        words = f"leave {name}, round which a contact moves, where joined bodies have residual shapes"
        raise ArgumentError("connections", words, got="one to it")
    first, second = np.array(turning.pairs).T
    if (modes.damping_rate[first] != modes.damping_rate[second]).any():
        words = f"be the same for both modes of each pair of {name}, round which a contact moves"
        raise ArgumentError("damping", words, body.damping)


def _uncoupled(stiffness: Array, dissipation: Array) -> bool:
    """Return whether the modes are oscillators on their own after all."""
    return _is_diagonal(stiffness) and _is_diagonal(dissipation)


def _is_diagonal(matrix: Array) -> bool:
    diagonal = np.diag(matrix)
    scale = np.sqrt(np.outer(diagonal, diagonal))
    return bool(np.all(np.abs(matrix - np.diag(diagonal)) <= UNCOUPLED * scale))


def _in_space(rows: Array) -> Array:
    """Return rows along x, y and z of a body, which is rigid along z in the plane."""
    return rows if len(rows) == 3 else np.concatenate([rows, np.zeros((1, rows.shape[1]))])


def _pairs(contact: PointContact) -> int:
    """Return how many pairs of rows a contact has."""
    return len(contact.frame) - 1


def _contact(contact: PointContact, layout: _Layout, turning: tuple[TurningModes, ...]) -> list[ContactRows]:
    frame = contact.frame
    fixed = frame @ layout.trace(contact.tip)[: len(frame)]
    if contact.touched_point is not None:
        fixed = fixed - frame @ layout.trace(contact.touched_point)[: len(frame)]
    if contact.friction.depends_on_speed:
        # Without mass nothing holds the slip against friction that falls with its speed.
        fixed[1:, layout.massless] = 0.0
    if contact.is_spatial:
        second = np.stack([np.zeros_like(fixed[0]), fixed[2]])
        circle = None
        if contact.circle is not None:
            span = layout.spans[contact.track_body]
            circle = next(one for one in turning if one.span == span)
        return [
            ContactRows(contact, fixed[:2], *_path_spans(contact, layout), circle=circle),
            ContactRows(contact, second, is_second=True, circle=circle),
        ]
    return [ContactRows(contact, fixed, *_path_spans(contact, layout))]


def _path_spans(contact: PointContact, layout: _Layout) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return the spans of modes that move a path along its normal and along its tangent, none without a path."""
    if contact.path_body is None:
        return (0, 0), (0, 0)
    first, end = layout.spans[contact.path_body]
    axial = first + len(contact.path_body.path().normal.multiples)
    return (first, axial), (axial, end)


def _motion(system: System, imposed: Signal) -> Signal:
    """Return the motions imposed on every contact: by a body under an imposed velocity, by a moving rigid track."""

    alongs = [contact.frame[:, 0].tolist() for contact in system.contacts]
    pairs = [_pairs(contact) for contact in system.contacts]
    firsts = (np.cumsum(pairs) - pairs).tolist()
    # Asked for once: where a point is on a body takes long to find.
    turnings = [contact.turning_velocities for contact in system.contacts]

    def motion(time: Array, step: float) -> Array:
        values = np.zeros((time.size, sum(pairs), 3))
        each = zip(firsts, system.contacts, alongs, turnings, strict=True)
        for number, contact, (normal_x, *tangents_x), passing in each:
            held = [(0, 1.0)] if system.is_held(contact.tip.body) else []
            held += [(1, -1.0)] if _touches_held(contact, system) else []
            for side, sign in held:
                moved = imposed(time, step)
                for pair, tangent_x in enumerate(tangents_x):
                    values[:, number + pair, side] += tangent_x * moved
                values[:, number, 2] += sign * normal_x * moved
            for pair, speed in enumerate(contact.surface_velocities):
                if speed:
                    values[:, number + pair, 1] += speed * time
            if contact.circle is not None:
                values[:, number, 0] += contact.circle.travel(time)
            for turning, speeds in passing:
                for pair, speed in enumerate(speeds):
                    values[:, number + pair, 1] += speed * turning.history.integral(time)
            if contact.rigid_track is not None:
                values[:, number, 1] += contact.rigid_track.travel(time)
                values[:, number, 2] -= contact.rigid_track.normal_travel(time)
                if contact.is_spatial:
                    values[:, number + 1, 1] += contact.rigid_track.lateral_travel(time)
        return values

    return motion


@dataclass
class _Load:
    """Modal forces of one signal, and its balance about the slider's root: along x and y [N], moment [N m]."""

    modal: Array
    root: Array


def _factor(history: History) -> Signal:
    return lambda time, step: history.factor(time)


def _loads(system: System, layout: _Layout) -> tuple[list[_Load], list[Signal], tuple[History, ...]]:
    """Return the loads, drives of the same history together, the signals, and the histories."""
    by_history: dict[History, _Load] = {}

    def add(history: History, modal: Array, root: Array) -> None:
        if history in by_history:
            by_history[history].modal += modal
            by_history[history].root += root
        else:
            by_history[history] = _Load(modal, root)

    inertia = _inertia(system)
    for drive in system.drives:
        if drive.push is not None:
            history, point, components = drive.push
            add(history, *_force(point, components, layout))
        if drive.fall is not None:
            modal = np.sum([drive.fall @ layout.translation(body) for body in layout.order], axis=0)
            add(Constant(), modal, inertia @ drive.fall[:2])
    for history, point, components in (push for one in system.connections for push in pushes(one)):
        add(history, *_force(point, components, layout))
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

    if imposed and history.settled != 0.0:
        loads.append(_Load(-layout.translation(imposed.point.body)[0], -inertia[:, 0]))
        signals.append(acceleration)
    return loads, [*signals, displacement, speed, acceleration], tuple(felt)


def _inertia(system: System) -> Array:
    """Return the slider's inertia as its root feels it, zero for bodies without a root."""
    slider = system.slider
    if not has_root(slider):
        return np.zeros((3, 2))
    inertia: Array = slider.root_reaction(system.is_held(slider)).inertia
    return inertia


def _force(point: BodyPoint, components: Array, layout: _Layout) -> tuple[Array, Array]:
    slider = layout.system.slider
    root = np.zeros(3)
    if point.body == slider and has_root(slider):
        root = slider.root_lever(point.position) @ components[:2]
    return components @ layout.trace(point), root


def _start(system: System, layout: _Layout) -> tuple[Array, Array]:
    """Return modal positions and velocities at the start."""
    position, velocity = np.zeros(layout.size), np.zeros(layout.size)
    for drive in system.drives:
        if drive.uniform_velocity is not None:
            # Residual shapes follow forces alone.
            modes = layout.modes(drive.acted_on)
            speeds = drive.uniform_velocity[: len(modes.translation)]
            moved = np.where(modes.massless, 0.0, speeds @ modes.translation)
            velocity += layout.full(drive.acted_on, moved)
        for name, given in drive.vectors.items():
            values = {"displacement": position, "velocity": velocity}[name]
            values += layout.full(drive.acted_on, drive.acted_on.modal_coordinates(given))
    return position, velocity


def _probe(probe: Probe, layout: _Layout, loads: list[_Load]) -> ProbeRows:
    if not isinstance(probe, Reaction) and probe.body not in layout.system.bodies:
        raise ArgumentError("probe", "be on a body of this system", probe, got=f"one on {brief(probe.body)}")
    return _rows_of(probe, layout, loads, np.zeros(len(loads) + 3), np.zeros((layout.pairs, 2)))


@singledispatch
def _rows_of(probe: Any, layout: _Layout, loads: list[_Load], direct: Array, contact: Array) -> ProbeRows:
    system, matrix = layout.system, np.zeros((3, layout.size))
    if hasattr(probe, "mode"):
        modes = layout.modes(probe.body).count
        if probe.mode >= modes:
            raise ArgumentError("probe", f"be of a mode below {modes}", probe, got=probe.mode)
        matrix[probe.derivative] = layout.blended(layout.full(probe.body, np.eye(1, modes, probe.mode)[0]))
        return ProbeRows(matrix, direct, contact)
    matrix[probe.derivative] = probe.along @ layout.trace(probe.point)
    if system.is_held(probe.point.body):
        direct[len(loads) + probe.derivative] = probe.along[0]
    return ProbeRows(matrix, direct, contact)


@_rows_of.register
def _support_rows(probe: SupportForce, layout: _Layout, loads: list[_Load], direct: Array, contact: Array) -> ProbeRows:
    matrix = np.zeros((3, layout.size))
    matrix[0] = layout.blended(layout.full(probe.body, probe.body.support_force(probe.end)))
    return ProbeRows(matrix, direct, contact)


@_rows_of.register
def _reaction_rows(probe: Reaction, layout: _Layout, loads: list[_Load], direct: Array, contact: Array) -> ProbeRows:
    system, beam = layout.system, probe.body
    component = ("x", "y", "moment").index(probe.component)
    if beam != system.slider:
        raise ArgumentError("probe", "be on the slider of this system", probe, got=f"one on {brief(beam)}")
    if beam.tip_support != "free":
        raise ArgumentError("tip_support", "be free where a Reaction is recorded", beam.tip_support)
    if any(point.body == beam for connection in system.connections for point in ends(connection)):
        raise ArgumentError("connections", "leave a body whose Reaction is recorded", got=f"one on {brief(beam)}")
    if system.is_spatial:
        raise ArgumentError("probe", "be another than a Reaction in a system with bodies in space", probe)
    reaction = beam.root_reaction(system.is_held(beam))
    matrix = np.zeros((3, layout.size))
    matrix[2] = layout.blended(layout.full(beam, reaction.mass[component]))
    direct[: len(loads)] = [-reaction.held[component] * load.root[component] for load in loads]
    for number, point in enumerate(system.contacts):
        # The contact pushes the tip with the normal force along the normal, less the tangential along the tangent.
        signs = np.array([-1.0, 1.0])
        if point.tip.body == beam:
            lever = beam.root_lever(point.tip.position)[component]  # type: ignore[arg-type]
            contact[number] += reaction.held[component] * signs * (point.frame @ lever)
        if point.touched_point is not None and point.touched_point.body == beam:
            lever = beam.root_lever(point.touched_point.position)[component]  # type: ignore[arg-type]
            contact[number] -= reaction.held[component] * signs * (point.frame @ lever)
    return ProbeRows(matrix, direct, contact)
