"""Traces of harmonic mode shapes at a moving point."""

import math

import numba

FASTMATH = {"reassoc", "contract", "nsz", "arcp"}


@numba.njit(cache=True, fastmath=FASTMATH)
def harmonics(theta, count, sines, cosines):
    """Fill `sines` and `cosines` with sin(k theta) and cos(k theta), k = 1 to `count`, by doubling the filled part."""
    sines[0] = math.sin(theta)
    cosines[0] = math.cos(theta)
    filled = 1
    while filled < count:
        sine, cosine = sines[filled - 1], cosines[filled - 1]
        for k in range(min(filled, count - filled)):
            sines[filled + k] = sine * cosines[k] + cosine * sines[k]
            cosines[filled + k] = cosine * cosines[k] - sine * sines[k]
        filled *= 2
