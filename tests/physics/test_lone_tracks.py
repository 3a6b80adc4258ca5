"""The sound of a track without its system: what else acts on it is named."""

from __future__ import annotations

import json

import numpy as np
import pytest

import stridula as st

from .cases import STEEL

BAR = st.ModalBeam(STEEL, st.Rectangle(0.03, 0.006), 0.5, bending_modes=8, axial_modes=2, damping=0.01)
OTHER = st.ModalBeam(STEEL, st.Rectangle(0.03, 0.006), 0.4, bending_modes=6, name="other bar")
MASS, SHAKER = st.PointMass(0.05), st.PointMass(0.2, name="shaker")
LOAD = st.Force(MASS.centre, y=-5.0)
PLACE = (0.3, 0.1, 0.4)
HARMONIC = st.Harmonic(430.0, amplitude=0.5, mean=1.0)
SAMPLED = st.Sampled((0.0, 1e-3), (0.0, -3.0))


def run_of(drives=(), connections=(), others=(), **words):
    contact = st.PointContact(MASS.centre, BAR, at=0.21, stiffness=1e5)
    return st.simulate(st.System([contact, *others], [LOAD, *drives], connections), 2e-3, **words)


def spring(first, second=None, direction="y"):
    return st.Spring(first, second, stiffness=1e6, direction=direction)


@pytest.mark.parametrize(
    ("drives", "connections", "words"),
    [
        ([st.Force(BAR.at(0.1), y=3.0, history=HARMONIC)], [], "harmonic force of up to 4.5 N at 0.1 m"),
        ([st.Force(BAR.at(0.1), x=9.0, y=2.0, history=SAMPLED)], [], "sampled force of up to 6 N at 0.1 m"),
        ([st.Force(BAR.at(0.3), y=2.0)], [], "constant force of up to 2 N at 0.3 m"),
        ([st.Gravity()], [], "gravity"),
        ([st.InitialVelocity(BAR, y=0.1)], [], "initial velocity"),
        ([], [spring(BAR.at(0.3))], "spring at 0.3 m"),
        ([], [spring(SHAKER.centre, BAR.at(0.2))], "spring at 0.2 m"),
        ([], [st.Dashpot(BAR.at(0.1), coefficient=9.0, direction=(1.0, 1.0, 0.0))], "dashpot at 0.1 m"),
        # These do not bend the bar.
        ([st.Force(BAR.at(0.1), x=3.0), st.Force(SHAKER.centre, y=3.0)], [spring(SHAKER.centre)], ""),
        ([], [spring(BAR.at(0.3), direction="x")], ""),
    ],
)
def test_what_acts_on_a_track_besides_contacts_is_named(drives, connections, words):
    beside = [st.PointContact(SHAKER.centre, BAR, at=0.4, gap=1.0)]
    run = run_of(drives, connections, beside)
    notes = st.radiate(run, BAR, PLACE).attrs["notes"].split("; ")
    found = [note for note in notes if note.startswith("not included")]
    assert found == ([f"not included without its system: {words}"] if words else [])
    varies = np.sqrt(float(run.normal_force.var("time").sum()))
    heard = f"only contacts along the track are heard, whose forces vary by {varies:.3g} N (root mean square)"
    assert (heard in notes) == bool(words)


def test_nothing_is_missing_from_recorded_motion():
    run = run_of([st.Gravity()], motion_rate=50e3)
    assert st.radiate(run, BAR, PLACE).attrs["notes"] == ""
    assert "gravity" in st.radiate(run.drop_vars("modal_motion"), BAR, PLACE).attrs["notes"]


def test_shipped_tracks_have_no_such_note():
    scenario = st.load_scenario("squeal", {"duration": "5 ms"})
    assert "not included" not in st.radiate(scenario.simulate(), scenario.system.track, PLACE).attrs["notes"]


def test_a_start_in_equilibrium_has_no_blow():
    run, blow = (run_of(start) for start in ([st.InitialEquilibrium()], []))
    still, struck = (st.radiate(one, BAR, PLACE) for one in (run, blow))
    assert np.abs(still.values).max() < 1e-6 * np.abs(struck.values).max()
    assert "not included" not in still.attrs["notes"]
    moving = run_of([st.InitialEquilibrium(mode=0, amplitude=1e-7)])
    assert "not included without its system: a mode" in st.radiate(moving, BAR, PLACE).attrs["notes"]


def test_contacts_at_a_fixed_point_are_left_out_and_named():
    """Records have no place of them along the track."""
    touching = st.PointContact(SHAKER.centre, BAR.at(0.3), stiffness=1e5, name="pin")
    both = run_of([st.Force(SHAKER.centre, y=-5.0)], others=[touching])
    alone = both.assign(normal_force=both.normal_force * [1.0, 0.0])
    heard = st.radiate(both, BAR, PLACE)
    np.testing.assert_array_equal(heard.values, st.radiate(alone, BAR, PLACE).values)
    assert "not included without its system: pin at a fixed point" in heard.attrs["notes"]
    assert not st.radiate(both.sel(contact="pin"), BAR, PLACE).values.any()


def test_contacts_on_another_body_are_named():
    elsewhere = st.PointContact(SHAKER.centre, OTHER, at=0.1, stiffness=1e5, name="beside")
    run = run_of([st.Force(SHAKER.centre, y=-5.0)], others=[elsewhere])
    words = "contacts on other bodies press on the track, too: "
    assert words + "contact 1" in st.radiate(run, OTHER, PLACE).attrs["notes"]
    assert words not in st.radiate(run.sel(contact=["beside"]), OTHER, PLACE).attrs["notes"]
    system = st.System([st.PointContact(MASS.centre, BAR, at=0.21), elsewhere])
    apart = st.radiate(run.sel(contact=["beside"]), system, PLACE, bodies=[OTHER])
    np.testing.assert_array_equal(apart.values, st.radiate(run.sel(contact=["beside"]), OTHER, PLACE).values)


def test_records_without_their_scenario_say_so():
    run = run_of([st.Gravity()])
    words = "does not say whether more than contacts acts on the track"
    del run.attrs["scenario"]
    assert words in st.radiate(run, BAR, PLACE).attrs["notes"]
    assert words not in st.radiate(run.assign_attrs(stridula_version=None).drop_attrs(), BAR, PLACE).attrs["notes"]


def test_what_acted_at_any_time_of_a_played_record_counts():
    runs = [run_of(drives) for drives in ([], [st.Gravity()])]
    changes = [{"time": 1e-3 * k, "scenario": run.attrs["scenario"]} for k, run in enumerate(runs)]
    played = runs[0].assign_attrs(changes=json.dumps(changes))
    assert "not included without its system: gravity" in st.radiate(played, BAR, PLACE).attrs["notes"]
    early = played.isel(time=slice(0, 50))
    assert "not included" not in st.radiate(early, BAR, PLACE).attrs["notes"]
