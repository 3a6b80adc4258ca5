"""Cache of compiled code between processes, and notification of compilations."""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import numba
from numba.core import event

# Files beside the compiled code: the digest of its sources, and the lock of the process that changes it.
STAMP, LOCK = "stridula-kernels", "stridula-compiling"


def find_a_place() -> None:
    """Keep compiled code for this process and its children only, with a warning, if it cannot be kept elsewhere."""
    try:
        numba.njit(cache=True)(_anything)
    except RuntimeError:
        folder = tempfile.mkdtemp(prefix="stridula-")
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        os.environ["NUMBA_CACHE_DIR"] = folder
        numba.config.CACHE_DIR = folder  # type: ignore[attr-defined]
        warnings.warn(
            "compiled code cannot be stored beside the package or in the home folder, so each start compiles again; "
            "set NUMBA_CACHE_DIR to a writable folder",
            stacklevel=2,
        )


def _anything() -> None:
    """Function for the test whether compiled code can be kept."""


def forget_other_sources(kernel: Any) -> None:
    """Delete compiled code of sources other than the present ones of the kernels.

    numba checks only the file of the called function: after an update of the package in place it would silently run
    old code.
    """
    folder = _folder_of(kernel)
    stamp, sources = folder / STAMP, hashlib.blake2b(digest_size=16)
    for path in sorted(Path(kernel.py_func.__code__.co_filename).parent.glob("*.py")):
        sources.update(path.read_bytes())

    def is_present() -> bool:
        return stamp.exists() and stamp.read_text(encoding="ascii") == sources.hexdigest()

    # If the folder cannot be written, numba keeps nothing either.
    with suppress(OSError):
        if is_present():
            return
        with _locked(folder):
            if is_present():
                return
            for compiled in folder.glob("*.nb[ic]"):
                compiled.unlink(missing_ok=True)
            stamp.write_text(sources.hexdigest(), encoding="ascii")


def compile_one_at_a_time(kernel: Any) -> None:
    """Let one process compile at a time, of all that keep their code where this kernel is kept.

    Otherwise they would compile the same functions, and numba, which numbers the stored code of a function, could store
    that of two types of arguments under one number.
    """
    event.register("numba:compile", _OneAtATime(_folder_of(kernel)))


def _folder_of(kernel: Any) -> Path:
    return Path(kernel._cache.cache_path)


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, made if necessary; hold none where it cannot be written or the system has no locks."""
    with ExitStack() as held:
        with suppress(ImportError, OSError):
            import fcntl

            folder.mkdir(parents=True, exist_ok=True)
            fcntl.flock(held.enter_context((folder / LOCK).open("a")), fcntl.LOCK_EX)
        yield


class _OneAtATime(event.Listener):
    """Listener that holds the lock of a folder from the start of a compilation to its end, nested ones included."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.depth, self.held = folder, 0, ExitStack()

    def on_start(self, event: event.Event) -> None:
        """Wait until no other process compiles."""
        self.depth += 1
        if self.depth == 1:
            self.held.enter_context(_locked(self.folder))

    def on_end(self, event: event.Event) -> None:
        """Let others compile."""
        self.depth -= 1
        if self.depth == 0:
            self.held.close()


@contextmanager
def tell_of_compiling(begins: Callable[[], None]) -> Iterator[None]:
    """Call a function whenever a compilation begins, in any thread; loading code from disk does not count."""
    with event.install_listener("numba:compile", _Beginnings(begins)):
        yield


class _Beginnings(event.Listener):
    """Listener that calls a function when a compilation begins."""

    def __init__(self, begins: Callable[[], None]) -> None:
        self.begins = begins

    def on_start(self, event: event.Event) -> None:
        """Call the function."""
        self.begins()

    def on_end(self, event: event.Event) -> None:
        """Do nothing."""
