"""Arrays of a march become a labelled xarray.Dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..bodies import BodyPoint, FiniteElementBeam
from ..bodies.modes import Array
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
    Variable,
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
    raw: Array,
    attributes: dict[str, Any],
) -> xr.Dataset:
    """Label the arrays of a march with names, units and meanings.

    Arrays of the contacts have the shapes (contacts, samples), and (samples, contacts, 3) for the status. `raw` are the
    last values of the probes at every step, which the low-pass still needs, shape (steps, probes).
    """
    run = xr.Dataset(attrs=attributes)
    run.coords["time"] = ("time", time, {"units": "s", "long_name": "time at the end of the sample interval"})
    run.coords["contact_status"] = ("contact_status", list(STATUS_WORDS))
    run.coords["contact"] = ("contact", list(system.contact_names))
    for variable in CONTACT:
        run[variable.name] = (("time", "contact"), contact_columns[variable.name].T, _attributes(variable))
    for variable in ENERGY:
        run[variable.name] = ("time", energies[variable.name], _attributes(variable))
    flags = {"flag_values": np.arange(3, dtype=np.int8), "flag_meanings": " ".join(STATUS_WORDS)}
    # Of equal shares the later state wins: sliding before sticking before separated.
    dominant = 2 - np.argmax(status_share[..., ::-1], axis=-1)
    run[STATUS.name] = (("time", "contact"), dominant.astype(np.int8), {**_attributes(STATUS), **flags})
    run[STATUS_SHARE.name] = (("time", "contact", "contact_status"), status_share, _attributes(STATUS_SHARE))
    run["jammed_steps"] = run["jammed_steps"].astype(np.int64)
    _add_friction_state(run, system, contact_columns[FRICTION_STATE.name])
    if len(system.contacts) > 1:
        for variable in SOLVE:
            run[variable.name] = ("time", energies[variable.name].astype(np.int64), _attributes(variable))
    else:
        run = run.isel(contact=0, drop=True)
    _add_probes(run, system, probes, probe_values)
    for name, dimensions, values, words in (
        ("state_modal", ("state_kind", "mode"), state.modal, "modal positions and increments at the end"),
        ("state_remainder", ("state_kind", "mode"), state.remainder, "what they lack in the units of the march"),
        ("state_carried", ("state_contact", "state_scalar"), state.carried, "scalars of each contact at the end"),
        ("state_energies", "state_energy", state.energies, "energies carried by the march at the end"),
        ("state_raw", ("state_step", "state_probe"), raw, "last values of the probes at every step"),
    ):
        run[name] = (dimensions, values, {"long_name": words})
    return run


def _add_friction_state(run: xr.Dataset, system: System, values: Array) -> None:
    """Add the internal state of the laws of friction where one has any, NaN for contacts without."""
    units = [contact.friction.state_units for contact in system.contacts]
    if any(units):
        kept = np.where(np.array(units)[:, None] != "", values, np.nan).T
        used = sorted(set(units) - {""})
        attributes = {**_attributes(FRICTION_STATE), "units": " or ".join(used)}
        run[FRICTION_STATE.name] = (("time", "contact"), kept, attributes)


def _attributes(variable: Variable) -> dict[str, str]:
    return {
        "units": variable.units,
        "long_name": variable.long_name,
        "cell_methods": f"time: {variable.cell_methods}",
    }


def _add_probes(run: xr.Dataset, system: System, probes: Sequence[Probe], values: Array) -> None:
    """Add a variable for each kind of probe, with one entry per probe."""
    for kind, variable in PROBES.items():
        chosen = [k for k, probe in enumerate(probes) if type(probe).__name__.lower() == kind]
        if chosen:
            dimension = f"{kind}_probe"
            run.coords[dimension] = (dimension, [probe_label(probes[k], system) for k in chosen])
            run[kind] = (("time", dimension), values[:, chosen], _attributes(variable))


def probe_label(probe: Probe, system: System) -> str:
    """Return the label of a probe: body, place and direction."""
    if isinstance(probe, Reaction):
        return f"{system.body_name(probe.body)} root {probe.component}"
    return f"{system.body_name(probe.point.body)} {_place(probe.point)} {probe.direction}"


def _place(point: BodyPoint) -> str:
    body, position = point.body, point.position
    if isinstance(position, str):
        return position
    if isinstance(body, FiniteElementBeam):
        return {0.0: "tip", body.length: "root"}.get(position, f"{position:.6g} m")
    length: float = body.length  # type: ignore[attr-defined]
    return "centre" if position == length / 2.0 else f"{position:.6g} m"
