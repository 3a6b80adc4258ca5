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
    """Ratio of the forces of a step, its past part in the next one, status, share of the step in stick, and state."""

    ratio: float
    past: float
    status: int
    stuck: float
    state: float = 0.0


def on_its_way(before, free, normal, h):
    """Return the way of a contact under a normal force."""
    law, last, give, moved = before.law, before.slip, free.w[1, 1], free.slip + free.w[1, 0] * normal
    pull = give * normal
    if laws.has_state(law):
        scale = 1e-9 if isinstance(law, laws.ElasticFriction) else law.velocity * 1e-12
        ratio, past, state = with_state(before, moved, give, normal, h, partial(_root, scale))
        least = min(normal, before.normal)
        later = normal + np.clip(normal - before.normal, -least, least)
        slow = laws.counts_as_sticking(law.under(max(later, 1e-200)), state, (moved - pull * ratio) / h)
        return Way(ratio, past, STICKING if slow else SLIDING, 0.0, state)
    begun, past = 0.5 * (last + moved), before.past
    # Let go, it never sticks.
    held = -1.0 if free.let_go else laws.held_up_to(law, before.status == STICKING)
    driven = (moved + free.strayed) / pull
    # Whether it sticks, and when it breaks, follows from the forces with which it would stick.
    pressed, pushed = np.linalg.solve(free.w, [-free.gap, -free.slip - free.strayed])
    needed = driven if before.status == SLIDING or pressed <= 0 else -pushed / pressed
    if before.status == STICKING and last == 0.0:
        grows = needed - (2 * past if before.normal else needed)
        way = Sliding(law, h, pull, pull * driven, pull * grows)
        return _from_stick(way, needed, grows, driven, free.let_go)
    if before.status == STICKING:
        short = 2 * (needed - past)
        if abs(short) <= held:
            return Way(needed, short / 2, STICKING, 1.0)
        left = 2 * pull * (driven - past)
        most = abs(left) * max(1.0 - laws.held_up_to(law, not free.let_go) / abs(short), 0.0)
        u = np.clip(begun + free.strayed / 2 - pull * past, -most, most)
        return Sliding(law, h, pull, left - 2 * u).follow(u, 0.0, np.sign(u) or np.sign(short), past)
    if before.status == SEPARATED:
        if abs(needed) <= held:
            return Way(needed, needed / 2, STICKING, 1.0)
        past = 0.5 * (1.0 if begun > 0 else -1.0) * laws.curve(law, abs(begun) / h)
    u, drive = begun - pull * past, moved - last
    sense = 1.0 if u > 0 or (u == 0 and drive > 0) else -1.0
    return Sliding(law, h, pull, drive).follow(u, 0.0, sense, past)


def _from_stick(way, needed, grows, driven, let_go):
    """The way of a contact that stuck to the end of the last step: it sticks, breaks, or broke in the last step."""
    held = laws.held_up_to(way.law, not let_go)
    if max(abs(needed), abs(needed + grows)) <= held and not let_go:
        return Way(needed, needed / 2, STICKING, 1.0)
    mean = needed / 2 - grows / 6
    if abs(needed) > held:
        # It broke before this step: from the last one on it slides with the ratio of incipient sliding.
        sense, earlier = np.sign(needed), needed - grows
        breaks = np.clip((sense * held - earlier) / grows, 0.0, 1.0) if grows else 0.0
        slides = sense * laws.curve(way.law, 0.0)
        broken = _straight(0.0, breaks, earlier, earlier + grows * breaks) + _straight(breaks, 1.0, slides, slides)
        u = way.pull * (mean - broken[1] + (1 - breaks**2) / 2 * (driven - needed))
        return way.follow(u, 0.0, sense, broken[1])
    breaks = 0.0 if abs(needed) >= held else np.clip((np.sign(needed + grows) * held - needed) / grows, 0.0, 1.0)
    later, past = _straight(0.0, breaks, needed, needed + grows * breaks)
    return way.follow(0.0, breaks, np.sign(needed + grows) or -1.0, mean + later, past)


