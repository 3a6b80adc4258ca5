"""Sweeps: points and their order, measures, files on disk and resuming."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.studies import measures as table
from stridula.studies import sweeps
from stridula.studies.points import laid_out

FORCES = ["mean_force", "shares"]
SHORT = {"duration": "2 ms"}
GRID = st.Grid({"friction": np.linspace(0.2, 2.0, 9), "angle": [f"{angle} deg" for angle in range(10, 90, 5)]})


@pytest.fixture(autouse=True)
def in_an_empty_folder(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_grid_has_a_dimension_for_each_key_in_the_order_given():
    grid = st.Grid({"friction": [0.3, 0.6], "angle": ["10 deg", "20 deg", "30 deg"], "root_support": ["guided"]})
    found = st.sweep("squeal", grid, FORCES, **SHORT)
    assert found["mean_force"].dims == ("friction", "angle", "root_support")
    assert found["friction"].values.tolist() == [0.3, 0.6]
    assert found["angle"].values.tolist() == [10.0, 20.0, 30.0]
    assert found["root_support"].values.tolist() == ["guided"]
    assert (found["angle"].attrs["units"], found["friction"].attrs["units"]) == ("deg", "1")
    assert found["angle"].attrs["key"] == "slider.angle"
    assert found["angle"].attrs["long_name"].startswith("angle from the track's normal")
    one = {"friction": 0.6, "angle": "20 deg", "duration": "2 ms", "sample_rate": 20e3, "probes": []}
    alone = st.load_scenario("squeal", one).simulate()
    there = found.sel(friction=0.6, angle=20.0, root_support="guided")
    assert float(there["mean_force"]) == pytest.approx(float(alone["normal_force"].mean()), rel=1e-6)
    assert set(found["ended"].values.ravel()) == {"finished"}
    assert set(found["message"].values.ravel()) == {""}
    shares = [float(there[f"{status}_share"]) for status in ("separated", "sticking", "sliding")]
    assert sum(shares) == pytest.approx(1.0)


def test_a_list_has_the_dimension_point_and_a_coordinate_for_each_key():
    points = [{"friction": 0.3, "length": "50 cm"}, {"friction": 0.9, "length": 0.6}]
    points = [{key.replace("length", "slider.length"): value for key, value in point.items()} for point in points]
    found = st.sweep("squeal", points, "travel", **SHORT)
    assert found["travel"].dims == ("point",)
    assert found["friction"].values.tolist() == [0.3, 0.9]
    # Values in two units both become SI.
    assert found["slider.length"].values.tolist() == [0.5, 0.6]
    assert found["slider.length"].attrs["units"] == "m"
    assert set(found.coords) == {"point", "friction", "slider.length"}


def test_a_latin_hypercube_has_one_point_in_each_strip():
    cube = st.LatinHypercube({"friction": (0.2, 2.0), "angle": ("10 deg", "80 deg")}, count=20, seed=3)
    layout = laid_out(cube)
    friction, angle = zip(*layout.values, strict=True)
    degrees = np.array([float(text.removesuffix(" deg")) for text in angle])
    for values, low, high in ((np.array(friction), 0.2, 2.0), (degrees, 10.0, 80.0)):
        assert sorted(np.floor((values - low) / (high - low) * 20).astype(int)) == list(range(20))
    assert laid_out(st.LatinHypercube(cube.ranges, 20, 3)).values == layout.values
    assert laid_out(st.LatinHypercube(cube.ranges, 20, 4)).values != layout.values
    found = st.sweep("squeal", cube, "mean_force", **SHORT)
    assert found["angle"].attrs["units"] == "deg"
    np.testing.assert_array_equal(found["angle"], degrees)


def test_a_law_and_its_parameters_vary_together():
    points = [{"law": "coulomb", "coefficient": 0.4}, {"law": "static-kinetic", "coefficient": 0.4}]
    found = st.sweep("squeal", points, "mean_force", **SHORT)
    assert found["law"].values.tolist() == ["coulomb", "static-kinetic"]
    assert found["ended"].values.tolist() == ["finished", "not built"]
    assert "static must be given" in str(found["message"][1].item())


def test_points_may_change_whole_numbers_duration_and_sampling():
    """Other duration, step and sampling: such points do not run side by side."""
    grid = st.Grid({"elements": [4.0, 5.0], "simulation.duration": [1e-3, 2e-3]})
    found = st.sweep("squeal", grid, {"samples": lambda run: run.sizes["time"]}, sample_rate="50 kHz")
    assert found["samples"].values.tolist() == [[50.0, 100.0]] * 2
    assert found["elements"].dtype.kind == "i"


def test_records_are_sampled_at_20_khz_and_have_probes_for_functions_only(monkeypatch):
    seen = []
    for rate, overrides in ((None, {}), ("10 kHz", {}), (None, {"sample_rate": "40 kHz"})):
        look = {"look": lambda run: seen.append((run.sizes["time"], "acceleration" in run)) or 0.0}
        st.sweep("squeal", [{"friction": 0.3}], look, sample_rate=rate, overrides=overrides, **SHORT)
    st.sweep("squeal", [{"friction": 0.3}], look, probes=False, **SHORT)
    assert seen == [(40, True), (20, True), (80, True), (40, False)]
    monkeypatch.setitem(table.MEASURES, "look", table.Measure("look", (table.Column("y", "1", "y"),), _probed))
    assert float(st.sweep("squeal", [{"friction": 0.3}], "look", **SHORT)["y"][0]) == 0.0


def _probed(run):
    return {"y": float("acceleration" in run)}


def test_functions_return_numbers_or_words_and_their_failures_are_those_of_the_point():
    def fails_above_half(run):
        coefficient = st.load_scenario(run).system.contact.friction.coefficient
        if coefficient > 0.5:
            raise KeyError("too much")
        return run["normal_force"].max()

    measures = [{"peak": fails_above_half, "word": lambda run: "good"}, "travel"]
    found = st.sweep("squeal", st.Grid({"friction": [0.3, 0.8]}), measures, **SHORT)
    assert np.isnan(found["peak"].values).tolist() == [False, True]
    assert found["word"].values.tolist() == ["good", ""]
    assert found["ended"].values.tolist() == ["finished", "not measured"]
    assert found["message"].values.tolist() == ["", "measure 'peak': KeyError: 'too much'"]
    assert set(found["travel"].attrs) == {"units", "long_name"}
    bad = st.sweep("squeal", [{"friction": 0.3}], {"bad": lambda run: [1, 2]}, **SHORT)
    assert bad["message"].item() == "measure 'bad': must return a number or a text, got a list"


MASS = table.Measure(
    "mass",
    (table.Column("mass", "kg", "mass of the slider"), table.Column("size", "", "how heavy", is_text=True)),
    of_system=lambda system: {"mass": system.slider.total_mass, "size": "light"},
)


def test_measures_of_the_system_need_no_run(monkeypatch):
    monkeypatch.setitem(table.MEASURES, "mass", MASS)
    monkeypatch.setattr("stridula.studies.task.simulate_many", lambda *args, **kwargs: pytest.fail("it ran"))
    found = st.sweep("squeal", st.Grid({"slider.length": [0.5, -1.0, 1.0]}), "mass")
    assert found["mass"].values[2] == pytest.approx(2.0 * found["mass"].values[0])
    assert found["ended"].values.tolist() == ["not simulated", "not built", "not simulated"]
    assert found["size"].values.tolist() == ["light", "", "light"]


def test_stability_is_that_of_linear_theory_at_each_point():
    found = st.sweep("weak-pressure", st.Grid({"friction": [0.3, 1.2, 2.0]}), "stability")
    assert found["equilibrium"].values.tolist() == ["sliding", "sliding", "jammed"]
    assert found["equilibria"].values.tolist() == ["one", "one", "one"]
    for friction in (0.3, 1.2):
        modes = st.sliding_stability(st.load_scenario("weak-pressure", {"friction": friction}).system)
        there = found.sel(friction=friction)
        assert float(there["growth_rate"]) == pytest.approx(float(modes["growth_rate"].max()), rel=1e-6)
        assert int(there["unstable_modes"]) == int(modes["unstable"].sum())
    fastest = modes.isel(mode=int(modes["growth_rate"].values.argmax()))
    assert float(found.sel(friction=1.2)["flutter_frequency"]) == pytest.approx(float(fastest["frequency"]), rel=1e-6)
    assert np.isnan(found.sel(friction=2.0)["unstable_modes"])


def test_held_contacts_have_no_growth():
    found = st.sweep("squeal", [{"friction": 1.5}], "stability").isel(point=0)
    assert (found["equilibrium"].item(), int(found["unstable_modes"])) == ("held", 0)
    assert np.isnan(found["growth_rate"])


def test_a_measure_brings_those_that_belong_to_it(monkeypatch):
    monkeypatch.setitem(table.MEASURES, "mass", MASS)
    both = table.Measure("both", (table.Column("y", "1", "y"),), _probed, also=("mass",))
    monkeypatch.setitem(table.MEASURES, "both", both)
    found = st.sweep("squeal", [{"friction": 0.3}], ["both", "mass"], **SHORT)
    assert {"y", "mass", "size"} <= set(found)
    assert found["ended"].item() == "finished"


def test_failing_points_are_kept_with_their_message_and_the_others_continue():
    """Not built, overlapping at the start, blown up by its drive; each as in a run alone."""
    points = [
        {"friction": 0.3, "angle": "20 deg", "transverse": 3.0},
        {"friction": 0.3, "angle": "95 deg", "transverse": 3.0},
        {"friction": -0.3, "angle": "20 deg", "transverse": 3.0},
        {"friction": 0.3, "angle": "20 deg", "transverse": 1e300},
    ]
    found = st.sweep("squeal", points, "mean_force", **SHORT)
    assert found["ended"].values.tolist() == ["finished", "not built", "not built", "not finite"]
    messages = found["message"].values.tolist()
    assert "slider.angle must be strictly between" in messages[1]
    assert "coefficient must be 0 or above, got -0.3" in messages[2]
    assert "no longer finite" in messages[3]
    assert all("\n" not in message for message in messages)
    assert np.isnan(found["mean_force"].values).tolist() == [False, True, True, True]
    mass = 'title = "Mass"\n[bodies.mass]\nkind = "point mass"\nmass = 1\n[[contacts]]\ntip = { body = "mass" }\n'
    drive = '[[drives]]\nkind = "initial state"\nbody = "mass"\ndisplacement = [0, 0]\n[simulation]\nduration = 0.01\n'
    Path("mass.toml").write_text(f'{mass}track = {{ kind = "rigid" }}\n{drive}')
    points = [{"displacement": [0.0, 0.0]}, {"displacement": [0.0, -1e-3]}]
    found = st.sweep("mass.toml", points, "mean_force")
    assert found["ended"].values.tolist() == ["finished", "not started"]
    assert "overlap" in found["message"].values[1]


def complete(path, grid=GRID, **options) -> bytes:
    st.sweep("squeal", grid, FORCES, out=path, **(SHORT | options))
    assert not os.path.exists(f"{path}.parts")
    return Path(path).read_bytes()


def stop_after(count):
    """Interrupt a sweep after some parts."""
    seen = []

    def watch(progress):
        seen.append(progress)
        if len(seen) == count:
            raise KeyboardInterrupt

    return watch


def test_the_file_has_the_same_bytes_for_any_workers_and_interruptions(tmp_path):
    one = complete("one.nc", workers=1)
    assert complete("two.nc", workers=3) == one
    with pytest.raises(KeyboardInterrupt):
        complete("stopped.nc", watchers=[stop_after(1)])
    assert names(tmp_path / "stopped.nc.parts")[-1] == "sweep.json"
    assert len(names(tmp_path / "stopped.nc.parts")) == 2
    seen = []
    assert complete("stopped.nc", watchers=[seen.append]) == one
    assert seen[0].done in (16, 64)
    assert seen[-1].done == seen[-1].points == 144
    with pytest.raises(KeyboardInterrupt):
        complete("lost.nc", watchers=[stop_after(3)])
    (tmp_path / "lost.nc.parts" / "000001.json").unlink()
    (tmp_path / "lost.nc.parts" / "000002.json").write_text("[{")
    (tmp_path / "lost.nc.parts" / ".stridula-1-2.part").write_text("half")
    assert complete("lost.nc") == one
    assert names(tmp_path) == ["lost.nc", "one.nc", "stopped.nc", "two.nc"]


def test_a_complete_sweep_is_returned_as_it_is(monkeypatch, tmp_path):
    first = st.sweep("squeal", GRID, FORCES, out="map.nc", **SHORT)
    (tmp_path / "map.nc.parts").mkdir()
    monkeypatch.setattr("stridula.studies.task.simulate_many", lambda *args, **kwargs: pytest.fail("it ran"))
    before = (tmp_path / "map.nc").read_bytes()
    xr.testing.assert_identical(st.sweep("squeal", GRID, FORCES, out="map.nc", **SHORT), first)
    assert ((tmp_path / "map.nc").read_bytes(), names(tmp_path)) == (before, ["map.nc"])
    xr.testing.assert_identical(st.load("map.nc"), first)
    assert st.load_scenario("map.nc").duration == 2e-3
    wanted = json.loads(first.attrs["sweep"])
    assert wanted["points"]["grid"]["angle"][0] == "10 deg"
    assert wanted["measures"] == FORCES
    assert (wanted["duration"], wanted["sample_rate"]) == ("2 ms", None)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"points": st.Grid({"friction": [0.3]})}, "other points or options"),
        ({"measures": "travel"}, "other points or options"),
        ({"sample_rate": 1e4}, "another scenario and other points or options"),
        ({"scenario": "judder", "points": [{"friction": 0.3}]}, "another scenario"),
    ],
)
@pytest.mark.parametrize("place", ["file", "parts"])
def test_another_sweep_is_not_touched(tmp_path, place, options, words):
    points = [{"friction": 0.3}, {"friction": 0.4}]
    stop = [stop_after(1)] if place == "parts" else []
    try:
        st.sweep("squeal", points, FORCES, out="map.nc", watchers=stop, **SHORT)
    except KeyboardInterrupt:
        assert place == "parts"
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    given = {"scenario": "squeal", "points": points, "measures": FORCES, **SHORT} | options
    with pytest.raises(ValueError, match=words):
        st.sweep(**given, out="map.nc")
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_other_files_are_not_touched(tmp_path):
    st.save(st.load_scenario("squeal", {"duration": "1 ms"}).simulate(), "run.nc")
    (tmp_path / "text.nc").write_text("mine")
    (tmp_path / "folder.nc.parts").mkdir()
    (tmp_path / "folder.nc.parts" / "mine.txt").write_text("mine")
    (tmp_path / "file.nc.parts").write_text("mine")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    for out, words in (
        ("run.nc", "another file"),
        ("text.nc", "another file"),
        ("folder.nc", "must hold parts of this sweep"),
        ("file.nc", "must be free for the parts"),
    ):
        with pytest.raises(ValueError, match=words):
            st.sweep("squeal", [{"friction": 0.3}], FORCES, out=out, **SHORT)
    for out in ("none/map.nc", "."):
        with pytest.raises(OSError, match="cannot write"):
            st.sweep("squeal", [{"friction": 0.3}], FORCES, out=out, **SHORT)
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


KILLED = """
import os, signal, sys
import numpy as np
import stridula as st
from unit.test_sweep import FORCES, GRID, SHORT
def die(progress):
    os.kill(os.getpid(), signal.SIGKILL)
