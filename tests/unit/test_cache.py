"""The cache on disk for other processes: exact, bounded, and ignored if it fails."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from stridula import cache

ARRAYS = {"first": np.arange(6.0).reshape(2, 3), "second": np.array([1 + 2j], dtype=np.complex64)}


@pytest.fixture(name="place")
def place_(monkeypatch, tmp_path):
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "kept"))
    return tmp_path / "kept"


def test_cached_arrays_are_recalled_to_the_last_bit(place):
    assert cache.recall("it") is None
    cache.keep("it", ARRAYS)
    found = cache.recall("it")
    assert list(found) == list(ARRAYS)
    for name, values in ARRAYS.items():
        np.testing.assert_array_equal(found[name], values)
        assert found[name].dtype == values.dtype
    assert cache.recall("another") is None
    assert [path.name for path in place.iterdir()] == ["it.kept"]


@pytest.mark.parametrize("harm", [lambda text: text[:-7], lambda text: text[:99] + b"?" + text[100:], lambda text: b""])
def test_a_damaged_file_is_ignored(place, harm):
    cache.keep("it", ARRAYS)
    file = place / "it.kept"
    file.write_bytes(harm(file.read_bytes()))
    assert cache.recall("it") is None
    cache.keep("it", ARRAYS)
    assert cache.recall("it") is not None


def test_a_folder_that_cannot_be_made_is_ignored(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "file" / "kept"))
    cache.keep("it", ARRAYS)
    assert cache.recall("it") is None
    assert (tmp_path / "file").read_text() == "in the way"


def test_a_folder_that_cannot_be_written_is_ignored(place, monkeypatch):
    cache.keep("it", ARRAYS)

    def refused(*arguments):
        raise PermissionError("read-only")

    monkeypatch.setattr("stridula.cache.write", refused)
    monkeypatch.setattr(os, "utime", refused)
    cache.keep("another", ARRAYS)
    assert cache.recall("another") is None
    assert cache.recall("it") is not None


def test_the_least_recently_used_file_is_removed(place, monkeypatch):
    cache.keep("one", ARRAYS)
    size = (place / "one.kept").stat().st_size
    monkeypatch.setattr(cache, "MOST", 2 * size)
    cache.keep("two", ARRAYS)
    for age, name in ((200, "one"), (100, "two")):
        before = (place / f"{name}.kept").stat().st_mtime - age
        os.utime(place / f"{name}.kept", (before, before))
    # A use makes it the younger one.
    assert cache.recall("one") is not None
    cache.keep("three", ARRAYS)
    assert sorted(path.stem for path in place.iterdir()) == ["one", "three"]
    monkeypatch.setattr(cache, "MOST", size // 2)
    cache.keep("too large", ARRAYS)
    assert cache.recall("too large") is None


def test_it_can_be_turned_off(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(cache.FOLDER, "off")
    cache.keep("it", ARRAYS)
    assert cache.recall("it") is None
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("system", "variables", "wanted"),
    [
        ("linux", {}, "home/.cache/stridula"),
        ("linux", {"XDG_CACHE_HOME": "elsewhere"}, "elsewhere/stridula"),
        ("darwin", {"XDG_CACHE_HOME": "elsewhere"}, "home/Library/Caches/stridula"),
        ("win32", {"LOCALAPPDATA": "local"}, "local/stridula"),
        ("linux", {cache.FOLDER: "mine"}, "mine"),
    ],
)
def test_the_folder_is_the_one_of_the_system(monkeypatch, system, variables, wanted):
    for name in (cache.FOLDER, "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr("sys.platform", system)
    monkeypatch.setattr(Path, "home", lambda: Path("home"))
    assert cache.folder() == Path(wanted)


def test_names_distinguish_parts():
    assert cache.key([b"ab", b"c"]) != cache.key([b"a", b"bc"])
    assert cache.key([b"ab", b"c"]) == cache.key([b"ab", b"c"])
