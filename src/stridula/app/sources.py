"""Sources of the sound: contact forces, probes or the sound radiated by a track, sample by sample."""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from ..acoustics.hearable import hearable
from ..acoustics.panels import is_flat
from ..acoustics.streamed import StreamedSound
from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import listed
from ..connections import ends
from ..integration.live import LiveChunk, LiveMarch
from ..records import Probe
from ..records.dataset import probe_label
from ..records.variables import PROBES
from ..system import System


@dataclass(frozen=True)
class Source:
    """A source of sound.

    Attributes
    ----------
    name, unit : str
        Name and unit.
    full_scale : float
        Amplitude at full scale for a volume of 0 dB.
    words : str
        Explanation in one line.
    """

    name: str
    unit: str
    full_scale: float
    words: str


SOURCES = {
    "pressure": Source(
        "Sound pressure",
        "Pa",
        0.1,
        "The sound pressure half a metre above the track, in a baffle, from contact forces.",
    ),
    "force": Source("Contact force", "N", 20.0, "The normal force between tip and track."),
    "acceleration": Source("Track acceleration", "m/s²", 50.0, "The acceleration of the track's centre."),
    "friction": Source("Friction force", "N", 20.0, "The friction force on the track."),
}
# Sources for several contacts, instead of those for one.
TOGETHER = {
    "force": Source("Contact forces", "N", 20.0, "The sum of the normal forces of all contacts."),
    "friction": Source("Friction forces", "N", 20.0, "The sum of the friction forces of all contacts."),
}
TIP_ACCELERATION = Source("Tip acceleration", "m/s²", 50.0, "The acceleration of the first tip along its track.")
# Full scale of probes by their unit.
FULL_SCALES = {"m": 1e-3, "m/s": 0.5, "m/s2": 50.0, "N": 5.0}
HEIGHT = 0.5


def sources_of(system: System, probes: tuple[Probe, ...]) -> dict[str, Source]:
    """Return the sources of a system, the most informative first.

    Parameters
    ----------
    system : System
        The system.
    probes : tuple of probe
        Its probes; the first is an acceleration.
    """
    track = system.contacts[0].path_body
    sounds = track is not None and is_flat(track)
    driven = [*_others_on(system, track)] if sounds else []
    found = {"pressure": _with(SOURCES["pressure"], _silent(system, track))} if sounds and not driven else {}
    more = {f"probe {number}": _of_probe(probe, system) for number, probe in enumerate(probes[1:], 1)}
    # A string is heard through its bridge, and another body by the velocity of its wall.
    first = [
        [name for name, one in more.items() if one.name.startswith(word)] for word in ("Support force", "Velocity")
    ]
    radiating = {name: more[name] for name in next(filter(None, first), [])}
    known = TOGETHER if len(system.contacts) > 1 else SOURCES
    # The normal force on a point pressed on a belt is constant.
    is_on_track = system.contacts[0].path_body is not None
    forces = {name: known[name] for name in (("force", "friction") if is_on_track else ("friction", "force"))}
    if driven:
        words = f" There is no sound pressure, as more than contacts along it drives the track: {listed(driven)}."
        forces["force"] = _with(forces["force"], words)
    acceleration = SOURCES["acceleration"] if is_on_track else TIP_ACCELERATION
    return {**found, **radiating, **forces, "acceleration": acceleration, **more}


def _of_probe(probe: Any, system: System) -> Source:
    variable = PROBES[probe.quantity]
    name = f"{probe.quantity.replace('_', ' ').capitalize()}, {probe_label(probe, system)}"
    unit = variable.units.replace("m/s2", "m/s²")
    return Source(name, unit, FULL_SCALES.get(variable.units, 1.0), f"A probe of the scenario: {variable.long_name}.")


def _with(source: Source, words: str) -> Source:
    """Return a source with more words."""
    return replace(source, words=source.words + words)


def _others_on(system: System, track: Any) -> Iterator[str]:
    """Yield what drives a track besides contacts that move along it, in words; weight alone does not sound."""
    for connection in system.connections:
        if any(point.body == track for point in ends(connection)):
            yield f"a {connection.kind}"
    for drive in system.drives:
        if drive.acted_on == track:
            yield drive.kind
        elif drive.acted_on is None and drive.starts_motion:
            yield "a mode of vibration at the start"
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        if contact.path_body != track or contact.tip.body == track:
            yield name


