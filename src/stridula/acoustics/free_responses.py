"""What a body in open air sends to a listener: an impulse response for each of its modes, from fits at frequencies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import BodySurface
from .air import Air
from .delays import Response
from .fits import fits_of

# Frequency above which nothing is left of a response, over the bandwidth.
STOP = 1.2
# Length of a response in times of travel through the body, and in periods of the width between bandwidth and stop.
TRAVELS, PERIODS = 2.0, 6.0
# Share of the largest value of a response that may be left at its end, before frequencies are taken twice as close, and
# how often.
LEFT, TIMES = 5e-3, 3


@dataclass(frozen=True)
class Sent:
    """What a body sends to listeners.

    Attributes
    ----------
    responses : list of Response
        Impulse responses of the modes at each listener, from acceleration to pressure.
    frequencies : ndarray, shape (frequencies,)
        Where fits were made [Hz].
    errors : ndarray, shape (frequencies, modes)
        Relative errors of the normal motion over the surface.
    left : float
        What is left of the responses at their end, over their largest values.
    """

    responses: list[Response]
    frequencies: Array
    errors: Array
    left: float


def free_responses(
    surface: BodySurface, places: Array, distances: Array, air: Air, interval: float, shift: float, bandwidth: float
) -> Sent:
    """Return the impulse responses of the modes of a body in open air.

    The travel time from the nearest point of the surface is taken off the phases at the frequencies and put back as an
    exact delay. Responses are whole up to the bandwidth and fall to nothing at 1.2 times that.

    Parameters
    ----------
    surface : PointSurface or RingSurface
        The surface of the body.
    places : ndarray, shape (listeners, 3)
        Where one listens [m].
    distances : ndarray, shape (listeners,)
        Distances to the nearest points of the surface [m].
    air : Air
        The air.
    interval : float
        Time between samples [s].
    shift : float
        What is added to every delay, in samples.
    bandwidth : float
        Frequency up to which responses are whole [Hz].
    """
    fits = fits_of(surface)
    width = (STOP - 1.0) * bandwidth
    lasts = TRAVELS * fits.radiator.size / air.speed + PERIODS / width
    early = 0.5 * PERIODS / width
    for number in range(TIMES):
        frequencies = np.arange(int(np.ceil(STOP * bandwidth * lasts))) / lasts
        waves = 2.0 * np.pi * frequencies / air.speed
        made = fits.at(waves.tolist())
        heard = np.array([fits.radiator.heard(fit, k, places) for fit, k in zip(made, waves.tolist(), strict=True)])
        heard = heard.astype(complex)
        heard *= air.density * np.exp(1j * waves[:, None] * distances)[:, :, None]
        heard *= _taper(frequencies, bandwidth)[:, None, None]
        pairs = [
            _taps(heard[:, one], lasts, early, distances[one] / air.speed, interval, shift)
            for one in range(len(places))
        ]
        left = max(share for _, share in pairs)
        if left < LEFT or number == TIMES - 1:
            break
        lasts *= 2.0
    fits.keep()
    return Sent([one for one, _ in pairs], frequencies, np.array([fit.errors for fit in made]), left)


def _taper(frequencies: Array, bandwidth: float) -> Array:
    beyond = np.clip((frequencies / bandwidth - 1.0) / (STOP - 1.0), 0.0, 1.0)
    return np.asarray(np.cos(0.5 * np.pi * beyond) ** 2)


def _taps(
    heard: Array, lasts: float, early: float, delay: float, interval: float, shift: float
) -> tuple[Response, float]:
    """Return a response from its values at frequencies, and what is left of it at its end."""
    first = int(np.ceil((delay - early) / interval + shift))
    count = int(lasts / interval)
    times = (first + np.arange(count) - shift) * interval - delay
    turned = np.exp(2j * np.pi / lasts * np.outer(times, np.arange(len(heard))))
    turned[:, 1:] *= 2.0
    taps = interval / lasts * (turned @ heard).real
    # Of the loudest mode: what others leave is not heard beside it. After this end comes what fits that differ from one
    # frequency to the next put before the arrival, which does not get less with time.
    size = float(np.abs(taps).max(initial=0.0))
    is_end = np.abs(times - (lasts - 1.625 * early)) <= 0.125 * early
    end = float(np.abs(taps[is_end]).max(initial=0.0))
    return Response(first, taps), end / size if size else 0.0
