"""Modes of a rectangular sheet in its plane, its edges held along their normals and free along themselves."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...ordinary import check_mode_count
from ..sections import Material


@dataclass(frozen=True)
class PlaneStress:
    """Modes ``(A sin(kx x) cos(ky y), B cos(kx x) sin(ky y))`` of a sheet of unit mass, by increasing frequency.

    Attributes
    ----------
    numbers : ndarray, shape (modes, 2)
        Half-waves along length and width, counted from 0.
    polarisations : ndarray, shape (modes, 2)
        Unit vectors (A, B).
    frequency : ndarray, shape (modes,)
        Natural frequencies [Hz].
    wavenumbers : ndarray, shape (2, modes)
        Wavenumbers kx and ky [rad/m].
    amplitudes : ndarray, shape (2, modes)
        Amplitudes (A, B) of unit modal mass [1].
    """

    numbers: Array
    polarisations: Array
    frequency: Array
    wavenumbers: Array
    amplitudes: Array


def speeds(material: Material) -> tuple[float, float]:
    """Return the speeds of longitudinal and of shear waves in the plane of a sheet [m/s]."""
    squared = material.young / material.density
    return math.sqrt(squared / (1.0 - material.poisson**2)), math.sqrt(squared / (2.0 * (1.0 + material.poisson)))


def lowest(material: Material, length: float, width: float) -> float:
    """Return the lowest natural frequency in the plane [Hz]."""
    longitudinal, shear = speeds(material)
    return 0.5 * min(longitudinal / max(length, width), shear * math.hypot(1.0 / length, 1.0 / width))


def plane_stress(
    material: Material, length: float, width: float, most: tuple[int, int], cutoff: float | None
) -> PlaneStress:
    """Return the modes with at most `most` half-waves along length and width, or all up to a cutoff [Hz]."""
    sides, (longitudinal, shear) = np.array([length, width]), speeds(material)
    if cutoff is not None:
        most = (int(2.0 * cutoff * length / shear) + 1, int(2.0 * cutoff * width / shear) + 1)
    check_mode_count(2 * (most[0] + 1) * (most[1] + 1), cutoff)
    m, n = (numbers.ravel() for numbers in np.meshgrid(*(np.arange(k + 1) for k in most), indexing="ij"))
    # A sheet held along the normals of its edges has no rigid motion.
    numbers = np.stack([m, n], axis=1)[1:]
    waves = numbers / sides
    size = np.hypot(*waves.T)
    along = waves / size[:, None]
    sheared = numbers.all(axis=1)
    numbers = np.concatenate([numbers, numbers[sheared]])
    polarisations = np.concatenate([along, along[sheared, ::-1] * [1.0, -1.0]])
    frequency = np.concatenate([0.5 * longitudinal * size, 0.5 * shear * size[sheared]])
    order = np.argsort(frequency, kind="stable")
    if cutoff is not None:
        order = order[frequency[order] <= cutoff * (1.0 + 1e-12)]
    return of_numbers(numbers[order], polarisations[order], frequency[order], sides)


def rigid(length: float, width: float) -> PlaneStress:
    """Return no modes."""
    return of_numbers(np.zeros((0, 2), dtype=int), np.zeros((0, 2)), np.zeros(0), np.array([length, width]))


def of_numbers(numbers: Array, polarisations: Array, frequency: Array, sides: Array) -> PlaneStress:
    """Return the modes with these half-waves over sides [m], all arrays read-only."""
    # A cosine of no half-wave has a mean square of 1, any other sine or cosine of 1/2.
    squares = np.where(numbers == 0, 1.0, 0.5).prod(axis=1)
    found = PlaneStress(
        numbers, polarisations, frequency, numbers.T * (np.pi / sides)[:, None], polarisations.T / np.sqrt(squares)
    )
    for one in vars(found).values():
        one.flags.writeable = False
    return found
