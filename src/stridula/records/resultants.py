"""Resultants of the forces at the points of a surface."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..contact.surface_contact import SurfaceContact
from ..contact.surface_points import SurfacePoints

Faces = SurfaceContact | SurfacePoints

# Unit and meaning of each resultant; force, moment and centre have world components.
RESULTANTS = {
    "force": ("N", "resultant force on the body"),
    "moment": ("N m", "moment on the body"),
    "centre_of_pressure": ("m", "centre of pressure"),
    "closed_area": ("m2", "area in contact"),
    "sticking_area": ("m2", "area that sticks"),
    "friction_power": ("W", "power lost to friction"),
}
AXES = ("x", "y", "z")


def forces_on(contact: Faces, normal: Array, tangential: Array) -> Array:
    """Return the forces on the body at the points of a surface along the world's axes [N], (samples, points, 3)."""
    frames = np.array([one.frame for one in contact.contacts])
    return np.asarray(normal[..., None] * frames[:, 0] - np.einsum("tpi,pij->tpj", tangential, frames[:, 1:]))


def resultants(contact: Faces, normal: Array, tangential: Array, share: Array, slip: Array) -> dict[str, Array]:
    """Return the resultants of a surface over time, by the names of `RESULTANTS`.

    Parameters
    ----------
    contact : SurfaceContact or SurfacePoints
        The surface.
    normal : ndarray, shape (samples, points)
        Normal forces [N].
    tangential, slip : ndarray, shape (samples, points, 2)
        Tangential forces on the track [N] and slip velocities [m/s].
    share : ndarray, shape (samples, points, 3)
        Shares of the interval in each status.
    """
    places, areas = contact.places, contact.areas
    forces, total = forces_on(contact, normal, tangential), normal.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        centre = np.where(total[:, None] > 0.0, normal @ places / total[:, None], np.nan)
    return {
        "force": forces.sum(axis=1),
        "moment": np.cross(places - areas @ places / areas.sum(), forces).sum(axis=1),
        "centre_of_pressure": centre,
        "closed_area": (1.0 - share[..., 0]) @ areas,
        "sticking_area": share[..., 1] @ areas,
        "friction_power": (tangential * slip).sum(axis=(1, 2)),
    }
