"""Arguments of the wrong kind or size: refused in one line, before any computation."""

from __future__ import annotations

import os
import subprocess
import sys
import time
import tracemalloc
import zipfile

import numpy as np
import pytest
import scipy.io
import scipy.sparse

import stridula as st
from stridula import analysis, plot
from stridula.checks import brief, by_key, count, finite, in_one_line, suggestion
from stridula.ordinary import MOST_MODES

STEEL, STRIP = st.Material(2.1e11, 7800.0), st.Rectangle(0.02, 0.008)


@pytest.fixture(scope="module", name="run")
def run_():
    return st.load_scenario("squeal").simulate(duration=0.01)


def refused(call, pattern, kind=ValueError):
    with pytest.raises(kind, match=pattern) as caught:
        call()
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400
    return str(caught.value)


# Many problems, and long ones.


@pytest.mark.parametrize("place", ["", "[contact]\n"])
def test_many_unknown_keys_are_shortened_with_a_count(tmp_path, place):
    keys = "\n".join(f"key{k} = {k}" for k in range(20_000))
    (tmp_path / "case.toml").write_text(f'base = "squeal"\n{place}{keys}\n')
    began = time.perf_counter()
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario(tmp_path / "case.toml")
    assert time.perf_counter() - began < 5.0
    assert len(caught.value.problems) == 21
    assert "key0 = 0" in caught.value.problems[0]
    assert caught.value.problems[-1] == "19980 other problems"
    assert len(str(caught.value)) < 2000
    assert str(caught.value).endswith("other problems")


def test_few_problems_are_all_reported():
    assert st.ScenarioError(["a", "b", "a"]).problems == ("a", "b")
    assert str(st.ScenarioError(["a\nb", "c"])) == "a b; c"
    assert st.ScenarioError([str(k) for k in range(21)]).problems[-1] == "1 other problem"
    long = st.ScenarioError(["x" * 400] * 2 + [f"{k}" + "y" * 490 for k in range(9)], others=5)
    assert str(long).endswith("; 12 other problems")
    assert len(str(long)) < 2000


def test_many_bad_keys_are_refused_quickly():
    began = time.perf_counter()
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario("squeal", {f"key{k}": 1 for k in range(5000)})
    assert time.perf_counter() - began < 5.0
    assert len(caught.value.problems) == 20
    assert caught.value.problems[-1] == "keys must be valid before others are checked; 4981 were not checked"


def test_the_number_of_bodies_is_limited(tmp_path):
    tables = "".join(f'[bodies.b{k}]\nkind = "point mass"\nmass = 1.0\n' for k in range(3000))
    (tmp_path / "case.toml").write_text(
        f"{tables}[[contacts]]\ntip = {{ body = 'b0' }}\ntrack = {{ kind = 'rigid' }}\n"
    )
    with pytest.raises(st.ScenarioError, match="bodies must hold at most 1000, got 3000"):
        st.load_scenario(tmp_path / "case.toml")


def test_values_are_cut_in_messages(tmp_path):
    long = "x" * 3000
    refused(lambda: st.load_scenario("squeal", {long: 1}), r"^key must be .*, got 'xxx.*\.\.\.$", st.ScenarioError)
    refused(lambda: st.load_scenario("squeal", {"law": long}), r"got 'xxx.*\.\.\.$", st.ScenarioError)
    refused(lambda: st.load_scenario("squeal", {"coefficient": 10**5000}), "must be finite", st.ScenarioError)
    (tmp_path / "case.toml").write_text(f'base = "squeal"\n[contact]\n{long} = 1\n')
    refused(lambda: st.load_scenario(tmp_path / "case.toml"), "one of the known keys", st.ScenarioError)
    refused(lambda: st.load("y" * 3000), r"^cannot read '\.\.\.y+': file name too long$", OSError)
    refused(lambda: st.save(st.load_scenario("squeal").simulate(duration=1e-4), "y" * 3000), "name too long", OSError)


def test_values_that_are_not_numbers_are_named_by_their_type(run):
    assert refused(lambda: finite("x", run), "must be a number") == "x must be a number, got a Dataset"
    assert refused(lambda: finite("x", 10**400), "must be finite") == "x must be finite, got an int"
    assert refused(lambda: count("x", 5, high=4), "at most") == "x must be at most 4, got 5"
    assert brief(10**5000) == "an int"
    assert brief("x" * 100) == "'" + "x" * 76 + "..."
    assert suggestion("coulom" * 100, ["coulomb"]) == ""
    assert in_one_line(KeyError()) == "KeyError"
    assert by_key("x", None) == {}


