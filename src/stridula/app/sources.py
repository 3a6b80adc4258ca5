"""What one hears: the contact force, the track's acceleration or the sound it radiates, sample by sample."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..acoustics.streamed import StreamedSound
from ..arrays import Array
from ..bodies import ModalBeam
from ..integration.live import LiveChunk, LiveMarch


@dataclass(frozen=True)
class Source:
    """Something that can be heard.

    Attributes
    ----------
    name, unit : str
        What it is and its unit.
    full_scale : float
        Amplitude that is as loud as can be at a volume of 0 dB.
    words : str
        What it is, in a line.
    """

    name: str
    unit: str
    full_scale: float
    words: str


SOURCES = {
    "pressure": Source("Sound pressure", "Pa", 0.1, "What a listener hears half a metre above the track, in a baffle."),
    "force": Source("Contact force", "N", 20.0, "The normal force between tip and track, as if an ear lay in it."),
    "acceleration": Source("Track acceleration", "m/s²", 50.0, "What a sensor on the middle of the track would give."),
}
HEIGHT = 0.5


class Pressure:
    """The sound pressure above the middle of a track."""

    def __init__(self, track: ModalBeam, interval: float, steps: int) -> None:
        self.sound = copy(_sound(track, interval, steps))
        self.begin()

    def begin(self) -> None:
        """Let nothing have sounded yet."""
        self.sound.begin()
        self.place: float | None = None

    def heard(self, chunk: LiveChunk) -> Array:
        """Return the pressure over a chunk [Pa]."""
        places = chunk.contact["contact_position"]
        before = np.concatenate([places[:1] if self.place is None else [self.place], places[:-1]])
        self.place = float(places[-1])
        return self.sound.feed(chunk.contact["normal_force"], (before + places) / 2.0)


@lru_cache(maxsize=64)
def _sound(track: ModalBeam, interval: float, steps: int) -> StreamedSound:
    """Return the sound of a track before it is heard: to find its paths takes longer than a part of the sound."""
    return StreamedSound(track, (track.length / 2.0, 0.0, HEIGHT), interval, steps)


class Force:
    """The normal contact force."""

    def begin(self) -> None:
        """Forget nothing: nothing is known of what was before."""

    def heard(self, chunk: LiveChunk) -> Array:
        """Return the force over a chunk [N]."""
        return chunk.contact["normal_force"]


class Acceleration:
    """The acceleration of the middle of the track."""

    def begin(self) -> None:
        """Forget nothing: nothing is known of what was before."""

    def heard(self, chunk: LiveChunk) -> Array:
        """Return the acceleration over a chunk [m/s²]."""
        return chunk.probes[:, 0]


def source_of(name: str, live: LiveMarch) -> Pressure | Force | Acceleration:
    """Return what is to be heard of a march; what sounded before it is silent."""
    if name == "pressure":
        return Pressure(live.system.track, live.interval, live.ratio)
    return Force() if name == "force" else Acceleration()
