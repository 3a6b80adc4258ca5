"""Systems: consistency of bodies, contact and drives, and the printed card."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physics.cases import dragged, pair, shaken, slider, track, transverse

import stridula as st

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
        r"^drives\[1\] must be a Force or ImposedVelocity or Gravity or InitialVelocity or InitialState, got ",
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
    from stridula.assembly import assemble

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
