"""Compilation happens once: the cache of one short run serves every kind of run in later processes."""

from __future__ import annotations

import json
import os
import subprocess
import sys

KERNELS = {"march.march_run", "march.march_runs"}


def counts(cache, *words):
    """Counts of `every_kind` for each compiled function, and the time that its first run waited for compilation."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-m", "kernels.every_kind", *words]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    return said["functions"], said["compile_times"]


def named(seen, key):
    return {name for name, counted in seen.items() if counted[key]}


def test_nothing_compiles_twice(tmp_path):
    """Laws, sizes, schemes, options and types of numbers: one signature, in the cache since the first run.

    One test, since it compiles everything anew: some 20 s.
    """
    cold, waited = counts(tmp_path, "first")
    assert named(cold, "compiled") >= KERNELS
    assert min(waited) > 0.0
    warm, waited = counts(tmp_path)
    assert waited == [0.0]
    assert named(warm, "compiled") == set()
    assert named(warm, "loaded") >= KERNELS
    several = {name: counted["signatures"] for name, counted in warm.items() if len(counted["signatures"]) > 1}
    assert several == {}
    # Negative control: the code of a law as an integer of one byte.
    assert named(counts(tmp_path, "other", "type")[0], "compiled") == {"friction.set_valued"}
