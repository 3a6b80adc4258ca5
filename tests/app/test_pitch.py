"""The pitch of a microphone: of synthetic tones of glasses with noise and hum, and none of noise; without a browser."""

from __future__ import annotations

import numpy as np
import pytest

from .scripting import result_of

SIZE = 8192
MOMENTS = """import { pitchOf } from "./pitch.js";
import { hann, spectrum } from "./spectrum.js";
const window = hann(8192);
result = given.map(([sound, rate]) => pitchOf(spectrum(Float32Array.from(sound), window), rate));"""
AGREED = """import { Agreed } from "./pitch.js";
const agreed = new Agreed();
result = given.map((one) => agreed.after(one));"""
WHITE = """import { spectrum, transformed } from "./spectrum.js";
const [re, im] = given.map((one) => Float64Array.from(one));
transformed(re, im);
result = [[...re], [...im], [...spectrum(Float32Array.from(given[0]), new Float32Array(given[0].length).fill(1))]];"""


def rubbed(dice: np.random.Generator, frequency: float) -> list[tuple[float, float]]:
    """Return frequencies and amplitudes of harmonics, none stronger than the first."""
    return [(n * frequency, 1.0 if n == 1 else 10.0 ** -dice.uniform(0.0, 1.0)) for n in range(1, 6)]


def tapped(dice: np.random.Generator, frequency: float) -> list[tuple[float, float]]:
    """Return partials of a bowl, whose modes of two, three and four waves are near 1 : 2.3 : 4.3."""
    return [(frequency, 1.0), (dice.uniform(2.2, 2.5) * frequency, 0.5), (dice.uniform(4.0, 4.6) * frequency, 0.2)]


def faint(dice: np.random.Generator, frequency: float) -> list[tuple[float, float]]:
    """Return harmonics of a string whose body hardly radiates the first."""
    return [(n * frequency, 0.001 if n == 1 else dice.uniform(0.5, 1.0)) for n in range(1, 10)]


def sound(dice, partials, rate, ratio, hum=0.3, swell=0.0):
    """Return a moment with noise of a ratio [dB], hum of the mains, and a swell of some hertz."""
    time = np.arange(SIZE) / rate
    tones = [a * np.sin(2.0 * np.pi * f * time + dice.uniform(0, 6.28)) for f, a in partials if f < rate / 2]
    tone = np.sum(tones, axis=0) * (1.0 + swell * np.sin(2.0 * np.pi * dice.uniform(0.5, 4.0) * time))
    power = np.mean(tone**2)
    noise = dice.normal(size=SIZE) * np.sqrt(power / 10.0 ** (ratio / 10.0))
    heard = tone + noise + hum * np.sqrt(power) * np.sin(2.0 * np.pi * 50.0 * time)
    return [float(one) for one in 0.01 * heard]


@pytest.mark.parametrize("kind", [rubbed, tapped, faint])
@pytest.mark.parametrize("rate", [44100, 48000])
def test_tones_of_glasses_are_found_in_noise(tmp_path, kind, rate):
    dice = np.random.default_rng()
    ends = (200.0, 900.0) if kind is faint else (150.0, 3000.0)
    frequencies = np.exp(dice.uniform(*np.log(ends), size=60))
    given = [[sound(dice, kind(dice, one), rate, dice.uniform(6.0, 30.0), swell=0.5), rate] for one in frequencies]
    found = result_of(tmp_path, MOMENTS, given)
    assert None not in found
    cents = 1200.0 * np.log2(np.array(found) / frequencies)
    # A swell within a moment moves the maximum by a part of a sample of the spectrum, 6 Hz.
    allowed = np.maximum(6.0, 1200.0 * np.log2(1.0 + 0.1 * rate / SIZE / frequencies))
    assert (np.abs(cents) < allowed).all(), (frequencies, cents)


def test_noise_hum_and_silence_have_no_pitch(tmp_path):
    dice = np.random.default_rng()
    noises = [dice.normal(size=SIZE) * 0.05 for _ in range(100)]
    # A fan: noise with more power at low frequencies.
    noises += [np.cumsum(dice.normal(size=SIZE)) * 0.01 for _ in range(100)]
    noises += [np.sin(2.0 * np.pi * 50.0 * np.arange(SIZE) / 48000.0) + 0.001 * dice.normal(size=SIZE), np.zeros(SIZE)]
    given = [[[float(value) for value in one], 48000] for one in noises]
    assert result_of(tmp_path, MOMENTS, given) == [None] * len(given)


def test_a_pitch_needs_moments_that_agree(tmp_path):
    given = [440.0, 441.0, 439.0, 700.0, 440.5, None, None, None, 300.0, 440.0]
    found = result_of(tmp_path, AGREED, given)
    assert found[:2] == [None, None]
    assert found[2] == 440.0
    # One moment that is off does not count.
    assert found[3] == 441.0
    assert found[4] == 440.5
    assert found[7:] == [None] * 3


def test_the_transform_is_that_of_numpy(tmp_path):
    dice = np.random.default_rng()
    re, im = dice.normal(size=(2, 256))
    found = result_of(tmp_path, WHITE, [re.tolist(), im.tolist()])
    wanted = np.fft.fft(re + 1j * im)
    np.testing.assert_allclose(np.array(found[0]) + 1j * np.array(found[1]), wanted, atol=1e-10)
    powers = np.abs(np.fft.fft(re - re.mean())[:128]) ** 2
    np.testing.assert_allclose(found[2], powers, rtol=1e-3, atol=1e-3 * powers.max())
