"""Surfaces recorded in short: what is left is what all points come to."""

from __future__ import annotations

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

import stridula as st
from stridula import analysis, plot
from stridula.contact.resultants import RESULTANTS
from stridula.integration import together
from stridula.records.by_surface import by_surface

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
def both():
    """The same run with all points and in short, with a point beside the face."""
    shoe = st.RigidBody(mass=0.1, name="shoe")
    heel = st.PointContact(
        shoe.centre, st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.3), normal=(0, 1, 0), name="heel"
    )
    given = system(heel)
    return st.simulate(given, 8.2e-3, **WORDS), st.simulate(given, 8.2e-3, surface_rate=MAPS, **WORDS)


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


def test_regime_figures_and_files_know_it(both, tmp_path):
    _, short = both
    st.save(short, tmp_path / "short.nc")
    loaded = st.load(tmp_path / "short.nc")
    assert loaded.identical(short)
    assert str(st.regime(short).regime.item())
    plot.surface(analysis.surface(loaded, SOLE), "status")
    plot.overview(short)
    st.export(short, tmp_path / "short.csv")
    assert float(st.compare(short, short).attrs["within_tolerance"]) == 1


def test_it_goes_on_and_runs_again(both):
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
    # The record has points alone: no areas, and no resultants.
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(again.normal_force, run.normal_force)
    np.testing.assert_array_equal(again.map_status, run.map_status)
    assert "surface_force" not in again
    assert short.nbytes < whole.nbytes


def test_what_an_interrupt_leaves_is_whole(both, monkeypatch):
    """After some chunks, and before the first."""
    whole, _ = both
    given, stopped = system(), {}
    known = st.simulate(given, 4e-3, surface_rate=MAPS, **WORDS)
    for name, chunk in (("some", 7), ("none", 0)):
        monkeypatch.setattr(together, "STEPS_PER_CHUNK", chunk * round(1 / (RATE * whole.attrs["step"])))
        monkeypatch.setattr(together, "SAMPLES_PER_CHUNK", chunk)
        if not chunk:
            monkeypatch.setattr(together, "DeferredInterrupt", lambda: nullcontext(SimpleNamespace(requested=True)))
        with pytest.raises(st.Interrupted) as caught:
            st.simulate(given, 4e-3, surface_rate=MAPS, watchers=[interrupt], **WORDS)
        stopped[name] = caught.value.record
    count = stopped["some"].sizes["time"]
    assert 0 < count < known.sizes["time"]
    np.testing.assert_array_equal(stopped["some"].surface_force, known.surface_force[:count])
    assert stopped["some"].sizes["map_time"] == count // round(RATE / MAPS)
    assert stopped["none"].surface_force.shape == (0, 1, 3)
    assert stopped["none"].map_normal_force.shape == (0, 4)


def test_sound_needs_all_points(both):
    _, short = both
    with pytest.raises(st.ArgumentError, match="a record with a surface_rate: record it without"):
        st.radiate(short, system(), (0.0, 1.0, 0.0))


def test_what_is_refused():
    mass = st.RigidBody(1.0)
    alone = st.System(st.PointContact(mass.centre, st.RigidTrack()), [st.Gravity()])
    for given, rate, words in (
        (alone, 1e3, "surface_rate must be left out without surfaces in contact"),
        (system(), 0.0, "surface_rate must be"),
        (system(), 3e4, "surface_rate must be at most the sample rate"),
    ):
        with pytest.raises(st.ArgumentError, match=words):
            st.simulate(given, 1e-3, surface_rate=rate, **WORDS)
