"""Records in files: equal when read back, whole or not at all."""

from __future__ import annotations

import errno
import os
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula import disk


@pytest.fixture(scope="module")
def record():
    return st.load_scenario("squeal", {"duration": "2 ms"}).simulate()


def test_a_record_reads_back_equal(record, tmp_path):
    path = tmp_path / "run.nc"
    st.save(record, path)
    again = st.load(path)
    xr.testing.assert_identical(again, record)
    assert {name: type(value) for name, value in again.attrs.items()} == {
        name: type(value) for name, value in record.attrs.items()
    }
    assert {name: v.dtype for name, v in again.data_vars.items()} == {name: v.dtype for name, v in record.items()}
    assert list(tmp_path.iterdir()) == [path]


def test_a_record_read_back_can_be_continued(record, tmp_path):
    st.save(record, tmp_path / "run.nc")
    scenario = st.load_scenario("squeal", {"duration": "1 ms"})
    onwards = scenario.simulate(start=st.load(tmp_path / "run.nc"))
    xr.testing.assert_equal(onwards, scenario.simulate(start=record))


def test_a_record_without_samples_is_kept_too(record, tmp_path):
    empty = record.isel(time=slice(0, 0))
    st.save(empty, tmp_path / "run.nc")
    xr.testing.assert_identical(st.load(tmp_path / "run.nc"), empty)


def test_a_record_replaces_the_one_before_through_a_link(record, tmp_path):
    (tmp_path / "real.nc").write_bytes(b"old")
    (tmp_path / "link.nc").symlink_to("real.nc")
    st.save(record, tmp_path / "link.nc")
    assert (tmp_path / "link.nc").is_symlink()
    assert st.load(tmp_path / "real.nc").sizes == record.sizes


def test_a_full_disk_leaves_the_old_file(record, tmp_path, monkeypatch):
    path = tmp_path / "run.nc"
    path.write_bytes(b"old")

    def full(descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(disk.os, "fsync", full)
    with pytest.raises(OSError, match=r"^cannot write '.*run.nc': no space left on device$") as caught:
        st.save(record, path)
    assert caught.value.errno == errno.ENOSPC
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_device_is_reported(record):
    with pytest.raises(OSError, match=r"^cannot write '/dev/full': no space left on device$"):
        st.save(record, "/dev/full")


@pytest.mark.parametrize(
    ("name", "message"),
    [("", "it is a directory"), ("none/run.nc", "there is no folder"), ("f/x", "there is no folder")],
)
def test_a_path_that_cannot_be_written_is_reported(record, tmp_path, name, message):
    (tmp_path / "f").touch()
    with pytest.raises(OSError, match=f"^cannot write .*: {message}"):
        st.save(record, tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["f"]


def test_a_write_protected_file_is_left_alone(record, tmp_path, monkeypatch):
    path = tmp_path / "run.nc"
    path.write_bytes(b"old")
    monkeypatch.setattr(disk.os, "access", lambda path, mode: False)
    with pytest.raises(PermissionError, match="permission denied"):
        st.save(record, path)
    assert path.read_bytes() == b"old"


def test_other_files_are_refused(record, tmp_path):
    (tmp_path / "text.nc").write_text("no")
    xr.Dataset({"a": ("x", np.ones(2))}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    st.save(record, tmp_path / "run.nc")
    (tmp_path / "cut.nc").write_bytes((tmp_path / "run.nc").read_bytes()[:5000])
    for name, message in [
        ("text.nc", "must be a record that stridula wrote"),
        ("other.nc", "must be a record that stridula wrote"),
        ("cut.nc", "must be a complete record"),
    ]:
        with pytest.raises(ValueError, match=message):
            st.load(tmp_path / name)
    with pytest.raises(FileNotFoundError, match=r"cannot read .*no such file"):
        st.load(tmp_path / "none.nc")


NOWHERE = """
import os, warnings
from numba.core import caching
for locator in (caching.InTreeCacheLocator, caching.UserWideCacheLocator):
    locator.from_function = classmethod(lambda *given: None)
import stridula.integration
print(os.environ["NUMBA_CACHE_DIR"])
print(os.path.isdir(os.environ["NUMBA_CACHE_DIR"]))
"""


def test_a_package_that_nobody_can_write_beside_is_imported_with_one_warning():
    surroundings = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    found = subprocess.run(
        [sys.executable, "-c", NOWHERE], env=surroundings, capture_output=True, text=True, check=True
    )
    folder, was_there = found.stdout.split()
    assert was_there == "True"
    assert not os.path.exists(folder)
    assert found.stderr.count("compiled code cannot be stored") == 1
    assert "set NUMBA_CACHE_DIR" in found.stderr
