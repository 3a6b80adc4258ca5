"""No change on the page ends the stroke for good; without a browser and without a server."""

from __future__ import annotations

from copy import deepcopy
from functools import cache
from itertools import permutations

import pytest

from stridula.app.controls import CONTROLS, values
from stridula.app.instrument import RATE, TRUST, Instrument
from stridula.app.parts import Part, Stop
from stridula.app.playable import PRESETS, playable

AT = "contact.at"
MOMENTS = (3, 7, 22, 31)
SHARES = (0.0, 0.03, 0.1, 0.25, 0.4, 0.6, 0.75, 0.9, 1.0)
UNBELIEVED = {"energy created", "not finite", "contact unsolved"}


def after(case: str, hundredths: int, repeats: bool = True) -> Instrument:
    """Return an instrument that has played a case for a number of hundredths of a second."""
    found = deepcopy(_after(case, hundredths))
    found.repeats = repeats
    return found


@cache
def _after(case: str, hundredths: int) -> Instrument:
    found = Instrument(playable(case, None, {}))
    played(found, hundredths)
    assert found.stroke == 1
    return found


def played(instrument: Instrument, hundredths: int) -> tuple[list[Part], list[str]]:
    """Continue and return the parts, and the reasons why strokes ended."""
    came = [one for _ in range(hundredths) for one in instrument.play(RATE // 100)]
    return [one for one in came if isinstance(one, Part)], [one.why for one in came if isinstance(one, Stop)]


def samples(parts: list[Part]) -> int:
    return sum(len(part.sound) for part in parts)


@pytest.mark.parametrize(("before", "now"), list(permutations(PRESETS, 2)), ids=str)
def test_another_case_begins_a_stroke_at_any_moment(before, now):
    for moment in MOMENTS:
        instrument = after(before, moment)
        stroke = instrument.stroke
        assert not instrument.change(playable(now, None, {}), 1)
        parts, ended = played(instrument, 10)
        assert samples(parts) == RATE // 10
        assert not UNBELIEVED & set(ended)
        assert parts[0].stroke == stroke + 1
        assert parts[0].chunk.time[0] == pytest.approx(1 / RATE)


@pytest.mark.parametrize("case", PRESETS)
def test_no_change_of_a_control_makes_a_faulty_stroke(case):
    held = values(playable(case, None, {}).tables)
    jumps = 0
    for control in CONTROLS:
        for number, share in enumerate(SHARES) if control.key in held else ():
            instrument = after(case, (5, 31)[number % 2])
            value = (control.low + share * (control.high - control.low)) * control.scale
            try:
                instrument.change(playable(case, None, {control.key: value}), 1)
            except ValueError:
                continue
            parts, ended = played(instrument, 10)
            assert samples(parts) == RATE // 10, (control.key, value)
            assert not UNBELIEVED & set(ended), (control.key, value)
            jumps += 1
    assert jumps > 50


@pytest.mark.parametrize("case", PRESETS)
def test_a_moved_contact_continues_at_its_new_place(case):
    instrument = after(case, 31)
    here = float(played(instrument, 1)[0][-1].chunk.contact["contact_position"][-1])
    at = instrument.live.system.contacts[0].at
    assert instrument.change(playable(case, None, {AT: at / 2}), 1)
    parts, _ = played(instrument, 1)
    assert parts[0].stroke == 1
    assert parts[0].chunk.contact["contact_position"][0] == pytest.approx(here - at / 2, abs=1e-3)


def broken(instrument: Instrument) -> Instrument:
    """Return an instrument whose march creates energy."""
    instrument.live.now.belief.initial_energy += 1.0
    return instrument


def test_a_faulty_stroke_is_followed_by_another():
    instrument = broken(after("squeal", 5))
    parts, ended = played(instrument, 10)
    assert ended == ["energy created"]
    assert samples(parts) == RATE // 10
    assert not instrument.ended


def test_strokes_that_end_at_once_do_not_restart_for_ever(monkeypatch):
    instrument = broken(after("squeal", 5))
    restart = instrument.live.restart
    monkeypatch.setattr(instrument.live, "restart", lambda: (restart(), broken(instrument)))
    _, ended = played(instrument, round(200 * TRUST))
    assert ended == ["energy created"] * 2
    assert instrument.ended


def test_a_tip_at_the_end_of_the_track_does_not_restart_for_ever():
    length = playable("stable-sliding", None, {}).system.track.length
    instrument = Instrument(playable("stable-sliding", None, {AT: length * (1.0 - 1e-13)}))
    parts, ended = played(instrument, 2)
    assert parts == []
    assert set(ended) == {"off the track"}
    assert instrument.ended


@pytest.mark.parametrize(
    "begin",
    [
        lambda one: one.restart(),
        lambda one: one.repeat(True),
        lambda one: one.change(playable("squeal", None, {AT: 0.4}), 1),
        lambda one: one.change(playable("judder", None, {}), 1),
    ],
    ids=["new stroke", "stroke again", "a change", "another case"],
)
def test_an_ended_stroke_restarts(begin):
    instrument = broken(after("squeal", 5, repeats=False))
    assert played(instrument, 1) == ([], ["energy created"])
    assert played(instrument, 1) == ([], [])
    assert not begin(instrument)
    parts, ended = played(instrument, 10)
    assert samples(parts) == RATE // 10
    assert parts[0].stroke == 2
    assert not UNBELIEVED & set(ended)


def test_a_tip_at_rest_restarts_when_repetition_is_turned_on():
    at_rest = {"drives.0.transverse": 0.5, "contact.friction.coefficient": 2.0, "damping": 0.1}
    instrument = Instrument(playable("stable-sliding", None, at_rest))
    instrument.repeats = False
    assert played(instrument, 100)[1] == []
    instrument.repeat(True)
    assert played(instrument, 60)[1] == ["at rest"]
