"""The states of all contacts in a step, every combination of which is tried (step 5)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgesv

import stridula as st

from .laws import curve
from .way import SEPARATED, SLIDING, STICKING, Before, Free, Way, on_its_way

# Slides under Coulomb's law have their sense as kind, 1 or -1. What turns round in the step slides back.
OPEN, GIVEN, STICK, BACK, ON_ITS_WAY = "open", "given", "stick", "back", "on its way"


class Touch(NamedTuple):
    """State of a contact in a step, its forces [N], and its way under laws other than Coulomb's."""

    status: int
    normal: float = 0.0
    tangential: float = 0.0
    way: Way | None = None


@dataclass(frozen=True)
class Contacts:
    """All contacts of a step of `h` [s], each without forces of any; these add ``w @ (N1, -T1, N2, ...)``."""

    before: list[Before]
    free: list[Free]
    w: np.ndarray
    h: float

    def alone(self, i, forces):
        """Contact `i` under the forces of all others."""
        others, own = forces.copy(), slice(2 * i, 2 * i + 2)
        others[own] = 0.0
        gap, slip = self.w[own] @ others
        return self.free[i]._replace(gap=self.free[i].gap + gap, slip=self.free[i].slip + slip)


def forces_of(touches):
    """The forces (N1, -T1, N2, ...)."""
    return np.array([value for touch in touches for value in (touch.normal, -touch.tangential)])


def solve(contacts, guess=None):
    """Return every consistent combination of kinds, each with the touch of every contact.

    With a `guess` that combination comes first, and the first that is consistent is enough.
    """
    found = consistent(contacts, guess)
    # The response of another foot may bring a sliding foot below its static limit: it still slides.
    feet = range(len(contacts.free))
    for slides in (chosen for size in feet for chosen in combinations(feet, size + 1)):
        if found:
            break
        free = [one._replace(let_go=i in slides) for i, one in enumerate(contacts.free)]
        found = consistent(replace(contacts, free=free))
    return found


def consistent(contacts, guess=None):
    """The same, without contacts that are let go."""
    found = []
    for kinds in ([] if guess is None else [guess]) + list(product(*map(kinds_of, contacts.before))):
        forces = tried(contacts, kinds)
        if forces is None:
            continue
        touches = []
        for i, kind in enumerate(kinds):
            own = forces[2 * i : 2 * i + 2]
            touch = touch_of(kind, contacts.before[i], contacts.alone(i, forces), own, contacts.h)
            if touch is None:
                break
            touches.append(touch)
        else:
            found.append((kinds, touches))
            if guess is not None:
                break
    return found


def kinds_of(before):
    if before.given is not None:
        return OPEN, GIVEN
    return (OPEN, STICK, 1, -1, BACK) if isinstance(before.law, st.Coulomb) else (OPEN, ON_ITS_WAY)


def touch_of(kind, before, alone, own, h):
    """The touch of a kind under its own forces (N, -T), None if these contradict it."""
    if (kind == OPEN) != (alone.gap >= 0):
        return None
    if kind == OPEN:
        return Touch(SEPARATED)
    normal, tangential = own[0], -own[1]
    if kind == ON_ITS_WAY:
        way = on_its_way(before, alone, normal, h) if normal > 0 else None
        return way and Touch(way.status, normal, tangential, way)
    turn = turned(before, alone)
    if turn:
        fits = kind == (STICK if turn.status == STICKING else BACK)
    elif kind == STICK:
        fits = holds(before, own)
    else:
        slip = alone.slip + alone.w[1] @ own
        fits = kind == GIVEN or (kind != BACK and normal > 0 and kind * slip > 0)
    return Touch(STICKING if kind == STICK else SLIDING, normal, tangential) if fits else None


def holds(before, own):
    return abs(own[1]) <= before.law.coefficient * own[0]


def turned(before, alone):
    """The touch of a contact whose slip ends within the step (5d), else None.

    It slides on for a share of the step; for the rest it is held, or slides back. Forces are means over the step.
    """
    if before.status != SLIDING or before.slip == 0 or alone.gap >= 0:
        return None
    ratio = np.sign(before.slip) * before.law.coefficient
    stiff = alone.w[0, 0] - np.array([ratio, -ratio]) * alone.w[0, 1]
    if stiff.min() <= 0:
        return None
    on, back = (-alone.gap / one * np.array([1.0, r]) for one, r in zip(stiff, (ratio, -ratio), strict=True))
    farther = alone.slip + alone.w[1] @ (on * [1, -1])
    if farther * before.slip >= 0:
        return None
    share = before.slip / (before.slip - farther)
    rest = solved(alone.w, [-alone.gap, before.slip - alone.slip])
    held = holds(before, rest)
    return Touch(STICKING if held else SLIDING, *(share * on + (1 - share) * (rest * [1, -1] if held else back)))


def tried(contacts, kinds):
    """Forces (N1, -T1, N2, ...) of a combination, or None.

    The ratio of a contact that slides back, or goes its way, depends on the forces of all: it is iterated.
    """
    moving = [i for i, kind in enumerate(kinds) if kind in (BACK, ON_ITS_WAY)]
    before, h = contacts.before, contacts.h
    ratios = {i: before[i].tangential / before[i].normal if before[i].normal > 0 else 0.0 for i in moving}
    for _ in range(300):
        forces = closing(contacts, kinds, ratios)
        if forces is None:
            return None
        found = {i: ratio_of(kinds[i], before[i], contacts.alone(i, forces), forces[2 * i], h) for i in moving}
        if None in found.values():
            return None
        if all(abs(found[i] - ratios[i]) <= 1e-15 * max(abs(found[i]), 0.1) for i in moving):
            break
        ratios = found
    return forces


def ratio_of(kind, before, alone, normal, h):
    """The ratio of a contact whose friction changes within the step, None if that is not its state."""
    if kind == BACK:
        turn = turned(before, alone)
        return turn.tangential / turn.normal if turn else None
    return on_its_way(before, alone, normal, h).ratio if alone.gap < 0 and normal > 0 else None


def closing(contacts, kinds, ratios):
    """Forces that close the gaps of a combination, with given ratios where they are not those of sliding, or None."""
    left, right = np.eye(len(contacts.w)), np.zeros(len(contacts.w))
    for i, (kind, before, free) in enumerate(zip(kinds, contacts.before, contacts.free, strict=True)):
        if kind == OPEN:
            continue
        left[2 * i], right[2 * i] = contacts.w[2 * i], -free.gap
        if kind == STICK:
            left[2 * i + 1], right[2 * i + 1] = contacts.w[2 * i + 1], -free.slip - free.strayed
            continue
        ratio = before.given if kind == GIVEN else ratios[i] if i in ratios else kind * curve(before.law, 0.0)
        left[2 * i + 1] = 0.0
        left[2 * i + 1, 2 * i : 2 * i + 2] = ratio, 1.0
    return solved(left, right)


def solved(left, right):
    """Solution of a few equations, as by np.linalg.solve, which takes several times as long for so few."""
    *_, solution, singular = dgesv(left, right)
    return None if singular or not np.all(np.isfinite(solution)) else solution
