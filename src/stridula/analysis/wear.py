"""Wear of faces in contact between runs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import instance, positive
from ..contact import SurfaceContact
from .surfaces import surface


def worn(face: SurfaceContact, run: xr.Dataset, coefficient: float, times: float = 1.0) -> SurfaceContact:
    """Return a face as it is worn by the sliding of a record, by Archard's law.

    The depth worn off grows at each point by ``coefficient * pressure * slip speed`` (Archard 1953, J. Appl. Phys. 24),
    with the means of the record. The wear of the track is not followed: it is spread over its whole path. Put the face
    into a new system in place of the old one, and repeat with short steps: a depth that exceeds the deformation of the
    face at once takes the pressure off its point.

    Parameters
    ----------
    face : SurfaceContact
        The face, worn or not.
    run : Dataset
        A record of a system with it, such as one of steady sliding.
    coefficient : float
        Volume worn off per force and distance [m²/N], the specific rate of wear, such as 1e-13 for a brake lining.
    times : float, optional
        Number of times that the record is repeated.

    Returns
    -------
    SurfaceContact
        The same face with a larger `wear`.

    Raises
    ------
    ValueError
        If the record lacks points of the face, or an argument is out of its range.
    """
    instance("face", face, SurfaceContact)
    coefficient, times = positive("coefficient", coefficient), positive("times", times)
    before = np.zeros(face.areas.size) if face.wear is None else np.asarray(face.wear)
    return replace(face, wear=(before + coefficient * times * _slid_under_pressure(face, run)).tolist())


def _slid_under_pressure(face: SurfaceContact, run: xr.Dataset) -> Array:
    """Return the integral of pressure times slip speed over a record at each point [N/m]."""
    found = surface(run, face)
    pressure, slip = found["pressure"], found["slip_velocity"]
    if pressure.dims[0] != slip.dims[0]:
        # The record has only maps of the slip, at a lower rate.
        pressure = pressure.interp(time=slip["map_time"].values).rename(time="map_time")
    speed = np.hypot.reduce(slip.transpose(..., "tangent").values, axis=-1)
    time = run["time"].values
    return np.asarray((pressure.values * speed).mean(axis=0) * (time[-1] - time[0]) * time.size / (time.size - 1))
