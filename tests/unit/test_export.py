"""Records as tables for other programs: they are read back unchanged."""

from __future__ import annotations

import csv
import tomllib

import numpy as np
import pytest
import scipy.io
import xarray as xr

import stridula as st
from stridula.records.export import _matlab_names, columns


@pytest.fixture(scope="module")
def record():
    scenario = st.load_scenario("squeal", {"duration": "5 ms", "contact.gap": 0.0})
    system = scenario.system
    probes = [st.Acceleration(system.track.centre), st.Acceleration(system.track.at(0.3)), st.Reaction(system.slider)]
    return scenario.simulate(probes=probes)


@pytest.fixture(scope="module")
def two():
    """A record of two contacts, one of whose names is a trap for readers."""
    mass, other = st.PointMass(1.0), st.PointMass(2.0, name="other")
    floor = st.RigidTrack(velocity=0.1)
    contacts = [
        st.PointContact(mass.centre, floor, friction=st.Coulomb(0.3), name='a, "b" #1'),
        st.PointContact(other.centre, floor, gap=1e-5),
    ]
    return st.simulate(st.System(contacts, [st.Gravity()]), 1e-3)


def read_csv(path):
    """Return comment lines, names, and columns of a CSV file."""
    with open(path, encoding="utf-8", newline="") as file:
        lines = file.readlines()
    comments = [line for line in lines if line.startswith("#")]
    names, *rows = csv.reader(lines[len(comments) :])
    return comments, names, dict(zip(names, np.array(rows, dtype=float).T, strict=True))


def test_a_csv_holds_every_sample_of_every_variable_bit_by_bit(record, tmp_path):
    st.export(record, tmp_path / "run.csv")
    comments, names, table = read_csv(tmp_path / "run.csv")
    np.testing.assert_array_equal(table["time"], record["time"])
    np.testing.assert_array_equal(table["normal_force"], record["normal_force"])
    np.testing.assert_array_equal(table["status_share [sliding]"], record["status_share"].sel(contact_status="sliding"))
    np.testing.assert_array_equal(table["acceleration [track 0.3 m y]"], record["acceleration"][:, 1])
    np.testing.assert_array_equal(table["reaction [slider root moment]"], record["reaction"][:, 0])
    units = dict(zip(names, comments[-1].removeprefix("# units: ").strip().split(","), strict=True))
    assert (units["time"], units["normal_force"], units["acceleration [track centre y]"]) == ("s", "N", "m/s2")
    assert f"# step: {record.attrs['step']}\n" in comments
    scenario = [line.removeprefix("# scenario").removeprefix(": ").removeprefix("| ") for line in comments]
    text = "".join(line for line, full in zip(scenario, comments, strict=True) if full.startswith("# scenario"))
    assert tomllib.loads(text) == tomllib.loads(record.attrs["scenario"])


def test_a_csv_of_several_contacts_names_each(two, tmp_path):
    st.export(two, tmp_path / "run.csv")
    _, names, table = read_csv(tmp_path / "run.csv")
    assert 'normal_force [a, "b" 1]' in names
    np.testing.assert_array_equal(table["normal_force [contact 2]"], two["normal_force"][:, 1])
    np.testing.assert_array_equal(table['status_share [a, "b" 1; sliding]'], two["status_share"][:, 0, 2])
    assert len(set(names)) == len(names)


def test_a_mat_file_holds_arrays_units_labels_and_attributes(record, two, tmp_path):
    st.export(record, tmp_path / "run.mat")
    held = scipy.io.loadmat(tmp_path / "run.mat", simplify_cells=True)
    for name in ("time", "normal_force", "acceleration", "status_share", "status"):
        np.testing.assert_array_equal(held[name], record[name])
    assert held["units"]["normal_force"] == "N"
    assert held["long_name"]["gap"] == record["gap"].attrs["long_name"]
    assert list(held["labels"]["acceleration_probe"]) == ["track centre y", "track 0.3 m y"]
    assert held["attributes"]["step"] == record.attrs["step"]
    assert held["attributes"]["scenario"] == record.attrs["scenario"]
    st.export(two, tmp_path / "two.mat")
    held = scipy.io.loadmat(tmp_path / "two.mat", simplify_cells=True)
    np.testing.assert_array_equal(held["normal_force"], two["normal_force"])
    assert list(held["labels"]["contact"]) == list(two["contact"].values)


def test_every_name_is_one_that_matlab_takes():
    given = _matlab_names(["time", "end", "2nd mode", "a-b", "a b", "ü", "units", "x" * 70, "x" * 71], taken=("units",))
    assert len(set(given.values())) == len(given)
    assert given["time"] == "time"
    for name in given.values():
        assert name.isidentifier()
        assert name.isascii()
        assert name[0].isalpha()
        assert len(name) <= 63
        assert name not in ("end", "units")


def test_an_empty_record_is_a_table_without_rows(record, tmp_path):
    empty = record.isel(time=slice(0, 0))
    st.export(empty, tmp_path / "run.csv")
    assert (tmp_path / "run.csv").read_text().splitlines()[-1].startswith("time,normal_force")
    st.export(empty, tmp_path / "run.mat")


def test_columns_have_different_names(record, two):
    for run in (record, two):
        found = columns(run)
        assert len({column.name for column in found}) == len(found)
        assert all(column.values.shape == (run.sizes["time"],) for column in found)
    assert not any(column.variable.startswith("state_") for column in columns(record))


@pytest.mark.parametrize(
    ("name", "error", "message"),
    [
        ("run.txt", ValueError, "path must end in .csv or .mat, got"),
        ("run", ValueError, "path must end in .csv or .mat, got"),
        ("none/run.csv", OSError, "there is no folder"),
        ("folder.csv", OSError, "it is a directory"),
    ],
)
def test_failed_writes_are_reported_and_leave_nothing(record, tmp_path, name, error, message):
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(error, match=message):
        st.export(record, tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.csv"]


def test_other_datasets_cannot_be_exported(tmp_path):
    with pytest.raises(ValueError, match="run must be a record of simulate, a Dataset"):
        st.export(3, tmp_path / "run.csv")
    with pytest.raises(ValueError, match="run must be a record with time, got one with"):
        st.export(xr.Dataset({"a": ("x", [1.0])}), tmp_path / "run.csv")
