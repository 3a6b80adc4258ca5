"""Natural frequencies of finite elements and modal beams against closed forms, and the order of the elements."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np

from ..arrays import Array
from ..bodies import FiniteElementBeam, ModalBeam
from .case import Case, Curve, Outcome, Row, Sketch
from .systems.beams import COUNT, SQUARE, STEEL, SUPPORTS, N, beam_of, bending, families, stretching

ELEMENTS = 40
# Names of supports and lengths [m].
BEAMS = (("simply supported", 0.3), ("guided-free", 0.15), ("guided-pinned", 0.3))


def beams() -> Outcome:
    """Three supports in 40 elements."""
    rows, curves = [], []
    for name, length in BEAMS:
        beam, body = SUPPORTS[name], beam_of(name, ELEMENTS, length)
        found, along = families(body)
        known, known_along = bending(beam.roots, length), stretching(beam.multiples, length)
        hermite = "Hermite cubics, 40 elements: (x/n)^4 / 1440 of the frequency, round-off of the highest mode"
        linear = "linear bars, 40 elements: (x/n)² / 24 of the frequency and its next term"
        for k in range(COUNT):
            # The next term of the series is (x/n)² of the first.
            share = (beam.roots[k] / ELEMENTS) ** 4 / 1440.0 * (1.0 + (beam.roots[k] / ELEMENTS) ** 2)
            share += np.finfo(float).eps * (found[-1] / found[k]) ** 2
            rows.append(Row(f"{name}, bending {k + 1}", known[k], found[k], share * known[k], hermite, "Hz"))
        for k in range(2):
            share = (beam.multiples[k] * pi / ELEMENTS) ** 2 / 23.0
            words = f"{name}, stretching {k + 1}"
            rows.append(Row(words, known_along[k], along[k], share * known_along[k], linear, "Hz"))
        rigid = int(np.sum(body.modes().frequency == 0.0))
        rows.append(Row(f"{name}, rigid motions", beam.rigid, rigid, 0.0, "a count"))
        curves.append(Curve(N, found[:COUNT] / known - 1.0, name, marks=True))
    return Outcome(rows, Sketch("mode in bending", "frequency over the closed form, less 1", curves))


def modal_beam() -> Outcome:
    """The modal beam uses the closed forms themselves."""
    body = ModalBeam(STEEL, SQUARE, 0.3, bending_modes=COUNT, axial_modes=2)
    known = np.concatenate([bending(N * pi, 0.3), stretching(N[:2], 0.3)])
    found = body.modes().frequency
    words = [f"bending {k}" for k in N] + [f"stretching {k}" for k in N[:2]]
    rows = [
        Row(what, float(a), float(b), 1e-12 * float(a), "round-off", "Hz")
        for what, a, b in zip(words, known, found, strict=True)
    ]
    curves = [Curve(np.arange(1, 7), known, "closed form"), Curve(np.arange(1, 7), found, "modal beam", marks=True)]
    return Outcome(rows, Sketch("mode", "frequency [Hz]", curves))


def fitted_order(sizes: Array, errors: Array) -> float:
    """Return the slope of log error over log size, by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def element_orders() -> Outcome:
    """Order of the eigenvalue of the second mode in the size of the elements, simply supported."""
    supports, counts = "simply supported", np.array([8, 12, 16, 24])
    roots = SUPPORTS[supports].roots
    kinds: list[tuple[str, str, int, float, Callable[[FiniteElementBeam], float]]] = [
        ("bending, consistent mass", "consistent", 4, bending(roots, 0.3)[1], lambda body: families(body)[0][1]),
        ("bending, lumped mass", "lumped", 2, bending(roots, 0.3)[1], lambda body: families(body)[0][1]),
        ("stretching, consistent mass", "consistent", 2, stretching(N, 0.3)[1], lambda body: families(body)[1][1]),
        ("stretching, lumped mass", "lumped", 2, stretching(N, 0.3)[1], lambda body: families(body)[1][1]),
    ]
    rows, curves = [], []
    for name, mass, order, known, frequency in kinds:
        errors = np.array([abs((frequency(beam_of(supports, int(n), mass=mass)) / known) ** 2 - 1.0) for n in counts])
        rows.append(Row(f"order, {name}", order, fitted_order(1.0 / counts, errors), 0.1, "declared order within 0.1"))
        curves.append(Curve(0.3 / counts, errors, name, marks=True))
    sketch = Sketch("size of an element [m]", "relative error of the eigenvalue", curves, logarithmic=True)
    return Outcome(rows, sketch)


CASES = (
    Case(
        "frequencies-beams",
        "Frequencies of beams in finite elements",
        "closed forms of Euler-Bernoulli beams and rods (Blevins 1979, Formulas for Natural Frequency and Mode Shape)",
        beams,
    ),
    Case(
        "frequencies-modal",
        "Frequencies of the modal beam",
        "closed forms of the simply supported beam and the clamped rod (Blevins 1979)",
        modal_beam,
    ),
    Case(
        "order-elements",
        "Order of the finite elements",
        "Strang & Fix 1973, An Analysis of the Finite Element Method: eigenvalues of degree p, order 2 (p + 1 - m)",
        element_orders,
    ),
)
