"""What an instrument plays, and how far it is, as a value: strokes, sound, and their end."""

from __future__ import annotations

from contextlib import suppress
from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..histories import Constant
from ..integration.live import LiveChunk, LiveMarch
from ..integration.live import Moment as MarchMoment
from .drawing import Drawing
from .last_seconds import LastSeconds
from .parts import Part
from .playable import Playable
from .sources import Heard, Source, heard_from, source_of

RATE = 48_000
# Time after which a tip that sticks under a constant force, or is off the track, begins another stroke [s].
PATIENCE = 0.5
# Time since the last repeated stroke after which a failed stroke is followed by another [s].
TRUST = 0.5
# Time in which a jump of the sound is smoothed, so that a new stroke does not click [s].
BLEND = 0.004
# Samples without rest after which a stroke at rest stays as it is.
NEVER = -(2**62)


@dataclass(frozen=True)
class Playing:
    """What an instrument plays; its march, its source and its record continue in place, all else is replaced.

    Attributes
    ----------
    played : Playable
        Scenario that is played.
    wanted, name : str
        Requested source of the sound, and the one that the scenario has in its place.
    live : LiveMarch
        The march.
    source : Heard
        Source of the sound.
    last_seconds : LastSeconds
        The last seconds played.
    revision : int
        Number of the last change.
    longer : float or None
        Longer step needed to keep up with the sound [s], None if the usual one suffices.
    stroke : int
        Number of the stroke.
    ended : str
        Why it ended, empty while it continues.
    samples : int
        Samples played.
    still : int
        Samples since the system is at rest.
    since_repeat : int
        Samples since a stroke last followed another by itself.
    last, blend : float
        Last value of the sound, and what is left of its last jump.
    must_blend : bool
        Whether the sound is about to jump.
    """

    played: Playable
    wanted: str
    name: str
    live: LiveMarch
    source: Heard
    last_seconds: LastSeconds
    revision: int = 0
    longer: float | None = None
    stroke: int = 1
    ended: str = ""
    samples: int = 0
    still: int = 0
    since_repeat: int = round(TRUST * RATE)
    last: float = 0.0
    blend: float = 0.0
    must_blend: bool = False

    @property
    def heard_as(self) -> Source:
        """Source of the sound, in words."""
        return self.played.sources[self.name]

    @property
    def moment(self) -> Moment:
        """The present moment."""
        return Moment(replace(self, source=self.source.copy()), self.live.moment)

    def apart(self) -> Playing:
        """Return the same on its own: changes of it leave this one as it is."""
        return replace(self, live=copy(self.live), source=self.source.copy(), last_seconds=self.last_seconds.copy())

    def changed(self, played: Playable, revision: int) -> tuple[Playing, bool]:
        """Return what is played after a change, and whether the motion continues; otherwise a stroke begins.

        Raises
        ------
        ValueError
            If the march refuses the scenario; then nothing is changed.
        """
        longer = self.longer if played.origin == self.played.origin else None
        if longer is not None and played.scenario.step is None:
            # The longer step may be beyond the limit of the changed scenario.
            with suppress(ValueError):
                return self._changed(played.stepped(longer), revision, longer)
            longer = None
        return self._changed(played, revision, longer)

    def _changed(self, played: Playable, revision: int, longer: float | None) -> tuple[Playing, bool]:
        then = self.apart()
        what = (played.system, played.probes, played.scenario.scheme, played.scenario.step)
        goes_on = played.origin == self.played.origin and not self.ended
        if goes_on:
            goes_on = then.live.change(*what)
        else:
            then.live.begin(*what)
        name = offered(self.wanted, played)
        if name != self.name or heard_from(then.live) != heard_from(self.live):
            then = replace(then, source=source_of(name, then.live))
        then = replace(then.continued_as(played, revision, name), longer=longer)
        return (then if goes_on else then.in_a_new_stroke()), goes_on

    def continued_as(self, played: Playable, revision: int, name: str) -> Playing:
        """Return the same from a change of the scenario on."""
        self.last_seconds.goes_on_as(played)
        self.last_seconds.changed(self.samples / RATE, played)
        return replace(
            self.at_the_level_of(played.sources[name]),
            played=played,
            revision=revision,
            name=name,
            must_blend=True,
            still=0,
            since_repeat=round(TRUST * RATE),
        )

    def listening_to(self, name: str) -> Playing:
        """Return the same with another source, at the same level."""
        then = self.at_the_level_of(self.played.sources[name])
        return replace(then, wanted=name, name=name, source=source_of(name, self.live), must_blend=True)

    def at_the_level_of(self, source: Source) -> Playing:
        """Return the same with its last value in the unit of a source."""
        return replace(self, last=self.last * (source.full_scale / self.heard_as.full_scale))

    def in_a_new_stroke(self) -> Playing:
        """Return the same in the next stroke, whose march has begun."""
        self.source.begin()
        return replace(self, stroke=self.stroke + 1, ended="", must_blend=True, still=0)

    def restarted(self) -> Playing:
        """Return the same in another stroke from the initial state."""
        self.live.restart()
        return self.in_a_new_stroke()

    def after(self, chunk: LiveChunk, drawing: Drawing) -> tuple[Playing, Part]:
        """Return the same after a chunk of the march, and its sound and picture."""
        heard, then = self.source.heard(chunk), replace(self, samples=self.samples + len(chunk.time))
        sound, then = then.blended(heard)
        shapes = drawing.shapes(self.live, chunk)
        part = Part(self.revision, then.samples / RATE, sound, chunk, shapes, self.stroke)
        self.last_seconds.keep(part, self.heard_as)
        return replace(then, since_repeat=self.since_repeat + len(chunk.time)), part

    def blended(self, sound: Array) -> tuple[Array, Playing]:
        """Return the sound with a smooth transition after a jump, and the same after it."""
        blend = self.last - float(sound[0]) if self.must_blend else self.blend
        if blend:
            fade = np.exp(-np.arange(len(sound) + 1) / (BLEND * RATE))
            sound = sound + blend * fade[:-1]
            blend *= fade[-1]
            if abs(blend) < 1e-9 * (1.0 + abs(self.last)):
                blend = 0.0
        return sound, replace(self, last=float(sound[-1]), blend=blend, must_blend=False)

    def at_rest(self, chunk: LiveChunk) -> tuple[str, Playing]:
        """Return why this stroke remains at rest, or an empty text, and the same with the time at rest."""
        drives = self.live.system.drives
        is_constant = all(getattr(drive, "history", Constant()).settled == 0.0 for drive in drives)
        sticks = chunk.status_shares[..., 1].min() == 1.0 and not self._is_drawn_along
        is_still = is_constant and (sticks or chunk.status_shares[..., 0].min() == 1.0)
        still = self.still + len(chunk.time) if is_still else min(self.still, 0)
        why = "at rest" if sticks else "lifted off"
        return (why if still >= PATIENCE * RATE else ""), replace(self, still=still)

    @property
    def _is_drawn_along(self) -> bool:
        """Whether a motion is prescribed."""
        system = self.live.system
        rigid = [one.rigid_track for one in system.contacts if one.rigid_track is not None]
        moves = [*(not track.is_still for track in rigid), *(any(one.surface_velocities) for one in system.contacts)]
        return system.imposed_velocity is not None or any(moves)


@dataclass(frozen=True)
class Moment:
    """A moment to which an instrument can return.

    Attributes
    ----------
    playing : Playing
        The state of playing, with a source of its own.
    march : Moment
        The moment of its march.
    """

    playing: Playing
    march: MarchMoment

    @property
    def samples(self) -> int:
        """Samples played until then."""
        return self.playing.samples


def offered(wanted: str, played: Playable) -> str:
    """Return the requested source if the scenario has it, else its first source."""
    return wanted if wanted in played.sources else next(iter(played.sources))
