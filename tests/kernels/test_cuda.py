"""The march on a graphics card, by numba's simulator, and the error without a card."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

import stridula
from kernels.on_the_simulator import CASES
from stridula._kernels.layout import columns as at
from stridula.integration import cuda_march

TOLERANCE = 1e-9
# The tests' folder and the package under test.
PATHS = (Path(__file__).parents[1], Path(stridula.__file__).parents[1])


@pytest.fixture(scope="module")
def comparisons():
    """Results of the simulator by case; it is selected when numba is imported, so it needs another interpreter."""
    words = {"NUMBA_ENABLE_CUDASIM": "1", "PYTHONPATH": os.pathsep.join(map(str, PATHS))}
    program = [sys.executable, "-m", "kernels.on_the_simulator"]
    done = subprocess.run(program, env=os.environ | words, capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("case", CASES)
def test_a_thread_marches_a_run_as_it_marches_alone(comparisons, case):
    found = comparisons[case]
    assert max(found["differences"].values()) < TOLERANCE, found["differences"]
    assert min(found["apart"]) < 1.0, "no contact, nothing tested"


@pytest.mark.parametrize("case", CASES)
def test_neighbouring_runs_are_distinguished(comparisons, case):
    """Negative control: a run equal to its neighbour's would be detected."""
    assert comparisons[case]["beside"] > 1e-3


@pytest.mark.parametrize("case", CASES)
def test_no_thread_writes_where_another_one_does(comparisons, case):
    """The simulator runs one thread after the other, and would not detect it."""
    found = comparisons[case]
    assert set(found["columns"].values()) == {len(found["ended"])}, found["columns"]


def test_a_run_that_leaves_its_track_leaves_the_others_alone(comparisons):
    assert comparisons["off the track"]["ended"] == [at.FINISHED, at.OFF_TRACK, at.FINISHED]


def test_without_numba_cuda_the_package_to_install_is_named(monkeypatch):
    monkeypatch.setattr(cuda_march, "find_spec", lambda name: None)
    with pytest.raises(
        RuntimeError, match=r'device="cuda" needs numba-cuda, .*: pip install "\.\[cuda\]" in the source folder$'
    ):
        cuda_march.require_cuda()


@pytest.mark.parametrize(
    ("error", "words"),
    [
        ("\nCUDA driver library cannot be found.\nEnsure that...\n", "the NVIDIA driver, which was not found"),
        ("CUDA_ERROR_NO_DEVICE (100)", "a GPU: there is a driver but no GPU"),
        ("CUDA_ERROR_SYSTEM_DRIVER_MISMATCH\n(803)", r"CUDA to work: CUDA_ERROR_SYSTEM_DRIVER_MISMATCH \(803\)"),
    ],
)
def test_without_a_gpu_one_line_says_what_is_missing(monkeypatch, error, words):
    pytest.importorskip("numba.cuda")
    monkeypatch.setattr(cuda_march, "find_spec", lambda name: object())
    monkeypatch.setattr(numba.cuda, "is_available", lambda: False)
    monkeypatch.setattr(numba.cuda, "cuda_error", lambda: error)
    with pytest.raises(RuntimeError, match=f'^device="cuda" needs {words}$'):
        cuda_march.CudaMarch([], [], 1e-6, 1)
