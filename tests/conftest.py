"""Settings shared by all tests."""

from __future__ import annotations

import signal
from pathlib import Path

from hypothesis import settings

import stridula

# The same examples in every run: a test that fails must fail again.
settings.register_profile("repeatable", derandomize=True, database=None)
settings.load_profile("repeatable")


def pytest_configure(config):
    """Compile the march anew where any kernel is newer: numba looks at the file of the function called only."""
    kernels = Path(stridula.__file__).parent / "_kernels"
    if not hasattr(config, "workerinput"):
        newest = max(path.stat().st_mtime for path in kernels.glob("*.py"))
        for compiled in (kernels / "__pycache__").glob("*.nb[ic]"):
            if compiled.stat().st_mtime < newest:
                compiled.unlink()


# A runner in the background starts with Ctrl-C ignored: tests of Ctrl-C need Python's own handler.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
