"""Friction that varies over a face, and random fields."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st

SIZE, PARTS = (0.06, 0.02, 0.03), (3, 1, 2)


def pressed(friction, velocity=0.1):
    """A block pressed on a belt by its back, with the face that touches it."""
    material = st.Material(young=1e9, density=2000.0, poisson=0.3)
    pad = st.SolidBody.block(SIZE, PARTS, material, cutoff=1e4, damping=0.2, contact_faces=["bottom"], name="pad")
    # Two sides, against the moment of uneven friction about the normal.
    held = [st.Spring(pad.at((0.0, 0.01, side)), stiffness=1e6, direction=way) for side in (0.0, 0.03) for way in "xz"]
    face = st.SurfaceContact(pad, "bottom", st.RigidTrack(velocity=velocity), stiffness=2e11, name="lining")
    laws = friction(face)
    face = replace(face, friction=laws)
    return face, st.System([face], [st.Force(pad.at("top"), y=-500.0), st.InitialEquilibrium()], held)


def varied(face):
    factors = st.random_field(face.places, 0.02, 0.08, mean=0.4, seed=3)
    return [st.Coulomb(float(factor)) for factor in factors]


def test_each_point_slides_under_its_own_coefficient():
    """In linear theory, and in a run, where points slide on."""
    face, system = pressed(varied)
    coefficients = np.array([law.coefficient for law in face.friction])
    assert np.ptp(coefficients) > 0.1
    found = st.sliding_stability(system)
    assert set(found["status"].values.tolist()) == {"sliding"}
    pulls, presses = np.linalg.norm(found["tangential_force"], axis=1), found["normal_force"].values
    np.testing.assert_allclose(pulls, coefficients * presses, rtol=1e-9)
    run = st.simulate(system, 1e-3, surface_rate="all")
    pulls, presses = np.linalg.norm(run["tangential_force"].values, axis=-1), run["normal_force"].values
    np.testing.assert_allclose(pulls, coefficients * presses, atol=1e-6 * presses.max())
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(again["normal_force"], run["normal_force"])


def test_equal_laws_are_one_law():
    face, many = pressed(lambda face: [st.Coulomb(0.3)] * face.areas.size)
    _, one = pressed(lambda face: st.Coulomb(0.3))
    assert face.contacts[0].friction == st.Coulomb(0.3)
    runs = [st.simulate(system, 5e-4) for system in (many, one)]
    np.testing.assert_array_equal(runs[0]["tangential_force"], runs[1]["tangential_force"])


def test_a_wrong_number_of_laws_is_named():
    face, _ = pressed(lambda face: st.Coulomb(0.3))
    count = face.areas.size
    with pytest.raises(
        ValueError, match=rf"^friction must be one law, or have {count}, one for each point, got 2 laws"
    ):
        replace(face, friction=[st.Coulomb(0.3), st.Coulomb(0.4)])


def test_a_random_field_has_its_deviation_and_correlation():
    """Over many seeds, within the scatter of their number."""
    places = np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.02, 0.0], [1.0, 1.0, 1.0]])
    fields = np.array([st.random_field(places, 0.02, 0.1, mean=0.4, seed=seed) for seed in range(4000)])
    np.testing.assert_allclose(fields.mean(axis=0), 0.4, atol=0.007)
    np.testing.assert_allclose(fields.std(axis=0), 0.1, rtol=0.05)
    np.testing.assert_allclose(np.corrcoef(fields.T)[0], [1.0, np.exp(-0.25), np.exp(-1.0), 0.0], atol=0.06)
    np.testing.assert_array_equal(fields[7], st.random_field(places, 0.02, 0.1, mean=0.4, seed=7))
    np.testing.assert_array_equal(st.random_field(places, 0.02, 0.0, mean=0.4), 0.4)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (([1.0, 2.0], 0.1, 0.1), "^places must be a table of places"),
        (([[0.0, np.nan]], 0.1, 0.1), "^places must be a table of places"),
        (([[0.0, 1.0]], 0.0, 0.1), "^correlation_length must be above 0"),
        (([[0.0, 1.0]], 0.1, -0.1), "^deviation must be 0 or above"),
    ],
)
def test_bad_arguments_of_a_random_field(arguments, words):
    with pytest.raises(ValueError, match=words):
        st.random_field(*arguments)
