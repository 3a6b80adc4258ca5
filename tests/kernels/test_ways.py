"""The way of a slip through a step, as the solution of a contact returns it, and the pieces of its curves."""

import numpy as np
import pytest

import stridula as st
from stridula._kernels.contact.exact import ratio_under, slide_on_its_way
from stridula._kernels.contact.friction import NO_PIECE, curve_at, on_piece
from stridula._kernels.contact.slipping import SLIDING
from stridula._kernels.layout import columns as at
from stridula._kernels.layout.contact_values import Before, Compliance, Free, Law
from stridula._kernels.layout.laws import END_SLOPE, LAW_COLUMNS, ORDER, PIECES, SECTIONS, STATIC
from stridula.lowering.own_laws import law_of_march

STEP = 1e-4
SPEEDS = np.linspace(0.0, 2.0, 9)
LAWS = (
    st.TabulatedFriction(SPEEDS, 0.2 + 0.3 / (1.0 + SPEEDS / 0.2), 0.6),
    st.Stribeck(0.5, 0.3, 0.05, viscous=0.02),
    st.LuGre(0.5, 0.3, velocity=0.1, stiffness=100.0, damping=1.0),
)


@pytest.mark.parametrize("order", [1, 2, 3, 4, 7, 8])
def test_a_piece_has_the_ratio_of_its_curve(order):
    random, pieces = np.random.default_rng(order), 5
    edges = np.concatenate([[0.0], np.cumsum(random.uniform(0.1, 1.0, pieces))])
    head = np.zeros(LAW_COLUMNS)
    head[[PIECES, ORDER, END_SLOPE, SECTIONS]] = pieces, order, 0.3, 1
    numbers = [*head, *edges, *random.uniform(0.5, 1.0, pieces + 1), *random.standard_normal(pieces * order)]
    law = Law(at.CURVE, np.array([numbers]), 0, 0.0, 1.0)
    for speed in random.uniform(0.0, edges[-1], 40):
        ratio, _, _, piece = curve_at(law, speed)
        assert piece.begin <= speed < piece.end
        assert on_piece(piece, law, speed) == pytest.approx(ratio, rel=1e-13, abs=1e-13)
    assert curve_at(law, edges[-1] + 0.1)[3] == NO_PIECE


@pytest.mark.parametrize("friction", LAWS, ids=lambda one: one.law)
def test_the_solution_closes_the_gap_and_has_the_way_under_its_normal_force(friction):
    random, (code, row), slides, jumps = np.random.default_rng(7), law_of_march(friction), 0, 0
    for _ in range(300):
        half = random.standard_normal((2, 2))
        w = Compliance(*(1e-7 * (half @ half.T + np.eye(2))).ravel())
        gap, last = -(10.0 ** random.uniform(-7.0, -5.0)), STEP * 10.0 ** random.uniform(-3.0, 0.0)
        slip = last + 0.1 * abs(gap) * random.standard_normal()
        normal, state = abs(gap) / w.nn, 0.003 if code == at.LUGRE else 0.0
        ratio = random.uniform(0.25, 0.4)
        before = Before(float(SLIDING), last, last, state, normal, ratio * normal, 0.5 * ratio)
        free, law = Free(gap, slip, 0.0, w, 0.0), Law(code, row[None], 0, row[STATIC], 0.0)
        touch = slide_on_its_way(free, law, before, STEP)
        if touch.jammed:
            continue
        assert gap + w.nn * touch.normal - w.nt * touch.tangential == pytest.approx(0.0, abs=1e-14 * abs(gap))
        found, past, state, status, stuck = ratio_under(touch.normal, free, law, before, STEP)
        if abs(found - touch.tangential / touch.normal) > 1e-9:
            jumps += 1
            continue
        slides += status == SLIDING
        assert found == pytest.approx(touch.tangential / touch.normal, rel=1e-12)
        assert touch.way[:2] == pytest.approx((past, state), rel=1e-10, abs=1e-13)
        # That of the last trial.
        assert touch.way.stuck == pytest.approx(stuck, abs=1e-6)
    assert slides > 100
    # The ratio jumps at few normal forces.
    assert jumps < 10
