"""The motion that the page names: over long enough times, in the words of cards and maps, and steadily."""

from __future__ import annotations

import numpy as np
import pytest

from stridula.app import now
from stridula.app.instrument import RATE, Instrument
from stridula.app.playable import playable


def found(regime: str, frequency: float | None = None) -> dict:
    return {"regime": regime, "frequency": frequency, "impact_rate": None}


def named(*regimes: str, revisions: tuple[int, ...] | None = None) -> list[str]:
    """Return the regimes named after some were found."""
    headline = now.Headline()
    each = zip(regimes, revisions or [1] * len(regimes), strict=True)
    return [headline.after(found(regime), revision)["regime"] for regime, revision in each]


def test_a_regime_is_named_at_once_and_another_once_it_is_found_twice():
    assert named("squeal") == ["squeal"]
    assert named("squeal", "stick-slip", "squeal", "squeal") == ["squeal"] * 4
    assert named("squeal", "judder", "judder") == ["squeal", "squeal", "judder"]
    # A regime that follows a change is named at once.
    assert named("squeal", "judder", revisions=(1, 2)) == ["squeal", "judder"]


def test_a_regime_is_judged_over_at_least_three_periods_within_ten_seconds():
    headline = now.Headline()
    assert headline.seconds(100.0) == 1.0
    headline.after(found("squeal", 440.0), 1)
    assert headline.seconds(100.0) == 1.0
    headline.after(found("stick-slip", 0.5), 1)
    assert headline.seconds(100.0) == pytest.approx(6.0)
    # Not over a time in which other values played.
    assert headline.seconds(2.0) == 2.0
    assert headline.seconds(0.1) == 1.0
    headline.after(found("stick-slip", 0.1), 1)
    assert headline.seconds(100.0) == 10.0
    headline.after(found("sticking"), 2)
    assert headline.seconds(100.0) == 1.0


def test_a_regime_that_changes_each_second_is_judged_over_longer():
    headline = now.Headline()
    times = []
    for number in range(5):
        headline.after(found(("sticking", "stable sliding")[number % 2]), 1)
        times.append(headline.seconds(100.0))
    assert times == [1.0, 2.0, 4.0, 8.0, 10.0]


def test_starts_of_strokes_are_not_judged_unless_all_are_short():
    headline = now.Headline()
    assert headline.takes(0.3, 1)
    headline.after(found("stable sliding"), 1)
    assert [headline.takes(seconds, 1) for seconds in (0.7, 0.4, 0.2, 1.0, 0.7)] == [False, False, False, True, False]
    assert [headline.takes(0.3, 1) for _ in range(5)] == [False, False, True, True, True]
    # After a change nothing else is known.
    assert headline.takes(0.3, 2)


def test_a_case_that_slides_in_strokes_of_a_second_never_squeals():
    """The vibration of the start of each stroke dies away."""
    instrument, headline = Instrument(playable("stable-sliding", None, {})), now.Headline()
    told, alone = set(), set()
    for _ in range(8):
        for _ in range(100):
            list(instrument.play(RATE // 100))
        last = instrument.last_seconds
        variables, _ = last.moment(headline.seconds(last.steady))
        regime = now.measured(1.0 / RATE, ["contact"], {name: now.said(one) for name, one in variables.items()})
        alone.add(regime["regime"])
        if headline.takes(len(variables["damping_loss"]) / RATE, 0):
            told.add(headline.after(regime, 0)["regime"])
    assert told == {"stable sliding"}
    assert "squeal" in alone


def test_stick_slip_of_some_seconds_is_named_and_stays_named():
    instrument, headline = Instrument(playable("belt", None, {})), now.Headline()
    told = []
    for _ in range(24):
        for _ in range(100):
            list(instrument.play(RATE // 100))
        last = instrument.last_seconds
        variables, _ = last.moment(headline.seconds(last.steady))
        regime = now.measured(1.0 / RATE, ["contact"], {name: now.said(one) for name, one in variables.items()})
        told.append(now.words(headline.after(regime, 0), None))
    assert told[-10:] == [told[-1]] * 10
    assert told[-1].startswith("sticks and slips, once in ")
    assert float(told[-1].split()[-2]) == pytest.approx(3.7, abs=0.1)
    # Judged each second, it would be named differently.
    alone = set()
    for _ in range(4):
        for _ in range(100):
            list(instrument.play(RATE // 100))
        variables, _ = instrument.last_seconds.moment(1.0)
        alone.add(now.measured(1.0 / RATE, ["contact"], {n: now.said(one) for n, one in variables.items()})["regime"])
    assert len(alone) > 1


@pytest.mark.parametrize(
    ("regime", "frequency", "wanted"),
    [
        ("squeal", 718.4, "squeals at 718 Hz"),
        ("squeal", 2290.0, "squeals at 2.29 kHz"),
        ("stick-slip", 195.4, "sticks and slips 195 times a second"),
        ("stick-slip", 0.31, "sticks and slips, once in 3.2 s"),
        ("stick-slip", None, "sticks and slips"),
    ],
)
def test_a_regime_has_the_word_of_the_map_and_of_cards(regime, frequency, wanted):
    assert now.words(found(regime, frequency), None) == wanted


def test_the_time_since_a_change_is_known():
    instrument = Instrument(playable("squeal", None, {}))
    assert instrument.last_seconds.steady == 0.0
    list(instrument.play(4800))
    assert instrument.last_seconds.steady == pytest.approx(0.1)
    instrument.change(playable("squeal", None, {"contact.friction.coefficient": 1.0}), 1)
    list(instrument.play(480))
    assert instrument.last_seconds.steady == pytest.approx(0.01)
    assert np.isfinite(instrument.last_seconds.moment(1.0)[0]["normal_force"]).all()
