"""Searches for modes by blocks against closed forms, and the libraries that factorise for them against SuperLU."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest
import scipy.sparse

import stridula as st
from stridula.bodies.reduction import factorisation, sparse_reduction
from stridula.bodies.reduction.block_lanczos import WIDTH, Inverse, lowest
from stridula.bodies.reduction.factorisation import LIBRARIES, factorised
from stridula.bodies.reduction.sparse_reduction import SparseProblem, reduce_sparse

SIZE = 400
EPS = float(np.finfo(float).eps)


def chains(count: int, held: bool = True):
    """Mass and stiffness of equal chains of unit masses and springs side by side, and their squared frequencies."""
    diagonal = np.full(SIZE, 2.0)
    if not held:
        diagonal[[0, -1]] = 1.0
    beside = np.full(SIZE - 1, -1.0)
    stiffness = scipy.sparse.diags_array([beside, diagonal, beside], offsets=[-1, 0, 1])
    every = scipy.sparse.kron(scipy.sparse.eye_array(count), stiffness).tocsr()
    number = np.arange(SIZE)
    angle = (number + 1) * np.pi / (SIZE + 1) if held else number * np.pi / SIZE
    return scipy.sparse.eye_array(count * SIZE, format="csr"), every, np.repeat(4.0 * np.sin(0.5 * angle) ** 2, count)


def problem(count: int, held: bool = True) -> tuple[SparseProblem, np.ndarray]:
    mass, stiffness, squared = chains(count, held)
    return SparseProblem(mass, stiffness, np.zeros((count * SIZE, 0))), squared


@pytest.mark.parametrize("longest", [400, 40])
def test_a_search_finds_the_lowest_modes_of_their_formula(longest):
    """Also if the basis is too short for all of them, so that it begins again."""
    mass, stiffness, squared = chains(2)
    shift, highest = 1e-4, float(np.sqrt(squared[30] * squared[32]))
    solve = factorised(stiffness + shift * mass)
    found, shapes = [], np.zeros((2 * SIZE, 0))
    block = np.random.default_rng(1).standard_normal((2 * SIZE, WIDTH))
    searches = 0
    while searches < 20:
        searches += 1
        part = lowest(Inverse(mass, solve, shift, shapes), block, highest, longest=longest)
        found, shapes = np.append(found, part.squared), np.hstack([shapes, part.shapes])
        block = part.following
        if part.is_complete:
            break
    assert (searches == 1) == (longest == 400)
    found = np.sort(found[found <= highest])
    # Rounding of the factors, of which the largest eigenvalue is 4.
    np.testing.assert_allclose(found, squared[: found.size], rtol=0.0, atol=4.0 * 4.0 * EPS)
    assert found.size == (squared <= highest).sum() == 32
    np.testing.assert_allclose(shapes.T @ (mass @ shapes), np.eye(shapes.shape[1]), atol=1e-12)
    left = stiffness @ part.shapes - mass @ part.shapes * part.squared
    assert np.linalg.norm(left, axis=0).max() < 1e-9 * np.abs(stiffness).max()


def test_no_mode_is_missed_where_a_block_has_no_part_in_it():
    """Seven equal chains, of which the first block moves four: the next search beside them finds the others."""
    mass, stiffness, squared = chains(7)
    highest = 1.5 * squared[7 * 3]
    shift = 1e-2 * highest
    solve = factorised(stiffness + shift * mass)
    random = np.random.default_rng(1)
    start = random.standard_normal((7 * SIZE, WIDTH))
    start[4 * SIZE :] = 0.0
    first = lowest(Inverse(mass, solve, shift, np.zeros((7 * SIZE, 0))), start, highest)
    assert first.is_complete
    assert first.squared.size == 4 * 4
    beside = Inverse(mass, solve, shift, first.shapes)
    second = lowest(beside, random.standard_normal((7 * SIZE, WIDTH)), highest)
    found = np.sort(np.append(first.squared, second.squared))
    expected = squared[squared <= highest]
    np.testing.assert_allclose(found[: expected.size], expected, rtol=1e-9)
    third = lowest(Inverse(mass, solve, shift, np.hstack([first.shapes, second.shapes])), start, highest)
    assert third.is_complete
    assert not third.squared.size
    whole, _ = problem(7)
    found = reduce_sparse(whole, float(np.sqrt(highest)) / (2.0 * np.pi)).angular_frequency
    np.testing.assert_allclose(found**2, expected, rtol=1e-9)


def test_modes_without_stiffness_are_found_where_they_are_not_known():
    whole, squared = problem(3, held=False)
    highest = 1.5 * squared[3 * 3]
    found = reduce_sparse(whole, float(np.sqrt(highest)) / (2.0 * np.pi))
    assert (found.angular_frequency == 0.0).sum() == 3
    np.testing.assert_allclose(found.angular_frequency[3:] ** 2, squared[3 : found.angular_frequency.size], rtol=1e-9)


def test_the_first_mode_is_named_where_none_is_left():
    whole, squared = problem(2)
    with pytest.raises(st.ArgumentError, match="cutoff must leave at least one mode") as caught:
        reduce_sparse(whole, 0.1 * float(np.sqrt(squared[0])) / (2.0 * np.pi))
    first = float(str(caught.value).split("first at ")[1].split(" Hz")[0])
    assert first == pytest.approx(np.sqrt(squared[0]) / (2.0 * np.pi), rel=1e-3)


def test_many_modes_take_the_dense_way(monkeypatch):
    """More than an eighth of all modes; the result is the same."""
    whole, squared = problem(2)
    asked = []
    dense = sparse_reduction._all_modes
    monkeypatch.setattr(sparse_reduction, "_all_modes", lambda given: asked.append(1) or dense(given))
    highest = float(np.sqrt(squared[200] * squared[202]))
    found = reduce_sparse(whole, float(np.sqrt(highest)) / (2.0 * np.pi))
    assert asked
    np.testing.assert_allclose(found.angular_frequency**2, squared[squared <= highest], rtol=1e-8)


@pytest.mark.parametrize("package", LIBRARIES)
def test_libraries_solve_as_superlu_does(package, monkeypatch):
    """The real library: one vector, several, and the modes of a body of steel."""
    if find_spec(package) is None:
        pytest.skip(f"{package} is not installed, so its factors are not tested")
    mass, stiffness, _ = chains(3)
    matrix = stiffness + 1e-3 * mass
    mesh = st.SolidMesh.block((0.05, 0.02, 0.03), (8, 4, 4))
    words = {"points": {"corner": (0.05, 0.02, 0.03)}, "fixed": ["left"], "cutoff": 60e3}
    steel = st.Material(2.1e11, 7800.0, 0.3)
    rights = [np.random.default_rng(1).standard_normal(shape) for shape in ((3 * SIZE,), (3 * SIZE, WIDTH))]
    found = {}
    for name in ("superlu", package):
        chosen = {name: LIBRARIES[name]} if name in LIBRARIES else {}
        monkeypatch.setattr(factorisation, "LIBRARIES", chosen)
        solve = factorised(matrix)
        body = st.SolidBody(mesh, steel, **words, name=name)
        found[name] = [solve(right) for right in rights], body.modes(), body.trace("corner")
    (known, modes, row), (same, others, moved) = found.values()
    for one, other in zip(known, same, strict=True):
        assert one.shape == other.shape
        # The condition of the matrix.
        np.testing.assert_allclose(other, one, atol=1e2 * EPS * 4.0 / 1e-3 * np.abs(one).max())
    assert modes.massless.sum() == others.massless.sum() > 0
    np.testing.assert_allclose(others.angular_frequency, modes.angular_frequency, rtol=1e-10)
    np.testing.assert_allclose(moved / others.stiffness @ moved.T, row / modes.stiffness @ row.T, rtol=1e-9)
