"""Reduced bodies of sparse matrices that are too large for dense ones, and of dense ones with a cutoff."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io
import scipy.linalg
import scipy.sparse

import stridula as st
from stridula.bodies.matrices import reduced_body
from stridula.bodies.reduction.dense_reduction import reduce_body
from stridula.bodies.reduction.sparse_reduction import DENSE

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


def plate(kind: str):
    """Mass and stiffness of a square grid of masses with springs to the ground along x and y, or a full matrix.

    Units of every second degree of freedom differ, as those of rotations do.
    """
    side, random = 19, np.random.default_rng(5)
    size = 2 * side**2
    beside = np.eye(side, k=1) + np.eye(side, k=-1)
    net = 4.0 * np.eye(side**2) - np.kron(beside, np.eye(side)) - np.kron(np.eye(side), beside)
    stiffness = np.kron(net, np.array([[2.0, 0.3], [0.3, 1.0]]))
    if kind == "free":
        links = np.kron(np.kron(beside, np.eye(side)) + np.kron(np.eye(side), beside), np.eye(2))
        stiffness = np.diag(links.sum(axis=1)) - links
    if kind == "full":
        turned = scipy.linalg.qr(random.standard_normal((size, size)))[0]
        stiffness = turned.T @ stiffness @ turned
        stiffness = 0.5 * (stiffness + stiffness.T)
    mass = np.diag(random.uniform(1.0, 2.0, size))
    units = np.where(np.arange(size) % 2, 1.0, 30.0)
    return np.outer(units, units) * mass, 1e6 * np.outer(units, units) * stiffness, units


@pytest.mark.parametrize("damping", ["ratio", "matrix"])
@pytest.mark.parametrize("kind", ["held", "free", "full"])
def test_dense_matrices_with_a_cutoff_have_the_modes_of_all(kind, damping):
    """The search for some modes against the solution for all, from which most are cut off."""
    mass, stiffness, units = plate(kind)
    size = len(mass)
    assert size > DENSE
    losses = 1e-5 * stiffness + 2.0 * mass + (kind != "full") * np.diag(np.arange(size) * 0.1 * units**2)
    words = {
        "points": {"corner": (0, 1), "middle": (size // 2, None)},
        "translation": np.stack([np.arange(size) % 2 == 0, np.arange(size) % 2 == 1]) / units,
        "damping": losses if damping == "matrix" else 0.02,
        "cutoff": 100.0,
    }
    body = st.ReducedBody(mass, stiffness, **words)
    found, known = body.modes(), reduce_body(body)
    modes = known.modes
    assert 10 < (~modes.massless).sum() < size // 8
    assert found.massless.sum() == modes.massless.sum() > 0
    held = ~modes.massless
    assert (found.angular_frequency == 0.0).sum() == (2 if kind == "free" else 0)
    np.testing.assert_allclose(found.angular_frequency[held], modes.angular_frequency[held], rtol=1e-9)
    traces = [
        np.concatenate([rows @ shapes for rows in body.points.values()]) for shapes in (body.shapes, known.shapes)
    ]
    soft = [np.where(one.stiffness > 0.0, one.stiffness, np.inf) for one in (found, modes)]
    flexible = [(trace / one) @ trace.T for trace, one in zip(traces, soft, strict=True)]
    np.testing.assert_allclose(flexible[0], flexible[1], atol=1e-9 * np.abs(flexible[1]).max())
    # Quantities that do not depend on the choice of shapes of equal frequency: rates of decay at the points.
    lossy = [np.diag(one.damping_rate) if one.damping_matrix is None else one.damping_matrix for one in (found, modes)]
    decays = [trace @ one @ trace.T for trace, one in zip(traces, lossy, strict=True)]
    np.testing.assert_allclose(decays[0], decays[1], atol=1e-8 * np.abs(decays[1]).max())
    assert (found.damping_matrix is None) == (modes.damping_matrix is None)
    moved = [one.translation @ trace.T for trace, one in zip(traces, (found, modes), strict=True)]
    np.testing.assert_allclose(moved[0], moved[1], atol=1e-8 * np.abs(moved[1]).max())


@pytest.mark.parametrize("large", [True, False])
def test_errors_of_dense_matrices_do_not_depend_on_the_way(large, monkeypatch):
    """A stiffness that is not positive semidefinite, a cutoff below the first mode, too many ratios of damping."""
    if not large:
        monkeypatch.setattr(reduced_body, "DENSE", 10_000)
    mass, stiffness, _ = plate("held")
    for changes, words in (
        ({"stiffness": stiffness - 1e6 * np.diag(np.diag(mass))}, "stiffness must be positive semidefinite, got the"),
        ({"cutoff": 1e-3}, "cutoff must leave at least one mode .first at 27.9394 Hz"),
        ({"damping": [0.1, 0.2]}, "damping must have one ratio or 5, one for each mode kept, got 2"),
    ):
        given = {"mass": mass, "stiffness": stiffness, "points": {"corner": (0, 1)}, "cutoff": 60.0} | changes
        with pytest.raises(st.ArgumentError, match=words):
            st.ReducedBody(**given)
