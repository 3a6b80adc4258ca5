"""Continuation of a run from the record of another, with the checks that it is possible."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from .._kernels.layout import columns as at
from ..arrays import Array
from ..checks import ArgumentError, brief, instance, listed
from ..lowering import Assembly, Signal, with_motion_so_far, with_travel
from ..lowering.blocks import Recurrence
from ..lowering.contact_rows import STATEFUL
from ..lowering.schemes import Scheme
from ..records import Probe
from ..records.provenance import scenario_toml
from ..records.state import LAYOUT, State
from ..system import System
from .probe_records import memory_of
from .timing import Timing

STATE = ("modal", "remainder", "carried", "springs", "energies")
ATTRIBUTES = ("ended", "scenario", "scheme", "step", "steps_per_sample", "last_step", "initial_energy")
# Larger states overflow in the units of the march.
LARGEST = 1e100
OTHER_VERSION = "a record of another version runs again, but cannot be continued"


def state_of(
    start: xr.Dataset, system: System, arrays: Assembly, scheme: Scheme, timing: Timing, probes: Sequence[Probe]
) -> State:
    """Return the state at the end of a record, for a run that continues it.

    Raises
    ------
    ValueError
        If the record does not end in a state that can be continued, or if the system differs in more than drives,
        friction and duration.
    """
    state, attributes = state_at_end(start, arrays), start.attrs
    for name, value in (("scheme", scheme.name), ("step", timing.step), ("steps_per_sample", timing.ratio)):
        if attributes[name] != value:
            raise ArgumentError("start", f"have the same {name} as this run, {value!r}", attributes[name])
    columns = start["state_raw"].shape[-1:]
    if columns != (len(arrays.probes),):
        raise ArgumentError(
            "start", f"have the same number of probes, {len(arrays.probes)}", start, got=_count(columns)
        )
    instance("start.scenario", attributes["scenario"], str)
    before, now = (tomllib.loads(text) for text in (attributes["scenario"], scenario_toml(system, probes, {})))
    knows_motion = "state_motion" in start
    _check_frozen(_frozen(before, knows_motion), _frozen(now, knows_motion))
    # Without probes, or after an immediate interruption, the low-pass needs no values.
    memory = memory_of(timing) if len(arrays.probes) and start.sizes["time"] else 0
    _check_values(start, {"raw": (memory, len(arrays.probes))})
    return state


def state_at_end(start: xr.Dataset, arrays: Assembly) -> State:
    """Return the state at the end of a record, for a system with as many modes and contacts.

    Raises
    ------
    ValueError
        If the record does not end in a state that can be continued.
    """
    instance("start", start, xr.Dataset)
    needed = ("time", *(f"state_{name}" for name in STATE), "state_raw")
    if any(name not in start.variables for name in needed):
        raise ArgumentError(
            "start", "be a record of simulate with its final state", start, got=f"variables {listed(map(str, start))}"
        )
    attributes = start.attrs
    missing = [name for name in ATTRIBUTES if name not in attributes]
    if missing:
        raise ArgumentError("start", "have the attributes of a record", start, got=f"one without {listed(missing)}")
    if attributes["ended"] not in ("finished", "interrupted"):
        raise ArgumentError(
            "start", "be a run that can be continued", start, got=f"one that ended {attributes['ended']!r}"
        )
    if attributes.get("state_layout") != LAYOUT:
        got = attributes.get("state_layout", "none")
        raise ArgumentError(
            "start", f"have the state_layout of this version, {LAYOUT}", got, got=f"{brief(got)}: {OTHER_VERSION}"
        )
    modes = start["state_modal"].shape[-1:]
    if modes != (arrays.mode_count,):
        raise ArgumentError(
            "start", f"have the same number of modes as this system, {arrays.mode_count}", start, got=_count(modes)
        )
    _check_whole(start)
    modal, contacts = (2, arrays.mode_count), len(arrays.contacts)
    shapes = {
        "modal": modal,
        "remainder": modal,
        "carried": (contacts, at.CARRIED),
        "springs": (len(arrays.springs.bends),),
        "energies": (at.ENERGIES,),
        "motion": (3, contacts, at.MOTIONS),
    }
    _check_values(start, shapes)
    return State(*(np.array(start[f"state_{name}"].values, dtype=float, order="C") for name in STATE))


def _count(shape: tuple[int, ...]) -> int:
    return shape[0] if shape else 0


def _check_whole(start: xr.Dataset) -> None:
    """Raise a ValueError if the final state of a record does not belong to its last sample."""
    attributes, times = start.attrs, start["time"].values
    step, last = float(attributes["step"]), int(attributes["last_step"])
    if last and not (times.size and abs(times[-1] - last * step) < 0.5 * step):
        got = f"{times[-1]:.6g} s" if times.size else "none"
        raise ArgumentError(
            "start",
            f"be a complete record, up to its final state at {last * step:.6g} s",
            start,
            got=f"a last time of {got}: part of a record cannot be continued; run up to that time instead",
        )


def _check_values(start: xr.Dataset, shapes: dict[str, tuple[int, ...]]) -> None:
    """Raise a ValueError if parts of a state do not have the layout of the march."""
    for name, shape in shapes.items():
        if f"state_{name}" not in start:
            continue
        values = start[f"state_{name}"].values
        if values.shape != shape:
            raise ArgumentError(
                "start",
                f"have a state_{name} of shape {shape}, as this version keeps it",
                start,
                got=f"{values.shape}: {OTHER_VERSION}",
            )
        if values.dtype.kind not in "fiu" or not (np.abs(values) < LARGEST).all():
            raise ArgumentError("start", f"have a finite state_{name}", start, got="one that is not")


def imposed_at(arrays: Assembly, last_step: int, step: float) -> dict[str, float]:
    """Return distance [m] and velocity [m/s] of the root by an imposed velocity after some steps."""
    time = np.array([last_step * step])
    signals = {"root_travel": arrays.signals.displacement, "root_velocity": arrays.signals.velocity}
    return {name: float(signal(time, step)[0]) for name, signal in signals.items()}


def moved_on(
    start: xr.Dataset, system: System, arrays: Assembly, modes: Recurrence, state: State, step: float
) -> tuple[Assembly, Array]:
    """Return a system whose root and rigid tracks continue from the end of a record, perhaps at other velocities.

    A change of the root's velocity does not change that of the body at once: `state` is changed accordingly, and the
    energy of this change, in the frame of the root, is work of the drive. Bodies that stick to a belt must follow it.

    Returns
    -------
    arrays : Assembly
        The system.
    offset : ndarray, shape (contacts, motions)
        Displacement of its contacts in addition to its description [m].
    """
    described = arrays.motion
    arrays = _root_moved_on(start, system, arrays, modes, state, step)
    last = int(start.attrs["last_step"])
    here = motion_about(described, last, step)
    if "state_motion" not in start:
        return arrays, motion_about(arrays.motion, last, step)[1] - here[1]
    kept = start["state_motion"].values
    # If nothing has changed, the motion is exactly as before: a run then continues bit by bit.
    was, offset = kept[:2], kept[2] + (kept[1] - here[1])
    turns = not np.array_equal(here, was)
    if turns or offset.any():
        moved = replace(arrays, motion=described)
        arrays = with_motion_so_far(moved, offset, last * step, was[0] + kept[2] if turns else None)
    return arrays, offset


def motion_about(motion: Signal, last_step: int, step: float) -> Array:
    """Return the motions of the contacts after some steps and one step earlier [m], shape (2, contacts, motions)."""
    return motion(np.array([last_step - 1, last_step]) * step, step)


def _root_moved_on(
    start: xr.Dataset, system: System, arrays: Assembly, modes: Recurrence, state: State, step: float
) -> Assembly:
    if not {"root_travel", "root_velocity"} <= set(start.attrs) or system.imposed_velocity is None:
        return arrays
    now = imposed_at(arrays, int(start.attrs["last_step"]), step)
    travel, faster = (now[name] - float(start.attrs[name]) for name in ("root_travel", "root_velocity"))
    if travel:
        arrays = with_travel(arrays, system, -travel)
    if faster:
        body: Any = system.imposed_velocity.point.body
        span = slice(*arrays.spans[system.body_name(body)])
        before = modes.stored_energy(state.modal)
        state.modal[at.D, span] -= faster * step * body.modes(True).translation[0]
        after = modes.stored_energy(state.modal)
        state.energies[at.DRIVE_WORK] += after - before
        state.energies[at.STORED] = after
    return arrays


def _frozen(tables: dict[str, Any], knows_motion: bool) -> dict[str, Any]:
    """Return the part of a scenario that must be equal in a continued run: all but drives, friction and timing.

    If a record lacks the displacement of its rigid tracks, their motion must also be equal.
    """
    kept = {name: value for name, value in tables.items() if name not in ("drives", "simulation")}
    kept["probes"] = tables["simulation"]["probes"]
    if "contact" in kept:
        kept["contact"] = _without_friction(kept["contact"])
    if "contacts" in kept:
        kept["contacts"] = [_without_friction(contact) for contact in kept["contacts"]]
        if knows_motion:
            kept["contacts"] = [_without_motion(contact) for contact in kept["contacts"]]
    return kept


def _without_friction(contact: dict[str, Any]) -> dict[str, Any]:
    name = contact["friction"]["law"]
    return {**contact, "friction": name if name in STATEFUL else None}


def _without_motion(contact: dict[str, Any]) -> dict[str, Any]:
    track = contact["track"]
    if track["kind"] != "rigid":
        return contact
    return {**contact, "track": {name: track[name] for name in ("kind", "name", "profile") if name in track}}


def _check_frozen(before: Any, now: Any, path: str = "") -> None:
    """Raise a ValueError that names the first value that differs."""
    if isinstance(before, dict) and isinstance(now, dict):
        for name in dict.fromkeys((*now, *before)):
            _check_frozen(before.get(name), now.get(name), f"{path}.{name}" if path else name)
    elif _is_tables(before) and _is_tables(now) and len(before) == len(now):
        for number, pair in enumerate(zip(before, now, strict=True)):
            _check_frozen(*pair, f"{path}.{number}")
    elif before != now:
        raise ArgumentError("start", f"have the same {path} as this run, {brief(now)}", before)


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(entry, dict) for entry in value)
