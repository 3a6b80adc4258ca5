"""Painlevé's rod: rigid, at an angle to the ground, digging in."""

from __future__ import annotations

from math import pi, radians, tan

import numpy as np
import xarray as xr

from ..bodies import FiniteElementBeam, Material, Rectangle
from ..contact import Coulomb, PointContact, RigidTrack
from ..drives import Drive, Gravity, InitialVelocity
from ..integration import simulate
from ..lowering.schemes import Scheme
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme

ANGLES = (30.0, 45.0, 60.0, 75.0)
STEP = 1e-5


def painleve_limit(angle: float) -> float:
    """Return the coefficient of friction beyond which a sliding rod at `angle` [rad] to the ground jams.

    A force N at the end, with friction mu N against the sliding, moves that end along the normal by
    ``1/m (1 + 3 cos² - 3 mu sin cos)`` of it for a uniform rod, ``I = m L² / 12``: zero at mu = (tan + 4 / tan) / 3.
    """
    return (tan(angle) + 4.0 / tan(angle)) / 3.0


def slide(angle: float, friction: float, scheme: Scheme, steps: int = 20) -> xr.Dataset:
    """Simulate a rigid rod thrown along the ground with its end leading."""
    # The beam's angle is from the normal; inclined forward over its tip it digs in when it moves towards -x.
    # A cutoff below the first bending mode leaves only rigid motions.
    steel, square = Material(2.1e11, 7800.0), Rectangle(0.01, 0.01)
    rod = FiniteElementBeam(steel, square, 0.4, angle=pi / 2.0 - angle, elements=1, cutoff=1.0, root_support="free")
    drives: list[Drive] = [InitialVelocity(rod, x=-2.0), Gravity()]
    system = System(PointContact(rod.tip, RigidTrack(), friction=Coulomb(friction)), drives=drives)
    return simulate(system, steps * STEP, scheme=scheme, step=STEP, sample_rate=1.0 / STEP, probes=[])


def found_limit(angle: float, scheme: Scheme, width: float) -> float:
    """Return the coefficient of friction above which steps jam, by bisection to `width`."""
    low, high = 1.0, 4.0
    while high - low > width:
        middle = 0.5 * (low + high)
        jams = float(slide(angle, middle, scheme)["jammed_steps"].sum()) > 0.0
        low, high = (low, middle) if jams else (middle, high)
    return 0.5 * (low + high)


def painleve() -> Outcome:
    """Limit at four angles, and the laws of contact beyond it."""
    width = 1e-6
    angles = np.radians(np.linspace(20.0, 80.0, 200))
    curves = [Curve(np.degrees(angles), np.array([painleve_limit(float(a)) for a in angles]), "closed form")]

    def rows(scheme: Scheme) -> list[Row]:
        found, limits = [], []
        for degrees in ANGLES:
            limit = found_limit(radians(degrees), scheme, width)
            limits.append(limit)
            known, reason = painleve_limit(radians(degrees)), "bisected to 1e-6, for any step"
            found.append(Row(f"limit at {degrees:g}°", known, limit, width, reason, "1", scheme.name))
        curves.append(Curve(np.array(ANGLES), np.array(limits), f"first jam, {scheme.name}", marks=True))
        return [*found, *_laws(scheme)]

    return Outcome(by_scheme(rows), Sketch("angle to the ground [°]", "coefficient of friction", curves))


def _laws(scheme: Scheme) -> list[Row]:
    """Return the laws of contact at every step, 20 % beyond the limit at 45°."""
    friction = 1.2 * painleve_limit(radians(45.0))
    run = slide(radians(45.0), friction, scheme, steps=2000)
    normal, tangential, gap = (run[name].values for name in ("normal_force", "tangential_force", "gap"))
    weight = 7800.0 * 1e-4 * 0.4 * 9.80665
    largest = max(weight, float(normal.max()))
    reason = "the laws hold at every step; round-off of the largest force and of 1 m"

    def row(quantity: str, obtained: float, scale: float, units: str) -> Row:
        return Row(f"beyond the limit: {quantity}", 0.0, max(0.0, obtained), 1e-12 * scale, reason, units, scheme.name)

    return [
        row("largest pull of the ground", float(-normal.min()), largest, "N"),
        row("deepest overlap", float(-gap.min()), 1.0, "m"),
        row("largest force on an open gap, times the gap", float((normal * np.abs(gap)).max()), largest, "N m"),
        row("largest force outside the cone", float((np.abs(tangential) - friction * normal).max()), largest, "N"),
    ]


CASES = (
    Case(
        "painleve",
        "Painlevé's rod jams",
        "Painlevé 1895; Génot & Brogliato 1999, New results on Painlevé paradoxes, Eur. J. Mech. A 18",
        painleve,
    ),
)
