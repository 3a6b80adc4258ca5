"""The sound pressure of a track under the forces of a record."""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bars import show_progress
from ..bodies import ModalBeam, ModalPlate
from ..checks import ArgumentError, instance
from ..records.repeated import is_cycle
from ..records.variables import described
from ..system import System
from .air import Air
from .bridges import Bridge, bridged_sound
from .free_bodies import free_sound
from .lone_tracks import lone_sound
from .plane_sound import plane_sound
from .steady_sound import steady_sound


def radiate(
    run: xr.Dataset,
    track: ModalBeam | ModalPlate | System | Bridge,
    listener: Any = None,
    *,
    bodies: Sequence[Any] | None = None,
    baffled: bool | None = None,
    air: Air | None = None,
    sample_rate: float | None = None,
    progress: bool = False,
) -> xr.DataArray:
    """Return the sound pressure of a track, or of the bodies of a system, in time.

    The track, with all its bending modes, is driven again by the normal forces of the record at their places. Its sound
    follows from Rayleigh's integral with exact travel times (in a rigid baffle), from a sheet of dipoles (a plate in
    free air) or from a line of dipoles (a beam in free air). Bodies in space are driven again by all forces of the
    record at their contacts and by the drives of the system, and radiate into open air: bodies of revolution by
    equivalent sources within them, meshed bodies by the pressure on their surface, plates as sheets of dipoles, beams
    as lines of dipoles if they are slim at all frequencies of their modes, otherwise by the pressure on their surface.
    Bodies are at rest before the record, and the
    air does not act back on them.

    Bodies whose motion is recorded, see `ModalMotion`, move as recorded and are not driven again.

    Of a limit cycle, it is one period of the steady sound: `harmonic_levels` has the levels of its harmonics, and
    `repeat_cycle` makes a sound of any length of it.

    The same holds for the tracks of a system in the plane, also under its drives, springs and dashpots. Its beams, such
    as the slider, are lines of dipoles driven again by all forces at their contacts and by the drives; a baffle that
    tracks are flush with reflects their sound. In space there is a baffle only with ``baffled=True``: plates and beams
    of rectangular section are flush with it.

    Parameters
    ----------
    run : xarray.Dataset
        A record, with or without probes. All its contacts press on the track: select them with
        ``run.sel(contact=[...])``. Or the result of `limit_cycle`, best with ``motion=True``: bodies that are driven
        again take their time to settle.
    track : ModalBeam, ModalPlate, System or Bridge
        Source of the sound. A track need not be the body of the run, but must reach as far as it is pressed; without
        its system, only the contacts along it press it, and notes name everything else that acts on it. For a system,
        that of the run, the sound is the sum over its bodies: in space over all that have a surface, in the plane over
        tracks and slim beams. For a bridge, it is that of the body driven by the recorded force on the support of a
        string.
    listener : tuple of float, or sequence of tuples, optional
        Places of the listeners, x, y, z [m]: x along the track from its left end, y across it in its surface, from the
        axis of a beam or from the first edge of a plate, z above it, on the slider's side. A pair of ears a metre above
        the middle of the track if left out. A track in space has the same axes; a system in the plane has those of its
        first track, or, without a track, world x, across the plane, and world y. For a system in space they are the
        world axes; the ears are then a metre above the middle of the bodies, on the side of the first contact's tip.
        Plates and beams in space are placed by the bodies that they touch if these have places in the world; otherwise
        the track of the first contact begins at the origin.
    bodies : sequence of AxisymmetricBody, SolidBody, ModalBeam, ModalPlate or FiniteElementBeam, optional
        Bodies of a system to include; all that can be heard if left out.
    baffled : bool, optional
        Whether flat surfaces are flush with an infinite rigid wall. By default those of tracks are, except for bodies
        in space, which are in open air, and for beams of a system in the plane without a track.
    air : Air, optional
        The air, `Air()` if left out.
    sample_rate : float, optional
        Sample rate of the sound [Hz], at most that of the record, which is the default.
    progress : bool, optional
        Whether bars on standard error show how much of the sound of each body is computed, and the time left.

    Returns
    -------
    xarray.DataArray, shape (time, listener)
        Pressure [Pa]. Time starts with the record, when the first sound is sent; until it arrives the pressure is zero.
        ``attrs`` have the bandwidth [Hz], up to which the sound is complete and above which it is cut off, the air, the
        distances [m] to the nearest point of a body, and notes on missing parts. ``motion`` is "recorded", "driven
        again", or both. For a system they have the names of the bodies. ``fit_error`` is for each body the largest
        relative error of its sources at the frequency of a mode: in the mode's normal motion over the surface, or for
        plates as sheets in the force of the air on the mode; nan for lines of dipoles and flat surfaces in a baffle.
        Notes state it where it is above 5 %. ``period`` [s] is that of a limit cycle.

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

    def sound_of(record: Any) -> xr.DataArray:
        return _labelled(*_sound(track, record, listener, bodies, baffled, air, sample_rate))

    with show_progress(progress):
        if not is_cycle(run):
            return sound_of(run)
        if sample_rate is not None:
            raise ArgumentError("sample_rate", "be left out for a limit cycle, whose sound has a sample at every step")
        return steady_sound(run, sound_of)


Sound = tuple[Array, Array, Array, dict[str, Any]]


@singledispatch
def _sound(track: Any, run: Any, listener: Any, bodies: Any, baffled: Any, air: Any, sample_rate: Any) -> Sound:
    _check_no_bodies(bodies)
    return lone_sound(run, track, listener, baffled is not False, air, sample_rate)


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
        raise ArgumentError("bodies", "be left out unless a System is given", bodies)


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
