"""Rigid joints: parts of a beam welded together against the whole, and a mass bolted to a beam in closed form."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
from scipy.optimize import brentq

from ..arrays import Array
from ..bodies import FiniteElementBeam, Material, ModalBeam, PointMass, Rectangle
from ..connections import RigidJoint
from ..contact import PointContact, RigidTrack
from ..linear.structure import Structure
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch

STEEL, SQUARE = Material(2.1e11, 7800.0, 0.3), Rectangle(0.02, 0.009)
# Length [m] and elements of the whole beam, elements of its first part, and frequencies compared.
LENGTH, ELEMENTS, FIRST, COMPARED = 0.5, 10, 4, 6
# Length of the pinned beam [m], mass in its middle [kg], and intervals of the roots for symmetric modes.
SPAN, BOLTED, INTERVALS = 1.0, 0.5, ((0.1, 1.57), (3.2, 4.712))


def natural_frequencies(system: System) -> Array:
    """Return the natural frequencies of a system whose contacts are open [Hz]."""
    structure = Structure(system)
    moving = structure.mass > 0.0
    squared = np.linalg.eigvalsh(structure.stiffness[np.ix_(moving, moving)])
    return np.asarray(np.sqrt(np.maximum(squared, 0.0)) / (2.0 * pi))


def _welded() -> tuple[Array, Array]:
    """Return the first frequencies of the whole cantilever and of its welded parts [Hz]."""
    whole = FiniteElementBeam(STEEL, SQUARE, LENGTH, elements=ELEMENTS, root_support="clamped")
    share = LENGTH * FIRST / ELEMENTS
    first = replace(whole, length=share, elements=FIRST, root_support="free", name="first part")
    second = replace(whole, length=LENGTH - share, elements=ELEMENTS - FIRST, name="second part")
    joint = RigidJoint(first.root, second.tip, rotations=True)
    alone = System(PointContact(whole.tip, RigidTrack(), gap=1.0))
    parts = System(PointContact(first.tip, RigidTrack(), gap=1.0), (), [joint])
    return natural_frequencies(alone)[:COMPARED], natural_frequencies(parts)[:COMPARED]


def _bolted() -> tuple[Array, Array]:
    """Return the first symmetric frequencies of a pinned beam with a mass in its middle, exactly and found [Hz]."""
    bar, mass = ModalBeam(STEEL, SQUARE, SPAN, bending_modes=80, axial_modes=0), PointMass(BOLTED, name="mass")
    own = STEEL.density * SQUARE.area * SPAN
    ratio = 2.0 * own / BOLTED
    roots = [brentq(lambda b: np.tan(b) - np.tanh(b) - ratio / b, low, high) for low, high in INTERVALS]
    speed = sqrt(STEEL.young * SQUARE.second_moment * SPAN / own)
    exact = np.array([(2.0 * root / SPAN) ** 2 * speed / (2.0 * pi) for root in roots])
    joint = RigidJoint(mass.centre, bar.at(SPAN / 2.0), axes="y")
    found = natural_frequencies(System(PointContact(mass.centre, RigidTrack(), gap=1.0), (), [joint]))
    # The mass moves freely along x, and antisymmetric modes have a node in the middle.
    return exact, found[found > 1.0][: 2 * len(roots) : 2]


def welds() -> Outcome:
    """Frequencies of a cantilever in two welded parts, and of a beam with a mass."""
    (whole, parts), (exact, found) = _welded(), _bolted()
    rows = [
        Row(f"frequency {k} of two welded parts", one, other, 1e-6 * one, "a millionth", "Hz")
        for k, (one, other) in enumerate(zip(whole.tolist(), parts.tolist(), strict=True), 1)
    ]
    rows += [
        Row(f"symmetric frequency {k} with a bolted mass", one, other, 1e-4 * one, "1e-4 with 80 modes", "Hz")
        for k, (one, other) in enumerate(zip(exact.tolist(), found.tolist(), strict=True), 1)
    ]
    numbers = np.arange(1.0, COMPARED + 1.0)
    curves = [Curve(numbers, whole, "whole"), Curve(numbers, parts, "welded")]
    return Outcome(rows, Sketch("mode", "frequency [Hz]", curves))


CASES = (
    Case(
        "welded-beam",
        "Two parts of a beam welded together, and a mass bolted to a beam",
        "frequencies of the whole with the same elements; characteristic equation of a pinned beam with a central mass",
        welds,
    ),
)
