"""The instrument: a contact played in strokes, whose sound and picture are sent in parts."""

from __future__ import annotations

import time as clock
from collections import deque
from collections.abc import Iterator, MutableSequence
from dataclasses import replace

from ..checks import choice
from ..integration.live import LiveMarch
from .drawing import drawing_of
from .last_seconds import LastSeconds
from .parts import THINNED, Part, Stop
from .playable import Playable
from .playing import NEVER, RATE, TRUST, Moment, Playing, offered
from .sources import Heard, Source, source_of

# It keeps up with the sound if it plays more than this number of seconds per second.
LIVE = 1.05
# Number of moments that measure the speed of playing, their samples, and the samples of short ones, which are used if a
# short one takes longer than the last value [s].
MOMENTS, MOMENT, SHORT, LONG = 5, 480, 48, 0.01
# Number of parts to whose ends it can return.
PARTS_KEPT = 50


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
        live = LiveMarch(played.system, played.probes, played.scenario.scheme, RATE, played.scenario.step)
        name, last_seconds = offered(source, played), LastSeconds(RATE, played)
        last_seconds.changed(0.0, played)
        self._now = Playing(played, source, name, live, source_of(name, live), last_seconds)
        self.drawing = drawing_of(played.system)
        self.repeats = True
        self._moments: deque[Moment] = deque(maxlen=PARTS_KEPT)
        # The part that is played again up to the place of a change.
        self._again: list[Part | Stop] = []
        self._forget()

    @property
    def played(self) -> Playable:
        """Scenario that is played."""
        return self._now.played

    @property
    def revision(self) -> int:
        """Number of the last change."""
        return self._now.revision

    @property
    def live(self) -> LiveMarch:
        """The march."""
        return self._now.live

    @property
    def last_seconds(self) -> LastSeconds:
        """The last seconds played."""
        return self._now.last_seconds

    @property
    def name(self) -> str:
        """Name of the source of the sound."""
        return self._now.name

    @property
    def source(self) -> Heard:
        """Source of the sound, as it continues."""
        return self._now.source

    @property
    def heard_as(self) -> Source:
        """Source of the sound, in words."""
        return self._now.heard_as

    @property
    def stroke(self) -> int:
        """Number of the stroke."""
        return self._now.stroke

    @property
    def ended(self) -> str:
        """Why the stroke ended, empty while it continues."""
        return self._now.ended

    @property
    def longer(self) -> float | None:
        """Longer step needed to keep up with the sound [s], None if the usual one suffices."""
        return self._now.longer

    @property
    def played_samples(self) -> int:
        """Samples played."""
        return self._now.samples

    @property
    def given_samples(self) -> int:
        """Played samples without those that the next call of `play` gives again."""
        return self.played_samples - sum(one.samples for one in self._again)

    def is_of(self, played: Playable) -> bool:
        """Whether a scenario is of the case or text that is played."""
        return played.origin == self.played.origin

    def begins_as(self, revision: int, repeats: bool) -> None:
        """Set the number of the change that begins it, and whether strokes are repeated."""
        self._now, self.repeats = replace(self._now, revision=revision), repeats
        self._forget()

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
        now, again = self._back_at(kept, is_apart=True)
        now, goes_on = now.changed(played, revision)
        self._continue(now, again)
        return goes_on

    def begin_as(self, other: Instrument, revision: int, kept: int | None = None) -> None:
        """Begin a stroke of the scenario of another instrument that has not been played yet, as in `change`."""
        now, again = self._back_at(kept)
        new = other._now
        now = replace(now, live=new.live, source=new.source, longer=new.longer)
        self.drawing = other.drawing
        self._continue(now.continued_as(new.played, revision, new.name).in_a_new_stroke(), again)

    def _continue(self, now: Playing, again: list[Part | Stop]) -> None:
        """Continue from what is played now, drawn first, without a way back to before it."""
        is_drawn = now.played.system == self.drawing.system
        drawing = self.drawing if is_drawn else drawing_of(now.played.system)
        self._now, self._again, self.drawing = now, again, drawing
        self._forget()

    def _forget(self) -> None:
        """Forget earlier moments, since the instrument must not return to before now."""
        self._moments.clear()
        self._moments.append(self._now.moment)

    def _back_at(self, kept: int | None, *, is_apart: bool = False) -> tuple[Playing, list[Part | Stop]]:
        """Return what was played after a number of samples, and the parts to give again up to there.

        Found from the last moment before it, or else from the first known moment; if `is_apart`, what is played now
        stays as it is.
        """
        now, again = self._now, self._again
        if kept is None or kept >= now.samples:
            return now, again
        first, *others = self._moments
        moment = next((one for one in reversed(others) if one.samples <= kept), first)
        if moment.samples >= now.samples:
            return now, again
        then = replace(moment.playing, source=moment.playing.source.copy())
        if is_apart:
            then = replace(then, live=now.live.at(moment.march), last_seconds=now.last_seconds.copy())
        else:
            then.live.return_to(moment.march)
        missing = max(0, -(-(kept - then.samples) // THINNED) * THINNED)
        found = [*self._strokes(then, missing, [])]
        return (found[-1][0] if found else then), [one for _, one in found if one is not None]

    def listen_to(self, name: str, kept: int | None = None) -> None:
        """Change the source of the sound, with a smooth transition at the same level, as soon as in `change`.

        Raises
        ------
        ValueError
            If there is no source of this name.
        """
        choice("source", name, tuple(self.played.sources))
        now, again = self._back_at(kept)
        self._continue(now.listening_to(name), again)

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
        self._now = replace(self._now, longer=step)
        self._forget()
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
        now, again = self._back_at(kept)
        self._continue(now.restarted(), again)

    def repeat(self, on: bool) -> None:
        """Repeat strokes or not; if on, an ended stroke or one at rest begins again."""
        self.repeats = on
        if on and self.ended:
            self.restart()
        self._now = replace(self._now, still=max(self._now.still, 0))

    def play(self, samples: int) -> Iterator[Part | Stop]:
        """Yield the next parts and the ends of strokes; nothing after a stroke that is not repeated."""
        again, self._again = self._again, []
        yield from again
        for now, one in self._strokes(self._now, samples, self._moments):
            self._now = now
            if one is not None:
                yield one

    def _strokes(
        self, now: Playing, samples: int, moments: MutableSequence[Moment]
    ) -> Iterator[tuple[Playing, Part | Stop | None]]:
        """Yield what is played after each part and each end of a stroke, and the part or the end; keep the moments."""
        while samples and not now.ended:
            chunk, ended = now.live.advance(samples)
            if len(chunk.time):
                now, part = now.after(chunk, self.drawing)
                yield now, part
            samples -= len(chunk.time)
            moments.append(now.moment)
            why, now = (ended, now) if ended != "finished" else now.at_rest(chunk)
            if not why:
                yield now, None
                continue
            # A stroke that ends at once would be repeated endlessly.
            needed = 1 if ended in ("finished", "off the track") else TRUST * RATE
            goes_on = self.repeats and now.since_repeat >= needed
            if goes_on:
                now = replace(now, since_repeat=0).restarted()
            elif ended == "finished":
                now = replace(now, still=NEVER)
                yield now, None
                continue
            else:
                now = replace(now, ended=why)
            yield now, Stop(why, goes_on)
