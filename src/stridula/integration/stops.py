"""Reasons why a run stops before its end, in words."""

from __future__ import annotations

import numpy as np
import xarray as xr

from .._kernels.layout import columns as at
from ..arrays import Array
from ..checks import listed
from ..lowering import Assembly
from ..lowering.blocks import Blocks
from ..records.state import State
from ..records.variables import STATUS_WORDS

ENDED = {
    at.FINISHED: "finished",
    at.OFF_TRACK: "off the track",
    at.NOT_FINITE: "not finite",
    at.CONTACT_UNSOLVED: "contact unsolved",
    at.ENERGY_CREATED: "energy created",
    at.TOO_STIFF: "spring too stiff",
}
WHAT = {
    "not finite": "the state is no longer finite",
    "contact unsolved": "the contact forces did not converge",
    "energy created": "energy was created",
    "spring too stiff": "the step is too long for the slope that a nonlinear spring or dashpot has reached",
}
CAUSE = {
    "not finite": "an instability that grows without bound, or drives far too large",
    "contact unsolved": "bodies squeezed between others, too much friction in several contacts, or too few sweeps",
    "energy created": "a step too long for the contact, numbers at the limits of arithmetic, or a fault of the model",
    "spring too stiff": "a larger stretch or velocity than at the start: give a shorter step",
}
# Words for a status in the step that was not solved: the last is that of a contact that stopped in it.
STATUS_IN_STEP = (*STATUS_WORDS, "sticking")
# Longest list of contacts in a message, unless the first one alone is longer.
LONGEST_WORDS = 150


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a run; `record` has the record so far, `reason` the time in words."""

    def __init__(self, record: xr.Dataset) -> None:
        self.record, self.reason = record, f"interrupted at t = {_end(record):.6g} s"
        super().__init__(f"{self.reason}; see .record")


class Diverged(RuntimeError):
    """A run whose result is not valid; `record` has the record up to then, `reason` the cause in words."""

    def __init__(self, record: xr.Dataset, contacts: str) -> None:
        self.record = record
        self.reason = divergence_words(record.attrs["ended"], _end(record), record.attrs["step"], contacts)
        super().__init__(self.reason)


def _end(record: xr.Dataset) -> float:
    return float(record.sizes["time"] * record.attrs["sample_interval"])


def divergence_words(ended: str, time: float, step: float, contacts: str) -> str:
    """Return the time [s] up to which a result is valid, and the cause, in words."""
    return f"{WHAT[ended]} after t = {time:.6g} s (step {step:.3g} s); {contacts}; likely cause: {CAUSE[ended]}"


def contact_words(names: tuple[str, ...], carried: Array) -> str:
    """Return the last state of the contacts in words; of many, those with the largest normal forces."""
    lines = [
        f"{name} {STATUS_IN_STEP[int(one[at.STATUS])]} at {one[at.ABSCISSA]:.6g} m with {one[at.LAST_NORMAL]:.4g} N "
        f"normal, {one[at.LAST_TANGENTIAL]:.4g} N tangential"
        for name, one in zip(names, carried, strict=True)
    ]
    hardest = np.argsort(-np.abs(np.nan_to_num(carried[:, at.LAST_NORMAL], nan=np.inf)), kind="stable")
    return listed([lines[number] for number in hardest], longest=LONGEST_WORDS)


def rank_words(arrays: Assembly, blocks: Blocks, state: State) -> str:
    """Return rank and condition of the compliance of the closed contacts, in words."""
    places = state.carried[:, at.ABSCISSA]
    closed = np.flatnonzero(state.carried[:, at.STATUS] > 0)
    rows = [arrays.contacts[i].rows_at(float(places[i])) for i in closed]
    if not rows or not np.isfinite(places[closed]).all():
        return "no contact is closed"
    flat = np.concatenate(rows)
    sizes = np.linalg.svd(flat @ blocks.modes.mobility(flat).T, compute_uv=False)
    rank = int(np.sum(sizes > sizes[0] * len(sizes) * np.finfo(float).eps))
    condition = f"{sizes[0] / sizes[-1]:.1e}" if rank == len(sizes) else "infinite"
    return f"their compliance has rank {rank} of {len(sizes)} and condition {condition}"