@dataclass
class Sliding:
    """Sliding on its way under a set-valued law, in a step of `h` [s]: ``u' = drive + growth s - pull r``."""

    law: st.FrictionLaw
    h: float
    pull: float
    drive: float
    growth: float = 0.0

    def follow(self, u, begin, sense, ratio, past=0.0):
        """Slide to the end of the step from `begin` on, where it stuck until then, with both parts of the ratio."""
        held, stuck, parts = laws.held_up_to(self.law, True) * self.pull, begin, np.array([ratio, past])
        for _ in range(3):
            more, stop = self.until_stop(u, begin, sense)
            parts += more
            if stop is None:
                break
            first, last = self.drive + self.growth * stop, self.drive + self.growth
            if max(abs(first), abs(last)) <= held:
                parts += _straight(stop, 1.0, first, last) / self.pull
                return Way(*parts, STICKING if stop < 1 else SLIDING, stuck + 1.0 - stop)
            begin = stop
            if abs(first) <= held:
                broken = np.sign(last) * held
                begin = stop + (1 - stop) * (broken - first) / (last - first)
                parts += _straight(stop, begin, first, broken) / self.pull
                first = last
            u, sense = 0.0, 1.0 if first > 0 else -1.0
        return Way(*parts, SLIDING, stuck)

    def until_stop(self, u, a, sense):
        """Slide by the method of Runge and Kutta; return both parts of the ratio, and the share at a stop or None."""
        parts = np.zeros(2)

        def ratio(u):
            return sense * laws.curve(self.law, max(sense * u, 0.0) / self.h)

        while a < 1:
            k1 = ratio(u)
            rate = self.drive + self.growth * a - self.pull * k1
            size = min(self.part(u, rate, abs(k1)), 1 - a)
            middle = self.drive + self.growth * (a + 0.5 * size)
            k2 = ratio(u + size / 2 * rate)
            k3 = ratio(u + size / 2 * (middle - self.pull * k2))
            k4 = ratio(u + size * (middle - self.pull * k3))
            new = u + size * (middle - self.pull * (k1 + 2 * k2 + 2 * k3 + k4) / 6)
            if sense * new < 0:
                # On the parabola with the slope at the beginning.
                bent, after = (new - u - rate * size) / size**2, 0.0
                if u:
                    roots = np.roots([bent, rate, u])
                    inside = [one.real for one in roots if abs(one.imag) < 1e-9 * size and one.real / size > -1e-9]
                    after = float(np.clip(min(inside), 0.0, size))
                half = u + rate * after / 2 + bent * (after / 2) ** 2
                return parts + _moments(a, a + after, k1, ratio(half), ratio(0.0)), a + after
            parts += _moments(a, a + size, k1, 0.5 * (k2 + k3), k4)
            u, a = new, 1.0 if a + size >= 1 else a + size
        return parts, None

    def part(self, u, rate, ratio):
        """Size of a part of the way."""
        law, h = self.law, self.h
        if isinstance(law, st.StaticKinetic):
            return 1.0
        if isinstance(law, st.TabulatedFriction):
            speed, pieces = abs(u) / h, law.curve
            bend = np.interp(speed, pieces.speed, pieces.bend) + max(speed - pieces.speed[-1], 0.0)
            steep = abs(law.linearised_at(speed).slope)
            return max(0.5 / (abs(rate) / (bend * h) + self.pull * steep / h + 0.4), 1 / 64)
        if isinstance(law, st.LinearWeakening):
            scale, steep = law.static / law.slope * h, law.slope / h * (ratio > law.kinetic)
        else:
            scale, viscous = law.velocity * h, law.viscous / h if isinstance(law, st.Stribeck) else 0.0
            steep = (ratio - law.kinetic - viscous * abs(u)) / scale + viscous
        return max(0.5 / (abs(rate) / (scale + abs(u)) + self.pull * steep + 0.4), 1 / 64)


