"""Heating of contacts and laws over the temperature: refusals, tables from files, scenarios."""

from __future__ import annotations

import re

import numpy as np
import pytest

import stridula as st
from stridula._kernels.layout.columns import LAYERS
from stridula.contact.heating import MOST_LAYERS
from stridula.plot import friction

COLD_AND_HOT = [st.Coulomb(0.5), st.Coulomb(0.3)]
FADING = st.FrictionOverTemperature([20.0, 220.0], COLD_AND_HOT)


def contact(**words):
    return st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(velocity=1.0), **words)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: st.HeatedLayers(0.0), "capacity must be above 0"),
        (lambda: st.HeatedLayers([1.0] * 9, [1.0] * 8), "capacity must have 1 to 8 layers, got 9"),
        (lambda: st.HeatedLayers([1.0, 1.0]), "conductance must have one entry fewer than capacity, 1, got 0"),
        (lambda: st.HeatedLayers(1.0, share=1.5), "share must be between 0 and 1, got 1.5"),
        (lambda: st.HeatedLayers(1.0, initial=[1.0, 2.0]), "initial must be one temperature, or 1, got 2"),
        (lambda: st.HeatedLayers(1.0, cooling=-1.0), "cooling must be 0 or above"),
        (lambda: slab(layers=1), "layers must be a whole number from 2 to 8, got 1"),
        (lambda: slab(thickness=0.0), "thickness must be above 0"),
        (lambda: st.TemperatureHistory([0.0], [20.0]), "time must have two values or more, got 1"),
        (lambda: st.TemperatureHistory([0.0, 1.0], [20.0]), "temperature must have as many values as time, 2, got 1"),
        (lambda: st.TemperatureHistory([1.0, 0.5], [20.0, 30.0]), "time"),
        (lambda: st.FrictionOverTemperature([20.0], COLD_AND_HOT[:1]), "temperature must have two values or more"),
        (lambda: st.FrictionOverTemperature([20.0, 10.0], COLD_AND_HOT), "temperature"),
        (lambda: st.FrictionOverTemperature([20.0, 30.0], COLD_AND_HOT[:1]), "laws must have as many laws as temperat"),
        (
            lambda: st.FrictionOverTemperature([20.0, 30.0], [st.Coulomb(0.5), st.StaticKinetic(0.5, 0.4)]),
            "laws[1] must be of the kind of the first, Coulomb, got StaticKinetic",
        ),
        (
            lambda: st.FrictionOverTemperature([20.0, 30.0], [st.Stribeck(0.5, 0.4, v) for v in (0.1, 0.2)]),
            "laws[1].velocity must be that of the first law, 0.1, got 0.2",
        ),
        (
            lambda: st.FrictionOverTemperature([20.0, 30.0], [st.LinearWeakening(0.5, 0.4, 0.1)] * 2),
            "laws[0] must be a Coulomb, StaticKinetic, Stribeck, ExponentialWeakening or TabulatedFriction",
        ),
        (lambda: st.FrictionOverTemperature([20.0, 30.0], 0.5), "laws must be a list of laws of friction"),
        (lambda: contact(friction=FADING), "heating must be given under friction that depends on the temperature"),
        (lambda: contact(friction=FADING, heating=0.5), "heating must be"),
        (lambda: FADING.coefficient_at(1.0), "temperature must be chosen before friction is evaluated"),
        (
            lambda: contact(
                friction=st.FrictionOverTemperature([20.0, 30.0], [st.StaticKinetic(0.5, 0.4)] * 2),
                heating=st.HeatedLayers(1.0),
                tangential_stiffness=1e5,
            ),
            "tangential_stiffness must be left out under friction that holds more at rest",
        ),
    ],
)
def test_arguments_out_of_range_are_named(make, words):
    with pytest.raises(ValueError, match="^" + re.escape(words)):
        make()


def slab(**changed):
    given = {"thickness": 0.01, "conductivity": 1.0, "density": 2000.0, "specific_heat": 1000.0}
    return st.HeatedLayers.slab(1e-3, **{**given, **changed})


def test_the_march_has_as_many_layers_as_the_description():
    assert MOST_LAYERS == LAYERS


def test_a_slab_has_its_capacity_and_conductance():
    layers = slab(layers=5, transfer=10.0, share=0.7)
    assert sum(layers.capacity) == pytest.approx(20.0)
    assert 1.0 / sum(1.0 / one for one in layers.conductance) == pytest.approx(0.1)
    assert layers.cooling == pytest.approx(0.01)
    assert layers.share == 0.7


