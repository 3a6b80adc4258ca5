"""Forces of many rigid contacts under Coulomb's law in one step: Newton's method on all forces, written plainly.

A contact that stuck has its slip from the anchor. Any other has the slip of the step, in space with the share of the
last two that makes the velocity of second order. Where this slip ends or turns round, forces up to its end are given,
and the slip of the step counts for the rest.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

STICKING, SLIDING = 1, 2


@dataclass
class Step:
    """Contacts in a step: compliance, motions without forces, ratios, and what the contacts were."""

    compliance: np.ndarray
    free: np.ndarray
    ratio: np.ndarray
    status: np.ndarray
    away: np.ndarray
    last: np.ndarray
    earlier: np.ndarray
    force: np.ndarray
    apex: np.ndarray = field(init=False)
    shift: np.ndarray = field(init=False)
    ends: np.ndarray = field(init=False)

    def __post_init__(self):
        in_space = self.last.shape[1] > 1
        self.apex, self.ends = np.zeros_like(self.free), np.zeros(len(self.free), dtype=bool)
        carried_on = (6.0 * self.last + self.earlier) / 9.0 * in_space
        self.shift = np.where((self.status == STICKING)[:, None], self.away, carried_on)

    def moved(self, force):
        return self.free + (self.compliance @ force.ravel()).reshape(force.shape)

    def own(self, i):
        numbers = slice(i * self.free.shape[1], (i + 1) * self.free.shape[1])
        return self.compliance[numbers, numbers]

    def before_its_end(self, i, force, moved):
        """Forces of a contact that slides on along its last slip, times the share of the step until that ends."""
        w, size = self.own(i), np.linalg.norm(self.last[i])
        way = np.array([1.0, *(-self.ratio[i] * self.last[i] / size)])
        free = moved[i] - w @ force[i]
        if w[0] @ way <= 0.0 or free[0] >= 0.0:
            return np.zeros_like(way)
        on = -free[0] / (w[0] @ way)
        farther = (free + on * w @ way)[1:] @ self.last[i] / size
        return (size / (size - farther) if farther < 0.0 else 0.0) * on * way

    def put_ends(self, force):
        moved = self.moved(force)
        for i in np.flatnonzero(self.ends & (self.status == SLIDING) & self.last.any(axis=1)):
            self.apex[i] = self.before_its_end(i, force, moved)

    def find_ends(self, force):
        """Mark slips that end in the step; return whether there are new ones."""
        moved, found = self.moved(force), False
        for i in np.flatnonzero((self.status != STICKING) & ~self.ends & (force[:, 0] > 0.0)):
            pulled, slid = force[i, 1:], self.status[i] == SLIDING
            slides = np.linalg.norm(pulled) > (1.0 - 1e-9) * self.ratio[i] * force[i, 0]
            on = pulled @ moved[i, 1:] <= 0.0 and (not slid or pulled @ self.last[i] <= 0.0)
            if (slides and on) or (not slid and self.last.shape[1] == 1):
                continue
            self.ends[i], self.shift[i], found = True, 0.0, True
        return found

    def residual(self, force, stiffness):
        """What forces miss of their projection, and its slopes."""
        count, own = force.shape
        within, moved = force - self.apex, self.moved(force)
        moved[:, 1:] += self.shift
        missed, slopes = np.zeros_like(force), np.eye(count * own)
        for i in range(count):
            rows = slice(i * own, (i + 1) * own)
            asked, change = within[i] - stiffness[i] * moved[i], -stiffness[i] * self.compliance[rows]
            change[:, rows] += np.eye(own)
            radius, size = self.ratio[i] * asked[0], np.linalg.norm(asked[1:])
            if asked[0] <= 0.0:
                missed[i] = within[i]
                continue
            if size > radius:
                way = asked[1:] / size
                turned = change[1:] - np.outer(way, way @ change[1:])
                change[1:] = radius / size * turned + self.ratio[i] * np.outer(way, change[0])
                asked[1:] = radius * way
            missed[i] = within[i] - asked
            slopes[rows] -= change
        return missed.ravel(), slopes


def forces(step: Step, trials: int = 200):
    """Return the forces, or None if they are not found."""
    count, own = step.free.shape
    stiffness, force = np.array([own / np.trace(step.own(i)) for i in range(count)]), step.force.copy()
    for _ in range(4):
        for trial in range(trials):
            if trial < 60:
                step.put_ends(force)
            missed, slopes = step.residual(force, stiffness)
            if np.linalg.norm(missed) <= 1e-12 * force[:, 0].max():
                break
            force = force + np.linalg.solve(slopes, -missed).reshape(force.shape)
        else:
            return None
        if not step.find_ends(force):
            return force
    return force