st.sweep("squeal", GRID, FORCES, out="map.nc", watchers=[die], **SHORT)
"""


def test_a_killed_process_leaves_a_sweep_that_can_be_resumed(tmp_path):
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", KILLED], env=environment, capture_output=True, text=True)
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert len([name for name in names(tmp_path / "map.nc.parts") if name[0].isdigit()]) == 1
    assert complete("map.nc") == complete("whole.nc")


def test_a_full_disk_keeps_the_parts(monkeypatch, tmp_path):
    def full(*args):
        raise OSError(28, "no space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("stridula.studies.parts.save", full)
        with pytest.raises(OSError, match="no space"):
            complete("map.nc")
    assert len(names(tmp_path / "map.nc.parts")) == 4
    seen = []
    complete("map.nc", watchers=[seen.append])
    assert [progress.done for progress in seen] == [144]


def test_two_processes_may_compute_the_same_sweep(tmp_path):
    """Another process completes the sweep and removes the parts while this one runs."""

    def other_completes(progress):
        if progress.done < 144 and not (tmp_path / "map.nc").exists():
            complete("map.nc")

    assert complete("map.nc", watchers=[other_completes]) == complete("whole.nc")


REDUCED = """
title = "Pad"
[bodies.pad]
kind = "reduced"
file = "pad.npz"
[bodies.block]
kind = "point mass"
mass = 2.0
[[contacts]]
tip = { body = "pad", point = "tip" }
track = { kind = "rigid", velocity = 0.1 }
friction = 0.3
[[connections]]
kind = "spring"
first = { body = "pad", point = "tip" }
second = { body = "block" }
stiffness = 1e4
[[drives]]
kind = "force"
body = "pad"
point = "tip"
y = -50
[simulation]
duration = "2 ms"
"""


def test_the_matrices_of_reduced_bodies_are_kept_with_the_sweep(tmp_path):
    (tmp_path / "pad.toml").write_text(REDUCED)
    stiffness = np.array([[4e5, -1e5], [-1e5, 4e5]])
    st.ReducedBody(np.eye(2) * 0.1, stiffness, {"tip": (0, 1)}).save("pad.npz")
    # The key mass means that of the point mass, as in the file, also where matrices stand in their place.
    points = [{"mass": 1.0, "friction": 0.2}, {"mass": 2.0, "friction": 0.2}]
    found = st.sweep("pad.toml", points, "mean_force", out="map.nc")
    assert found["message"].values.tolist() == ["", ""]
    with pytest.raises(ValueError, match="matrices are read once"):
        st.sweep("pad.toml", [{"bodies.pad.file": "other.npz"}], "mean_force")
    st.ReducedBody(np.eye(2) * 0.2, stiffness, {"tip": (0, 1)}).save("pad.npz")
    with pytest.raises(ValueError, match="another scenario"):
        st.sweep("pad.toml", points, "mean_force", out="map.nc")
    (tmp_path / "pad.npz").unlink()
    points = [{"bodies.block.mass": point["mass"], "friction": point["friction"]} for point in points]
    again = st.sweep("map.nc", points, "mean_force")
    np.testing.assert_array_equal(again["mean_force"], found["mean_force"])


BAD = [
    ({"points": st.Grid({"frction": [1]})}, "did you mean 'friction'?"),
    ({"points": st.Grid({"length": [1]})}, "key must name one place, got 'length', which fits"),
    ({"points": st.Grid({"friction": [1], "contact.friction.coefficient": [1]})}, "which both mean contact.friction"),
    ({"points": st.Grid({"friction": [1]}), "overrides": {"coefficient": 1}}, "key must be set or varied, got both"),
    ({"points": st.Grid({"angle": ["10 deg", "10 N"]})}, "slider.angle must be a number in rad or deg, got '10 N'"),
    ({"points": st.Grid({"elements": [4, 4.5]})}, "slider.elements must be a whole number, got 4.5"),
    ({"points": st.Grid({"root_support": ["clampd"]})}, "did you mean 'clamped'?"),
    ({"points": [{"friction": "nan"}]}, "must be finite"),
    ({"points": [{"elements": 10**400}]}, "elements must be finite, got an int"),
    ({"points": [{"friction": 1}, {"angle": 1}]}, r"points\[1\] must have the keys of points\[0\]"),
    ({"points": []}, "points must hold at least one point"),
    ({"points": "friction"}, "points must be a Grid"),
    ({"points": [{"drives.0.transverse": 1, "message": 1}]}, "key must not have the name"),
    ({"measures": "regim"}, "did you mean 'regime'?"),
    ({"measures": []}, "measures must be names"),
    ({"measures": {"ended": len}}, "measures must have names other than"),
    ({"measures": ["shares", {"sliding_share": len}]}, "measures must have names other than"),
    ({"measures": {"a": 1}}, "functions of a record by name"),
    ({"workers": 0}, "workers must be at least 1"),
    ({"client": 3}, "client must be a client of dask.distributed"),
    ({"watchers": 3}, "watchers must be a list"),
    ({"duration": -1}, "simulation.duration must be above 0"),
    ({"overrides": {"frction": 1}}, "did you mean 'friction'?"),
    ({"scenario": "sqeal"}, "did you mean 'squeal'?"),
    ({"scenario": "squeal", "overrides": {"gap": -1}}, "contact.gap must be 0 or above"),
]


@pytest.mark.parametrize(("options", "message"), BAD, ids=[message for _, message in BAD])
def test_bad_arguments_are_one_line_and_nothing_is_written(tmp_path, options, message):
    given = {"scenario": "squeal", "points": [{"friction": 0.3}], "measures": FORCES, "out": "map.nc"} | options
    with pytest.raises(ValueError, match=message) as error:
        st.sweep(**given)
    assert "\n" not in str(error.value)
    assert names(tmp_path) == []


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: st.Grid({}), "values must be lists"),
        (lambda: st.Grid({"friction": []}), "must hold at least one value"),
        (lambda: st.Grid({"friction": 0.3}), "must be a list of values"),
        (lambda: st.Grid({"friction": [0.1, np.inf]}), "friction must be finite, got inf"),
        (lambda: st.Grid({"friction": [0.1, 10**400]}), "friction must be finite"),
        (lambda: st.Grid({"": [1]}), "key must be a text"),
        (lambda: st.LatinHypercube({"friction": (2.0, 0.2)}, 3), "high must be above low"),
        (lambda: st.LatinHypercube({"angle": ("1 deg", 0.2)}, 3), "high must be in the unit of low"),
        (lambda: st.LatinHypercube({"law": ("coulomb", "lugre")}, 3), "low must be a number"),
        (lambda: st.LatinHypercube({"friction": (0.1, 0.2, 3)}, 3), "must be a Range or its two ends"),
        (lambda: st.LatinHypercube({"friction": (0.1, 0.2)}, 0), "count must be at least 1"),
        (lambda: st.LatinHypercube({}, 3), "ranges must be ranges by key"),
    ],
)
def test_bad_points_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_several_machines_give_the_same_bytes_and_a_lost_one_is_reported():
    with warnings.catch_warnings():
        # Warnings of dask's own start and end are ignored.
        warnings.simplefilter("ignore")
        distributed = pytest.importorskip("distributed")
        options = {"dashboard_address": None, "processes": True, "silence_logs": 50}
        # Not tried again on three others first.
        at_once = pytest.importorskip("dask").config.set({"distributed.scheduler.allowed-failures": 0})
        with (
            at_once,
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, **options) as cluster,
            distributed.Client(cluster) as client,
        ):
            seen = []
            there = complete("there.nc", client=client, watchers=[seen.append])
            function = {"peak": lambda run: float(run["normal_force"].max())}
            peaks = st.sweep("squeal", [{"friction": 0.3}], function, client=client, **SHORT)
            with pytest.raises(RuntimeError, match="failed on other machines") as error:
                st.sweep("squeal", [{"friction": 0.3}], {"x": _die}, client=client, **SHORT)
    assert there == complete("here.nc")
    assert seen[-1].done == 144
    assert float(peaks["peak"][0]) == float(st.sweep("squeal", [{"friction": 0.3}], function, **SHORT)["peak"][0])
    assert "\n" not in str(error.value)


def _die(run):
    os._exit(1)


def test_ctrl_c_stops_threads_at_once():
    """The second part would take a minute or more; compilation of the first one is done before."""

    def interrupt(progress):
        raise KeyboardInterrupt

    frictions = enumerate(np.linspace(0.1, 1.0, 128))
    points = [{"friction": value, "duration": 1e-3 if number < 64 else 100.0} for number, value in frictions]
    st.sweep("squeal", points[:64], "mean_force", workers=2)
    began = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        st.sweep("squeal", points, "mean_force", watchers=[interrupt], workers=2)
    assert time.perf_counter() - began < 20.0
    assert sweeps.POINTS_OF_A_PART == 64
