"""The table of measures at listeners."""

from __future__ import annotations

import numpy as np
import pytest

from stridula.acoustics import level_words, sensation
from stridula.acoustics.level_words import loudest
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
        *(column.head for column in (*level_words.LEVELS, *level_words.SENSATIONS)),
    ]
    cells = [word.strip() for word in first if word.strip()]
    assert cells[0] == "ear at (0.25, 0.25, 0.25) m"
    numbers = [float(cell) for cell in cells[1:]]
    np.testing.assert_allclose(numbers, [60.0, 60.0, 60.0, 4.02, 1.0, 0.0], atol=0.1)
    assert [word.strip() for word in second if word.strip()][1:] == ["-", "-", "-", "0.00", "-", "0.00"]


FEELS = "loudness N5 (at least {}), sharpness (at least {}), roughness (at least {})"


@pytest.mark.parametrize(
    ("lasts", "rate", "last_line"),
    [
        (
            0.1,
            16e3,
            "0.1 s of sound at 16 kHz are too little for LAeq and LAFmax (at least 20 kHz), "
            + FEELS.format("0.25 s and 28.3 kHz", "0.5 s and 28.3 kHz", "0.2 s and 28.3 kHz"),
        ),
        (0.1, 48e3, "0.1 s of sound at 48 kHz are too little for " + FEELS.format("0.25 s", "0.5 s", "0.2 s")),
        (
            0.5,
            16e3,
            "0.5 s of sound at 16 kHz are too little for LAeq and LAFmax (at least 20 kHz), "
            "loudness N5, sharpness and roughness (at least 28.3 kHz)",
        ),
        (
            0.01,
            96e3,
            "0.01 s of sound at 96 kHz are too little for Leq, LAeq and LAFmax (at least 0.05 s), "
            + FEELS.format("0.25 s", "0.5 s", "0.2 s"),
        ),
    ],
)
def test_measures_that_need_a_longer_sound_are_one_line(capsys, lasts, rate, last_line):
    if not sensation.is_available():
        pytest.skip("takes mosqito")
    print_levels(tone(duration=lasts, rate=rate))
    said = [line for line in capsys.readouterr().out.splitlines() if line.strip()]
    assert said[-1] == last_line
    # Before it the head, a rule, the listener and the end of the band.
    assert len(said) == 4 + (rate < 40e3)
    assert ("the levels are of sound up to 8 kHz" in said) is (rate < 40e3)
    for column in (*level_words.LEVELS, *level_words.SENSATIONS):
        assert (column.head in said[0]) is (column.name not in last_line)


@pytest.mark.parametrize("column", [*level_words.LEVELS, *level_words.SENSATIONS], ids=lambda column: column.name)
def test_requirements_in_the_table_are_those_of_the_measures(column):
    if column in level_words.SENSATIONS and not sensation.is_available():
        pytest.skip("takes mosqito")
    rate = column.lowest_rate or 8e3
    assert np.isfinite(column.measure(tone(duration=column.shortest + 1.0 / rate, rate=rate)).values).all()
    with pytest.raises(ValueError, match="must last at least"):
        column.measure(tone(duration=0.95 * column.shortest, rate=rate))
    if column.lowest_rate:
        with pytest.raises(ValueError, match="must be sampled at"):
            column.measure(tone(duration=1.1 * column.shortest, rate=0.95 * rate))


def test_the_louder_ear_is_named_as_far_as_the_sound_is_enough():
    one = tone(level=60.0, duration=0.6)
    both = heard(np.stack([0.1 * one.values, one.values], axis=1))
    assert loudest(both) == "at the louder ear: Leq 60.0 dB, LAeq 60.0 dB, LAFmax 60.0 dB"
    assert loudest(tone(duration=1e-3)) == loudest(0.0 * one) == ""


def test_measures_that_need_a_package_name_it(capsys, monkeypatch):
    monkeypatch.setattr(level_words, "is_available", lambda: False)
    print_levels(tone())
    assert (
        "loudness, sharpness and roughness need mosqito, which is not installed: pip install" in capsys.readouterr().out
    )
