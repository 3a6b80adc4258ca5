"""Traces of harmonic mode shapes at a moving point."""

import math

import numba
from numba.extending import overload

from .block_rows import NUMBER
from .lanes import fused, lane, load, store, whole
from .vectors import LANES, VECTOR

FASTMATH = {"reassoc", "contract", "nsz", "arcp"}
# Sums in the order written: a run does not depend, to the last bit, on how it is sampled.
IN_ORDER = {"contract", "nsz", "arcp"}


@numba.njit(cache=True, fastmath={"contract", "nsz"}, forceinline=True)
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


def set_harmonics(theta, count, rows, first, sine, run):
    """Put sin(k theta) and cos(k theta), k from 1, into `count` blocks of rows of `rows`."""
    s, c = sine_and_cosine(theta)
    store(rows, first, sine, run, s)
    store(rows, first, sine + 1, run, c)
    filled = 1
    while filled < count:
        for k in range(min(filled, count - filled)):
            known, new = first + k, first + filled + k
            a, b = load(rows, known, sine, run), load(rows, known, sine + 1, run)
            store(rows, new, sine, run, fused(s, b, c * a))
            store(rows, new, sine + 1, run, fused(c, b, -s * a))
        s, c = 2.0 * s * c, 1.0 - 2.0 * s * s
        filled *= 2


@numba.njit(cache=True, forceinline=True)
def set_eight_at_a_time(theta, count, rows, first, sine, run):
    """Do so for one run, whose blocks have eight harmonics: the first eight at once, the others by turning on."""
    half_turns = load(rows, first, NUMBER, run) * (theta / math.pi)
    passed = whole(half_turns)
    s, c = sine_and_cosine((half_turns - passed) * math.pi)
    sign = 1.0 - 2.0 * (passed - 2.0 * whole(0.5 * passed))
    s, c = s * sign, c * sign
    store(rows, first, sine, run, s)
    store(rows, first, sine + 1, run, c)
    turn_s, turn_c = lane(s, LANES - 1), lane(c, LANES - 1)
    for k in range(1, count):
        s, c = fused(s, turn_c, c * turn_s), fused(c, turn_c, -turn_s * s)
        store(rows, first + k, sine, run, s)
        store(rows, first + k, sine + 1, run, c)


@overload(set_harmonics)
def _overload_set_harmonics(theta, count, rows, first, sine, run):
    if theta is VECTOR:
        return set_harmonics
    return lambda theta, count, rows, first, sine, run: set_eight_at_a_time(theta, count, rows, first, sine, run)
