"""The instrument: a contact played in strokes, whose sound and picture are sent in parts."""

from __future__ import annotations

import time as clock
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import choice
from ..histories import Constant
from ..integration.live import LiveChunk, LiveMarch
from ..integration.live import Moment as MarchMoment
from .drawing import drawing_of
from .last_seconds import LastSeconds
from .parts import THINNED, Part, Stop
from .playable import Playable
from .sources import Heard, Source, heard_from, source_of

RATE = 48_000
# A tip that sticks under a constant force, or has left the track, begins another stroke after this time [s].
PATIENCE = 0.5
# A failed stroke is followed by another if at least this time has passed since the last repeated one [s].
TRUST = 0.5
# A jump of the sound is smoothed over this time, so that a new stroke does not click [s].
BLEND = 0.004
# It keeps up with the sound if it plays more than this number of seconds per second.
LIVE = 1.05
# Number of moments that measure the speed of playing, their samples, and the samples of short ones, which are used if a
# short one takes longer than the last value [s].
MOMENTS, MOMENT, SHORT, LONG = 5, 480, 48, 0.01
# Number of parts to whose ends it can return.
PARTS_KEPT = 50
# Attributes that change while it plays.
PLAYING = ("stroke", "ended", "played_samples", "_still", "_blend", "_last", "_since_repeat", "_must_blend")


@dataclass(frozen=True)
class _Moment:
    """A moment to which an instrument can return: its attributes, its source and its march."""

    attributes: dict[str, Any]
    source: Heard
    march: MarchMoment

    @property
    def samples(self) -> int:
        """Samples played until then."""
        return int(self.attributes["played_samples"])


