"""The slip on its way through a step, under laws whose friction changes within it (step 5c).

``u' = drive - pull r`` for the slip u over the step, with the ratio r of the forces. The ratio of a step has the weight
``1 - s`` for its own way and ``s`` for that of the step before.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

import stridula as st

from . import laws

SEPARATED, STICKING, SLIDING = 0, 1, 2
# The rule of two stages. The growth of the drive is divided so that creep under it has the slip of its stages.
SHARE = 1 - np.sqrt(0.5)
INNER = np.array([[SHARE, 0.0], [1 - SHARE, SHARE]])
GROWTH = np.array([(1 / 6 - SHARE / 2) / (1 - SHARE), 0.5])


@dataclass
class Before:
    """What the force of a contact in a step depends on from the steps before: slips [m], forces [N], past ratio.

    `given` is the ratio of its forces, if its motion at the start determines it.
    """

    law: st.FrictionLaw
    status: int = SEPARATED
    slip: float = 0.0
    earlier_slip: float = 0.0
    state: float = 0.0
    normal: float = 0.0
    tangential: float = 0.0
    past: float = 0.0
    given: float | None = None


class Free(NamedTuple):
    """Motion of a contact in a step without its own forces [m], which add ``w @ (N, -T)``.

    `strayed` is the distance of a stick from its anchor. A contact that is `let_go` is held by its kinetic coefficient,
    and slides where it could also stick.
    """

    gap: float
    slip: float
    strayed: float
    w: np.ndarray
    let_go: bool = False


class Way(NamedTuple):
    """Ratio of the forces of a step, its past part in the next one, state and status, share of the step in stick."""

    ratio: float
    past: float
    state: float
    status: int
    stuck: float


@dataclass
class Sliding:
    """Sliding under a set-valued law: the slip that a ratio of one undoes in a step, and the step [s]."""

    law: st.FrictionLaw
    pull: float
    h: float


def on_its_way(before, free, normal, h):
    """Return the way of a contact under a normal force."""
    law, last, give, moved = before.law, before.slip, free.w[1, 1], free.slip + free.w[1, 0] * normal
    pull = give * normal
    if laws.has_state(law):
        ratio, past, state = with_state(before, moved, give, normal, h, partial(_root, law.velocity * 1e-12))
        slow = abs(moved - pull * ratio) < h * law.velocity
        return Way(ratio, past, state, STICKING if slow else SLIDING, 0.0)
    begun, drive = 0.5 * (last + moved), moved - last
    held = laws.held_up_to(law, before.status == STICKING and not free.let_go)
    driven = (moved + free.strayed) / pull
    # Whether it sticks, and when it breaks, follows from the forces with which it would stick.
    pressed, pushed = np.linalg.solve(free.w, [-free.gap, -free.slip - free.strayed])
    needed = driven if before.status == SLIDING or pressed <= 0 else -pushed / pressed
    way = Sliding(law, pull, h)
    if before.status == STICKING and last == 0.0:
        return _from_stick(way, before, needed, driven, held, free.let_go)
    if before.status == STICKING:
        short = 2 * (needed - before.past)
        if abs(short) <= held and not free.let_go:
            return Way(needed, needed / 2, before.state, STICKING, 1.0)
        more, rest, sticks = _slide(way, 0.0, 0.0, (2 * pull * (driven - before.past), 0.0), np.sign(short))
        return _slid(before, before.past + more, rest, sticks)
    past = before.past
    if before.status == SEPARATED:
        if abs(needed) <= held and not free.let_go:
            return Way(needed, needed / 2, before.state, STICKING, 1.0)
        sense = 1.0 if begun > 0 else -1.0
        past = 0.5 * sense * laws.curve(law, abs(begun) / h)
    u = begun - pull * past
    sense = 1.0 if u > 0 or (u == 0 and drive > 0) else -1.0
    more, rest, sticks = _slide(way, u, 0.0, (drive, 0.0), sense)
    return _slid(before, past + more, rest, sticks)


def _from_stick(way, before, needed, driven, held, let_go):
    """The way of a contact that stuck to the end of the last step: it sticks, breaks, or broke in the last step."""
    pull = way.pull
    grows = needed - (before.tangential / before.normal if before.normal else needed)
    if max(abs(needed), abs(needed + grows)) <= held and not let_go:
        return Way(needed, needed / 2 + grows / 3, before.state, STICKING, 1.0)
    if abs(needed) > held:
        # It broke before this step: from the last one on it slides with the ratio of incipient sliding.
        sense, earlier = np.sign(needed), needed - grows
        breaks = np.clip((sense * held - earlier) / grows, 0.0, 1.0) if grows else 0.0
        slides = sense * laws.curve(way.law, 0.0)
        before_now = _moments(0.0, breaks, *(earlier + grows * breaks * np.array([0.0, 0.5, 1.0])))[1]
        before_now += _moments(breaks, 1.0, slides, slides, slides)[1]
        u = pull * ((needed / 2 - grows / 6) - before_now + (1 - breaks**2) / 2 * (driven - needed))
        more, rest, sticks = _slide(way, u, 0.0, (pull * driven, pull * grows), sense)
        return _slid(before, before_now + more, rest, sticks)
    sense = np.sign(needed + grows) or -1.0
    breaks = 0.0 if abs(needed) >= held else np.clip((sense * held - needed) / grows, 0.0, 1.0)
    later, past = _moments(0.0, breaks, *(needed + grows * breaks * np.array([0.0, 0.5, 1.0])))
    more, rest, sticks = _slide(way, 0.0, breaks, (pull * driven, pull * grows), sense)
    return _slid(before, needed / 2 - grows / 6 + later + more, past + rest, sticks, breaks)


def _slid(before, ratio, past, sticks, stuck=0.0):
    """A way that ends in a stick for a share of the step, after another stick, or in sliding."""
    return Way(ratio, past, before.state, STICKING if sticks else SLIDING, stuck + sticks)


def _moments(a, b, first, middle, last):
    """Return the integrals of a ratio from a to b with the weights ``1 - s`` and ``s``, by Simpson's rule."""
    s, values = np.array([a, 0.5 * (a + b), b]), np.array([first, 4 * middle, last])
    return (b - a) / 6 * np.sum((1 - s) * values), (b - a) / 6 * np.sum(s * values)


