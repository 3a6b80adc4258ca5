"""Compiled code that several processes share: deleted with its sources, and stored by one process at a time."""

from __future__ import annotations

import os
import subprocess
import sys
from types import SimpleNamespace

import pytest
from numba.core.caching import FunctionCache

from stridula.integration import marches
from stridula.integration.compiled_code import LOCK, STAMP, _keep_only, _locked, _storing_alone, compiled_functions

fcntl = pytest.importorskip("fcntl", reason="this system has no such locks")


# A package of kernels in two folders, each with a function whose compiled code is kept.
KERNELS = {
    "march.py": """
from numba import njit
from .below.factors import twice

@njit(cache=True)
def march(x):
    return twice(x) + 1
""",
    "below/factors.py": """
from numba import njit

@njit(cache=True)
def twice(x):
    return 2 * x
""",
}
MARCH = """
from importlib import import_module
from stridula.integration.compiled_code import compiled_functions, forget_other_sources
march = import_module("kernels_of_test.march").march
forget_other_sources("kernels_of_test")
print(march(3), *(sum(one.stats.cache_misses.values()) for one in compiled_functions("kernels_of_test").values()))
"""


@pytest.fixture
def kernels(tmp_path):
    """Folder of the sources of a package of kernels."""
    for name, text in KERNELS.items():
        path = tmp_path / "kernels_of_test" / name
        path.parent.mkdir(exist_ok=True)
        (path.parent / "__init__.py").touch()
        path.write_text(text, encoding="utf-8")
    return tmp_path / "kernels_of_test"


def marched(kernels) -> list[int]:
    """Return the result of a process, and how many functions of each folder it compiled."""
    surroundings = os.environ | {"PYTHONPATH": os.pathsep.join([str(kernels.parent), *sys.path])}
    surroundings["NUMBA_CACHE_DIR"] = str(kernels.parent / "compiled")
    surroundings.pop("NUMBA_DISABLE_JIT", None)
    done = subprocess.run([sys.executable, "-c", MARCH], env=surroundings, capture_output=True, text=True, check=True)
    return [int(word) for word in done.stdout.split()]


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


@pytest.mark.parametrize("edited", ["march.py", "below/factors.py"])
def test_an_edit_in_any_folder_compiles_all_anew(kernels, edited):
    assert marched(kernels) == [7, 1, 1]
    assert marched(kernels) == [7, 0, 0]
    path = kernels / edited
    changed = {"march.py": ("+ 1", "+ 2", 8), "below/factors.py": ("2 * x", "3 * x", 10)}[edited]
    path.write_text(path.read_text(encoding="utf-8").replace(*changed[:2]), encoding="utf-8")
    assert marched(kernels)[0] == changed[2]
    assert marched(kernels) == [changed[2], 0, 0]


def test_all_folders_of_the_kernels_are_watched():
    """Every compiled function of the march has its sources below the package, and every folder has some."""
    kernels = compiled_functions("stridula._kernels")
    folders = {name.rpartition(".")[0].rpartition(".")[0] for name in kernels}
    assert {"", "books", "contact", "contacts", "modes"} <= folders


def test_code_of_other_sources_is_deleted_once(tmp_path):
    compiled = tmp_path / "march.nbc"
    for text, is_kept in ((None, False), ("other", False), (None, True)):
        compiled.touch()
        if text:
            (tmp_path / STAMP).write_text(text)
        _keep_only(tmp_path, "present")
        assert compiled.exists() == is_kept


def test_the_present_code_is_used_while_another_process_compiles(tmp_path):
    _keep_only(tmp_path, "present")
    with (tmp_path / LOCK).open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        _keep_only(tmp_path, "present")
