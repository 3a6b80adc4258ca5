"""Compiled code that several processes share: deleted with its sources, and stored by one process at a time."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from numba.core.caching import FunctionCache

from stridula.integration import marches
from stridula.integration.compiled_code import LOCK, STAMP, _locked, _storing_alone, forget_other_sources

fcntl = pytest.importorskip("fcntl", reason="this system has no such locks")


def kernel_in(folder):
    """Return a function whose compiled code would be stored in a folder."""
    return SimpleNamespace(_cache=SimpleNamespace(cache_path=str(folder)), py_func=forget_other_sources)


def is_locked(folder) -> bool:
    with (folder / LOCK).open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
    return False


def test_one_process_stores_at_a_time(tmp_path):
    """The lock of the folder is held while code is stored, and not afterwards."""
    seen = []
    store = _storing_alone(lambda cache, signature, code: seen.append((is_locked(tmp_path), signature, code)))
    store(SimpleNamespace(cache_path=tmp_path), "a signature", "its code")
    assert seen == [(True, "a signature", "its code")]
    assert not is_locked(tmp_path)
    # All that numba stores after the import of the march.
    assert marches.PLAIN or FunctionCache.save_overload.__wrapped__


def test_a_folder_that_cannot_be_made_has_no_lock(tmp_path):
    (tmp_path / "file").touch()
    with _locked(tmp_path / "file" / "below"):
        pass


def test_code_of_other_sources_is_deleted_once(tmp_path):
    kernel, compiled = kernel_in(tmp_path), tmp_path / "march.nbc"
    for text, is_kept in ((None, False), ("other", False), (None, True)):
        compiled.touch()
        if text:
            (tmp_path / STAMP).write_text(text)
        forget_other_sources(kernel)
        assert compiled.exists() == is_kept


def test_the_present_code_is_used_while_another_process_compiles(tmp_path):
    kernel = kernel_in(tmp_path)
    forget_other_sources(kernel)
    with (tmp_path / LOCK).open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        forget_other_sources(kernel)
