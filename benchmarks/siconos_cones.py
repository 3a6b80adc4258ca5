"""Solve closed contacts in space with Siconos' `FrictionContact(3)`; runs under a Python that has it, with NumPy alone.

``python3 siconos_cones.py cases.npz answers.npz`` reads for each case k ``compliance_k`` (3 n, 3 n), rows of normal and
both tangents of each contact, ``free_k`` (3 n,), displacements without forces, and ``friction_k`` (n,). It writes
``forces_k`` (3 n,), with signs such that displacements are free plus compliance times forces, and ``time_k`` [s].
"""

from __future__ import annotations

import sys
import time

import numpy as np
import siconos.numerics as sn

TOLERANCE, ITERATIONS = 1e-13, 100000


def solved(compliance: np.ndarray, free: np.ndarray, friction: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the forces by nonsmooth Gauss-Seidel, and the time it took [s]."""
    problem = sn.FrictionContactProblem(3, len(friction), compliance, free, friction)
    options = sn.SolverOptions(sn.SICONOS_FRICTION_3D_NSGS)
    options.dparam[sn.SICONOS_DPARAM_TOL] = TOLERANCE
    options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = ITERATIONS
    forces, velocity = np.zeros_like(free), np.zeros_like(free)
    began = time.perf_counter()
    sn.fc3d_driver(problem, forces, velocity, options)
    return forces, time.perf_counter() - began


def main(case_file: str, answer_file: str) -> None:
    """Solve all cases."""
    with np.load(case_file) as stored:
        cases = dict(stored)
    answers = {}
    for number in range(len(cases) // 3):
        given = (np.ascontiguousarray(cases[f"{word}_{number}"]) for word in ("compliance", "free", "friction"))
        answers[f"forces_{number}"], answers[f"time_{number}"] = solved(*given)
    np.savez(answer_file, **answers)


if __name__ == "__main__":
    main(*sys.argv[1:])
