"""The sound pressure of a track under the forces of a record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import ArgumentError, instance
from ..records.changes import check_one_track
from ..records.variables import described
from ..system import System
from .air import Air
from .convolution import Convolution
from .delays import Response
from .driven import FASTEST, accelerations, first_time
from .free_bodies import free_sound
from .listeners import ears, listeners_of
from .panels import Panel, line_of, panel_of
from .recorded import Pressing, pressing
from .resampling import bandwidth_of, ratio_of, resample
from .responses import check_listeners, responses

# Bytes of modal motion held at once.
MEMORY = 64e6
# Samples by which the low-pass is ahead.
REACH = 40.0
# Bandwidth [Hz] below which a sound lacks what can be heard, which is said.
AUDIBLE = 16e3


def radiate(
    run: xr.Dataset,
    track: ModalBeam | ModalPlate | System,
    listener: Any = None,
    *,
    bodies: Sequence[Any] | None = None,
    baffled: bool | None = None,
    air: Air | None = None,
    sample_rate: float | None = None,
) -> xr.DataArray:
    """Return the sound pressure of a track, or of the bodies of a system in space, in time.

    The track is driven again by the normal forces of the record where they pressed, with all its bending modes, and
    is heard through Rayleigh's integral with exact travel times (in a rigid baffle) or as a line of dipoles (a beam in
    free air). Bodies in space are driven again by all forces of the record at their contacts and by the drives of the
    system, and are heard in open air by equivalent sources within them. Bodies are at rest before the record, and the
    air does not act back on them.

    Parameters
    ----------
    run : xarray.Dataset
        A record, with or without probes. All its contacts press on the track: choose with ``run.sel(contact=[...])``.
    track : ModalBeam, ModalPlate or System
        What is heard. A track need not be the body of the run, but must be as long as where it is pressed. Of a system,
        that of the run, its bodies in space are heard: the sum over all that have a surface.
    listener : tuple of float, or sequence of tuples, optional
        Where one listens, x, y, z [m]: x along the track from its left end, y across it in its surface, from the axis
        of a beam or from the first edge of a plate, z above it, on the slider's side. A pair of ears a metre above the
        middle of the track if left out. These are the axes of a track in space, too. Of a system in space they are
        those of the world; the ears are then a metre above the middle of what is heard, on the side of the first
        contact's tip.
    bodies : sequence of AxisymmetricBody or SolidBody, optional
        Which bodies of a system are heard; all that have a surface if left out.
    baffled : bool, optional
        Whether the surface of a track is flush with an endless rigid wall, which it is if left out; else it is a slim
        beam in free air. Bodies in space are in open air.
    air : Air, optional
        The air, `Air()` if left out.
    sample_rate : float, optional
        Samples per second of the sound [Hz], at most the record's, which it is if left out.

    Returns
    -------
    xarray.DataArray, shape (time, listener)
        Pressure [Pa]. Time starts where the record starts, when the first sound is sent; before it can arrive the
        pressure is zero. ``attrs`` have the bandwidth [Hz], up to which the sound is whole and above which it is cut
        off, the air, the distances [m] to the nearest point of the track, and notes on what is missing. Of a system
        they have the names of the bodies heard and, as ``fit_error``, the largest relative error with which the sources
        of each meet the normal motion of a mode all over the surface, at the mode's own frequency; notes say it where
        it is above 5 %.

    Raises
    ------
    ValueError
        If the record diverged, holds NaN or fewer than 2 samples, or presses beyond the track; if its track was changed
        while it was played; if a listener is in the surface, behind the baffle, on the beam or in a body; if the sample
        rate is more than the record supports, or too low; if a body has no surface, or the record is not one of the
        system.
    """
    if baffled is not None:
        instance("baffled", baffled, bool)
    what: Any = track
    if hasattr(what, "contacts"):
        if baffled:
            raise ArgumentError("baffled", "be False, or left out, for bodies in space", baffled)
        return _labelled(*free_sound(run, what, listener, bodies, air, sample_rate))
    if bodies is not None:
        raise ArgumentError("bodies", "be left out but for a System", bodies)
    return _of_track(run, what, listener, baffled is not False, air, sample_rate)


def _of_track(
    run: xr.Dataset,
    track: ModalBeam | ModalPlate,
    listener: Any,
    baffled: bool,
    air: Air | None,
    sample_rate: float | None,
) -> xr.DataArray:
    air = Air() if air is None else air
    instance("air", air, Air)
    surface: Callable[[Any], Panel] = panel_of if baffled else line_of
    panel = surface(track)
    listeners = listeners_of(ears(track) if listener is None else listener)
    check_listeners(listeners, track, baffled)
    pressed = pressing(run, panel)
    check_one_track(run)
    recorded = 1.0 / pressed.interval
    ratio = ratio_of(sample_rate, recorded, pressed.samples)
    bandwidth = bandwidth_of(ratio, recorded)
    kept = np.flatnonzero(panel.angular_frequency * pressed.interval < FASTEST)
    # Modes that share a sine stand together.
    kept = kept[np.argsort(panel.wavenumbers[kept, 0], kind="stable")]
    heard = panel.only(kept)
    shift = (first_time(pressed) - pressed.start) / pressed.interval
    paths = responses(heard, track, baffled, listeners, air, pressed.interval, shift, bandwidth)
    pressure = resample(_sum(heard, pressed, paths), ratio)
    time = np.arange(pressure.shape[1]) * pressed.interval / float(ratio)
    distances = _distances(listeners, panel)
    arrival = _first_press(pressed) + distances / air.speed
    # Beyond the reach of the low-pass, what comes before the first force can be heard is rounding.
    early = np.maximum(arrival - REACH * pressed.interval / float(ratio), distances / air.speed)
    pressure[time < early[:, None]] = 0.0
    notes = _notes(pressed, len(kept), len(panel.wavenumbers), time[-1], arrival)
    if bandwidth < AUDIBLE:
        notes.append(f"whole up to {bandwidth:.4g} Hz only, for the record's sample rate")
    if not baffled:
        notes.append(f"a line of dipoles: the beam is slim below {_slim_below(track, air):.4g} Hz")
    attributes = {
        "bandwidth": bandwidth,
        "modes": len(kept),
        "baffled": int(baffled),
        "distance": distances.tolist(),
        **{f"air_{name}": value for name, value in asdict(air).items()},
        "air_speed": air.speed,
        "air_density": air.density,
        "notes": "; ".join(notes),
    }
    return _labelled(pressure, pressed.start + time, listeners, attributes)


def _sum(panel: Panel, pressed: Pressing, responses: list[Response]) -> Array:
    """Return the pressures at the samples of the record, shape (listeners, samples)."""
    modes = len(panel.wavenumbers)
    if not modes or not pressed.force.any():
        return np.zeros((len(responses), pressed.samples))
    several = max(1, int(MEMORY / 8 / (3 * pressed.samples)))
    first = accelerations(panel.only(slice(0, several)), pressed)
    sound = Convolution(responses, first.shape[1])
    sound.add(first, slice(0, several))
    for begin in range(several, modes, several):
        part = slice(begin, begin + several)
        sound.add(accelerations(panel.only(part), pressed), part)
    return sound.signals()[:, : pressed.samples]


def _distances(listeners: Array, panel: Panel) -> Array:
    """Return the distances [m] of the listeners to the nearest points of the panel."""
    low = np.array([0.0, panel.edge])
    away = listeners[:, :2] - np.clip(listeners[:, :2], low, low + np.array([panel.length, panel.width]))
    return np.asarray(np.hypot(np.hypot(away[:, 0], away[:, 1]), listeners[:, 2]))


def _slim_below(track: Any, air: Air) -> float:
    """Return the frequency [Hz] below which a beam is slim: its width is a sixth of the wavelength."""
    return float(air.speed / (6.0 * track.section.largest_side))


def _first_press(pressed: Pressing) -> float:
    """Return when the sample interval begins in which a contact first presses [s from the start], 0 if none does."""
    presses = np.flatnonzero(pressed.force.any(axis=0))
    return float(presses[0]) * pressed.interval if presses.size else 0.0


def _notes(pressed: Pressing, kept: int, modes: int, duration: float, arrival: Array) -> list[str]:
    """Return what is to be said of a sound, in words."""
    notes = []
    if not pressed.force.any():
        notes.append("silence: the contact never presses")
    elif (arrival > duration).any():
        notes.append("silence: the sound does not arrive within the record")
    if kept < modes:
        notes.append(f"{modes - kept} modes above what the record's sample rate carries are left out")
    if pressed.start > 0.5 * pressed.interval:
        notes.append("the record continues another one; vibration left from that one is not included")
    return notes


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
