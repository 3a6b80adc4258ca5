"""Poles of frequency response functions that stay the same while the order of a fit rises."""

from __future__ import annotations

import numpy as np

from ..arrays import Array

# Share of a turn that the band takes on the unit circle; the rest keeps its ends apart.
SHARE = 0.9
# Orders of the fit: first, and step.
FIRST, STEP = 4, 2
# Largest differences of a pole that stays: of its frequency, relative to its frequency and to the width of the band,
# and of its damping, relative.
SAME_FREQUENCY, SAME_BAND, SAME_DAMPING = 0.003, 0.002, 0.25
# Largest damping ratio of a pole.
HIGHEST_DAMPING = 0.2
# Share of orders after its first in which a pole stays.
STAYS = 0.6


def stable_poles(frequency: Array, values: Array, highest_order: int) -> Array:
    """Return the poles [rad/s] that stay, by rising frequency.

    All functions are fitted by polynomials in ``z = exp(2 pi i s (f - f_0) / (f_1 - f_0))`` with one denominator, in
    linear least squares (Guillaume et al. 2003, for one denominator and complex coefficients).

    Parameters
    ----------
    frequency : ndarray, shape (lines,)
        Rising frequencies [Hz].
    values : ndarray, shape (functions, lines)
        Functions.
    highest_order : int
        Highest order of the denominators.
    """
    low, width = frequency[0], frequency[-1] - frequency[0]
    turns = np.exp(2j * np.pi * SHARE * (frequency - low) / width)
    basis = turns[:, None] ** np.arange(highest_order + 1)
    tracks: list[list[complex]] = []
    begun: list[int] = []
    orders = range(FIRST, highest_order + 1, STEP)
    for number, order in enumerate(orders):
        roots = _denominator_roots(basis[:, : order + 1], values)
        exponents = np.log(roots[roots != 0.0]) * width / SHARE
        # Angles beyond the band lie below it.
        angle = np.mod(exponents.imag, 2.0 * np.pi * width / SHARE)
        poles = exponents.real + 1j * (angle + 2.0 * np.pi * low)
        _follow(tracks, begun, poles[_is_mode(poles, frequency)], number, width)
    found = []
    for track, start in zip(tracks, begun, strict=True):
        following = len(orders) - start
        if len(track) >= max(3, STAYS * following):
            late = np.array(track[len(track) // 2 :])
            found.append(complex(np.median(late.real), np.median(late.imag)))
    return np.array(sorted(found, key=lambda pole: pole.imag), dtype=complex)


def _denominator_roots(basis: Array, values: Array) -> Array:
    """Return the roots of the denominator of polynomials in the basis that fit all functions."""
    size = basis.shape[1]
    across = np.linalg.qr(basis)[0]
    normal = np.zeros((size, size), dtype=complex)
    for one in values:
        rows = basis * one[:, None]
        rows = rows - across @ (across.conj().T @ rows)
        normal += rows.conj().T @ rows
    # The lowest coefficient is 1: roots of noise then grow, and those of modes decay.
    others = np.linalg.lstsq(normal[1:, 1:], -normal[1:, 0], rcond=None)[0]
    return np.asarray(np.roots(np.concatenate([[1.0], others])[::-1]))


def _is_mode(poles: Array, frequency: Array) -> Array:
    ratio = -poles.real / np.abs(poles)
    inside = (poles.imag > 2.0 * np.pi * frequency[0]) & (poles.imag < 2.0 * np.pi * frequency[-1])
    return np.asarray(inside & (ratio > 0.0) & (ratio < HIGHEST_DAMPING))


def _follow(tracks: list[list[complex]], begun: list[int], poles: Array, number: int, width: float) -> None:
    """Append each pole to the track whose last pole is the same, or begin another one."""
    left = list(poles)
    for track in tracks:
        last = track[-1]
        apart = min(SAME_FREQUENCY * abs(last), SAME_BAND * 2.0 * np.pi * width)
        near = [pole for pole in left if abs(pole.imag - last.imag) < apart]
        near = [pole for pole in near if abs(pole.real - last.real) < SAME_DAMPING * abs(last.real)]
        if near:
            nearest = min(near, key=lambda pole: abs(pole - last))
            left.remove(nearest)
            track.append(nearest)
    for pole in left:
        tracks.append([pole])
        begun.append(number)
