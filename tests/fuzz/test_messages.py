"""A few hundred random conversations."""

from __future__ import annotations

from collections import Counter

import psutil
import pytest

from . import messages

SEED, COUNT = 7, 300
# Growth of memory allowed after the first of them [bytes].
GROWTH = 60e6


def test_a_session_answers_any_message_and_continues(capfd):
    process, found = psutil.Process(), Counter()
    for number, given in enumerate(messages.inputs(SEED, COUNT)):
        found[messages.check(given)] += 1
        if number == COUNT // 3:
            before = process.memory_info().rss
    assert process.memory_info().rss < before + GROWTH
    # Both outcomes occur, or nothing would be tested.
    assert min(found["accepted"], found["refused"]) > COUNT // 10
    assert capfd.readouterr() == ("", "")


def test_equal_seeds_give_equal_messages():
    assert list(messages.inputs(3, 20)) == list(messages.inputs(3, 20))
    assert list(messages.inputs(3, 20)) != list(messages.inputs(4, 20))


def test_a_session_that_ends_is_found(monkeypatch):
    def ends(text):
        raise RuntimeError("no way")

    monkeypatch.setattr("stridula.app.session.message_of", ends)
    with pytest.raises(AssertionError, match="the session ended"):
        messages.check(['{"type": "restart"}'])
