"""Mode coupling: a mass of two degrees of freedom on belts, without damping and with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
import xarray as xr

from ...arrays import Array
from ...bodies import ReducedBody
from ...contact import Coulomb, PointContact, RigidTrack
from ...drives import Force, InitialState
from ...integration import simulate
from ...lowering.schemes import Scheme
from ...records import Displacement
from ...system import System
from ..prony import exponents, only_sliding

# Mass of a foot behind a contact spring. It rests on its belt, so that any mass gives the same sliding motion.
FOOT = 0.5


@dataclass(frozen=True)
class Coupled:
    """A mass in the plane on belts, each under a foot at the end of a contact spring.

    Degrees of freedom: x and y of the mass, then one for each foot along its belt's normal. Along the belt a foot moves
    with the mass.

    Attributes
    ----------
    mass, damping, stiffness : ndarray, shape (2 + belts, 2 + belts)
        Matrices of the body without contact.
    feet : tuple of (str, tuple of int, float, float)
        For each belt: name, degrees of freedom that give the foot's x and y, inclination of the belt [rad], sense in
        which the belt runs along its tangent.
    sliding : callable
        Function of the coefficient of friction that returns the stiffness matrix of the sliding mass, shape (2, 2).
    time : float
        Unit of time, the inverse of the lowest angular frequency [s].
    """

    mass: Array
    damping: Array
    stiffness: Array
    feet: tuple[tuple[str, tuple[int, int], float, float], ...]
    sliding: Callable[[float], Array]
    time: float

    def exponents(self, friction: float) -> Array:
        """Return the exponents of sliding motion with positive frequency [1/s], the fastest growing first."""
        one, zero = np.eye(2), np.zeros((2, 2))
        first = np.block([[zero, one], [-self.sliding(friction), -self.damping[:2, :2]]])
        found = np.linalg.eigvals(first)
        found = found[found.imag > 0.0]
        return found[np.lexsort((-found.imag, -np.round(found.real * self.time, 9)))]

    @property
    def highest(self) -> float:
        """Highest angular frequency of the body without contact [rad/s]."""
        inverse = np.diag(1.0 / np.sqrt(np.diag(self.mass)))
        return float(np.sqrt(np.linalg.eigvalsh(inverse @ self.stiffness @ inverse)[-1]))

    def body(self) -> ReducedBody:
        """Return its body."""
        points = {name: numbers for name, numbers, _, _ in self.feet} | {"mass": (0, 1)}
        return ReducedBody(self.mass, self.stiffness, points=points, damping=self.damping, name="mass")

    def push(self) -> Array:
        """Return the force that presses the mass on each belt with 1 N."""
        return sum((np.array([np.sin(turn), -np.cos(turn)]) for _, _, turn, _ in self.feet), np.zeros(2))

    def start(self, friction: float, kick: float = 0.01) -> tuple[Array, Array]:
        """Return the position of sliding equilibrium, and one displaced by a kick."""
        rest = np.linalg.solve(self.sliding(friction), self.push())
        return rest, rest + kick * np.linalg.norm(rest) * np.array([1.0, 0.6])

    def system(self, friction: float) -> System:
        """Return the system pressed on belts too fast to stick, displaced by a kick from sliding equilibrium."""
        body, push, (_, place) = self.body(), self.push(), self.start(friction)
        contacts = []
        for name, _, inclination, sense in self.feet:
            belt = RigidTrack(velocity=sense * 1e3 / self.time, name=f"belt {name}")
            contacts.append(
                PointContact(body.at(name), belt, friction=Coulomb(friction), inclination=inclination, name=name)
            )
        start = InitialState(body, displacement=(*place, *(0.0 for _ in self.feet)))
        return System(contacts, drives=[Force(body.at("mass"), x=push[0], y=push[1]), start])

    def run(self, friction: float, scheme: Scheme, step: float, duration: float) -> xr.Dataset:
        """Simulate and record every step."""
        system = self.system(friction)
        point = system.drives[0].point  # type: ignore[attr-defined]
        probes = [Displacement(point, "x"), Displacement(point, "y")]
        return simulate(system, duration, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes)

    def seen(self, friction: float, scheme: Scheme, step: float, duration: float) -> Array:
        """Return the exponents of the simulated motion [1/s], the fastest growing first."""
        run = self.run(friction, scheme, step, duration)
        only_sliding(run)
        every = max(1, round(0.15 * 2.0 * pi / abs(self.exponents(friction)).max() / step))
        return exponents(run["displacement"].values[::every], every * step, self.time)


# Hoffmann's springs to the ground [N/m] and their directions [rad], and the one at the contact.
GROUNDED = (
    (2.0 * (2.0 - sqrt(3.0)) / 3.0, 5.0 * pi / 6.0),
    (2.0 * (2.0 + sqrt(3.0)) / 3.0, pi / 6.0),
)
AT_CONTACT = 4.0 / 3.0


def hoffmann(scale: float = 1.0, damping: float = 0.0, foot: float = FOOT) -> Coupled:
    """Return Hoffmann's mass: springs k1 at 150° and k2 at 30°, contact spring k3 over a belt that runs towards -x.

    Parameters
    ----------
    scale : float, optional
        Factor on all spring stiffnesses: frequencies grow with its root.
    damping : float, optional
        Coefficient of dashpots between mass and ground, along x and y [N s/m].
    foot : float, optional
        Mass behind the contact spring [kg].
    """
    grounded = sum(k * np.outer((np.cos(a), np.sin(a)), (np.cos(a), np.sin(a))) for k, a in GROUNDED)
    k3 = scale * AT_CONTACT
    stiffness = np.zeros((3, 3))
    stiffness[:2, :2] = scale * grounded
    stiffness[1:, 1:] += k3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    free = stiffness[:2, :2]
    return Coupled(
        mass=np.diag([1.0, 1.0, foot]),
        damping=np.diag([damping, damping, 0.0]),
        stiffness=stiffness,
        feet=(("floor", (0, 2), 0.0, -1.0),),
        # The normal force is -k3 y, the belt drags with mu N towards -x.
        sliding=lambda mu: free - mu * k3 * np.array([[0.0, 1.0], [0.0, 0.0]]),
        time=1.0 / sqrt(scale),
    )


SINOU_FREQUENCIES = (2.0 * pi * 100.0, 2.0 * pi * 75.0)


def sinou(damping: tuple[float, float] = (0.0, 0.0)) -> Coupled:
    """Return Hulten's mass between a wall, behind spring w1², and a floor, behind w2²; dampers to the ground."""
    w1, w2 = SINOU_FREQUENCIES
    stiffness = np.zeros((4, 4))
    for k, foot, stiff in ((0, 2, w1**2), (1, 3, w2**2)):
        stiffness[np.ix_([k, foot], [k, foot])] = stiff * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return Coupled(
        mass=np.diag([1.0, 1.0, FOOT, FOOT]),
        damping=np.diag([damping[0] * w1, damping[1] * w2, 0.0, 0.0]),
        stiffness=stiffness,
        # The wall's tangent points down and it runs up; the floor runs to -x.
        feet=(("wall", (2, 1), -pi / 2.0, -1.0), ("floor", (0, 3), 0.0, -1.0)),
        sliding=lambda mu: np.array([[w1**2, -mu * w2**2], [mu * w1**2, w2**2]]),
        time=1.0 / w2,
    )


def sinou_limit(damping: tuple[float, float]) -> float:
    """Return the coefficient of friction at which Hulten's mass becomes unstable.

    Undamped both frequencies meet: ``mu = (w1² - w2²) / (2 w1 w2)``. Damped, by Hurwitz on
    ``(s² + a s + w1²)(s² + b s + w2²) + mu² w1² w2²``.
    """
    w1, w2 = SINOU_FREQUENCIES
    a, b = damping[0] * w1, damping[1] * w2
    if a == b == 0.0:
        return (w1**2 - w2**2) / (2.0 * w1 * w2)
    cubic, square, linear = a + b, w1**2 + w2**2 + a * b, a * w2**2 + b * w1**2
    constant = (linear * cubic * square - linear**2) / cubic**2
    return sqrt(constant / (w1 * w2) ** 2 - 1.0)