def test_between_temperatures_the_coefficient_lies_on_a_line():
    assert float(FADING.at(70.0).coefficient_at(1.0)) == pytest.approx(0.45)
    assert float(FADING.at(-40.0).coefficient_at(1.0)) == 0.5
    assert float(FADING.at(900.0).coefficient_at(1.0)) == 0.3
    falling = st.FrictionOverTemperature([0.0, 100.0], [st.Stribeck(0.5, 0.3, 0.1), st.Stribeck(0.3, 0.2, 0.1)])
    middle, speeds = falling.at(25.0), np.linspace(0.0, 1.0, 11)
    expected = st.Stribeck(0.45, 0.275, 0.1)
    np.testing.assert_allclose(middle.coefficient_at(speeds), expected.coefficient_at(speeds))
    assert middle.linearised_at(0.1).slope == pytest.approx(expected.linearised_at(0.1).slope)
    assert middle.holding == pytest.approx(0.45)


@pytest.mark.parametrize("order", [1, -1])
def test_a_table_is_read_from_a_file(tmp_path, order):
    lines = [f"{speed},{mu},{temperature}" for temperature, row in ((20, (0.5, 0.4)), (300, (0.3, 0.25)))
             for speed, mu in zip((0, 1000), row, strict=True)]  # fmt: skip
    path = tmp_path / "lining.csv"
    path.write_text("speed,mu,T\n" + "\n".join(lines[::order]), encoding="utf-8")
    law = st.FrictionOverTemperature.read(path, ("speed", "mu", "T"), speed_unit=1e-3)
    assert law.temperature == (20.0, 300.0)
    assert law.laws[1] == st.TabulatedFriction([0.0, 1.0], [0.3, 0.25])
    path.write_text("0,0.5,20\n1,0.4,20\n0,0.3,300\n", encoding="utf-8")
    with pytest.raises(ValueError, match="must have each speed once at each temperature, got 3 lines for 2 speeds"):
        st.FrictionOverTemperature.read(path)
    with pytest.raises(ValueError, match="columns must be three"):
        st.FrictionOverTemperature.read(path, (0, 1))


def test_a_law_is_drawn_at_each_of_its_temperatures():
    figure = friction(FADING)
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()][:2] == ["20 degC", "220 degC"]


SCENARIO = """
[bodies.pad]
kind = "point mass"
mass = 1.0

[[contacts]]
tip = { body = "pad" }
track = { kind = "rigid", velocity = 2.0 }
FRICTION
heating = { kind = "layers", capacity = [20, 60], conductance = [8], cooling = 3, share = 0.6 }

[[connections]]
kind = "spring"
first = { body = "pad" }
stiffness = 400.0

[[drives]]
kind = "force"
body = "pad"
y = -50.0

[simulation]
duration = 0.05
"""
LAWS = """friction = { law = "over temperature", temperature = [20, 60], laws = [
    { law = "coulomb", coefficient = 0.5 }, { law = "coulomb", coefficient = 0.3 } ] }"""


def written(folder, friction, heating=None):
    path = folder / "fading.toml"
    text = SCENARIO.replace("FRICTION", friction)
    path.write_text(re.sub("(?m)^heating = .*$", heating, text) if heating else text, encoding="utf-8")
    return path


@pytest.mark.parametrize("heating", [None, 'heating = { kind = "history", time = [0, 0.1], temperature = [20, 60] }'])
def test_a_scenario_has_laws_over_the_temperature_and_runs_again_from_its_record(tmp_path, heating):
    run = st.load_scenario(written(tmp_path, LAWS, heating)).simulate()
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(run["temperature"], again["temperature"])
    assert float(run["temperature"][-1]) > 20.0


def test_a_scenario_reads_a_table_over_the_temperature_from_a_file(tmp_path):
    (tmp_path / "lining.csv").write_text("0,0.5,20\n1,0.4,20\n0,0.3,300\n1,0.2,300\n", encoding="utf-8")
    friction = 'friction = { law = "over temperature", file = "lining.csv" }'
    law = st.load_scenario(written(tmp_path, friction)).system.contacts[0].friction
    assert law.laws[0] == st.TabulatedFriction([0.0, 1.0], [0.5, 0.4])


@pytest.mark.parametrize(
    ("friction", "heating", "words"),
    [
        (LAWS.replace("0.3", "-1"), None, r"contacts.0.friction.laws.1.coefficient must be 0 or above"),
        (LAWS.replace("[20, 60]", "[20]"), None, r"contacts.0.friction.temperature must have two values or more"),
        (
            LAWS,
            'heating = { kind = "layers", capacity = [2, 3] }',
            r"contacts.0.heating.conductance must have one entry fewer than capacity, 1, got 0$",
        ),
        (LAWS, 'heating = { kind = "fire" }', "heating"),
        (LAWS, " ", r"contacts.0.heating must be given under friction that depends on the temperature"),
    ],
)
def test_a_scenario_with_a_fault_names_its_place(tmp_path, friction, heating, words):
    with pytest.raises(st.ScenarioError, match=words):
        _ = st.load_scenario(written(tmp_path, friction, heating)).system


def test_the_card_of_a_record_has_the_temperature(tmp_path):
    run = st.load_scenario(written(tmp_path, LAWS)).simulate()
    first, last = float(run["temperature"][0]), float(run["temperature"][-1])
    assert st.card(run).facts["temperature"] == f"{first:.4g} degC at the beginning, {last:.4g} degC at the end"
