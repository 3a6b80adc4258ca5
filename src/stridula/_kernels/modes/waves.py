"""Sines and cosines of the waves of a path at a moving point.

The waves of a path are sines and cosines of the multiples of an angle along it; on a plate modes are their products
with those of a second angle. Their order: multiples of the first angle, then multiples of the second, from 0 on.
"""

import math
from typing import Any

import numba

from ..lanes.compiled import INLINED, inlined, overloaded
from ..lanes.operations import Array, Number, Pair, Runs, fused, lane, load, spread, store, whole
from ..lanes.vectors import LANES, VECTOR
from ..layout.rows import ACROSS, ALONG, FIRST, FROM_ZERO, NUMBER


@numba.njit(**(INLINED | {"fastmath": {"contract", "nsz"}}))
def sine_and_cosine(theta: float) -> Pair:
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


@inlined
def sine_and_cosine_of_half_turns(half_turns: Number) -> Pair:
    """Return sin and cos of any number of half turns."""
    passed = whole(half_turns)
    s, c = sine_and_cosine((half_turns - passed) * math.pi)
    sign = 1.0 - 2.0 * (passed - 2.0 * whole(0.5 * passed))
    return s * sign, c * sign


def set_multiples(theta: float, from_zero: int, count: int, waves: Array, first: int, sine: int, runs: Runs) -> None:
    """Set sin(k theta) and cos(k theta), for k from 1 or from 0 on, in `count` blocks of rows of `waves`."""
    s, c = sine_and_cosine(theta)
    if from_zero:
        store(waves, first, sine, runs, spread(0.0))
        store(waves, first, sine + 1, runs, spread(1.0))
        first, count = first + 1, count - 1
    if count == 0:
        return
    store(waves, first, sine, runs, s)
    store(waves, first, sine + 1, runs, c)
    filled = 1
    while filled < count:
        for k in range(min(filled, count - filled)):
            known, new = first + k, first + filled + k
            a, b = load(waves, known, sine, runs), load(waves, known, sine + 1, runs)
            store(waves, new, sine, runs, fused(s, b, c * a))
            store(waves, new, sine + 1, runs, fused(c, b, -s * a))
        s, c = 2.0 * s * c, 1.0 - 2.0 * s * s
        filled *= 2


@inlined
def set_eight_at_a_time(
    theta: float, from_zero: int, count: int, waves: Array, first: int, sine: int, runs: Runs
) -> None:
    """Do `set_multiples` for one run, with eight multiples in a block: the first directly, the others by rotation."""
    s, c = sine_and_cosine_of_half_turns(load(waves, first, NUMBER, runs) * (theta / math.pi))
    store(waves, first, sine, runs, s)
    store(waves, first, sine + 1, runs, c)
    turn_s, turn_c = lane(s, LANES - 1), lane(c, LANES - 1)
    if from_zero:
        one_s, one_c = lane(s, 1), lane(c, 1)
        turn_s, turn_c = turn_s * one_c + turn_c * one_s, turn_c * one_c - turn_s * one_s
    for k in range(1, count):
        s, c = fused(s, turn_c, c * turn_s), fused(c, turn_c, -turn_s * s)
        store(waves, first + k, sine, runs, s)
        store(waves, first + k, sine + 1, runs, c)


@overloaded(set_multiples)
def _set_multiples(theta: Any, from_zero: Any, count: Any, waves: Any, first: Any, sine: Any, runs: Any) -> Any:
    if theta is VECTOR:
        return set_multiples
    return lambda theta, from_zero, count, waves, first, sine, runs: set_eight_at_a_time(
        theta, from_zero, count, waves, first, sine, runs
    )


@inlined
def set_waves(waves: Array, sets: Array, i: int, along: float, across: float, sine: int, runs: Runs) -> None:
    """Set the waves of the path of contact `i` in rows from `sine` on, from the two angles at the contact."""
    first, count, cross = sets[i, FIRST], sets[i, ALONG], sets[i, ACROSS]
    set_multiples(along, sets[i, FROM_ZERO], count, waves, first, sine, runs)
    if cross:
        set_multiples(across, 1, cross, waves, first + count, sine, runs)
