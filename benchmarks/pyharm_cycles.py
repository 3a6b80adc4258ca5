"""Search periodic motions by harmonic balance with pyHarm; needs a Python with pyHarm and NumPy only.

``python pyharm_cycles.py cases.npz answers.npz`` reads cases numbered from 0. Arrays of each, with its number appended:

mass, damping, stiffness (coordinates, coordinates)
    Matrices [kg, N s/m, N/m].
push, pushed
    Amplitude of a force times the cosine of its phase [N], and the coordinate on which it acts.
touching
    Coordinate of the contact with the ground.
friction, gap
    Force of dry friction, softened by a spring in series, a Jenkins element [N], or NaN; otherwise the displacement at
    which a stop on a spring is met [m].
harmonics (harmonics,), samples
    Harmonics of the motion, and samples of a period for the force of the contact.
contact, angular (searches,)
    Stiffness of the spring of the contact [N/m] and angular frequency of the force [rad/s] of each search. A search
    begins at the last motion found; if it fails, another one is made between.

Arrays of the answers, also numbered:

motion (searches, harmonics, coordinates)
    Complex amplitudes of ``exp(i n w t)`` [m].
residual (searches,)
    Norm of the equations that are left [N].
"""

from __future__ import annotations

import logging
import os
import sys
import warnings
from typing import Any

# Neither a search for accelerators nor its warnings.
os.environ.setdefault("JAX_PLATFORMS", "cpu")
warnings.simplefilter("ignore")
logging.disable(logging.CRITICAL)

import numpy as np  # noqa: E402
from pyHarm.Maestro import Maestro  # noqa: E402

BODY = "body"
# Powell's hybrid method: plain Newton steps fail where a contact sticks.
SOLVER = {"root": {"method": "hybr", "options": {"xtol": 1e-11, "maxfev": 500}}}
# Largest residual of a motion that counts as found [N].
SOLVED = 1e-6
# How often the way to a motion is halved.
HALVINGS = 3

Case = dict[str, np.ndarray]


def model(case: Case, contact: float, angular: float) -> dict[str, Any]:
    """Return the input of pyHarm for a stiffness of the contact and an angular frequency."""
    count = len(case["mass"])
    matrices = {"M": case["mass"], "C": case["damping"], "K": case["stiffness"]}
    at_contact = {"connect": {BODY: [int(case["touching"])], "GROUND": [0]}, "dirs": [0], "k": contact}
    friction = float(case["friction"])
    if np.isnan(friction):
        touching = {"type": "PenaltyUnilateralGap", "g": float(case["gap"])}
    else:
        touching = {"type": "Jenkins", "mu": friction, "N0": 1.0}
    push = {"connect": {BODY: [int(case["pushed"])]}, "dirs": [0], "amp": float(case["push"])}
    search = {"study": "frf", "solver": "scipyroot", "solver_options": SOLVER, "verbose": False}
    return {
        "analysis": {"search": search | {"puls_inf": angular, "puls_sup": angular, "puls_start": angular}},
        "system": {"type": "Base", "nh": [int(n) for n in case["harmonics"]], "nti": int(case["samples"])},
        "substructures": {BODY: {"matrix": matrices, "nnodes": count, "ndofs": 1, "matching": [0]}},
        "connectors": {"push": {"type": "CosinusForcing"} | push, "touching": touching | at_contact},
    }


class Search:
    """The search of a motion from the last one found.

    Parameters
    ----------
    case : dict of ndarray
        The case.

    Attributes
    ----------
    found : ndarray or None
        Unknowns of the last motion found, None before the first.
    at : ndarray, shape (2,)
        Stiffness of the contact and angular frequency of that motion [N/m, rad/s].
    """

    def __init__(self, case: Case) -> None:
        self.case = case
        self.found: np.ndarray | None = None
        self.at = np.zeros(2)

    def motion(self, to: np.ndarray, halvings: int = HALVINGS) -> tuple[np.ndarray, float]:
        """Return complex amplitudes, shape (harmonics, coordinates), and residual at a stiffness and a frequency.

        A search that fails is repeated after one half-way.
        """
        motion, residual = self.attempt(to)
        if residual > SOLVED and halvings and self.found is not None:
            self.motion(np.sqrt(self.at * to), halvings - 1)
            motion, residual = self.motion(to, halvings - 1)
        return motion, residual

    def attempt(self, to: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the same of a single search."""
        peer = Maestro(model(self.case, *map(float, to)))
        search = peer.nls["search"]
        search.initialise(self.found)
        solution = search.SolList[-1]
        unknowns, residual = solution.x[:-1], float(np.linalg.norm(solution.R_solver))
        if residual <= SOLVED:
            self.found, self.at = unknowns, to
        rows = {int(n): row for row, n in enumerate(self.case["harmonics"])}
        motion = np.zeros((len(rows), len(self.case["mass"])), complex)
        for place, unknown in zip(unknowns, peer.system.expl_dofs.itertuples(), strict=True):
            motion[rows[unknown.harm], unknown.node_num] += place if unknown.cs == "c" else -1j * place
        return motion, residual


def main(cases_file: str, answers_file: str) -> None:
    """Search the motions of all cases."""
    with np.load(cases_file) as stored:
        arrays = dict(stored)
    answers = {}
    for number in range(sum(name.startswith("mass_") for name in arrays)):
        end = f"_{number}"
        case = {name.removesuffix(end): array for name, array in arrays.items() if name.endswith(end)}
        search = Search(case)
        path = np.column_stack([case["contact"], case["angular"]])
        found, residuals = zip(*map(search.motion, path), strict=True)
        answers["motion" + end], answers["residual" + end] = np.array(found), np.array(residuals)
    np.savez(answers_file, **answers)


if __name__ == "__main__":
    main(*sys.argv[1:])
