"""The table of what listeners hear."""

from __future__ import annotations

import numpy as np
import pytest

from stridula.acoustics import sensation
from stridula.cli import hearing
from stridula.cli.hearing import print_levels

from .sounds import heard, tone


def test_every_measure_of_every_listener(capsys):
    if not sensation.is_available():
        pytest.skip("takes mosqito")
    one = tone(level=60.0, duration=0.6).values
    places = {axis: ("listener", [0.25, 1.0]) for axis in "xyz"}
    print_levels(heard(np.stack([one, 0.0 * one], axis=1)).assign_coords(places | {"listener": ["ear", "wall"]}))
    head, _, first, second = (line.split("  ") for line in capsys.readouterr().out.strip().splitlines())
    assert [word.strip() for word in head if word.strip()] == [
        "listener",
        *(f"{word}" for word, _, _ in (*hearing.LEVELS, *hearing.SENSATIONS)),
    ]
    cells = [word.strip() for word in first if word.strip()]
    assert cells[0] == "ear at (0.25, 0.25, 0.25) m"
    numbers = [float(cell) for cell in cells[1:]]
    np.testing.assert_allclose(numbers, [60.0, 60.0, 60.0, 4.02, 1.0, 0.0], atol=0.1)
    assert [word.strip() for word in second if word.strip()][1:] == ["-", "-", "-", "0.00", "-", "0.00"]


def test_what_cannot_be_said_is_explained(capsys, monkeypatch):
    print_levels(tone(duration=0.1, rate=20e3))
    out = capsys.readouterr().out
    assert "no LAeq: pressure must be sampled at 40000 Hz or more for A-weighting, got 20000 Hz" in out
    assert "Leq [dB]" in out
    monkeypatch.setattr(hearing, "is_available", lambda: False)
    print_levels(tone())
    assert "they take mosqito (pip install stridula[psycho])" in capsys.readouterr().out
