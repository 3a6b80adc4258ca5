"""The strongest tone that the page names."""

from __future__ import annotations

import numpy as np
import pytest

from .conversation import RATE
from .scripting import result_of

SIZE = 1 << 14
BIN = RATE / SIZE
TIME = np.arange(SIZE) / RATE
TONE = """import { strongestTone } from "./spectrum.js";
result = given.map((signal) => strongestTone(Float32Array.from(signal), 48000));"""


def tones(folder, *signals: np.ndarray) -> list[float | None]:
    return result_of(folder, TONE, [signal.tolist() for signal in signals])


def sine(frequency: float, phase: float = 0.3) -> np.ndarray:
    return np.sin(2.0 * np.pi * frequency * TIME + phase)


@pytest.mark.parametrize("beside", [0.0, 5.0, 5.0 - 4.0 * TIME], ids=["alone", "on a weight", "on a slope"])
def test_a_tone_is_found_wherever_it_lies(tmp_path, beside):
    wanted = [23.0, 46.0, 93.7, 375.4, 2950.2, 11_990.0, 20_000.3]
    found = tones(tmp_path, *[sine(frequency) + beside for frequency in wanted])
    assert found == pytest.approx(wanted, abs=0.1 * BIN)


def test_the_stronger_of_two_tones_is_named(tmp_path):
    one, other = sine(433.0), sine(2950.0)
    assert tones(tmp_path, one + 0.8 * other, 0.8 * one + other) == pytest.approx([433.0, 2950.0], abs=0.1 * BIN)


def test_no_tone_lies_outside_the_audible_range(tmp_path):
    random = np.random.default_rng(7)
    slow = [np.cumsum(random.normal(size=SIZE)) for _ in range(20)]
    jumps = [np.where(place < TIME, 1.0, 0.0) for place in (0.01, 0.1, 0.17, 0.33)]
    decays = [np.exp(-rate * TIME) for rate in (0.1, 3.0, 100.0, 5000.0)]
    swings = [sine(frequency) for frequency in (0.5, 3.0, 9.0)]
    for tone in tones(tmp_path, *slow, *jumps, *decays, *swings):
        assert tone is None or 20.0 - BIN / 2.0 <= tone <= RATE / 2.0


def test_silence_has_no_tone(tmp_path):
    steady = np.full(SIZE, 3.7)
    assert tones(tmp_path, 0.0 * TIME, steady, steady + 1e-7 * sine(500.0)) == [None, None, None]
    # A faint signal alone has a tone.
    assert tones(tmp_path, 1e-7 * sine(500.0)) == pytest.approx([500.0], abs=0.1 * BIN)
