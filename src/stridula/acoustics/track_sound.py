"""The sound of a track under the forces of a record."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..records.changes import check_one_track
from .air import Air
from .convolution import Convolution
from .delays import Response, Sampling
from .driven import DrivenModes
from .listeners import ears, listeners_of
from .moments import moment_note
from .panels import Panel
from .recorded import pressing
from .recorded_motion import recorded_modes
from .resampling import bandwidth_of, ratio_of, resample
from .responses import way_of

# Bytes of modal motion held at once.
MEMORY = 64e6
# Samples by which the low-pass is ahead.
REACH = 40.0
# Bandwidth [Hz] below which a note states that audible frequencies are missing.
AUDIBLE = 16e3


class Motion(Protocol):
    """Motion of the modes of a track."""

    words: str
    start: float
    interval: float
    samples: int
    first: float
    begins: float | None
    notes: list[str]

    def carried(self, angular_frequency: Array) -> Array:
        """Return the numbers of the modes that are heard, from the frequencies of all modes [rad/s]."""

    def accelerations(self, modes: Any) -> Array:
        """Return the accelerations of modes, by their numbers, shape (modes, samples or more)."""


def track_sound(
    run: xr.Dataset,
    track: ModalBeam | ModalPlate,
    listener: Any,
    baffled: bool,
    air: Air,
    sample_rate: float | None,
    silence: tuple[str, str] = ("silence", "the contact never presses"),
    name: str | None = None,
    driven: Callable[[], Motion] | None = None,
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return pressures (listeners, samples), their times, the listeners and attributes; arguments are as in `radiate`.

    `silence` has a name for silence and its cause without a force; `name` is that of the track in its system. `driven`
    returns its motion if it is not recorded and more than the contacts along it drives it.

    Raises
    ------
    ValueError
        If the record is not usable, the track has no such surface, or a listener is inside a body or behind the baffle.
    """

    def moved(panel: Panel) -> Motion:
        found: Motion | None = recorded_modes(run, track, name)
        if found is None and driven is not None:
            return driven()
        found = found or DrivenModes(panel, pressing(run, panel))
        check_one_track(run)
        return found

    def unheard(panel: Panel, response: Response, pressure: Array) -> list[str]:
        notes = moment_note(run, track, panel, response, pressure)
        return notes if name is None else [f"{name}: {note}" for note in notes]

    return panel_sound(moved, track, listener, baffled, air, sample_rate, silence, unheard)


def panel_sound(
    moved: Callable[[Panel], Motion],
    track: ModalBeam | ModalPlate,
    listener: Any,
    baffled: bool,
    air: Air,
    sample_rate: float | None,
    silence: tuple[str, str],
    unheard: Callable[[Panel, Response, Array], list[str]] | None = None,
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return the sound of a track; `moved` takes its panel and returns its motion.

    `unheard` takes the modes heard, their responses at the first listener and the sound there; it returns notes. Other
    arguments, results and errors are those of `track_sound`.
    """
    way = way_of(track, baffled)
    listeners = listeners_of(ears(track) if listener is None else listener)
    way.check(listeners)
    panel, motion = way.panel, moved(way.panel)
    recorded = 1.0 / motion.interval
    ratio = ratio_of(sample_rate, recorded, motion.samples)
    bandwidth = min(bandwidth_of(ratio, recorded), way.most)
    kept = motion.carried(panel.angular_frequency)
    # Modes that share a sine stand together.
    kept = kept[np.argsort(panel.wavenumbers[kept, 0], kind="stable")]
    shift = (motion.first - motion.start) / motion.interval
    sent = way.heard(kept, listeners, air, Sampling(motion.interval, bandwidth, shift))
    pressure = resample(_sum(sent.numbers, motion, sent.responses), ratio)
    time = np.arange(pressure.shape[1]) * motion.interval / float(ratio)
    distances = panel.distances(listeners)
    arrival = (motion.begins or 0.0) + distances / air.speed
    # Earlier than the low-pass reaches before the first arrival, the pressure is rounding.
    early = np.maximum(arrival - REACH * motion.interval / float(ratio), distances / air.speed)
    pressure[time < early[:, None]] = 0.0
    notes = _notes(motion, len(kept), len(panel.wavenumbers), time[-1], arrival, silence)
    if unheard is not None and arrival[0] <= time[-1]:
        notes += unheard(panel.only(sent.numbers), sent.responses[0], pressure[0])
    if bandwidth < AUDIBLE:
        notes.append(f"complete only up to {bandwidth:.4g} Hz, because of the record's sample rate")
    attributes = {
        "bandwidth": bandwidth,
        "modes": len(kept),
        "baffled": int(baffled),
        "distance": distances.tolist(),
        "motion": motion.words,
        **air.attributes,
        "notes": "; ".join([*notes, *sent.notes]),
    }
    if np.isfinite(sent.error):
        attributes["fit_error"] = [sent.error]
    return pressure, motion.start + time, listeners, attributes


def _sum(modes: Array, motion: Motion, responses: list[Response]) -> Array:
    """Return the pressures at the samples of the record, shape (listeners, samples)."""
    if not modes.size or motion.begins is None:
        return np.zeros((len(responses), motion.samples))
    several = max(1, int(MEMORY / 8 / (3 * motion.samples)))
    first = motion.accelerations(modes[:several])
    sound = Convolution(responses, first.shape[1])
    sound.add(first, slice(0, several))
    for begin in range(several, modes.size, several):
        sound.add(motion.accelerations(modes[begin : begin + several]), slice(begin, begin + several))
    return sound.signals()[:, : motion.samples]


def _notes(
    motion: Motion, kept: int, modes: int, duration: float, arrival: Array, silence: tuple[str, str]
) -> list[str]:
    """Return notes on a sound."""
    notes = []
    if motion.begins is None:
        notes.append(": ".join(silence))
    elif (arrival > duration).any():
        notes.append(f"{silence[0]}: the sound does not arrive within the record")
    if kept < modes:
        notes.append(f"{modes - kept} modes above the limit of the record's sample rate are left out")
    return [*notes, *motion.notes]
