"""Traces of harmonic mode shapes at a moving point."""

import math

import numba

FASTMATH = {"reassoc", "contract", "nsz", "arcp"}


@numba.njit(cache=True, fastmath=FASTMATH)
def harmonics(theta, sines, cosines):
    """Fill `sines` and `cosines` with sin(k theta) and cos(k theta), k = 1, 2, ..., by doubling the filled part."""
    count = sines.size
    sines[0] = math.sin(theta)
    cosines[0] = math.cos(theta)
    filled = 1
    while filled < count:
        s, c = sines[filled - 1], cosines[filled - 1]
        new = min(filled, count - filled)
        for k in range(new):
            sines[filled + k] = s * cosines[k] + c * sines[k]
            cosines[filled + k] = c * cosines[k] - s * sines[k]
        filled += new
