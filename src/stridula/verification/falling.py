"""Friction that falls with speed: sliding on a belt grows by negative damping."""

from __future__ import annotations

from math import exp, sqrt

from ..contact import ExponentialWeakening, FrictionLaw, LinearWeakening, Stribeck
from ..lowering.schemes import Scheme
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .instabilities import exponents, only_sliding
from .sliders import Slider

MASS, STIFFNESS, NORMAL, BELT = 1.0, 4.0, 10.0, 0.5


def laws() -> dict[str, tuple[FrictionLaw, float, float]]:
    """Return laws, their coefficient of friction at the belt's velocity, and its fall with velocity there [s/m]."""
    drop = 0.4 - 0.25
    gauss, fall = drop * exp(-((BELT / 0.4) ** 2)), drop * exp(-BELT / 0.4)
    return {
        "linear weakening": (LinearWeakening(0.4, slope=0.02, kinetic=0.1), 0.4 - 0.02 * BELT, 0.02),
        "Stribeck, viscous": (
            Stribeck(0.4, 0.25, velocity=0.4, viscous=0.05),
            0.25 + gauss + 0.05 * BELT,
            2.0 * BELT / 0.4**2 * gauss - 0.05,
        ),
        "exponential weakening": (ExponentialWeakening(0.4, 0.25, velocity=0.4), 0.25 + fall, fall / 0.4),
    }


def exponent(slope: float) -> complex:
    """Return the exponent [1/s] of ``m x'' - N slope x' + k x = 0``, the motion about steady sliding."""
    growth = NORMAL * slope / (2.0 * MASS)
    return complex(growth, sqrt(STIFFNESS / MASS - growth**2))


def falling() -> Outcome:
    """Growth and frequency after a kick so small that only the slope of a curved law matters."""
    step, duration, kick = 5e-4, 6.0, 1e-7
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        found = []
        for name, (law, ratio, slope) in laws().items():
            known = exponent(slope)
            slider = Slider(MASS, STIFFNESS, NORMAL, law, position=ratio * NORMAL / STIFFNESS + kick, belt=BELT)
            run = slider.run(duration, step, scheme)
            only_sliding(run)
            place = run["displacement"].values
            curves.append(Curve(run["time"].values, place[:, 0] - place[0, 0] + kick, f"{scheme.name}, {name}"))
            every = round(0.5 / step)
            seen = exponents(place[::every], every * step, 1.0, count=1)[0]
            # The next term of the law's series, at the velocity to which the kick has grown.
            swing = kick * abs(known) * exp(known.real * duration)
            tolerance = abs(known) * (abs(known) * step) ** 2 / 12.0 + abs(known) * swing / BELT
            reason = "second order: |s| (|s| h)² / 12, and the swing's velocity over the belt's"
            found += [
                Row(f"{name}: growth", known.real, seen.real, tolerance, reason, "1/s", scheme.name),
                Row(f"{name}: frequency", known.imag, seen.imag, tolerance, reason, "rad/s", scheme.name),
            ]
        return found

    return Outcome(by_scheme(rows), Sketch("time [s]", "displacement from steady sliding [m]", curves))


CASES = (
    Case(
        "falling-friction",
        "Mass on a belt under friction that falls with speed",
        "closed form: negative damping N mu' / 2m (Mills 1938; e.g. Armstrong-Hélouvry, Dupont & Canudas de Wit 1994, "
        "Automatica 30)",
        falling,
    ),
)
