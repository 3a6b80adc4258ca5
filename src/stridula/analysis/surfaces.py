"""Surfaces in contact: resultants over time and fields over the face, from the record of their points."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, instance
from ..contact import SurfaceContact
from ..contact.resultants import AXES, RESULTANTS, resultants
from ..records.variables import STATUS_SHARE, attributes_of, described

OF_POINTS = ("normal_force", "tangential_force", "slip_velocity", STATUS_SHARE.name)


def surface(run: xr.Dataset, contact: SurfaceContact) -> xr.Dataset:
    """Return resultants and fields of a surface in contact.

    Parameters
    ----------
    run : Dataset
        A record of a system with the surface, or a part of one in time.
    contact : SurfaceContact
        The surface.

    Returns
    -------
    Dataset
        Over time: ``force`` [N] and ``moment`` about the middle of the face [N m] on the body along the world's axes,
        ``centre_of_pressure`` [m], NaN without pressure, ``closed_area`` and ``sticking_area`` [m²], means over each
        interval, and ``friction_power`` [W]. Over time and the points of the face: ``pressure`` [Pa], ``shear`` along
        both tangents [Pa], on the track, ``slip_velocity`` [m/s] and ``status_share`` of the interval [1]. Points have
        the coordinates ``place`` [m] and ``area`` [m²]. Of a record with a `surface_rate` the fields are over
        ``map_time``, at that rate.

    Raises
    ------
    ValueError
        If the record has not all points of the surface.
    """
    instance("contact", contact, SurfaceContact)
    names = [one.name for one in contact.contacts]
    is_short = "map_time" in run.dims
    over, points = ("map_time", "point") if is_short else ("time", "contact")
    if points not in run.dims or not set(names) <= set(run[points].values.tolist()):
        raise ArgumentError("run", f"be a record with the points of {contact.name!r}", run)
    chosen = run.sel({points: names})
    normal, tangential, slip, share = (chosen[f"map_{name}" if is_short else name].values for name in OF_POINTS)
    data: dict[str, Any] = {}
    if not is_short:
        found = resultants(contact, normal, tangential, share, slip)
        for name, meaning in RESULTANTS.items():
            data[name] = (("time", "axis")[: found[name].ndim], found[name], described(*meaning))
    elif "face" in run.dims and contact.name in run["face"].values.tolist():
        data = {name: run[f"surface_{name}"].sel(face=contact.name, drop=True).variable for name in RESULTANTS}
    areas, along = contact.areas, (over, "point", "tangent")
    data |= {
        "pressure": ((over, "point"), normal / areas, described("Pa", "normal pressure")),
        "shear": (along, tangential / areas[:, None], described("Pa", "shear on the track")),
        "slip_velocity": (along, slip, described("m/s", "slip velocity")),
        STATUS_SHARE.name: ((over, "point", "contact_status"), share, attributes_of(STATUS_SHARE)),
    }
    return xr.Dataset(
        data,
        {
            **{name: run[name] for name in dict.fromkeys(("time", over))},
            "axis": list(AXES),
            "tangent": run.tangent,
            "contact_status": run.contact_status,
            "point": np.arange(1, len(names) + 1),
            "place": (("point", "axis"), contact.points.place, described("m", "place of a point of the face")),
            "area": ("point", areas, described("m2", "area of a point of the face")),
        },
        {"surface": contact.name},
    )
