"""Poles and residues of mobilities by least squares: residues are linear, poles are found by their elimination."""

from __future__ import annotations

import numpy as np
import scipy  # its parts are imported on first use

from ..arrays import Array

# Most directions of the functions that the search of poles uses: the others are noise, and take part in the residues.
MOST = 60


def fitted_poles(angular: Array, values: Array, poles: Array) -> Array:
    """Return poles [rad/s] near given ones for which the error of all functions is least.

    The functions are ``i w (sum r / (i w - p) + conjugate) + i w u + l / (i w)`` with real u and l for the modes above
    and below the band. Residues are eliminated (Golub & Pereyra 2003, with Kaufman's derivative).

    Parameters
    ----------
    angular : ndarray, shape (lines,)
        Angular frequencies [rad/s].
    values : ndarray, shape (functions, lines)
        Mobilities.
    poles : ndarray, shape (modes,)
        Poles to begin with.
    """
    rows = _stacked(values.T)
    if rows.shape[1] > MOST:
        left, size, _ = np.linalg.svd(rows, full_matrices=False)
        rows = left[:, :MOST] * size[:MOST]
    count = poles.size

    def residual(given: Array) -> Array:
        across = np.linalg.qr(_columns(angular, given[:count] + 1j * given[count:]))[0]
        return np.asarray((rows - across @ (across.T @ rows)).ravel())

    def slope(given: Array) -> Array:
        found = given[:count] + 1j * given[count:]
        columns = _columns(angular, found)
        across, upper = np.linalg.qr(columns)
        inner = scipy.linalg.solve_triangular(upper, across.T @ rows)
        parts = []
        for turn in (1.0, 1.0j):
            for mode in range(count):
                moved = _stacked(_pair(angular, found[mode], turn)) @ inner[2 * mode : 2 * mode + 2]
                parts.append(-(moved - across @ (across.T @ moved)).ravel())
        return np.stack(parts, axis=1)

    start = np.concatenate([poles.real, poles.imag])
    found = scipy.optimize.least_squares(residual, start, slope, x_scale="jac", method="lm").x
    return np.asarray(found[:count] + 1j * found[count:])


def residues_of(angular: Array, values: Array, poles: Array) -> tuple[Array, Array]:
    """Return residues of receptances, shape (functions, modes), and the mobilities of the fit."""
    columns = _columns(angular, poles)
    found = np.linalg.lstsq(columns, _stacked(values.T), rcond=None)[0]
    fit = columns @ found
    lines = angular.size
    residues = found[: 2 * poles.size : 2] + 1j * found[1 : 2 * poles.size : 2]
    return residues.T, (fit[:lines] + 1j * fit[lines:]).T


def _columns(angular: Array, poles: Array) -> Array:
    """Return the functions of real and imaginary parts of residues, and of modes above and below, stacked."""
    about = [_modes(angular, pole) for pole in poles]
    others = np.stack([1j * angular / angular[-1], angular[0] / (1j * angular)], axis=1)
    return _stacked(np.concatenate([*about, others], axis=1))


def _modes(angular: Array, pole: complex) -> Array:
    one, other = (1j * angular / (1j * angular - end) for end in (pole, np.conj(pole)))
    return np.stack([one + other, 1j * (one - other)], axis=1)


def _pair(angular: Array, pole: complex, turn: complex) -> Array:
    """Return the derivatives of `_modes` with the real part of the pole, or with a turn of i the imaginary part."""
    one, other = (1j * angular / (1j * angular - end) ** 2 for end in (pole, np.conj(pole)))
    one, other = one * turn, other * np.conj(turn)
    return np.stack([one + other, 1j * (one - other)], axis=1)


def _stacked(values: Array) -> Array:
    """Return real parts above imaginary parts."""
    return np.concatenate([values.real, values.imag])
