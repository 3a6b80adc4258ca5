"""The sound of a record of a whole system: of its bodies in space, or of the first of its tracks that can be heard."""

from __future__ import annotations

from typing import Any

import xarray as xr

from ..bodies import ModalBeam, ModalPlate
from ..checks import ArgumentError
from .free_bodies import bodies_heard
from .panels import panel_of
from .radiate import radiate


def track_of(system: Any) -> ModalBeam | ModalPlate:
    """Return the first track of a system that can be heard.

    Raises
    ------
    ValueError
        If there is no beam and no plate among its tracks.
    """
    tracks: list[Any] = [contact.track for contact in system.contacts]
    for track in tracks:
        if hasattr(track, "path"):
            found: ModalBeam | ModalPlate = track
            return found
    raise ArgumentError("track", "be a modal beam or a modal plate to be heard", got=f"a {type(tracks[0]).__name__}")


def check_heard(system: Any, surface_rate: float | str | None = None) -> None:
    """Raise ValueError if no body in space and no track in a baffle can be heard of a system.

    Parameters
    ----------
    system : System
        The system.
    surface_rate : float or str, optional
        What is to be recorded of its surfaces, as for `simulate`: maps alone have no sound.
    """
    if not bodies_heard(system):
        panel_of(track_of(system))
    elif surface_rate is not None and not isinstance(surface_rate, str):
        raise ArgumentError("surface_rate", "be left out, or all, to be heard", surface_rate)


def heard(record: xr.Dataset, system: Any, places: Any = None, baffled: bool = True) -> xr.DataArray:
    """Return the sound of all bodies in space that have a surface, else of the first track that can be heard.

    The track is that under the contacts that press on it; bodies in space are in open air.

    Parameters
    ----------
    record : xarray.Dataset
        A record of the system.
    system : System
        The system.
    places : tuple of float, or sequence of tuples, optional
        Where one listens, as for `radiate`.
    baffled : bool, optional
        Whether the track is flush with an endless rigid wall.

    Raises
    ------
    ValueError
        If there is no such track, or the record cannot be heard.
    """
    if bodies_heard(system):
        return radiate(record, system, places)
    track = track_of(system)
    on_it = [number for number, contact in enumerate(system.contacts) if contact.track == track]
    several = "contact" in record.dims
    pressure = radiate(record.isel(contact=on_it) if several else record, track, places, baffled=baffled)
    if several and len(on_it) < record.sizes["contact"]:
        others = record.sizes["contact"] - len(on_it)
        notes = [pressure.attrs["notes"], f"{others} of {record.sizes['contact']} contacts press on other tracks"]
        pressure.attrs["notes"] = "; ".join(note for note in notes if note)
    return pressure
