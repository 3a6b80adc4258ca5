"""What a body in open air sends to a listener: an impulse response for each of its modes, from fits at frequencies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import BodySurface
from .air import Air
from .delays import Response
from .fits import fits_of
from .sheets import Sheet

# Frequency above which nothing is left of a response, over the bandwidth.
STOP = 1.2
# Up to where responses are whole, and where nothing is left of them, over the frequency of the highest mode: beyond it
# a body moves as modes do that are not known.
WHOLE_BEYOND, STOP_BEYOND = 1.2, 1.6
# Length of a response in times of travel through the body, and in periods of the width between bandwidth and stop.
TRAVELS, PERIODS = 2.0, 6.0
# Share of the largest value of a response that may be left late in it, before frequencies are taken twice as close, and
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
        What is left of the responses where they are least in their later half, over their largest values.
    """

    responses: list[Response]
    frequencies: Array
    errors: Array
    left: float


def free_responses(
    surface: BodySurface | Sheet,
    places: Array,
    distances: Array,
    air: Air,
    interval: float,
    shift: float,
    bandwidth: float,
    highest: float = np.inf,
) -> Sent:
    """Return the impulse responses of the modes of a body in open air.

    The travel time from the nearest point of the surface is taken off the phases at the frequencies and put back as an
    exact delay. Responses are whole up to the bandwidth and fall to nothing at 1.2 times that, or from 1.2 to 1.6 times
    the frequency of the highest mode where that is less.

    Parameters
    ----------
    surface : PointSurface, RingSurface or Sheet
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
    highest : float, optional
        Frequency of the highest mode [Hz].
    """
    fits = fits_of(surface)
    whole, stop = min(bandwidth, WHOLE_BEYOND * highest), min(STOP * bandwidth, STOP_BEYOND * highest)
    width = stop - whole
    lasts = TRAVELS * fits.radiator.size / air.speed + PERIODS / width
    early = 0.5 * PERIODS / width
    for number in range(TIMES):
        frequencies = np.arange(int(np.ceil(stop * lasts))) / lasts
        waves = 2.0 * np.pi * frequencies / air.speed
        made = fits.at(waves.tolist())
        heard = np.array([fits.radiator.heard(fit, k, places) for fit, k in zip(made, waves.tolist(), strict=True)])
        heard = heard.astype(complex)
        heard *= air.density * np.exp(1j * waves[:, None] * distances)[:, :, None]
        heard *= _taper(frequencies, whole, stop)[:, None, None]
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


def _taper(frequencies: Array, whole: float, stop: float) -> Array:
    beyond = np.clip((frequencies - whole) / (stop - whole), 0.0, 1.0)
    return np.asarray(np.cos(0.5 * np.pi * beyond) ** 2)


def _taps(
    heard: Array, lasts: float, early: float, delay: float, interval: float, shift: float
) -> tuple[Response, float]:
    """Return a response from its values at frequencies, and what is left of it late, over its largest value."""
    first = int(np.ceil((delay - early) / interval + shift))
    count = int(lasts / interval)
    times = (first + np.arange(count) - shift) * interval - delay
    turned = np.exp(2j * np.pi / lasts * np.outer(times, np.arange(len(heard))))
    turned[:, 1:] *= 2.0
    taps = interval / lasts * (turned @ heard).real
    # Of the loudest mode: what others leave is not heard beside it. Towards the end comes what fits that differ from
    # one frequency to the next put before the next arrival, which does not get less with time.
    size = float(np.abs(taps).max(initial=0.0))
    late = np.abs(taps[times > 0.5 * (lasts - early)]).max(axis=1, initial=0.0)
    pieces = np.array_split(late, max(1, int(late.size * interval / (0.25 * early))))
    end = min(float(piece.max(initial=0.0)) for piece in pieces)
    return Response(first, taps), end / size if size else 0.0
