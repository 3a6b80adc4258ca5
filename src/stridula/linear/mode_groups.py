"""Modes alone, modes that merge with another one, and modes of equal exponents, with derivatives by parameters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..arrays import Array
from .invariant_pairs import InvariantPair, invariant_pair
from .pencils import Pencil
from .vibration import Exponents

ALONE, MERGING, DOUBLE = "alone", "merging", "double"
# Relative distance of exponents below which they count as equal: rounding separates merged ones by its square root.
EQUAL = 1e-6
# Relative distance up to which the nearest mode is followed together with a mode.
NEAR = 0.1
# Factor by which others are farther away from the middle of modes that are followed together, and most of these.
APART, MOST = 1.5, 8
# Shapes with a larger assurance criterion are more alike than not: the modes merge.
ALIKE = 0.5
# Relative size of random parts of the first shapes, so that shapes of equal exponents are independent.
STIRRED = 1e-6


@dataclass(frozen=True)
class ModeGroup:
    """A mode with those that it is followed with.

    Attributes
    ----------
    kind : str
        ``alone``; ``merging``: the shape is more like that of another mode than not; ``double``: other modes have the
        same exponent, with shapes of their own.
    partner : int
        Number of the mode with which it forms a pair, its own for a pair with its conjugate, -1 for none.
    exponent : complex
        The exponent [1/s].
    rank : int
        Place of the mode among those of equal exponents.
    pair : InvariantPair
        Their subspaces.
    """

    kind: str
    partner: int
    exponent: complex
    rank: int
    pair: InvariantPair

    def slope(self, change: Array) -> complex:
        """Return the derivative of the exponent from that of the matrix, NaN where merged modes have none."""
        if self.kind == DOUBLE:
            return complex(self._split(change)[self.rank])
        values, vectors = np.linalg.eig(self.pair.matrix)
        if self.kind == MERGING and self._is_merged(values):
            return complex(np.nan, np.nan)
        along = np.linalg.solve(vectors, change @ vectors)
        return complex(along.diagonal()[np.abs(values - self.exponent).argmin()])

    def moved(self, change: Array, amount: float) -> complex:
        """Return the change of the exponent for a finite change of the parameter, by the matrix of the group."""
        if self.kind == DOUBLE:
            return amount * complex(self._split(change)[self.rank])
        values = np.linalg.eigvals(self.pair.matrix)
        after = np.linalg.eigvals(self.pair.matrix + amount * change)
        _, order = linear_sum_assignment(np.abs(values[:, None] - after))
        number = int(np.abs(values - self.exponent).argmin())
        return complex(after[order[number]] - values[number])

    def invariants(self, change: Array) -> tuple[complex, complex]:
        """Return the derivatives of sum and product of the exponents of a pair, NaN for a mode alone."""
        matrix = self.pair.matrix
        if self.kind == ALONE or len(matrix) != 2:
            return complex(np.nan, np.nan), complex(np.nan, np.nan)
        others = np.trace(matrix) * np.eye(2) - matrix
        return complex(np.trace(change)), complex(np.trace(others @ change))

    def _split(self, change: Array) -> Array:
        """Return the derivatives of equal exponents, those that grow most first."""
        slopes = np.linalg.eigvals(change)
        return slopes[np.lexsort((-slopes.imag, -slopes.real))]

    def _is_merged(self, values: Array) -> bool:
        return bool(np.ptp(values.real) + np.ptp(values.imag) <= EQUAL * np.abs(values).max())


def group_of(pencil: Pencil, found: Exponents, number: int) -> ModeGroup:
    """Return a mode with the others of its exponent or, where there are none, with the nearest one.

    Parameters
    ----------
    pencil : Pencil
        Small motions.
    found : Exponents
        All known modes, one of each conjugate pair.
    number : int
        Number of the mode.
    """
    values = np.concatenate([found.values, found.values.conj()])
    shapes = np.hstack([found.shapes, found.shapes.conj()])
    count, exponent = found.values.size, complex(found.values[number])
    there = np.abs(shapes).max(axis=0, initial=0.0) > 0.0
    there[count:] &= found.values.imag > 0.0
    there[number] = False
    distance = np.where(there, np.abs(values - exponent), np.inf) / abs(exponent)
    equal = np.flatnonzero(distance <= EQUAL).tolist()
    nearest = int(distance.argmin())
    # In order, so that a pair is the same for both.
    members = sorted([number, *equal] if equal else _near(values, distance, number))
    there[members] = False
    others = np.abs(values[there] - values[members].mean()).min(initial=abs(exponent))
    pair = invariant_pair(pencil, values[members].tolist(), _stirred(shapes[:, members]), float(others))
    if equal:
        spread = pair.matrix - exponent * np.eye(len(members))
        kind = DOUBLE if np.abs(spread).max() <= EQUAL * abs(exponent) else MERGING
    else:
        both = [number, nearest]
        kind = MERGING if len(members) > 1 and _alike(pencil, values[both], shapes[:, both]) > ALIKE else ALONE
    partner = nearest % count if kind != ALONE and len(members) == 2 else -1
    return ModeGroup(kind, partner, exponent, int(np.sum(np.array(equal, dtype=int) < number)), pair)


def _near(values: Array, distance: Array, number: int) -> list[int]:
    """Return a mode and the nearest one, with all others that are not farther from their middle by a factor."""
    order = np.argsort(distance, kind="stable")
    members = [number]
    if distance[order[0]] > NEAR:
        return members
    for member in order[:MOST].tolist():
        middle = values[members].mean()
        if len(members) > 1 and np.abs(values[member] - middle) > APART * np.abs(values[members] - middle).max():
            break
        members.append(member)
    return members


def _alike(pencil: Pencil, values: Array, shapes: Array) -> float:
    """Return the assurance criterion of two modes, of displacements and velocities of what has mass."""
    moved = pencil.mass.diagonal()[:, None] * shapes
    one, other = np.vstack([abs(values[0]) * moved, values * moved]).T
    size = float((np.abs(one) ** 2).sum() * (np.abs(other) ** 2).sum())
    return float(np.abs(one.conj() @ other) ** 2 / size) if size else 0.0


def _stirred(shapes: Array) -> Array:
    noise = np.random.default_rng(0).standard_normal(shapes.shape)
    return np.asarray(shapes + STIRRED * np.abs(shapes).max(axis=0) * noise)
