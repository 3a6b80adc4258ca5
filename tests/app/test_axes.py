"""Ticks and ends of axes, without a page."""

from __future__ import annotations

import numpy as np
import pytest

from .scripting import result_of

TICKS = """import { ticks } from "./axes.js";
result = given.map((words) => ticks(...words));"""
ROOF = """import { roof } from "./axes.js";
result = given.map(roof);"""
TOLD = """import { told } from "./axes.js";
result = given.map(told);"""


def test_ticks_are_round_and_lie_between_the_ends(tmp_path):
    found = result_of(tmp_path, TICKS, [[0, 12, 6], [-60, 0, 6], [-1, 0, 5], [-0.004, 0.004, 8], [-80, 0, 4]])
    assert found[0] == [0, 2, 4, 6, 8, 10, 12]
    assert found[1] == [-60, -50, -40, -30, -20, -10, 0]
    assert found[2] == [-1, -0.8, -0.6, -0.4, -0.2, 0]
    assert found[3] == pytest.approx(np.linspace(-0.004, 0.004, 9), abs=1e-12)
    assert found[4] == [-80, -60, -40, -20, 0]


def test_there_are_never_more_ticks_than_fit(tmp_path):
    random = np.random.default_rng(3)
    given = []
    for _ in range(300):
        low = float(random.normal() * 10.0 ** random.uniform(-9, 6))
        given.append([low, low + float(10.0 ** random.uniform(-9, 6)), int(random.integers(1, 12))])
    for (low, high, most), found in zip(given, result_of(tmp_path, TICKS, given), strict=True):
        assert len(found) <= most + 1
        rounding = 1e-6 * (abs(low) + abs(high))
        assert all(low - rounding <= tick <= high + rounding for tick in found)
        # Never too few: the next smaller step would be at most two and a half times as small.
        assert len(found) >= np.floor(most / 2.5) or high - low < 1e-9 * abs(low)


def test_sides_without_extent_have_no_ticks(tmp_path):
    assert result_of(tmp_path, TICKS, [[0, 0, 5], [1, 0, 5], [3, 3, 0]]) == [[], [], []]


def test_an_axis_ends_at_the_next_round_value(tmp_path):
    values = [float(value) for value in 10.0 ** np.linspace(-9, 9, 400)] + [1.0, 2.0, 10.0, 0.3, 50.0]
    roofs = result_of(tmp_path, ROOF, values)
    assert all(value * (1 - 1e-8) <= top <= 1.3401 * value for value, top in zip(values, roofs, strict=True))
    assert roofs[-5:] == pytest.approx([1.0, 2.0, 10.0, 0.3, 50.0])
    assert len(set(roofs)) < 220


def test_numbers_have_a_proper_minus(tmp_path):
    assert result_of(tmp_path, TOLD, [-0.25, 0, 1250, 0.00012345]) == ["−0.25", "0", "1250", "0.000123"]
