"""Radiation efficiency of modes, and the damping that results from it."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import ArgumentError, at_most, instance, positive
from .air import Air
from .panels import Panel, panel_of

# Gauss-Legendre points in a piece of a side, over which the phase turns by 2 pi at most.
POINTS = 10
# Wavelengths along times wavelengths across, above which the integral takes minutes and the efficiency is 1 anyway.
MOST_WAVES = 40_000


def radiation_efficiency(track: ModalBeam | ModalPlate, frequency: float | Array, air: Air | None = None) -> Array:
    """Return the radiation efficiencies of the modes of a track in a baffle.

    Sound power of one face over that of a piston of the same area and mean square velocity, ``rho c S <v²>``
    (Wallace 1972, J. Acoust. Soc. Am. 51, 946-952). From the resistance of the mode against itself, the real part of
    Rayleigh's integral over the surface: with the autocorrelations C of the shape along x and y
    ``sigma = 2 k² / (pi N) double integral of C(u) C(v) sin(k r) / (k r) du dv`` over one quarter, N the integral of
    the shape's square.

    Parameters
    ----------
    track : ModalBeam or ModalPlate
        The track; a beam must have a rectangular section.
    frequency : float or ndarray, shape (modes,)
        Frequency of the sound [Hz], one for all modes or one for each.
    air : Air, optional
        The air, `Air()` if left out.

    Returns
    -------
    ndarray, shape (modes,)
        Efficiencies [1] of the modes that bend, in the order of the track's.

    Raises
    ------
    ValueError
        If the track has no flat surface or a frequency is not above zero.
    """
    air = Air() if air is None else air
    instance("air", air, Air)
    panel = panel_of(track)
    given = np.atleast_1d(np.asarray(frequency, dtype=float))
    if given.shape not in ((1,), panel.angular_frequency.shape):
        words, got = f"be one number or a list of {panel.angular_frequency.size}", f"a list of {given.size}"
        raise ArgumentError("frequency", words, frequency, got=got)
    longest, area = max(panel.length, panel.width), panel.length * panel.width
    highest = air.speed * min(MOST_WAVES / longest, float(np.sqrt(MOST_WAVES / area)))
    for value in given:
        if positive("frequency", float(value)) > highest:
            raise ArgumentError("frequency", f"be at most {at_most(highest)} Hz for a track of this size", float(value))
    each = np.broadcast_to(2.0 * np.pi * given / air.speed, panel.angular_frequency.shape)
    return np.array([_efficiency(panel.only([k]), float(wavenumber)) for k, wavenumber in enumerate(each)])


def radiation_damping(track: ModalBeam | ModalPlate, air: Air | None = None) -> Array:
    """Return the damping ratios due to the sound of one face of the modes of a track in a baffle.

    ``zeta = rho c sigma N / 2 w`` with the efficiency sigma at the natural frequency and the integral N of the square
    of the mass-normalised shape: the power radiated in a period over the energy. Light fluid: modes and frequencies
    are unchanged; coupling of modes by the air and the mass of the air are neglected. Neither `radiate` nor a run
    includes it: add it to the damping of the body (twice, if both faces radiate).

    Parameters
    ----------
    track : ModalBeam or ModalPlate
        The track; a beam must have a rectangular section.
    air : Air, optional
        The air, `Air()` if left out.

    Returns
    -------
    ndarray, shape (modes,)
        Damping ratios [1] of all modes of the track in its order, zero for those without bending.

    Raises
    ------
    ValueError
        If the track has no flat surface.
    """
    air = Air() if air is None else air
    panel = panel_of(track)
    efficiency = radiation_efficiency(track, panel.angular_frequency / (2.0 * np.pi), air)
    found = np.zeros(sum(track.harmonics))
    found[: efficiency.size] = air.impedance * efficiency * mean_square(panel) / (2.0 * panel.angular_frequency)
    return found


def mean_square(panel: Panel) -> Array:
    """Return the integrals of the squares of the mode shapes over the surface [m²/kg], shape (modes,)."""
    halves = np.where(panel.wavenumbers == 0.0, 1.0, 0.5).prod(axis=1)
    return np.asarray(panel.amplitude**2 * panel.length * panel.width * halves)


def _efficiency(panel: Panel, wavenumber: float) -> float:
    """Return the efficiency of the only mode of a panel."""
    (along, across), square = panel.wavenumbers[0], mean_square(panel)[0] / panel.amplitude**2
    u, du = _quadrature(panel.length, along + wavenumber)
    v, dv = _quadrature(panel.width, across + wavenumber)
    first, second = _autocorrelation(u, panel.length, along), _autocorrelation(v, panel.width, across)
    total = 0.0
    for part in range(0, len(u), 256):
        rows = slice(part, part + 256)
        reach = np.sinc(wavenumber / np.pi * np.hypot(u[rows, None], v))
        total += float((first * du)[rows] @ reach @ (second * dv))
    return 2.0 * wavenumber**2 / (np.pi * square) * total


def _autocorrelation(lag: Array, side: float, wavenumber: float) -> Array:
    """Return the integral of sin(p x) sin(p (x + lag)) over the side, or of 1 where p is zero."""
    if wavenumber == 0.0:
        return side - lag
    return ((side - lag) * np.cos(wavenumber * lag) + np.sin(wavenumber * lag) / wavenumber) / 2.0


def _quadrature(side: float, wavenumber: float) -> tuple[Array, Array]:
    pieces = int(np.ceil(side * wavenumber / (2.0 * np.pi)))
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    size = side / pieces
    points = (np.arange(pieces)[:, None] + (nodes + 1.0) / 2.0) * size
    return points.ravel(), np.tile(weights * size / 2.0, pieces)
