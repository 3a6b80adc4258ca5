"""Compilation happens once: the cache of one short run serves every kind of run in later processes."""

from __future__ import annotations

import json
import os
import pkgutil
import subprocess
import sys
from importlib import import_module

from numba.core.dispatcher import Dispatcher

from stridula import integration, lowering
from stridula._kernels import march
from stridula.integration.compiled_code import compiled_functions

from .caches import KERNEL, START, incomplete_cache

# A single contact, several in the plane or in space, alone or side by side; the start of one run in either.
KINDS, STARTS = 6, 2


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
    """Laws, sizes, schemes, options and types of numbers: a signature for each kind, in the cache since its first."""
    signatures = {one for words in ("alone", "abreast") for one in counts(words)[0][KERNEL]["signatures"]}
    assert len(signatures) == KINDS
    warm, waited = counts()
    assert waited == [0.0]
    assert named(warm, "compiled") == set()
    several = {name: len(counted["signatures"]) for name, counted in warm.items() if len(counted["signatures"]) > 1}
    assert several == {KERNEL: KINDS, START: STARTS}
    # Negative control: a kernel that is not in the cache, and the code of a law as an integer of one byte. Compiled
    # without optimisation, which takes a tenth of the time.
    surroundings = {"NUMBA_CACHE_DIR": str(incomplete_cache(tmp_path)), "NUMBA_OPT": "0"}
    without, waited = counts("other", "type", **surroundings)
    assert named(without, "compiled") == {KERNEL, "contact.friction.set_valued"}
    assert min(waited) > 0.0


def wrapped(function: Dispatcher) -> bool:
    return not function.targetoptions.get("no_cpython_wrapper")


def test_functions_called_from_python_have_a_wrapper():
    """Without one they crash."""
    modules = [
        import_module(f"{at.__name__}.{one.name}")
        for at in (integration, lowering)
        for one in pkgutil.iter_modules(at.__path__)
    ]
    called = {name: one for module in modules for name, one in vars(module).items() if isinstance(one, Dispatcher)}
    assert {"march", "solve_closed", "believed"} <= set(called)
    assert [name for name, one in called.items() if not wrapped(one)] == []
    assert not wrapped(march.begin)


def test_functions_do_not_inherit_how_they_are_compiled():
    """numba passes options on to functions without them: by chance, those whose caller happens to be compiled first.

    So much was once inlined by force that a first run took 280 s of compilation in place of 30.
    """
    functions = compiled_functions("stridula._kernels")
    assert len(functions) > 200
    for name, function in functions.items():
        missing = {"fastmath", "error_model", "forceinline"} - set(function.targetoptions)
        assert not missing, name
    # Nothing orders sums anew; the sines of waves alone may leave out a sign of zero and fuse products.
    fast = {name for name, one in functions.items() if one.targetoptions["fastmath"] is not False}
    assert fast == {"modes.waves.sine_and_cosine"}
