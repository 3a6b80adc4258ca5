"""Settings shared by all tests."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import pytest
from hypothesis import settings

import stridula
from stridula.cli import main

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


@pytest.fixture(name="stridula")
def stridula_(monkeypatch, capsys, tmp_path):
    """Run the command line in an empty folder; return exit code, output and error."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["stridula", *arguments])
        with pytest.raises(SystemExit) as stop:
            main()
        captured = capsys.readouterr()
        return stop.value.code, captured.out, captured.err

    return run
