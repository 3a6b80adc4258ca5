"""Drives and connections with offsets as modal forces and signals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint, has_root
from ..connections import pushes
from ..histories import Constant, History
from ..system import System
from .coordinates import Coordinates
from .signals import Signal, Signals


@dataclass
class Load:
    """One signal as a load.

    Attributes
    ----------
    modal : ndarray, shape (modes,)
        Modal forces for a unit signal.
    root : ndarray, shape (3,)
        Its resultant about the slider's root: along x and y [N], moment [N m].
    own : ndarray, shape (modes,)
        The same modal forces on the coordinates of the bodies, before rigid joints.
    history : Constant, Ramp, Harmonic or Sampled
        Its signal; None for the acceleration of a root.
    """

    modal: Array
    root: Array
    own: Array
    history: History | None = None


def _factor(history: History) -> Signal:
    return lambda time, step: history.factor(time)


def loads_of(system: System, coordinates: Coordinates) -> tuple[list[Load], Signals, tuple[History, ...]]:
    """Return the loads, merged by their histories, the signals, and the histories."""
    by_history: dict[History, Load] = {}

    def add(history: History, modal: Array, root: Array, own: Array) -> None:
        if history in by_history:
            by_history[history].modal += modal
            by_history[history].root += root
            by_history[history].own += own
        else:
            by_history[history] = Load(modal, root, own, history)

    inertia = _inertia(system)
    for drive in system.drives:
        if drive.push is not None:
            history, point, components = drive.push
            add(history, *_force(point, components, coordinates))
        if drive.fall is not None:
            modal = np.sum([drive.fall @ coordinates.translation(body) for body in coordinates.order], axis=0)
            own = np.sum([drive.fall @ coordinates.body_translation(body) for body in coordinates.order], axis=0)
            add(Constant(), modal, inertia @ drive.fall[:2], own)
    for history, point, components in (push for one in system.connections for push in pushes(one)):
        add(history, *_force(point, components, coordinates))
    # Offsets of connections that balance each other move nothing, but probes of their forces need them.
    offsets = {history for one in system.connections for history, *_ in pushes(one)}
    felt = {
        history: load
        for history, load in by_history.items()
        if load.modal.any() or load.root.any() or history in offsets
    }
    loads = list(felt.values())
    factors = [_factor(history) for history in felt]

    imposed = system.imposed_velocity
    history, velocity = (imposed.history, imposed.velocity) if imposed else (Constant(), 0.0)

    def displacement(time: Array, step: float) -> Array:
        return velocity * history.integral(time)

    def speed(time: Array, step: float) -> Array:
        return velocity * history.factor(time)

    def acceleration(time: Array, step: float) -> Array:
        # A difference, not the derivative: its impulses add up to the change of velocity, even at kinks.
        return velocity * (history.factor(time + step / 2.0) - history.factor(time - step / 2.0)) / step

    if imposed and history.settled != 0.0:
        body = imposed.point.body
        own = -coordinates.body_translation(body)[0]
        loads.append(Load(-coordinates.translation(body)[0], -inertia[:, 0], own))
        factors.append(acceleration)
    return loads, Signals(tuple(factors), displacement, speed, acceleration), tuple(felt)


def _inertia(system: System) -> Array:
    """Return the slider's inertia with respect to its root, zero for bodies without a root."""
    slider = system.slider
    if not has_root(slider):
        return np.zeros((3, 2))
    inertia: Array = slider.root_reaction(system.is_held(slider)).inertia
    return inertia


def _force(point: BodyPoint, components: Array, coordinates: Coordinates) -> tuple[Array, Array, Array]:
    slider = coordinates.system.slider
    root = np.zeros(3)
    if point.body == slider and has_root(slider):
        root = slider.root_lever(point.position) @ components[:2]
    return components @ coordinates.trace(point), root, components @ coordinates.body_trace(point)