# Matrices.


def test_an_npz_is_checked_by_its_headers(tmp_path):
    large = np.zeros((9000, 9000))
    np.savez_compressed(tmp_path / "large.npz", mass=large, stiffness=large)
    assert (tmp_path / "large.npz").stat().st_size < 2e6
    tracemalloc.start()
    refused(
        lambda: st.ReducedBody.read(tmp_path / "large.npz"),
        "large.npz': mass must have at most 4000 degrees of freedom, got 9000",
    )
    assert tracemalloc.get_traced_memory()[1] < 20e6
    tracemalloc.stop()


def test_a_header_with_too_large_sizes_allocates_nothing(tmp_path):
    header = b"\x93NUMPY\x01\x00v\x00" + b"{'descr': '<f8', 'fortran_order': False, 'shape': (4000, 4000), }"
    with zipfile.ZipFile(tmp_path / "body.npz", "w") as archive:
        for name in ("mass", "stiffness"):
            archive.writestr(f"{name}.npy", header.ljust(127) + b"\n" + b"\0" * 800)
    refused(lambda: st.ReducedBody.read(tmp_path / "body.npz"), "mass must hold the 16000000 numbers .* holds fewer$")


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("order", ["<", ">"])
def test_matlab_files_are_read_as_scipy_reads_them(tmp_path, packed, order):
    body = st.ReducedBody(np.diag([1.0, 2.0]), np.array([[3.0, -1.0], [-1.0, 3.0]]), {"tip": (0, 1)})
    held = {"M": scipy.sparse.csc_array(body.mass), "K": body.stiffness, "C": np.eye(2, dtype=np.int8), "other": "text"}
    if order == ">":
        whole = _big_endian({"M": body.mass, "K": body.stiffness, "point_tip": np.eye(2)})
        (tmp_path / "b.mat").write_bytes(whole)
        assert scipy.io.loadmat(tmp_path / "b.mat")["K"].tolist() == body.stiffness.tolist()
    else:
        scipy.io.savemat(tmp_path / "b.mat", held | {"point_tip": np.eye(2)}, do_compression=packed)
    again = st.ReducedBody.read(tmp_path / "b.mat")
    np.testing.assert_array_equal(again.mass, body.mass)
    np.testing.assert_array_equal(again.stiffness, body.stiffness)
    assert (np.ndim(again.damping) == 2) == (order == "<")


def _big_endian(arrays):
    """Return a file as MATLAB wrote them on other machines."""

    def element(kind, data):
        return np.array([kind, len(data)], ">u4").tobytes() + data + b"\0" * (-len(data) % 8)

    content = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x01\x00MI"
    for name, array in arrays.items():
        parts = element(6, np.array([6, 0], ">u4").tobytes()) + element(5, np.array(array.shape, ">i4").tobytes())
        parts += element(1, name.encode()) + element(9, array.T.astype(">f8").tobytes())
        content += element(14, parts)
    return content


def test_a_sparse_matrix_with_bad_indices_crashes_no_process(tmp_path):
    # Expanding it would write outside of its memory.
    bad = scipy.sparse.csc_array(np.eye(3))
    bad.indices[1] = 10**6
    refused(lambda: st.ReducedBody(bad, np.eye(3), {"tip": (0, 1)}), "indices")
    scipy.io.savemat(tmp_path / "b.mat", {"M": bad, "K": np.eye(3), "point_tip": np.eye(2, 3)})
    refused(lambda: st.ReducedBody.read(tmp_path / "b.mat"), r"^cannot read '.*b.mat': .*indices")


# Sizes.


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (
            {"track.length": 1e20},
            r"^cutoff must leave at most 50000 modes, got 15000.0 Hz, below which there are 2.66575e\+21$",
        ),
        ({"track.length": 1e11}, "cutoff must leave at most 50000 modes"),
        ({"track.length": 1e5}, "cutoff must leave at most 50000 modes"),
        ({"material.density": 1.4e15}, "cutoff must leave at most 50000 modes"),
        ({"track.length": 1e-300}, "track must hold numbers of ordinary size: its modes overflow"),
        ({"section.height": 1e-200}, "width and height must be of ordinary size"),
        ({"section.height": 1e200}, "width and height must be of ordinary size"),
    ],
)
def test_the_number_of_modes_of_a_track_is_limited(keys, message):
    st.load_scenario("squeal")
    tracemalloc.start()
    with pytest.raises(st.ScenarioError, match=message):
        st.load_scenario("squeal", keys)
    assert tracemalloc.get_traced_memory()[1] < 20e6
    tracemalloc.stop()


