"""The sound pressure of a track under the forces of a record."""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import ArgumentError, instance
from ..records.variables import described
from ..system import System
from .air import Air
from .bridges import Bridge, bridged_sound
from .free_bodies import free_sound
from .plane_sound import plane_sound
from .track_sound import track_sound


def radiate(
    run: xr.Dataset,
    track: ModalBeam | ModalPlate | System | Bridge,
    listener: Any = None,
    *,
    bodies: Sequence[Any] | None = None,
    baffled: bool | None = None,
    air: Air | None = None,
    sample_rate: float | None = None,
) -> xr.DataArray:
    """Return the sound pressure of a track, or of the bodies of a system, in time.

    The track is driven again by the normal forces of the record where they pressed, with all its bending modes, and
    is heard through Rayleigh's integral with exact travel times (in a rigid baffle), as a sheet of dipoles (a plate in
    free air) or as a line of them (a beam in free air). Bodies in space are driven again by all forces of the record at
    their contacts and by the drives of the system, and are heard in open air: discs by equivalent sources within them,
    meshed bodies by the pressure on their surface, plates as sheets of dipoles, beams as lines of dipoles where they
    are slim at all frequencies of their modes and else by their surface. Bodies are at rest before the record, and the
    air does not act back on them.

    Bodies whose motion the record has, see `ModalMotion`, move as that says and are not driven again.

    Of a system in the plane its tracks are heard so, and its beams, such as the slider, as lines of dipoles driven
    again by all forces at their contacts and by the drives; a baffle that tracks are flush with reflects their sound.
    Of a system in space it does so if it is asked for: plates and beams of rectangular section are flush with it.

    Parameters
    ----------
    run : xarray.Dataset
        A record, with or without probes. All its contacts press on the track: choose with ``run.sel(contact=[...])``.
    track : ModalBeam, ModalPlate, System or Bridge
        What is heard. A track need not be the body of the run, but must be as long as where it is pressed. Of a system,
        that of the run, the sum over its bodies is heard: in space over all that have a surface, in the plane over
        tracks and slim beams. Of a bridge, the body that the recorded force on the support of a string drives.
    listener : tuple of float, or sequence of tuples, optional
        Where one listens, x, y, z [m]: x along the track from its left end, y across it in its surface, from the axis
        of a beam or from the first edge of a plate, z above it, on the slider's side. A pair of ears a metre above the
        middle of the track if left out. These are the axes of a track in space, too, and those of the first track of a
        system in the plane; without one they are world x, across the plane, and world y. Of a system in space they are
        those of the world; the ears are then a metre above the middle of what is heard, on the side of the first
        contact's tip. Plates and beams in space are where the bodies that they touch are, if these know their places,
        else the track of the first contact begins at the origin.
    bodies : sequence of AxisymmetricBody, SolidBody, ModalBeam, ModalPlate or FiniteElementBeam, optional
        Which bodies of a system are heard; all that can be if left out.
    baffled : bool, optional
        Whether flat surfaces are flush with an endless rigid wall: by default those of tracks are, but for bodies in
        space, which are in open air, and for beams of a system in the plane without a track.
    air : Air, optional
        The air, `Air()` if left out.
    sample_rate : float, optional
        Samples per second of the sound [Hz], at most the record's, which it is if left out.

    Returns
    -------
    xarray.DataArray, shape (time, listener)
        Pressure [Pa]. Time starts where the record starts, when the first sound is sent; before it can arrive the
        pressure is zero. ``attrs`` have the bandwidth [Hz], up to which the sound is whole and above which it is cut
        off, the air, the distances [m] to the nearest point of the track, and notes on what is missing. ``motion`` is
        "recorded", "driven again", or both. Of a system they have the names of the bodies heard and, as ``fit_error``,
        the largest relative error with which the sources of each meet the normal motion of a mode all over the surface,
        at the mode's own frequency, nan for plates and lines of dipoles; notes say it where it is above 5 %.

    Raises
    ------
    ValueError
        If the record diverged, holds NaN or fewer than 2 samples, or presses beyond the track; if its track was changed
        while it was played; if a listener is in the surface, behind the baffle, on the beam or in a body; if flat
        bodies do not lie in one baffle, or others behind it; if the sample rate is more than the record supports, or
        too low; if a body has no surface, or the record is not one of the system.
    """
    if baffled is not None:
        instance("baffled", baffled, bool)
    air = Air() if air is None else air
    instance("air", air, Air)
    return _labelled(*_sound(track, run, listener, bodies, baffled, air, sample_rate))


Sound = tuple[Array, Array, Array, dict[str, Any]]


@singledispatch
def _sound(track: Any, run: Any, listener: Any, bodies: Any, baffled: Any, air: Any, sample_rate: Any) -> Sound:
    _check_no_bodies(bodies)
    return track_sound(run, track, listener, baffled is not False, air, sample_rate)


@_sound.register
def _of_a_system(
    system: System, run: Any, listener: Any, bodies: Any, baffled: Any, air: Any, sample_rate: Any
) -> Sound:
    if not system.is_spatial:
        return plane_sound(run, system, listener, bodies, baffled, air, sample_rate)
    return free_sound(run, system, listener, bodies, baffled, air, sample_rate)


@_sound.register
def _of_a_bridge(
    bridge: Bridge, run: Any, listener: Any, bodies: Any, baffled: Any, air: Any, sample_rate: Any
) -> Sound:
    _check_no_bodies(bodies)
    return bridged_sound(run, bridge, listener, baffled, air, sample_rate)


def _check_no_bodies(bodies: Any) -> None:
    if bodies is not None:
        raise ArgumentError("bodies", "be left out but for a System", bodies)


def _labelled(pressure: Array, time: Array, listeners: Array, attributes: dict[str, Any]) -> xr.DataArray:
    coordinates: dict[str, Any] = {
        "time": ("time", time, {"units": "s", "long_name": "time since the start of the march"}),
    }
    for name, values in zip("xyz", listeners.T, strict=True):
        coordinates[name] = ("listener", values, {"units": "m"})
    coordinates["listener"] = ("listener", np.arange(len(listeners)))
    return xr.DataArray(
        pressure.T, coordinates, ("time", "listener"), "pressure", described("Pa", "sound pressure") | attributes
    )
