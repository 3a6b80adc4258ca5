"""Points of a branch as datasets, from which the branch can be followed on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..integration.period_map import PeriodMap
from ..integration.state_vectors import StateVectors
from ..lowering import Assembly
from ..records.variables import PROBES, described
from .branch import Point
from .events import Event
from .floquet import Multipliers
from .returning import Orbit, Return


def point_of_branch(key: str, units: str, point: Point, multipliers: Multipliers, record: xr.Dataset) -> xr.Dataset:
    """Return a point of a branch with its results and its orbit.

    Parameters
    ----------
    key, units : str
        Parameter and its unit.
    point : Point
        The point.
    multipliers : Multipliers
        Its multipliers.
    record : xarray.Dataset
        Its record, as of `limit_cycle`.
    """
    orbit, leading = point.cycle.orbit, multipliers.leading
    data: dict[str, Any] = {name: record[name] for name in ("period", "frequency", "stable", "second_frequency")}
    data["leading_multiplier"] = (
        "part",
        [leading.real, leading.imag],
        described("1", "largest Floquet multiplier but for the trivial one"),
    )
    share = record["status_share"]
    data["mean_status_share"] = share.mean([name for name in share.dims if name != "contact_status"]).assign_attrs(
        described("1", "mean share of the period in each contact status, over the contacts")
    )
    data |= {f"{kind}_amplitude": record[f"{kind}_amplitude"] for kind in PROBES if f"{kind}_amplitude" in record}
    data["orbit"] = ("orbit_number", orbit.vector, {"long_name": "state at the start of the period"})
    data["orbit_status"] = ("orbit_contact", orbit.status, {"long_name": "status of the contacts at that time"})
    data["orbit_steps"] = ("orbit_step", [point.cycle.of_period.steps, point.cycle.of_period.first_step])
    data["round_corner"] = ((), point.is_round_corner, described("1", "whether a corner lies before this point"))
    return xr.Dataset(data).assign_coords({key: ((), point.value, {"units": units})})


def orbit_of_branch(one: xr.Dataset, key: str, flat: Assembly, like: Return) -> Point:
    """Return a point of a branch from its dataset.

    Parameters
    ----------
    one : xarray.Dataset
        The dataset.
    key : str
        Parameter.
    flat : Assembly
        The system at that point.
    like : Return
        Another point of the branch.
    """
    steps, first_step = (int(number) for number in one["orbit_steps"].values)
    of_period = PeriodMap(flat, like.of_period.scheme, like.of_period.solve, steps, first_step, like.of_period.counter)
    vectors = StateVectors(flat, like.vectors.period)
    vectors.of_states = like.vectors.of_states
    orbit = Orbit(np.array(one["orbit"].values), float(one["period"]), np.array(one["orbit_status"].values))
    return Point(float(one[key]), Return.of(of_period, vectors, orbit), bool(one["round_corner"]))


def events_of_branch(events: Sequence[Event], key: str, units: str) -> dict[str, Any]:
    """Return the variables of the events of a branch."""
    return {
        "event_value": ("event", [one.value for one in events], described(units, f"{key} at the event")),
        "event_kind": ("event", np.array([one.kind for one in events], dtype=str)),
        "event_frequency": (
            "event",
            [one.frequency for one in events],
            described("Hz", "frequency of the cycle at the event"),
        ),
    }
