"""A slim beam in free air: a line of dipoles."""

from __future__ import annotations

from functools import singledispatch
from math import cos, pi
from typing import Any

import numpy as np
import scipy  # its parts are imported on first use

from ..arrays import Array
from ..bodies import Circle, Rectangle
from ..checks import ArgumentError
from .air import Air
from .delays import Response, Sampling, add, response, span
from .panels import Panel
from .surfaces import line_of_points


@singledispatch
def moved_area(section: Any) -> float:
    """Return the area [m²] of air that a slim beam carries with it in bending, its own section included.

    The far flow about a section that oscillates is a dipole of the strength of the force on the air plus that of the
    displaced air, ``rho S + added mass`` per length (Batchelor 1967, An Introduction to Fluid Dynamics, section 6.4).
    The map ``f(z) = C (z + c / z + ...)`` of the outside of a circle to that of the section gives ``2 pi C² (1 + c)``
    for motion along the imaginary axis. For a rectangle, ``|f'| = C sqrt(2 |cos 2t - cos 2a|)`` on the circle, with the
    corners at the angles ``±a`` and ``pi ± a``, and ``c = cos 2a``. A circle has ``2 S``, a thin strip
    ``pi (width / 2)²``.

    Raises
    ------
    ValueError
        If the section is no rectangle and no circle.
    """
    raise ArgumentError("track", "have a Rectangle or a Circle as section without a baffle", section)


@moved_area.register
def _of_a_circle(section: Circle) -> float:
    return 2.0 * section.area


@moved_area.register
def _of_a_rectangle(section: Rectangle) -> float:
    half = section.height / section.width
    corner = scipy.optimize.brentq(
        lambda a: _side(0.0, a) - half * _side(pi / 2.0, a), 1e-9, pi / 2.0 - 1e-9, xtol=1e-14
    )
    radius = section.width / (2.0 * _side(pi / 2.0, corner))
    return float(2.0 * pi * radius**2 * (1.0 + cos(2.0 * corner)))


def _side(middle: float, corner: float) -> float:
    """Return half a side of the rectangle whose first corner is at an angle, over C; `middle` is the side's angle."""
    reach = corner if middle == 0.0 else pi / 2.0 - corner
    # With t = reach sin(s) about the side's middle, the square root at the corner is smooth.
    nodes, weights = np.polynomial.legendre.leggauss(60)
    turn = (nodes + 1.0) * pi / 4.0
    angle = middle - reach * np.sin(turn)
    speed = np.sqrt(2.0 * np.abs(np.cos(2.0 * angle) - cos(2.0 * corner)))
    return float(np.sum(weights * pi / 4.0 * speed * reach * np.cos(turn)))


def dipole_response(
    panel: Panel,
    area: float,
    listener: Array,
    air: Air,
    sampling: Sampling,
    refinement: float = 1.0,
) -> Response:
    """Return the impulse responses from the acceleration of each mode of a beam to the pressure at a listener.

    The pressure of a force F per length on the air, along z, is the integral along the line of
    ``z / (4 pi R²) (F'(t - R/c) / c + F(t - R/c) / R)``
    (Morse & Ingard 1968, Theoretical Acoustics, section 7.1), with ``F = rho area w''``. This holds where
    the section is small against wavelength, distance and bending wavelength.

    Parameters
    ----------
    panel : Panel
        The bending modes, a line.
    area : float
        Area of air that moves with the beam [m²], `moved_area`.
    listener : ndarray, shape (3,)
        Its x, y, z [m], y and z from the axis.
    air : Air
        The air.
    sampling : Sampling
        Sampling of the responses.
    refinement : float, optional
        Factor by which the elements are smaller than needed.
    """
    interval, kernel = sampling.interval, sampling.kernel
    # Largest wavenumber that samples can carry.
    points, lengths = line_of_points(panel, listener, pi / (air.speed * interval), refinement)
    across = listener[1] ** 2 + listener[2] ** 2
    away = np.sqrt((points - listener[0]) ** 2 + across)
    delays = sampling.delays(away, air.speed)
    found = response(*span(float(delays.min()), float(delays.max()), kernel), len(panel.wavenumbers))
    shapes = panel.shapes(points, np.zeros_like(points))
    weights = air.density * area / (4.0 * pi) * lengths * listener[2] / away**2
    add(found, delays, (weights / away)[:, None] * shapes, kernel)
    add(found, delays, (weights / (air.speed * interval))[:, None] * shapes, kernel, derivative=True)
    return found
