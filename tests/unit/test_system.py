"""Systems: consistency of bodies, contact and drives, and the printed card."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from physics.cases import dragged, pair, shaken, slider, track, transverse

import stridula as st
from stridula.lowering import assemble

ROD, BAR = slider(30.0), track()
SYSTEM = pair(transverse(), mu=0.5, rod=ROD, bar=BAR)
OTHER = slider(30.0, length=0.4)


def refuse(match, **changes):
    with pytest.raises(ValueError, match=match) as caught:
        st.System(**({"contact": SYSTEM.contact, "drives": ()} | changes))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", [None, ROD, "contact"])
def test_bad_contact(value):
    refuse(r"^contact must be a PointContact or a list of them, got ", contact=value)


@pytest.mark.parametrize("value", [None, 3, "gravity", st.Gravity(), {st.Gravity()}])
def test_bad_drives(value):
    refuse(r"^drives must be a list of drives, got ", drives=value)


@pytest.mark.parametrize("value", [None, ROD, "gravity", 9.81])
def test_bad_drive(value):
    refuse(
        r"^drives\[1\] must be a Force or ImposedVelocity or Gravity or InitialVelocity or InitialState or "
        "InitialEquilibrium, got ",
        drives=[st.Gravity(), value],
    )


@pytest.mark.parametrize(
    "drive",
    [st.Force(OTHER.root, y=1.0), st.ImposedVelocity(OTHER.root, 0.1), st.InitialVelocity(OTHER, x=1.0)],
)
def test_drive_on_another_body(drive):
    refuse(r"^drives\[0\] must act on a body of this system, got ", drives=[drive])


def test_two_imposed_velocities():
    refuse("at most one ImposedVelocity, got 2", drives=[st.ImposedVelocity(ROD.root, v) for v in (0.1, 0.2)])


def test_two_initial_equilibria():
    refuse("at most one InitialEquilibrium, got 2", drives=[st.InitialEquilibrium(), st.InitialEquilibrium()])


def test_an_initial_equilibrium_is_on_the_card():
    start = st.InitialEquilibrium(mode=3, amplitude=2e-6)
    assert "initial equilibrium, mode number 3 on top by 2e-06 m" in str(st.System(SYSTEM.contact, [start]))
    assert st.System(SYSTEM.contact, [start]).initial_equilibrium == start
    assert SYSTEM.initial_equilibrium is None


def test_imposed_velocity_with_a_throw():
    refuse(
        r"^drives\[1\]\.x must be 0 under an imposed velocity",
        drives=[st.ImposedVelocity(ROD.root, 0.1), st.InitialVelocity(ROD, x=0.1)],
    )
    upward = st.System(SYSTEM.contact, [st.ImposedVelocity(ROD.root, 0.1), st.InitialVelocity(ROD, y=0.1)])
    assert upward.imposed_velocity.velocity == 0.1


@pytest.mark.parametrize("support", ["pinned", "clamped"])
def test_imposed_velocity_needs_a_root_that_can_move(support):
    rod = replace(ROD, root_support=support)
    with pytest.raises(ValueError, match=r"^root_support must be guided or free under an imposed velocity"):
        pair(dragged(), 0.5, rod=rod)
    with pytest.raises(ValueError, match=r"^tip_support must be free under an imposed velocity"):
        pair(dragged(), 0.5, rod=replace(ROD, tip_support="pinned"))


def test_a_system_is_a_value():
    again = pair(transverse(), mu=0.5, rod=slider(30.0), bar=track())
    assert again == SYSTEM
    assert hash(again) == hash(SYSTEM)
    assert isinstance(st.System(SYSTEM.contact, [st.Gravity()]).drives, tuple)
    assert (SYSTEM.slider, SYSTEM.track, SYSTEM.imposed_velocity) == (ROD, BAR, None)


def test_card_names_every_part():
    system = pair(lambda rod: [*shaken(rod), st.Force(rod.root, history=st.Ramp(0.1))], mu=0.7, angle=30.0)
    card = str(system)
    for words in (
        "slider",
        "track",
        "30 deg",
        "friction 0.7",
        "gravity 9.807",
        "0.5 N",
        "ramp",
        "harmonic",
        "gap 1e-06",
    ):
        assert words in card
    assert str(pair(dragged(), 0.5)).count("imposed velocity 0.01 m/s") == 1
    assert len(card.splitlines()) == 3 + 5


def test_assembly_keeps_slider_bending_axial_in_order():
    from stridula.lowering import assemble

    arrays = assemble(SYSTEM)
    rows = arrays.contacts[0]
    slider_modes = ROD.modes().count
    assert rows.bending == (slider_modes, slider_modes + BAR.harmonics[0])
    assert rows.axial == (rows.bending[1], arrays.mode_count)
    expected = np.concatenate([ROD.modes().angular_frequency, BAR.modes().angular_frequency])
    np.testing.assert_array_equal(arrays.angular_frequency, expected)
    np.testing.assert_array_equal(rows.fixed[::-1, :slider_modes], ROD.trace(0.0))
    assert not rows.fixed[:, slider_modes:].any()
    held = assemble(pair(dragged(), 0.5, rod=ROD, bar=BAR))
    np.testing.assert_array_equal(held.contacts[0].fixed[::-1, : slider_modes - 1], ROD.trace(0.0, held_x=True))
    assert np.sum(held.angular_frequency == 0) == 1
    assert np.sum(arrays.angular_frequency == 0) == 2


PLATE = st.ModalPlate(st.Material(2.1e11, 7800.0), 3e-3, 0.6, 0.4, name="sheet")
ROUND = st.ModalBeam(st.Material(2.1e11, 7800.0), st.Circle(0.01), 0.8)


@pytest.mark.parametrize(
    ("refused", "message"),
    [
        (
            lambda: st.PointContact(ROD, BAR, 0.1),
            "tip must be a BodyPoint, got a FiniteElementBeam",
        ),
        (
            lambda: st.PointContact(BAR.centre, BAR, 0.1),
            "track must be a body other than the tip's (equal bodies need names), got a ModalBeam for both",
        ),
        (
            lambda: st.Spring(PLATE.centre, PLATE.centre, stiffness=1.0),
            "second must be a point other than first (equal bodies need names), got a BodyPoint for both",
        ),
        (
            lambda: st.Force(PLATE, y=1.0),
            "point must be a BodyPoint, got a ModalPlate named 'sheet'",
        ),
        (
            lambda: st.System(SYSTEM.contact, [st.Force(OTHER.root, y=1.0)]),
            "drives[0] must act on a body of this system, got a FiniteElementBeam",
        ),
        (
            lambda: st.simulate(SYSTEM, 1e-3, probes=[st.Velocity(PLATE.centre)]),
            "probe must be on a body of this system, got one on a ModalPlate named 'sheet'",
        ),
        (
            lambda: st.simulate(SYSTEM, 1e-3, probes=[st.Reaction(OTHER, "x")]),
            "probe must be on the slider of this system, got one on a FiniteElementBeam",
        ),
        (
            lambda: st.simulate(SYSTEM, 1e-3, probes=SYSTEM.contact),
            "probes must be a list of probes, got a PointContact",
        ),
        (lambda: st.simulate_many(SYSTEM, 1e-3), "systems must be a list of systems, got a System"),
        (lambda: st.BodyPoint(SYSTEM, 0.0), "body must be a body of stridula, got a System"),
        (
            lambda: st.radiation_efficiency(ROUND, [1000.0]),
            "track must have a Rectangle as section to have a flat surface in a baffle, got Circle(diameter=0.01)",
        ),
        (lambda: st.ModalBeam([BAR] * 20, BAR.section, 0.8), "material must be a Material, got a list"),
    ],
)
def test_messages_name_the_type_of_a_bad_argument(refused, message):
    """The fields of a body would fill a screen."""
    with pytest.raises(ValueError) as caught:
        refused()
    assert str(caught.value) == message


def test_cached_results_of_a_system_are_not_pickled():
    """In another process texts have other hashes, and functions cannot be unpickled."""
    system = st.load_scenario("squeal").system
    arrays = assemble(system)
    assert assemble(system) is arrays
    assert hash(system.slider) == hash(replace(system.slider))
    other = pickle.loads(pickle.dumps(system))
    assert other == system
    assert hash(other) == hash(system)
    assert "kept" not in vars(other)
    assert "_hash" not in vars(pickle.loads(pickle.dumps(system.slider)))
    again = assemble(other)
    assert again is not arrays
    np.testing.assert_array_equal(again.loads, arrays.loads)
    assert "kept" not in vars(replace(system))


def test_probes_are_added_to_the_cached_assembly():
    system = st.load_scenario("squeal").system
    probes = [st.Acceleration(system.track.centre, "y"), st.Reaction(system.slider, "x")]
    assert assemble(system).probes == []
    after, fresh = (assemble(one, probes).probes for one in (system, replace(system)))
    for one, other in zip(after, fresh, strict=True):
        np.testing.assert_array_equal(one.rows, other.rows)
        np.testing.assert_array_equal(one.direct, other.direct)
    assert assemble(system).probes == []


def test_the_trace_of_a_beam_may_be_modified():
    rod = st.load_scenario("squeal").system.slider
    first = rod.trace(0.0)
    first[:] = 0.0
    assert rod.trace(0.0).any()
