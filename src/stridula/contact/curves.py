"""Curves of a coefficient over the slip speed in pieces: the form of tables and of users' formulas in the march."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array

# Coefficients of a piece of a formula, and of one between points of a table.
OF_FORMULA, OF_TABLE = 8, 4
# Decades below and above the speed that is characteristic of a formula in which pieces are at most a decade wide.
DECADES_BELOW, DECADES_ABOVE = 6, 4
# Error of a piece relative to the coefficient that is round-off; halvings of a piece of a formula; most pieces.
ROUND_OFF, HALVINGS, MOST_PIECES = 2e-14, 44, 4000
# Jump within a piece that is no more halved, relative to the coefficient, which a formula must not have.
JUMP = 1e-6
# Change of the ratio, in units of the whole, that a bend makes over the speed that is called its own.
BENT = 1.5

Formula = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Curve:
    """A coefficient over the slip speed, a polynomial in each piece; beyond the last piece it is straight.

    Attributes
    ----------
    speed : ndarray, shape (pieces + 1,)
        Speeds between pieces [m/s], rising from 0.
    coefficients : ndarray, shape (pieces, order)
        Coefficients of the powers of a variable that goes from -1 to 1 over the piece [1].
    bend : ndarray, shape (pieces + 1,)
        Changes of the speed over which the curve bends, about each of the speeds [m/s].
    end_slope : float
        Slope beyond the last speed [s/m].
    """

    speed: Array
    coefficients: Array
    bend: Array
    end_slope: float

    @property
    def order(self) -> int:
        """Number of coefficients of a piece."""
        return int(self.coefficients.shape[1])

    @property
    def flat(self) -> Array:
        """All numbers of the pieces in a row, as the march reads them."""
        return np.concatenate([self.speed, self.bend, self.coefficients.ravel()])


def flat_sections(curves: Sequence[Curve], forces: Sequence[float], statics: Sequence[float]) -> Array:
    """Return the numbers of curves with common speeds over normal forces [N], and their ratios at rest."""
    parts = [number for one in curves for number in (one.bend, one.coefficients.ravel())]
    return np.concatenate([curves[0].speed, *parts, forces, statics])


def in_pieces(formula: Formula, speed: Array, order: int, end_slope: float) -> Curve:
    """Return a curve of a formula between given speeds."""
    coefficients = _polynomials(formula, speed, order)
    return Curve(speed, coefficients, _bends(speed, coefficients), end_slope)


def of_formula(formula: Formula, reach: float) -> Curve:
    """Return a curve that equals a smooth formula to round-off, straight beyond ten thousand times `reach` [m/s].

    Pieces are halved until their polynomials agree with the formula between the nodes; at a kink they end as soon as
    that no longer matters.

    Raises
    ------
    ValueError
        If the formula jumps, or has too many bends; the message names the speed.
    """
    decades = np.arange(-DECADES_BELOW, DECADES_ABOVE + 1)
    speed = np.concatenate([[0.0], reach * 10.0**decades])
    for _ in range(HALVINGS):
        wrong = _misses(formula, speed)
        if not wrong.any():
            break
        if speed.size > MOST_PIECES:
            raise ValueError(f"have fewer bends between 0 and {speed[-1]:.4g} m/s")
        middles = 0.5 * (speed[:-1] + speed[1:])[wrong]
        speed = np.sort(np.concatenate([speed, middles]))
    ends = _values(formula, speed)
    jumps = np.abs(np.diff(ends)) > JUMP * np.maximum(np.abs(ends[1:]), np.abs(ends[:-1]))
    steep = jumps & (np.diff(speed) <= 2.0 ** (2 - HALVINGS) * np.maximum(speed[1:], reach))
    if steep.any():
        raise ValueError(f"be continuous near {speed[steep.argmax()]:.4g} m/s")
    before, last = _values(formula, speed[-1] * np.array([1.0 - 1e-5, 1.0]))
    return in_pieces(formula, speed, OF_FORMULA, float(last - before) / (1e-5 * speed[-1]))


def _values(formula: Formula, speed: Array) -> Array:
    return np.broadcast_to(np.asarray(formula(speed), dtype=float), speed.shape)


def _nodes(order: int) -> Array:
    return np.cos(np.pi * (np.arange(order) + 0.5) / order)[::-1]


def _polynomials(formula: Formula, speed: Array, order: int) -> Array:
    """Return the coefficients of the polynomials through the values at Chebyshev's nodes of each piece."""
    nodes = _nodes(order)
    values = _values(formula, speed[:-1, None] + 0.5 * np.diff(speed)[:, None] * (nodes + 1.0))
    return np.linalg.solve(np.vander(nodes, increasing=True), values.T).T


def _misses(formula: Formula, speed: Array) -> Array:
    """Return which pieces of a formula are too wide for their polynomials."""
    coefficients = _polynomials(formula, speed, OF_FORMULA)
    places = np.concatenate([[-1.0], 0.5 * (_nodes(OF_FORMULA)[1:] + _nodes(OF_FORMULA)[:-1]), [1.0]])
    values = _values(formula, speed[:-1, None] + 0.5 * np.diff(speed)[:, None] * (places + 1.0))
    error = np.abs(coefficients @ np.vander(places, OF_FORMULA, increasing=True).T - values).max(axis=1)
    return np.asarray(error > ROUND_OFF * np.maximum(np.abs(values).max(axis=1), abs(values[0, 0])))


def _bends(speed: Array, coefficients: Array) -> Array:
    """Return the changes of the speed over which a curve bends, about each of the speeds between pieces."""
    places = np.linspace(-1.0, 1.0, 5)
    values = coefficients @ np.vander(places, coefficients.shape[1], increasing=True).T
    curvature = np.polynomial.polynomial.polyder(coefficients.T, 2)
    steepest = np.abs(np.polynomial.polynomial.polyval(places, curvature)).max(axis=1) * (2.0 / np.diff(speed)) ** 2
    whole, widest = float(np.ptp(values)), float(speed[-1])
    own = np.full(len(coefficients), widest)
    if whole > 0.0:
        own = np.sqrt(BENT * whole / np.maximum(steepest, BENT * whole / widest**2))
    return np.concatenate([own[:1], np.minimum(own[1:], own[:-1]), own[-1:]])