def _moments(a, b, first, middle, last):
    """Return the integrals of a ratio from a to b with the weights ``1 - s`` and ``s``, by Simpson's rule."""
    s, values = np.array([a, 0.5 * (a + b), b]), np.array([first, 4 * middle, last])
    return (b - a) / 6 * np.array([np.sum((1 - s) * values), np.sum(s * values)])


def _straight(a, b, first, last):
    return _moments(a, b, first, 0.5 * (first + last), last)


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
    law, state, past = before.law.under(normal), before.state, before.past
    elastic = isinstance(law, laws.ElasticFriction)
    pull, begun, drive = give * normal, 0.5 * (before.slip + moved), moved - before.slip
    grows = later = rest = 0 * drive
    least = min(normal, before.normal)
    rises = np.clip(normal - before.normal, -least, least) / normal
    if before.status == SEPARATED:
        past = 0.5 * laws.ratio_with_state(law, state, begun / h)
    elif before.normal > 0:
        # The normal force to which the friction of the last step has changed: an impulse would not go on.
        now = give * (before.normal + np.clip(normal - before.normal, -least, least))
        if elastic:
            # The force of a joint does not change with the normal force.
            now, past = give * before.normal, past * before.normal / normal
        grows = drive - (before.slip - before.earlier_slip) - np.dot(now, before.tangential) / before.normal
    u = begun - np.dot(pull, past) - grows / 6
    count = _parts(law, before, u, drive, pull, h)
    part = 1 / count
    for k in range(count):
        begin, ratios = drive + grows * k * part, np.zeros((2, *np.shape(u)))
        for stage in range(2):
            driven = INNER[stage].sum() * begin + GROWTH[stage] * part * grows
            free = u + part * (driven - np.dot(pull, INNER[stage] @ ratios))
            risen = 1 + rises * part * (k + INNER[stage].sum())
            if elastic:
                law = before.law.under(max(risen * normal, 1e-200))

            def ratio(v, state=state, law=law, risen=risen):
                if elastic:
                    firm = law.stiffness * SHARE * part * h + law.damping
                    force = laws.cut(
                        law.stiffness * state + firm * v, risen * normal * laws.curve(law.friction, laws.size(v))
                    )
                    return force / normal
                return laws.ratio_with_state(law, laws.state_after(law, state, v, SHARE * part * h), v)

            def error(v, free=free, ratio=ratio):
                return v - (free - SHARE * part * np.dot(pull, ratio(v))) / h

            v = root(error, u / h, free / h)
            ratios[stage] = ratio(v)
            state = laws.state_between(law, state, v, SHARE * part * h, (1 - SHARE, SHARE)[stage] * part * h)
        more, less = weighted(part, k * part, ratios)
        later, rest, u = later + more, rest + less, v * h
    if elastic:
        most = max(laws.curve(law.friction, laws.size(one) / h) for one in (before.slip, begun, u))
        return laws.cut(past + later, most), rest, state
    return past + later, rest, state


def _parts(law, before, u, drive, pull, h):
    if isinstance(law, laws.ElasticFriction):
        if np.ndim(pull):
            pull = _along(u, drive, pull)
        limit = max(laws.curve(law.friction, 0.0) * before.normal, 1e-200)
        passed = 2 * laws.size(before.slip) * law.stiffness / limit
        passed = passed if passed <= 8 else 64 / passed
        return int(min(1 + max(4 * np.sqrt(pull / law.normal_force * law.stiffness), passed), 64))
    if not isinstance(law, st.LuGre):
        return int(min(2 + (abs(u) + abs(drive)) / law.slip_distance, 64))
    if np.ndim(pull):
        pull = _along(u, drive, pull)
    change = (laws.size(drive) + pull * law.static) / (4 * law.velocity * h)
    return int(min(1 + max(np.sqrt(pull * law.stiffness) / 0.25, change), 64))


def _along(u, drive, pull):
    squares = u @ u + drive @ drive
    return (u @ pull @ u + drive @ pull @ drive) / squares if squares else np.trace(pull) / 2


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
