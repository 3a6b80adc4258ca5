"""Challenges: each can be met, none is met by its case, and passing by does not count; without a browser."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest

from stridula.app import now
from stridula.app.challenges import CHALLENGES, WORDS, Judge, changes, missing, note_of
from stridula.app.instrument import RATE, Instrument
from stridula.app.messages import Scene
from stridula.app.playable import playable
from stridula.plot.colours import REGIME_COLOURS
from stridula.records.by_surface import groups

from .scripting import result_of

# A setting that meets each challenge.
SOLUTIONS = {
    "wheel-a4": {"bodies.wheel.material.young": 330e9},
    "glass-silent": {"contacts.0.friction.static": 0.31},
    "largest-friction": {"contact.friction.coefficient": 0.99},
    "belt-second": {"connections.0.stiffness": 20.0, "bodies.block.mass": 0.4},
    "violin-a3": {"bodies.string.tension": 55.7},
    "lugre-steady": {"contacts.0.track.velocity": -0.2},
    "pressure-squeal": {"drives.0.normal_load": 100.0},
}
# Time after which a judge must have decided [s], longer where a slow motion must settle.
SECONDS = {"belt-second": 20, "lugre-steady": 30, "glass-silent": 14, "violin-a3": 4}


def scene(case: str, overrides: dict, revision: int = 1, text: str | None = None) -> Scene:
    return Scene(type="scene", revision=revision, case=case, text=text, overrides=overrides)


def judged(name: str, overrides: dict, seconds: int) -> list[dict]:
    """Return the verdicts on a setting that is chosen while the case plays, as the page does, one a second."""
    challenge = CHALLENGES[name]
    instrument, headline, judge = Instrument(playable(challenge.case, None, {})), now.Headline(), Judge(challenge)
    list(instrument.play(RATE // 2))
    instrument.change(playable(challenge.case, None, overrides), 1)
    wanted, verdicts = scene(challenge.case, overrides), []
    for _ in range(seconds):
        for _ in range(100):
            list(instrument.play(RATE // 100))
        last, played = instrument.last_seconds, instrument.played
        variables, _ = last.moment(headline.seconds(last.steady))
        if not headline.takes(len(variables["damping_loss"]) / RATE, 1):
            continue
        names = played.system.contact_names
        members = [names[those[0]] for those in groups(names, played.system.surface_names)]
        told = {key: now.said(values) for key, values in variables.items()}
        named = headline.after(now.measured(1.0 / RATE, members, told), 1)
        verdicts.append(judge.after(named, wanted, played, instrument.played_samples / RATE, 1))
        if verdicts[-1]["reached"]:
            break
    return verdicts


@pytest.mark.parametrize("name", CHALLENGES)
def test_a_challenge_can_be_met(name):
    verdicts = judged(name, SOLUTIONS[name], SECONDS.get(name, 8))
    assert verdicts[-1]["reached"], verdicts[-1]["words"]
    assert not verdicts[0]["reached"]


@pytest.mark.parametrize("name", CHALLENGES)
def test_a_case_does_not_meet_its_challenge(name):
    challenge = CHALLENGES[name]
    verdicts = judged(name, {}, SECONDS.get(name, 8))
    assert not any(one["reached"] for one in verdicts)
    assert verdicts[-1]["judged"]
    assert verdicts[-1]["words"]
    assert changes(scene(challenge.case, SOLUTIONS[name]), challenge.case) <= challenge.changes


def test_texts_name_the_values_of_the_cases():
    friction = playable("judder", None, {}).turned.values["contact.friction.coefficient"]
    assert f"friction of {friction:g} " in CHALLENGES["largest-friction"].words
    velocity = playable("lugre", None, {}).turned.values["contacts.0.track.velocity"]
    assert f"at {-velocity:g} m/s" in CHALLENGES["lugre-steady"].words
    assert len(CHALLENGES) >= 6
    for one in CHALLENGES.values():
        assert re.fullmatch(r"[a-z0-9-]{1,40}", one.name)
        assert one.hint
        # Nothing of the task is left to the note or the frequency where only the regime counts.
        assert (not one.note) or one.note in one.words


def test_the_bound_of_the_largest_friction_is_within_its_words_of_the_limit():
    """At 45 degrees a push along the axis overcomes friction up to the tangent, 1."""
    [bound] = CHALLENGES["largest-friction"].bounds
    angle = playable("judder", None, {}).turned.values["slider.angle"]
    assert bound.low == pytest.approx(math.tan(angle) - 0.02)
    verdicts = judged("largest-friction", {"contact.friction.coefficient": 0.9}, 6)
    assert verdicts[-1]["words"] == bound.words
    verdicts = judged("largest-friction", {"contact.friction.coefficient": 1.04}, 6)
    assert not any(one["reached"] for one in verdicts)


NAMED = {"regime": "squeal", "frequency": 440.0}


def test_passing_by_does_not_count():
    played, wanted = SimpleNamespace(turned=SimpleNamespace(values={})), scene("wheel", {})
    judge = Judge(CHALLENGES["wheel-a4"])

    def after(clock: float, frequency: float = 440.0, revision: int = 1) -> tuple[float, bool]:
        found = judge.after(NAMED | {"frequency": frequency}, wanted, played, clock, revision)
        return found["held"], found["reached"]

    assert [after(clock) for clock in (10.0, 11.0, 12.9)] == [(0.0, False), (1.0, False), (pytest.approx(2.9), False)]
    # It is left, and the time begins again.
    assert after(12.95, 500.0) == (0.0, False)
    assert after(13.5) == (0.0, False)
    assert after(16.4) == (pytest.approx(2.9), False)
    # So it does with each change.
    assert after(16.5, revision=2) == (0.0, False)
    assert after(19.5, revision=2) == (3.0, True)
    # Reached once, it stays so until the next change.
    assert after(21.0, 500.0, revision=2) == (3.0, True)
    assert after(21.0, 500.0, revision=3) == (0.0, False)


def test_a_verdict_of_no_needs_the_time_to_hold():
    played, wanted = SimpleNamespace(turned=SimpleNamespace(values={})), scene("wheel", {})
    judge = Judge(CHALLENGES["wheel-a4"])
    told = [judge.after(NAMED | {"frequency": 351.0}, wanted, played, clock, 1) for clock in (5.0, 7.0, 8.0)]
    assert [one["judged"] for one in told] == [False, False, True]
    assert told[-1]["words"] == "Its note is F4."


def test_what_is_missing_is_said():
    played = playable("wheel", None, {})
    one = CHALLENGES["wheel-a4"]
    assert missing(one, NAMED, scene("wheel", {}), played) == ""
    assert missing(one, NAMED | {"frequency": None}, scene("wheel", {}), played) == "Its pitch is not clear."
    assert missing(one, {"regime": "judder", "frequency": 440.0}, scene("wheel", {}), played) == "It judders."
    assert missing(one, NAMED, scene("glass", {}), played).startswith("Another case plays")
    assert missing(one, NAMED, scene("wheel", {}, text="title = 'a wheel'"), played).startswith("Another case plays")
    belt = CHALLENGES["belt-second"]
    slow = missing(belt, {"regime": "stick-slip", "frequency": 0.27}, scene("belt", {}), playable("belt", None, {}))
    assert slow == "It is too slow: 0.27 times a second."
    two = scene("glass", {"contacts.0.friction.static": 0.5, "drives.0.z": -0.5})
    slides = {"regime": "stable sliding", "frequency": None}
    assert (
        missing(CHALLENGES["glass-silent"], slides, two, played) == "2 values differ from the case: only 1 value may."
    )


def test_only_values_that_differ_from_the_case_count_as_changes():
    assert changes(scene("judder", {"contact.friction.coefficient": 1.1}), "judder") == 0
    assert changes(scene("judder", {"contact.friction.coefficient": 1.0, "section.height": 0.01}), "judder") == 2
    assert changes(scene("belt", {"connections.0.stiffness": 4.0, "bodies.block.mass": 0.4}), "belt") == 1
    # A shared key counts once, and so does that of a single place.
    assert changes(scene("violin", {"drives.*.x": 0.3}), "violin") == 1
    assert changes(scene("violin", {"drives.0.x": 0.3, "drives.1.x": 0.3}), "violin") == 2
    assert changes(scene("violin", {"drives.*.x": 0.22}), "violin") == 0


def test_notes_are_those_of_the_page(tmp_path):
    frequencies = [*np.exp(np.random.default_rng().uniform(math.log(20.0), math.log(12000.0), 500)), 440.0, 27.5]
    code = 'import { noteOf } from "./note.js"; result = given.map((one) => noteOf(one).name);'
    assert [note_of(one) for one in frequencies] == result_of(tmp_path, code, frequencies)


def test_every_regime_has_the_word_of_the_headline():
    assert set(WORDS) == set(REGIME_COLOURS)
    for regime, word in WORDS.items():
        assert now.words({"regime": regime, "frequency": None, "impact_rate": None}, None) == word
