"""Force of a contact with a stiffness over a step, from the path of its indentation, and the energy stored in it.

The force of step n is the mean of the force along the path over the two steps about it, weighted by a triangle: that
mean moves a mass exactly. The path is the parabola through the indentations of steps n - 1, n and n + 1, which makes
an elastic force of fourth order; where the contact opens or closes, or its damping would pull, the path is divided. The
mean velocity on it is of second order only, and corrected by the third difference of the indentation.
"""

import math

from ..lanes.compiled import strict
from ..lanes.operations import Number, Numbers, Pair
from ..layout.contact_values import Indentations, Yielding
from .lanewise import lanewise

# Change of the indentation, relative to its mean, below which the quotient is computed by its series.
SMALL = 0.01
# Stiffness of a contact times the size of its sawtooth, a motion that changes its sign from step to step, under unit
# forces on all contacts, up to which the path alone gives the force. It would be unstable from 1.5 on: above, the
# quotient of stored energies, which is stable at any step, has a share that grows to one.
RESOLVED = 1.0
# Damping of a contact over the step, times the size of the same sawtooth, up to which the damping is corrected in full:
# on a sawtooth the correction is like a further stiffness of this size, which would be unstable from 0.5 on, beside a
# stiffness of RESOLVED. From twice this size on, where steps are too long for the decay by the damping, there is none.
CORRECTED = 0.25
# Largest correction, relative to the force.
LARGEST = 0.5
# Nodes of Gauss's quadrature with four points, from the middle, relative to half the interval, and their weights.
NODES = (-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526)
WEIGHTS = (0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538)


@strict
def power(x: float, exponent: float) -> float:
    """Return a power of a number that is not negative."""
    if exponent == 1.5:
        return x * math.sqrt(x)
    return x if exponent == 1.0 else x**exponent


@strict
def quotient(x: float, before: float, exponent: float) -> Pair:
    """Return ``(U(x) - U(before)) / (x - before)`` for ``U' = x^exponent`` from zero on, and its slope in x."""
    inside, was = max(x, 0.0), max(before, 0.0)
    mean, change = 0.5 * (inside + was), x - before
    if inside > 0.0 and was > 0.0 and abs(change) <= SMALL * mean:
        p, share = exponent, (change / mean) ** 2
        bend = p * (p - 1.0) / 24.0
        force = power(mean, p) * (1.0 + bend * share * (1.0 + (p - 2.0) * (p - 3.0) / 80.0 * share))
        return force, power(mean, p) / mean * (0.5 * p + 2.0 * bend * change / mean)
    if change == 0.0:
        return 0.0, 0.0
    stored = (inside * power(inside, exponent) - was * power(was, exponent)) / (exponent + 1.0)
    force = stored / change
    return force, (power(inside, exponent) - force) / change


@strict
def press_by_quotient(x: float, before: float, yields: Yielding, step: float) -> Pair:
    """Return the force of an indentation by the quotient of energies, and its slope."""
    stiffness, exponent, damping, rate, _ = yields
    force, slope = quotient(x, before, exponent)
    velocity = 0.5 * (max(x, 0.0) - max(before, 0.0)) / step
    braked = stiffness * force * rate + damping
    total = stiffness * force + braked * velocity
    if total <= 0.0:
        return 0.0, 0.0
    return total, stiffness * slope * (1.0 + rate * velocity) + (0.5 * braked / step if x > 0.0 else 0.0)


@strict
def roots(bent: float, sloped: float, level: float) -> Pair:
    """Return the real roots of ``level + sloped s + bent s²``, 2 in place of those that do not exist."""
    if bent == 0.0:
        return (-level / sloped if sloped != 0.0 else 2.0), 2.0
    under = sloped * sloped - 4.0 * bent * level
    if under <= 0.0:
        return 2.0, 2.0
    half = -0.5 * (sloped + math.copysign(math.sqrt(under), sloped))
    return half / bent, (level / half if half != 0.0 else 2.0)


@strict
def nearest_above(low: float, high: float, one: float) -> float:
    """Return `one` where it lies between the other two, else `high`."""
    return one if low < one < high else high


@strict
def press_on_piece(low: float, high: float, path: Numbers, yields: Yielding, step: float) -> Pair:
    """Return the force on a piece of the path, in steps from -1 to 1, and its slope in the indentation of step n + 1.

    Within a piece the contact is closed or open, and the force is positive or none.
    """
    stiffness, exponent, damping, rate, _ = yields
    level, sloped, bent = path
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    force, slope = 0.0, 0.0
    for k in range(4):
        s = middle + half * NODES[k]
        inside, moved = level + s * (sloped + s * bent), (sloped + 2.0 * s * bent) / step
        if inside <= 0.0:
            return 0.0, 0.0
        elastic = stiffness * power(inside, exponent)
        braked = damping + rate * elastic
        here = elastic + braked * moved
        if here <= 0.0:
            return 0.0, 0.0
        weight = half * WEIGHTS[k] * (1.0 - abs(s))
        share, speed = 0.5 * s * (s + 1.0), (s + 0.5) / step
        force += weight * here
        slope += weight * (exponent * elastic / inside * (1.0 + rate * moved) * share + braked * speed)
    return force, slope


