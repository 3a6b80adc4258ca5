"""Displacements of sliding bodies in a record."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array, in_space
from ..system import System
from .recorded import sampled

# Sliding distance above which a note states that a body is heard from its mean place [m].
FAR = 0.01


def travel_of(run: xr.Dataset, system: System, body: Any) -> tuple[Array, float]:
    """Return the mean displacement of a body from its start [m], shape (3,), and the range of its places [m].

    Both are zero for a body that touches no track at rest.
    """
    known = run["contact"].values.tolist() if "contact" in run.dims else list(system.contact_names)
    for contact, name in zip(system.contacts, system.contact_names, strict=True):
        still = contact.path_body is not None or (contact.rigid_track is not None and contact.rigid_track.is_still)
        if contact.tip.body == body and still and name in known:
            *_, (places,) = sampled(run, "contact_position")
            # Along the first tangent, and along the second one if there are two.
            ways = np.atleast_2d(places[known.index(name)])
            tangents = np.array([in_space(tangent) for tangent in contact.frame[1:]])
            moved = ways.mean(axis=1) - [contact.at, 0.0][: len(ways)]
            return moved @ tangents, float(np.linalg.norm(np.ptp(ways, axis=1)))
    return np.zeros(3), 0.0


def travel_note(name: str, reach: float) -> list[str]:
    """Return notes on a body that slides."""
    return (
        [f"{name}: it slides over {reach:.3g} m; its sound is computed at the middle of its path"]
        if reach > FAR
        else []
    )
