"""Surfaces in short records: resultants and sound equal those of all points."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import stridula as st
from stridula import analysis, plot
from stridula.acoustics.redriven import redriven
from stridula.integration import together
from stridula.plot.surfaces import QUANTITIES
from stridula.records.by_point import by_point, counted
from stridula.records.by_surface import by_surface
from stridula.records.resultants import RESULTANTS

STEEL = st.Material(2.1e11, 7800.0, 0.3)
RATE, MAPS = 2e4, 2e3
WORDS = {"sample_rate": RATE, "probes": []}


BLOCK = st.SolidBody.block((0.02, 0.02, 0.02), (1, 1, 1), STEEL, contact_faces=["bottom"], name="block")
SOLE = st.SurfaceContact(
    BLOCK, "bottom", st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.3), stiffness=1e11, name="sole"
)


def system(*others):
    """A block on a belt that is pulled up and pushed down, so that it lifts off."""
    push = st.Force(BLOCK.at("top"), y=-20.0, history=st.Harmonic(800.0))
    return st.System([*others, SOLE], [st.Gravity(), push])


def interrupt(_):
    raise KeyboardInterrupt


@pytest.fixture(scope="module")
def pair():
    """A system with a point beside the face."""
    shoe = st.RigidBody(mass=0.1, name="shoe")
    heel = st.PointContact(
        shoe.centre, st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.3), normal=(0, 1, 0), name="heel"
    )
    return system(heel)


@pytest.fixture(scope="module")
def both(pair):
    """The same run with all points and as a short record."""
    return [st.simulate(pair, 8.2e-3, surface_rate=rate, **WORDS) for rate in ("all", MAPS)]


@pytest.fixture(scope="module")
def usual(pair):
    """The run as recorded by default."""
    return st.simulate(pair, 8.2e-3, **WORDS)


def test_a_surface_is_one_contact(both):
    whole, short = both
    known = by_surface(whole)
    assert short["contact"].values.tolist() == ["heel", "sole"]
    for name in ("normal_force", "tangential_force", "slip_velocity", "status_share", "gap", "landings"):
        np.testing.assert_allclose(short[name], known[name], rtol=1e-12, atol=1e-15, err_msg=name)
        assert short[name].dims == whole[name].dims
    for name in ("kinetic_and_elastic", "contact_work", "contact_sweeps"):
        np.testing.assert_array_equal(short[name], whole[name])
    assert 0 < int((whole.status.sel(contact="sole 1") == 0).sum()) < whole.sizes["time"]


def test_resultants_are_those_of_all_points(both):
    whole, short = both
    known, found = analysis.surface(whole, SOLE), analysis.surface(short, SOLE)
    for name in RESULTANTS:
        np.testing.assert_allclose(found[name], known[name], rtol=1e-12, atol=1e-15, err_msg=name)
        assert found[name].dims == known[name].dims
        assert found[name].attrs == known[name].attrs


def test_maps_are_means_over_their_interval(both):
    whole, short = both
    every = round(RATE / MAPS)
    known, found = analysis.surface(whole, SOLE), analysis.surface(short, SOLE)
    count = whole.sizes["time"] // every
    assert found.sizes["map_time"] == count
    np.testing.assert_allclose(found.map_time, whole.time[every - 1 :: every][:count])
    for name in ("pressure", "shear", "slip_velocity", "status_share"):
        means = known[name][: count * every].values.reshape(count, every, *known[name].shape[1:]).mean(axis=1)
        np.testing.assert_allclose(found[name], means, rtol=1e-12, atol=1e-12, err_msg=name)
    assert whole.sizes["time"] % every, "an interval that is not whole should be left out"


def test_regimes_figures_and_files_accept_it(both, tmp_path):
    _, short = both
    st.save(short, tmp_path / "short.nc")
    loaded = st.load(tmp_path / "short.nc")
    assert loaded.identical(short)
    assert str(st.regime(short).regime.item())
    plot.surface(analysis.surface(loaded, SOLE), "status")
    plot.overview(short)
    st.export(short, tmp_path / "short.csv")
    assert float(st.compare(short, short).attrs["within_tolerance"]) == 1


def test_the_usual_record_continues():
    given = system()
    run, first = (st.simulate(given, duration, **WORDS) for duration in (4e-3, 2e-3))
    rest = st.simulate(given, 2e-3, start=first, **WORDS)
    for name in ("normal_force", "point_normal_force", "point_status_share", "point_landings", "map_slip_velocity"):
        np.testing.assert_array_equal(np.concatenate([first[name], rest[name]]), run[name], err_msg=name)


def test_it_continues_and_runs_again(both):
    whole, short = both
    given = system()
    words = WORDS | {"surface_rate": MAPS}
    run = st.simulate(given, 4e-3, **words)
    first = st.simulate(given, 2e-3, **words)
    rest = st.simulate(given, 2e-3, start=first, **words)
    for name in ("normal_force", "map_normal_force", "surface_moment"):
        over = "map_time" if name.startswith("map") else "time"
        assert "contact" not in run[name].dims
        np.testing.assert_array_equal(np.concatenate([first[name], rest[name]]), run[name])
        np.testing.assert_allclose(np.concatenate([first[over], rest[over]]), run[over])
    scenario = st.load_scenario(run)
    again = scenario.simulate()
    np.testing.assert_array_equal(again.normal_force, run.normal_force)
    np.testing.assert_array_equal(again.map_status, run.map_status)
    # The system of a record has no mesh, but the areas and places of its points.
    np.testing.assert_allclose(again.surface_moment, run.surface_moment, rtol=1e-12, atol=1e-15)
    (face,) = scenario.system.faces
    assert analysis.surface(run, face).identical(analysis.surface(run, SOLE))
    assert short.nbytes < whole.nbytes


@pytest.mark.parametrize("rate", [MAPS, None], ids=["maps", "usual"])
def test_an_interrupted_record_is_complete(both, monkeypatch, rate):
    """After some chunks, and before the first."""
    whole, _ = both
    every = round(RATE / (rate or 1e3))
    given, stopped = system(), {}
    known = st.simulate(given, 4e-3, surface_rate=rate, **WORDS)
    for name, chunk in (("some", 7), ("none", 0)):
        monkeypatch.setattr(together, "STEPS_PER_CHUNK", chunk * round(1 / (RATE * whole.attrs["step"])))
        monkeypatch.setattr(together, "SAMPLES_PER_CHUNK", chunk)
        if not chunk:
            monkeypatch.setattr(together, "DeferredInterrupt", lambda: nullcontext(SimpleNamespace(requested=True)))
        with pytest.raises(st.Interrupted) as caught:
            st.simulate(given, 4e-3, surface_rate=rate, watchers=[interrupt], **WORDS)
        stopped[name] = caught.value.record
    count = stopped["some"].sizes["time"]
    assert 0 < count < known.sizes["time"]
    np.testing.assert_array_equal(stopped["some"].surface_force, known.surface_force[:count])
    assert stopped["some"].sizes["map_time"] == count // every
    assert stopped["none"].surface_force.shape == (0, 1, 3)
    assert stopped["none"].map_normal_force.shape == (0, 4)
    if rate is None:
        np.testing.assert_array_equal(stopped["some"].point_normal_force, known.point_normal_force[:count])
        assert stopped["none"].point_tangential_force.shape == (0, 4, 2)


def test_a_record_of_maps_has_no_sound(both, pair):
    _, short = both
    with pytest.raises(st.ArgumentError, match="a record of maps alone: leave surface_rate out"):
        st.radiate(short, pair, (0.0, 1.0, 0.0))


def test_the_usual_record_sounds_as_all_points_do(both, usual, pair):
    whole, _ = both
    wrong = usual.assign(point_normal_force=1.001 * usual.point_normal_force)
    # Sound is linear in these.
    moved = [redriven(one, pair) for one in (whole, usual, wrong)]
    known, found, other = (one.accelerations(np.arange(one.given.flat.mode_count)) for one in moved)
    assert known.std() > 0.0
    assert np.abs(found - known).max() < 1e-6 * np.abs(known).max()
    assert np.abs(other - known).max() > 1e-5 * np.abs(known).max()


def test_the_usual_record_has_the_points_in_fewer_digits(both, usual, tmp_path):
    whole, short = both
    of_points = [one for one in whole.isel(contact=whole.surface == "sole").data_vars.values() if "contact" in one.dims]
    kept = sum(one.nbytes for name, one in usual.data_vars.items() if name.startswith("point_"))
    assert kept < 0.2 * sum(one.nbytes for one in of_points)
    for name in short.data_vars:
        if not name.startswith("map_"):
            np.testing.assert_array_equal(usual[name], short[name], err_msg=name)
    points = by_point(usual)
    assert points.contact.values.tolist() == whole.contact.values.tolist()
    assert points.surface.values.tolist() == whole.surface.values.tolist()
    for name, digits in (("normal_force", 1e-6), ("tangential_force", 1e-6), ("status_share", 4e-3), ("landings", 0.0)):
        largest = float(np.abs(whole[name]).max())
        np.testing.assert_allclose(points[name], whole[name], rtol=0.0, atol=digits * largest, err_msg=name)
        assert points[name].dims == whole[name].dims
    assert by_point(whole) is whole
    assert by_point(short) is short
    assert by_point(usual.sel(contact=["sole"])).contact.values.tolist() == [one.name for one in SOLE.contacts]
    st.save(usual, tmp_path / "usual.nc")
    assert st.load(tmp_path / "usual.nc").identical(usual)
    st.export(usual, tmp_path / "usual.mat")


def test_regimes_and_fields_of_the_usual_record_are_those_of_all_points(both, usual):
    whole, _ = both
    known, found = st.regime(whole), st.regime(usual)
    for name in known.data_vars:
        if name != "regime":
            np.testing.assert_allclose(found[name], known[name], rtol=0.02, err_msg=name)
    assert found.regime.item() == known.regime.item()
    assert (
        st.regime(usual.isel(contact=usual.surface == "sole")).impact_rate
        == st.regime(whole.isel(contact=whole.surface == "sole")).impact_rate
    )
    face, all_points = analysis.surface(usual, SOLE), analysis.surface(whole, SOLE)
    assert {str(face[name].dims[0]) for name in ("pressure", "shear", "status_share", "force")} == {"time"}
    assert face.slip_velocity.dims[0] == "map_time"
    np.testing.assert_allclose(face.pressure, all_points.pressure, atol=1e-6 * float(all_points.pressure.max()))
    for quantity in QUANTITIES:
        plot.surface(face, quantity)


def test_shares_are_counted_so_that_none_and_all_are_exact():
    share = np.array([0.0, 1e-12, 1e-4, 0.5, 1.0 - 1e-4, 1.0 - 1e-12, 1.0])
    np.testing.assert_array_equal(counted(share), [0, 0, 1, 128, 254, 255, 255])


def test_a_record_says_how_its_surfaces_were_recorded(both, usual):
    whole, short = both
    assert [st.load_scenario(run).surface_rate for run in (whole, short, usual)] == ["all", MAPS, None]
    again = st.load_scenario(usual).simulate()
    np.testing.assert_array_equal(again.point_normal_force, usual.point_normal_force)
    np.testing.assert_allclose(again.surface_force, usual.surface_force, rtol=1e-12, atol=1e-12)


def test_many_runs_record_surfaces_as_one_does(both, usual, pair):
    for rate, known in (("all", both[0]), (MAPS, both[1]), (None, usual)):
        (found,) = st.simulate_many([pair], 8.2e-3, surface_rate=rate, **WORDS)
        assert set(found.variables) == set(known.variables)
        np.testing.assert_array_equal(found.normal_force, known.normal_force)
        (plain,) = st.simulate_many([pair], 8.2e-3, surface_rate=rate, labelled=False, **WORDS)
        assert list(plain.contacts) == (both[1] if rate == MAPS else both[0]).contact.values.tolist()
        assert analysis.regime_of(plain)["regime"] == str(st.regime(known).regime.item())
    scenario = replace(st.load_scenario(usual), surface_rate=MAPS)
    asked = pair, {"duration": 8.2e-3, "surface_rate": MAPS}
    for made in (scenario, asked):
        swept = st.sweep(lambda _, made=made: made, {"_": [0.0]}, {"maps": lambda run: run.sizes["map_time"]})
        assert swept.maps.item() == both[1].sizes["map_time"]
    kept = {"points": lambda run: float("point_normal_force" in run), "contacts": lambda run: run.sizes["contact"]}
    for rate, known in ((None, [1.0, 2.0]), ("all", [0.0, 5.0])):
        measured = st.ensemble(pair, 1e-3, kept, runs=2, surface_rate=rate, **WORDS)
        assert [float(measured[name][0]) for name in kept] == known


def test_bad_arguments_are_refused():
    mass = st.RigidBody(1.0)
    alone = st.System(st.PointContact(mass.centre, st.RigidTrack()), [st.Gravity()])
    for given, rate, words in (
        (alone, 1e3, "surface_rate must be left out without surfaces in contact"),
        (system(), 0.0, "surface_rate must be"),
        (system(), 3e4, "surface_rate must be at most the sample rate"),
        (system(), "points", "surface_rate must be a rate in Hz or 'all', got 'points'"),
    ):
        with pytest.raises(st.ArgumentError, match=words):
            st.simulate(given, 1e-3, surface_rate=rate, **WORDS)
    with pytest.raises(st.ArgumentError, match="area must be left out except at a point of a surface"):
        st.PointContact(mass.centre, st.RigidTrack(), area=1e-4)
