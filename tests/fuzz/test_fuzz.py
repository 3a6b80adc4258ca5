"""A few hundred deliberately wrong inputs of each kind; `python -m tests.fuzz` runs many, with limits."""

from __future__ import annotations

import os
from functools import cache

import pytest

from . import __main__ as runner
from .outcomes import ACCEPTED, REFUSED

# Numbers that take some seconds; other kinds have FEW.
SEED, COUNTS, FEW = 0, {"scenarios": 200, "matrices": 400, "records": 100, "calls": 150, "controls": 40}, 100
PARTS = 10
KINDS = runner.modules()


@cache
def drawn(name):
    """Inputs of a kind, drawn for all parts at once."""
    return list(enumerate(KINDS[name].inputs(SEED, COUNTS.get(name, FEW))))


@pytest.mark.parametrize("part", range(PARTS))
@pytest.mark.parametrize("name", list(KINDS))
def test_wrong_inputs_are_refused_in_one_line(name, part):
    for number, given in drawn(name)[part::PARTS]:
        try:
            assert KINDS[name].check(given) in (ACCEPTED, REFUSED)
        except BaseException as error:
            error.add_note(f"python -m tests.fuzz --kind {name} --seed {SEED} --number {number}")
            raise


@pytest.mark.parametrize("name", list(KINDS))
def test_inputs_are_repeatable(name):
    first, again = (list(map(repr, KINDS[name].inputs(3, 5))) for _ in range(2))
    assert first == again != list(map(repr, KINDS[name].inputs(4, 5)))
    assert first == list(map(repr, KINDS[name].inputs(3, 9)))[:5]


class Wrong:
    """Inputs that fail in different ways."""

    @staticmethod
    def inputs(seed, count):
        return iter(("accepted", "refused", "traceback", "crashed", "hung"))

    @staticmethod
    def check(given):
        if given == "traceback":
            raise KeyError(given)
        if given == "crashed":
            os.abort()
        while given == "hung":
            pass
        return given


def test_failures_are_counted_and_reported(monkeypatch, capsys):
    monkeypatch.setattr(runner, "LIMIT", 0.5)
    counts, peak = runner.counted("wrong", Wrong, 7, 5, 2)
    assert counts == {"accepted": 1, "refused": 1, "traceback": 1, "crashed": 1, "hung": 1}
    assert 2**20 < peak < 2**33
    told = capsys.readouterr().out
    assert "wrong traceback: --kind wrong --seed 7 --number 2: 'traceback'" in told
    assert "KeyError: 'traceback'" in told
    assert "wrong crashed: --kind wrong --seed 7 --number 3: 'crashed'" in told
    assert "wrong hung: --kind wrong --seed 7 --number 4: 'hung'" in told
