"""Branches of a viscoelastic spring, fitted to a stiffness and a loss factor over frequency."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy  # its parts are imported on first use

from ..arrays import Array

# Damping rate of a branch over the angular frequency at the end of the table: its mass hardly matters up to there.
LIGHT = 4.0
# Relative error with which fewer branches are enough, most branches, and loss factor below which errors are absolute.
ACCURATE, MOST, LOSSLESS = 0.02, 8, 0.02
# Least stiffness at rest relative to the least of the table, as nothing is known of slower creep; trials of a search.
LEAST_AT_REST, TRIALS = 0.5, 40


class Branch(NamedTuple):
    """A spring that relaxes, in parallel to others: ``stiffness (p² + rate p) / (p² + rate p + frequency²)``.

    Here p is i times the angular frequency. It is a spring to a coordinate with a mass and a dashpot, which is passive.

    Attributes
    ----------
    stiffness : float
        Stiffness of a fast motion [N/m].
    angular_frequency : float
        That of its coordinate [rad/s].
    damping_rate : float
        That of its coordinate [1/s].
    """

    stiffness: float
    angular_frequency: float
    damping_rate: float


@dataclass(frozen=True)
class Relaxation:
    """A stiffness over frequency as a stiffness at rest with branches.

    Attributes
    ----------
    at_rest : float
        Stiffness at rest [N/m].
    branches : tuple of Branch
        Branches in parallel to it.
    error : float
        Largest relative difference from the stiffness and the loss factor of the table [1].
    """

    at_rest: float
    branches: tuple[Branch, ...]
    error: float

    @property
    def fast(self) -> float:
        """Stiffness of a fast motion [N/m]."""
        return self.at_rest + sum(one.stiffness for one in self.branches)

    def stiffness(self, angular: Array) -> Array:
        """Return the complex stiffness at angular frequencies [N/m]."""
        found = np.full(angular.shape, self.at_rest, dtype=complex)
        for one in self.branches:
            found += one.stiffness * _relaxing(angular, one.angular_frequency, one.damping_rate)
        return found


def _relaxing(angular: Array, frequency: Array | float, rate: float) -> Array:
    """Return the share of its stiffness that a branch has at angular frequencies."""
    moved = 1j * rate * angular - angular**2
    return np.asarray(moved / (moved + np.square(frequency)))


@lru_cache(maxsize=256)
def relaxation_of(frequency: tuple[float, ...], stiffness: tuple[float, ...], loss: tuple[float, ...]) -> Relaxation:
    """Return the fewest branches that have a stiffness [N/m] and a loss factor at frequencies [Hz], or the best.

    For given rates of the branches their stiffnesses are a linear problem with numbers that are not below zero; the
    rates follow from least squares, whose first guesses are spread over the table.
    """
    angular = 2.0 * np.pi * np.array(frequency)
    table = np.array(stiffness) * (1.0 + 1j * np.array(loss))
    best = _fitted(angular, table, np.zeros(0))
    for count in range(1, MOST + 1):
        if best.error <= ACCURATE:
            break
        best = min([best, *_with_branches(angular, table, count)], key=lambda one: one.error)
    return best


def _with_branches(angular: Array, table: Array, count: int) -> list[Relaxation]:
    """Return fits with a number of branches."""
    low, high = np.log(angular[0]), np.log(angular[-1])
    spread = (np.arange(count) + 0.5) / count
    found = []
    for wider in (0.3, 1.0):
        guess = low - wider + (high - low + 2.0 * wider) * spread

        def missed(rates: Array) -> Array:
            return _missed(_fitted(angular, table, np.exp(rates)).stiffness(angular), table)

        bounds = (low - 4.0, high + 1.0)
        result = scipy.optimize.least_squares(missed, guess, bounds=bounds, max_nfev=TRIALS)
        found.append(_fitted(angular, table, np.exp(result.x)))
    return found


def _missed(found: Array, table: Array) -> Array:
    """Return what stiffnesses miss of the parts of a table, each relative to this part, one after the other."""
    missed = found - table
    return np.concatenate([missed.real / table.real, missed.imag / _losses(table)])


def _losses(table: Array) -> Array:
    """Return the imaginary parts of a table, at least those of a small loss factor."""
    return np.maximum(table.imag, LOSSLESS * table.real)


def _fitted(angular: Array, table: Array, rates: Array) -> Relaxation:
    """Return the best stiffnesses of branches that relax at given rates [1/s]."""
    damping = LIGHT * angular[-1]
    frequencies = np.sqrt(rates * damping)
    columns = [np.ones(angular.shape, dtype=complex), *(_relaxing(angular, one, damping) for one in frequencies)]
    # The stiffness at rest has a part that is no unknown, so that it is never zero.
    least, scale = LEAST_AT_REST * table.real.min(), table.real.max()
    rows = np.concatenate([np.real(columns) / table.real, np.imag(columns) / _losses(table)], axis=1).T
    right = np.concatenate([(table.real - least) / table.real, table.imag / _losses(table)])
    shares = scale * scipy.optimize.nnls(scale * rows, right)[0]
    branches = tuple(
        Branch(float(share), float(one), float(damping))
        for share, one in zip(shares[1:], frequencies, strict=True)
        if share > 0.0
    )
    found = Relaxation(float(least + shares[0]), branches, 0.0)
    moduli = found.stiffness(angular)
    stiffer = np.abs(moduli.real / table.real - 1.0)
    lossier = np.abs(moduli.imag / moduli.real - table.imag / table.real) / (_losses(table) / table.real)
    return Relaxation(found.at_rest, branches, float(max(stiffer.max(), lossier.max())))
