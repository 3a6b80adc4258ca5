"""Equilibria of blocks against every set of points tried by hand."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.analysis.stability import stability_of
from stridula.linear.complementarity import all_sets, searched

from .blocks import Block, random_block
from .sliding_systems import bar, rod
from .test_equilibrium_starts import starting


def different(block: Block) -> list:
    """Return the equilibria by hand that are in different places."""
    kept: list = []
    for one in block.equilibria():
        if not any(np.abs(one[1] - other[1]).max() <= 1e-6 * np.abs(one[1]).max() for other in kept):
            kept.append(one)
    return kept


def test_points_are_closed_again():
    """By hand 92.1, 188.2, 124.3 N, no point open; opening whichever pulls leaves one open 17 um below the belt."""
    rng = np.random.default_rng(11)
    count = int(rng.integers(3, 6))
    stiffness, along = 1e7 * 10 ** rng.uniform(-1, 1, count), np.sort(rng.uniform(-0.1, 0.1, count))
    height, friction = rng.uniform(0.02, 0.3), rng.uniform(0.1, 0.8)
    gap = rng.uniform(0, 2e-5, count) * (rng.random(count) < 0.5)
    load, at = rng.uniform(50, 500), rng.uniform(-0.05, 0.05)
    one, zero = np.ones(count), np.zeros(count)
    block = Block(
        np.diag([1.0, 1.0, 0.01]),
        np.diag([1e5, 0.0, 0.0]),
        np.array([zero, one, along]).T,
        np.array([one, zero, height * one]).T,
        np.zeros((count, 3)),
        gap,
        friction,
        1.0,
        [(k, 1.0) for k in stiffness],
        np.array([0.0, -load, -load * at]),
    )
    found = st.sliding_stability(block.system())
    np.testing.assert_allclose(found.normal_force, [92.10372167, 188.19732436, 124.31677151], rtol=1e-8)
    assert (found.status == "sliding").all()
    assert (found.attrs["equilibrium"], found.attrs["equilibria"], found.attrs["violated"]) == ("sliding", "one", "")
    ((_, _, forces),) = different(block)
    np.testing.assert_allclose(found.normal_force, forces, rtol=1e-9)


@pytest.mark.parametrize("kind", ["linear", "power"])
@pytest.mark.parametrize("spatial", [False, True])
def test_every_unique_equilibrium_of_blocks_is_found(spatial, kind):
    """Forces and growth are those of the set found by hand."""
    unique = 0
    # One of the last has a set of points, found first, that friction cannot hold.
    for seed in [*range(25), *([100] if kind == "linear" else [])]:
        block = random_block(np.random.default_rng(seed), spatial, kind)
        by_hand, found = different(block), st.sliding_stability(block.system())
        if len(by_hand) != 1:
            continue
        unique += 1
        ((closed, _, forces),) = by_hand
        np.testing.assert_allclose(found.normal_force, forces, rtol=0.0, atol=1e-8 * np.abs(block.load).max())
        assert found.attrs["violated"] == ""
        growth = block.growth(closed, forces)
        assert float(found.growth_rate.max()) == pytest.approx(growth, rel=1e-6, abs=1e-3)
    assert unique > 8


@pytest.mark.parametrize("kind", ["linear", "rigid"])
def test_several_and_no_equilibria_are_said(kind):
    """On supports in all directions no motion is free, and every set counts."""
    words = {}
    for seed in range(60):
        block = random_block(np.random.default_rng(seed), False, kind)
        if not np.diag(block.stiffness).all():
            continue
        count = len(different(block))
        found = st.sliding_stability(block.system())
        words.setdefault(count, set()).add(found.attrs["equilibria"])
        if count == 0:
            assert found.attrs["equilibrium"] == "jammed"
            assert np.isnan(found.normal_force).all()
            assert not found.sizes["mode"]
    assert words[1] == {"one"}
    assert words[0] == {"none"}


@pytest.mark.parametrize(("spatial", "seed"), [(False, 91), (False, 158), (True, 124), (True, 174)])
def test_forces_that_do_not_fit_their_indentations_are_no_equilibrium(spatial, seed):
    """None of the sets of points with a power law balances, whichever is tried by hand."""
    block = random_block(np.random.default_rng(seed), spatial, "power")
    assert different(block) == []
    found = st.sliding_stability(block.system())
    assert (found.attrs["equilibrium"], found.attrs["equilibria"]) == ("jammed", "none")
    first = st.sliding_stability(block.system(), status=["sliding", *["separated"] * (len(block.gap) - 1)])
    assert first.attrs["violated"]


def test_a_start_in_one_of_several_equilibria_is_noted():
    noted = {}
    for seed in (41, 42):
        system = random_block(np.random.default_rng(seed), False, "linear").system()
        noted[st.sliding_stability(system).attrs["equilibria"]] = st.simulate(starting(system), 1e-4).attrs["notes"]
        assert stability_of(system)["equilibria"] in noted
    assert noted == {"several": "start: several equilibria exist", "one": ""}


def test_given_statuses_are_judged_with_friction():
    block = random_block(np.random.default_rng(3), False, "linear")
    found = st.sliding_stability(block.system())
    again = st.sliding_stability(block.system(), status=found.status.values.tolist())
    assert (again.attrs["equilibrium"], again.attrs["violated"]) == (found.attrs["equilibrium"], "")
    np.testing.assert_array_equal(again.normal_force, found.normal_force)
    wrong = np.where(found.status == "sliding", "separated", "sliding").tolist()
    assert st.sliding_stability(block.system(), status=wrong).attrs["violated"]


def test_a_search_of_sets_solves_random_complementarity_problems():
    """Matrices whose symmetric part is positive definite have a single solution, at any size."""
    rng = np.random.default_rng(5)
    for count in [*range(1, 9)] * 5 + [60]:
        root, skew = rng.normal(size=(2, count, count))
        matrix, free = root @ root.T + 0.1 * np.eye(count) + 2.0 * (skew - skew.T), rng.normal(size=count)

        def margins(closed, matrix=matrix, free=free):
            force = np.zeros(len(free))
            force[closed] = np.linalg.solve(matrix[np.ix_(closed, closed)], -free[closed])
            return np.where(closed, force, free + matrix @ force) + 1e-9

        found = searched(margins, np.ones(count, dtype=bool))
        assert found is not None
        assert (margins(found) >= 0.0).all()
        if count < 9:
            (only,) = all_sets(margins, count)
            np.testing.assert_array_equal(found, only)


def resting(stiffness: float | None, velocity: float = 0.0) -> st.System:
    """Return an elastic block of second order, pressed on a floor or on a belt."""
    steel = st.Material(2.1e11, 7800.0, 0.3)
    body = st.SolidBody.block((0.06, 0.03, 0.04), (2, 1, 2), steel, cutoff=30e3, contact_faces=["bottom"], name="block")
    face = st.SurfaceContact(
        body, "bottom", st.RigidTrack(velocity=velocity), friction=st.Coulomb(0.3), stiffness=stiffness, name="face"
    )
    top = body.face_points("top")
    shares = top.area / top.area.sum()
    loads = [
        st.Force(body.at(place), y=-21.0 * share)
        for place, share in zip(top.place.tolist(), shares.tolist(), strict=True)
    ]
    springs = [st.Spring(body.at(top.place[k].tolist()), stiffness=1e7, direction=way) for k in (0, -1) for way in "xz"]
    return st.System(face, loads, springs)


@pytest.mark.parametrize("stiffness", [1e12, None])
def test_a_face_at_rest_pulls_nowhere_along_the_floor(stiffness):
    """It is held where it rests without friction, along both tangents, under its Poisson strain too."""
    found = st.sliding_stability(resting(stiffness))
    assert (found.attrs["equilibrium"], found.attrs["violated"]) == ("held", "")
    assert float(found.normal_force.sum()) == pytest.approx(21.0)
    assert np.abs(found.tangential_force).max() < 1e-9


def test_a_rigid_face_is_the_limit_of_a_stiff_one():
    """Points of second-order elements hold the same motion twice; sums and modes do not depend on how they share it."""
    rigid, stiff = (st.sliding_stability(resting(one, 1.0)) for one in (None, 1e17))
    assert rigid.attrs["violated"] == ""
    assert (rigid.normal_force >= 0.0).all()
    assert float(rigid.normal_force.sum()) == pytest.approx(21.0)
    moved = [one.tip_displacement.sel(direction="x").values for one in (rigid, stiff)]
    np.testing.assert_allclose(moved[0], moved[1], rtol=1e-3)


@pytest.mark.parametrize(("push", "supported"), [(1.0, "pinned"), (300.0, "pinned"), (1.0, "free"), (300.0, "free")])
def test_rounding_of_gaps_follows_from_the_bending_of_which_they_are_sums(push, supported):
    """Two rods that bend a beam: the gaps of both are sums of displacements far larger than these gaps."""
    track = bar()
    drawn, other = rod(5.0, name="drawn"), rod(-5.0, name="other", root_support=supported)
    contacts = [
        st.PointContact(drawn.tip, track.at(0.05), friction=st.Coulomb(0.3)),
        st.PointContact(other.tip, track.at(0.21), friction=st.Coulomb(0.2)),
    ]
    if supported == "pinned":
        drives = [st.ImposedVelocity(drawn.root, 0.05, 2.0), st.Force(other.tip, y=-push)]
    else:
        drives = [st.Force(drawn.root, x=1.0, y=-2.0), st.Force(other.root, x=-1.0, y=-push)]
    found = st.sliding_stability(st.System(contacts, drives))
    assert (found.attrs["equilibria"], found.attrs["violated"]) == ("one", "")
