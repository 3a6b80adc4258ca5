"""Where compiled code is kept from one process to the next."""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
import warnings

import numba


def find_a_place() -> None:
    """Keep compiled code for this process and its children only where it can be kept nowhere else, and say so once."""
    try:
        numba.njit(cache=True)(_anything)
    except RuntimeError:
        folder = tempfile.mkdtemp(prefix="stridula-")
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        os.environ["NUMBA_CACHE_DIR"] = folder
        numba.config.CACHE_DIR = folder  # type: ignore[attr-defined]
        warnings.warn(
            "compiled code cannot be kept, neither beside the package nor in the home folder: each start compiles "
            "again, which is slower; set NUMBA_CACHE_DIR to a folder that can be written",
            stacklevel=2,
        )


def _anything() -> None:
    """Stand for all that is compiled."""
