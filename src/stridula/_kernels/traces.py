"""Traces of harmonic mode shapes at a moving point."""

import math

import numba

FASTMATH = {"reassoc", "contract", "nsz", "arcp"}


@numba.njit(cache=True, fastmath={"contract", "nsz"})
def sine_and_cosine(theta):
    """Return sin and cos of an angle from 0 to pi, to two units in the last place.

    From the sine and cosine of half the angle off pi/2, which is at most pi/4, by the polynomials of FreeBSD's msun.
    """
    x = 0.5 * (theta - math.pi / 2.0)
    z = x * x
    s = 2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)
    s = -1.66666666666666324348e-01 + z * (8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * s))
    s = x + x * z * s
    c = -2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)
    c = 4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * c))
    c = 1.0 - 0.5 * z + z * z * c
    return 1.0 - 2.0 * s * s, -2.0 * s * c


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def harmonics(theta, count, sines, cosines):
    """Fill `sines` and `cosines` with sin(k theta) and cos(k theta), k = 1 to `count`, by doubling the filled part.

    Whole blocks are filled: the arrays are at least twice as long as `count`.
    """
    s, c = sine_and_cosine(theta)
    sines[0], cosines[0] = s, c
    filled = 1
    while filled < count:
        for k in range(filled):
            sines[filled + k] = s * cosines[k] + c * sines[k]
            cosines[filled + k] = c * cosines[k] - s * sines[k]
        s, c = 2.0 * s * c, 1.0 - 2.0 * s * s
        filled *= 2
