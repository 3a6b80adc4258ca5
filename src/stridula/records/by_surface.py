"""Records in which the points of each surface count as one contact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

# Variables that are summed over the points of a surface; all others are averaged.
SUMMED = ("normal_force", "tangential_force", "jammed_steps", "landings")


def groups(contacts: Sequence[str], surfaces: Sequence[str]) -> list[list[int]]:
    """Return the numbers of the contacts of each surface, and of each contact without one.

    Parameters
    ----------
    contacts : sequence of str
        Names of the contacts.
    surfaces : sequence of str
        Name of the surface of each contact, empty for none; or an empty sequence without surfaces.
    """
    found: dict[str | int, list[int]] = {}
    for number in range(len(contacts)):
        found.setdefault((surfaces[number] if surfaces else "") or number, []).append(number)
    return list(found.values())


def by_surface(run: xr.Dataset) -> xr.Dataset:
    """Return a record with one contact for each surface in place of its points; itself without surfaces.

    Forces and counts are sums over the points, along each point's own directions; all other variables are means, so
    that the share of a status is the mean over the points.

    Parameters
    ----------
    run : xarray.Dataset
        A record, or a part of one.
    """
    if "surface" not in run.coords or "contact" not in run.dims:
        return run
    contacts, surfaces = ([str(name) for name in run[kind].values] for kind in ("contact", "surface"))
    members, found = groups(contacts, surfaces), {}
    if len(members) == len(contacts):
        return run
    for name, variable in run.data_vars.items():
        if "contact" not in variable.dims or not np.issubdtype(variable.dtype, np.number):
            continue
        parts = [variable.isel(contact=those) for those in members]
        whole = [part.sum("contact") if name in SUMMED else part.mean("contact") for part in parts]
        joined = xr.concat(whole, "contact", coords="minimal", compat="override").transpose(*variable.dims)
        found[name] = joined.assign_attrs(variable.attrs)
    kept = run.drop_vars([name for name in run.data_vars if "contact" in run[name].dims]).drop_vars("surface")
    kept = kept.drop_dims("contact").assign_coords(contact=[surfaces[one[0]] or contacts[one[0]] for one in members])
    return kept.assign(found)
