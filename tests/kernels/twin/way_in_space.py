"""The slip on its way through a step in space: `way` for vectors of both tangents (step 5c)."""

from __future__ import annotations

import numpy as np
from scipy.optimize import root

import stridula as st

from .laws import curve
from .way import INNER, SHARE, weighted, with_state


def solved(error, start, otherwise=None):
    """The vector at which an error vanishes, to round-off, sought from `start`, or `otherwise` where that is zero."""
    start = start if start.any() or otherwise is None else otherwise
    size = max(np.abs(start).max(), 1e-300)
    for begin in (start / size, 0.5 * start / size, 1e-3 * start / size, np.zeros(2)):
        found = root(lambda x: error(size * x) / size, begin, tol=1e-15)
        found = root(lambda x: error(size * x) / size, found.x, tol=1e-15)
        if np.abs(error(size * found.x)).max() < 1e-12 * size:
            return size * found.x
    raise AssertionError("no velocity found")


def on_bristles(before, slip, w, h, normal):
    """Return ratios, past parts and bristles of LuGre's law.

    `slip` are those without forces of this contact, `w` the compliance for ``(N, -T1, -T2)``.
    """
    return with_state(before, slip + w[1:, 0] * normal, w[1:, 1:], normal, h, solved)


def sliding(law, last, past, slip, w, h, normal):
    """Return ratios and past parts of a contact that slides on under a set-valued law, none if it comes to rest."""
    pull, moved = w[1:, 1:] * normal, slip + w[1:, 0] * normal
    drive, begin, later, rest = moved - last, 0.0, np.zeros(2), np.zeros(2)
    u = 0.5 * (last + moved) - pull @ past
    incipient = curve(law, 0.0)
    while begin < 1:
        speed, way = np.linalg.norm(u), u / np.linalg.norm(u)
        friction = curve(law, speed / h)
        rate = np.linalg.norm(drive - friction * pull @ way)
        part = 1.0
        if not isinstance(law, st.StaticKinetic):
            scale, viscous = law.velocity * h, law.viscous / h
            steep = (friction - law.kinetic - viscous * speed) / scale + viscous
            part = min(max(0.5 / (rate / (scale + speed) + way @ pull @ way * steep + 0.4), 1 / 64), 1)
        part = min(max(1 / (1 / part + rate / speed), min(part, 1 / 16)), 1 - begin)
        ratios = np.zeros((2, 2))
        for stage in range(2):
            free = u + part * (INNER[stage].sum() * drive - pull @ (INNER[stage] @ ratios))
            own = SHARE * part * pull
            if np.linalg.norm(np.linalg.solve(own, free)) <= incipient:
                return None

            def ratio(moved):
                size = np.linalg.norm(moved)
                return curve(law, size / h) * moved / size if size else np.zeros(2)

            def error(moved, free=free, own=own, ratio=ratio):
                return moved - free + own @ ratio(moved)

            moved_on = solved(error, free)
            ratios[stage] = ratio(moved_on)
        more, less = weighted(part, begin, ratios)
        later, rest, u, begin = later + more, rest + less, moved_on, begin + part
    return past + later, rest


def closing(gap, w, ratio_under):
    """The normal force that closes a gap and what goes with it: ``N = -gap / (w_nn - w_nt ratio(N))``."""
    normal = -gap / w[0, 0]
    for _ in range(200):
        found = ratio_under(normal)
        if found is None:
            return normal, None
        new = -gap / (w[0, 0] - w[0, 1:] @ found[0])
        if abs(new - normal) <= 1e-15 * normal:
            return new, found
        normal = new
    raise AssertionError("no normal force found")
