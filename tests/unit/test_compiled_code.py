"""Compiled code that several processes share: deleted with its sources, and changed by one process at a time."""

from __future__ import annotations

from types import SimpleNamespace

import numba
import pytest
from numba.core import event

from stridula.integration.compiled_code import LOCK, STAMP, _OneAtATime, compile_one_at_a_time, forget_other_sources

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


def test_one_process_compiles_at_a_time(tmp_path):
    """The lock is held while a function and those that it calls are compiled, and not afterwards."""
    seen, folder = [], tmp_path / "compiled"
    compile_one_at_a_time(kernel_in(folder))
    (lock,) = [one for one in event._registered["numba:compile"] if getattr(one, "folder", None) == folder]

    class Look(event.Listener):
        def on_start(self, event):
            seen.append(is_locked(folder))

        on_end = on_start

    @numba.njit
    def inner(x):
        return x + 1

    @numba.njit
    def outer(x):
        return inner(x)

    try:
        assert isinstance(lock, _OneAtATime)
        with event.install_listener("numba:compile", Look()):
            assert outer(1) == 2
    finally:
        event.unregister("numba:compile", lock)
    # The last one is seen after the lock is given back.
    assert seen == [True, True, True, False]
    assert not is_locked(folder)


def test_a_folder_that_cannot_be_made_has_no_lock(tmp_path):
    (tmp_path / "file").touch()
    lock = _OneAtATime(tmp_path / "file" / "below")
    lock.on_start(None)
    lock.on_end(None)
    assert lock.depth == 0


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
