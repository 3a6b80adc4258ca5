"""Sliders of the page reach no value that is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest

from stridula.app.bounds import bounds_of
from stridula.app.held import held
from stridula.app.instrument import RATE, Instrument
from stridula.app.messages import Scene
from stridula.app.playable import PRESETS, SYSTEMS, playable

from .scripting import result_of

ENDS = """import { Controls } from "./controls.js";
const controls = Object.assign(Object.create(Controls.prototype), { bounds: given.bounds });
result = given.controls.map((one) => controls.ends(one));"""


def ends(folder, case: str, overrides: dict[str, float]) -> dict[str, tuple[float, float]]:
    """Return the ends of the sliders that the page shows, in SI, by key."""
    played = playable(case, None, overrides)
    shown = [one for one in played.turned.controls if one.key in played.turned.values]
    found = result_of(folder, ENDS, {"bounds": bounds_of(played), "controls": [vars(one) for one in shown]})
    pairs = zip(shown, found, strict=True)
    return {one.key: (round(low * one.scale, 12), round(high * one.scale, 12)) for one, (low, high) in pairs}


@pytest.mark.parametrize("case", [*PRESETS, *SYSTEMS])
def test_every_end_of_a_slider_is_playable(tmp_path, case):
    for key, values in ends(tmp_path, case, {}).items():
        for value in values:
            playable(case, None, {key: value})


def test_sliders_follow_the_values_that_bound_them(tmp_path):
    short = ends(tmp_path, "squeal", {"track.length": 0.9})
    assert short["contact.at"] == pytest.approx((0.01, 0.899))
    assert short["track.length"][0] == pytest.approx(0.57619)
    slippery = ends(tmp_path, "belt", {"contacts.0.friction.kinetic": 0.1})
    assert slippery["contacts.0.friction.static"] == pytest.approx((0.11, 2.0))
    assert slippery["contacts.0.friction.kinetic"] == pytest.approx((0.01, 0.39))
    # A shorter plate has room for a higher cutoff.
    long, other = (ends(tmp_path, "squeal-on-plate", {"bodies.plate.length": size}) for size in (0.6, 0.3))
    assert other["bodies.plate.cutoff"][1] > 1.5 * long["bodies.plate.cutoff"][1]


def test_a_longer_step_of_the_page_refuses_no_value():
    violin = playable("violin", None, {})
    instrument = Instrument(violin)
    step = 1.0 / RATE / 8
    assert instrument.change(violin.stepped(step), 1)
    instrument._now = replace(instrument._now, longer=step)
    assert instrument.change(playable("violin", None, {"bodies.string.tension": 45.0}), 2)
    assert instrument.longer == step
    instrument.change(playable("violin", None, {"bodies.string.section.diameter": 4e-3}), 3)
    assert instrument.longer is None
    assert instrument.live.ratio > 8


def test_a_value_of_several_contacts_is_refused_in_one_line():
    before = Scene(type="scene", revision=1, case="violin")
    key = "contacts.*.friction.kinetic"
    found = held(before.model_copy(update={"overrides": {key: 2.0}}), before)
    assert found.refused == {key: ["contacts.*.friction.static must be at least kinetic (2.0), got 1.2"]}
    alone = before.model_copy(update={"overrides": {"contacts.0.friction.kinetic": 2.0}})
    assert held(alone, before).problems == ["contacts.0.friction.static must be at least kinetic (2.0), got 1.2"]
