"""Some hundred random changes of controls."""

from __future__ import annotations

from collections import Counter

import pytest

from stridula.app.instrument import Instrument

from . import controls

# A thousand: python -m tests.fuzz --kind controls --count 50
SEED, ROWS = 7, 8


def test_no_change_makes_a_stroke_freeze_or_end_for_good():
    counts: Counter[str] = Counter()
    for row in controls.inputs(SEED, ROWS):
        counts.update(controls.played(row))
    assert counts["played"] + counts["refused"] == ROWS * controls.CHANGES
    assert counts["played"] > ROWS * controls.CHANGES / 2
    assert counts["went on"] > counts["played"] / 2
    assert counts["faulty"] <= 2 * counts["ends at once"] + 1


def test_a_stroke_that_freezes_is_found(monkeypatch):
    play = Instrument.play
    monkeypatch.setattr(Instrument, "play", lambda self, samples: play(self, samples if self.revision < 5 else 0))
    (row,) = controls.inputs(SEED, 1)
    with pytest.raises(AssertionError, match="0 samples of"):
        controls.played(row)
