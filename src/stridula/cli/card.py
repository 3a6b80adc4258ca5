"""The closing card of a run."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..analysis import bursts, dominant_frequency, regime_of
from ..analysis.phases import inside
from ..records.variables import ENERGY, STATUS_WORDS

ENDINGS = {
    "finished": "finished",
    "off the track": "the tip ran off the end of its track",
    "not finite": "failed: the state is no longer finite",
    "contact unsolved": "failed: the contact forces were not found",
    "energy created": "failed: energy came from nowhere",
    "interrupted": "interrupted",
}
# Relative changes of a force below are rounding, not vibration.
STEADY = 1e-9


def print_card(record: xr.Dataset, title: str, files: list[str], doubtful: list[str]) -> None:
    """Print what came of a run, and which of its values are doubtful."""
    table = Table(title=escape(title), show_header=False, title_justify="left")
    for name, words in card(record).items():
        table.add_row(name, escape(words))
    if doubtful:
        table.add_row("doubtful", escape("\n".join(doubtful)))
    if files:
        table.add_row("written", escape("\n".join(files)))
    Console().print(table)


def card(record: xr.Dataset) -> dict[str, str]:
    """Return what came of a run, in words."""
    interval, samples = record.attrs["sample_interval"], record.sizes["time"]
    end = float(record["time"][-1]) if samples else 0.0
    lines = {"ended": f"{ENDINGS[record.attrs['ended']]} at t = {end:.6g} s"}
    if samples:
        lines |= _contact(record) | _energy(record)
    wall_time = record.attrs["wall_time"]
    compile_time = record.attrs.get("compile_time", 0.0)
    compiled = f", after {compile_time:.2g} s of compiling" if compile_time else ""
    lines["took"] = f"{wall_time:.3g} s, {samples * interval / max(wall_time, 1e-9):.2f} x real time{compiled}"
    lines["step"] = f"{record.attrs['step']:.4g} s, {record.attrs['scheme']}, {record.attrs['modes']} modes"
    return lines


def _contact(record: xr.Dataset) -> dict[str, str]:
    """Return what came of the contact, or of each of several on a line of its own."""
    if "contact" in record.dims:
        names = [str(name) for name in record["contact"].values]
        lines = {
            name: "; ".join(words for words in _one_contact(record.sel(contact=name)).values() if words[:4] != "none")
            for name in names
        }
        unsolved = int(record["unsolved_steps"].sum())
        return lines | ({"unsolved": f"{unsolved} steps with contact forces out of tolerance"} if unsolved else {})
    return _one_contact(record)


def _one_contact(record: xr.Dataset) -> dict[str, str]:
    shares = record["status_share"].mean("time").values
    force, place = record["normal_force"].values, record["contact_position"].values
    jammed = int(record["jammed_steps"].sum())
    lines = {
        "status": ", ".join(f"{word} {100 * share:.1f} %" for word, share in zip(STATUS_WORDS, shares, strict=True)),
        "tip": f"from {place[0]:.4g} m to {place[-1]:.4g} m along the track",
        "normal force": f"mean {force.mean():.4g} N, peak {force.max():.4g} N",
        "dominant frequency": _frequency(record),
        "regime": _regime(record),
    }
    return lines | ({"jammed": f"{jammed} steps in which sliding would have jammed"} if jammed else {})


def _frequency(record: xr.Dataset) -> str:
    """Return the dominant frequency of the normal force, between the stops where there are any."""
    force = record["normal_force"].values
    if force.size < 2:
        return "none"
    between = bursts(record)
    # The first sample is where the load comes on.
    heard = force[inside(record, between)] if len(between) else force[1:]
    if np.ptp(heard) <= STEADY * np.abs(force).max():
        return "none, the normal force is constant"
    frequency = dominant_frequency(record["normal_force"], between if len(between) else None)
    where = " of the normal force" + (" between the stops" if len(between) else "")
    return "none" if math.isnan(frequency) else f"{frequency:.4g} Hz{where}"


def _regime(record: xr.Dataset) -> str:
    """Return the regime, which takes at least 2 samples."""
    if record.sizes["time"] < 2:
        return "none"
    found = regime_of(record)
    return f"{found['regime']} (confidence {found['confidence']:.2f})"


def _energy(record: xr.Dataset) -> dict[str, str]:
    largest = {variable.name: float(np.abs(record[variable.name]).max()) for variable in ENERGY}
    residual = largest.pop("ledger_residual")
    term = max(largest, key=largest.__getitem__)
    share = residual / largest[term] if largest[term] else 0.0
    return {"energy ledger": f"residual {share:.1e} of the largest term, {term}"}
