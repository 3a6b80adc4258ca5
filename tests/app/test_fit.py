"""The wall of a glass that sings at a wanted pitch: found by linear theory, and true when played."""

from __future__ import annotations

import math

import numpy as np
import pytest

from stridula.app.fit import CLOSE, THICKEST, THINNEST, _searched, fitted, walls_of
from stridula.app.instrument import RATE, Instrument
from stridula.app.playable import CASES, playable
from stridula.checks import ArgumentError


def sung(overrides: dict, seconds: float) -> float:
    """Return the strongest frequency of the wall of a glass in the second half of a time [Hz], by its spectrum."""
    instrument = Instrument(playable("glass", None, overrides), "probe 1")
    parts = [one.sound for _ in range(round(100 * seconds)) for one in instrument.play(RATE // 100)]
    sound = np.concatenate(parts)[-RATE:]
    power = np.abs(np.fft.rfft(sound * np.hanning(RATE)))
    return float(np.argmax(power))


@pytest.mark.parametrize("frequency", [523.25, 784.0])
def test_a_glass_is_fitted_to_a_note_and_sings_it(frequency):
    found = fitted(playable("glass", None, {}).tables, frequency, 717.6 / 713.9)
    assert found["words"].endswith("Hz.")
    assert sung(found["overrides"], 3.0) == pytest.approx(frequency, rel=0.01)
    walls = walls_of(playable("glass", None, {}).tables)
    factors = {round(found["overrides"][key] / one, 4) for key, one in walls.items()}
    # All of the wall is scaled by one factor.
    assert max(factors) - min(factors) < 2e-4
    assert (max(factors) > 1.0) == (frequency > 717.6)
    # The force only becomes smaller, so that the finger stays on the glass.
    assert -1.0 <= found["overrides"].get("drives.0.z", -1.0) < 0.0


@pytest.mark.parametrize("frequency", [200.0, 2000.0])
def test_a_pitch_out_of_reach_is_refused_in_a_sentence(frequency):
    found = fitted(playable("glass", None, {}).tables, frequency)
    assert found["overrides"] == {}
    assert found["words"].startswith("pitch must be")
    assert "\n" not in found["words"]


def test_only_the_glass_has_a_wall():
    assert [case for case in CASES if walls_of(playable(case, None, {}).tables)] == ["glass"]
    tables = playable("glass", None, {}).tables
    # The stem is solid below 76 mm.
    assert len(walls_of(tables)) == len(tables["bodies"]["glass"]["profile"]["thickness"]) - 2


def test_the_search_finds_the_factor_of_any_monotonic_pitch():
    dice = np.random.default_rng()
    for _ in range(100):
        power, bend = dice.uniform(0.5, 1.5), dice.uniform(-0.3, 0.3)

        def pitch(factor: float, power: float = power, bend: float = bend) -> float:
            return 700.0 * factor**power * math.exp(bend * math.log(factor) ** 2)

        wanted = dice.uniform(THINNEST * 1.01, THICKEST * 0.99)
        factor, reached = _searched(lambda one, pitch=pitch: [(pitch(one), 1.0), (5000.0, 0.5)], pitch(wanted))
        assert reached == pytest.approx(pitch(wanted), rel=1.1 * CLOSE)
        assert pitch(factor) == pytest.approx(reached)


def test_a_search_that_meets_another_mode_is_refused():
    def growing(factor: float) -> list[tuple[float, float]]:
        own, other = (700.0 * factor, 10.0 / factor), (300.0, 9.0)
        return sorted([own, other], key=lambda one: -one[1])

    assert _searched(growing, 600.0)[0] == pytest.approx(600.0 / 700.0, rel=CLOSE)
    with pytest.raises(ArgumentError, match="grows fastest"):
        _searched(growing, 1000.0)
    with pytest.raises(ArgumentError, match="does not sing"):
        _searched(lambda factor: [], 600.0)


def test_the_page_names_the_pitch_of_the_fit(talk):
    """Over the socket, with an answer for the glass and a refusal for two beams."""
    talk.scene("squeal")
    assert "glass" in talk.asks("fit", "problem", revision=talk.revision, frequency=440.0)["problems"][0]
    assert talk.scene("glass")["fits"]
    answer = talk.asks("fit", "fit", revision=talk.revision, frequency=2000.0)
    assert answer["overrides"] == {}
    assert answer["words"].startswith("pitch must be")
