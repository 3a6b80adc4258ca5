"""Settings that the demonstration of the home page plays: against limit cycles, new runs, and sums of sines."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest

import stridula as st

from .pages import ROOT

sys.path.insert(0, str(ROOT / "docs"))

from demonstration import instruments, page, recording, tones, writing

RATE = 48e3
REFERENCE = 20e-6
DATA = json.loads(writing.DATA.read_text(encoding="utf-8"))
CASES = {one["name"]: one for one in DATA["instruments"]}


def setting(case, x, y):
    """Return a setting by the values of its axes."""
    values = case["y"]["values"]
    return case["settings"][case["x"]["values"].index(x) * len(values) + values.index(y)]


def pressures(one):
    """Return the amplitudes of the lines of a setting [Pa] by their numbers."""
    return {k: real + 1j * imaginary for k, real, imaginary in one["lines"]}


def displacements(case, one):
    """Return the displacements of the drawn points of a setting [m], (points, 3), by the numbers of its lines."""
    body = case["body"]
    shapes = body["grain"] * np.array(body["shapes"]).reshape(len(body["shapes"]), -1, 3)
    amounts = {k: np.array(parts).reshape(-1, 2) @ [1.0, 1j] for k, *parts in one["motion"]}
    return {k: np.einsum("m,mpi->pi", amount, shapes) for k, amount in amounts.items()}


@pytest.mark.parametrize("periods", [1, 2, 3])
def test_base_and_lines_of_a_random_cycle(periods):
    rng = np.random.default_rng(periods)
    for _ in range(10):
        pitch = rng.uniform(150.0, 3000.0)
        time = np.arange(int(40.0 * periods / pitch * RATE)) / RATE
        given = rng.normal(size=8) + 1j * rng.normal(size=8)
        # Lines off the multiples of the pitch must carry more than `WORTH`.
        given[0] = 4.0 * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi))
        number = np.arange(1, 9)
        signal = (given @ np.exp(2j * np.pi * pitch / periods * np.outer(number, time))).real
        base, share = tones.base_of(signal, RATE, pitch * rng.uniform(0.999, 1.001), 9.0 * pitch / periods)
        # Hann's window of 40 cycles separates lines to some 1e-5.
        assert base == pytest.approx(pitch / periods, rel=1e-5)
        assert share == pytest.approx(1.0, abs=1e-3)
        np.testing.assert_allclose(tones.amplitudes(signal[:, None], RATE, base, 8)[:, 0], given, atol=5e-3)


def test_noise_is_no_cycle():
    noise = np.random.default_rng(1).normal(size=24_000)
    _, share = tones.base_of(noise, RATE, 720.0, 4e3)
    assert share < 0.1


def test_a_repeated_stretch_keeps_power_and_has_no_seam():
    rng = np.random.default_rng(2)
    noise = np.convolve(rng.normal(size=60_000), np.hanning(32), "valid")[:, None]
    stretch = tones.looped(noise, 48_000)
    assert np.var(stretch) == pytest.approx(np.var(noise), rel=0.05)
    # The first sample follows the last one as in the signal.
    assert stretch[0, 0] == noise[48_000, 0]
    np.testing.assert_array_equal(stretch[9_600:], noise[9_600:48_000])
    lines = tones.lines_of(stretch)[:, 0]
    assert 0.5 * np.sum(np.abs(lines) ** 2) == pytest.approx(np.var(stretch), rel=1e-3)


def test_the_settings_are_small_and_complete():
    assert writing.DATA.stat().st_size < 300_000
    assert [one["name"] for one in DATA["instruments"]] == list(instruments.INSTRUMENTS)
    for name, case in CASES.items():
        described = instruments.INSTRUMENTS[name]
        for key, axis in (("x", described.x), ("y", described.y)):
            assert case[key] == {"label": axis.label, "unit": axis.unit, "values": list(axis.values)}
        assert len(case["settings"]) == len(described.x.values) * len(described.y.values)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_what_is_silent_has_no_lines_and_what_sounds_has_its_level(case):
    silent = [one for one in case["settings"] if one["level"] is None]
    assert 0 < len(silent) < len(case["settings"]) or case["name"] == "violin"
    for one in silent:
        assert one["regime"] in recording.SILENT
        assert one["lines"] == one["motion"] == []
    for one in case["settings"]:
        assert one["regime"] in DATA["words"].keys() & DATA["colours"].keys()
        if one not in silent:
            power = 0.5 * sum(abs(line) ** 2 for line in pressures(one).values())
            whole = REFERENCE**2 * 10.0 ** (one["level"] / 10.0)
            # The level has four digits, 0.05 dB beyond 100 dB.
            assert power / whole == pytest.approx(one["share"], rel=0.015)


def test_the_motion_of_the_glass_is_that_of_its_limit_cycle():
    """The rim where it is widest, by Newton's method on a period instead of a run."""
    case, described = CASES["glass"], instruments.GLASS
    x, y = (described.x.values[described.start[0]], described.y.values[described.start[1]])
    one = setting(case, x, y)
    system = described.scenario(x, y).system
    glass = system.bodies[1]
    rim = glass.at((0.0325, 0.0, 0.17))
    cycle = st.limit_cycle(system, probes=[st.Displacement(rim, "x")])
    assert one["pitch"] == pytest.approx(1.0 / float(cycle.period), rel=1e-4)
    found = cycle.displacement.values[:, 0]
    amplitude = 2.0 * np.abs(np.fft.rfft(found)[1]) / found.size
    places = np.array(case["body"]["places"]).reshape(-1, 3) * case["body"]["step"]
    corner = int(np.linalg.norm(places - [0.0325, 0.0, 0.17], axis=1).argmin())
    # `STEADY` allows 1.2 % of a part, `ERROR` of the shapes 2 %, and the number of grains less than 0.1 %.
    assert abs(displacements(case, one)[1][corner, 0]) == pytest.approx(amplitude, rel=0.035)
    # Negative control: another force has another amplitude.
    other = setting(case, x, described.y.values[described.start[1] - 2])
    assert abs(displacements(case, other)[1][corner, 0]) != pytest.approx(amplitude, rel=0.035)