@strict
def press_on_path(x: float, now: float, before: float, yields: Yielding, step: float) -> Pair:
    """Return the force over a step and its slope in x, for the indentations of steps n + 1, n and n - 1.

    Only a linear stiffness has a dashpot, and no damping rate beside it.
    """
    stiffness, exponent, damping, rate, _ = yields
    level, sloped, bent = now, 0.5 * (x - before), 0.5 * (x - 2.0 * now + before)
    if max(x, now, before) <= 0.0:
        return 0.0, 0.0
    if exponent == 1.0 and rate == 0.0 and min(x, now, before) > 0.0:
        # A parabola deviates from the chords of three points by at most an eighth of their second difference, and its
        # steepest slope is that at an end.
        least = min(x, now, before) - 0.25 * abs(bent)
        if stiffness * least >= damping * (abs(sloped) + 2.0 * abs(bent)) / step:
            force = stiffness * (x + 10.0 * now + before) / 12.0 + damping * sloped / step
            return force, stiffness / 12.0 + 0.5 * damping / step
    opens, closes = roots(bent, sloped, level)
    if rate == 0.0:
        first, second = roots(
            stiffness * bent,
            stiffness * sloped + 2.0 * damping * bent / step,
            stiffness * level + damping * sloped / step,
        )
    else:
        first, second = roots(0.0, 2.0 * rate * bent / step, 1.0 + rate * sloped / step)
    force, slope, low = 0.0, 0.0, -1.0
    while low < 1.0:
        high = nearest_above(low, 1.0, 0.0)
        for cut in (opens, closes, first, second):
            high = nearest_above(low, high, cut)
        more, steeper = press_on_piece(low, high, (level, sloped, bent), yields, step)
        force, slope, low = force + more, slope + steeper, high
    if damping > 0.0:
        # The force of a dashpot begins at once where the contact closes, at a place that moves with x.
        for cut in (opens, closes):
            if -1.0 < cut < 1.0 and sloped + 2.0 * cut * bent > 0.0:
                slope += damping / step * (1.0 - abs(cut)) * 0.5 * cut * (cut + 1.0)
    return force, slope


@lanewise(0.0)
def share_of(x: Number, path: Indentations, yields: Yielding) -> Number:
    """Return the share of the force by the quotient of energies, for the indentation `x` without force."""
    deepest = max(x, path.now, path.before)
    if deepest <= 0.0:
        return 0.0
    steepness = yields.reach * yields.stiffness * yields.exponent * power(deepest, yields.exponent) / deepest
    return 1.0 - RESOLVED / steepness if steepness > RESOLVED else 0.0


@strict
def damping_corrected(path: Indentations, yields: Yielding, step: float) -> float:
    """Return the damping that is corrected in a step: none unless the contact was closed in the last three."""
    _, _, damping, rate, reach = yields
    if (damping == 0.0 and rate == 0.0) or min(path.now, path.before, path.earlier) <= 0.0:
        return 0.0
    braked = damping + rate * yields.stiffness * power(path.now, yields.exponent)
    size = reach * braked / step
    return braked * min(max(2.0 - size / CORRECTED, 0.0), 1.0)


@strict
def press_corrected(x: float, path: Indentations, yields: Yielding, step: float) -> Pair:
    """Return the force on the path, with its damping corrected, and its slope.

    The mean velocity is too large by a twelfth of the third difference, taken half a step late. Across a jump of the
    acceleration the sum of the corrections over the steps is still right. Where the contact ceases to press they vanish
    with the force, which is therefore continuous.
    """
    now, before, earlier = path
    force, slope = press_on_path(x, now, before, yields, step)
    braked = damping_corrected(path, yields, step)
    if braked == 0.0 or force == 0.0:
        return force, slope
    per_difference = braked / (12.0 * step)
    more = -per_difference * (x - 3.0 * (now - before) - earlier)
    if abs(more) <= LARGEST * force:
        return force + more, slope - per_difference
    share = 1.0 + math.copysign(LARGEST, more)
    return share * force, share * slope


@lanewise((0.0, 0.0))
def press(x: Number, path: Indentations, yields: Yielding, share: Number, step: float) -> Pair:
    """Return the force of an indentation and its slope.

    `path` are the indentations of the last three steps, the latest first, `share` that of the quotient of energies.
    """
    before = path.before
    force, slope = press_corrected(x, path, yields, step)
    if share == 0.0:
        return force, slope
    other, steeper = press_by_quotient(x, before, yields, step)
    return force + share * (other - force), slope + share * (steeper - slope)


@strict
def between(x: float, now: float, exponent: float) -> float:
    """Return the energy per stiffness stored between two steps, given the indentations at both.

    A sixth of it is the mean of the energies at the two steps; the rest is the energy at their geometric mean, which
    for a linear stiffness makes the sum of all energies constant as long as the contact is closed.
    """
    inside, was = max(x, 0.0), max(now, 0.0)
    mean = math.sqrt(inside * was)
    energy = 5.0 * mean * power(mean, exponent)
    energy += 0.5 * (inside * power(inside, exponent) + was * power(was, exponent))
    return energy / (6.0 * (exponent + 1.0))


@lanewise(0.0)
def stored_in(x: Number, now: Number, yields: Yielding) -> Number:
    """Return the energy stored in a contact between two steps, given the indentations at both."""
    return yields.stiffness * between(x, now, yields.exponent) if yields.stiffness > 0.0 else 0.0
