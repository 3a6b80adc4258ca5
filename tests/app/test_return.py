"""An instrument returns to a moment that was played and continues from there; without a browser."""

from __future__ import annotations

import numpy as np
import pytest

from stridula.app.instrument import RATE, Instrument
from stridula.app.parts import Part
from stridula.app.playable import playable

from .conversation import conversation

PART = 480
FRICTION = "contact.friction.coefficient"
SOURCES = [("squeal", "pressure"), ("squeal", "acceleration"), ("judder", "friction"), ("squeal-on-plate", "pressure"),
           ("violin", "probe 1"), ("pin-on-disc", "force")]  # fmt: skip


def played(instrument: Instrument, parts: int) -> np.ndarray:
    """Play parts of 10 ms and return their sound, shape (parts, samples)."""
    found = [one for _ in range(parts) for one in instrument.play(PART)]
    return np.array([one.sound for one in found if isinstance(one, Part)])


@pytest.mark.parametrize(("case", "source"), SOURCES)
def test_a_change_takes_place_where_the_page_wants_it(case, source):
    """The sound is, to the last bit, that of an instrument that has not played any further."""
    same = playable(case, None, {})
    ahead, other = (Instrument(same, source) for _ in range(2))
    assert ahead.name == source
    np.testing.assert_array_equal(played(ahead, 12)[:7], played(other, 7))
    ahead.change(same, 1, kept=6 * PART + 1)
    other.change(same, 1)
    assert ahead.played_samples == 7 * PART
    np.testing.assert_array_equal(played(ahead, 6), played(other, 6))


def test_sound_that_must_stay_stays():
    instrument = Instrument(playable("squeal", None, {}))
    played(instrument, 5)
    for kept in (None, 5 * PART, 9 * PART):
        instrument.change(playable("squeal", None, {FRICTION: 0.9}), 1, kept)
        assert instrument.played_samples == 5 * PART
    # Not to before an earlier change.
    instrument.change(playable("squeal", None, {FRICTION: 1.2}), 2, 0)
    assert instrument.played_samples == 5 * PART


def test_a_refused_change_leaves_the_instrument_where_it_was(monkeypatch):
    instrument, other = (Instrument(playable("squeal", None, {})) for _ in range(2))
    played(instrument, 8)
    played(other, 8)

    def refused(*words):
        raise ValueError("refused")

    monkeypatch.setattr(instrument.live, "change", refused)
    with pytest.raises(ValueError, match="refused"):
        instrument.change(playable("squeal", None, {FRICTION: 0.5}), 1, PART)
    np.testing.assert_array_equal(played(instrument, 3), played(other, 3))


def test_a_stroke_and_a_source_begin_where_the_page_wants_them():
    instrument = Instrument(playable("squeal", None, {}))
    first = played(instrument, 8)
    instrument.restart(3 * PART)
    assert (instrument.played_samples, instrument.stroke) == (3 * PART, 2)
    again = played(instrument, 5)
    # After the transition of some milliseconds.
    np.testing.assert_allclose(again[3:], first[3:5], rtol=0.0, atol=1e-3 * np.abs(first).max())
    instrument.listen_to("force", 5 * PART)
    assert instrument.played_samples == 5 * PART


def test_a_record_has_each_moment_once():
    instrument = Instrument(playable("squeal", None, {}))
    played(instrument, 10)
    instrument.change(playable("squeal", None, {FRICTION: 0.5}), 1, 4 * PART)
    played(instrument, 3)
    kept = instrument.last_seconds
    clocks = [round(part.clock * RATE) for part in kept._parts]
    assert clocks == [PART * k for k in range(1, 8)]
    assert kept._samples == 7 * PART
    assert [clock for clock, _ in kept._changes] == [0.0, 4 * PART / RATE]


def test_the_page_is_told_from_where_on_its_sound_changes(own):
    with conversation(own) as page:
        page.scene("squeal")
        page.play(10 * PART)
        page.say("scene", revision=7, case="squeal", overrides={FRICTION: 0.5}, kept=4 * PART)
        told = page.until("anew", "scene")
        assert told["type"] == "anew"
        assert 4 * PART <= told["samples"] < 10 * PART
        assert page.until("scene")["revision"] == 7
        (part,) = page.play(PART).parts
        assert round(part.clock * RATE) == told["samples"] + PART
        for message in ({"type": "restart"}, {"type": "listen", "source": "force"}):
            page.asks(message.pop("type"), "anew", kept=told["samples"], **message)
            (part,) = page.play(PART).parts
            assert round(part.clock * RATE) == told["samples"] + PART
