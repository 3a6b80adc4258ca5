"""Natural frequencies of finite elements and modal beams against closed forms, and the order of the elements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from scipy.optimize import brentq

from ..arrays import Array
from ..bodies import FiniteElementBeam, Material, ModalBeam, Rectangle
from .case import Case, Curve, Outcome, Row, Sketch

STEEL = Material(2.1e11, 7800.0)
SQUARE = Rectangle(0.010, 0.010)
ELEMENTS = 40
COUNT = 4


def bending(roots: Array, length: float) -> Array:
    """Return ``(x / L)² sqrt(EI / rho S) / 2 pi`` [Hz] for the roots x of a beam's characteristic function."""
    return (roots / length) ** 2 * sqrt(STEEL.young * SQUARE.second_moment / (STEEL.density * SQUARE.area)) / (2.0 * pi)


def stretching(multiples: Array, length: float) -> Array:
    """Return ``n c / 2 L`` [Hz] of a rod."""
    return multiples * sqrt(STEEL.young / STEEL.density) / (2.0 * length)


def guided_free_roots(count: int) -> Array:
    """Return the roots of ``tan x + tanh x = 0`` above zero."""
    starts = (np.arange(1, count + 1) - 0.25) * pi
    return np.array([brentq(lambda x: np.sin(x) + np.cos(x) * np.tanh(x), a - 0.5, a + 0.5) for a in starts])


N = np.arange(1, COUNT + 1)


@dataclass(frozen=True)
class Beam:
    """A steel beam of 10 x 10 mm with known frequencies.

    Attributes
    ----------
    name : str
        Its supports as text.
    root, tip : str
        Supports.
    length : float
        Length [m].
    roots : ndarray
        Roots of the characteristic function of bending.
    multiples : ndarray
        Multiples of c / 2L in stretching.
    rigid : int
        Number of rigid motions.
    """

    name: str
    root: str
    tip: str
    length: float
    roots: Array
    multiples: Array
    rigid: int

    def elements(self, count: int = ELEMENTS) -> FiniteElementBeam:
        """Return the beam in finite elements."""
        return FiniteElementBeam(
            STEEL, SQUARE, self.length, elements=count, root_support=self.root, tip_support=self.tip
        )


BEAMS = (
    Beam("simply supported", "pinned", "pinned", 0.3, N * pi, N, 0),
    Beam("guided-free", "guided", "free", 0.15, guided_free_roots(COUNT), N, 2),
    Beam("guided-pinned", "guided", "pinned", 0.3, (N - 0.5) * pi, N - 0.5, 0),
)


def families(body: FiniteElementBeam) -> tuple[Array, Array]:
    """Return the frequencies above zero of bending and of stretching [Hz], distinguished by their motion."""
    along, across = body.axes
    moved = np.array([body.trace(place) for place in np.linspace(0.0, body.length, 23)])
    share = [np.sum(np.tensordot(moved, way, axes=(1, 0)) ** 2, axis=0) for way in (across, along)]
    frequency = body.modes().frequency
    return frequency[(frequency > 0) & (share[0] > share[1])], frequency[(frequency > 0) & (share[1] > share[0])]


def beams() -> Outcome:
    """Three supports in 40 elements."""
    rows, curves = [], []
    for beam in BEAMS:
        found, along = families(beam.elements())
        known, known_along = bending(beam.roots, beam.length), stretching(beam.multiples, beam.length)
        hermite = "Hermite cubics, 40 elements: (x/n)^4 / 1440 of the frequency, round-off of the highest mode"
        linear = "linear bars, 40 elements: (x/n)² / 24 of the frequency and its next term"
        for k in range(COUNT):
            # The next term of the series is (x/n)² of the first.
            share = (beam.roots[k] / ELEMENTS) ** 4 / 1440.0 * (1.0 + (beam.roots[k] / ELEMENTS) ** 2)
            share += np.finfo(float).eps * (found[-1] / found[k]) ** 2
            rows.append(Row(f"{beam.name}, bending {k + 1}", known[k], found[k], share * known[k], hermite, "Hz"))
        for k in range(2):
            share = (beam.multiples[k] * pi / ELEMENTS) ** 2 / 23.0
            words = f"{beam.name}, stretching {k + 1}"
            rows.append(Row(words, known_along[k], along[k], share * known_along[k], linear, "Hz"))
        rigid = int(np.sum(beam.elements().modes().frequency == 0.0))
        rows.append(Row(f"{beam.name}, rigid motions", beam.rigid, rigid, 0.0, "a count"))
        curves.append(Curve(N, found[:COUNT] / known - 1.0, beam.name, marks=True))
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


def pinned(count: int, mass: str) -> FiniteElementBeam:
    """Return the simply supported beam in finite elements."""
    return FiniteElementBeam(STEEL, SQUARE, 0.3, elements=count, mass=mass, root_support="pinned", tip_support="pinned")


def element_orders() -> Outcome:
    """Order of the eigenvalue of the second mode in the size of the elements, simply supported."""
    beam, counts = BEAMS[0], np.array([8, 12, 16, 24])
    kinds: list[tuple[str, str, int, float, Callable[[FiniteElementBeam], float]]] = [
        ("bending, consistent mass", "consistent", 4, bending(beam.roots, 0.3)[1], lambda body: families(body)[0][1]),
        ("bending, lumped mass", "lumped", 2, bending(beam.roots, 0.3)[1], lambda body: families(body)[0][1]),
        ("stretching, consistent mass", "consistent", 2, stretching(N, 0.3)[1], lambda body: families(body)[1][1]),
        ("stretching, lumped mass", "lumped", 2, stretching(N, 0.3)[1], lambda body: families(body)[1][1]),
    ]
    rows, curves = [], []
    for name, mass, order, known, frequency in kinds:
        errors = np.array([abs((frequency(pinned(int(n), mass)) / known) ** 2 - 1.0) for n in counts])
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
