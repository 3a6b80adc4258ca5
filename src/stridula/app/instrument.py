"""The instrument: a contact that is played stroke after stroke, heard and seen part by part."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from ..arrays import Array
from ..bodies import FiniteElementBeam, ModalBeam
from ..histories import Constant
from ..integration.live import LiveChunk, LiveMarch
from .last_seconds import LastSeconds
from .parts import Part, Shapes, Stop
from .playable import Playable
from .sources import SOURCES, source_of

RATE = 48_000
# A tip that sticks under a constant force, or has been off the track, for so long [s] begins another stroke.
PATIENCE = 0.5
# After so long [s] without one, a stroke that cannot be believed is followed by another.
TRUST = 0.5
# Time in which a jump of what is heard dies away [s]: a stroke that begins anew does not click.
BLEND = 0.004
TRACK_POINTS = 65


class Instrument:
    """A contact that is played.

    Parameters
    ----------
    played : Playable
        What is played.
    source : str
        What is heard: ``pressure``, ``force`` or ``acceleration``.
    """

    def __init__(self, played: Playable, source: str = "pressure") -> None:
        self.played, self.revision = played, 0
        self.live = LiveMarch(played.system, played.probes, played.scenario.scheme, RATE)
        self.name, self.source = source, source_of(source, self.live)
        self.repeats, self.stroke, self.played_samples = True, 1, 0
        self.ended = ""
        self._still, self._blend, self._last = 0, 0.0, 0.0
        # Samples since a stroke last followed another by itself.
        self._since_repeat = round(TRUST * RATE)
        self._must_blend = False
        self.last_seconds = LastSeconds(RATE)
        self.last_seconds.changed(0.0, played.toml)

    def change(self, played: Playable, revision: int) -> bool:
        """Go on as another scenario and return whether the motion went on; else a stroke begins.

        Another case or text begins one, and so does whatever follows a stroke that has ended.
        """
        track, steps = self.live.system.track, self.live.ratio
        what = (played.system, played.probes, played.scenario.scheme)
        goes_on = played.origin == self.played.origin and not self.ended
        if goes_on:
            goes_on = self.live.change(*what)
        else:
            self.live.begin(*what)
        self.played, self.revision = played, revision
        self.last_seconds.changed(self.played_samples / RATE, played.toml)
        if (track, steps) != (self.live.system.track, self.live.ratio):
            self.source = source_of(self.name, self.live)
        self._must_blend, self._still = True, 0
        if not goes_on:
            self._begin_stroke()
        self._since_repeat = round(TRUST * RATE)
        return goes_on

    def listen_to(self, name: str) -> None:
        """Let something else be heard, led over from what was heard at the same level."""
        self._last *= SOURCES[name].full_scale / SOURCES[self.name].full_scale
        self.name, self.source, self._must_blend = name, source_of(name, self.live), True

    def restart(self) -> None:
        """Begin a stroke at the start."""
        self.live.restart()
        self._begin_stroke()

    def repeat(self, on: bool) -> None:
        """Let strokes follow each other or not; what has ended or is at rest begins anew."""
        self.repeats = on
        if on and self.ended:
            self.restart()
        self._still = max(self._still, 0)

    def play(self, samples: int) -> Iterator[Part | Stop]:
        """Play on and return what was played, and what ended strokes; nothing once a stroke ended for good."""
        while samples and not self.ended:
            chunk, ended = self.live.advance(samples)
            if len(chunk.time):
                yield self._part(chunk)
            samples -= len(chunk.time)
            self._since_repeat += len(chunk.time)
            why = ended if ended != "finished" else self._at_rest(chunk)
            if not why:
                continue
            # What ends as soon as it begins would begin without end.
            needed = 1 if ended in ("finished", "off the track") else TRUST * RATE
            goes_on = self.repeats and self._since_repeat >= needed
            if goes_on:
                self._since_repeat = 0
                self.restart()
            elif ended == "finished":
                self._still = -(2**62)
                continue
            else:
                self.ended = why
            yield Stop(why, goes_on)

    def _begin_stroke(self) -> None:
        self.stroke, self.ended = self.stroke + 1, ""
        self.source.begin()
        self._must_blend, self._still = True, 0

    def _at_rest(self, chunk: LiveChunk) -> str:
        """Return why nothing more will come of this stroke, or nothing."""
        drives = self.live.system.drives
        is_constant = all(getattr(drive, "history", Constant()).settled == 0.0 for drive in drives)
        sticks = chunk.status_share[:, 1].min() == 1.0 and self.live.system.imposed_velocity is None
        is_still = is_constant and (sticks or chunk.status_share[:, 0].min() == 1.0)
        self._still = self._still + len(chunk.time) if is_still else min(self._still, 0)
        if self._still < PATIENCE * RATE:
            return ""
        return "at rest" if sticks else "lifted off"

    def _part(self, chunk: LiveChunk) -> Part:
        self.played_samples += len(chunk.time)
        sound = self._blended(self.source.heard(chunk))
        clock = self.played_samples / RATE
        part = Part(self.revision, clock, sound, chunk, self._shapes(chunk), self.stroke)
        self.last_seconds.keep(part, self.name)
        return part

    def _blended(self, sound: Array) -> Array:
        """Return what is heard, led over from what was heard before a jump."""
        if self._must_blend:
            self._blend, self._must_blend = self._last - float(sound[0]), False
        if self._blend:
            fade = np.exp(-np.arange(len(sound) + 1) / (BLEND * RATE))
            sound = sound + self._blend * fade[:-1]
            self._blend *= fade[-1]
            if abs(self._blend) < 1e-9 * (1.0 + abs(self._last)):
                self._blend = 0.0
        self._last = float(sound[-1])
        return sound

    def _shapes(self, chunk: LiveChunk) -> Shapes:
        position, spans, system = self.live.position, self.live.spans, self.live.system
        slider: FiniteElementBeam = system.slider
        track: ModalBeam = system.track
        nodes = slider.node_traces(system.is_held(slider)) @ position[slice(*spans[system.body_name(slider)])]
        moved = nodes.reshape(-1, 3)[:, :2]
        first, _ = spans[system.body_name(track)]
        waves = track.harmonics[0]
        deflection = _sines(waves) @ (track.amplitude * position[first : first + waves])
        place, height = (float(chunk.contact[name][-1]) for name in ("contact_position", "contact_height"))
        return Shapes(place, height, moved - moved[0], np.asarray(deflection))


@lru_cache(maxsize=64)
def _sines(waves: int) -> Array:
    """Return the values of sines over a track, shape (points, waves)."""
    return np.sin(np.outer(np.linspace(0.0, np.pi, TRACK_POINTS), np.arange(1, waves + 1)))
