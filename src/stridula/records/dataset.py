"""Arrays of a march become a labelled xarray.Dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import BodyPoint
from ..system import System
from .probes import Probe, Reaction
from .state import State
from .variables import (
    CONTACT,
    ENERGY,
    FRICTION_STATE,
    PROBES,
    SOLVE,
    STATUS,
    STATUS_SHARE,
    STATUS_WORDS,
    attributes_of,
    described,
    status_attributes,
)


def to_dataset(
    system: System,
    time: Array,
    contact_columns: dict[str, Array],
    status_share: Array,
    energies: dict[str, Array],
    probes: Sequence[Probe],
    probe_values: Array,
    state: State,
    motion: Array,
    raw: Array,
    attributes: dict[str, Any],
) -> xr.Dataset:
    """Label the arrays of a march with names, units and meanings.

    Arrays of the contacts have the shapes (contacts, samples), and (samples, contacts, 3) for the status. `motion`
    is what is imposed on each contact a step before the end and at the end, and by how much it has been moved beyond
    that, shape (3, contacts, 3). `raw` are the last values of the probes at every step, which the low-pass still needs,
    shape (steps, probes).
    """
    words = described("s", "time at the end of the sample interval")
    coordinates: dict[str, Any] = {
        "time": ("time", time, words),
        "contact_status": ("contact_status", list(STATUS_WORDS)),
        "contact": ("contact", list(system.contact_names)),
    }
    along = ("time", "contact")
    data: dict[str, Any] = {
        variable.name: (along, contact_columns[variable.name].T, attributes_of(variable)) for variable in CONTACT
    }
    data |= {variable.name: ("time", energies[variable.name], attributes_of(variable)) for variable in ENERGY}
    data[STATUS.name] = (along, contact_columns[STATUS.name].T.astype(np.int8), status_attributes())
    data[STATUS_SHARE.name] = ((*along, "contact_status"), status_share, attributes_of(STATUS_SHARE))
    for name in ("jammed_steps", "landings"):
        data[name] = (along, contact_columns[name].T.astype(np.int64), data[name][2])
    data |= _friction_state(system, contact_columns[FRICTION_STATE.name])
    if len(system.contacts) > 1:
        for variable in SOLVE:
            data[variable.name] = ("time", energies[variable.name].astype(np.int64), attributes_of(variable))
    else:
        data = {name: _of_the_one_contact(*given) for name, given in data.items()}
        del coordinates["contact"]
    for kind, variable in PROBES.items():
        chosen = [k for k, probe in enumerate(probes) if type(probe).__name__.lower() == kind]
        if chosen:
            dimension = f"{kind}_probe"
            coordinates[dimension] = (dimension, [probe_label(probes[k], system) for k in chosen])
            data[kind] = (("time", dimension), probe_values[:, chosen], attributes_of(variable))
    for name, dimensions, values, meaning in (
        ("state_modal", ("state_kind", "mode"), state.modal, "modal positions and increments at the end"),
        ("state_remainder", ("state_kind", "mode"), state.remainder, "what they lack in the units of the march"),
        ("state_carried", ("state_contact", "state_scalar"), state.carried, "scalars of each contact at the end"),
        ("state_energies", "state_energy", state.energies, "energies carried by the march at the end"),
        (
            "state_motion",
            ("state_instant", "state_contact", "state_direction"),
            motion,
            "motions imposed on each contact at the last two steps, and what it has been moved beyond them",
        ),
        ("state_raw", ("state_step", "state_probe"), raw, "last values of the probes at every step"),
    ):
        data[name] = (dimensions, values, {"long_name": meaning})
    return xr.Dataset(data, coordinates, attributes)


def _of_the_one_contact(dimensions: Any, values: Array, attributes: dict[str, Any]) -> tuple[Any, Array, Any]:
    """Return a variable without the dimension of the contacts, of which there is one."""
    if "contact" not in dimensions:
        return dimensions, values, attributes
    return tuple(name for name in dimensions if name != "contact"), values[:, 0], attributes


def _friction_state(system: System, values: Array) -> dict[str, Any]:
    """Return the internal state of the laws of friction where one has any, NaN for contacts without."""
    units = [contact.friction.state_units for contact in system.contacts]
    if not any(units):
        return {}
    kept = np.where(np.array(units)[:, None] != "", values, np.nan).T
    attributes = {**attributes_of(FRICTION_STATE), "units": " or ".join(sorted(set(units) - {""}))}
    return {FRICTION_STATE.name: (("time", "contact"), kept, attributes)}


def probe_label(probe: Probe, system: System) -> str:
    """Return the label of a probe: body, place and direction."""
    if isinstance(probe, Reaction):
        return f"{system.body_name(probe.body)} root {probe.component}"
    return f"{system.body_name(probe.point.body)} {_place(probe.point)} {probe.direction}"


def _place(point: BodyPoint) -> str:
    if point.point_name is not None:
        return point.point_name
    if isinstance(point.position, tuple):
        return f"({point.position[0]:.6g}, {point.position[1]:.6g}) m"
    return f"{point.position:.6g} m"
