"""Copies of the code that numba has compiled and stored."""

from __future__ import annotations

import shutil
from pathlib import Path

from numba.core.caching import _CacheLocator

import stridula as st
from stridula._kernels import march

KERNEL = "march.march"


def incomplete_cache(folder: Path) -> Path:
    """Copy the compiled code except `KERNEL` to where numba looks for it if NUMBA_CACHE_DIR is this folder."""
    # Compiled now if it is not stored yet.
    st.load_scenario("squeal", {"duration": "1 ms"}).simulate()
    ignored = shutil.ignore_patterns("*.pyc", f"{KERNEL}-*")
    subfolder = _CacheLocator.get_suitable_cache_subpath(march.__file__)
    shutil.copytree(march.march.stats.cache_path, folder / subfolder, ignore=ignored)
    return folder
