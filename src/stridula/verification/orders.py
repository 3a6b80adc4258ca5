"""Observed order of the time schemes on smooth motion, and exactness of the exact modal scheme."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians

import numpy as np
from scipy.linalg import expm

from ..arrays import Array
from ..bodies import BodyPoint, FiniteElementBeam, Material, ModalBeam, Rectangle
from ..contact import PointContact
from ..drives import Drive, Force, InitialVelocity
from ..histories import Harmonic
from ..integration import ExactModal, simulate
from ..lowering.schemes import Scheme
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, schemes
from .frequencies import fitted_order
from .instabilities import hoffmann, only_sliding

STEEL = Material(2.1e11, 7800.0)
STRIP = Rectangle(0.020, 0.004)
FREQUENCY, PHASE, DURATION = 310.0, 0.7, 0.012
DECLARED = 2.0
STEPS = np.array([2e-6, 1e-6, 5e-7])


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
    points : list of BodyPoint
        Points compared.
    exact : ndarray, shape (points, 2)
        World displacements of the points at the end [m].
    """

    name: str
    system: System
    points: list[BodyPoint]
    exact: Array

    def error(self, scheme: Scheme, step: float) -> float:
        """Return the relative error at the end."""
        probes = [Displacement(point, way) for point in self.points for way in ("x", "y")]
        run = simulate(self.system, DURATION, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes)
        found = run["displacement"].values[-1].reshape(self.exact.shape)
        return float(np.linalg.norm(found - self.exact) / np.linalg.norm(self.exact))


def _pair(rod: FiniteElementBeam, bar: ModalBeam, drives: list[Drive]) -> System:
    return System(PointContact(rod.tip, bar, at=0.2, gap=1.0), drives=drives)


def forced_track() -> Smooth:
    """Five bending and two axial modes under an oblique harmonic force."""
    bar = ModalBeam(STEEL, STRIP, 0.8, bending_modes=5, axial_modes=2, damping=0.03)
    rod = FiniteElementBeam(STEEL, STRIP, 0.5, angle=radians(45.0), elements=10, cutoff=2e3)
    force = Force(bar.at(0.31), x=300.0, y=2.0, history=Harmonic(FREQUENCY, phase=PHASE))
    modes, places = bar.modes(), (0.17, 0.31, 0.6)
    push = bar.trace(0.31).T @ [300.0, 2.0]
    at_end = motion(modes.angular_frequency, modes.damping, push, 0.0 * push, DURATION)
    exact = np.array([bar.trace(place) @ at_end for place in places])
    return Smooth("forced beam", _pair(rod, bar, [force]), [bar.at(place) for place in places], exact)


def thrown_slider(root_support: str = "guided", push: float = 1.0, damping: float = 0.02) -> Smooth:
    """A slider thrown up under a harmonic force at 0.2 m; without it if `push` is zero."""
    rod = FiniteElementBeam(
        STEEL, STRIP, 0.5, angle=radians(30.0), elements=10, damping=damping, cutoff=3e3, root_support=root_support
    )
    bar = ModalBeam(STEEL, STRIP, 0.8, cutoff=500.0)
    drives: list[Drive] = [InitialVelocity(rod, x=0.3, y=0.8)]
    if push:
        drives.append(Force(rod.at(0.2), x=2.0 * push, y=3.0 * push, history=Harmonic(FREQUENCY, phase=PHASE)))
    modes, places = rod.modes(), (0.0, 0.13, 0.4)
    force = push * (rod.trace(0.2).T @ [2.0, 3.0])
    velocity = modes.translation.T @ [0.3, 0.8]
    at_end = motion(modes.angular_frequency, modes.damping, force, velocity, DURATION)
    exact = np.array([rod.trace(place) @ at_end for place in places])
    return Smooth("thrown slider", _pair(rod, bar, drives), [rod.at(place) for place in places], exact)


def smooth() -> Outcome:
    """Fitted order over three steps, the highest mode at most at w h = 0.16."""
    rows, curves = [], []
    for case in (forced_track(), thrown_slider()):
        for scheme in schemes():
            errors = np.array([case.error(scheme, float(step)) for step in STEPS])
            reason = "declared order within 0.1"
            order = fitted_order(STEPS, errors)
            rows.append(Row(f"order, {case.name}", DECLARED, order, 0.1, reason, "1", scheme.name))
            curves.append(Curve(STEPS, errors, f"{case.name}, {scheme.name}", marks=True))
    free = thrown_slider(root_support="pinned", push=0.0, damping=0.01)
    for step in (1e-5, 1e-4):
        words = f"error of free damped motion at a step of {step:g} s"
        reason = "exact at any step; round-off of a step times the steps, 2.2e-16 n w / w_min"
        rows.append(Row(words, 0.0, free.error(ExactModal(), step), 1e-11, reason, "1", ExactModal.name))
    return Outcome(rows, Sketch("step [s]", "relative error", curves, logarithmic=True))


def sliding() -> Outcome:
    """Hoffmann's mass sliding on its belt: contact and friction act, and the motion stays smooth.

    Exact modes leave ``q'' + K q = f + h²/12 f'' + O(h⁴)``: the contact force is off by h²/12 of its own second
    derivative, and the motion, to which only its direction matters, is of fourth order.
    """
    model, friction, duration = hoffmann(), 0.9, 8.0
    steps = np.array([1.6e-2, 8e-3, 4e-3])
    free = np.block([[np.zeros((2, 2)), np.eye(2)], [-model.sliding(friction), np.zeros((2, 2))]])
    rows, curves = [], []
    for scheme in schemes():
        errors = []
        for step in steps:
            run = model.run(friction, scheme, float(step), duration)
            only_sliding(run)
            rest, start = model.start(friction)
            moved = expm(free * duration) @ np.concatenate([start - rest, np.zeros(2)])
            errors.append(float(np.linalg.norm(run["displacement"].values[-1] - rest - moved[:2])))
        order, expected = fitted_order(steps, np.array(errors)), 2.0 * DECLARED if scheme == ExactModal() else DECLARED
        words = "order of a force of one direction, within 0.1"
        rows.append(Row("order, sliding contact", expected, order, 0.1, words, "1", scheme.name))
        curves.append(Curve(steps, np.array(errors), scheme.name, marks=True))
    return Outcome(rows, Sketch("step", "error of the displacement", curves, logarithmic=True))


CASES = (
    Case(
        "order-time",
        "Order of the time schemes on smooth motion",
        "closed form of modes under a harmonic force; schemes declare second order (Carpenter, Taylor & Katona 1991; "
        "Issanchou, Acary, Perignon, Touze & Le Carrou 2018, J. Acoust. Soc. Am. 143)",
        smooth,
    ),
    Case(
        "order-sliding",
        "Order of the time schemes in a sliding contact",
        "matrix exponential of Hoffmann's mass in sliding (Hoffmann, Fischer, Allgaier & Gaul 2002)",
        sliding,
    ),
)