@pytest.mark.parametrize(("x", "y"), [(0.12, 1.1)])
def test_a_new_run_of_the_violin_has_the_lines_that_are_played(x, y):
    one = setting(CASES["violin"], x, y)
    again = recording.record(instruments.VIOLIN, x, y)
    assert (one["regime"], one["repeated"]) == (again.regime, again.repeated)
    assert one["base"] == pytest.approx(again.base, rel=1e-4)
    strongest = max(map(abs, pressures(one).values()))
    for k, line in pressures(one).items():
        # Steady to `STEADY`, 1.2 %, of the whole.
        assert abs(line) == pytest.approx(abs(again.lines[k - 1]), abs=0.012 * strongest)


def test_the_page_has_every_script_and_loads_nothing_from_elsewhere():
    text = page.html()
    for name in page.SCRIPTS:
        script = ROOT / "docs" / "_static" / "demonstration" / f"{name}.js"
        assert f'src="_static/demonstration/{name}.js"' in text
        assert "http" not in script.read_text(encoding="utf-8")
    assert "http" not in text
    assert text.count("</script>") == 1 + len(page.SCRIPTS)
    assert Path(page.FOLDER / "settings.json").read_text(encoding="utf-8") in text


def test_every_file_that_the_first_page_plays_is_there():
    text = (ROOT / "docs" / "index.rst").read_text(encoding="utf-8")
    named = re.findall(r'(?:src|poster)="(_static/[^"]+)"', text)
    assert any(name.endswith(".mp4") for name in named)
    assert [name for name in named if not (ROOT / "docs" / name).exists()] == []
