"""Compilation happens once: the cache of one short run serves every kind of run in later processes."""

from __future__ import annotations

import json
import os
import subprocess
import sys

from .caches import KERNEL, incomplete_cache

KERNELS = {f"march.march_{kind}" for kind in ("single", "several", "single_abreast", "several_abreast")}


def counts(*words, **environment):
    """Return what `every_kind` counts for each compiled function, and the time its first run waited for compilation."""
    surroundings = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)} | environment
    command = [sys.executable, "-m", "kernels.every_kind", *words]
    done = subprocess.run(command, env=surroundings, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    counted = json.loads(done.stdout)
    return counted["functions"], counted["compile_times"]


def named(functions, key):
    return {name for name, counted in functions.items() if counted[key]}


def test_nothing_compiles_twice(tmp_path):
    """Laws, sizes, schemes, options and types of numbers: one signature, in the cache since the first run."""
    first, _ = counts("first")
    assert named(first, "compiled") | named(first, "loaded") >= KERNELS
    warm, waited = counts()
    assert waited == [0.0]
    assert named(warm, "compiled") == set()
    assert named(warm, "loaded") >= KERNELS
    several = {name: counted["signatures"] for name, counted in warm.items() if len(counted["signatures"]) > 1}
    assert several == {}
    # Negative control: a kernel that is not in the cache, and the code of a law as an integer of one byte. Compiled
    # without optimisation, which takes a tenth of the time.
    surroundings = {"NUMBA_CACHE_DIR": str(incomplete_cache(tmp_path)), "NUMBA_OPT": "0"}
    without, waited = counts("other", "type", **surroundings)
    assert named(without, "compiled") == {KERNEL, "friction.set_valued"}
    assert min(waited) > 0.0
