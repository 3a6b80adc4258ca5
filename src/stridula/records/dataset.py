"""Arrays of a march become a labelled xarray.Dataset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..bodies import BodyPoint, FiniteElementBeam
from ..bodies.modes import Array
from .probes import Probe, Reaction
from .variables import CONTACT, ENERGY, PROBES, STATUS, STATUS_SHARE, STATUS_WORDS, Variable


@dataclass(frozen=True)
class State:
    """Where a march stopped, enough to go on from there.

    Attributes
    ----------
    modal : ndarray, shape (2, modes)
        Positions and last increments of the modes.
    carried : ndarray
        Scalars that the march carries.
    raw : ndarray, shape (steps, probes)
        Last values of the probes at every step, which the low-pass still needs.
    """

    modal: Array
    carried: Array
    raw: Array


def to_dataset(
    time: Array,
    columns: dict[str, Array],
    status_share: Array,
    probes: Sequence[Probe],
    probe_values: Array,
    state: State,
    attributes: dict[str, Any],
) -> xr.Dataset:
    """Label the arrays of a march with names, units and meanings."""
    run = xr.Dataset(attrs=attributes)
    run.coords["time"] = ("time", time, {"units": "s", "long_name": "time at the end of the sample interval"})
    run.coords["contact_status"] = ("contact_status", list(STATUS_WORDS))
    for variable in (*CONTACT, *ENERGY):
        run[variable.name] = ("time", columns[variable.name], _attributes(variable))
    flags = {"flag_values": np.arange(3, dtype=np.int8), "flag_meanings": " ".join(STATUS_WORDS)}
    # Of equal shares the later state wins: sliding before sticking before separated.
    dominant = 2 - np.argmax(status_share[:, ::-1], axis=1)
    run[STATUS.name] = ("time", dominant.astype(np.int8), {**_attributes(STATUS), **flags})
    run[STATUS_SHARE.name] = (("time", "contact_status"), status_share, _attributes(STATUS_SHARE))
    run["jammed_steps"] = run["jammed_steps"].astype(np.int64)
    _add_probes(run, probes, probe_values)
    run["state_modal"] = (
        ("state_kind", "mode"),
        state.modal,
        {"long_name": "modal positions and increments at the end"},
    )
    run["state_carried"] = (
        "state_scalar",
        state.carried,
        {"long_name": "scalars carried by the march at the end"},
    )
    run["state_raw"] = (
        ("state_step", "state_probe"),
        state.raw,
        {"long_name": "last values of the probes at every step"},
    )
    return run


def _attributes(variable: Variable) -> dict[str, str]:
    return {
        "units": variable.units,
        "long_name": variable.long_name,
        "cell_methods": f"time: {variable.cell_methods}",
    }


def _add_probes(run: xr.Dataset, probes: Sequence[Probe], values: Array) -> None:
    """Add a variable for each kind of probe, with one entry per probe."""
    for kind, variable in PROBES.items():
        chosen = [k for k, probe in enumerate(probes) if type(probe).__name__.lower() == kind]
        if chosen:
            dimension = f"{kind}_probe"
            run.coords[dimension] = (dimension, [probe_label(probes[k]) for k in chosen])
            run[kind] = (("time", dimension), values[:, chosen], _attributes(variable))


def probe_label(probe: Probe) -> str:
    """Return the label of a probe: body, place and direction."""
    if isinstance(probe, Reaction):
        return f"slider root {probe.component}"
    return f"{_place(probe.point)} {probe.direction}"


def _place(point: BodyPoint) -> str:
    body: Any = point.body
    if isinstance(body, FiniteElementBeam):
        named = {0.0: "tip", body.length: "root"}
        return f"slider {named.get(point.position, f'{point.position:.6g} m')}"
    return "track centre" if point.position == body.length / 2.0 else f"track {point.position:.6g} m"
