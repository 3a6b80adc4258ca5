"""Conversion of the arrays of a march to a labelled xarray.Dataset."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies.modes import Body
from ..system import System
from .probes import ModalMotion, Probe
from .state import State
from .variables import (
    CONTACT,
    ENERGY,
    FRICTION_STATE,
    HEAT,
    PROBES,
    SOLVE,
    STATUS,
    STATUS_SHARE,
    STATUS_WORDS,
    TANGENTS,
    TEMPERATURE,
    attributes_of,
    described,
    status_attributes,
)

# Variables over time that are the same for all systems.
OVER_TIME = {variable.name: variable for variable in (*CONTACT, *ENERGY, STATUS_SHARE, *SOLVE, TEMPERATURE, *HEAT)}
# All variables over time except the probes.
RECORDED = (*OVER_TIME, STATUS.name, FRICTION_STATE.name)

# Dimension of the motion of bodies if it is recorded at other times than the rest.
MOTION_TIME = "motion_time"


def to_dataset(
    system: System,
    time: Array,
    contact_columns: dict[str, Array],
    status_share: Array,
    energies: dict[str, Array],
    probes: Sequence[Probe],
    probe_values: tuple[Array, Array, Array | None],
    state: State,
    *,
    motion: Array,
    raw: Array,
    attributes: dict[str, Any],
    shown: Mapping[int, str] | None = None,
) -> xr.Dataset:
    """Label the arrays of a march with names, units and meanings.

    Arrays of the contacts have the shapes (contacts, samples), and (samples, contacts, 3) for the status. `motion` is
    the motion imposed on each contact a step before the end and at the end, and its displacement beyond these, shape
    (3, contacts, motions). `probe_values` are those of probes, those of all modes of bodies, and the times of the
    latter unless they are those of the samples. `raw` are the last values of both at every step, which the low-passes
    still need, shape (steps, values). `shown` has the names of rows that represent several contacts, by the number of
    one of these.
    """
    words = described("s", "time at the end of the sample interval")
    coordinates: dict[str, Any] = {
        "time": ("time", time, words),
        "contact_status": ("contact_status", list(STATUS_WORDS)),
        "contact": ("contact", list(system.contact_names if shown is None else shown.values())),
    }
    over = over_time(system, contact_columns, status_share, energies, shown=shown)
    data: dict[str, Any] = {name: (*given, _attributes(name, system)) for name, given in over.items()}
    if len(coordinates["contact"][1]) == 1:
        del coordinates["contact"]
    elif system.surface_names:
        numbers = range(len(system.contacts)) if shown is None else shown
        coordinates["surface"] = ("contact", [system.surface_names[number] for number in numbers])
    if system.has_two_tangents:
        coordinates["tangent"] = ("tangent", list(TANGENTS))
    values, motion_values, motion_time = probe_values
    plain = [probe for probe in probes if not hasattr(probe, "of_each")]
    for kind, variable in PROBES.items():
        chosen = [k for k, probe in enumerate(plain) if probe.quantity == kind]
        if chosen:
            dimension = f"{kind}_probe"
            coordinates[dimension] = (dimension, [probe_label(plain[k], system) for k in chosen])
            data[kind] = (("time", dimension), values[:, chosen], attributes_of(variable))
    if len(plain) < len(probes):
        kind = ModalMotion.quantity
        coordinates |= _of_modes(system, [probe.body for probe in probes if probe not in plain])
        along = "time" if motion_time is None else MOTION_TIME
        data[kind] = ((along, f"{kind}_probe"), motion_values, attributes_of(PROBES[kind]))
        if motion_time is not None:
            coordinates[along] = (along, motion_time, described("s", "time at the end of an interval of the motion"))
    for name, dimensions, values, meaning in (
        ("state_modal", ("state_kind", "mode"), state.modal, "modal positions and increments at the end"),
        ("state_remainder", ("state_kind", "mode"), state.remainder, "rounding remainders of state_modal"),
        ("state_carried", ("state_contact", "state_scalar"), state.carried, "scalars of each contact at the end"),
        ("state_springs", "state_spring", state.springs, "increments of nonlinear springs in the step before the last"),
        ("state_energies", "state_energy", state.energies, "energies carried by the march at the end"),
        (
            "state_motion",
            ("state_instant", "state_contact", "state_direction"),
            motion,
            "motions imposed on each contact at the last two steps, and its displacement beyond them",
        ),
        ("state_raw", ("state_step", "state_probe"), raw, "last values of the probes at every step"),
    ):
        data[name] = (dimensions, values, {"long_name": meaning})
    return xr.Dataset(data, coordinates, attributes)


def over_time(
    system: System,
    contact_columns: Mapping[str, Array],
    status_share: Array,
    energies: Mapping[str, Array],
    wanted: Collection[str] = RECORDED,
    shown: Collection[int] | None = None,
) -> dict[str, tuple[tuple[str, ...], Array]]:
    """Return the variables of contacts and energies with their dimensions; arguments as in `to_dataset`."""
    along = ("time", "contact")
    found: dict[str, tuple[tuple[str, ...], Array]] = {}
    for variable in CONTACT:
        if variable.name in wanted:
            values = contact_columns[variable.name]
            # In space there is a component along each tangent.
            found[variable.name] = ((*along, "tangent")[: values.ndim], np.swapaxes(values, 0, 1))
    found |= {variable.name: (("time",), energies[variable.name]) for variable in ENERGY if variable.name in wanted}
    if STATUS.name in wanted:
        found[STATUS.name] = (along, contact_columns[STATUS.name].T.astype(np.int8))
    if STATUS_SHARE.name in wanted:
        found[STATUS_SHARE.name] = ((*along, "contact_status"), status_share)
    for name in ("jammed_steps", "landings"):
        if name in wanted:
            found[name] = (along, contact_columns[name].T.astype(np.int64))
    contacts = system.contacts if shown is None else [system.contacts[number] for number in shown]
    units = [contact.law.state_units for contact in contacts]
    if FRICTION_STATE.name in wanted and any(units):
        # NaN for contacts whose law has no state.
        kept = np.swapaxes(contact_columns[FRICTION_STATE.name], 0, 1).copy()
        kept[:, np.array(units) == ""] = np.nan
        if kept.ndim > 2:
            # Laws other than those of bristles also have a single state in space.
            kept[:, [not contact.has_state_vector for contact in contacts], 1] = np.nan
        found[FRICTION_STATE.name] = ((*along, "tangent")[: kept.ndim], kept)
    cold = [contact.heating is None for contact in contacts]
    if TEMPERATURE.name in wanted and not all(cold):
        # NaN for contacts without a temperature.
        kept = contact_columns[TEMPERATURE.name].T.copy()
        kept[:, cold] = np.nan
        found[TEMPERATURE.name] = (along, kept)
    if any(contact.heating is not None for contact in system.contacts):
        found |= {one.name: (("time",), energies[one.name]) for one in HEAT if one.name in wanted}
    if len(system.contacts) > 1:
        solved = [one.name for one in SOLVE if one.name in wanted]
        found |= {name: (("time",), energies[name].astype(np.int64)) for name in solved}
    if len(contacts) > 1:
        return found
    return {name: _of_the_one_contact(*given) for name, given in found.items()}


def _of_the_one_contact(dimensions: tuple[str, ...], values: Array) -> tuple[tuple[str, ...], Array]:
    """Return a variable without the dimension of the contacts, for a single contact."""
    if "contact" not in dimensions:
        return dimensions, values
    return (dimensions[0], *dimensions[2:]), values[:, 0]


def _units_of_states(system: System) -> list[str]:
    return [contact.law.state_units for contact in system.contacts]


def _attributes(name: str, system: System) -> dict[str, Any]:
    """Return the attributes of a variable over time."""
    if name == STATUS.name:
        return status_attributes()
    if name == FRICTION_STATE.name:
        units = " or ".join(sorted({*_units_of_states(system)} - {""}))
        return {**attributes_of(FRICTION_STATE), "units": units}
    return attributes_of(OVER_TIME[name])


def _of_modes(system: System, bodies: Sequence[Body]) -> dict[str, Any]:
    """Return the coordinates of all modes of bodies: labels, names of the bodies, and frequencies [Hz]."""
    kind = ModalMotion.quantity
    modes = [body.modes(system.is_held(body)) for body in bodies]
    names = [system.body_name(body) for body, own in zip(bodies, modes, strict=True) for _ in range(own.count)]
    labels = [
        f"{system.body_name(body)} mode {k}" for body, own in zip(bodies, modes, strict=True) for k in range(own.count)
    ]
    frequencies = np.concatenate([own.frequency for own in modes])
    found = {
        "probe": (labels, {}),
        "body": (names, {}),
        "frequency": (frequencies, described("Hz", "natural frequency")),
    }
    return {f"{kind}_{word}": (f"{kind}_probe", *given) for word, given in found.items()}


def probe_label(probe: Any, system: System) -> str:
    """Return the label of a probe: body, place and direction, or connection and component."""
    if hasattr(probe, "label"):
        return str(probe.label(system))
    return f"{system.body_name(probe.body)} {probe.place}"
