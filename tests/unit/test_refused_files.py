"""Files that cannot be read to their end: pipes, devices, and those that are far larger when unpacked."""

from __future__ import annotations

import os
import socket

import numpy as np
import pytest
import scipy.io

import stridula as st
from stridula import disk
from stridula.bodies import limits
from stridula.bodies.revolution.profiles import MeshProfile
from stridula.cli.points import points_of
from stridula.records import files
from stridula.signals import sound_files

POINTS = {"tip": (0, 1)}
READERS = {
    "mesh.msh": st.SolidMesh.read,
    "mesh.vtu": st.SolidMesh.read,
    "profile.msh": MeshProfile.read,
    "record.nc": st.load,
    "sound.wav": st.read_wav,
    "points.csv": lambda path: points_of([], None, None, str(path), yes=False),
    "scenario.toml": st.load_scenario,
    "body.npz": st.ReducedBody.read,
    "body.mat": st.ReducedBody.read,
    "job.sti": lambda path: st.ReducedBody.read(path, points=POINTS),
    "body.op4": lambda path: st.ReducedBody.read(path, points=POINTS),
    "mass.mtx": lambda path: st.ReducedBody.read(mass=path, stiffness=path, points=POINTS),
}


@pytest.fixture
def matrix(tmp_path):
    path = tmp_path / "k.mtx"
    scipy.io.mmwrite(path, np.diag([2.0, 3.0]))
    return path


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    path = tmp_path_factory.mktemp("records") / "run.nc"
    st.save(st.load_scenario("squeal", {"duration": "1 ms"}).simulate(), path)
    return path.read_bytes()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
@pytest.mark.parametrize("name", READERS)
def test_pipes_are_refused_by_every_reader(name, tmp_path):
    os.mkfifo(tmp_path / name)
    with pytest.raises((OSError, ValueError), match=rf"^(cannot read|scenario must) .*{name}'.* a pipe") as caught:
        READERS[name](tmp_path / name)
    assert "\n" not in str(caught.value)
    assert str(caught.value).count("cannot read") <= 1


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
@pytest.mark.parametrize("argument", ["labels", "mesh"])
def test_pipes_are_refused_beside_matrices(argument, matrix, tmp_path):
    os.mkfifo(tmp_path / "job.inp")
    with pytest.raises(OSError, match=r"^cannot read '.*job.inp': it must be a regular file, got a pipe$"):
        st.ReducedBody.read(mass=matrix, stiffness=matrix, points=POINTS, **{argument: tmp_path / "job.inp"})


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
def test_pipes_are_refused_as_bases(tmp_path):
    os.mkfifo(tmp_path / "base.toml")
    (tmp_path / "own.toml").write_text('base = "base.toml"\n')
    with pytest.raises(ValueError, match=r"^base must be a scenario file or one of .*, got 'base.toml'"):
        st.load_scenario(tmp_path / "own.toml")


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="needs /dev/zero")
@pytest.mark.parametrize("read", [st.load, st.read_wav, st.load_scenario, st.ReducedBody.read, disk.read])
def test_devices_are_refused(read):
    with pytest.raises(
        (OSError, ValueError), match=r"^(cannot read|scenario must) .*'/dev/zero'.*, a device$|a device$"
    ):
        read("/dev/zero")


@pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="needs sockets with names")
def test_sockets_are_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as one:
        one.bind("record.nc")
        with pytest.raises(OSError, match=r"^cannot read 'record.nc': it must be a regular file, got a socket$"):
            st.load("record.nc")


@pytest.mark.parametrize(
    ("name", "read"), [("a.toml", st.load_scenario), ("a.csv", READERS["points.csv"]), ("a.wav", st.read_wav)]
)
def test_huge_texts_and_sounds_are_refused_unread(name, read, tmp_path):
    with open(tmp_path / name, "wb") as file:
        os.truncate(file.fileno(), 4097 * 1024**2)
    with pytest.raises(OSError, match=rf"^cannot read '.*{name}': 4097 MiB, but at most \d+ MiB are read$"):
        read(tmp_path / name)


