"""The sound of bodies from their motion: each by its responses at the listeners, from its first arrival on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import listed
from .air import Air
from .convolution import Convolution
from .delays import Sampling
from .motions import Motion
from .open_surfaces import Heard
from .resampling import bandwidth_of, ratio_of, resample
from .sounding import Sounding, Wall

# Bytes of modal motion held at once.
MEMORY = 64e6
# Samples by which the low-pass is ahead.
REACH = 40.0
# Bandwidth [Hz] below which a note states that audible frequencies are missing.
AUDIBLE = 16e3


@dataclass(frozen=True)
class Listening:
    """Where and how the sound of bodies is heard.

    Attributes
    ----------
    places : ndarray, shape (listeners, 3)
        Listeners in the axes of the bodies [m].
    air : Air
        The air.
    wall : Wall or None
        The wall that reflects the sound of bodies in front of it, None in open air.
    sample_rate : float or None
        Sample rate of the sound [Hz], that of the record if None.
    """

    places: Array
    air: Air
    wall: Wall | None
    sample_rate: float | None

    def seen(self, one: Sounding) -> Array:
        """Return the listeners of a body, followed by their images in the wall if it is in front of that."""
        if self.wall is None or one.wall is not None:
            return self.places
        return np.concatenate([self.places, self.wall.images(self.places)])


@dataclass(frozen=True)
class Part:
    """The sound of a body.

    Attributes
    ----------
    heard : Heard
        Its modes that sound, with their responses.
    pressure : ndarray, shape (listeners, samples)
        The sound [Pa].
    arrival : ndarray, shape (listeners,)
        Times of its first arrivals [s from the start].
    """

    heard: Heard
    pressure: Array
    arrival: Array


def bodies_sound(
    bodies: Sequence[Sounding],
    moved: Callable[[], Sequence[Motion]],
    listening: Listening,
    unheard: Callable[[Sounding, Heard, Array], list[str]] = lambda *_: [],
) -> tuple[Array, Array, dict[str, Any]]:
    """Return the sum of the sounds of bodies (listeners, samples) [Pa], its times [s] and its attributes.

    Parameters
    ----------
    bodies : sequence of Sounding
        The bodies; one of a name that has been before is a part of that body.
    moved : callable
        Returns their motions, which have the samples of one record.
    listening : Listening
        The listeners.
    unheard : callable, optional
        Takes a body, its responses and the whole sound at the first listener, returns notes on missing parts.

    Raises
    ------
    ValueError
        If a listener is in a body or behind the baffle, or there is no such motion or sample rate.
    """
    distances = np.array([one.distances(listening.places) for one in bodies])
    motions = moved()
    first = motions[0]
    recorded = 1.0 / first.interval
    ratio = ratio_of(listening.sample_rate, recorded, first.samples)
    bandwidth = min(bandwidth_of(ratio, recorded), *(one.most for one in bodies))
    parts = [
        _part(one, motion, listening, away, ratio, bandwidth)
        for one, motion, away in zip(bodies, motions, distances, strict=True)
    ]
    pressure = np.sum([one.pressure for one in parts], axis=0)
    time = np.arange(pressure.shape[1]) * first.interval / float(ratio)
    notes = [*_silences(bodies, motions, parts, time[-1]), *_left_out(bodies, motions)]
    notes += [note for motion in motions for note in motion.notes]
    for one, motion, part in zip(bodies, motions, parts, strict=True):
        if part.heard.numbers.size and motion.begins is not None and part.arrival[0] <= time[-1]:
            notes += unheard(one, part.heard, pressure[0])
    if bandwidth < AUDIBLE:
        notes.append(f"complete only up to {bandwidth:.4g} Hz, because of the record's sample rate")
    own = {one.name: part.heard for one, part in reversed(list(zip(bodies, parts, strict=True)))}
    names = list(dict.fromkeys(one.name for one in bodies))
    attributes = {
        "bandwidth": bandwidth,
        "modes": sum(int(one.numbers.size) for one in own.values()),
        "baffled": int(listening.wall is not None),
        "distance": distances.min(axis=0).tolist(),
        **({"bodies": names} if names[0] else {}),
        "fit_error": [own[name].error for name in names],
        "motion": " or ".join(dict.fromkeys(one.words for one in motions)),
        **listening.air.attributes,
        "notes": joined([*notes, *(note for part in parts for note in part.heard.notes)]),
    }
    return pressure, first.start + time, attributes


def joined(notes: Sequence[str]) -> str:
    """Return notes as a text, each once."""
    return "; ".join(dict.fromkeys(filter(None, notes)))


def _part(
    one: Sounding, motion: Motion, listening: Listening, distances: Array, ratio: Fraction, bandwidth: float
) -> Part:
    """Return the sound of a body and of its image, zero before its first arrival."""
    sampling = Sampling(motion.interval, bandwidth, motion.shift)
    heard = one.heard(motion.carried, listening.seen(one), listening.air, sampling)
    signals = _sum(heard, motion) if heard.numbers.size else np.zeros((len(distances), motion.samples))
    pressure = resample(signals.reshape(-1, len(distances), motion.samples).sum(axis=0), ratio)
    time = np.arange(pressure.shape[1]) * motion.interval / float(ratio)
    travel = distances / listening.air.speed
    arrival = (motion.begins or 0.0) + travel
    # Earlier than the low-pass reaches before the first arrival, the pressure is rounding.
    pressure[time < np.maximum(arrival - REACH * motion.interval / float(ratio), travel)[:, None]] = 0.0
    return Part(heard, pressure, arrival)


def _sum(heard: Heard, motion: Motion) -> Array:
    """Return the pressures at the samples of the record, shape (listeners, samples)."""
    if motion.begins is None:
        return np.zeros((len(heard.responses), motion.samples))
    several = max(1, int(MEMORY / 8 / (3 * motion.samples)))
    first = motion.accelerations(heard.numbers[:several])
    sound = Convolution(heard.responses, first.shape[1])
    sound.add(first, slice(0, several))
    for begin in range(several, heard.numbers.size, several):
        sound.add(motion.accelerations(heard.numbers[begin : begin + several]), slice(begin, begin + several))
    return sound.signals()[:, : motion.samples]


def _silences(
    bodies: Sequence[Sounding], motions: Sequence[Motion], parts: Sequence[Part], duration: float
) -> list[str]:
    """Return notes on bodies without sound, those of one cause together."""
    causes: dict[str, list[str]] = {}
    for one, motion, part in zip(bodies, motions, parts, strict=True):
        if motion.begins is None:
            causes.setdefault(motion.still, []).append(one.name)
        elif (part.arrival > duration).any():
            causes.setdefault("the sound does not arrive within the record", []).append(one.name)
    return [
        f"{listed(names)} {'is' if len(names) == 1 else 'are'} silent: {cause}" if names[0] else f"silence: {cause}"
        for cause, names in causes.items()
    ]


def _left_out(bodies: Sequence[Sounding], motions: Sequence[Motion]) -> list[str]:
    """Return a note on modes that the samples cannot represent."""
    fast = sum(int((~np.isin(one.numbers, motion.carried)).sum()) for one, motion in zip(bodies, motions, strict=True))
    return [f"{fast} modes above the limit of the record's sample rate are left out"] if fast else []
