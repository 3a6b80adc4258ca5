"""Forces of closed contacts at the start: a single contact is solved alone, as beside another that it does not move."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula._kernels.contact.exact import SLIDING, STICKING
from stridula._kernels.layout import columns as at
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import forces_of
from stridula.lowering.own_laws import law_of_march

LAWS = [
    st.Coulomb(0.4),
    st.StaticKinetic(0.5, 0.3),
    st.Stribeck(0.5, 0.3, 0.01),
    st.TabulatedFriction([0.0, 0.01, 0.1], [0.5, 0.35, 0.3]),
    st.LuGre(0.6, 0.35, 0.05, 2e4, 8.0, 0.2),
]
TOLERANCE = 1e-10


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_a_single_contact_has_the_forces_that_it_has_beside_another(law):
    random, step, ratios = np.random.default_rng(5), 1e-5, []
    code, numbers = law_of_march(law)
    codes, laws = np.full(2, code), np.array([numbers, numbers])
    for _ in range(100):
        size = random.standard_normal((2, 4))
        one = size @ size.T
        both = np.zeros((4, 4))
        both[:2, :2] = both[2:, 2:] = one
        gap, slip = -random.random(), random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-3.0, 1.0)
        carried = np.zeros((2, at.CARRIED))
        carried[:, at.STATUS] = random.choice([STICKING, SLIDING])
        if carried[0, at.STATUS] == SLIDING:
            carried[:, at.LAST_SLIP] = carried[:, at.EARLIER_SLIP] = 0.1 * slip
        else:
            carried[:, at.MATERIAL] = 0.1 * random.standard_normal()
        given = (both, (codes, laws), carried)
        pair = forces_of(np.array([gap, gap]), np.array([[slip], [slip]]), *given, step, GaussSeidel(tolerance=1e-13))
        alone = forces_of(
            np.array([gap]), np.array([[slip]]), one, (codes[:1], laws[:1]), carried[:1], step, GaussSeidel()
        )
        np.testing.assert_allclose(alone, pair[:1], rtol=TOLERANCE)
        ratios.append(alone[0, 1] / alone[0, 0])
    # Some stick, with a ratio of their own.
    assert np.unique(np.round(ratios, 9)).size > 10
