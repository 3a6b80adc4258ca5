"""Floquet multipliers of a periodic motion, and its stability in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .returning import Return

# Most products for the multipliers, and largest error of those that are returned.
MOST_PRODUCTS, LARGEST_ERROR = 200, 1e-3
# Distance of the multiplier along the cycle from 1 above which it has not been found.
FOUND = 0.02
# Norm of what a product adds, relative to the product, below which all multipliers have been found.
COMPLETE = 1e-7
# Accuracy from which multipliers are not computed again.
ACCURATE = 5e-4
# Imaginary part, relative to its size, below which a multiplier is real.
REAL = 1e-5
# Least distance from the unit circle that counts.
MARGIN = 1e-6
# Size of perturbations relative to the residual of a motion whose contacts jump at a step.
OF_RESIDUAL = 30.0
SEED = 0

FOLD, DOUBLING, TORUS = "fold", "period doubling", "Neimark-Sacker"
WORDS = {
    FOLD: "neighbouring motions depart without turning back",
    DOUBLING: "neighbouring motions depart with twice the period",
}


@dataclass(frozen=True)
class Multipliers:
    """Multipliers of the motions next to a periodic one over a period.

    Attributes
    ----------
    values : ndarray of complex
        Multipliers, the largest first.
    trivial : int or None
        Number of the one along the motion, which is 1; None if drives prescribe the phase.
    period : float
        Period [s].
    """

    values: Array
    trivial: int | None
    period: float

    @property
    def accuracy(self) -> float:
        """Distance of the trivial multiplier from 1; NaN without one."""
        return float("nan") if self.trivial is None else float(abs(self.values[self.trivial] - 1.0))

    @property
    def others(self) -> Array:
        """All multipliers but the trivial one."""
        return self.values if self.trivial is None else np.delete(self.values, self.trivial)

    @property
    def leading(self) -> complex:
        """The largest of these, 0 without any."""
        return complex(self.others[0]) if self.others.size else 0j

    @property
    def is_stable(self) -> bool:
        """Whether no neighbouring motion departs, as far as the multipliers are known."""
        return self.are_known and abs(self.leading) <= 1.0 + MARGIN

    @property
    def kind(self) -> str:
        """The bifurcation at which the leading multiplier would cross the unit circle."""
        if abs(self.leading.imag) > REAL * abs(self.leading):
            return TORUS
        return FOLD if self.leading.real >= 0.0 else DOUBLING

    @property
    def second_frequency(self) -> float:
        """Frequency [Hz] by which the leading pair of multipliers turns; NaN if the leading one is real."""
        if self.kind != TORUS:
            return float("nan")
        return float(abs(np.angle(self.leading)) / (2.0 * np.pi * self.period))

    @property
    def are_known(self) -> bool:
        """Whether they were found: the trivial one is among them, or any if there is none."""
        return self.values.size > 0 and not self.accuracy > FOUND

    @property
    def verdict(self) -> str:
        """Stability in words."""
        if not self.are_known:
            return "unknown: no multiplier is near 1, as that along the cycle must be"
        size = f"{abs(self.leading):.4g}"
        if self.is_stable and abs(self.leading) >= 1.0 - MARGIN:
            return "stable: neighbouring motions neither depart nor all return, as without damping"
        if self.is_stable:
            return f"stable: neighbouring motions return, by a factor of at most {size} in a period"
        if self.kind == TORUS:
            second, first = self.second_frequency, 1.0 / self.period
            tones = f"{first - second:.4g} and {first + second:.4g} Hz"
            return f"unstable: a pair of multipliers of size {size} adds tones at {tones}"
        return f"unstable: {WORDS[self.kind]}, by a factor of {size} in a period"


def multipliers_of(cycle: Return, is_driven: bool) -> Multipliers:
    """Return the multipliers of a periodic motion: all of them for few modes, else the largest.

    Where contacts stop, reverse or land, the place of that event within its step changes with the state, which the
    derivative at a state has to first order in the step. If the multiplier along the cycle is far from 1, they are
    those of mean derivatives over two steps, unless that is farther from it. If drives prescribe the phase, no
    multiplier tells; mean derivatives are taken where contacts stop or reverse.
    """
    if is_driven:
        return _by_arnoldi(cycle, cycle.mean_product if cycle.passed.stops else _near(cycle), None)
    found = _by_arnoldi(cycle, _near(cycle), 1.0)
    if not found.accuracy < ACCURATE:
        mean = _by_arnoldi(cycle, cycle.mean_product, 1.0)
        return mean if mean.accuracy < found.accuracy else found
    return found


def _near(cycle: Return) -> Callable[[Array], Array]:
    """Return the product of the derivative at a cycle."""
    return lambda direction: cycle.product(direction, OF_RESIDUAL)


def _by_arnoldi(cycle: Return, product: Callable[[Array], Array], trivial: float | None) -> Multipliers:
    """Return the multipliers by Arnoldi's method; `trivial` is the value of the one along the cycle."""
    counted, norm = cycle.vectors.counted, cycle.vectors.norm
    # The first product is a motion that the march has reached.
    direction = product(cycle.vectors.random(SEED, cycle.orbit.vector))
    size = norm(direction)
    if not size > 0.0:
        return Multipliers(np.zeros(1, dtype=complex), None, cycle.orbit.period)
    basis = [direction / size]
    numbers = [counted(basis[0])]
    projected = np.zeros((MOST_PRODUCTS + 1, MOST_PRODUCTS))
    used, left = 0, np.inf
    for k in range(MOST_PRODUCTS):
        direction = product(basis[k])
        whole = norm(direction)
        for _ in range(2):
            for i, one in enumerate(basis):
                part = numbers[i] @ counted(direction)
                projected[i, k] += part
                direction = direction - part * one
        left, used = norm(direction), k + 1
        projected[k + 1, k] = left
        if left <= COMPLETE * max(whole, 1.0):
            break
        basis.append(direction / left)
        numbers.append(counted(basis[-1]))
    values, vectors = np.linalg.eig(projected[:used, :used])
    errors = left * np.abs(vectors[-1])
    values = values[errors <= LARGEST_ERROR]
    values = values[np.argsort(-np.abs(values), kind="stable")]
    along = None if trivial is None or not values.size else int(np.argmin(np.abs(values - trivial)))
    return Multipliers(values, along, cycle.orbit.period)