def test_the_number_of_requested_modes_is_limited():
    beam = st.ModalBeam(STEEL, STRIP, 1.0, bending_modes=MOST_MODES - 20)
    assert beam.modes().count == MOST_MODES
    refused(lambda: st.ModalBeam(STEEL, STRIP, 1.0, bending_modes=MOST_MODES), "modes must be at most 50000 in all")
    refused(lambda: st.ModalPlate(STEEL, 1e-3, 1.0, 1.0, (10**6, 10**6)), "modes must be at most 50000 in all")
    refused(lambda: st.ModalPlate(STEEL, 1e-3, 1e4, 1e4, cutoff=1e4), "cutoff must leave at most 50000 modes")
    refused(
        lambda: st.ModalPlate(STEEL, 1e-3, 1.0, 1.0, in_plane=True, in_plane_modes=(10**6, 10**6)),
        "modes must be at most 50000 in all",
    )
    refused(lambda: st.ModalPlate(STEEL, 1e-200, 1.0, 1.0, cutoff=1e4), "must")


def test_the_number_of_coupled_modes_is_limited():
    beam, mass = st.ModalBeam(STEEL, STRIP, 1.0, bending_modes=5000), st.PointMass(1.0)
    system = st.System(
        st.PointContact(mass.centre, beam, at=0.5), (), [st.Spring(beam.at(0.3), mass.centre, stiffness=1e3)]
    )
    refused(lambda: st.simulate(system, 1e-3), "connections must couple at most 4000 modes, got 50")


def test_numbers_that_overflow_are_refused_and_warn_of_nothing():
    refused(lambda: st.ModalBeam(STEEL, st.Section(5e-324, 1.0), 1e-200, cutoff=1e4), "ordinary size")
    mass = st.PointMass(1e-12)
    far = st.System(st.PointContact(mass.centre, st.RigidTrack(1e300)), [st.Force(mass.centre, y=-1e308)])
    refused(lambda: st.simulate(far, 1e-3, step=1e-3, sample_rate=1e3), "ordinary size", (ValueError, st.Diverged))


# Kinds.


def test_a_path_is_not_a_record(run):
    for call in (analysis.bursts, plot.overview, st.regime, analysis.settling_time):
        refused(
            lambda call=call: call("squeal.nc"), "^run must be a record of simulate, .*, got 'squeal.nc': read a file"
        )
        refused(
            lambda call=call: call(run.normal_force), "^run must be .*Dataset.*, got a DataArray named 'normal_force'"
        )
        refused(lambda call=call: call(3), "^run must be .*Dataset.*, got 3$")
        refused(lambda call=call: call(run.drop_vars("time")), "^run must be a record with time, got one with")
    refused(lambda: st.save(3, "x.nc"), "^run must be a Dataset, got 3$")
    refused(lambda: st.export(3, "x.csv"), "^run must be a record of simulate, a Dataset, got 3$")
    refused(lambda: analysis.spectrum(run), "^signal must be a DataArray")
    refused(lambda: plot.timeline(run, "status"), "^variables must be a list of names, got 'status'$")
    refused(lambda: plot.timeline(run, ["status"], 3), "^span must be a start and an end in s, got 3$")
    refused(lambda: plot.save(3, "a.png"), "^figure must be a Figure, got 3$")
    refused(lambda: analysis.status_share(run, "sliding", 3), "^intervals must be pairs of start and end in s, got 3$")


@pytest.mark.parametrize("overrides", [3, "friction=1", [("friction", 1)], {3: 1}])
def test_values_by_key_are_a_mapping(overrides):
    refused(lambda: st.load_scenario("squeal", overrides), "^overrides must ")
    refused(lambda: st.sweep("squeal", [{"at": 0.3}], "regime", overrides=overrides), "^overrides must ")
    refused(lambda: st.root_loci("squeal", "at", [0.3, 0.4], overrides=overrides), "^overrides must ")


