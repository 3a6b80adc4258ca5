"""Comparison of two records: inserted differences are found at their places and times."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st


@pytest.fixture(scope="module")
def record():
    return st.load_scenario("squeal", {"duration": "5 ms", "gap": 0.0}).simulate()


def test_a_record_is_equal_to_itself(record):
    found = st.compare(record, record, tolerance=0.0)
    assert found.attrs["within_tolerance"] == 1
    assert float(found["difference"].max()) == float(found["relative_difference"].max()) == 0.0
    assert np.isnan(found["first_time"]).all()
    assert found.sizes["attribute"] == 0


def test_an_inserted_difference_is_found_in_its_place(record):
    other = record.copy(deep=True)
    largest = float(np.abs(record["normal_force"]).max())
    other["normal_force"][300] += 1e-4 * largest
    other["normal_force"][200] -= 1e-8 * largest
    found = st.compare(record, other, tolerance=1e-6)
    force = found.sel(variable="normal_force")
    assert float(force["difference"]) == pytest.approx(1e-4 * largest, rel=1e-6)
    assert float(force["relative_difference"]) == pytest.approx(1e-4, rel=1e-6)
    assert float(force["first_time"]) == record["time"].values[300]
    assert str(force["units"].item()) == "N"
    assert found.attrs["within_tolerance"] == 0
    others = found.drop_sel(variable="normal_force")
    assert float(others["difference"].max()) == 0.0
    assert st.compare(record, other, tolerance=1e-3).attrs["within_tolerance"] == 1
    earlier = st.compare(record, other, tolerance=1e-9).sel(variable="normal_force")
    assert float(earlier["first_time"]) == record["time"].values[200]


def test_statistics_are_those_of_each_record(record):
    other = record.copy(deep=True)
    other["normal_force"] *= 2.0
    force = st.compare(record, other).sel(variable="normal_force")
    mean = float(record["normal_force"].mean())
    np.testing.assert_allclose(force["mean"], [mean, 2.0 * mean])
    np.testing.assert_allclose(force["rms"], np.sqrt((record["normal_force"] ** 2).mean().item()) * np.array([1, 2]))
    shares = st.compare(record, other).sel(variable="status_share [sliding]")["mean"]
    np.testing.assert_allclose(shares, record["status_share"].sel(contact_status="sliding").mean())


def test_nan_is_equal_to_nan_and_far_from_a_number(record):
    one, other = record.copy(deep=True), record.copy(deep=True)
    one["gap"][:] = other["gap"][:] = np.nan
    assert st.compare(one, other).attrs["within_tolerance"] == 1
    other["gap"][7] = 0.0
    found = st.compare(one, other).sel(variable="gap")
    assert float(found["difference"]) == np.inf
    assert float(found["first_time"]) == record["time"].values[7]


def test_different_settings_are_listed_by_key(record):
    other = st.load_scenario("squeal", {"duration": "5 ms", "gap": 0.0, "friction": 1.4}).simulate(
        scheme=st.CentralDifference(), probes=[]
    )
    found = st.compare(record, other)
    values = {str(k): tuple(v) for k, v in zip(found["attribute"].values, found["value"].values, strict=True)}
    assert values["scenario.contact.friction.coefficient"] == ("1.5", "1.4")
    assert values["scheme"] == ("exact modal", "central difference")
    assert "step" in values
    assert values["variable acceleration [track centre y]"] == ("recorded", "not there")
    assert "wall_time" not in values
    assert "scenario.contact.at" not in values


def test_round_off_about_zero_is_no_difference(record):
    other = record.copy(deep=True)
    other["ledger_residual"] += 1e-9 * float(record["kinetic_and_elastic"].max())
    other["gap"] += 1e-9 * float(np.abs(record["contact_height"]).max())
    assert st.compare(record, other).attrs["within_tolerance"] == 1


def on_a_belt():
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.1), friction=st.Coulomb(0.3))
    return st.System(contact, [st.Gravity()])


def test_round_off_on_a_rigid_floor_is_held_against_the_largest_length():
    record = st.simulate(on_a_belt(), 0.01)
    other = record.copy(deep=True)
    reach = float(np.ptp(record["contact_position"].values))
    for name in ("gap", "contact_height"):
        assert float(np.abs(record[name]).max()) < 1e-20
        other[name] += 1e-22
    assert st.compare(record, other).attrs["within_tolerance"] == 1
    other["gap"][7] += 1e-3 * reach
    found = st.compare(record, other)
    assert found.attrs["within_tolerance"] == 0
    assert float(found.sel(variable="gap")["relative_difference"]) == pytest.approx(1e-3)
    assert float(found.sel(variable="contact_height")["relative_difference"]) < 1e-15


def test_a_displacement_counts_as_a_length():
    mass = st.PointMass(1.0)
    system = st.System(st.PointContact(mass.centre, st.RigidTrack()), [st.InitialVelocity(mass, y=1.0)])
    record = st.simulate(system, 0.01, probes=[st.Displacement(mass.centre, "y")])
    record["gap"][:] = record["contact_height"][:] = record["contact_position"][:] = 0.0
    other = record.copy(deep=True)
    largest = float(np.abs(record["displacement"]).max())
    other["gap"] += 1e-3 * largest
    assert float(st.compare(record, other).sel(variable="gap")["relative_difference"]) == pytest.approx(1e-3)


def test_records_of_other_lengths_are_compared_over_what_both_have(record):
    part = record.isel(time=slice(100, 400))
    for pair in ((record, part), (part, record)):
        found = st.compare(*pair)
        assert (found.attrs["samples"], found.attrs["within_tolerance"]) == (300, 1)
    other = part.copy(deep=True)
    other["normal_force"][5] += 1.0
    assert float(st.compare(record, other).sel(variable="normal_force")["first_time"]) == record["time"].values[105]


def test_each_contact_is_compared_on_its_own():
    mass, floor = st.PointMass(1.0), st.RigidTrack()
    contacts = [
        st.PointContact(mass.centre, floor, name="low"),
        st.PointContact(mass.centre, floor, inclination=np.pi / 2.0, at=1.0, name="wall"),
    ]
    run = st.simulate(st.System(contacts, [st.Gravity(), st.InitialVelocity(mass, x=1.0)]), 1e-3)
    other = run.copy(deep=True)
    other["normal_force"][3, 1] += 1.0
    found = st.compare(run, other)
    assert float(found.sel(variable="normal_force [low]")["difference"]) == 0.0
    assert float(found.sel(variable="normal_force [wall]")["difference"]) == 1.0
    assert not any("sweeps" in str(name) for name in found["variable"].values)


def test_incomparable_records_are_reported(record):
    for other, message in [
        (
            st.load_scenario("squeal", {"duration": "5 ms", "sample_rate": 5e4}).simulate(),
            "b must have the same sample inter",
        ),
        (record.assign_coords(time=record["time"] + 1.0), "b must overlap a in time"),
        (record.isel(time=slice(0, 0)), "b must have samples to compare, got a record without any"),
        (xr.Dataset(), "b must be a record of simulate"),
        ("run.nc", "b must be a Dataset"),
    ]:
        with pytest.raises(ValueError, match=message) as caught:
            st.compare(record, other)
        assert "\n" not in str(caught.value)
    with pytest.raises(ValueError, match="tolerance must be 0 or above"):
        st.compare(record, record, tolerance=-1.0)
