"""The tour: every stop shows what its text describes; without a browser."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

import numpy as np
import pytest

from stridula.app import now
from stridula.app.instrument import RATE, Instrument
from stridula.app.parts import Part
from stridula.app.playable import playable
from stridula.app.tour import STOPS, TourStop

SECONDS = 3
SEPARATED, STICKING, SLIDING = range(3)
BY_TITLE = {stop.title: stop for stop in STOPS}


@dataclass
class Seen:
    """Regimes, levels and states of a setting in its first seconds."""

    regimes: list[dict] = field(default_factory=list)
    levels: list[float] = field(default_factory=list)
    sounds: list[np.ndarray] = field(default_factory=list)
    shares: list[np.ndarray] = field(default_factory=list)

    def all(self, name: str) -> list:
        return [one[name] for one in self.regimes]


@cache
def seen(title: str, compared: bool = False) -> Seen:
    stop = BY_TITLE[title]
    instrument = Instrument(playable(stop.case, None, stop.compared if compared else stop.overrides))
    found = Seen()
    for _ in range(SECONDS):
        parts = [one for _ in range(100) for one in instrument.play(RATE // 100)]
        assert all(isinstance(one, Part) for one in parts), "no stroke ends while one reads"
        found.shares.append(np.mean([one.chunk.status_shares.mean(axis=(0, 1)) for one in parts], axis=0))
        variables, pressure = instrument.last_seconds.moment(now.MOMENT)
        told = {name: now.said(values) for name, values in variables.items()}
        found.regimes.append(now.measured(1.0 / RATE, instrument.played.system.contact_names, told))
        found.levels.append(now.level_of(pressure))
        found.sounds.append(pressure)
    return found


def least(title: str, state: int, compared: bool = False) -> float:
    """Return the share of a state in the second in which it is smallest."""
    return min(shares[state] for shares in seen(title, compared).shares)


def test_the_tip_sticks():
    assert seen("Stick").all("regime") == ["sticking"] * SECONDS
    first, *others = [shares[STICKING] for shares in seen("Stick").shares]
    # At first the tip lands.
    assert first > 0.98
    assert others == [1.0] * (SECONDS - 1)


def test_the_tip_slips_and_the_sound_dies_away():
    before, after = (BY_TITLE[title].overrides for title in ("Stick", "Slip"))
    assert before["contact.friction.coefficient"] / 2 == values(BY_TITLE["Slip"])["contact.friction.coefficient"]
    assert after["drives.0.velocity"] > before["drives.0.velocity"]
    assert after["drives.0.normal_load"] < before["drives.0.normal_load"]
    slips = seen("Slip")
    assert slips.all("regime") == ["stable sliding"] * SECONDS
    assert least("Slip", SLIDING) > 0.99
    assert slips.levels == sorted(slips.levels, reverse=True)


def test_the_tip_separates():
    assert seen("Separate").all("regime") == ["judder"] * SECONDS
    assert least("Separate", SEPARATED) > 0.5
    assert values(BY_TITLE["Separate"])["slider.angle"] < 0.0 < values(BY_TITLE["Separate"])["drives.0.velocity"]


def test_it_squeals_near_the_stated_tone():
    held = values(BY_TITLE["Squeal"])
    assert held["contact.friction.coefficient"] == number("Squeal", r"Friction is ([\d.]+)")
    assert math.degrees(held["slider.angle"]) == pytest.approx(number("Squeal", r"by (\d+) degrees"))
    assert held["contact.friction.coefficient"] > 1.0 / math.tan(held["slider.angle"])
    squeals = seen("Squeal")
    assert squeals.all("regime") == ["squeal"] * SECONDS
    assert squeals.all("frequency") == pytest.approx([number("Squeal", r"near (\d+) Hz")] * SECONDS, rel=0.05)
    assert least("Squeal", STICKING) > 0.5
    assert all(share > 0.6 for share in map(stripes, squeals.sounds))
    # A continuous sound has no stripes.
    assert stripes(np.random.default_rng(1).normal(size=RATE)) < 0.3


def test_it_judders_at_the_stated_rate():
    assert values(BY_TITLE["Judder"])["contact.friction.coefficient"] == number("Judder", r"friction of ([\d.]+):")
    assert seen("Judder").all("regime") == ["judder"] * SECONDS
    assert seen("Judder").all("impact_rate") == pytest.approx([number("Judder", r"some (\d+)")] * SECONDS, rel=0.1)


def test_pressure_raises_the_pitch():
    weak, strong = seen("Pressure"), seen("Pressure", compared=True)
    stop = BY_TITLE["Pressure"]
    assert stop.overrides["drives.0.normal_load"] == number("Pressure", r"A presses with (\d+) N")
    assert stop.compared["drives.0.normal_load"] == number("Pressure", r"B presses with (\d+) N")
    assert weak.all("regime") == ["judder"] * SECONDS
    assert all(200.0 < rate < 700.0 for rate in weak.all("impact_rate"))
    assert least("Pressure", SEPARATED) > 0.5
    assert strong.all("regime") == ["squeal"] * SECONDS
    assert min(strong.all("frequency")) > number("Pressure", r"above (\d+) Hz")
    assert least("Pressure", STICKING, compared=True) > 0.9


def test_targets_of_stops_are_on_the_page():
    page = files("stridula.app").joinpath("page", "index.html").read_text(encoding="utf-8")
    assert [stop.title for stop in STOPS] == ["Stick", "Slip", "Separate", "Squeal", "Judder", "Pressure"]
    for stop in STOPS:
        assert f'<canvas id="{stop.look}"' in page
        assert 2 <= len(re.findall(r"[.] ", stop.words + " ")) <= 4


def stripes(sound: np.ndarray) -> float:
    """Return the share of the power above 1 kHz in the loudest fifth of the columns of a spectrogram."""
    columns = np.lib.stride_tricks.sliding_window_view(sound, 1024)[::256] * np.hanning(1024)
    power = (np.abs(np.fft.rfft(columns)[:, 1000 * 1024 // RATE :]) ** 2).sum(axis=1)
    return float(np.sort(power)[-len(power) // 5 :].sum() / power.sum())


def values(stop: TourStop) -> dict:
    return playable(stop.case, None, stop.overrides).turned.values


def number(title: str, pattern: str) -> float:
    """Return a number in the text of a stop."""
    found = re.search(pattern, BY_TITLE[title].words)
    assert found is not None
    return float(found[1])