def _part(way, u, rate, ratio):
    law = way.law
    if isinstance(law, st.StaticKinetic):
        return 1.0
    if isinstance(law, st.LinearWeakening):
        scale, steep = law.static / law.slope * way.h, law.slope / way.h * (ratio > law.kinetic)
    else:
        scale, viscous = law.velocity * way.h, law.viscous / way.h if isinstance(law, st.Stribeck) else 0.0
        steep = (ratio - law.kinetic - viscous * abs(u)) / scale + viscous
    return max(0.5 / (abs(rate) / (scale + abs(u)) + way.pull * steep + 0.5), 1 / 64)


def _slide(way, u, begin, drive, sense):
    """Slide from `begin` on by the method of Runge and Kutta; return both parts of the ratio and the share of stick."""
    later, past, pull = 0.0, 0.0, way.pull
    held = laws.held_up_to(way.law, True)
    for _ in range(3):

        def ratio(u, sense=sense):
            return sense * laws.curve(way.law, max(sense * u, 0.0) / way.h)

        stops, a = False, begin
        while a < 1:
            k1 = ratio(u)
            rate = drive[0] + drive[1] * a - pull * k1
            size = _part(way, u, rate, abs(k1))
            b = 1.0 if a + size >= 1 else a + size
            size = b - a
            middle = drive[0] + drive[1] * 0.5 * (a + b)
            k2 = ratio(u + size / 2 * rate)
            k3 = ratio(u + size / 2 * (middle - pull * k2))
            k4 = ratio(u + size * (middle - pull * k3))
            new = u + size * (middle - pull * (k1 + 2 * k2 + 2 * k3 + k4) / 6)
            if sense * new < 0:
                bent = (new - u - rate * size) / size**2
                after = 0.0
                if u:
                    roots = np.roots([bent, rate, u])
                    inside = [one.real for one in roots if abs(one.imag) < 1e-9 * size and one.real / size > -1e-9]
                    after = float(np.clip(min(inside), 0.0, size))
                half = u + rate * after / 2 + bent * (after / 2) ** 2
                more, less = _moments(a, a + after, k1, ratio(half), ratio(0.0))
                later, past, begin, stops = later + more, past + less, a + after, True
                break
            more, less = _moments(a, b, k1, 0.5 * (k2 + k3), k4)
            later, past, u, a = later + more, past + less, new, b
        if not stops:
            return later, past, 0.0
        ends = drive[0] + drive[1] * np.array([begin, 0.5 * (begin + 1), 1.0])
        if max(abs(ends[0]), abs(ends[2])) <= held * pull:
            more, less = _moments(begin, 1.0, *ends / pull)
            return later + more, past + less, 1.0 - begin
        if abs(ends[0]) <= held * pull:
            breaks = begin + (1 - begin) * (np.sign(ends[2]) * held * pull - ends[0]) / (ends[2] - ends[0])
            at_break = np.sign(ends[2]) * held
            more, less = _moments(begin, breaks, ends[0] / pull, 0.5 * (ends[0] / pull + at_break), at_break)
            later, past, begin, ends = later + more, past + less, breaks, ends[[2, 1, 2]]
        u, sense = 0.0, 1.0 if ends[0] > 0 else -1.0
    return later, past, 0.0


