"""Cache of compiled code between processes, and notification of compilations."""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import sys
import tempfile
import threading
import time as clock
import warnings
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import wraps
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba.core import event
from numba.core.caching import FunctionCache
from numba.core.dispatcher import Dispatcher

from ..cache import keep, key, recall

# Files beside the compiled code: the digest of its sources, and the lock of the process that changes it.
STAMP, LOCK = "stridula-kernels", "stridula-storing"


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


def forget_other_sources(package: str) -> None:
    """Delete compiled code of sources other than the present ones of a package, given by name, and those in it.

    numba checks only the file of the called function: after an update of the package in place it would silently run
    old code. Its functions must have been imported; each folder of them has compiled code of its own.
    """
    sources = hashlib.blake2b(digest_size=16)
    for path in sorted(Path(path) for root in sys.modules[package].__path__ for path in Path(root).rglob("*.py")):
        sources.update(path.read_bytes())
    for folder in {Path(function._cache.cache_path) for function in compiled_functions(package).values()}:
        _keep_only(folder, sources.hexdigest())


def compiled_functions(package: str) -> dict[str, Any]:
    """Return the compiled functions of a package that have been imported, by their names in it."""
    within = f"{package}."
    return {
        f"{name.removeprefix(within)}.{word}": thing
        for name, module in list(sys.modules.items())
        if name.startswith(within)
        for word, thing in vars(module).items()
        if isinstance(thing, Dispatcher) and thing.py_func.__module__ == name
    }


def _keep_only(folder: Path, sources: str) -> None:
    """Delete the compiled code in a folder unless it is that of some sources, given by their digest."""
    stamp = folder / STAMP

    def is_present() -> bool:
        return stamp.exists() and stamp.read_text(encoding="ascii") == sources

    # If the folder cannot be written, numba keeps nothing either.
    with suppress(OSError):
        if is_present():
            return
        with _locked(folder):
            if is_present():
                return
            for compiled in folder.glob("*.nb[ic]"):
                compiled.unlink(missing_ok=True)
            stamp.write_text(sources, encoding="ascii")


def store_one_at_a_time() -> None:
    """Let one process at a time store compiled code.

    numba numbers the stored code of a function, a number for each kind of arguments: two processes that store at the
    same time could give two kinds the same number.
    """
    FunctionCache.save_overload = _storing_alone(FunctionCache.save_overload)  # type: ignore[method-assign]


def _storing_alone(save: Callable[..., None]) -> Callable[..., None]:
    @wraps(save)
    def save_overload(cache: FunctionCache, signature: Any, code: Any) -> None:
        with _locked(Path(cache.cache_path)):
            save(cache, signature, code)

    return save_overload


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, made if necessary; hold none where it cannot be written or the system has no locks."""
    with ExitStack() as held:
        with suppress(ImportError, OSError):
            folder.mkdir(parents=True, exist_ok=True)
            import fcntl

            fcntl.flock(held.enter_context((folder / LOCK).open("a")), fcntl.LOCK_EX)
        yield


@contextmanager
def tell_of_compiling(begins: Callable[[str], None]) -> Iterator[None]:
    """Call a function whenever a compilation begins, in any thread, with its time on this machine last time, in words.

    Loading code from disk does not count, nor does code that is compiled for other code.
    """
    with event.install_listener("numba:compile", _Compilations(begins)):
        yield


class _Compilations(event.Listener):
    """Listener that calls a function when a compilation begins, and keeps the time that it takes."""

    def __init__(self, begins: Callable[[str], None]) -> None:
        self.begins, self.here = begins, threading.local()

    def on_start(self, event: event.Event) -> None:
        """Call the function, unless this is a part of a compilation."""
        under_way = getattr(self.here, "under_way", 0)
        self.here.under_way = under_way + 1
        if not under_way:
            self.here.name, self.here.began = _name_of(event), clock.perf_counter()
            self.begins(_time_in_words(self.here.name))

    def on_end(self, event: event.Event) -> None:
        """Keep the time of a compilation that is complete; one that began before the listener did has none."""
        under_way = getattr(self.here, "under_way", 0)
        self.here.under_way = max(under_way - 1, 0)
        if under_way == 1:
            keep(self.here.name, {"seconds": np.array(clock.perf_counter() - self.here.began)})


def _name_of(compilation: event.Event) -> str:
    """Return the name of the time of a compilation in the cache: that of what is compiled, and for which arguments."""
    of = compilation.data["dispatcher"].py_func
    return key(part.encode() for part in ("compilation", of.__module__, of.__qualname__, str(compilation.data["args"])))


def _time_in_words(name: str) -> str:
    """Return the time of a compilation last time in words."""
    known = recall(name)
    if known is None:
        return "a minute or two"
    seconds = float(known["seconds"])
    return f"{seconds:.0f} s last time" if seconds >= 1.0 else "a moment"
