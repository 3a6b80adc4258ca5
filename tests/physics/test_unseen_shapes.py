"""Residual shapes that nothing sees are left out of linear theory: exponents and forces stay, whatever is kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.linear import condensed as module
from stridula.linear.condensed import condensed
from stridula.linear.equilibrium import find_equilibrium
from stridula.linear.given import given_velocity
from stridula.linear.growth import Growths, growth_of
from stridula.linear.modes import exponents_alone
from stridula.linear.structure import Structure
from stridula.linear.vibration import vibration

from .test_condensed_shapes import LAWS, system

VELOCITY = [0.0, 0.0, 0.0, 0.4]


@pytest.fixture(autouse=True)
def any_size(monkeypatch):
    """Eliminate shapes of small systems as well."""
    monkeypatch.setattr(module, "FEWEST", 1)
    monkeypatch.setattr(module, "LARGEST_SHARE", 1.0)


def of_all_shapes(one: st.System, velocity=None):
    structure = Structure(one)
    at = find_equilibrium(structure, given_velocity(velocity, structure))
    return at, exponents_alone(structure, vibration(structure, at)), structure


def vibrating(values) -> np.ndarray:
    """Return the exponents of vibration in order: those of creep have wider rounding."""
    return np.sort_complex(values[values.imag > 1.0])


def assert_same(found, known, tolerance: float) -> None:
    assert found.shape == known.shape
    np.testing.assert_allclose(found, known, rtol=0.0, atol=tolerance * np.abs(known).max())


@pytest.mark.parametrize("law", LAWS, ids=str)
@pytest.mark.parametrize("stiffness", [None, 3e5])
@pytest.mark.parametrize("axes", [2, 3])
@pytest.mark.parametrize("dashpot", [False, True])
def test_exponents_and_forces_are_those_with_all_shapes(law, stiffness, axes, dashpot):
    made = system(LAWS[law], stiffness, axes, dashpot)
    at, known, whole = of_all_shapes(made, VELOCITY)
    small = condensed(whole).small
    assert small.mode_count < whole.mode_count
    found = growth_of(made, VELOCITY)
    assert found.equilibrium.kind == at.kind
    assert found.equilibrium.status == at.status
    np.testing.assert_allclose(found.equilibrium.normal_force, at.normal_force, rtol=1e-9, atol=1e-9)
    assert_same(vibrating(found.exponents), vibrating(known), 1e-10)
    assert found.exponents.size == known.size


@pytest.mark.parametrize("stiffness", [None, 3e5])
def test_a_shape_that_a_contact_sees_must_not_be_left_out(monkeypatch, stiffness):
    """Negative control: without the rows across the slip, exponents in space differ."""
    made = system(LAWS["coulomb"], stiffness, 3, False)
    _, known, _ = of_all_shapes(made, VELOCITY)
    rows = module._rows

    def fewer(structure):
        blind = structure.shifted(np.zeros(len(structure.lines)))
        blind.lines = [replace(line, across=np.zeros_like(line.across)) for line in structure.lines]
        return rows(blind)

    monkeypatch.setattr(module, "_rows", fewer)
    found = vibrating(growth_of(made, VELOCITY).exponents)
    assert np.abs(found - vibrating(known)).max() > 1e-6 * np.abs(found).max()


def brakes():
    """Yield words, a changed brake, and whether its static response is that of the one before."""
    keys = {
        "friction": ({"friction": 0.3}, True),
        "friction of one lining": ({"surfaces.0.friction.coefficient": 0.5}, True),
        "stiffness of a lining": ({"surfaces.0.stiffness.stiffness": 4e11}, True),
        "damping of a lining": ({"surfaces.1.stiffness.damping": 1e6}, True),
        "pressure": ({"drives.0.y": -1500.0, "drives.1.y": 1500.0}, False),
        "speed": ({"bodies.disc.turning": 25.0}, False),
        "spring": ({"connections.3.stiffness": 4e6}, False),
    }
    for words, (changes, same) in keys.items():
        yield words, st.load_scenario("brake", changes).system, same


def test_points_of_the_brake_are_those_computed_alone(monkeypatch):
    """The same bits one after another as alone, and all shapes give the same exponents."""
    monkeypatch.undo()
    growths = Growths()
    growths.of(st.load_scenario("brake").system)
    for words, one, same in brakes():
        before = growths._last
        found, alone = growths.of(one), growth_of(one)
        np.testing.assert_array_equal(found.exponents, alone.exponents, words)
        np.testing.assert_array_equal(found.equilibrium.normal_force, alone.equilibrium.normal_force, words)
        at, known, _ = of_all_shapes(one)
        assert_same(vibrating(found.exponents), vibrating(known), 1e-12)
        np.testing.assert_allclose(found.equilibrium.normal_force, at.normal_force, rtol=1e-9)
        assert (before is not None and before.with_laws(one) is not None) == same, words


def test_a_motion_that_nothing_holds_is_named_as_with_all_shapes():
    """The message needs all modes of the bodies."""
    brake = st.load_scenario("brake").system
    loose = [one for one in brake.connections if one.direction != "x"]
    loose = st.System(brake.contacts, brake.drives, loose)
    messages = []
    for of in (of_all_shapes, growth_of):
        with pytest.raises(ValueError, match="hold each motion in which friction carries a body along") as refused:
            of(loose)
        messages.append(str(refused.value))
    assert messages[0] == messages[1]
