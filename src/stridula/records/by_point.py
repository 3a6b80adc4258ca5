"""Records in which each point of a surface counts as a contact, whichever way its surface was recorded."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..arrays import Array
from .variables import CONTACT, FRICTION_STATE, STATUS, STATUS_SHARE

# What is recorded of the points of surfaces at every sample, beside the surfaces themselves.
OF_POINTS = ("normal_force", "tangential_force", STATUS_SHARE.name, "landings")
POINT = "point_"
# The whole of a sample interval, in the numbers that shares of points are recorded in.
WHOLE = 255
# Share that rounding leaves of none, or takes from all.
ROUND_OFF = 1e-9
OF_CONTACTS = (*(variable.name for variable in CONTACT), STATUS.name, STATUS_SHARE.name, FRICTION_STATE.name)


def counted(share: Array) -> Array:
    """Return shares as whole numbers up to `WHOLE`: 0 is none of the interval, `WHOLE` is all of it."""
    found = np.clip(np.rint(share * WHOLE), 1, WHOLE - 1)
    found[share <= ROUND_OFF] = 0
    found[share >= 1.0 - ROUND_OFF] = WHOLE
    return found.astype(np.uint8)


def by_point(run: xr.Dataset, names: Sequence[str] = OF_POINTS) -> xr.Dataset:
    """Return a record with all points of its surfaces as contacts; itself where they are, or were not recorded.

    It has the forces, the shares of the status and the landings of all contacts, or those of these that are named, and
    all that is not of contacts.

    Parameters
    ----------
    run : xarray.Dataset
        A record, or a part of one.
    names : sequence of str, optional
        Which variables of contacts are taken, all that are recorded of points if left out.
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
