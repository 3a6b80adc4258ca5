"""Surfaces in contact: resultants over time and fields over the face, from the record of their points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, instance
from ..contact import SurfaceContact, SurfacePoints
from ..records.by_point import by_point
from ..records.checked import record
from ..records.resultants import AXES, RESULTANTS, resultants
from ..records.variables import STATUS_SHARE, attributes_of, described

OF_POINTS = ("normal_force", "tangential_force", "slip_velocity", STATUS_SHARE.name)
# Recorded variables of fields with other names.
SHOWN = {"pressure": "normal_force", "shear": "tangential_force"}


def surface(run: xr.Dataset, contact: SurfaceContact | SurfacePoints) -> xr.Dataset:
    """Return resultants and fields of a surface in contact.

    Parameters
    ----------
    run : Dataset
        A record of a system with the surface, or a part of one in time.
    contact : SurfaceContact
        The surface, or one of ``system.faces``, also of a system made from a record.

    Returns
    -------
    Dataset
        Over time: ``force`` [N] and ``moment`` about the middle of the face [N m] on the body along the world's axes,
        ``centre_of_pressure`` [m], NaN without pressure, ``closed_area`` and ``sticking_area`` [m²], means over each
        interval, and ``friction_power`` [W]. Over time and the points of the face: ``pressure`` [Pa], ``shear`` along
        both tangents [Pa], on the track, ``slip_velocity`` [m/s] and ``status_share`` of the interval [1]. Points have
        the coordinates ``place`` [m] and ``area`` [m²]. Fields that a record has only at the rate of its maps are over
        ``map_time``: the slip velocity, and with a `surface_rate` all of them.

    Raises
    ------
    ValueError
        If the record lacks points of the surface.
    """
    instance("contact", contact, (SurfaceContact, SurfacePoints))
    names, whole = [one.name for one in contact.contacts], by_point(record("run", run))
    fields = {name: _field(run, whole, name, names) for name in OF_POINTS}
    normal, tangential, slip, share = (one.values for one in fields.values())
    data: dict[str, Any] = {}
    if "face" in run.dims and contact.name in run["face"].values.tolist():
        data = {name: run[f"surface_{name}"].sel(face=contact.name, drop=True).variable for name in RESULTANTS}
    elif all(one.dims[0] == "time" for one in fields.values()):
        found = resultants(contact, normal, tangential, share, slip)
        for name, meaning in RESULTANTS.items():
            data[name] = (("time", "axis")[: found[name].ndim], found[name], described(*meaning))
    areas = contact.areas
    for name, values, words in (
        ("pressure", normal / areas, described("Pa", "normal pressure")),
        ("shear", tangential / areas[:, None], described("Pa", "shear on the track")),
        ("slip_velocity", slip, described("m/s", "slip velocity")),
        (STATUS_SHARE.name, share, attributes_of(STATUS_SHARE)),
    ):
        data[name] = (fields[SHOWN.get(name, name)].dims, values, words)
    times = dict.fromkeys(["time", *(str(one.dims[0]) for one in fields.values())])
    return xr.Dataset(
        data,
        {
            **{name: run[name] for name in times},
            "axis": list(AXES),
            "tangent": run.tangent,
            "contact_status": run.contact_status,
            "point": np.arange(1, len(names) + 1),
            "place": (("point", "axis"), contact.places, described("m", "place of a point of the face")),
            "area": ("point", areas, described("m2", "area of a point of the face")),
        },
        {"surface": contact.name},
    )


def _field(run: xr.Dataset, whole: xr.Dataset, name: str, names: Sequence[str]) -> xr.DataArray:
    """Return a recorded variable of some points, at every sample or in maps, over time and ``point``."""
    for source, word, along in ((whole, name, "contact"), (run, f"map_{name}", "point")):
        if word in source and along in source[word].dims and set(names) <= set(source[along].values.tolist()):
            return source[word].sel({along: list(names)}).rename({along: "point"} if along != "point" else {})
    raise ArgumentError("run", "be a record with all points of the surface", run)