@pytest.mark.parametrize("path", [0, 1, 1.5, None, b"x", "a\0b"])
def test_a_number_is_not_a_file(run, path):
    for call in (st.load, lambda path: st.save(run, path), st.read_wav):
        refused(lambda call=call: call(path), "^path must be the name of a file, got ")
    for stream in range(3):
        os.fstat(stream)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rate": 1e-8}, "^rate must be at least twice the lowest tone, 600 Hz, got 1e-08$"),
        ({"lowest_tone": 1e300}, "^lowest_tone must be from 0.001 to 1e"),
        ({"frame": 1e-300}, "^frame must be from 1e-06 to 10000"),
    ],
)
def test_the_search_for_a_regime_is_limited(run, options, message):
    refused(lambda: st.regime(run, **options), message)


def test_a_record_shorter_than_a_sample_of_the_rate_has_a_regime(run):
    assert st.regime(run.isel(time=slice(2)))["confidence"] == 0.5
    assert st.regime(run, rate=1e-2, lowest_tone=1e-3)["audibility"] == 0.0


def test_errors_of_calibration_watchers_are_raised():
    def calibrate(watcher):
        def measured(points):
            return [{"x": 1.0} for _ in points]

        st.calibrate(measured, {"a": (0.0, 1.0)}, {"x": (2.0, 3.0)}, population=5, generations=1, watchers=[watcher])

    refused(lambda: calibrate(3), "not callable", TypeError)
    refused(lambda: calibrate(lambda progress: int("x")), "invalid literal")


def test_sound_of_no_wavelength_is_refused():
    plate = st.ModalPlate(STEEL, 0.002, 0.4, 0.3, (2, 2))
    refused(
        lambda: st.radiation_efficiency(plate, 1e12), "^frequency must be at most 198605 Hz for a track of this size"
    )
    assert st.radiation_efficiency(plate, 50e3) == pytest.approx(1.0, abs=1e-3)


# Records edited by hand.


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (
            lambda run: run.isel(contact_status=[0, 1]),
            "must have a status_share of each of separated, sticking, sliding",
        ),
        (lambda run: run.assign_coords(time=0.0 * run.time), "must have finite, increasing times"),
        (lambda run: run.assign_coords(time=run.time[::-1].values), "must have finite, increasing times"),
        (lambda run: run.assign(status_share=("time", np.ones(run.sizes["time"]))), "must have a status_share of each"),
        (lambda run: run.assign(normal_force=1.0), "must have a normal_force of numbers over time"),
        (lambda run: run.assign(normal_force=run.normal_force.astype(str)), "must have a normal_force of numbers"),
        (lambda run: run.drop_vars("status_share"), "must be a record with status_share"),
    ],
)
def test_a_record_that_was_edited_is_refused(run, edit, message):
    edited = edit(run)
    refused(lambda: st.regime(edited), message)
    if "normal_force" not in message:
        refused(lambda: analysis.phases(edited, "sliding"), message)
        refused(lambda: plot.timeline(edited, ["normal_force", "status"]), message)


# Remains of a killed process.


def test_remains_of_a_killed_process_are_removed_by_the_next_writer(tmp_path, run):
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    left = tmp_path / f".stridula-{gone.pid}-12345.part"
    others = [tmp_path / name for name in (f".stridula-{os.getppid()}-1.part", ".stridula-x-1.part", "a.part")]
    for path in (left, *others):
        path.write_bytes(b"half")
    st.save(run, tmp_path / "run.nc")
    assert sorted(tmp_path.iterdir()) == sorted([*others, tmp_path / "run.nc"])


@pytest.mark.skipif(os.name == "nt", reason="no locks there")
def test_files_of_another_machine_are_left_alone(tmp_path, run):
    import fcntl

    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    written = tmp_path / f".stridula-{gone.pid}-12345.part"
    with written.open("wb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        st.save(run, tmp_path / "run.nc")
        assert written.exists()
    st.save(run, tmp_path / "run.nc")
    assert not written.exists()


def test_a_state_with_excessive_values_is_not_continued(run):
    edited = run.assign(state_modal=run.state_modal * 0.0 + 1e308)
    system = st.load_scenario("squeal").system
    refused(lambda: st.simulate(system, 1e-3, start=edited), "^start must have a finite state_modal")
