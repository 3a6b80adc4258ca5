"""Probability of growth for random parameters: modes that merge, and a falling law of correlated coefficients."""

from __future__ import annotations

from collections.abc import Mapping
from math import exp, sqrt
from typing import Any

import numpy as np
import scipy.stats

from ..contact import ExponentialWeakening
from ..studies.growth_probability import mode_probability
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch
from .systems.mode_coupling import hoffmann
from .systems.on_belts import Slider

SAMPLES = 500
# A standard error is exceeded four times in one of 16 000 cases.
ERRORS = 4.0
REASON = f"four standard errors of a share of {SAMPLES} samples, 4 √(p (1 - p) / n)"
# Friction at which Hoffmann's modes merge, and distributions of it.
MERGE = 0.75
FRICTIONS = {
    "normal, 0.7 ± 0.1": scipy.stats.norm(0.7, 0.1),
    "uniform, 0.5 to 0.8": scipy.stats.uniform(0.5, 0.3),
    "lognormal, median 0.6": scipy.stats.lognorm(0.3, scale=0.6),
}
# Of a mass on a belt: load [N], slip speed and speed of the law [m/s]; means and deviations of coefficients at rest and
# in fast sliding [1], and of a dashpot [N s/m]; correlations of the first and the last two.
LOAD, BELT, FALLS = 10.0, 0.1, 0.2
COEFFICIENTS = {"static": (0.6, 0.03), "kinetic": (0.3, 0.03), "dashpot": (8.5, 0.6)}
CORRELATIONS = ((0.0, 0.0), (0.8, 0.3), (-0.8, 0.5))


def _share(name: str, known: float, obtained: float) -> Row:
    return Row(name, known, obtained, ERRORS * sqrt(known * (1.0 - known) / SAMPLES), REASON)


def random_friction() -> Outcome:
    """Hoffmann's model with random friction: two modes merge at 0.75, and one of them grows beyond."""
    rows, curves = [], []
    for seed, (name, friction) in enumerate(FRICTIONS.items()):
        given = {"friction": friction}
        found = mode_probability(hoffmann().system, given, samples=SAMPLES, seed=seed)
        rows.append(_share(f"friction {name}: a mode grows", float(friction.sf(MERGE)), float(found["probability"][0])))
        rows.append(Row(f"friction {name}: bands of growing modes", 1, found.sizes["band"], 0.0, "a count"))
        grid = np.sort(found["friction"].values)
        growing = np.sort(found["friction"].values[found["unstable_modes"].values > 0.0])
        curves.append(Curve(grid, 1.0 - np.arange(SAMPLES) / SAMPLES, f"{name}: share above"))
        lowest = float(growing[0])
        curves.append(Curve(np.array([lowest]), np.array([growing.size / SAMPLES]), f"{name}: grows", marks=True))
    return Outcome(rows, Sketch("coefficient of friction", "probability", curves))


def weakening_slider(static: float, kinetic: float, dashpot: float) -> System:
    """Return a mass on a spring and a belt, whose friction falls with speed."""
    return Slider(1.0, 1e4, LOAD, ExponentialWeakening(static, kinetic, FALLS), belt=BELT, dashpot=dashpot).system()


def probability_of_growth(deviations: Mapping[str, Any], first: float, second: float) -> float:
    """Return the probability that the vibration grows, for normal coefficients and a normal dashpot.

    It grows if the slope of friction exceeds the dashpot: ``w = N exp(-v / V) / V (static - kinetic) - dashpot > 0``,
    which is linear in these, so that it is normal, too.
    """
    weight = LOAD * exp(-BELT / FALLS) / FALLS
    along = np.array([weight, -weight, -1.0])
    mean, deviation = np.array(list(deviations.values())).T
    correlation = np.array([[1.0, first, 0.0], [first, 1.0, second], [0.0, second, 1.0]])
    spread = along * deviation
    return float(scipy.stats.norm.cdf(along @ mean / sqrt(spread @ correlation @ spread)))


def correlated_coefficients() -> Outcome:
    """A mass on a belt: both coefficients of a falling law are correlated, and one of them with the dashpot."""
    rows, curves = [], []
    given = {name: scipy.stats.norm(*numbers) for name, numbers in COEFFICIENTS.items()}
    for seed, (first, second) in enumerate(CORRELATIONS):
        pairs = {("static", "kinetic"): first, ("kinetic", "dashpot"): second}
        found = mode_probability(weakening_slider, given, samples=SAMPLES, correlations=pairs, seed=seed)
        known = probability_of_growth(COEFFICIENTS, first, second)
        rows.append(
            _share(f"correlations {first:g} and {second:g}: the mode grows", known, float(found["probability"][0]))
        )
        fall = found["static"].values - found["kinetic"].values
        words = f"correlations {first:g} and {second:g}"
        curves.append(Curve(fall, found["dashpot"].values, words, marks=True))
    ends = np.array([0.1, 0.5])
    curves.append(Curve(ends, LOAD * exp(-BELT / FALLS) / FALLS * ends, "limit of growth"))
    return Outcome(rows, Sketch("fall of friction", "dashpot [N s/m]", curves))


CASES = (
    Case(
        "random-friction",
        "Probability that Hoffmann's modes merge for random friction",
        "probability of a coefficient above 0.75; system of Hoffmann, Fischer, Allgaier & Gaul 2002",
        random_friction,
    ),
    Case(
        "correlated-friction",
        "Probability of growth for correlated coefficients of a falling law",
        "normal distribution of the slope of friction less the dashpot, which is linear in both coefficients",
        correlated_coefficients,
    ),
)
