"""Records in which the points of each surface count as one contact."""

from __future__ import annotations

import numpy as np
import xarray as xr

# Variables that add up over the points of a surface; of all others there is a mean.
SUMMED = ("normal_force", "tangential_force", "jammed_steps", "landings")


def by_surface(run: xr.Dataset) -> xr.Dataset:
    """Return a record with one contact for each surface in the place of its points; itself where there is none.

    Forces and counts are sums over the points, along each point's own directions; all else are means over them, so that
    the shares of a status are those of the points.

    Parameters
    ----------
    run : xarray.Dataset
        A record, or a part of one.
    """
    if "surface" not in run.coords or "contact" not in run.dims:
        return run
    groups: dict[str, list[int]] = {}
    for number, (surface, contact) in enumerate(zip(run["surface"].values, run["contact"].values, strict=True)):
        groups.setdefault(str(surface) or str(contact), []).append(number)
    found = {}
    for name, variable in run.data_vars.items():
        if "contact" not in variable.dims or not np.issubdtype(variable.dtype, np.number):
            continue
        parts = [variable.isel(contact=those) for those in groups.values()]
        whole = [part.sum("contact") if name in SUMMED else part.mean("contact") for part in parts]
        joined = xr.concat(whole, "contact", coords="minimal", compat="override").transpose(*variable.dims)
        found[name] = joined.assign_attrs(variable.attrs)
    kept = run.drop_vars([name for name in run.data_vars if "contact" in run[name].dims]).drop_vars("surface")
    kept = kept.drop_dims("contact").assign_coords(contact=list(groups))
    return kept.assign(found)
