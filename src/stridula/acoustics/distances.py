"""Distances of listeners from the surface of a body, and a check that they are outside of it."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import BodySurface
from ..checks import ArgumentError, at_least
from .flat_patches import patch_integrals

# Smallest distance of a listener over the size of the body.
NEAREST = 1e-3


def distances_to(surface: BodySurface, places: Array, origin: Array | None = None) -> Array:
    """Return the distances of places to the nearest points of a surface [m], with its origin at `origin` if given.

    Raises
    ------
    ValueError
        If a place is in the body or on it.
    """
    points = surface.as_points
    size, found = float(np.linalg.norm(np.ptp(points.points, axis=0))), []
    for place in places:
        own = place if origin is None else place - origin
        away = points.points - own
        distance = np.linalg.norm(away, axis=1)
        if surface.form == "points":
            # Exact for patches, as a body may be thinner than its patches are long.
            corners = points.corners.reshape(-1, 4, 3)
            angle = float(patch_integrals(np.repeat(own[None], len(corners), axis=0), corners)[1].sum())
        else:
            angle = float((points.areas * (points.normals * away).sum(axis=1) / distance**3).sum())
        if angle > 2.0 * np.pi or distance.min() < NEAREST * size:
            words = f"be outside of the bodies, {at_least(NEAREST * size, 3)} m from them"
            raise ArgumentError("listener", words, got=f"{tuple(place.tolist())}")
        found.append(float(distance.min()))
    return np.array(found)
