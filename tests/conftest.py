"""Settings shared by all tests."""

from __future__ import annotations

import os
import random
import signal
import sys
from pathlib import Path

import pytest
from hypothesis import settings
from threadpoolctl import threadpool_limits

from stridula.cli import main

# Linear algebra in one thread, here and in processes: threads that wait for one another beside other tests take
# several times the processor time.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
threadpool_limits(1)

# No test uses the cache of another one or of the user; processes inherit it.
os.environ["STRIDULA_CACHE_DIR"] = "off"

# Files that take about a minute come first, so that no process is left alone with one at the end.
LONGEST = (
    *("test_pages.py", "test_short_forms.py", "test_examples.py", "test_page.py", "test_page_features.py"),
    *("test_cases.py", "test_cases_in_space.py", "test_general_march.py"),
)

# The same examples in every run: a test that fails must fail again.
settings.register_profile("repeatable", derandomize=True, database=None)
settings.load_profile("repeatable")


def pytest_addoption(parser):
    parser.addoption("--order", type=int, metavar="SEED", help="seed of the order of the tests; another each time")


def pytest_configure_node(node):
    """Pass the order to a worker process."""
    node.workerinput["order"] = node.config.option.order


def pytest_collection_modifyitems(config, items):
    """Shuffle files, and the tests in each, equally in all processes; the longest files come first."""
    files: dict[Path, list[pytest.Item]] = {}
    for item in items:
        files.setdefault(item.path, []).append(item)
    shuffled, groups = random.Random(config.option.order), list(files.values())
    for group in (groups, *groups):
        shuffled.shuffle(group)
    groups.sort(key=lambda group: group[0].path.name not in LONGEST)
    items[:] = [item for group in groups for item in group]


def pytest_terminal_summary(terminalreporter, config):
    terminalreporter.write_line(f"in this order again: --order {config.option.order}")


def pytest_configure(config):
    """Draw the order."""
    if hasattr(config, "workerinput"):
        config.option.order = config.workerinput["order"]
    elif config.option.order is None:
        config.option.order = random.SystemRandom().randrange(10**6)


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
