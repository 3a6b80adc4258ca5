"""Sound of plates and beams under forces, springs, dashpots and riders at default settings.

The modes are integrated by DOP853 from their equations, written out here with sines and their frequencies in closed
form, and the pressure is summed over the surface after Rayleigh with the travel time from every point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from ..acoustics import Air, radiate
from ..arrays import Array
from ..bodies import Material, ModalBeam, ModalPlate, PointMass, Rectangle
from ..connections import Connection, Dashpot, Spring
from ..contact import PointContact
from ..drives import Drive, Force, InitialState, InitialVelocity
from ..histories import Harmonic
from ..integration import simulate
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch

STEEL, AIR = Material(2.1e11, 7800.0, 0.3), Air()
DAMPING, DURATION = 0.01, 0.03
# Sides and thickness of the plate [m], width and height of the beam [m] of the same length.
LENGTH, WIDTH, THICKNESS = 0.4, 0.3, 0.004
STRIP, HEIGHT = 0.03, 0.008
# Numbers of bending modes: of the plate along and across, and of the beam.
OF_PLATE, OF_BEAM = (4, 3), 7
# Force [N] and frequency [Hz] of the shaker, its mass [kg], and where it acts along the track [m].
FORCE, FREQUENCY, SHAKER, SHAKEN = 3.0, 430.0, 0.2, 0.29
# Mass of the rider [kg], its load [N], its place [m], its speed when it moves [m/s], and the stiffness below it [N/m].
RIDER, LOAD, RIDDEN, SPEED, STIFFNESS = 0.05, 40.0, 0.13, 2.0, 2e6
# Spring [N/m] and dashpot [N s/m] between shaker or ground and track.
SPRING, DASHPOT = 1e6, 150.0
LISTENERS = ((0.1, 0.05, 0.3), (0.5, -0.2, 0.6))
# Points of Gauss along and across the surface, and interval [s] of the spline of the motion.
POINTS, FINE = (48, 30), 4e-6


@dataclass(frozen=True)
class Surface:
    """A track with its modes in closed form.

    Attributes
    ----------
    track : ModalPlate or ModalBeam
        The track.
    shapes : callable
        Takes x and y [m] of points, returns the mass-normalised modes there, shape (points, modes).
    slopes : callable
        The same for their derivatives along x, by order.
    angular : ndarray, shape (modes,)
        Angular frequencies [rad/s].
    sides : tuple
        Lower and upper x and y of the surface [m].
    line : float
        The y along which contacts move [m].
    """

    track: ModalPlate | ModalBeam
    shapes: Callable[[Array, Array], Array]
    slopes: Callable[[float, int], Array]
    angular: Array
    sides: tuple[tuple[float, float], tuple[float, float]]
    line: float

    def at(self, x: float) -> Array:
        """Return the modes at an abscissa of the line of contacts, shape (modes,)."""
        return self.slopes(x, 0)


def plate() -> Surface:
    """Return the plate, simply supported, whose line of contacts is in its middle."""
    track = ModalPlate(STEEL, THICKNESS, LENGTH, WIDTH, bending_modes=OF_PLATE, damping=DAMPING)
    m, n = (part.ravel() for part in np.meshgrid(*(np.arange(1, count + 1) for count in OF_PLATE), indexing="ij"))
    along, across = m * pi / LENGTH, n * pi / WIDTH
    rigidity = STEEL.young * THICKNESS**3 / (12.0 * (1.0 - STEEL.poisson**2))
    angular = sqrt(rigidity / (STEEL.density * THICKNESS)) * (along**2 + across**2)
    amplitude = sqrt(4.0 / (STEEL.density * THICKNESS * LENGTH * WIDTH))

    def slopes(x: float, order: int, y: float = 0.5 * WIDTH) -> Array:
        return amplitude * along**order * np.sin(along * x + order * pi / 2.0) * np.sin(across * y)

    def shapes(x: Array, y: Array) -> Array:
        return amplitude * np.sin(np.outer(x, along)) * np.sin(np.outer(y, across))

    return Surface(track, shapes, slopes, angular, ((0.0, LENGTH), (0.0, WIDTH)), 0.5 * WIDTH)


def beam() -> Surface:
    """Return the beam, simply supported, a strip that moves uniformly across."""
    track = ModalBeam(STEEL, Rectangle(STRIP, HEIGHT), LENGTH, bending_modes=OF_BEAM, axial_modes=2, damping=DAMPING)
    along = np.arange(1, OF_BEAM + 1) * pi / LENGTH
    angular = sqrt(STEEL.young * HEIGHT**2 / (12.0 * STEEL.density)) * along**2
    amplitude = sqrt(2.0 / (STEEL.density * STRIP * HEIGHT * LENGTH))

    def slopes(x: float, order: int) -> Array:
        return amplitude * along**order * np.sin(along * x + order * pi / 2.0)

    def shapes(x: Array, y: Array) -> Array:
        return amplitude * np.sin(np.outer(x, along))

    return Surface(track, shapes, slopes, angular, ((0.0, LENGTH), (-0.5 * STRIP, 0.5 * STRIP)), 0.0)


def swing(time: float) -> float:
    """Return the force of the shaker [N]."""
    return FORCE * np.sin(2.0 * pi * FREQUENCY * time)


@dataclass(frozen=True)
class Shaken:
    """A track with drives, and the equations of its modes and of one mass.

    Attributes
    ----------
    words : str
        Name of the case.
    surface : Surface
        The track.
    system : System
        The system.
    accelerations : callable
        Takes time [s], displacements and velocities of the modes and of the mass; returns their accelerations.
    start : tuple of float
        Displacement [m] and velocity [m/s] of the mass at the start.
    """

    words: str
    surface: Surface
    system: System
    accelerations: Callable[[float, Array, Array], Array]
    start: tuple[float, float] = (0.0, 0.0)

    def motion(self) -> CubicSpline:
        """Return the accelerations of the modes over time, by DOP853."""
        count = self.surface.angular.size + 1
        begin = np.zeros(2 * count)
        begin[count - 1], begin[-1] = self.start
        times = np.arange(0.0, DURATION + FINE, FINE)
        found = solve_ivp(
            lambda time, state: np.concatenate([state[count:], self.accelerations(time, state[:count], state[count:])]),
            (0.0, times[-1]),
            begin,
            "DOP853",
            times,
            rtol=1e-9,
            atol=1e-13,
        ).y
        values = [self.accelerations(t, *np.split(state, 2))[:-1] for t, state in zip(times, found.T, strict=True)]
        return CubicSpline(times, np.array(values))

    def pressure(self, times: Array) -> Array:
        """Return the pressure at the listeners, shape (times, listeners) [Pa]."""
        motion, surface, pressure = self.motion(), self.surface, np.zeros((times.size, len(LISTENERS)))
        nodes = [np.polynomial.legendre.leggauss(count) for count in POINTS]
        (x, wide), (y, high) = (
            (low + 0.5 * (upper - low) * (node + 1.0), 0.5 * (upper - low) * weight)
            for (low, upper), (node, weight) in zip(surface.sides, nodes, strict=True)
        )
        x, y = (part.ravel() for part in np.meshgrid(x, y, indexing="ij"))
        shapes, areas = surface.shapes(x, y), np.outer(wide, high).ravel()
        for k, (a, b, c) in enumerate(LISTENERS):
            away = np.sqrt((x - a) ** 2 + (y - b) ** 2 + c**2)
            weights = AIR.density / (2.0 * pi) * areas / away
            for shape, weight, delay in zip(shapes, weights, away / AIR.speed, strict=True):
                sent = times - delay
                pressure[:, k] += weight * np.where(sent > 0.0, motion(np.maximum(sent, 0.0)) @ shape, 0.0)
        return pressure

    def rows(self) -> tuple[list[Row], list[Curve]]:
        """Return the rows of a default run and its curves."""
        run = simulate(self.system, DURATION)
        heard = radiate(run, self.system, LISTENERS, bodies=[self.surface.track])
        # A prime stride samples every phase of the vibration.
        picked = slice(211, -100, 11)
        times, found = heard["time"].values[picked], heard.values[picked]
        known = self.pressure(times)
        rows = []
        for k in range(len(LISTENERS)):
            level, words = float(np.sqrt(np.mean(known[:, k] ** 2))), f"{self.words}, listener {k + 1}"
            obtained = float(np.sqrt(np.mean(found[:, k] ** 2)))
            apart = float(np.sqrt(np.mean((found[:, k] - known[:, k]) ** 2))) / level
            rows += [
                Row(f"{words}: root mean square", level, obtained, 0.01 * level, "one per cent", "Pa"),
                Row(f"{words}: difference over that", 0.0, apart, 0.01, "one per cent"),
            ]
        early = times < 0.012
        curves = [
            Curve(1e3 * times[early], known[early, 0], f"{self.words}: integrated"),
            Curve(1e3 * times[early], found[early, 0], f"{self.words}: obtained", marks=True),
        ]
        return rows, curves


def _alone(surface: Surface, displacement: Array, velocity: Array) -> Array:
    """Return the accelerations of the modes without forces."""
    angular = surface.angular
    return -(angular**2) * displacement - 2.0 * DAMPING * angular * velocity


def _system(
    surface: Surface,
    drives: Sequence[Drive],
    connections: Sequence[Connection] = (),
    contact: PointContact | None = None,
) -> System:
    """Return a system of a track; without a contact of its own, it has one that stays open."""
    if contact is None:
        aloof = PointMass(0.01, name="aloof")
        contact = PointContact(aloof.centre, surface.track, at=RIDDEN, gap=1.0)
    return System(contact, drives, connections)


def by_a_force(surface: Surface, words: str) -> Shaken:
    """Return a track on which the force acts."""
    track, shape = surface.track, surface.at(SHAKEN)
    push = Force(track.at(SHAKEN), y=FORCE, history=Harmonic(FREQUENCY))

    def accelerations(time: float, displacement: Array, velocity: Array) -> Array:
        bent = _alone(surface, displacement[:-1], velocity[:-1]) + shape * swing(time)
        return np.append(bent, 0.0)

    return Shaken(f"{words} under a force", surface, _system(surface, [push]), accelerations)


def through_a_spring(surface: Surface, words: str, dashpot: float = 0.0) -> Shaken:
    """Return a track joined by a spring, and by a dashpot, to a mass on which the force acts."""
    track, shape = surface.track, surface.at(SHAKEN)
    shaker = PointMass(SHAKER, name="shaker")
    connections: list[Connection] = [Spring(shaker.centre, track.at(SHAKEN), stiffness=SPRING, direction="y")]
    if dashpot:
        connections.append(Dashpot(shaker.centre, track.at(SHAKEN), coefficient=dashpot, direction="y"))
    push = Force(shaker.centre, y=FORCE, history=Harmonic(FREQUENCY))

    def accelerations(time: float, displacement: Array, velocity: Array) -> Array:
        stretched, faster = (state[-1] - shape @ state[:-1] for state in (displacement, velocity))
        pull = SPRING * stretched + dashpot * faster
        bent = _alone(surface, displacement[:-1], velocity[:-1]) + shape * pull
        return np.append(bent, (swing(time) - pull) / SHAKER)

    means = "a spring and a dashpot" if dashpot else "a spring"
    return Shaken(f"{words} through {means}", surface, _system(surface, [push], connections), accelerations)


def under_a_rider(surface: Surface, words: str, force: float = FORCE) -> Shaken:
    """Return a track under a force, and under a loaded mass on a contact with a stiffness, which stays closed."""
    track, shape, ridden = surface.track, surface.at(SHAKEN), surface.at(RIDDEN)
    rider = PointMass(RIDER, name="rider")
    depth = LOAD / STIFFNESS
    drives: list[Drive] = [Force(rider.centre, y=-LOAD), InitialState(rider, displacement=(0.0, -depth))]
    if force:
        drives.append(Force(track.at(SHAKEN), y=force, history=Harmonic(FREQUENCY)))
    contact = PointContact(rider.centre, track, at=RIDDEN, stiffness=STIFFNESS)

    def accelerations(time: float, displacement: Array, velocity: Array) -> Array:
        pressed = max(STIFFNESS * (ridden @ displacement[:-1] - displacement[-1]), 0.0)
        bent = (
            _alone(surface, displacement[:-1], velocity[:-1]) + shape * force / FORCE * swing(time) - ridden * pressed
        )
        return np.append(bent, (pressed - LOAD) / RIDER)

    system = _system(surface, drives, contact=contact)
    return Shaken(
        f"{words} under {'a force and ' if force else ''}a rider", surface, system, accelerations, (-depth, 0.0)
    )


def under_a_moving_rider(surface: Surface, words: str) -> Shaken:
    """Return a track under a force and a loaded mass that moves along it in rigid contact, without friction.

    At ``x = a + v t`` the mass has the acceleration ``w'' + 2 v dw'/dx + v² d²w/dx²`` of the track below it.
    """
    track, shape = surface.track, surface.at(SHAKEN)
    rider = PointMass(RIDER, name="rider")
    drives: list[Drive] = [
        Force(track.at(SHAKEN), y=FORCE, history=Harmonic(FREQUENCY)),
        Force(rider.centre, y=-LOAD),
        InitialVelocity(rider, x=SPEED),
    ]
    contact = PointContact(rider.centre, track, at=RIDDEN)

    def accelerations(time: float, displacement: Array, velocity: Array) -> Array:
        place, slope, bend = (surface.slopes(RIDDEN + SPEED * time, order) for order in range(3))
        free = _alone(surface, displacement[:-1], velocity[:-1]) + shape * swing(time)
        carried = 2.0 * SPEED * slope @ velocity[:-1] + SPEED**2 * bend @ displacement[:-1]
        pressed = (RIDER * (place @ free + carried) + LOAD) / (1.0 + RIDER * place @ place)
        return np.append(free - place * pressed, 0.0)

    system = _system(surface, drives, contact=contact)
    return Shaken(f"{words} under a force and a moving rider", surface, system, accelerations)


def shaken() -> Outcome:
    """Pressure of a plate and of a beam in a baffle."""
    rows, curves = [], []
    for surface, words in ((plate(), "plate"), (beam(), "beam")):
        for one in (
            by_a_force(surface, words),
            through_a_spring(surface, words),
            through_a_spring(surface, words, DASHPOT),
            under_a_rider(surface, words),
            under_a_rider(surface, words, force=0.0),
            under_a_moving_rider(surface, words),
        ):
            found, drawn = one.rows()
            rows += found
            curves += drawn if surface.sides[1][0] and one.words.endswith(("force", "spring")) else []
    return Outcome(rows, Sketch("time [ms]", "pressure [Pa]", curves))


CASES = (
    Case(
        "shaken-tracks",
        "Sound of tracks under forces, springs, dashpots and riders",
        "modes in closed form, integrated by DOP853; Rayleigh 1896, Theory of Sound, section 278, summed over points",
        shaken,
    ),
)
