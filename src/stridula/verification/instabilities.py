"""Mode coupling: growth and frequency of a preloaded sliding contact after a small kick, measured in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from ..arrays import Array
from ..bodies import ReducedBody
from ..contact import Coulomb, PointContact, RigidTrack
from ..drives import Force, InitialState
from ..integration import simulate
from ..lowering.schemes import Scheme
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme

SLIDING = 2
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

    def push(self) -> Array:
        """Return the force that presses the mass on each belt with 1 N."""
        return sum((np.array([np.sin(turn), -np.cos(turn)]) for _, _, turn, _ in self.feet), np.zeros(2))

    def start(self, friction: float, kick: float = 0.01) -> tuple[Array, Array]:
        """Return the position of sliding equilibrium, and one displaced by a kick."""
        rest = np.linalg.solve(self.sliding(friction), self.push())
        return rest, rest + kick * np.linalg.norm(rest) * np.array([1.0, 0.6])

    def system(self, friction: float) -> System:
        """Return the system pressed on belts too fast to stick, displaced by a kick from sliding equilibrium."""
        points = {name: numbers for name, numbers, _, _ in self.feet} | {"mass": (0, 1)}
        body = ReducedBody(self.mass, self.stiffness, points=points, damping=self.damping, name="mass")
        push, (_, place) = self.push(), self.start(friction)
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


def only_sliding(run: xr.Dataset) -> None:
    """Raise RuntimeError unless every step of a run slid."""
    if bool((run["status"] != SLIDING).any()):
        raise RuntimeError("the contact must slide all the time")


def exponents(motion: Array, interval: float, unit: float, count: int = 2) -> Array:
    """Return the exponents with positive frequency of samples that are sums of `count` pairs and a constant (Prony).

    Each difference of samples is a linear combination of the 2 `count` before it, the same in all channels; the roots
    of that recurrence are the exponentials over an interval.
    """
    moves = np.diff(motion, axis=0)
    moves /= np.abs(moves).max()
    past = np.stack([moves[k : len(moves) - 2 * count + k] for k in range(2 * count)], axis=-1)
    weights = np.linalg.lstsq(past.reshape(-1, 2 * count), moves[2 * count :].reshape(-1), rcond=None)[0]
    roots = np.roots(np.concatenate([[1.0], -weights[::-1]]))
    found = np.log(roots.astype(complex)) / interval
    found = found[found.imag > 0.0]
    found = found[np.lexsort((-found.imag, -np.round(found.real * unit, 5)))][:count]
    return np.pad(found, (0, count - found.size), constant_values=complex(np.nan, np.nan))


def hoffmann() -> Coupled:
    """Return Hoffmann's mass: springs k1 at 150° and k2 at 30°, contact spring k3 over a belt that runs towards -x."""
    k1, k2, k3 = 2.0 * (2.0 - sqrt(3.0)) / 3.0, 2.0 * (2.0 + sqrt(3.0)) / 3.0, 4.0 / 3.0
    ways = [(k1, np.radians(150.0)), (k2, np.radians(30.0))]
    grounded = sum(k * np.outer((np.cos(a), np.sin(a)), (np.cos(a), np.sin(a))) for k, a in ways)
    stiffness = np.zeros((3, 3))
    stiffness[:2, :2] = grounded
    stiffness[1:, 1:] += k3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    free = stiffness[:2, :2]
    return Coupled(
        mass=np.diag([1.0, 1.0, FOOT]),
        damping=np.zeros((3, 3)),
        stiffness=stiffness,
        feet=(("floor", (0, 2), 0.0, -1.0),),
        # The normal force is -k3 y, the belt drags with mu N towards -x.
        sliding=lambda mu: free - mu * k3 * np.array([[0.0, 1.0], [0.0, 0.0]]),
        time=1.0,
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


def bound(model: Coupled, step: float) -> float:
    """Return the relative error of an exponent: of second order in the step, ``(W h)² / 12``.

    W is the highest frequency of the body without contact, since the exact modal scheme integrates those modes and
    holds the foot by impulses. Central differences have ``|s|² h² / 24``, less than that.
    """
    return (model.highest * step) ** 2 / 12.0


REASON = "second order: |s| (W h)² / 12, W the highest frequency without contact"


def _rows(model: Coupled, friction: float, scheme: Scheme, step: float, duration: float) -> list[Row]:
    known, found = model.exponents(friction), model.seen(friction, scheme, step, duration)
    tolerance = float(abs(known[0])) * bound(model, step)
    words = f"friction {friction:g}"
    rows = [
        Row(f"{words}: frequency {k + 1}", s.imag, z.imag, tolerance, REASON, "rad/s", scheme.name)
        for k, (s, z) in enumerate(zip(known, found, strict=True))
        if k == 0 or abs(s.imag - known[0].imag) > tolerance
    ]
    growth = Row(f"{words}: growth", known[0].real, found[0].real, tolerance, REASON, "1/s", scheme.name)
    return [*rows, growth]


def _limit_undamped(model: Coupled, low: float, high: float, scheme: Scheme, step: float, duration: float) -> float:
    """Return the friction at which both frequencies meet, from motions on both sides.

    The squares of the two exponents are the roots of a polynomial whose discriminant is smooth in the coefficient of
    friction and passes zero where they meet.
    """

    def discriminant(friction: float) -> float:
        first, second = model.seen(friction, scheme, step, duration) ** 2
        if abs(first.imag) > 1e-3 * abs(first):
            second = np.conj(first)
        return float(((first - second) ** 2).real)

    return float(brentq(discriminant, low, high, xtol=1e-7))


def hoffmann_case() -> Outcome:
    """Motion below and above flutter, and its onset."""
    model, step, duration = hoffmann(), 2e-3, 20.0
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        run = model.run(0.9, scheme, step, duration)
        curves.append(Curve(run["time"].values, run["displacement"].values[:, 0], f"{scheme.name}, friction 0.9"))
        limit = _limit_undamped(model, 0.6, 0.9, scheme, step, duration)
        # The discriminant is a difference of squares, which are off by 2 |s|² (W h)² / 12 each, over its slope 16 / 3.
        off = 8.0 * sqrt(2.0) * 2.0 * bound(model, step) / (16.0 / 3.0)
        reason = "second order, (W h)² / 12 of each exponent, over the slope of the discriminant"
        return [
            *_rows(model, 0.5, scheme, step, duration),
            *_rows(model, 0.9, scheme, step, duration),
            Row("coefficient of friction at flutter", 0.75, limit, off, reason, "1", scheme.name),
        ]

    return Outcome(by_scheme(rows), Sketch("time", "displacement along the belt", curves))


SINOU_DAMPINGS = ((0.0, 0.0), (0.02, 0.02), (0.02, 0.06))


def sinou_case() -> Outcome:
    """Onset of flutter without damping, with equal and with unequal damping; growth on both sides."""
    step, duration = 1e-5, 0.06
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        found: list[Row] = []
        for damping in SINOU_DAMPINGS:
            model, limit = sinou(damping), sinou_limit(damping)
            words = f"damping {damping[0]:g}, {damping[1]:g}"
            if any(damping):
                seen = brentq(
                    lambda mu, model=model: model.seen(mu, scheme, step, duration)[0].real,
                    0.95 * limit,
                    1.05 * limit,
                    xtol=1e-8,
                )
            else:
                seen = _limit_undamped(model, 0.8 * limit, 1.2 * limit, scheme, step, duration)
            reason = "second order: the growth is off by |s| (W h)² / 12, over its slope in the coefficient"
            found.append(
                Row(f"{words}: friction at flutter", limit, seen, _slack(model, limit, step), reason, "1", scheme.name)
            )
            for share in (0.9, 1.1):
                for row in _rows(model, round(share * limit, 4), scheme, step, duration):
                    found.append(Row(f"{words}, {row.quantity}", *_rest(row)))
        run = sinou((0.02, 0.06)).run(0.3, scheme, step, duration)
        words = f"{scheme.name}, friction 0.3"
        curves.append(Curve(run["time"].values, run["displacement"].values[:, 0], words))
        return found

    return Outcome(by_scheme(rows), Sketch("time [s]", "displacement [m]", curves))


def _rest(row: Row) -> tuple[float, float, float, str, str, str]:
    return row.expected, row.obtained, row.tolerance, row.reason, row.units, row.scheme


def _slack(model: Coupled, limit: float, step: float) -> float:
    """Return the error of a limit caused by an error of the exponents."""
    if not model.damping.any():
        w1, w2 = SINOU_FREQUENCIES
        # Discriminant (w1² - w2²)² - 4 mu² w1² w2² of slope 8 mu w1² w2²; squares off by 2 |s|² (W h)² / 12 each.
        square = abs(model.exponents(limit)[0]) ** 2
        return 8.0 * square**2 * bound(model, step) / (8.0 * limit * (w1 * w2) ** 2) * 2.0
    off = float(abs(model.exponents(limit)[0])) * bound(model, step)
    slope = (model.exponents(limit * 1.001)[0].real - model.exponents(limit * 0.999)[0].real) / (0.002 * limit)
    return off / slope


CASES = (
    Case(
        "hoffmann",
        "Mode coupling of two degrees of freedom",
        "Hoffmann, Fischer, Allgaier & Gaul 2002, A minimal model for studying properties of the mode-coupling type "
        "instability in friction induced oscillations, Mech. Res. Commun. 29",
        hoffmann_case,
    ),
    Case(
        "sinou",
        "Mode coupling with damping",
        "Hultén 1993, SAE 932965; Sinou & Jézéquel 2007, Mode coupling instability in friction-induced vibrations and "
        "its dependency on system parameters including damping, Eur. J. Mech. A 26",
        sinou_case,
    ),
)
