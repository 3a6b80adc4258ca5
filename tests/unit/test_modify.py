"""Systems with small changes, against systems built with them from the start."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

BELT = st.RigidTrack(velocity=0.5)


def slider(mass, friction=0.5, feet=("foot",), **more):
    block = st.PointMass(mass, "block")
    contacts = [
        st.PointContact(block.centre, BELT, friction=st.Coulomb(friction), stiffness=800.0, name=name) for name in feet
    ]
    springs = [
        st.Spring(block.centre, stiffness=1000.0, direction=(1.0, 1.0, 0.0)),
        st.Dashpot(block.centre, coefficient=3.0),
        st.Spring(block.centre, stiffness=700.0, direction="y"),
        *more.get("connections", []),
    ]
    return st.System(contacts, [st.Force(block.centre, y=-20.0), st.InitialEquilibrium()], springs)


def same(found, expected):
    a, b = st.sliding_stability(found), st.sliding_stability(expected)
    for name in ("growth_rate", "frequency"):
        np.testing.assert_allclose(np.sort(a[name]), np.sort(b[name]), rtol=1e-9, atol=1e-9)


def test_an_added_mass_is_part_of_the_body():
    system = slider(1.0)
    changed = st.modify(system, masses=[(system.bodies[0].centre, 0.2), (system.bodies[0].centre, 0.1)])
    same(changed, slider(1.3))
    assert len(system.bodies) == 1
    assert [changed.body_name(body) for body in changed.bodies] == ["block", "mass 1 on block", "mass 2 on block"]


def test_the_derivative_by_a_mass_is_that_of_small_masses():
    system = st.load_scenario("brake").system
    pad = system.bodies[0]
    back = pad.at((0.0, 0.026, 0.1))
    found = st.mode_sensitivity(system, [], masses={"back": back})
    mass = 1e-4
    changed = st.sliding_stability(st.modify(system, masses=[(back, mass)]))
    for frequency, growth, slope in zip(
        found["frequency"].values, found["growth_rate"].values, found["d_growth_rate"].values[0], strict=True
    ):
        nearest = int(np.abs(changed["frequency"].values - frequency).argmin())
        assert float(changed["growth_rate"][nearest]) - growth == pytest.approx(mass * slope, rel=0.02)


def test_connections_and_friction_are_those_given():
    system = slider(1.0, feet=("left", "right"))
    block = system.bodies[0]
    mount = st.Bushing(block.centre, stiffness=(300.0, 100.0, 0.0))
    changed = st.modify(system, connections=[mount], friction=st.Coulomb(0.2))
    same(changed, slider(1.0, 0.2, ("left", "right"), connections=[mount]))
    one = st.modify(system, friction={"left": st.Coulomb(0.3)})
    assert [contact.friction.coefficient for contact in one.contacts] == [0.3, 0.5]


def test_contacts_may_be_left_out():
    same(st.modify(slider(1.0, feet=("left", "right")), without=["right"]), slider(1.0, feet=("left",)))
    brake = st.load_scenario("brake").system
    chamfered = st.modify(brake, without=["upper lining 1", "lower lining"])
    assert len(chamfered.contacts) == 31
    assert set(chamfered.surface_names) == {"upper lining"}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"without": ["middle"]}, r"^without must name contacts or surfaces \(left, right\), got 'middle'"),
        ({"friction": {"middle": st.Coulomb(0.1)}}, r"^friction must name contacts or surfaces"),
        ({"without": ["left", "right"]}, r"^without must leave at least one contact"),
        ({"masses": [(st.PointMass(2.0).centre, 0.1)]}, r"^masses\[0\]\[0\] must be on a body of the system"),
    ],
)
def test_changes_that_are_none_are_named(changes, words):
    with pytest.raises(ValueError, match=words):
        st.modify(slider(1.0, feet=("left", "right")), **changes)


@pytest.mark.parametrize("mass", [0.0, -1.0, np.nan])
def test_a_mass_is_above_zero(mass):
    system = slider(1.0)
    with pytest.raises(ValueError, match=r"^masses\[0\]\[1\] must be "):
        st.modify(system, masses=[(system.bodies[0].centre, mass)])
