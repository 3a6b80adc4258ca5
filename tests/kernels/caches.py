"""Copies of the code that numba has compiled and stored."""

from __future__ import annotations

import shutil
from pathlib import Path

from numba import types
from numba.core.caching import _CacheLocator

import stridula as st
from stridula._kernels import march
from stridula.integration.compiled_code import compiled_functions

KERNEL, START = "march.march", "contacts.sweeps.solve_closed"


def incomplete_cache(folder: Path) -> Path:
    """Copy the compiled code to where numba looks for it if NUMBA_CACHE_DIR is this folder, without one march.

    It is that of a single contact, which is compiled now if it is not stored yet.
    """
    st.load_scenario("squeal", {"duration": "1 ms"}).simulate()
    stored = march.march._cache._cache_file._load_index()
    (single,) = [file for (signature, *_), file in stored.items() if signature[1:4] == (types.none,) * 3]
    ignored = shutil.ignore_patterns("*.pyc", single)
    for function in compiled_functions("stridula._kernels").values():
        subfolder = _CacheLocator.get_suitable_cache_subpath(function.py_func.__code__.co_filename)
        if not (folder / subfolder).exists():
            shutil.copytree(function.stats.cache_path, folder / subfolder, ignore=ignored)
    return folder
