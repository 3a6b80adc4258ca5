"""Some hundred jumps at random."""

from __future__ import annotations

from collections import Counter

import pytest

from stridula.app.instrument import Instrument

from . import jumps

# A thousand: python -m tests.fuzz --kind jumps --count 50
SEED, ROWS = 7, 8


def test_no_jump_makes_a_stroke_freeze_or_end_for_good():
    counts: Counter[str] = Counter()
    for row in jumps.inputs(SEED, ROWS):
        counts.update(jumps.played(row))
    assert counts["played"] + counts["refused"] == ROWS * jumps.JUMPS
    assert counts["played"] > ROWS * jumps.JUMPS / 2
    assert counts["went on"] > counts["played"] / 2
    assert counts["unbelieved"] <= 2 * counts["beyond belief"] + 1


def test_a_stroke_that_freezes_is_found(monkeypatch):
    play = Instrument.play
    monkeypatch.setattr(Instrument, "play", lambda self, samples: play(self, samples if self.revision < 5 else 0))
    (row,) = jumps.inputs(SEED, 1)
    with pytest.raises(AssertionError, match="0 samples of"):
        jumps.played(row)