def weighted(size, begin, ratios):
    """The ratios of both stages of a part, weighted for this step and for the next."""
    velocities = INNER[1]
    weights = size**2 * velocities @ INNER + size * velocities * (1 - begin - size)
    return weights @ ratios, (size * velocities - weights) @ ratios


def with_state(before, moved, give, normal, h, root):
    """Ratio, past part and state under a law with internal state, in parts of the rule of two stages.

    All are numbers along one tangent, and vectors along two, where `give`, the compliance, is a matrix. `moved` is the
    slip without friction, under the normal force; `root` finds a velocity.
    """
    law, state, past = before.law, before.state, before.past
    pull, begun, drive = give * normal, 0.5 * (before.slip + moved), moved - before.slip
    grows = later = rest = 0 * drive
    if before.status == SEPARATED:
        past = 0.5 * laws.ratio_with_state(law, state, begun / h)
    elif before.normal > 0:
        # The normal force to which the friction of the last step has changed: an impulse would not go on.
        least = min(normal, before.normal)
        now = give * (before.normal + np.clip(normal - before.normal, -least, least))
        grows = drive - (before.slip - before.earlier_slip) - np.dot(now, before.tangential) / before.normal
    u = begun - np.dot(pull, past) - grows / 6
    count = _parts(law, u, drive, pull, h)
    part = 1 / count
    for k in range(count):
        begin, ratios = drive + grows * k * part, np.zeros((2, *np.shape(u)))
        for stage in range(2):
            driven = INNER[stage].sum() * begin + GROWTH[stage] * part * grows
            free = u + part * (driven - np.dot(pull, INNER[stage] @ ratios))

            def ratio(v, state=state):
                return laws.ratio_with_state(law, laws.state_after(law, state, v, SHARE * part * h), v)

            def error(v, free=free, ratio=ratio):
                return v - (free - SHARE * part * np.dot(pull, ratio(v))) / h

            v = root(error, u / h, free / h)
            ratios[stage] = ratio(v)
            state = laws.state_after(law, state, v, (1 - SHARE, SHARE)[stage] * part * h)
        more, less = weighted(part, k * part, ratios)
        later, rest, u = later + more, rest + less, v * h
    return past + later, rest, state


def _parts(law, u, drive, pull, h):
    if not isinstance(law, st.LuGre):
        return int(min(2 + (abs(u) + abs(drive)) / law.slip_distance, 64))
    if np.ndim(pull):
        squares = u @ u + drive @ drive
        pull = (u @ pull @ u + drive @ pull @ drive) / squares if squares else np.trace(pull) / 2
    change = (laws.size(drive) + pull * law.static) / (4 * law.velocity * h)
    return int(min(1 + max(np.sqrt(pull * law.stiffness) / 0.25, change), 64))


def _root(scale, error, last, free):
    """The velocity at which an increasing function is zero, searched on the scale of creep."""
    at_rest = error(0.0)
    if at_rest == 0.0:
        return 0.0
    sense, high = -np.sign(at_rest), max(abs(last) + abs(free), scale)
    while sense * error(sense * high) < 0:
        high *= 2
    y = brentq(
        lambda y: error(sense * scale * np.sinh(y)), 0.0, np.arcsinh(high / scale), xtol=1e-300, rtol=4 * 2.0**-52
    )
    return sense * scale * np.sinh(y)