def test_records_that_unpack_to_more_than_16_gib_are_refused(record, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "run.nc"
    path.write_bytes(record)
    with h5py.File(path, "a") as file:
        file.create_dataset("more", shape=(10**10,), dtype="f8", chunks=(10**6,), compression="gzip")
    assert path.stat().st_size < 10**6
    with pytest.raises(ValueError, match=r"^path must have at most 16 GiB when unpacked, got 74.6 GiB in '.*run.nc'$"):
        st.load(path)


def test_records_that_cannot_be_read_again_are_not_written(tmp_path, monkeypatch):
    run = st.load_scenario("squeal", {"duration": "1 ms"}).simulate()
    monkeypatch.setattr(files, "LARGEST", 1024)
    with pytest.raises(ValueError, match=r"^run must have at most .* GiB, got "):
        st.save(run, tmp_path / "run.nc")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("way", ["link", "external"])
def test_variables_in_other_files_are_refused(way, record, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "run.nc"
    path.write_bytes(record)
    (tmp_path / "other").write_bytes(bytes(80))
    with h5py.File(path, "a") as file:
        if way == "link":
            file["other"] = h5py.ExternalLink(str(tmp_path / "other"), "/x")
        else:
            file.create_dataset("other", shape=(10,), dtype="f8", external=[(str(tmp_path / "other"), 0, 80)])
    with pytest.raises(ValueError, match=r"^path must hold all its variables itself, got 'other' of '.*run.nc'$"):
        st.load(path)


def test_sounds_that_unpack_to_more_than_4_gib_are_refused(tmp_path, monkeypatch):
    soundfile = pytest.importorskip("soundfile")
    path = tmp_path / "sound.wav"
    soundfile.write(path, np.zeros(100_000), 48000, format="FLAC")
    assert st.read_wav(path, full_scale=1.0).sizes["time"] == 100_000
    monkeypatch.setattr(sound_files, "LARGEST", 799_999)
    with pytest.raises(ValueError, match=r"^path must have samples of at most .* GiB, got .* GiB in '.*sound.wav'$"):
        st.read_wav(path, full_scale=1.0)


def test_all_variables_of_a_matlab_file_together_are_bounded(tmp_path, monkeypatch):
    held = {"M": np.eye(100), "K": np.eye(100)} | {f"point_{k}": np.zeros((2, 100)) for k in range(40)}
    scipy.io.savemat(tmp_path / "body.mat", held, do_compression=True)
    monkeypatch.setattr(limits, "LARGEST_FILE", 200_000)
    with pytest.raises(ValueError, match=r"^cannot read '.*body.mat': more than .* GiB when unpacked$"):
        st.ReducedBody.read(tmp_path / "body.mat")


# Numbers that are not finite are named with file and line.

BODY = {"points": {"tip": [[1.0, 0.0], [0.0, 1.0]]}}
UNIT = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1.0\n2 2 1.0\n"
TETRAHEDRON = """# vtk DataFile Version 3.0
one
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 double
0 0 0
1 0 0
0 {} 0
0 0 1
CELLS 1 5
4 0 1 2 3
CELL_TYPES 1
10
"""


def mass_and(name: str, text: str):
    def read(folder):
        (folder / "mass.mtx").write_text(UNIT, encoding="utf-8")
        (folder / name).write_text(text, encoding="utf-8")
        return st.ReducedBody.read(mass=folder / "mass.mtx", stiffness=folder / name, **BODY)

    return read


def packed(folder):
    stiffness = np.diag([1.0, np.nan])
    np.savez(folder / "body.npz", mass=np.eye(2), stiffness=stiffness, point_tip=np.eye(2))
    return st.ReducedBody.read(folder / "body.npz")


def meshed(read, coordinate="nan"):
    def made(folder):
        (folder / "mesh.vtk").write_text(TETRAHEDRON.format(coordinate), encoding="utf-8")
        return read(folder / "mesh.vtk")

    return made


def heard(folder):
    soundfile = pytest.importorskip("soundfile")
    soundfile.write(folder / "sound.wav", np.array([0.0, np.nan, 0.1]), 8000, subtype="FLOAT")
    return st.read_wav(folder / "sound.wav", full_scale=1.0)


NOT_FINITE = {
    "matrix": (
        mass_and("k.mtx", UNIT.replace("2 2 1.0", "2 2 NaN")),
        r"k\.mtx': line 4: stiffness must be finite, got nan$",
    ),
    "overflow": (
        mass_and("k.mtx", UNIT.replace("2 2 1.0", "2 2 1e999")),
        r"k\.mtx': line 4: stiffness must be finite, got inf$",
    ),
    "binary": (packed, r"body\.npz': stiffness must be finite, got nan at row 1, column 1 \(from 0\)$"),
    "mesh": (meshed(st.SolidMesh.read), r"mesh\.vtk': line 8: nodes must be finite, got nan$"),
    "profile": (meshed(st.MeshProfile.read), r"mesh\.vtk': line 8: nodes must be finite, got nan$"),
    "sound": (heard, r"^path must have finite samples, got nan in '.*sound\.wav' at 0\.000125 s$"),
}


@pytest.mark.parametrize("name", NOT_FINITE)
def test_a_number_that_is_not_finite_is_named_with_file_and_line(name, tmp_path):
    read, words = NOT_FINITE[name]
    with pytest.raises(ValueError, match=words) as caught:
        read(tmp_path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", ["nan", "-inf", "inf kHz"])
def test_a_value_of_a_table_that_is_not_finite_is_named_with_its_line(value, tmp_path):
    path = tmp_path / "points.csv"
    path.write_text(f"friction\n0.3\n\n{value}\n", encoding="utf-8")
    with pytest.raises(
        ValueError, match=rf"^--points must have finite numbers, got '{value}' in line 4 of '.*points\.csv'$"
    ):
        points_of([], None, None, str(path), yes=False)
