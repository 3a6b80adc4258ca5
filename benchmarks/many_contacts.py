"""The march of many contacts against hand-written C of the same step (contacts.c): ratio of the times per step.

A body of 100 and 200 modes pressed on a belt at 8, 20 and 40 points, Coulomb's law, ledger included. Needs gcc;
skipped without.
"""

from __future__ import annotations

import ctypes
import tempfile
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path

import numpy as np

import stridula as st
from against_c import Result, built, parameters, without_gcc
from ratios import Ratio, must_agree, over, seconds, show, sized
from stridula._kernels.contacts import sweeps as kernel
from stridula._kernels.layout import columns as at
from stridula.integration.marches import March
from stridula.lowering.packing import aligned, scale_of
from systems import case_of, limit_of, slab

TITLE = "time of a step of many contacts over that of hand-written C"
SOURCE = Path(__file__).with_name("contacts.c")
CASES = sized([(8, 100), (8, 200), (20, 100), (20, 200), (40, 100), (40, 200)], [(8, 100)])
STEPS, RATIO = sized(10_000, 1_000), 10
TOLERANCE, BAR = 1e-6, 1.5


class Pair:
    """A system prepared for the march of the package and of C."""

    def __init__(self, contacts: int, modes: int, compiled: ctypes.CDLL) -> None:
        system = slab(contacts, modes)
        self.step = 0.2 * limit_of(system)
        self.belt = system.contacts[0].track.velocity * self.step
        self.case = case_of(system, self.step, STEPS)
        self.march = March([self.case.blocks], [self.case.state], self.step, RATIO)
        self.compiled, self.count = compiled, contacts

    def ours(self) -> Result:
        """March the package and return its results."""
        march = self.march.copy()
        (chunk,) = march.advance([self.case.imposed], STEPS // RATIO)
        (state,) = march.states
        return result(state.modal[at.Q], state.energies, chunk.contacts[:, :, [at.NORMAL_FORCE, at.TANGENTIAL_FORCE]])

    def theirs(self) -> Result:
        """March C and return its results."""
        modes, contacts, state = self.case.blocks.modes, self.case.blocks.contacts, deepcopy(self.case.state)
        scale, count, solve = scale_of(modes), self.count, st.GaussSeidel()
        size, number = 2 * count, scale.size
        q, d = (np.ascontiguousarray(row) for row in state.modal / scale)
        arrays = {
            "kept": modes.block[at.B], "stiffness": modes.block[at.R], "load": modes.loads.sum(axis=0) / scale,
            "rows": contacts.rows * scale, "w": contacts.compliance.T,
            "opening": contacts.constants[:, at.GAP], "q": q, "d": d, "carried": state.carried.ravel(),
            "ledger": np.zeros(at.ENERGIES), "sums": np.zeros(6),
            "scratch": aligned(1, 3 * number + 4 * size + 3 * count + size * size)[0],
        }  # fmt: skip
        arrays = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
        numbers = {"mu": 0.4, "tolerance": solve.tolerance, "belt": self.belt}
        sizes = {"modes": number, "count": count, "most_sweeps": solve.sweeps}
        given = {
            "steps": ctypes.c_long(STEPS),
            **{name: ctypes.c_int(size) for name, size in sizes.items()},
            **{name: ctypes.c_double(number) for name, number in numbers.items()},
            **{name: array.ctypes.data_as(ctypes.c_void_p) for name, array in arrays.items()},
        }
        self.compiled.march(*(given[name] for name in parameters(SOURCE)))
        return result(arrays["q"] * scale, arrays["ledger"], arrays["sums"][1:3] / RATIO)


def result(positions: np.ndarray, ledger: np.ndarray, forces: np.ndarray) -> Result:
    """Return the results that must agree: forces are sums over all contacts and samples."""
    kept = [at.CONTACT_WORK, at.FRICTION_LOSS, at.DAMPING_LOSS]
    return {"positions": positions, "ledgers": ledger[kept], "forces": forces.reshape(-1, 2).sum(axis=0)}


def agree(found: Result, expected: Result) -> None:
    """Exit if the results of the two marches differ."""
    for quantity, values in found.items():
        must_agree(f"{quantity} of the march and of contacts.c", values, expected[quantity], TOLERANCE)


def rows() -> Iterator[Ratio | str]:
    """Yield a ratio for each size."""
    if missing := without_gcc():
        yield missing
        return
    with tempfile.TemporaryDirectory() as folder:
        compiled = built(Path(folder), SOURCE, vars(kernel))
        for contacts, modes in CASES:
            pair = Pair(contacts, modes, compiled)
            theirs, ours = seconds(pair.theirs, pair.ours, agree=agree)
            yield Ratio(f"{contacts} contacts, {modes} modes", over(ours, theirs), most=BAR)


if __name__ == "__main__":
    show(TITLE, rows())
