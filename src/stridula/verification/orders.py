"""Observed order of the time schemes on smooth motion, and exactness of the exact modal scheme."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm

from ..integration import ExactModal
from .case import Case, Curve, Outcome, Row, Sketch, schemes
from .frequencies import fitted_order
from .prony import only_sliding
from .systems.mode_coupling import hoffmann
from .systems.smooth import forced_track, thrown_slider

DECLARED = 2.0
STEPS = np.array([2e-6, 1e-6, 5e-7])


def smooth() -> Outcome:
    """Fitted order over three steps, the highest mode at most at w h = 0.16."""
    rows, curves = [], []
    for case in (forced_track(), thrown_slider()):
        for scheme in schemes():
            errors = np.array([case.error(scheme, float(step)) for step in STEPS])
            reason = "declared order within 0.1"
            order = fitted_order(STEPS, errors)
            rows.append(Row(f"order, {case.name}", DECLARED, order, 0.1, reason, "1", scheme.name))
            curves.append(Curve(STEPS, errors, f"{case.name}, {scheme.name}", marks=True))
    free = thrown_slider(root_support="pinned", push=0.0, damping=0.01)
    for step in (1e-5, 1e-4):
        words = f"error of free damped motion at a step of {step:g} s"
        reason = "exact at any step; round-off of a step times the steps, 2.2e-16 n w / w_min"
        rows.append(Row(words, 0.0, free.error(ExactModal(), step), 1e-11, reason, "1", ExactModal.name))
    return Outcome(rows, Sketch("step [s]", "relative error", curves, logarithmic=True))


def sliding() -> Outcome:
    """Hoffmann's mass sliding on its belt: contact and friction act, and the motion stays smooth.

    Exact modes leave ``q'' + K q = f + h²/12 f'' + O(h⁴)``: the contact force is off by h²/12 of its own second
    derivative, and the motion, to which only its direction matters, is of fourth order.
    """
    model, friction, duration = hoffmann(), 0.9, 8.0
    steps = np.array([1.6e-2, 8e-3, 4e-3])
    free = np.block([[np.zeros((2, 2)), np.eye(2)], [-model.sliding(friction), np.zeros((2, 2))]])
    rows, curves = [], []
    for scheme in schemes():
        errors = []
        for step in steps:
            run = model.run(friction, scheme, float(step), duration)
            only_sliding(run)
            rest, start = model.start(friction)
            moved = expm(free * duration) @ np.concatenate([start - rest, np.zeros(2)])
            errors.append(float(np.linalg.norm(run["displacement"].values[-1] - rest - moved[:2])))
        order, expected = fitted_order(steps, np.array(errors)), 2.0 * DECLARED if scheme == ExactModal() else DECLARED
        words = "order of a force of one direction, within 0.1"
        rows.append(Row("order, sliding contact", expected, order, 0.1, words, "1", scheme.name))
        curves.append(Curve(steps, np.array(errors), scheme.name, marks=True))
    return Outcome(rows, Sketch("step", "error of the displacement", curves, logarithmic=True))


CASES = (
    Case(
        "order-time",
        "Order of the time schemes on smooth motion",
        "closed form of modes under a harmonic force; schemes declare second order (Carpenter, Taylor & Katona 1991; "
        "Issanchou, Acary, Perignon, Touze & Le Carrou 2018, J. Acoust. Soc. Am. 143)",
        smooth,
    ),
    Case(
        "order-sliding",
        "Order of the time schemes in a sliding contact",
        "matrix exponential of Hoffmann's mass in sliding (Hoffmann, Fischer, Allgaier & Gaul 2002)",
        sliding,
    ),
)
