"""Solve faces of points in contact with Siconos; runs under a Python that has it, with NumPy alone.

``python3 siconos_faces.py problems.npz answers.npz`` reads for each problem k ``compliance_k`` (rows, rows), rows of
the normal and the tangents of each point, ``free_k`` (rows,), displacements without forces, ``friction_k`` (points,)
and ``start_k`` (rows,), forces to start from. It writes ``gauss_seidel_k`` and ``newton_k`` (rows,), forces with signs
such that displacements are free plus compliance times forces, and ``gauss_seidel_steps_k`` and ``newton_steps_k``.
"""

from __future__ import annotations

import sys

import numpy as np
import siconos.numerics as sn

TOLERANCE, SWEEPS, STEPS = 1e-12, 10000, 200

Given = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def solved(given: Given, name: str, most: int) -> tuple[np.ndarray, int]:
    """Return the forces by a solver, and the number of its iterations."""
    compliance, free, friction, start = given
    own = len(free) // len(friction)
    problem = sn.FrictionContactProblem(own, len(friction), compliance, free, friction)
    options = sn.SolverOptions(getattr(sn, name))
    options.dparam[sn.SICONOS_DPARAM_TOL] = TOLERANCE
    options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = most
    forces, velocity = start.copy(), free + compliance @ start
    (sn.fc3d_driver if own == 3 else sn.fc2d_driver)(problem, forces, velocity, options)
    return forces, int(options.iparam[sn.SICONOS_IPARAM_ITER_DONE])


def in_space(given: Given) -> Given:
    """Return a problem of the plane as one of space, without motion along the second tangent."""
    compliance, free, friction, start = given
    rows = (3 * np.arange(len(friction))[:, None] + np.arange(2)).ravel()
    wide = np.eye(3 * len(friction))
    wide[np.ix_(rows, rows)] = compliance
    motion, force = np.zeros((2, len(wide)))
    motion[rows], force[rows] = free, start
    return wide, motion, friction, force


def by_newton(given: Given) -> tuple[np.ndarray, int]:
    """Return the forces by the nonsmooth Newton method of Alart and Curnier, which Siconos has in space."""
    flat = len(given[1]) == 2 * len(given[2])
    forces, steps = solved(in_space(given) if flat else given, "SICONOS_FRICTION_3D_NSN_AC", STEPS)
    return forces.reshape(-1, 3)[:, :2].ravel() if flat else forces, steps


def main(problem_file: str, answer_file: str) -> None:
    """Solve all problems."""
    with np.load(problem_file) as stored:
        problems = dict(stored)
    answers = {}
    for k in range(len(problems) // 4):
        words = ("compliance", "free", "friction", "start")
        given: Given = tuple(np.ascontiguousarray(problems[f"{word}_{k}"]) for word in words)
        where = 3 if len(given[1]) == 3 * len(given[2]) else 2
        sweeping = solved(given, f"SICONOS_FRICTION_{where}D_NSGS", SWEEPS)
        answers[f"gauss_seidel_{k}"], answers[f"gauss_seidel_steps_{k}"] = sweeping
        answers[f"newton_{k}"], answers[f"newton_steps_{k}"] = by_newton(given)
    np.savez(answer_file, **answers)


if __name__ == "__main__":
    main(*sys.argv[1:])
