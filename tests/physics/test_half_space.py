"""The surface of an elastic half-space: against the solutions of point loads, and in contact."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

RUBBER = st.Material(5e6, 1000.0, 0.3)
SHEAR = RUBBER.young / (2 * (1 + RUBBER.poisson))
SIDE = 1e-3


def grid(count):
    """Middles of squares about the origin, in the plane of x and z."""
    line = SIDE * (np.arange(count) - (count - 1) / 2)
    return np.stack(np.meshgrid(line, 0.0, line, indexing="ij"), axis=-1).reshape(-1, 3)


def yields(body, moved, pushed, force):
    """Displacement of one point under a force on another."""
    return body.trace(moved) @ body.trace(pushed).T @ np.asarray(force, dtype=float)


def test_far_from_a_square_it_yields_as_under_a_point_load():
    """Boussinesq and Cerruti (Johnson 1985, 3.17 and 3.67 on); a square is one to second order of its side."""
    place = SIDE * np.array([30.0, 0.0, -40.0])
    body = st.ModalBody.half_space(RUBBER, [[0, 0, 0], place], SIDE)
    (x, _, z), r, nu = place, 50 * SIDE, RUBBER.poisson
    unit, beside = 1 / (2 * np.pi * SHEAR), (1 - 2 * nu) / (4 * np.pi * SHEAR)
    shear = unit * np.array([(1 - nu) / r + nu * x**2 / r**3, 0.0, nu * x * z / r**3])
    shear[1] = -beside * x / r**2
    normal = np.array([beside * x / r**2, unit * (1 - nu) / r, beside * z / r**2])
    size = unit / r
    np.testing.assert_allclose(yields(body, "2", "1", (1, 0, 0)), shear, atol=2e-4 * size)
    np.testing.assert_allclose(yields(body, "2", "1", (0, 1, 0)), normal, atol=2e-4 * size)


def test_a_circle_of_pressure_sinks_by_twice_the_pressure_times_the_radius_over_the_modulus():
    """In the middle of a uniform pressure over a circle ``2 (1 - nu²) p a / E``; squares make its edge a staircase."""
    places = grid(41)
    places = places[np.linalg.norm(places, axis=1) < 20 * SIDE]
    body = st.ModalBody.half_space(RUBBER, places, SIDE)
    radius = np.sqrt(len(places) * SIDE**2 / np.pi)
    middle = str(int(np.linalg.norm(places, axis=1).argmin()) + 1)
    sunk = sum(yields(body, middle, name, (0, -(SIDE**2), 0)) for name in body.point_names)
    assert sunk[1] == pytest.approx(-2 * (1 - RUBBER.poisson**2) * radius / RUBBER.young, rel=1e-3)
    np.testing.assert_allclose(sunk[[0, 2]], 0.0, atol=1e-9 * abs(sunk[1]))


def test_the_displacement_does_not_depend_on_the_orientation():
    """Turned as a whole: a wall that faces -x with sides at 30 degrees, beside a floor."""
    floor = st.ModalBody.half_space(RUBBER, grid(3), SIDE)
    out, along = np.array([-1.0, 0.0, 0.0]), np.array([0.0, np.cos(np.pi / 6), 0.5])
    turn = np.stack([along, out, np.cross(along, out)])
    wall = st.ModalBody.half_space(RUBBER, grid(3) @ turn, SIDE, normal=2 * out, along=along)
    force = np.array([1.0, 2.0, 3.0])
    for name in floor.point_names:
        np.testing.assert_allclose(
            yields(wall, name, "2", force @ turn), yields(floor, name, "2", force) @ turn, rtol=1e-9, atol=1e-12
        )


def dragged(block, tips, plane):
    """Press a bump on the squares of a plane and drag it; `tips` has the point of the block on each."""
    gaps = 0.02 * (grid(4) ** 2).sum(axis=1) / SIDE
    contacts = [
        st.PointContact(block.at(tips(name)), plane.at(name), friction=st.Coulomb(0.4), gap=gap, surface="face")
        for name, gap in zip(plane.point_names, gaps.tolist(), strict=True)
    ]
    point, history = block.at("middle"), st.Sampled([0.02, 0.04], [0.0, 1.0])
    drives = [st.Force(point, y=-1.0, history=st.Ramp(0.01)), st.Force(point, x=0.2, z=0.1, history=history)]
    run = st.simulate(st.System(contacts, drives), 0.06, step=1e-3, sample_rate=1e3, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    return run


def rigid(mass=1e-3):
    return st.ModalBody(np.zeros(3), {"middle": np.eye(3) / np.sqrt(mass)}, 2e3, name="block")


def test_two_equal_half_spaces_yield_as_one_of_half_the_modulus():
    """Pressed on each other, where both have the same tangential displacement under pressure."""
    soft = st.Material(RUBBER.young / 2, 1000.0, RUBBER.poisson)
    one = st.ModalBody.half_space(soft, grid(4), SIDE, coupled=False, name="plane")
    single = dragged(rigid(), lambda _: "middle", one)
    below = st.ModalBody.half_space(RUBBER, grid(4), SIDE, name="below")
    above = st.ModalBody.half_space(RUBBER, grid(4), SIDE, normal=(0, -1, 0))
    moved = rigid().trace("middle")
    shapes = {name: np.hstack([moved, above.trace(name)]) for name in above.point_names}
    shapes["middle"] = np.hstack([moved, np.zeros((3, above.residual))])
    carried = st.ModalBody(np.zeros(3), shapes, 2e3, residual=above.residual, name="block")
    double = dragged(carried, lambda name: name, below)
    assert int((single.normal_force[-1] > 0).sum()) > 4
    np.testing.assert_allclose(double.normal_force, single.normal_force, atol=1e-7)
    np.testing.assert_allclose(double.tangential_force, single.tangential_force, atol=1e-6)


def test_a_record_of_it_runs_again(tmp_path):
    plane = st.ModalBody.half_space(RUBBER, grid(4), SIDE, name="plane")
    run = dragged(rigid(), lambda _: "middle", plane)
    st.save(run, tmp_path / "run.nc")
    again = st.load_scenario(tmp_path / "run.nc").simulate()
    np.testing.assert_array_equal(again.tangential_force, run.tangential_force)
    assert run.normal_force.values[-1].sum() == pytest.approx(1.0, rel=1e-3)


BAD = {
    "overlap": ({"places": [[0, 0, 0], [0.5e-3, 0, 0.2e-3]]}, "places must be 0.001 m apart, the side of the squares"),
    "one twice": ({"places": [[0, 0, 0], [0, 1e-3, 0]]}, "places must be 0.001 m apart, the side of the squares"),
    "two numbers": ({"places": [[0, 0]]}, "places must be a list of places, three numbers each"),
    "none": ({"places": np.zeros((0, 3))}, "places must be a list of places"),
    "side": ({"side": 0.0}, "side must be"),
    "normal": ({"normal": (0, 0, 0)}, "normal must be three numbers, not all zero"),
    "askew": ({"along": (1, 1, 0)}, "along must be at right angles to the normal"),
    "material": ({"material": 1.0}, "material must be"),
    "coupled": ({"coupled": 1}, "coupled must be"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_are_refused(name):
    given, words = BAD[name]
    known = {"material": RUBBER, "places": grid(2), "side": SIDE} | given
    with pytest.raises(st.ArgumentError, match=words):
        st.ModalBody.half_space(**known)
