"""Reduced bodies of sparse matrices that are too large for dense ones."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io
import scipy.sparse

import stridula as st

SIZE = 5000
POINTS = {"end": (SIZE - 1, None), "middle": (SIZE // 2, None)}
# Springs of 1e6 N/m between masses of 1 g.
STIFF, HEAVY = 1e6, 1e-3


def chain(held):
    """Return mass and stiffness of a chain, its first mass held by another spring or free."""
    diagonal = np.full(SIZE, 2.0)
    diagonal[-1] = 1.0
    diagonal[0] = 2.0 if held else 1.0
    beside = np.full(SIZE - 1, -1.0)
    stiffness = STIFF * scipy.sparse.diags_array([beside, diagonal, beside], offsets=[-1, 0, 1])
    return HEAVY * scipy.sparse.eye_array(SIZE), stiffness.tocsr()


def body(held, **changed):
    mass, stiffness = chain(held)
    translation = np.stack([np.ones(SIZE), np.zeros(SIZE)])
    given = {"points": POINTS, "translation": translation, "cutoff": 60.0}
    return st.ReducedBody(mass, stiffness, **{**given, **changed})


@pytest.mark.parametrize("held", [True, False])
def test_chains_have_the_frequencies_of_their_formula(held):
    modes = body(held).modes()
    number = np.arange(1, SIZE + 1)
    angle = (2 * number - 1) * np.pi / (2 * SIZE + 1) if held else (number - 1) * np.pi / SIZE
    expected = 2.0 * np.sqrt(STIFF / HEAVY) * np.sin(angle / 2.0) / (2.0 * np.pi)
    expected = expected[expected <= 60.0]
    assert expected.size > 15
    found = modes.frequency[~modes.massless]
    # Rounding relative to the largest squared frequency, at the smallest one.
    rounding = 64.0 * np.finfo(float).eps * 4.0 * STIFF / HEAVY / (4.0 * np.pi**2)
    np.testing.assert_allclose(found**2, expected**2, rtol=1e-12, atol=rounding)
    assert (found == 0.0).sum() == (0 if held else 1)


def test_static_displacements_are_those_of_springs_in_a_row():
    """A pull at the end stretches every spring; residual shapes have the flexibility of the modes left out."""
    chained = body(True)
    modes = chained.modes()
    end, middle = chained.trace("end")[0], chained.trace("middle")[0]
    # Rounding of the factors times their condition, (2 SIZE / pi)².
    rounding = np.finfo(float).eps * (2.0 * SIZE / np.pi) ** 2
    assert end / modes.stiffness @ end == pytest.approx(SIZE / STIFF, rel=rounding)
    assert middle / modes.stiffness @ end == pytest.approx((SIZE // 2 + 1) / STIFF, rel=rounding)
    assert body(True, residual_flexibility=False).modes().massless.sum() == 0
    # Its own weight: the sum of n (n + 1) / 2 masses over the stiffness.
    sag = end / modes.stiffness @ modes.translation[0]
    assert sag == pytest.approx(SIZE * (SIZE + 1) / 2.0 * HEAVY / STIFF, rel=rounding)


def test_matrices_are_read_from_files(tmp_path):
    mass, stiffness = chain(True)
    scipy.io.mmwrite(tmp_path / "mass.mtx", scipy.sparse.coo_array(mass), symmetry="symmetric")
    scipy.io.mmwrite(tmp_path / "stiffness.mtx", scipy.sparse.coo_array(stiffness), symmetry="symmetric")
    translation = np.stack([np.ones(SIZE), np.zeros(SIZE)])
    read = st.ReducedBody.read(
        mass=tmp_path / "mass.mtx",
        stiffness=tmp_path / "stiffness.mtx",
        points=POINTS,
        translation=translation,
        cutoff=60.0,
    )
    assert read == body(True)
    assert hash(read) == hash(body(True))
    assert read != body(True, cutoff=50.0)
    with pytest.raises(ValueError):
        read.mass.data[0] = 2.0
    assert read.total_mass == pytest.approx(SIZE * HEAVY)


def test_requirements_of_large_bodies_are_reported(tmp_path):
    mass, stiffness = chain(True)
    for make, words in (
        (lambda: body(True, cutoff=None), "cutoff must be given for more than 4000"),
        (lambda: st.ReducedBody(mass, stiffness[:-1, :-1], POINTS, cutoff=60.0), "stiffness must be a sparse matrix"),
        (lambda: st.ReducedBody(mass, np.eye(SIZE), POINTS, cutoff=60.0), "stiffness must be a sparse matrix of 5000"),
        (lambda: st.ReducedBody(np.eye(SIZE), stiffness, POINTS, cutoff=60.0), "mass must have at most 4000"),
        (lambda: st.ReducedBody(0.0 * mass, stiffness, POINTS, cutoff=60.0), "mass must be positive definite"),
        (lambda: st.ReducedBody(mass, np.nan * stiffness, POINTS, cutoff=60.0), "stiffness must be finite"),
        (
            lambda: st.ReducedBody(mass, stiffness + scipy.sparse.eye_array(SIZE, k=1), POINTS, cutoff=60.0),
            "stiffness must be symmetric",
        ),
        (lambda: body(True, cutoff=0.1), "cutoff must leave at least one mode"),
        (lambda: body(True).save(tmp_path / "a.npz"), "to be saved"),
    ):
        with pytest.raises(st.ArgumentError, match=words) as caught:
            make()
        assert "\n" not in str(caught.value)
