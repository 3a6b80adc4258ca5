"""Surfaces in a rigid baffle: the integral of Rayleigh with the exact travel time from every point."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from .air import Air
from .convolution import Convolution
from .delays import Interpolation, Response, Sampling, add, arrivals, response, span
from .panels import Panel
from .surfaces import Surface

# Points whose strengths are held at once.
POINTS_AT_ONCE = 4096


def baffled_response(surface: Surface, listener: Array, air: Air, sampling: Sampling) -> Response:
    """Return the impulse responses from the acceleration of each mode to the pressure at a listener.

    ``p(r, t) = rho / (2 pi) integral of w''(x', t - R / c) / R dS`` (Rayleigh 1896, Theory of Sound, section 278; in
    time: Stepanishen 1971, J. Acoust. Soc. Am. 49, 1629-1638), w positive towards the listener, who is in front.

    Parameters
    ----------
    surface : Surface
        The surface.
    listener : ndarray, shape (3,)
        Its x, y, z [m].
    air : Air
        The air.
    sampling : Sampling
        Sampling of the responses.

    Returns
    -------
    Response
        In Pa for an acceleration of one unit of the shapes [m/s²].
    """
    away = np.sqrt(np.sum((surface.points - listener[:2]) ** 2, axis=1) + listener[2] ** 2)
    delays, kernel = sampling.delays(away, air.speed), sampling.kernel
    modes = surface.shapes(surface.points[:1]).shape[1]
    found = response(*span(float(delays.min()), float(delays.max()), kernel), modes)
    weights = air.density / (2.0 * np.pi) * surface.areas / away
    if surface.panel is not None:
        _add_panel(found, surface.panel, surface.points, delays, weights, kernel)
        return found
    for first in range(0, len(away), POINTS_AT_ONCE):
        part = slice(first, first + POINTS_AT_ONCE)
        add(found, delays[part], weights[part, None] * surface.shapes(surface.points[part]), kernel)
    return found


def _add_panel(to: Response, panel: Panel, points: Array, delays: Array, weights: Array, kernel: Interpolation) -> None:
    """Add the sound of points on a panel, whose shapes are products: first over the points of each x, then over x."""
    x, column = np.unique(points[:, 0], return_inverse=True)
    order = np.argsort(column, kind="stable")
    ends = np.searchsorted(column[order], np.arange(len(x) + 1))
    first = 0
    while first < len(x):
        last = max(first + 1, int(np.searchsorted(ends, ends[first] + POINTS_AT_ONCE, side="right")) - 1)
        part = order[ends[first] : ends[last]]
        across, along = panel.sines(x[first:last], points[part, 1])
        there = arrivals(to, delays[part], kernel, column[part] - first) @ (weights[part, None] * across)
        there = there.reshape(last - first, len(to.taps), -1)
        for number, (modes, sines) in enumerate(along):
            to.taps[:, modes] += there[:, :, number].T @ sines
        first = last


def baffled_pressure(
    surface: Surface, acceleration: Array, interval: float, listeners: Array, air: Air, bandwidth: float
) -> Array:
    """Return the pressure of a surface for given accelerations of its modes.

    Parameters
    ----------
    surface : Surface
        The surface, fine enough for the bandwidth and the listeners.
    acceleration : ndarray, shape (modes, samples)
        Accelerations of the modes.
    interval : float
        Time between samples [s].
    listeners : ndarray, shape (listeners, 3)
        Their x, y, z [m].
    air : Air
        The air.
    bandwidth : float
        Frequency [Hz] up to which it is accurate, below half the sample rate.

    Returns
    -------
    ndarray, shape (listeners, samples)
        Pressure [Pa] at the times of the accelerations.
    """
    sampling = Sampling(interval, bandwidth)
    heard = [baffled_response(surface, listener, air, sampling) for listener in listeners]
    sound = Convolution(heard, acceleration.shape[1])
    sound.add(acceleration, slice(None))
    return sound.signals()
