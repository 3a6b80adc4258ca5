"""Beams that move without touching anything: forced by a harmonic force, and thrown."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians

import numpy as np

from ...arrays import Array
from ...bodies import FiniteElementBeam, Material, ModalBeam, Rectangle
from ...contact import PointContact
from ...drives import Drive, Force, InitialVelocity
from ...histories import Harmonic
from ...integration import simulate
from ...lowering.schemes import Scheme
from ...records import Displacement
from ...system import System

STEEL = Material(2.1e11, 7800.0)
STRIP = Rectangle(0.020, 0.004)
FREQUENCY, PHASE, DURATION = 310.0, 0.7, 0.012


def motion(angular: Array, damping: Array, force: Array, velocity: Array, time: float) -> Array:
    """Return the positions of modes under ``force sin(W t + phase)``, from rest position with `velocity`.

    The steady part is the imaginary part of ``f e^{i(Wt+phi)} / (w² - W² + 2 i z w W)``; the free part
    ``e^{-zwt} (A cos wd t + B sin wd t)`` meets the start. With w = 0 both are polynomials and sines.
    """
    drive = 2.0 * pi * FREQUENCY
    rigid = angular == 0.0
    safe = np.where(rigid, 1.0, angular)
    steady = force * np.exp(1j * PHASE) / (safe**2 - drive**2 + 2j * damping * safe * drive)
    damped = safe * np.sqrt(1.0 - damping**2)
    a = -steady.imag
    b = (velocity - (1j * drive * steady).imag + damping * safe * a) / damped
    free = np.exp(-damping * safe * time) * (a * np.cos(damped * time) + b * np.sin(damped * time))
    flown = force / drive**2 * (np.sin(PHASE) - np.sin(drive * time + PHASE))
    flown = flown + (velocity + force * np.cos(PHASE) / drive) * time
    return np.where(rigid, flown, (steady * np.exp(1j * drive * time)).imag + free)


@dataclass(frozen=True)
class Smooth:
    """A body that moves without contact, and its exact motion at the end.

    Attributes
    ----------
    name : str
        Description.
    system : System
        A system with the body.
    body : FiniteElementBeam or ModalBeam
        The one that moves.
    places : tuple of float
        Positions of the points compared [m].
    modal : ndarray
        Positions of its modes at the end.
    """

    name: str
    system: System
    body: FiniteElementBeam | ModalBeam
    places: tuple[float, ...]
    modal: Array

    def error(self, scheme: Scheme, step: float) -> float:
        """Return the relative error at the end."""
        probes = [Displacement(self.body.at(place), way) for place in self.places for way in ("x", "y")]
        run = simulate(self.system, DURATION, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes)
        exact = np.concatenate([self.body.trace(place) @ self.modal for place in self.places])
        return float(np.linalg.norm(run["displacement"].values[-1] - exact) / np.linalg.norm(exact))


def _pair(rod: FiniteElementBeam, bar: ModalBeam, drives: list[Drive]) -> System:
    return System(PointContact(rod.tip, bar, at=0.2, gap=1.0), drives=drives)


def forced_track() -> Smooth:
    """Five bending and two axial modes under an oblique harmonic force."""
    bar = ModalBeam(STEEL, STRIP, 0.8, bending_modes=5, axial_modes=2, damping=0.03)
    rod = FiniteElementBeam(STEEL, STRIP, 0.5, angle=radians(45.0), elements=10, cutoff=2e3)
    force = Force(bar.at(0.31), x=300.0, y=2.0, history=Harmonic(FREQUENCY, phase=PHASE))
    modes = bar.modes()
    push = bar.trace(0.31).T @ [300.0, 2.0]
    at_end = motion(modes.angular_frequency, modes.damping, push, 0.0 * push, DURATION)
    return Smooth("forced beam", _pair(rod, bar, [force]), bar, (0.17, 0.31, 0.6), at_end)


def thrown_slider(root_support: str = "guided", push: float = 1.0, damping: float = 0.02) -> Smooth:
    """A slider thrown up under a harmonic force at 0.2 m; without it if `push` is zero."""
    rod = FiniteElementBeam(
        STEEL, STRIP, 0.5, angle=radians(30.0), elements=10, damping=damping, cutoff=3e3, root_support=root_support
    )
    bar = ModalBeam(STEEL, STRIP, 0.8, cutoff=500.0)
    drives: list[Drive] = [InitialVelocity(rod, x=0.3, y=0.8)]
    if push:
        drives.append(Force(rod.at(0.2), x=2.0 * push, y=3.0 * push, history=Harmonic(FREQUENCY, phase=PHASE)))
    modes = rod.modes()
    force = push * (rod.trace(0.2).T @ [2.0, 3.0])
    velocity = modes.translation.T @ [0.3, 0.8]
    at_end = motion(modes.angular_frequency, modes.damping, force, velocity, DURATION)
    return Smooth("thrown slider", _pair(rod, bar, drives), rod, (0.0, 0.13, 0.4), at_end)
