"""The sound of a track under the forces of a record."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..records.changes import check_one_track
from .air import Air
from .convolution import Convolution
from .delays import Response
from .driven import FASTEST, accelerations, first_time
from .listeners import ears, listeners_of
from .panels import Panel
from .recorded import Pressing, pressing
from .resampling import bandwidth_of, ratio_of, resample
from .responses import way_of

# Bytes of modal motion held at once.
MEMORY = 64e6
# Samples by which the low-pass is ahead.
REACH = 40.0
# Bandwidth [Hz] below which a sound lacks what can be heard, which is said.
AUDIBLE = 16e3


def track_sound(
    run: xr.Dataset,
    track: ModalBeam | ModalPlate,
    listener: Any,
    baffled: bool,
    air: Air,
    sample_rate: float | None,
    silence: tuple[str, str] = ("silence", "the contact never presses"),
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return pressures (listeners, samples), their times, the listeners and attributes; arguments are as in `radiate`.

    `silence` are the words for one, and why there is one without a force.

    Raises
    ------
    ValueError
        If the record is not usable, the track cannot be heard so, or a listener is where it cannot be heard.
    """

    def pressed(panel: Panel) -> tuple[Pressing, Panel]:
        found = pressing(run, panel)
        check_one_track(run)
        return found, panel

    return panel_sound(pressed, track, listener, baffled, air, sample_rate, silence)


def panel_sound(
    press: Callable[[Panel], tuple[Pressing, Panel]],
    track: ModalBeam | ModalPlate,
    listener: Any,
    baffled: bool,
    air: Air,
    sample_rate: float | None,
    silence: tuple[str, str],
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return the sound of a track under forces: `press` takes its panel and returns them with the panel they press on.

    Other arguments, results and errors are those of `track_sound`.
    """
    way = way_of(track, baffled)
    listeners = listeners_of(ears(track) if listener is None else listener)
    way.check(listeners)
    pressed, panel = press(way.panel)
    recorded = 1.0 / pressed.interval
    ratio = ratio_of(sample_rate, recorded, pressed.samples)
    bandwidth = bandwidth_of(ratio, recorded)
    kept = np.flatnonzero(panel.angular_frequency * pressed.interval < FASTEST)
    # Modes that share a sine stand together.
    kept = kept[np.argsort(panel.wavenumbers[kept, 0], kind="stable")]
    heard = panel.only(kept)
    shift = (first_time(pressed) - pressed.start) / pressed.interval
    paths = way.responses(kept, listeners, air, pressed.interval, shift, bandwidth)
    pressure = resample(_sum(heard, pressed, paths), ratio)
    time = np.arange(pressure.shape[1]) * pressed.interval / float(ratio)
    distances = _distances(listeners, panel)
    arrival = _first_press(pressed) + distances / air.speed
    # Beyond the reach of the low-pass, what comes before the first force can be heard is rounding.
    early = np.maximum(arrival - REACH * pressed.interval / float(ratio), distances / air.speed)
    pressure[time < early[:, None]] = 0.0
    notes = _notes(pressed, len(kept), len(panel.wavenumbers), time[-1], arrival, silence)
    if bandwidth < AUDIBLE:
        notes.append(f"whole up to {bandwidth:.4g} Hz only, for the record's sample rate")
    attributes = {
        "bandwidth": bandwidth,
        "modes": len(kept),
        "baffled": int(baffled),
        "distance": distances.tolist(),
        **air.attributes,
        "notes": "; ".join([*notes, *way.notes(air)]),
    }
    return pressure, pressed.start + time, listeners, attributes


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


def _first_press(pressed: Pressing) -> float:
    """Return when the sample interval begins in which a contact first presses [s from the start], 0 if none does."""
    presses = np.flatnonzero(pressed.force.any(axis=0))
    return float(presses[0]) * pressed.interval if presses.size else 0.0


def _notes(
    pressed: Pressing, kept: int, modes: int, duration: float, arrival: Array, silence: tuple[str, str]
) -> list[str]:
    """Return what is to be said of a sound, in words."""
    notes = []
    if not pressed.force.any():
        notes.append(": ".join(silence))
    elif (arrival > duration).any():
        notes.append(f"{silence[0]}: the sound does not arrive within the record")
    if kept < modes:
        notes.append(f"{modes - kept} modes above what the record's sample rate carries are left out")
    if pressed.start > 0.5 * pressed.interval:
        notes.append("the record continues another one; vibration left from that one is not included")
    return notes
