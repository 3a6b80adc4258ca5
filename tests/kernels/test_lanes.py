"""The functions of `lanes` on vectors give the result of their plain code on every lane."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from stridula._kernels.lanes import operations as lanes
from stridula._kernels.lanes.operations import (
    anywhere,
    choose,
    everywhere,
    fused,
    lane,
    load,
    magnitude,
    placed,
    read,
    spread,
    store,
    total,
    whole,
    with_lane,
    write,
)
from stridula._kernels.lanes.vectors import LANES
from stridula._kernels.layout.rows import NUMBER, WAVE_ROWS
from stridula._kernels.modes.waves import set_multiples

RANDOM = np.random.default_rng(7)
A, B, C = RANDOM.normal(size=(3, LANES))
EDGES = np.array([0.0, -0.0, np.inf, -np.inf, np.nan, 1e-320, -2.5, 3.0])


@numba.njit
def arithmetic(given, out):
    a, b, c = read(given, 0, 0, spread(0.0)), read(given, 1, 0, spread(0.0)), read(given, 2, 0, spread(0.0))
    write(out, 0, 0, a + b)
    write(out, 1, 0, a - 2.0 * b)
    write(out, 2, 0, 3.0 / a)
    write(out, 3, 0, -a)
    write(out, 4, 0, fused(a, b, c))
    write(out, 5, 0, whole(a))
    write(out, 6, 0, magnitude(a))
    write(out, 7, 0, choose(a < b, a, 5.0))
    write(out, 8, 0, choose(a >= 0.0, choose(b > c, 1.0, 2.0), choose(b <= c, 3.0, 4.0)))
    a += b
    a *= c
    write(out, 9, 0, a)


@pytest.mark.parametrize("first", [A, EDGES], ids=["numbers", "edges"])
def test_arithmetic_lane_by_lane(first):
    out = np.empty((10, LANES))
    arithmetic(np.stack([first, B, C]), out)
    a, b, c = first, B, C
    with np.errstate(all="ignore"):
        outer = np.where(a >= 0, np.where(b > c, 1.0, 2.0), np.where(b <= c, 3.0, 4.0))
        expected = [
            a + b,
            a - 2 * b,
            3 / a,
            -a,
            a * b + c,
            np.floor(a),
            np.abs(a),
            np.where(a < b, a, 5.0),
            outer,
            (a + b) * c,
        ]
    np.testing.assert_allclose(out, expected, rtol=4e-16, atol=1e-16)
    np.testing.assert_array_equal(np.signbit(out[3]), np.signbit(-a))


@numba.njit
def conditions(given):
    a = read(given, 0, 0, spread(0.0))
    return anywhere(a > 0.0), everywhere(a > 0.0), total(a, 0.0), lane(a, 3), lane(with_lane(a, 3, 7.0), 3)


@pytest.mark.parametrize("values", [A, np.abs(A), -np.abs(A), EDGES], ids=["mixed", "above", "below", "edges"])
def test_conditions_and_sums_over_the_lanes(values):
    some, all_of_them, summed, third, changed = conditions(values[None].copy())
    with np.errstate(invalid="ignore"):
        assert (some, all_of_them) == ((values > 0).any(), (values > 0).all())
        np.testing.assert_allclose(summed, values.sum(), rtol=1e-14)
    np.testing.assert_equal((third, changed), (values[3], 7.0))


def test_as_plain_python_everything_is_a_number():
    assert lanes.choose(2.0 > 1.0, 3.0, 4.0) == 3.0
    assert lanes.total(5.0, 0.0) == lanes.spread(5.0) == 5.0
    assert lanes.whole(-0.5) == -1.0
    assert not lanes.everywhere(1.0 < 0.0)
    rows = np.zeros((2, 3, 4))
    runs = lanes.placed((3, 4))
    lanes.store(rows, 1, 2, runs, 6.0)
    assert rows[1, 2, 3] == lanes.load(rows, 1, 2, runs) == 6.0


@numba.njit
def multiples_of_one_run(theta, from_zero, count, rows):
    set_multiples(theta, from_zero, count, rows, 0, 0, placed(None))


@numba.njit
def multiples_of_eight_runs(thetas, from_zero, count, rows):
    set_multiples(read(thetas, 0, 0, spread(0.0)), from_zero, count, rows, 0, 0, placed(True))


@numba.njit
def copied(rows, out):
    for k in range(rows.shape[0]):
        store(out, k, 0, placed(True), load(rows, k, 0, placed(True)))


@pytest.mark.parametrize("theta", [1e-9, 1e-3, 0.7, np.pi / 2, 3.0, np.pi - 1e-9])
@pytest.mark.parametrize("first", [0, 1])
def test_multiples_of_one_run(theta, first):
    """sin(k theta): a turn by eight adds one eps, np.sin's own argument is rounded by k theta eps / 2."""
    blocks = 51
    k = first + np.arange(blocks * LANES)
    rows = np.zeros((blocks, WAVE_ROWS, LANES))
    rows[:, NUMBER] = k.reshape(blocks, LANES)
    multiples_of_one_run(theta, 1 - first, blocks, rows)
    np.testing.assert_allclose(rows[:, 0].ravel(), np.sin(k * theta), atol=4e-16 * k.size, rtol=0)
    np.testing.assert_allclose(rows[:, 1].ravel(), np.cos(k * theta), atol=4e-16 * k.size, rtol=0)


@pytest.mark.parametrize("count", [1, 2, 3, 25, 100])
@pytest.mark.parametrize("first", [0, 1])
def test_multiples_of_eight_runs(count, first):
    thetas = np.linspace(1e-6, np.pi - 1e-6, LANES)[None]
    rows = np.zeros((count, WAVE_ROWS, LANES))
    multiples_of_eight_runs(thetas, 1 - first, count, rows)
    angles = (first + np.arange(count))[:, None] * thetas
    np.testing.assert_allclose(rows[:, 0], np.sin(angles), atol=4e-16 * (count + 1), rtol=0)
    np.testing.assert_allclose(rows[:, 1], np.cos(angles), atol=4e-16 * (count + 1), rtol=0)
    # Nothing beyond the given blocks changes, and in a block only the two rows.
    assert not rows[:, 2:].any()


def test_blocks_are_loaded_and_stored_whole():
    rows = RANDOM.normal(size=(3, 2, LANES))
    out = np.zeros_like(rows)
    copied(rows, out)
    np.testing.assert_array_equal(out[:, 0], rows[:, 0])
    assert not out[:, 1].any()
