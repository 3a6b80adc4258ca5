"""Mode coupling: growth and frequency of a preloaded sliding contact after a small kick, measured in time."""

from __future__ import annotations

from math import sqrt

import numpy as np
from scipy.optimize import brentq

from ..lowering.schemes import Scheme
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .systems.mode_coupling import SINOU_FREQUENCIES, Coupled, hoffmann, sinou, sinou_limit


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
        # The discriminant is a difference of squares, each with an error of 2 |s|² (W h)² / 12; its slope is 16 / 3.
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
