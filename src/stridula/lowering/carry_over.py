"""Transfer of motion to a changed body of the same kind, such as a longer or thicker one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import singledispatch
from typing import Any

import numpy as np

from .._kernels.layout import columns as at
from ..arrays import Array
from ..bodies import AxisymmetricBody, BodyPoint, FiniteElementBeam, ModalBeam, ModalPlate
from ..connections import held_motions
from ..contact import PointContact
from ..records.state import State
from ..system import System
from .assembly import Assembly
from .schemes import Scheme

# Fields of a body of revolution without influence on its modes.
NO_SHAPE = ("damping", "turning", "turning_history")
SAME_MESH = ("elements", "root_support", "tip_support")


@dataclass(frozen=True)
class Before:
    """The system before a change.

    Attributes
    ----------
    system : System
        The system.
    scheme : Scheme
        Its time scheme.
    spans : dict
        First mode of each body and end of its range, by the body's name.
    relaxing : tuple of int
        First of the inner motions of viscoelastic springs, and end of their range.
    step : float
        Its time step [s].
    """

    system: System
    scheme: Scheme
    spans: dict[str, tuple[int, int]]
    relaxing: tuple[int, int]
    step: float

    def goes_on_as(self, system: System) -> bool:
        """Return whether the motion can be transferred to another system."""
        before = self.system
        return (
            (before.imposed_velocity is None) == (system.imposed_velocity is None)
            and before.connections == system.connections
            and (not any(map(held_motions, system.connections)) or self.has_modes_of(system))
            and len(before.contacts) == len(system.contacts)
            and all(_is_like_contact(*pair) for pair in zip(before.contacts, system.contacts, strict=True))
            and len(before.bodies) == len(system.bodies)
            and all(carries_over(*pair) for pair in zip(before.bodies, system.bodies, strict=True))
        )

    def has_modes_of(self, system: System) -> bool:
        """Return whether the bodies of another system have the same modes, with any damping and turning."""
        return all(map(_has_same_modes, self.system.bodies, system.bodies))

    def motion_as(self, system: System, arrays: Assembly, state: State, time: float) -> tuple[Array, Array]:
        """Return modal positions and velocities converted to another system."""
        position, velocity = np.zeros((2, arrays.mode_count))
        speed_up = _root_velocity(system, time) - _root_velocity(self.system, time)
        for before, now in zip(self.system.bodies, system.bodies, strict=True):
            held = self.system.is_held(before)
            old, new = slice(*self.spans[self.system.body_name(before)]), slice(*arrays.spans[system.body_name(now)])
            position[new] = carried_over(before, now, held, state.modal[at.Q, old])
            velocity[new] = carried_over(before, now, held, state.modal[at.D, old] / self.step)
            if held:
                # A change of the root's velocity does not change that of the body at once.
                velocity[new] -= speed_up * now.modes(held).translation[0]
        old, new = slice(*self.relaxing), slice(*arrays.relaxing)
        position[new], velocity[new] = state.modal[at.Q, old], state.modal[at.D, old] / self.step
        return position, velocity


def _root_velocity(system: System, time: float) -> float:
    imposed = system.imposed_velocity
    return 0.0 if imposed is None else imposed.velocity * float(imposed.history.factor(np.array([time]))[0])


@singledispatch
def _has_same_modes(before: Any, now: Any) -> bool:
    """Return whether a body has the same shapes and frequencies as another."""
    return bool(before == now)


@_has_same_modes.register
def _whatever_its_speed(before: AxisymmetricBody, now: AxisymmetricBody) -> bool:
    return replace(before, **{name: getattr(now, name) for name in NO_SHAPE}) == now


def _is_like_contact(before: PointContact, now: PointContact) -> bool:
    """Return whether contacts have the same gap and direction, and tracks of the same kind and profile."""
    return (
        (before.gap, before.inclination) == (now.gap, now.inclination)
        and (before.path_body is None) == (now.path_body is None)
        and (before.rigid_track is None) == (now.rigid_track is None)
        and before.relief == now.relief
        and before.yields == now.yields
        and (now.path_body is not None or before.at == now.at)
        and _is_like_point(before.tip, now.tip)
        and _is_like_point(before.touched_point, now.touched_point)
    )


def _is_like_point(before: BodyPoint | None, now: BodyPoint | None) -> bool:
    """Return whether points are the same, or on different bodies."""
    return before == now or (before is not None and now is not None and before.body != now.body)


def carries_over(before: Any, now: Any) -> bool:
    """Return whether the motion of one body can be transferred to another."""
    return type(before) is type(now) and _is_like(before, now)


@singledispatch
def _is_like(before: Any, now: Any) -> bool:
    """Return whether the motion of a body can be transferred to another of its kind."""
    return _has_same_modes(before, now)


@_is_like.register(ModalBeam)
@_is_like.register(ModalPlate)
def _always(before: Any, now: Any) -> bool:
    return True


@_is_like.register
def _has_its_mesh(before: FiniteElementBeam, now: FiniteElementBeam) -> bool:
    return all(getattr(before, name) == getattr(now, name) for name in SAME_MESH)


def carried_over(before: Any, now: Any, held: bool, values: Array) -> Array:
    """Return modal positions or velocities of a body converted to the changed body.

    A finite-element beam keeps its rigid motion, and the deflections of its nodes along and across its axis; a beam or
    plate of exact modes keeps the amplitude of each sine.

    Parameters
    ----------
    before, now : body
        The body before and after the change, for which `carries_over` holds.
    held : bool
        Whether its root follows an imposed velocity.
    values : ndarray, shape (modes before,)
        Modal positions or velocities.

    Returns
    -------
    ndarray, shape (modes now,)
    """
    return values if _has_same_modes(before, now) else _carried(before, now, held, values)


@singledispatch
def _carried(before: Any, now: Any, held: bool, values: Array) -> Array:
    """Return the motion of a changed body; for exact modes, by their sines."""
    found = np.zeros(now.modes().count)
    ratio = before.amplitude / now.amplitude
    places = {key: place for place, key in enumerate(_sines(now))}
    for key, value in zip(_sines(before), values, strict=True):
        if key in places:
            found[places[key]] = ratio * value
    return found


@_carried.register
def _of_finite_elements(before: FiniteElementBeam, now: FiniteElementBeam, held: bool, values: Array) -> Array:
    traces, rigid = before.node_traces(held), before.modes(held).angular_frequency == 0.0
    travel = traces[:, rigid] @ values[rigid]
    deflected = (traces[:, ~rigid] @ values[~rigid]).reshape(-1, 3)
    deflected[:, :2] = deflected[:, :2] @ before.axes.T @ now.axes
    deflected[:, 2] *= before.length / now.length
    return now.modal_coordinates(travel + deflected.ravel(), held)


@singledispatch
def _sines(track: Any) -> list[Any]:
    """Return keys of the modes of a track, in their order."""
    bending, axial = track.harmonics
    return [("bending", k) for k in range(bending)] + [("axial", k) for k in range(axial)]


@_sines.register
def _of_a_plate(plate: ModalPlate) -> list[Any]:
    # Each pair of half-waves in the plane has a longitudinal mode and a shear mode.
    shears = (plate.polarisations[:, 1] < 0.0).tolist()
    in_plane = zip(plate.in_plane_numbers.tolist(), shears, strict=True)
    bends = [("bending", tuple(pair), False) for pair in plate.numbers.tolist()]
    return bends + [("in plane", tuple(pair), shear) for pair, shear in in_plane]