def _silent(system: System, track: Any) -> str:
    """Return words on the bodies whose sound is not included."""
    others = [system.body_name(body) for body in hearable(system) if body != track]
    return f" Not included: the sound of {listed(others)}." if others else ""


class Heard(Protocol):
    """Sound of a motion."""

    def begin(self) -> None:
        """Start from silence."""

    def heard(self, chunk: LiveChunk) -> Array:
        """Return the sound over a chunk."""

    def copy(self) -> Heard:
        """Return a sound that continues on its own from the same state."""


class Pressure:
    """The sound pressure above the middle of a track."""

    def __init__(self, system: System, interval: float, steps: int) -> None:
        self.sounds = [_sound(system.track, interval, steps).copy() for _ in system.contacts]
        self.interval, self.starts_at_rest = interval, system.initial_equilibrium is not None
        self.begin()

    def begin(self) -> None:
        """Start from silence."""
        for sound in self.sounds:
            sound.begin()
        self.places: list[float | None] = [None] * len(self.sounds)
        self.rest: Array | None = None

    def heard(self, chunk: LiveChunk) -> Array:
        """Return the pressure over a chunk [Pa]."""
        forces, abscissas = chunk.contacts["normal_force"], chunk.contacts["contact_position"]
        if self.rest is None:
            # Forces in equilibrium, and those of a stroke that continues, have already bent the track.
            is_bent = self.starts_at_rest or chunk.time[0] > 1.5 * self.interval
            self.rest = forces[:, :1] if is_bent else np.zeros((len(forces), 1))
        heard = []
        for number, (sound, force, places) in enumerate(zip(self.sounds, forces - self.rest, abscissas, strict=True)):
            last = self.places[number]
            before = np.concatenate([places[:1] if last is None else [last], places[:-1]])
            self.places[number] = float(places[-1])
            heard.append(sound.feed(force, (before + places) / 2.0))
        return heard[0] if len(heard) == 1 else np.asarray(np.sum(heard, axis=0))

    def copy(self) -> Pressure:
        """Return a sound that continues on its own from the same state."""
        other = copy(self)
        other.sounds, other.places = [sound.copy() for sound in self.sounds], list(self.places)
        return other


@lru_cache(maxsize=64)
def _sound(track: ModalBeam | ModalPlate, interval: float, steps: int) -> StreamedSound:
    """Return the sound of a track, prepared beforehand because that takes longer than a part of the sound."""
    across = getattr(track, "width", 0.0) / 2.0
    return StreamedSound(track, (track.length / 2.0, across, HEIGHT), interval, steps)


@dataclass(frozen=True)
class OfContacts:
    """A variable of the contacts, summed.

    Attributes
    ----------
    variable : str
        Its name in records.
    """

    variable: str

    def begin(self) -> None:
        """Do nothing: there is no memory of earlier chunks."""

    def heard(self, chunk: LiveChunk) -> Array:
        """Return the sum over a chunk."""
        return np.asarray(chunk.contacts[self.variable].sum(axis=0))

    def copy(self) -> OfContacts:
        """Return this source itself, which has no state."""
        return self


@dataclass(frozen=True)
class OfProbe:
    """A probe.

    Attributes
    ----------
    number : int
        Number of the probe.
    """

    number: int

    def begin(self) -> None:
        """Do nothing: there is no memory of earlier chunks."""

    def heard(self, chunk: LiveChunk) -> Array:
        """Return the probe over a chunk."""
        return chunk.probes[:, self.number]

    def copy(self) -> OfProbe:
        """Return this source itself, which has no state."""
        return self


def heard_from(live: LiveMarch) -> tuple[Any, ...]:
    """Return the parts of a live march on which sources of its sound depend."""
    system = live.system
    return system.track, live.ratio, len(system.contacts), system.initial_equilibrium is not None


def source_of(name: str, live: LiveMarch) -> Heard:
    """Return the sound of a motion by name, starting from silence."""
    if name == "pressure":
        return Pressure(live.system, live.interval, live.ratio)
    if name in ("force", "friction"):
        return OfContacts("normal_force" if name == "force" else "tangential_force")
    return OfProbe(int(name.removeprefix("probe ")) if name.startswith("probe ") else 0)
