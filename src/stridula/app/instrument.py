"""The instrument: a contact that is played stroke after stroke, heard and seen part by part."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator

import numpy as np

from ..arrays import Array
from ..checks import choice
from ..histories import Constant
from ..integration.live import LiveChunk, LiveMarch
from .drawing import drawing_of
from .last_seconds import LastSeconds
from .parts import Part, Stop
from .playable import Playable
from .sources import Source, source_of

RATE = 48_000
# A tip that sticks under a constant force, or has been off the track, for so long [s] begins another stroke.
PATIENCE = 0.5
# After so long [s] without one, a stroke that cannot be believed is followed by another.
TRUST = 0.5
# Time in which a jump of what is heard dies away [s]: a stroke that begins anew does not click.
BLEND = 0.004
# Seconds played in one from which on it keeps up with the sound.
LIVE = 1.05
# Moments of so many samples by which it is found how fast it can be played; short ones where they take so long [s].
MOMENTS, MOMENT, SHORT, LONG = 5, 480, 48, 0.01


class Instrument:
    """A contact that is played.

    Parameters
    ----------
    played : Playable
        What is played.
    source : str
        What is heard, a key of `Playable.sources`; the first of them where there is none of this name.
    """

    def __init__(self, played: Playable, source: str = "pressure") -> None:
        self.played, self.revision = played, 0
        self.live = LiveMarch(played.system, played.probes, played.scenario.scheme, RATE, played.scenario.step)
        self.wanted, self.name = source, _offered(source, played)
        self.source, self.drawing = source_of(self.name, self.live), drawing_of(played.system)
        self.repeats, self.stroke, self.played_samples = True, 1, 0
        self.ended = ""
        # The step with which it keeps up with the sound [s], None where the usual one does.
        self.longer: float | None = None
        self._still, self._blend, self._last = 0, 0.0, 0.0
        # Samples since a stroke last followed another by itself.
        self._since_repeat = round(TRUST * RATE)
        self._must_blend = False
        self.last_seconds = LastSeconds(RATE, played)
        self.last_seconds.changed(0.0, played.toml)

    def change(self, played: Playable, revision: int) -> bool:
        """Go on as another scenario and return whether the motion went on; else a stroke begins.

        Another case or text begins one, and so does whatever follows a stroke that has ended.
        """
        longer = self.longer if played.origin == self.played.origin else None
        if longer is not None and played.scenario.step is None:
            played = played.stepped(longer)
        drawing = self.drawing if played.system == self.drawing.system else drawing_of(played.system)
        track, steps, contacts = self.live.system.track, self.live.ratio, len(self.live.system.contacts)
        what = (played.system, played.probes, played.scenario.scheme, played.scenario.step)
        goes_on = played.origin == self.played.origin and not self.ended
        if goes_on:
            goes_on = self.live.change(*what)
        else:
            self.live.begin(*what)
        name = _offered(self.wanted, played)
        self._last *= played.sources[name].full_scale / self.heard_as.full_scale
        self.played, self.revision = played, revision
        self.longer, self.drawing = longer, drawing
        self.last_seconds.goes_on_as(played)
        self.last_seconds.changed(self.played_samples / RATE, played.toml)
        now = (self.live.system.track, self.live.ratio, len(self.live.system.contacts))
        if (track, steps, contacts) != now or name != self.name:
            self.name, self.source = name, source_of(name, self.live)
        self._must_blend, self._still = True, 0
        if not goes_on:
            self._begin_stroke()
        self._since_repeat = round(TRUST * RATE)
        return goes_on

    def listen_to(self, name: str) -> None:
        """Let something else be heard, led over from what was heard at the same level.

        Raises
        ------
        ValueError
            If there is nothing of this name to be heard.
        """
        choice("source", name, tuple(self.played.sources))
        self._last *= self.played.sources[name].full_scale / self.heard_as.full_scale
        self.wanted = self.name = name
        self.source, self._must_blend = source_of(name, self.live), True

    @property
    def heard_as(self) -> Source:
        """What is heard."""
        return self.played.sources[self.name]

    def keep_up(self) -> float:
        """Return how many seconds are played in one, from the start, with steps twice as long where that keeps up."""
        usual, speed, steps = self.played, self.speed(), self.live.ratio
        # Half the steps never make it three times as fast.
        if not LIVE / 3.0 < speed < LIVE or usual.scenario.step is not None or steps == 1:
            return speed
        step = self.live.interval / ((steps + 1) // 2)
        try:
            self.change(usual.stepped(step), self.revision)
        except ValueError:
            # Beyond the limit of the scheme.
            return speed
        longer = self.speed()
        if longer < LIVE:
            self.change(usual, self.revision)
            self.live.restart()
            return speed
        self.longer = step
        return longer

    def speed(self) -> float:
        """Return how many seconds are played in one, from some moments, and begin again at the start."""
        # The first may compile.
        self._moment(SHORT)
        samples = SHORT if self._moment(SHORT) > LONG else MOMENT
        taken = [self._moment(samples) for _ in range(MOMENTS)]
        self.live.restart()
        self.source.begin()
        return samples / RATE / sorted(taken)[MOMENTS // 2]

    def _moment(self, samples: int) -> float:
        """Play a moment that nobody hears or sees and return how long it takes [s]."""
        began = clock.perf_counter()
        chunk, _ended = self.live.advance(samples)
        if len(chunk.time):
            self.source.heard(chunk)
            self.drawing.shapes(self.live, chunk)
        return clock.perf_counter() - began

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
        sticks = chunk.status_shares[..., 1].min() == 1.0 and not self._is_drawn_along()
        is_still = is_constant and (sticks or chunk.status_shares[..., 0].min() == 1.0)
        self._still = self._still + len(chunk.time) if is_still else min(self._still, 0)
        if self._still < PATIENCE * RATE:
            return ""
        return "at rest" if sticks else "lifted off"

    def _is_drawn_along(self) -> bool:
        """Return whether something is moved whatever the contacts do."""
        system = self.live.system
        rigid = [one.rigid_track for one in system.contacts if one.rigid_track is not None]
        moves = [*(not track.is_still for track in rigid), *(any(one.surface_velocities) for one in system.contacts)]
        return system.imposed_velocity is not None or any(moves)

    def _part(self, chunk: LiveChunk) -> Part:
        self.played_samples += len(chunk.time)
        sound = self._blended(self.source.heard(chunk))
        part = Part(
            self.revision, self.played_samples / RATE, sound, chunk, self.drawing.shapes(self.live, chunk), self.stroke
        )
        self.last_seconds.keep(part, self.heard_as)
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


def _offered(wanted: str, played: Playable) -> str:
    """Return what is to be heard of what is played: what is wanted if it has it, else what it has first."""
    return wanted if wanted in played.sources else next(iter(played.sources))
