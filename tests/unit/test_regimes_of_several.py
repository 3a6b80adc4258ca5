"""Regimes of several contacts, and of surfaces, as one: constructed records with known answers, and real runs."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula import analysis
from stridula.analysis.several_contacts import loads, mean_shares, stretches, together
from stridula.analysis.status_changes import MIXED, last_rest
from stridula.records.by_surface import groups
from stridula.studies.measures import asked_for

RATE = 20e3
SEPARATED, STICKING, SLIDING = range(3)
SECOND = np.arange(1, round(RATE) + 1) / RATE
TONE = np.sin(2.0 * np.pi * 1000.0 * SECOND)
# Difference made by repeating a contact: landings add up.
ADDS_UP = {"impact_rate"}


def record(*contacts, surfaces=()):
    """Return a record of contacts, each given by its status and its normal force over time."""
    size, names = SECOND.size, [f"contact {number}" for number, _ in enumerate(contacts, 1)]
    status = np.stack([np.broadcast_to(status, size) for status, _ in contacts], axis=1)
    normal = np.stack([np.broadcast_to(np.asarray(normal, float), size) for _, normal in contacts], axis=1)
    along = ("time", "contact")
    data = {
        "status_share": ((*along, "contact_status"), np.eye(3)[status]),
        "normal_force": (along, normal),
        "tangential_force": (along, np.full_like(normal, 0.25)),
        "damping_loss": ("time", 0.0 * SECOND),
        "impact_loss": ("time", 0.0 * SECOND),
        "friction_loss": ("time", SECOND),
    }
    coordinates = {"time": SECOND, "contact": names}
    if surfaces:
        coordinates["surface"] = ("contact", list(surfaces))
    return xr.Dataset(data, coordinates, {"ended": "finished"})


def named(run):
    return str(analysis.regime(run).regime.values)


# Constructed records.


def hammering(every=160, closed=8):
    beat = np.arange(SECOND.size) % every
    return np.where(beat < closed, SLIDING, SEPARATED), np.where(beat < closed, 5.0, 0.0)


def creeping():
    phase = 30.0 * SECOND % 1.0
    return np.where(phase < 0.7, STICKING, SLIDING), 1.0 + 0.2 * (phase < 0.7)


CONTACTS = {
    "stable sliding": (SLIDING, 1.0),
    "sticking": (STICKING, 1.0),
    "squeal": (SLIDING, 1.0 + 0.3 * TONE),
    "judder": hammering(),
    "stick-slip": creeping(),
    "off the track": (SEPARATED, 0.0),
}


@pytest.mark.parametrize("surface", [(), ("pad", "pad", "pad")], ids=["points", "surface"])
@pytest.mark.parametrize("name", CONTACTS)
def test_equal_contacts_have_the_regime_of_one(name, surface):
    status, normal = CONTACTS[name]
    one, three = record((status, normal)), record(*[(status, normal)] * 3, surfaces=surface)
    found, expected = analysis.regime(three), analysis.regime(one.sel(contact="contact 1"))
    assert (str(found.regime.values), str(expected.regime.values)) == (name, name)
    for word in set(found.data_vars) - {"regime"} - ADDS_UP:
        np.testing.assert_allclose(found[word], expected[word], rtol=1e-9, err_msg=word)
    assert found.impact_rate == pytest.approx(3.0 * expected.impact_rate)
    assert analysis.regime(one).identical(expected)


def test_cancelling_forces_count_between_contacts_and_not_within_a_surface():
    """Two pads on both sides of a disc; or two points of one face that share a load to and fro."""
    sides = [(SLIDING, 1.0 + 0.5 * TONE), (SLIDING, 1.0 - 0.5 * TONE)]
    found = analysis.regime(record(*sides))
    assert (found.regime, found.confidence) == ("squeal", 1.0)
    assert found.frequency == pytest.approx(1000.0, abs=1.0)
    assert named(record(*sides, surfaces=("pad", "pad"))) == "stable sliding"
    assert named(record(*sides, surfaces=("pad", "other pad"))) == "squeal"


def test_each_contact_is_weighted_by_its_load():
    """A heavy foot slides and a light one hammers; one without load does not count."""
    light = hammering()
    run = record((SLIDING, 9.75), light, (SEPARATED, 0.0))
    found = analysis.regime(run)
    assert found.sliding == pytest.approx(0.975 + 0.025 * 0.05, abs=1e-3)
    assert found.separated == pytest.approx(0.025 * 0.95, abs=1e-3)
    assert named(run.sel(contact="contact 2")) == "judder"
    assert named(run.sel(contact="contact 3")) == "off the track"
    # The light one no longer counts below a twentieth of an equal share.
    assert named(record((SLIDING, 40.0), light, (SEPARATED, 0.0))) == "stable sliding"


def test_feet_that_rock_judder_though_one_always_touches():
    left = 25.0 * SECOND % 1.0 < 0.5
    rocking = record((np.where(left, SLIDING, SEPARATED), left), (np.where(left, SEPARATED, SLIDING), ~left))
    found = analysis.regime(rocking)
    assert found.regime == "judder"
    assert found.separated == pytest.approx(0.5, abs=1e-3)


def test_at_rest_it_slides_if_any_contact_does():
    assert named(record((STICKING, 3.0), (SLIDING, 1.0))) == "stable sliding"
    assert named(record((STICKING, 3.0), (SEPARATED, 0.0))) == "sticking"
    found = analysis.regime(record((STICKING, 3.0), (SLIDING, 1.0)))
    assert (found.settle_time, found.sticking, found.sliding) == (0.0, 0.75, 0.25)


def test_rest_begins_when_the_last_contact_rests():
    late = np.where(SECOND < 0.3, SLIDING, STICKING)
    assert analysis.regime(record((STICKING, 1.0), (late, 1.0))).settle_time == pytest.approx(0.3, abs=1e-4)


def test_slips_are_those_of_most_of_the_load():
    """Five hairs slip together 20 times a second; the outer ones once more in between."""
    phase = 20.0 * SECOND % 1.0
    common = phase > 0.9
    more = common | ((phase > 0.4) & (phase < 0.5))
    contacts = [(np.where(slip, SLIDING, STICKING), 1.0) for slip in (more, common, common, common, more)]
    found = analysis.regime(record(*contacts))
    assert found.regime == "stick-slip"
    assert found.slip_rate == pytest.approx(20.0, abs=1.2)
    assert found.frequency == pytest.approx(20.0, rel=1e-3)
    assert analysis.regime(record(*contacts).sel(contact="contact 1")).slip_rate == pytest.approx(40.0, abs=1.2)
    # If three of the five slip, all do.
    contacts[2] = contacts[0]
    assert analysis.regime(record(*contacts)).slip_rate == pytest.approx(40.0, abs=1.2)


def test_a_part_of_the_contacts_has_its_own_regime():
    run = record((SLIDING, 1.0), (SLIDING, 1.0 + 0.5 * TONE), (SLIDING, 1.0), surfaces=("a", "b", "a"))
    assert named(run) == "squeal"
    assert named(run.isel(contact=run.surface == "a")) == "stable sliding"
    assert named(run.isel(contact=run.surface == "b")) == "squeal"
    assert named(run.isel(contact=[1])) == "squeal"


def test_a_plain_record_of_several_contacts_has_the_regime_of_the_labelled_one():
    run = record(hammering(), (SLIDING, 1.0), (SLIDING, 1.0 - 0.5 * TONE), surfaces=("", "pad", "pad"))
    plain = st.PlainRecord(
        run.time.values,
        {str(name): run[name].values for name in run.data_vars},
        run.contact.values.tolist(),
        run.attrs,
        run.surface.values.tolist(),
    )
    np.testing.assert_equal(analysis.regime_of(plain), analysis.regime_of(run))
    assert plain.labelled("normal_force").surface.values.tolist() == ["", "pad", "pad"]


def test_bad_records_of_several_contacts():
    run = record((SLIDING, 1.0), (SLIDING, 1.0))
    with pytest.raises(ValueError, match="run must have a contact, got none"):
        analysis.regime(run.isel(contact=[]))
    with pytest.raises(ValueError, match="run must have a normal_force of each contact, got one over time"):
        analysis.regime(run.assign(normal_force=("time", SECOND)))
    with pytest.raises(ValueError, match="run must have a damping_loss over time alone, got one over time, contact"):
        analysis.regime(
            run.assign(damping_loss=run.damping_loss.expand_dims({"contact": run.sizes["contact"]}, axis=1))
        )


# The parts.


def test_loads():
    np.testing.assert_allclose(loads(np.array([[1.0, 3.0], [1.0, 3.0]]), 0.05), [0.25, 0.75])
    np.testing.assert_allclose(loads(np.array([[1.0, 99.0]]), 0.05), [0.0, 1.0])
    np.testing.assert_allclose(loads(np.zeros((4, 2)), 0.05), [0.5, 0.5])
    share = np.array([[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]])
    np.testing.assert_allclose(mean_shares(share, np.array([0.2, 0.8])), [0.1, 0.1, 0.8])


@pytest.mark.parametrize("carried", [[0.5, 0.5], [0.5 + 1e-9, 0.5 - 1e-9]])
def test_two_equal_contacts_only_stick_together(carried):
    share = np.array([[1.0, 0.0], [1.0, 1.0], [0.75, 0.25]])
    np.testing.assert_array_equal(together(share, np.array(carried)), [0.0, 1.0, 0.25])


def test_most_of_the_load_decides():
    share = np.array([[1.0, 1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0, 0.4]])
    np.testing.assert_array_equal(together(share, np.full(5, 0.2)), [1.0, 0.4])
    np.testing.assert_array_equal(together(share, np.array([0.6, 0.1, 0.1, 0.1, 0.1])), [1.0, 1.0])


def test_stretches_and_groups():
    found = np.array([[1, 1, 2, 2, 2, 2], [1, 1, 1, MIXED, 2, 2]])
    assert last_rest(stretches(found)) == 4
    assert stretches(found)[3] == MIXED
    assert groups(["a", "b", "c", "d"], ["x", "", "x", ""]) == [[0, 2], [1], [3]]
    assert groups(["a", "b"], []) == [[0], [1]]


# Named measures.


def test_named_measures_of_several_contacts():
    run = record((SLIDING, 3.0 + TONE), (SLIDING, 1.0 + 0.5 * TONE), (STICKING, 4.0))
    asked = asked_for(["regime", "shares", "dominant_frequency", "peak_force", "mean_force"])
    found = asked.of_record(run)
    assert found["regime"] == "squeal"
    assert (found["sliding_share"], found["sticking_share"]) == pytest.approx((0.5, 0.5))
    assert found["mean_force"] == pytest.approx(8.0)
    assert found["peak_force"] == pytest.approx(9.5, rel=1e-3)
    assert found["dominant_frequency"] == pytest.approx(1000.0, rel=1e-3)
    with pytest.raises(ValueError, match="measure 'travel': run must be of one contact"):
        asked_for("travel").of_record(run.assign(contact_position=run.normal_force))


# Real runs.


def belts(count: int) -> st.System:
    """Equal blocks on springs, each on a separate belt: all with the same motion."""
    contacts, drives, springs = [], [], []
    for number in range(count):
        block = st.PointMass(1.0, name=f"block {number}")
        law = st.StaticKinetic(0.4, 0.25)
        contacts.append(st.PointContact(block.centre, st.RigidTrack(velocity=0.5), friction=law))
        drives += [st.Force(block.centre, y=-10.0), st.InitialVelocity(block, x=0.5)]
        springs.append(st.Spring(block.centre, stiffness=400.0))
    return st.System(contacts, drives, springs)


def test_contacts_without_names_count():
    run = st.simulate(belts(3), 5.0, step=1e-4, sample_rate=2e3, probes=[])
    assert named(run.drop_vars("contact")) == named(run)


def test_three_belts_are_one_belt():
    one, three = (st.simulate(belts(count), 5.0, step=1e-4, sample_rate=2e3, probes=[]) for count in (1, 3))
    found, expected = st.regime(three), st.regime(one)
    assert found.regime == expected.regime == "stick-slip"
    for word in ("confidence", "frequency", "slip_rate", "sticking", "periodicity"):
        assert found[word] == pytest.approx(float(expected[word]), rel=1e-6)


# The growing mode of the pin, near 2273 Hz; for the pad that of the disc at 1719 Hz; both shifted by the cycle. The
# nodes of the pad are off the disc for a quarter of the time, in a chaotic motion on the border of squeal and judder:
# at half the step it is judder, whatever the damping of residual shapes.
RIGS = {
    "pin-on-disc": ({"squeal"}, 0.9, 2240.0, 2340.0),
    "pad-on-disc": ({"squeal", "judder"}, 0.5, 1690.0, 1725.0),
}


@pytest.mark.parametrize("name", RIGS)
def test_rigs_have_the_tone_of_their_mode_though_some_of_their_nodes_only_hammer(name):
    run = st.load_scenario(name).simulate(sample_rate=2e4)
    found = st.regime(run)
    regimes, least, low, high = RIGS[name]
    assert str(found.regime.values) in regimes
    assert found.confidence > least
    assert low < found.frequency < high


def test_points_of_a_face_have_the_name_of_their_surface(tmp_path):
    block = st.SolidBody(
        st.SolidMesh.block((0.02, 0.01, 0.01), (2, 1, 1)),
        st.Material(5e9, 2500.0, 0.3),
        cutoff=5e4,
        fixed=["top"],
        contact_faces=["bottom"],
        name="pad",
    )
    face = st.SurfaceContact(block, "bottom", st.RigidTrack(velocity=0.1), friction=st.Coulomb(0.3), name="face")
    load = [st.Force(one.tip, y=-1.0) for one in face.contacts]
    run = st.simulate(st.System(face, load), 2e-3, sample_rate=1e5, probes=[], surface_rate="all")
    assert run.surface.values.tolist() == ["face"] * len(face.contacts)
    assert named(run.isel(contact=run.surface == "face")) == named(run)
    st.save(run, tmp_path / "face.nc")
    xr.testing.assert_allclose(analysis.regime(st.load(tmp_path / "face.nc")), analysis.regime(run))
