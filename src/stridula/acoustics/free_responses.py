"""Impulse responses from the modes of a body in open air to listeners, from fits at frequencies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import BodySurface
from .air import Air
from .delays import Response, Sampling
from .fits import fits_of
from .sheets import Sheet

# Frequency above which responses are zero, over the bandwidth.
STOP = 1.2
# Frequencies up to which responses are complete and from which they are zero, over that of the highest mode: beyond it
# a body moves in modes that are not known.
WHOLE_BEYOND, STOP_BEYOND = 1.2, 1.6
# Length of a response in times of travel through the body, and in periods of the width between bandwidth and stop.
TRAVELS, PERIODS = 2.0, 6.0
# Fraction of the largest value of a response that may remain late in it before frequencies are taken twice as densely,
# and largest number of attempts.
LEFT, TIMES = 5e-3, 3


@dataclass(frozen=True)
class Sent:
    """Impulse responses of a body at listeners.

    Attributes
    ----------
    responses : list of Response
        Impulse responses of the modes at each listener, from acceleration to pressure.
    frequencies : ndarray, shape (frequencies,)
        Frequencies of the fits [Hz].
    errors : ndarray, shape (frequencies, modes)
        Relative errors of the fits.
    error_in : str
        Quantity in which these are errors.
    left : float
        Smallest remainder of the responses in their later half, over their largest values.
    """

    responses: list[Response]
    frequencies: Array
    errors: Array
    error_in: str
    left: float


def free_responses(
    surface: BodySurface | Sheet,
    places: Array,
    distances: Array,
    air: Air,
    sampling: Sampling,
    highest: float = np.inf,
) -> Sent:
    """Return the impulse responses of the modes of a body in open air.

    The travel time from the nearest point of the surface is removed from the phases at the frequencies and added again
    as an exact delay. Responses are complete up to the bandwidth and fall to zero at 1.2 times that, or from 1.2 to 1.6
    times the frequency of the highest mode where that is less.

    Parameters
    ----------
    surface : PointSurface, RingSurface or Sheet
        The surface of the body.
    places : ndarray, shape (listeners, 3)
        Places of the listeners [m].
    distances : ndarray, shape (listeners,)
        Distances to the nearest points of the surface [m].
    air : Air
        The air.
    sampling : Sampling
        Sampling of the responses.
    highest : float, optional
        Frequency of the highest mode [Hz].
    """
    fits = fits_of(surface)
    bandwidth = sampling.bandwidth
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
        pairs = [_taps(heard[:, one], lasts, early, distances[one] / air.speed, sampling) for one in range(len(places))]
        left = max(share for _, share in pairs)
        if left < LEFT or number == TIMES - 1:
            break
        lasts *= 2.0
    fits.keep()
    errors = np.array([fit.errors for fit in made])
    return Sent([one for one, _ in pairs], frequencies, errors, fits.radiator.error_in, left)


def _taper(frequencies: Array, whole: float, stop: float) -> Array:
    beyond = np.clip((frequencies - whole) / (stop - whole), 0.0, 1.0)
    return np.asarray(np.cos(0.5 * np.pi * beyond) ** 2)


def _taps(heard: Array, lasts: float, early: float, delay: float, sampling: Sampling) -> tuple[Response, float]:
    """Return a response from its values at frequencies, and its late remainder over its largest value."""
    interval, shift = sampling.interval, sampling.shift
    first = int(np.ceil((delay - early) / interval + shift))
    count = int(lasts / interval)
    times = (first + np.arange(count) - shift) * interval - delay
    turned = np.exp(2j * np.pi / lasts * np.outer(times, np.arange(len(heard))))
    turned[:, 1:] *= 2.0
    taps = interval / lasts * (turned @ heard).real
    # Relative to the loudest mode, which masks the others. Differences between fits at neighbouring frequencies appear
    # towards the end, before the next arrival, and do not decay.
    size = float(np.abs(taps).max(initial=0.0))
    late = np.abs(taps[times > 0.5 * (lasts - early)]).max(axis=1, initial=0.0)
    pieces = np.array_split(late, max(1, int(late.size * interval / (0.25 * early))))
    end = min(float(piece.max(initial=0.0)) for piece in pieces)
    return Response(first, taps), end / size if size else 0.0
