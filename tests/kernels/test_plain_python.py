"""The march without compilation, as in a debugger, gives the results of the compiled one."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

import stridula as st

VARIABLES = ("normal_force", "tangential_force", "contact_position", "status", "drive_work")
# Time of each [s]: contacts on beams, rigid tracks and plates, of a law with a state, and in space.
CASES = {"squeal": 5e-4, "belt": 0.05, "lugre": 0.01, "squeal-on-plate": 2e-4, "pin-on-disc": 2e-5, "violin": 1e-4}
WITHOUT_COMPILER = """
import numba
import numpy as np
import stridula as st
assert numba.config.DISABLE_JIT
for name, duration in CASES.items():
    run = st.load_scenario(name).simulate(duration=duration)
    np.savez(f"{name}.npz", **{variable: run[variable].values for variable in VARIABLES})
"""


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The records of all cases from a process without a compiler."""
    folder = tmp_path_factory.mktemp("plain")
    code = f"CASES, VARIABLES = {CASES!r}, {VARIABLES!r}\n{WITHOUT_COMPILER}"
    surroundings = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    subprocess.run([sys.executable, "-c", code], cwd=folder, env=surroundings, check=True, timeout=300)
    return {name: np.load(folder / f"{name}.npz") for name in CASES}


@pytest.mark.parametrize("name", CASES)
def test_plain_python_marches_as_the_compiled_code(plain, name):
    compiled = st.load_scenario(name).simulate(duration=CASES[name])
    for variable in VARIABLES:
        scale = np.abs(compiled[variable].values).max()
        np.testing.assert_allclose(
            plain[name][variable], compiled[variable], rtol=1e-9, atol=1e-9 * scale, err_msg=variable
        )
