"""An instrument returns to a moment that was played and continues from there; without a browser."""

from __future__ import annotations

import numpy as np
import pytest

from stridula.app.instrument import RATE, Instrument
from stridula.app.parts import Part
from stridula.app.playable import playable
from stridula.app.session import ANEW

from .conversation import Conversation, conversation, parts_of

PART = 480
FRICTION = "contact.friction.coefficient"
SOURCES = [("squeal", "pressure"), ("squeal", "acceleration"), ("judder", "friction"), ("squeal-on-plate", "pressure"),
           ("violin", "probe 1"), ("pin-on-disc", "force")]  # fmt: skip


def played(instrument: Instrument, parts: int) -> np.ndarray:
    """Play parts of 10 ms and return their sound, shape (samples,)."""
    found = [one for _ in range(parts) for one in instrument.play(PART)]
    return np.concatenate([one.sound for one in found if isinstance(one, Part)])


@pytest.mark.parametrize(("case", "source"), SOURCES)
@pytest.mark.parametrize("more", [0, 99, 476])
def test_a_change_takes_place_where_the_page_wants_it(case, source, more):
    """The sound is, to the last bit, that of an instrument that has not played any further.

    Pressures round otherwise if they are computed from parts of other lengths.
    """
    same, end = playable(case, None, {}), -(-(6 * PART + more) // 4) * 4
    ahead, other = (Instrument(same, source) for _ in range(2))
    assert ahead.name == source
    before = played(ahead, 12)
    assert np.array_equal(before[: 6 * PART], played(other, 6))
    assert all(len(one.sound) == end - 6 * PART for one in other.play(end - 6 * PART))
    ahead.change(same, 1, kept=6 * PART + more)
    other.change(same, 1)
    assert (ahead.played_samples, ahead.given_samples) == (end, 6 * PART)
    # The part in which the change takes place is given again up to there.
    again = played(ahead, 6)
    np.testing.assert_allclose(again[: end - 6 * PART], before[6 * PART : end], 0.0, 1e-14 * np.abs(before).max())
    np.testing.assert_array_equal(again[end - 6 * PART :], played(other, 6))
    assert ahead.given_samples == ahead.played_samples


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
        instrument.change(playable("squeal", None, {FRICTION: 0.5}), 1, PART + 100)
    np.testing.assert_array_equal(played(instrument, 3), played(other, 3))
    assert clocks(instrument) == [PART * k for k in range(1, 12)]


def test_a_change_that_cannot_be_drawn_leaves_the_instrument_where_it_was(monkeypatch):
    instrument, other = (Instrument(playable("squeal", None, {})) for _ in range(2))
    played(instrument, 8)
    played(other, 8)

    def refused(system):
        raise ValueError("not drawn")

    with monkeypatch.context() as patch:
        patch.setattr("stridula.app.instrument.drawing_of", refused)
        with pytest.raises(ValueError, match="not drawn"):
            instrument.change(playable("squeal", None, {FRICTION: 0.5}), 1, PART + 100)
    assert (instrument.revision, instrument.stroke, instrument.given_samples) == (0, 1, 8 * PART)
    np.testing.assert_array_equal(played(instrument, 3), played(other, 3))
    assert clocks(instrument) == [PART * k for k in range(1, 12)]


def test_a_stroke_and_a_source_begin_where_the_page_wants_them():
    instrument = Instrument(playable("squeal", None, {}))
    first = played(instrument, 8)
    instrument.restart(3 * PART)
    assert (instrument.played_samples, instrument.stroke) == (3 * PART, 2)
    again = played(instrument, 5)
    # After the transition of some milliseconds.
    late = slice(3 * PART, 5 * PART)
    np.testing.assert_allclose(again[late], first[late], rtol=0.0, atol=1e-3 * np.abs(first).max())
    instrument.listen_to("force", 5 * PART)
    assert instrument.played_samples == 5 * PART


def clocks(instrument: Instrument) -> list[int]:
    """Return the samples played at the end of each part that is kept."""
    parts = instrument.last_seconds._parts
    assert instrument.last_seconds._samples == sum(len(part.sound) for part in parts)
    return [round(part.clock * RATE) for part in parts]


def test_a_record_has_each_moment_once():
    instrument = Instrument(playable("squeal", None, {}))
    played(instrument, 10)
    instrument.change(playable("squeal", None, {FRICTION: 0.5}), 1, 4 * PART + 80)
    played(instrument, 3)
    assert clocks(instrument) == [*(PART * k for k in range(1, 5)), *(PART * k + 80 for k in range(4, 8))]
    assert [clock for clock, _ in instrument.last_seconds._changes] == [0.0, (4 * PART + 80) / RATE]


def test_losses_continue_from_where_the_instrument_returned_to():
    """Nothing that was played after the moment counts, as if it had never been played."""
    ahead, other = (Instrument(playable("squeal", None, {})) for _ in range(2))
    played(ahead, 10)
    played(other, 4)
    ahead.listen_to("force", 4 * PART)
    other.listen_to("force")
    for _ in range(2):
        played(ahead, 3)
        played(other, 3)
        losses = [np.concatenate([one.losses for one in each.last_seconds._parts], axis=1) for each in (ahead, other)]
        np.testing.assert_array_equal(*losses)
        for each in (ahead, other):
            each.change(playable("squeal", None, {FRICTION: 0.5}), 1)


def test_the_page_is_told_from_where_on_its_sound_changes(own):
    with conversation(own) as page:
        page.scene("squeal")
        page.play(10 * PART)
        page.say("scene", revision=7, case="squeal", overrides={FRICTION: 0.5}, kept=4 * PART)
        told = page.until("anew", "scene")
        assert told["type"] == "anew"
        # At the end of a part, later by the time that the server needs to read it.
        assert 4 * PART <= told["samples"] < 10 * PART
        assert told["samples"] % PART == 0
        assert page.until("scene")["revision"] == 7
        assert given_again(page, told["samples"]) < PART
        # In a later part, which comes again up to the change.
        for message in ({"type": "restart"}, {"type": "listen", "source": "force"}):
            end = round(page.play(PART).parts[-1].clock * RATE)
            told = page.asks(message.pop("type"), "anew", kept=end - 80, **message)
            assert told["samples"] == end - PART
            assert given_again(page, end - PART) == PART - 80


def given_again(page: Conversation, begin: int) -> int:
    """Check that parts come without a request, and return the number of samples given again before the change."""
    messages = [parts_of(page.bytes()) for _ in ANEW]
    lengths = [len(part.sound) for parts in messages for part in parts]
    again = lengths[0] if len(messages[0]) > ANEW[0] else 0
    assert lengths[bool(again) :] == [PART] * sum(ANEW)
    assert [len(parts) for parts in messages] == [ANEW[0] + bool(again), *ANEW[1:]]
    ends = [round(part.clock * RATE) for parts in messages for part in parts]
    assert ends == (begin + np.cumsum(lengths)).tolist()
    return again
