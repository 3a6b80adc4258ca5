"""Damping ratios mode by mode: bodies, scenarios, records, and radiation damping of a plate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st

STEEL = st.Material(2.1e11, 7800.0)


def plate(damping=0.0):
    return st.ModalPlate(STEEL, 0.002, 0.4, 0.3, bending_modes=(3, 2), damping=damping)


def beam(damping=0.0):
    return st.ModalBeam(STEEL, st.Rectangle(0.02, 0.004), 0.8, bending_modes=4, axial_modes=2, damping=damping)


@pytest.mark.parametrize("body", [plate, beam])
def test_each_mode_has_its_own_ratio(body):
    ratios = [0.01 * k for k in range(6)]
    damped = body(ratios)
    np.testing.assert_allclose(damped.modes().damping, ratios, rtol=1e-15)
    assert damped == body(np.array(ratios))
    assert damped != body(0.01)
    np.testing.assert_allclose(body(0.02).modes().damping, np.full(6, 0.02), rtol=1e-15)


@pytest.mark.parametrize(
    ("damping", "message"),
    [
        ([0.1] * 5, "damping must have one ratio or 6, one for each mode kept, got 5"),
        ([0.1] * 5 + [1.0], r"damping\[5\] must be below 1"),
        ([0.1] * 5 + [-0.1], r"damping\[5\] must be 0 or above"),
        ([[0.1] * 6], "damping must be one ratio, a list"),
        ("much", "damping must be a number"),
    ],
)
def test_bad_ratios_are_named(damping, message):
    for body in (plate, beam):
        with pytest.raises(ValueError, match=message):
            body(damping)


def test_a_record_runs_again_with_them(tmp_path):
    system = st.load_scenario("squeal", {"duration": "30 ms"}).system
    track = replace(system.track, damping=np.linspace(0.001, 0.02, system.track.modes().count))
    damped = replace(system, contact=replace(system.contact, track=track))
    run = st.simulate(damped, 30e-3)
    again = st.load_scenario(run)
    assert again.system.track == track
    np.testing.assert_array_equal(again.simulate()["normal_force"], run["normal_force"])
    plain = st.simulate(system, 30e-3)
    assert not np.array_equal(plain["normal_force"], run["normal_force"])


def test_a_plate_that_moves_in_its_plane_has_those_modes_last():
    """Two longitudinal modes of one half-wave, a shear mode and a longitudinal one of both."""
    sheet = replace(plate(), in_plane=True, in_plane_modes=(1, 1))
    ratios = [0.01 * k for k in range(10)]
    damped = replace(sheet, damping=ratios)
    np.testing.assert_allclose(damped.modes().damping, ratios, rtol=1e-15)
    assert damped.harmonics == (6, 4)
    rising = np.diff(damped.modes().frequency) > 0.0
    np.testing.assert_array_equal(rising, [True] * 9)
    np.testing.assert_allclose(damped.polarisations, [[0.8, -0.6], [1.0, 0.0], [0.0, 1.0], [0.6, 0.8]], atol=1e-15)
    with pytest.raises(ValueError, match="damping must have one ratio or 10, one for each mode kept, got 6"):
        replace(sheet, damping=ratios[:6])


def test_sound_brakes_a_beam_when_its_damping_is_added():
    still = beam()
    taken = st.radiation_damping(still)
    damped = replace(still, damping=taken)
    np.testing.assert_allclose(damped.modes().damping, taken, rtol=1e-15)
    bending = still.harmonics[0]
    assert (taken[:bending] > 0.0).all()
    assert not taken[bending:].any()


def test_sound_brakes_a_plate_when_its_damping_is_added():
    still = plate()
    taken = st.radiation_damping(still)
    damped = replace(still, damping=taken)
    np.testing.assert_allclose(damped.modes().damping, taken, rtol=1e-15)
    assert (taken > 0.0).all()
