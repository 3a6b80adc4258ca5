"""Sliding stability against an independent formula, solvers against each other, equilibria, bad arguments."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import stridula as st
from stridula.analysis import stability
from stridula.linear.equilibrium import find_equilibrium
from stridula.linear.structure import Structure
from stridula.linear.vibration import vibration

STEEL, SQUARE = st.Material(2.1e11, 7800.0), st.Rectangle(0.01, 0.01)
LURE = st.LuGre(0.6, 0.3, 0.01, 1e5, 10.0, 0.1)


def rod(degrees: float = 45.0, **words) -> st.FiniteElementBeam:
    return st.FiniteElementBeam(STEEL, SQUARE, 0.15, angle=radians(degrees), **{"elements": 6} | words)


def bar(**words) -> st.ModalBeam:
    return st.ModalBeam(STEEL, SQUARE, 0.4, **{"bending_modes": 10, "axial_modes": 5} | words)


def pair(drives, friction=0.5, slider=None, track=None, **words) -> st.System:
    slider, track = slider or rod(), track or bar()
    law = st.Coulomb(friction) if isinstance(friction, float) else friction
    at = 0.17 if isinstance(track, st.ModalBeam) else 0.0
    return st.System(st.PointContact(slider.tip, track, at=at, friction=law, **words), drives=drives(slider))


def dragged(velocity: float = 0.01, load: float = 1.0, history=None):
    return lambda slider: [st.ImposedVelocity(slider.root, velocity, load, history or st.Constant())]


def pushed(**force):
    return lambda slider: [st.Force(slider.root, **force)]


def matrices(seed: int, size: int, name: str, damping: bool = False) -> st.ReducedBody:
    random = np.random.default_rng(seed)
    half, lossy = random.standard_normal((2, size, size))
    points = {word: random.standard_normal((2, size)) for word in ("p", "q")}
    damping = 0.02 * lossy @ lossy.T if damping else 0.0
    mass = np.diag(random.uniform(1.0, 2.0, size))
    return st.ReducedBody(mass, half @ half.T + np.eye(size), points, damping=damping, name=name)


def exponents(found) -> np.ndarray:
    return found.growth_rate.values + 2j * pi * found.frequency.values


def assert_same(found, known, tolerance: float) -> None:
    """Both have the same exponents in any order; known ones with negative frequency are left out."""
    known = known[known.imag >= 0.0]
    assert found.size == known.size
    distance = np.abs(found[:, None] - known)
    rows, columns = scipy.optimize.linear_sum_assignment(distance)
    np.testing.assert_array_less(distance[rows, columns], tolerance)


def formula(stiffness, damping, gaps, slips, share) -> np.ndarray:
    """Exponents of (Y'Z, Y'DZ, Y'KZ) with Z = null(G), Y = null(G - s mu T), as a quadratic eigenproblem."""
    right = scipy.linalg.null_space(gaps)
    left = scipy.linalg.null_space(gaps - np.asarray(share)[:, None] * slips)
    inertia, braked, stiff = (left.T @ matrix @ right for matrix in (np.eye(len(stiffness)), damping, stiffness))
    if not damping.any():
        square = np.sqrt(-scipy.linalg.eigvals(stiff, inertia).astype(complex))
        return np.concatenate([square, -square])
    size, nothing = len(stiff), np.zeros_like(stiff)
    first = np.block([[nothing, np.eye(size)], [-stiff, -braked]])
    return scipy.linalg.eigvals(first, np.block([[np.eye(size), nothing], [nothing, inertia]]))


def two_bodies(seed: int, damping: bool = False, count: int = 1, friction: float = 0.4, sense: float = 1.0):
    """Random bodies in frozen contacts; system, modal stiffness and damping, rows of gaps and of slips."""
    bodies = matrices(seed, 7, "a", damping), matrices(seed + 100, 5, "b", damping)
    turns, points = (0.3, -1.1), ("p", "q")
    belt = [st.RigidTrack(velocity=-sense, name=f"belt {k}") for k in range(count)]
    contacts = [
        st.PointContact(bodies[k].at(points[k]), belt[k], friction=st.Coulomb(friction), inclination=turns[k])
        for k in range(count)
    ]
    link = st.Spring(bodies[0].at("q"), bodies[1].at("q"), stiffness=3.0, direction="y")
    system = st.System(contacts, connections=[link])
    squared = [body.modes().angular_frequency ** 2 for body in bodies]
    stiffness = np.diag(np.concatenate(squared))
    row = np.concatenate([bodies[0].trace("q")[1], -bodies[1].trace("q")[1]])
    stiffness += 3.0 * np.outer(row, row)
    losses = [
        body.shapes.T @ body.damping @ body.shapes if damping else np.zeros((size, size))
        for body, size in zip(bodies, (7, 5), strict=True)
    ]
    wide = [np.hstack([bodies[0].trace("p"), np.zeros((2, 5))]), np.hstack([np.zeros((2, 7)), bodies[1].trace("q")])]
    gaps = np.array([[-np.sin(turns[k]), np.cos(turns[k])] @ wide[k] for k in range(count)])
    slips = np.array([[np.cos(turns[k]), np.sin(turns[k])] @ wide[k] for k in range(count)])
    return system, stiffness, scipy.linalg.block_diag(*losses), gaps, slips


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("damping", [False, True])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_exponents_are_those_of_the_formula(seed, damping, count, sense):
    system, *known = two_bodies(seed, damping, count, sense=sense)
    found = exponents(st.sliding_stability(system, status=["sliding"] * count))
    assert_same(found, formula(*known, [0.4 * sense] * count), 1e-7)


@pytest.mark.parametrize("share", [-0.4, 0.2, 0.0])
def test_the_formula_distinguishes_another_friction(share):
    """Negative control: the wrong sense, half the friction or none gives other numbers."""
    system, *known = two_bodies(1)
    found = exponents(st.sliding_stability(system, status="sliding"))
    wrong = formula(*known, [share])
    assert max(np.abs(found - one).min() for one in wrong[wrong.imag > 0]) > 1e-3


def test_beams_without_load_are_those_of_the_formula():
    slider, track = rod(-45.0), bar()
    found = st.sliding_stability(pair(dragged(load=0.0), 0.8, slider, track))
    modes = [slider.modes(True), track.modes()]
    tip, beam = slider.trace(0.0, True), track.trace(0.17)
    gap, slip = np.hstack([tip[1], -beam[1]])[None], np.hstack([tip[0], -beam[0]])[None]
    stiffness = np.diag(np.concatenate([one.angular_frequency for one in modes]) ** 2)
    known = formula(stiffness, 0.0 * stiffness, gap, slip, [0.8])
    assert_same(exponents(found), known, 1e-8 * np.abs(known).max())
    assert float(found.growth_rate.max()) > 100.0


def test_undamped_exponents_come_as_plus_and_minus():
    found = exponents(st.sliding_stability(pair(dragged(load=0.0), 1.2, rod(-45.0))))
    growing = found[found.real > 1.0]
    assert growing.size > 1
    for one in growing:
        assert np.abs(found + one.conj()).min() < 1e-6 * abs(one)


def loaded(load: float):
    """Exponents of a dragged pair from numerical derivatives of its forces, evaluated at the shifted contact point."""
    slider, track, friction = rod(-30.0, elements=2), bar(bending_modes=4, axial_modes=2), 0.4
    system = pair(dragged(load=load), friction, slider, track)
    found = st.sliding_stability(system)
    shape = Structure(system)
    tip = slider.trace(0.0, True)
    size = tip.shape[1]
    squared = np.concatenate([slider.modes(True).angular_frequency, track.modes().angular_frequency]) ** 2
    drive = np.concatenate([-load * slider.trace(slider.length, True)[1], np.zeros(track.modes().count)])
    np.testing.assert_allclose(shape.load, drive, atol=1e-12)

    def rows(q, rest):
        beam = track.trace(0.17 + tip[0] @ (q - rest)[:size])
        return np.concatenate([tip[1], -beam[1]]), np.concatenate([tip[0], -beam[0]])

    def residual(unknown, rest):
        q, normal = unknown[:-1], unknown[-1]
        gap, slip = rows(q, rest)
        return np.append(squared * q - drive - normal * (gap - friction * slip), gap @ q)

    gap, slip = rows(np.zeros(squared.size), np.zeros(squared.size))
    static = np.block([[np.diag(squared), -(gap - friction * slip)[:, None]], [gap, 0.0]])
    rest = np.linalg.solve(static, np.append(drive, 0.0))
    jacobian = np.empty_like(static)
    for k in range(rest.size):
        step = np.zeros(rest.size)
        step[k] = 1e-6
        both = [residual(rest + sign * step, rest[:-1]) for sign in (1.0, -1.0)]
        jacobian[:, k] = (both[0] - both[1]) / 2e-6
    motion = vibration(shape, find_equilibrium(shape, np.zeros(1)))
    np.testing.assert_allclose(motion.held[0], jacobian[-1, :-1], rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(motion.pushes[0], -jacobian[:-1, -1], rtol=1e-6, atol=1e-6)
    # A bent or stretched track has the terms of the load alone.
    for rows_of_track in (slice(size, size + 4), slice(size + 4, size + 6)):
        known = jacobian[rows_of_track, :size]
        np.testing.assert_allclose(motion.stiffness[rows_of_track, :size], known, atol=1e-3 * np.abs(known).max())
    inertia = np.diag(np.append(np.ones(squared.size), 0.0))
    # Scaled to frequencies of order one: K x = -s² M x.
    high = squared.max()
    over = scipy.linalg.eigvals(inertia, jacobian)
    square = -1.0 / over[np.abs(over) > 1e-3 / high]
    known = np.sqrt(square.astype(complex))
    return found, np.concatenate([known, -known])


def test_a_load_adds_the_effect_of_the_bent_track():
    found, known = loaded(2e4)
    assert_same(exponents(found), known, 1e-5 * np.abs(known).max())
    slider, track = rod(-30.0, elements=2), bar(bending_modes=4, axial_modes=2)
    bare = st.sliding_stability(pair(dragged(load=0.0), 0.4, slider, track))
    assert np.abs(exponents(found) - exponents(bare)).max() > 1e-3 * np.abs(known).max()


@pytest.mark.parametrize("near", [0.0, 900.0, 20000.0])
@pytest.mark.parametrize(
    "system",
    [
        pair(pushed(axial=-1e-3), 0.8, rod(elements=12, damping=1e-3), bar(damping=1e-3)),
        pair(dragged(), 0.8, rod(-45.0, elements=12, damping=1e-3), bar(damping=1e-3)),
        pair(dragged(), LURE, rod(-45.0, elements=12, damping=1e-3), bar(damping=1e-3)),
        two_bodies(5, damping=True)[0],
    ],
    ids=["pushed", "dragged", "with a state", "coupled"],
)
def test_exponents_near_a_frequency_are_those_of_the_dense_solver(system, near):
    few = exponents(st.sliding_stability(system, status="sliding", modes=2, near=near))
    every = exponents(st.sliding_stability(system, status="sliding"))
    nearest = every[np.argsort(np.abs(every - 2j * pi * near))[:2]]
    assert_same(few, nearest, 1e-9 * max(np.abs(every).max(), 2 * pi * near))


def test_a_large_body_is_solved_about_its_lowest_modes():
    """700 masses in a chain; the lowest twelve are those of the formula."""
    size = 700
    chain = (2.0 * np.eye(size) - np.eye(size, k=1) - np.eye(size, k=-1)) * 1e4 + np.eye(size) * 10.0
    points = {"tip": np.eye(size)[[3, 300]]}
    body = st.ReducedBody(np.eye(size), chain, points)
    belt = st.RigidTrack(velocity=-1.0)
    system = st.System(st.PointContact(body.at("tip"), belt, friction=st.Coulomb(0.7)))
    found = exponents(st.sliding_stability(system, status="sliding", modes=12))
    assert found.size == 12
    # y is held by the floor, the rest moves; friction on x by the force that holds y.
    kept = np.delete(np.arange(size), 300)
    stiffness = chain[np.ix_(kept, kept)].copy()
    stiffness[3] += 0.7 * chain[300, kept]
    known = np.sort(np.sqrt(np.linalg.eigvals(stiffness).astype(complex)).real)[: found.size]
    np.testing.assert_allclose(np.sort(found.imag), known, rtol=1e-7)


def test_record():
    """Names, units, shares of energy and shapes; shapes obey the constraints of contacts."""
    slider, track = rod(-45.0), bar()
    found = st.sliding_stability(pair(dragged(), 0.8, slider, track))
    assert found.attrs["equilibrium"] == "sliding"
    np.testing.assert_allclose(found.energy_share.sum("body"), 1.0)
    assert list(found.body.values) == ["slider", "track"]
    assert np.all(np.diff(found.frequency) >= -1e-6)
    shape = found.mode_shape.sel(part="real").values + 1j * found.mode_shape.sel(part="imaginary").values
    np.testing.assert_allclose(np.linalg.norm(shape, axis=1), 1.0)
    gap = np.concatenate([slider.trace(0.0, True)[1], -track.trace(0.17)[1]])
    # Up to the slope of the track under 1 N.
    assert np.abs(shape @ gap).max() < 1e-2 * np.linalg.norm(gap)
    assert all("units" in found[name].attrs for name in found.data_vars)
    np.testing.assert_array_equal(found.unstable, found.growth_rate > 1e-3)
    assert str(found.status.values) == "sliding"
    assert (float(found.slip_velocity), float(found.tangential_force)) == pytest.approx((0.01, 0.8))


def test_a_law_without_load_still_has_a_shape_for_its_state():
    found = st.sliding_stability(pair(dragged(load=0.0), LURE))
    assert np.isfinite(found.mode_shape).all()


def test_measures_of_a_map():
    found = stability.stability_of(pair(dragged(), 0.8, rod(-45.0)))
    every = st.sliding_stability(pair(dragged(), 0.8, rod(-45.0)))
    fastest = int(np.argmax(every.growth_rate.values))
    assert found["growth_rate"] == pytest.approx(float(every.growth_rate[fastest]))
    assert found["flutter_frequency"] == pytest.approx(float(every.frequency[fastest]))
    assert found["unstable_modes"] == int(every.unstable.sum())
    assert found["equilibrium"] == "sliding"
    stable = stability.stability_of(pair(dragged(), 0.0, rod(damping=0.01), bar(damping=0.01)))
    assert np.isnan(stable["flutter_frequency"])
    assert stable["unstable_modes"] == 0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_ramp_that_has_ended_accelerates_nothing(sign):
    steady, ramped = (pair(dragged(0.01 * sign, history=one)) for one in (st.Constant(), st.Ramp(1e-3)))
    known, found = st.sliding_stability(steady), st.sliding_stability(ramped)
    np.testing.assert_array_equal(Structure(ramped).load, Structure(steady).load)
    np.testing.assert_allclose(exponents(found), exponents(known))
    assert float(found.slip_velocity) == pytest.approx(0.01 * sign)
    assert float(st.sliding_stability(ramped, time=5e-4).slip_velocity) == pytest.approx(0.005 * sign)


@pytest.mark.parametrize("lean", [0.3, -0.4])
def test_slip_on_an_inclined_track_follows_it(lean):
    """A root that is free along y follows the slope: the tip slips at v / cos, not v cos."""
    found = st.sliding_stability(pair(dragged(), 0.1, track=st.RigidTrack(velocity=0.2), inclination=lean))
    assert float(found.slip_velocity) == pytest.approx(0.01 / np.cos(lean) - 0.2)


@pytest.mark.parametrize("stiffness", [1e-9, 1e-3, 1e6, 1e15])
def test_a_spring_is_no_free_motion_however_soft(stiffness):
    slider, track = rod(damping=0.01), st.RigidTrack(velocity=-1.0)
    contact = st.PointContact(slider.tip, track, friction=st.Coulomb(0.1))
    hold = st.Spring(slider.root, stiffness=stiffness)
    found = st.sliding_stability(st.System(contact, drives=[st.Force(slider.root, y=-1.0)], connections=[hold]))
    assert float(found.slip_acceleration) == 0.0
    if stiffness < 1.0:
        assert float(found.frequency[0]) == pytest.approx(np.sqrt(stiffness / slider.total_mass) / (2 * pi), rel=1e-2)


def block(feet: int = 2) -> st.ReducedBody:
    """A rigid block of 1 kg on feet, its centre 0.5 m above ground."""
    places = np.linspace(-1.0, 1.0, feet)
    points = {f"foot {k}": np.array([[1.0, 0.0, 0.5], [0.0, 1.0, place]]) for k, place in enumerate(places)}
    return st.ReducedBody(
        np.diag([1.0, 1.0, 0.3]), np.zeros((3, 3)), points | {"centre": (0, 1)}, translation=np.eye(3)[:2]
    )


def on_feet(push: float, belt: float = 0.0, feet: int = 2, friction: float = 0.3) -> st.System:
    body = block(feet)
    contacts = [
        st.PointContact(
            body.at(f"foot {k}"), st.RigidTrack(velocity=belt, name=f"floor {k}"), friction=st.Coulomb(friction)
        )
        for k in range(feet)
    ]
    return st.System(contacts, drives=[st.Gravity(10.0), st.Force(body.at("centre"), x=push)])


@pytest.mark.parametrize(("push", "kind", "rate"), [(0.0, "held", 0.0), (2.9, "held", 0.0), (3.1, "sliding", 0.1)])
def test_a_block_on_two_feet(push, kind, rate):
    """It slides above mu m g = 3 N; the feet share its weight under the moment of the push 0.5 m above ground."""
    found = st.sliding_stability(on_feet(push))
    assert found.attrs["equilibrium"] == kind
    np.testing.assert_allclose(found.slip_acceleration, rate, atol=1e-12)
    drag = min(push, 3.0)
    np.testing.assert_allclose(found.normal_force, [5.0 - drag / 4.0, 5.0 + drag / 4.0])
    assert float(found.tangential_force.sum()) == pytest.approx(drag)


@pytest.mark.parametrize(("push", "kind", "rate"), [(0.0, "held", 0.0), (2.0, "held", 0.0), (3.5, "sliding", 0.5)])
def test_a_rigid_block_on_three_feet(push, kind, rate):
    """The feet hold the same motion twice; sum and moment of their forces are as on two feet."""
    found = st.sliding_stability(on_feet(push, feet=3))
    assert found.attrs["equilibrium"] == kind
    np.testing.assert_allclose(found.slip_acceleration, rate, atol=1e-9)
    assert (found.normal_force >= 0.0).all()
    assert float(found.normal_force.sum()) == pytest.approx(10.0)
    assert float(found.normal_force[2] - found.normal_force[0]) == pytest.approx(0.5 * min(push, 3.0))
    assert float(found.tangential_force.sum()) == pytest.approx(min(push, 3.0))


def test_a_block_rides_on_a_belt():
    found = st.sliding_stability(on_feet(0.0, belt=1.0))
    assert found.attrs["equilibrium"] == "held"
    np.testing.assert_array_equal(found.slip_velocity, 0.0)


def test_one_of_two_lifts_off_and_one_is_held():
    bodies = [rod(30.0, name=name) for name in "ab"]
    track = bar()
    contacts = [
        st.PointContact(body.tip, track, at=at, friction=st.Coulomb(0.4))
        for body, at in zip(bodies, (0.1, 0.3), strict=True)
    ]

    def verdict(x, y):
        drives = [st.Force(bodies[0].root, x=1.0, y=-1.0), st.Force(bodies[1].root, x=x, y=y)]
        found = st.sliding_stability(st.System(contacts, drives=drives))
        return found.attrs["equilibrium"], tuple(found.status.values)

    assert verdict(-1.0, -1.0) == ("sliding", ("sliding", "sliding"))
    assert verdict(-0.3, -1.0) == ("held", ("sliding", "sticking"))
    assert verdict(0.0, 1.0) == ("lifted off", ("sliding", "separated"))


def test_an_open_contact_has_no_slip_velocity():
    slider = rod(root_support="pinned")
    lifted = pair(lambda rod: [st.Force(rod.tip, y=5.0)], 0.3, slider, st.RigidTrack(velocity=0.5))
    found = st.sliding_stability(lifted)
    assert found.attrs["equilibrium"] == "lifted off"
    assert float(found.slip_velocity) == 0.0


@pytest.mark.parametrize(("friction", "kind"), [(1.2, "sliding"), (1.8, "jammed")])
def test_impulses_jam_though_forces_balance(friction, kind):
    """The root is free along y, so that N = load at any friction; but the end of an element jams from 5/3 on at 45°."""
    found = st.sliding_stability(pair(dragged(), friction, rod(-45.0, elements=1), st.RigidTrack()))
    assert found.attrs["equilibrium"] == kind
    assert float(found.normal_force) == pytest.approx(1.0)
    assert (found.sizes["mode"] == 0) == (kind == "jammed")


def test_a_ground_without_friction_holds_nothing():
    found = st.sliding_stability(pair(pushed(y=-1.0), 0.0))
    assert found.attrs["equilibrium"] == "sliding"
    assert st.sliding_stability(pair(pushed(y=-1.0), 0.1)).attrs["equilibrium"] == "held"


def test_a_held_contact_sticks_where_it_would_come_to_rest():
    """Hinged at its root and pressed on a floor 1 mm below, a rod is not held at the initial place of its tip."""
    slider = rod(root_support="pinned")
    found = st.sliding_stability(
        pair(lambda rod: [st.Force(rod.at(0.01), y=-10.0)], 0.3, slider, st.RigidTrack(), gap=1e-3)
    )
    assert found.attrs["equilibrium"] == "held"
    assert float(found.normal_force) == pytest.approx(10.0 * 0.14 / 0.15)
    assert float(found.tangential_force) == pytest.approx(0.0, abs=1e-9)


def test_masses_without_a_spring_have_exponents_zero():
    masses = [st.PointMass(1.0, name=name) for name in "abc"]
    contacts = [st.PointContact(masses[k].centre, masses[k + 1].centre, friction=st.Coulomb(0.3)) for k in (0, 1)]
    system = st.System(contacts, drives=[st.Force(masses[0].centre, x=1.0, y=-1.0)])
    assert exponents(st.sliding_stability(system, modes=1)) == pytest.approx([0.0])


def no_steady_state():
    slider = rod()
    return st.System(
        st.PointContact(slider.tip, st.RigidTrack(), friction=st.Coulomb(0.1)),
        drives=[st.Force(slider.root, x=1.0, y=-1.0)],
        connections=[st.Dashpot(slider.root, coefficient=1.0)],
    )


def twice():
    slider = rod()
    floors = [st.RigidTrack(velocity=1.0, name=name) for name in "uv"]
    return st.System(
        [
            st.PointContact(slider.tip, floor, friction=st.Coulomb(friction))
            for floor, friction in zip(floors, (0.1, 0.5), strict=True)
        ]
    )


def unmoved():
    body = st.ReducedBody(np.eye(2), np.eye(2), {"tip": (0, None)})
    return st.System(st.PointContact(body.at("tip"), st.RigidTrack()))


@pytest.mark.parametrize(
    ("system", "words", "message"),
    [
        (lambda: None, {}, "system must be a System"),
        (pair(dragged()), {"status": "stuck"}, "status must be one of separated, sticking, sliding"),
        (pair(dragged()), {"status": ["sliding", "sliding"]}, "status must have one value for each contact, 1 in all"),
        (pair(dragged()), {"status": 2}, "status must be one"),
        (pair(dragged()), {"status": [2]}, r"status\[0\] must be one of"),
        (pair(dragged(), LURE), {"status": "sticking"}, "status must be sliding or separated under lugre"),
        (pair(pushed(y=-1.0)), {"velocity": 0.0}, "velocity must not be 0"),
        (pair(dragged()), {"velocity": 0.1}, "velocity must be left out: drives and tracks prescribe the slip"),
        (pair(pushed(y=-1.0)), {"velocity": [0.1, 0.2]}, "velocity must have one value for each contact, 1 in all"),
        (pair(dragged()), {"velocity": [0.1]}, r"velocity\[0\] must be 0: drives and tracks prescribe the slip"),
        (
            pair(pushed(y=-1.0)),
            {"velocity": [0.1], "status": "sticking"},
            r"velocity\[0\] must be 0: a contact that does not slide has none",
        ),
        (pair(dragged()), {"time": -1.0}, "time must be 0 or above"),
        (pair(dragged()), {"modes": 0}, "modes must be at least 1"),
        (pair(dragged()), {"modes": 2.5}, "modes must be a whole number"),
        (pair(dragged()), {"near": -1.0}, "near must be 0 or above"),
        (pair(pushed(transverse=1.0), LURE), {}, "velocity must be given for contact 1: its lugre friction"),
        (pair(dragged(history=st.Harmonic(10.0))), {}, r"time must be given for drives\[0\]"),
        (
            pair(pushed(y=-1.0), track=st.RigidTrack(normal_velocity=0.1, normal_history=st.Harmonic(9.0))),
            {},
            "time must be given for the track of contact 1",
        ),
        (
            pair(dragged(), track=st.RigidTrack(), inclination=-pi / 2),
            {},
            "time must be given: no body can follow the motion along the normal of contact 1",
        ),
        (no_steady_state, {}, "connections must not brake a rigid motion"),
        (twice, {}, "contacts must not hold the same motion twice"),
        (unmoved, {}, "contact must be between points that move"),
    ],
)
def test_bad_arguments(system, words, message):
    with pytest.raises(ValueError, match=message) as caught:
        st.sliding_stability(system() if callable(system) else system, **words)
    assert "\n" not in str(caught.value)
