"""Colours of statuses and regimes: each has one meaning."""

from __future__ import annotations

import colorsys
import re
from importlib.resources import files

import pytest

from stridula.plot.colours import REGIME_COLOURS, STATUS_COLOURS

SAME = {"stable sliding": "sliding", "sticking": "sticking", "off the track": "separated"}


def hue(colour: str) -> float:
    return colorsys.rgb_to_hsv(*(int(colour[at : at + 2], 16) / 255.0 for at in (1, 3, 5)))[0]


@pytest.mark.parametrize("regime", REGIME_COLOURS)
def test_a_regime_has_the_tint_of_its_status_or_a_colour_of_no_status(regime):
    distances = {status: abs(hue(REGIME_COLOURS[regime]) - hue(one)) for status, one in STATUS_COLOURS.items()}
    near = {status for status, distance in distances.items() if distance < 0.02}
    assert near == ({SAME[regime]} if regime in SAME else set())


def test_the_page_has_the_colours_of_figures():
    style = files("stridula.app").joinpath("page", "style.css").read_text(encoding="utf-8")
    found = {status: re.findall(rf"--{status}: (#\w+);", style) for status in STATUS_COLOURS}
    assert found == {status: [colour] for status, colour in STATUS_COLOURS.items()}
