"""Records in which each point of a surface counts as a contact, however its surface was recorded."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..arrays import Array
from .variables import CONTACT, FRICTION_STATE, STATUS, STATUS_SHARE, TEMPERATURE

# Variables of the points of surfaces recorded at every sample, besides those of the surfaces themselves.
OF_POINTS = ("normal_force", "tangential_force", STATUS_SHARE.name, "landings")
POINT = "point_"
# Integer that stands for a share of 1 in records of points.
WHOLE = 255
# Shares that differ from 0 or 1 by less are due to rounding.
ROUND_OFF = 1e-9
OF_CONTACTS = (
    *(variable.name for variable in CONTACT),
    STATUS.name,
    STATUS_SHARE.name,
    FRICTION_STATE.name,
    TEMPERATURE.name,
)


def counted(share: Array) -> Array:
    """Return shares as integers: 0 for none of the interval, `WHOLE` for all of it."""
    found = np.clip(np.rint(share * WHOLE), 1, WHOLE - 1)
    found[share <= ROUND_OFF] = 0
    found[share >= 1.0 - ROUND_OFF] = WHOLE
    return found.astype(np.uint8)


def by_point(run: xr.Dataset, names: Sequence[str] = OF_POINTS) -> xr.Dataset:
    """Return a record with the recorded points of its surfaces as contacts; a record without them is unchanged.

    It has the forces, status shares and landings of all contacts, or the named ones of these variables, and all
    variables that do not belong to contacts.

    Parameters
    ----------
    run : xarray.Dataset
        A record, or a part of one.
    names : sequence of str, optional
        Variables of contacts to include; all that are recorded for points if left out.
    """
    if POINT + OF_POINTS[0] not in run.variables:
        return run
    surfaces = np.array([str(name) for name in run["point_surface"].values])
    shown = [str(name) for name in np.atleast_1d(run["contact"].values)] if "contact" in run.coords else []
    chosen = np.flatnonzero(np.isin(surfaces, shown)) if shown else np.arange(surfaces.size)
    if not chosen.size:
        return run
    alone = [number for number, name in enumerate(shown) if name not in surfaces]
    found = {}
    for name in names:
        points = run[POINT + name].transpose("time", "point", ...)[:, chosen]
        values = points.values.astype(np.int64 if name == "landings" else float)
        if name == STATUS_SHARE.name:
            values /= values.sum(axis=-1, keepdims=True)
        if alone:
            others = run[name].transpose("time", "contact", ...).values[:, alone]
            values = np.concatenate([others, values], axis=1)
        found[name] = (("time", "contact", *points.dims[2:]), values, run[name].attrs)
    called = [shown[number] for number in alone] + [str(name) for name in run["point"].values[chosen]]
    of_contacts = [name for name in OF_CONTACTS if name in run.variables]
    rest = run.drop_vars([*of_contacts, "contact", "surface"], errors="ignore").drop_dims("point")
    of = ["" for _ in alone] + surfaces[chosen].tolist()
    return rest.assign(found).assign_coords(contact=called, surface=("contact", of))
