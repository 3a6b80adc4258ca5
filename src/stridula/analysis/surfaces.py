"""Surfaces in contact: resultants over time and fields over the face, from the record of their points."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..checks import ArgumentError, instance
from ..contact import SurfaceContact
from ..records.variables import STATUS_SHARE, attributes_of, described

AXES = ("x", "y", "z")


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
        the coordinates ``place`` [m] and ``area`` [m²].

    Raises
    ------
    ValueError
        If the record has not all points of the surface.
    """
    instance("contact", contact, SurfaceContact)
    names = [one.name for one in contact.contacts]
    if "contact" not in run.dims or not set(names) <= set(run.contact.values.tolist()):
        raise ArgumentError("run", f"be a record with the points of {contact.name!r}", run)
    chosen = run.sel(contact=names)
    places, areas = contact.points.place, contact.areas
    normal, tangential = chosen.normal_force.values, chosen.tangential_force.values
    frames = np.array([one.frame for one in contact.contacts])
    forces = normal[..., None] * frames[:, 0] - np.einsum("tpi,pij->tpj", tangential, frames[:, 1:])
    middle = areas @ places / areas.sum()
    total = normal.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        centre = np.where(total[:, None] > 0.0, normal @ places / total[:, None], np.nan)
    share = chosen.status_share.values
    slip = chosen.slip_velocity.values
    over, along = ("time", "axis"), ("time", "point", "tangent")
    return xr.Dataset(
        {
            "force": (over, forces.sum(axis=1), described("N", "resultant force on the body")),
            "moment": (over, np.cross(places - middle, forces).sum(axis=1), described("N m", "moment on the body")),
            "centre_of_pressure": (over, centre, described("m", "centre of pressure")),
            "closed_area": ("time", (1.0 - share[..., 0]) @ areas, described("m2", "area in contact")),
            "sticking_area": ("time", share[..., 1] @ areas, described("m2", "area that sticks")),
            "friction_power": ("time", (tangential * slip).sum(axis=(1, 2)), described("W", "power lost to friction")),
            "pressure": (("time", "point"), normal / areas, described("Pa", "normal pressure")),
            "shear": (along, tangential / areas[:, None], described("Pa", "shear on the track")),
            "slip_velocity": (along, slip, described("m/s", "slip velocity")),
            STATUS_SHARE.name: (("time", "point", "contact_status"), share, attributes_of(STATUS_SHARE)),
        },
        {
            "time": run.time,
            "axis": list(AXES),
            "tangent": run.tangent,
            "contact_status": run.contact_status,
            "point": np.arange(1, len(names) + 1),
            "place": (("point", "axis"), places, described("m", "place of a point of the face")),
            "area": ("point", areas, described("m2", "area of a point of the face")),
        },
        {"surface": contact.name},
    )
