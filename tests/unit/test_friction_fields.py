"""Friction that varies over a face at random, in Python and in scenarios."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st

SPEEDS = [0.0, 0.1, 1.0]
PAD = st.SolidBody.block(
    (0.04, 0.01, 0.03), (2, 1, 2), st.Material(5e9, 2500.0, 0.3), cutoff=2e4, damping=0.02, contact_faces=["bottom"]
)
FIELD = st.FrictionField(deviation=0.1, correlation_length=0.015, seed=3)


def face(friction, field=FIELD, **more):
    belt = st.RigidTrack(velocity=1.0)
    return st.SurfaceContact(PAD, "bottom", belt, friction=friction, stiffness=1e11, friction_field=field, **more)


@pytest.mark.parametrize(
    "law",
    [
        st.Coulomb(0.4),
        st.StaticKinetic(0.5, 0.3),
        st.Stribeck(0.5, 0.3, 0.1, viscous=0.02),
        st.ExponentialWeakening(0.5, 0.3, 0.1),
        st.TabulatedFriction(SPEEDS, [0.5, 0.4, 0.35], 0.6),
        st.FrictionOverTemperature([20.0, 200.0], [st.Coulomb(0.4), st.Coulomb(0.3)]),
    ],
    ids=lambda law: law.law,
)
def test_each_point_has_the_coefficients_of_the_law_times_those_of_the_field(law):
    heating = st.HeatedLayers(10.0, cooling=1.0) if law.depends_on_temperature else None
    varied = face(law, heating=heating)
    factors = st.random_field(varied.places, 0.015, 0.1, seed=3)
    assert 0.05 < factors.std() < 0.2
    for one, factor in zip(varied.contacts, factors, strict=True):
        own = one.friction
        assert type(own) is type(law)
        given, even = (own.laws[1], law.laws[1]) if hasattr(law, "laws") else (own, law)
        np.testing.assert_allclose(given.coefficient_at([0.05, 0.7]), factor * even.coefficient_at([0.05, 0.7]))
        assert given.holding == pytest.approx(factor * even.holding)


def test_a_field_is_the_list_of_its_laws():
    even = face(st.Coulomb(0.4), None)
    factors = st.random_field(even.places, 0.015, 0.1, seed=3)
    listed = replace(even, friction=[st.Coulomb(0.4 * factor) for factor in factors.tolist()])
    drives = [st.Force(PAD.at("top"), y=-200.0)]
    held = [st.Spring(PAD.at("top"), stiffness=1e6, direction=way) for way in "xz"]
    given = {"duration": 1e-3, "sample_rate": 20e3}
    found, known = (st.simulate(st.System([one], drives, held), **given) for one in (face(st.Coulomb(0.4)), listed))
    np.testing.assert_array_equal(found.tangential_force, known.tangential_force)
    # A list of laws has its own field.
    twice = replace(listed, friction_field=FIELD)
    expected = 0.4 * factors**2
    np.testing.assert_allclose([one.friction.coefficient for one in twice.contacts], expected)


def test_fields_have_their_mean_deviation_and_correlation():
    laws = [face(st.Coulomb(0.4), replace(FIELD, seed=seed)).contacts for seed in range(600)]
    drawn = np.array([[one.friction.coefficient for one in contacts] for contacts in laws]) / 0.4
    places = face(st.Coulomb(0.4)).places
    apart = np.linalg.norm(places[:, None] - places[None], axis=2)
    # Within four standard errors of 600 draws.
    np.testing.assert_allclose(drawn.mean(axis=0), 1.0, atol=4.0 * 0.1 / np.sqrt(600))
    np.testing.assert_allclose(drawn.std(axis=0), 0.1, rtol=4.0 / np.sqrt(1200))
    np.testing.assert_allclose(np.corrcoef(drawn.T), np.exp(-((apart / 0.015) ** 2)), atol=4.0 / np.sqrt(600))


@pytest.mark.parametrize(
    ("friction", "field", "words"),
    [
        (st.Coulomb(0.4), replace(FIELD, deviation=3.0), r"friction_field.deviation must leave friction above zero"),
        (st.LuGre(0.4, 0.3, 0.1, stiffness=1e4), FIELD, "friction must be a Coulomb, .* with a friction_field"),
        (st.Coulomb(0.4), 0.1, "friction_field must be a FrictionField"),
    ],
)
def test_what_cannot_vary_is_refused(friction, field, words):
    with pytest.raises(ValueError, match=words):
        face(friction, field)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"deviation": -0.1, "correlation_length": 0.01}, "deviation must be 0 or above"),
        ({"deviation": 0.1, "correlation_length": 0.0}, "correlation_length must be above 0"),
        ({"deviation": 0.1, "correlation_length": 0.01, "seed": 1.5}, "seed must be a whole number"),
    ],
)
def test_numbers_out_of_range_are_refused(given, words):
    with pytest.raises(ValueError, match=words):
        st.FrictionField(**given)


SCENARIO = """
[bodies.pad]
kind = "solid"
materials = { young = "5 GPa", density = 2500 }
cutoff = "20 kHz"
damping = "2 %"
contact_faces = ["bottom"]
[bodies.pad.mesh]
shape = "block"
lengths = ["40 mm", "10 mm", "30 mm"]
divisions = [2, 1, 2]
[[surfaces]]
name = "lining"
body = "pad"
face = "bottom"
friction = 0.4
friction_field = { deviation = "10 %", correlation_length = "15 mm", seed = 3 }
stiffness = "1e11 N/m3"
track = { kind = "rigid", velocity = "1 m/s" }
[[drives]]
kind = "force"
body = "pad"
point = "top"
y = "-200 N"
[[connections]]
kind = "spring"
first = { body = "pad", point = "top" }
stiffness = "1 kN/mm"
direction = "x"
[simulation]
duration = "1 ms"
sample_rate = "20 kHz"
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "pad.toml"
    path.write_text(SCENARIO)
    return path


def test_a_scenario_has_a_field_whose_seed_is_a_key(file):
    found = st.load_scenario(file).system.contacts
    factors = st.random_field(face(st.Coulomb(0.4)).places, 0.015, 0.1, seed=3)
    np.testing.assert_allclose([one.friction.coefficient for one in found], 0.4 * factors)
    other = st.load_scenario(file, {"friction_field.seed": 4}).system.contacts
    assert found[0].friction != other[0].friction
    run = st.load_scenario(file).simulate()
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(run.tangential_force, again.tangential_force)


def test_the_seed_is_a_random_parameter_of_a_scenario(file):
    from scipy.stats import randint

    found = st.mode_probability(file, {"friction_field.seed": randint(0, 1000)}, samples=3)
    assert len(set(found.growth_rate.values.tolist())) == 3


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("10 %", "-10 %"), "surfaces.0.friction_field.deviation must be"),
        (("10 %", "900 %"), "surfaces.0.friction_field.deviation must leave friction above zero"),
        (("seed = 3", "seeds = 3"), "surfaces.0.friction_field.seeds must be one of the known keys"),
    ],
)
def test_problems_of_a_field_name_their_key(file, change, words):
    file.write_text(SCENARIO.replace(*change))
    with pytest.raises(st.ScenarioError) as found:
        st.load_scenario(file)
    assert words in str(found.value)