class Instrument:
    """A contact that is played.

    Parameters
    ----------
    played : Playable
        Scenario to play.
    source : str
        Source of the sound, a key of `Playable.sources`; the first of them if there is none of this name.
    """

    def __init__(self, played: Playable, source: str = "pressure") -> None:
        self.played, self.revision = played, 0
        self.live = LiveMarch(played.system, played.probes, played.scenario.scheme, RATE, played.scenario.step)
        self.wanted, self.name = source, _offered(source, played)
        self.source, self.drawing = source_of(self.name, self.live), drawing_of(played.system)
        self.repeats, self.stroke, self.played_samples = True, 1, 0
        self.ended = ""
        # Longer step needed to keep up with the sound [s], None if the usual one suffices.
        self.longer: float | None = None
        self._still, self._blend, self._last = 0, 0.0, 0.0
        # Number of samples since a stroke last followed another by itself.
        self._since_repeat = round(TRUST * RATE)
        self._must_blend = False
        self.last_seconds = LastSeconds(RATE, played)
        self.last_seconds.changed(0.0, played)
        self._moments: deque[_Moment] = deque(maxlen=PARTS_KEPT)
        # The part that is played again up to the place of a change.
        self._again: list[Part | Stop] = []
        self._forget()

    @property
    def given_samples(self) -> int:
        """Played samples without those that the next call of `play` gives again."""
        return self.played_samples - sum(one.samples for one in self._again)

    def is_of(self, played: Playable) -> bool:
        """Whether a scenario is of the case or text that is played."""
        return played.origin == self.played.origin

    def change(self, played: Playable, revision: int, kept: int | None = None) -> bool:
        """Continue as another scenario and return whether the motion continues; otherwise a stroke begins.

        Another case or text begins a stroke, as does any change after a stroke has ended.

        Parameters
        ----------
        played : Playable
            New scenario.
        revision : int
            Number of the change.
        kept : int, optional
            Played samples that must stay; the change takes place after them, and later ones are forgotten. The part
            that contains the last of them is given again up to the change. After all samples if left out.
        """
        now, again, last_seconds = self._now, self._again, self.last_seconds.copy()
        self._go_back(kept)
        try:
            goes_on = self._change(played, revision)
        except (ValueError, MemoryError):
            self._return_to(now)
            self._again, self.last_seconds = again, last_seconds
            raise
        self._forget()
        return goes_on

    def _change(self, played: Playable, revision: int) -> bool:
        longer = self.longer if self.is_of(played) else None
        if longer is not None and played.scenario.step is None:
            played = played.stepped(longer)
        drawing = self.drawing if played.system == self.drawing.system else drawing_of(played.system)
        before = heard_from(self.live)
        what = (played.system, played.probes, played.scenario.scheme, played.scenario.step)
        goes_on = self.is_of(played) and not self.ended
        if goes_on:
            goes_on = self.live.change(*what)
        else:
            self.live.begin(*what)
        name, source = _offered(self.wanted, played), self.source
        if before != heard_from(self.live) or name != self.name:
            source = source_of(name, self.live)
        self._now_plays(played, revision, name, source)
        self.longer, self.drawing = longer, drawing
        if not goes_on:
            self._begin_stroke()
        return goes_on

    def begin_as(self, other: Instrument, revision: int, kept: int | None = None) -> None:
        """Begin a stroke of the scenario of another instrument that has not been played yet, as in `change`."""
        self._go_back(kept)
        self.live, self.longer, self.drawing = other.live, other.longer, other.drawing
        self._now_plays(other.played, revision, other.name, other.source)
        self._begin_stroke()
        self._forget()

    def _now_plays(self, played: Playable, revision: int, name: str, source: Any) -> None:
        self._last *= played.sources[name].full_scale / self.heard_as.full_scale
        self.played, self.revision, self.name, self.source = played, revision, name, source
        self.last_seconds.goes_on_as(played)
        self.last_seconds.changed(self.played_samples / RATE, played)
        self._must_blend, self._still = True, 0
        self._since_repeat = round(TRUST * RATE)

    @property
    def _now(self) -> _Moment:
        return _Moment({name: getattr(self, name) for name in PLAYING}, self.source.copy(), self.live.moment)

    def _go_back(self, kept: int | None) -> None:
        """Return to a number of played samples, from the last moment before it, or else to the first known moment."""
        if kept is None or kept >= self.played_samples:
            return
        first, *others = self._moments
        moment = next((one for one in reversed(others) if one.samples <= kept), first)
        if moment.samples >= self.played_samples:
            return
        self._return_to(moment)
        missing = -(-(kept - self.played_samples) // THINNED) * THINNED
        self._again = list(self._played(max(0, missing)))

    def _return_to(self, moment: _Moment) -> None:
        vars(self).update(moment.attributes)
        self.source = moment.source.copy()
        self.live.return_to(moment.march)

    def _forget(self) -> None:
        """Forget earlier moments, since the instrument must not return to before now."""
        self._moments.clear()
        self._moments.append(self._now)

    def listen_to(self, name: str, kept: int | None = None) -> None:
        """Change the source of the sound, with a smooth transition at the same level, as soon as in `change`.

        Raises
        ------
        ValueError
            If there is no source of this name.
        """
        choice("source", name, tuple(self.played.sources))
        self._go_back(kept)
        self._last *= self.played.sources[name].full_scale / self.heard_as.full_scale
        self.wanted = self.name = name
        self.source, self._must_blend = source_of(name, self.live), True
        self._forget()

    @property
    def heard_as(self) -> Source:
        """Source of the sound."""
        return self.played.sources[self.name]

    def keep_up(self) -> float:
        """Return the seconds played per second, from the start, doubling the steps if that keeps up with the sound."""
        usual, speed, steps = self.played, self.speed(), self.live.ratio
        # Half the number of steps is at most three times as fast.
        if not LIVE / 3.0 < speed < LIVE or usual.scenario.step is not None or steps == 1:
            return speed
        step = self.live.interval / ((steps + 1) // 2)
        try:
            self.change(usual.stepped(step), self.revision)
        except ValueError:
            # The step is beyond the limit of the scheme.
            return speed
        longer = self.speed()
        if longer < LIVE:
            self.change(usual, self.revision)
            self._rewind()
            return speed
        self.longer = step
        return longer

    def speed(self) -> float:
        """Return the seconds played per second, measured over some moments, and restart."""
        # The first call may compile.
        self._taken(SHORT)
        samples = SHORT if self._taken(SHORT) > LONG else MOMENT
        taken = [self._taken(samples) for _ in range(MOMENTS)]
        self._rewind()
        return samples / RATE / sorted(taken)[MOMENTS // 2]

    def _rewind(self) -> None:
        self.live.restart()
        self.source.begin()
        self._forget()

    def _taken(self, samples: int) -> float:
        """Play a moment without output and return the processor time it takes [s], whatever else runs."""
        began = clock.thread_time()
        chunk, _ended = self.live.advance(samples)
        if len(chunk.time):
            self.source.heard(chunk)
            self.drawing.shapes(self.live, chunk)
        return clock.thread_time() - began

    def restart(self, kept: int | None = None) -> None:
        """Begin a stroke from the initial state, as soon as in `change`."""
        self._go_back(kept)
        self._restart()
        self._forget()

    def _restart(self) -> None:
        self.live.restart()
        self._begin_stroke()

    def repeat(self, on: bool) -> None:
        """Repeat strokes or not; if on, an ended stroke or one at rest begins again."""
        self.repeats = on
        if on and self.ended:
            self.restart()
        self._still = max(self._still, 0)

    def play(self, samples: int) -> Iterator[Part | Stop]:
        """Yield the next parts and the ends of strokes; nothing after a stroke that is not repeated."""
        again, self._again = self._again, []
        yield from again
        yield from self._played(samples)

    def _played(self, samples: int) -> Iterator[Part | Stop]:
        while samples and not self.ended:
            chunk, ended = self.live.advance(samples)
            if len(chunk.time):
                yield self._part(chunk)
            samples -= len(chunk.time)
            self._since_repeat += len(chunk.time)
            self._moments.append(self._now)
            why = ended if ended != "finished" else self._at_rest(chunk)
            if not why:
                continue
            # A stroke that ends at once would be repeated endlessly.
            needed = 1 if ended in ("finished", "off the track") else TRUST * RATE
            goes_on = self.repeats and self._since_repeat >= needed
            if goes_on:
                self._since_repeat = 0
                self._restart()
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
        """Return why this stroke remains at rest, or an empty text."""
        drives = self.live.system.drives
        is_constant = all(getattr(drive, "history", Constant()).settled == 0.0 for drive in drives)
        sticks = chunk.status_shares[..., 1].min() == 1.0 and not self._is_drawn_along()
        is_still = is_constant and (sticks or chunk.status_shares[..., 0].min() == 1.0)
        self._still = self._still + len(chunk.time) if is_still else min(self._still, 0)
        if self._still < PATIENCE * RATE:
            return ""
        return "at rest" if sticks else "lifted off"

    def _is_drawn_along(self) -> bool:
        """Return whether a motion is prescribed."""
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
        """Return the sound with a smooth transition after a jump."""
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
    """Return the requested source if the scenario has it, else its first source."""
    return wanted if wanted in played.sources else next(iter(played.sources))
