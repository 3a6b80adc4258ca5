"""Challenges for a class: motions to reach from a shipped case, judged by the motion that the page names."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from ..scenarios.outline import look_up
from .messages import Scene
from .playable import Playable, playable
from .turned import places_of

NAMES = ("C", "C♯", "D", "D♯", "E", "F", "F♯", "G", "G♯", "A", "A♯", "B")
# Frequency of A4 [Hz], and its MIDI number.
A4, A4_KEY = 440.0, 69
# Regimes in the words of the page.
WORDS = {
    "squeal": "squeals",
    "stick-slip": "sticks and slips",
    "judder": "judders",
    "stable sliding": "slides steadily",
    "sticking": "sticks",
    "off the track": "has lifted off",
}


@dataclass(frozen=True)
class Bound:
    """Ends of a value, in SI, and how they are told.

    Attributes
    ----------
    key : str
        Key of the value.
    low, high : float
        Its smallest and largest allowed value.
    words : str
        What is wrong with a value outside.
    """

    key: str
    low: float
    high: float
    words: str


@dataclass(frozen=True)
class Challenge:
    """A motion to reach.

    Attributes
    ----------
    name, title, words, hint : str
        Name in links, title, task, and hint.
    case : str
        Case from which it begins.
    regime : str
        Regime to reach.
    note : str
        Nearest note of the pitch, with its octave; empty for any.
    frequency : tuple of float
        Smallest and largest frequency [Hz].
    bounds : tuple of Bound
        Values that must stay within bounds.
    changes : int
        Largest number of values that may differ from the case.
    hold : float
        Time played for which the motion must be named without a break, and without a change [s].
    """

    name: str
    title: str
    words: str
    hint: str
    case: str
    regime: str
    note: str = ""
    frequency: tuple[float, float] = (0.0, math.inf)
    bounds: tuple[Bound, ...] = ()
    changes: int = 40
    hold: float = 3.0

    @property
    def described(self) -> dict[str, Any]:
        """Description for the page."""
        return {name: getattr(self, name) for name in ("name", "title", "words", "hint", "case")}


@dataclass
class Judge:
    """The judge of a challenge, who looks at every motion that the page names.

    Attributes
    ----------
    challenge : Challenge
        Challenge to judge.
    """

    challenge: Challenge
    _revision: int = field(default=-1, init=False)
    # Times at which this setting was first named, and since which it meets the challenge without a break.
    _first: float = field(default=0.0, init=False)
    _since: float | None = field(default=None, init=False)
    _reached: bool = field(default=False, init=False)

    def after(
        self, named: Mapping[str, Any], scene: Scene, played: Playable, clock: float, revision: int
    ) -> dict[str, Any]:
        """Return the verdict after a motion was named.

        Parameters
        ----------
        named : mapping
            ``regime`` and ``frequency`` [Hz] that the page names.
        scene : Scene
            Setting that plays.
        played : Playable
            Its scenario.
        clock : float
            Time played [s].
        revision : int
            Number of the last change: after a change the time to hold begins again.

        Returns
        -------
        dict
            ``name``; ``held`` and ``hold`` [s]; whether the challenge is ``reached``, and whether the setting is
            ``judged``; ``words`` that tell what is missing.
        """
        if revision != self._revision:
            self._revision, self._first, self._since, self._reached = revision, clock, None, False
        problem = missing(self.challenge, named, scene, played)
        if problem:
            self._since = None
        elif self._since is None:
            self._since = clock
        hold = self.challenge.hold
        held = 0.0 if self._since is None else min(hold, clock - self._since)
        self._reached = self._reached or held >= hold
        is_judged = self._reached or (bool(problem) and clock - self._first >= hold)
        return {
            "name": self.challenge.name,
            "held": hold if self._reached else held,
            "hold": hold,
            "reached": self._reached,
            "judged": is_judged,
            "words": "" if self._reached else problem,
        }


def missing(challenge: Challenge, named: Mapping[str, Any], scene: Scene, played: Playable) -> str:
    """Return in a sentence what a setting and its motion lack for a challenge, empty if nothing."""
    if scene.text is not None or scene.case != challenge.case:
        return "Another case plays: Start again returns to that of the challenge."
    many = changes(scene, challenge.case)
    if many > challenge.changes:
        allowed = f"{challenge.changes} value" + ("s" if challenge.changes > 1 else "")
        return f"{many} values differ from the case: only {allowed} may."
    for bound in challenge.bounds:
        value = played.turned.values.get(bound.key)
        if not (isinstance(value, (int, float)) and bound.low <= value <= bound.high):
            return bound.words
    if named["regime"] != challenge.regime:
        return f"It {WORDS[named['regime']]}."
    return _off_pitch(challenge, named["frequency"])


def _off_pitch(challenge: Challenge, frequency: float | None) -> str:
    low, high = challenge.frequency
    if not challenge.note and (low, high) == (0.0, math.inf):
        return ""
    if frequency is None:
        return "Its pitch is not clear."
    if challenge.note and note_of(frequency) != challenge.note:
        return f"Its note is {note_of(frequency)}."
    if not low <= frequency <= high:
        return f"It is too {'slow' if frequency < low else 'fast'}: {frequency:.3g} times a second."
    return ""


def note_of(frequency: float) -> str:
    """Return the nearest note of equal temperament to a frequency [Hz], as the page names it."""
    key = math.floor(A4_KEY + 12.0 * math.log2(frequency / A4) + 0.5)
    return f"{NAMES[key % 12]}{key // 12 - 1}"


def changes(scene: Scene, case: str) -> int:
    """Return the number of values that a scene sets to others than those of a case."""
    begins = _begins(case)
    known = begins.turned.values

    def is_other(key: str, value: Any) -> bool:
        if begins.before is None:
            return bool(known.get(key) != value)
        return any(look_up(begins.tables, place) != value for place in places_of(key, begins.tables))

    return sum(is_other(key, value) for key, value in scene.overrides.items())


@cache
def _begins(case: str) -> Playable:
    return playable(case, None, {})


_ALL = (
    Challenge(
        "wheel-a4",
        "Make the wheel squeal at A4",
        "The railway wheel squeals at 351 Hz, an F4. Make it squeal at A4, the 440 Hz to which orchestras tune.",
        "The pitch is that of a mode of the wheel. Which of its numbers raises all modes, and by which factor must it "
        "change for the pitch to rise by a quarter? Pitch goes with the square root of stiffness over mass.",
        "wheel",
        "squeal",
        note="A4",
    ),
    Challenge(
        "glass-silent",
        "Silence the glass with one slider",
        "The wine glass sings. Change one value, and only one, so that the finger slides without a sound.",
        "The glass takes its energy from friction that falls as the finger slides faster. Without a fall, or with a "
        "very small one, damping wins.",
        "glass",
        "stable sliding",
        changes=1,
        hold=6.0,
    ),
    Challenge(
        "largest-friction",
        "Find the largest friction at which it slides",
        "At a friction of 1.1 the pushed slider hammers. Find the largest friction at which it slides steadily, to "
        "within 0.02, and change nothing else.",
        "The slider leans by 45 degrees and is pushed along its axis. Up to which friction is a push of this angle "
        "steep enough to overcome it? Think of a ladder against a wall.",
        "judder",
        "stable sliding",
        bounds=(Bound("contact.friction.coefficient", 0.98, math.inf, "It also slides at a larger friction."),),
        changes=1,
    ),
    Challenge(
        "belt-second",
        "Make the belt stick and slip once a second",
        "The mass on the belt sticks and slips once in 3.7 s. Make it once a second, to within a tenth.",
        "While it sticks, the spring is drawn out at the speed of the belt until it overcomes friction; a stiffer "
        "spring ends that sooner. The slip takes about half a period of the mass on the spring.",
        "belt",
        "stick-slip",
        frequency=(0.9, 1.1),
        hold=5.0,
    ),
    Challenge(
        "violin-a3",
        "Tune the violin to A3",
        "The open G string sounds at 195 Hz, a G3. Tune it up by two semitones to A3, at 220 Hz, as with its peg.",
        "The peg changes the tension. Pitch goes with its square root.",
        "violin",
        "stick-slip",
        note="A3",
        changes=1,
        hold=2.0,
    ),
    Challenge(
        "lugre-steady",
        "End stick-slip with one slider",
        "A spring pulls a mass at 0.1 m/s, and the mass sticks and slips. Change one value so that it slides steadily.",
        "In each cycle the mass comes to rest. It does not if the pull is fast enough, or if friction at rest is "
        "hardly larger than while sliding.",
        "lugre",
        "stable sliding",
        changes=1,
        hold=10.0,
    ),
    Challenge(
        "pressure-squeal",
        "Turn the hammering into a squeal",
        "The dragged slider flies and lands some four hundred times a second. Make it squeal, with one value.",
        "The tip needs time to fly. What leaves it none?",
        "weak-pressure",
        "squeal",
        changes=1,
    ),
)
CHALLENGES = {one.name: one for one in _ALL}
