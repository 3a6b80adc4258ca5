"""The force of a contact with a stiffness over a step, against quadrature of the path in plain Python."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.integrate import quad

from stridula._kernels.pressing import between, press_on_path, press_one, quotient

STEP = 1e-5
DRAWS = 150


def mean_on_path(x: float, now: float, before: float, numbers: tuple[float, ...]) -> float:
    """Return the mean of the force along the parabola through three indentations, weighted by a triangle."""
    k, p, damping, rate = numbers
    sloped, bent = 0.5 * (x - before), 0.5 * (x - 2.0 * now + before)

    def force(s: float) -> float:
        inside, velocity = now + s * (sloped + s * bent), (sloped + 2.0 * s * bent) / STEP
        if inside <= 0.0:
            return 0.0
        return float(max(k * inside**p * (1.0 + rate * velocity) + damping * velocity, 0.0) * (1.0 - abs(s)))

    kinks = [root.real for root in np.roots([bent, sloped, now]) if abs(root.imag) < 1e-12]
    if damping:
        pulls = np.roots([k * bent, k * sloped + 2.0 * damping * bent / STEP, k * now + damping * sloped / STEP])
        kinks += [root.real for root in pulls if abs(root.imag) < 1e-12]
    if rate * bent:
        kinks.append(-(1.0 + rate * sloped / STEP) / (2.0 * rate * bent / STEP))
    points = sorted({-1.0, 0.0, 1.0, *(float(one) for one in kinks if -1.0 < one < 1.0)})
    return sum(quad(force, *ends, epsabs=1e-12 * k * 1e-6**p, epsrel=1e-7)[0] for ends in itertools.pairwise(points))


def drawn(rng: np.random.Generator) -> tuple[tuple[float, float, float], tuple[float, float, float, float]]:
    """Return a path, often through contact and lift-off, and the numbers of a stiffness."""
    path = 1e-6 * rng.normal(size=3) + 1e-6 * rng.normal()
    if rng.random() < 0.3:
        path = np.abs(path)
    if rng.random() < 0.5:
        return tuple(map(float, path)), (10.0 ** rng.uniform(3, 9), 1.0, float(rng.choice([0.0, 1.0, 100.0])), 0.0)
    exponent = float(rng.choice([1.0, 1.5, 2.0, 3.3]))
    return tuple(map(float, path)), (10.0 ** rng.uniform(8, 12), exponent, 0.0, float(rng.choice([0.0, 0.1, 10.0])))


@pytest.mark.parametrize("seed", range(DRAWS))
def test_the_force_is_the_mean_along_the_path(seed):
    path, numbers = drawn(np.random.default_rng(seed))
    known = mean_on_path(*path, numbers)
    found, _ = press_on_path(*path, (*numbers, 0.0), STEP)
    # The quadrature has four points in each piece; the largest force on the path is the scale.
    largest = numbers[0] * max(*path, 0.0) ** numbers[1]
    assert found == pytest.approx(known, rel=2e-3, abs=2e-4 * largest)


@pytest.mark.parametrize("seed", range(DRAWS))
@pytest.mark.parametrize("share", [0.0, 0.4])
def test_the_slope_is_that_of_the_force(seed, share):
    (x, now, before), numbers = drawn(np.random.default_rng(seed))
    yields, change = (*numbers, 0.0), 1e-11

    def force(at: float) -> float:
        return press_one(at, (now, before), yields, share, STEP)[0]

    _, slope = press_one(x, (now, before), yields, share, STEP)
    around = (force(x + change) - force(x - change)) / (2.0 * change)
    scale = numbers[0] * numbers[1] * max(x, now, before, 1e-9) ** (numbers[1] - 1.0) + numbers[2] / STEP
    assert slope == pytest.approx(around, rel=5e-3, abs=5e-3 * scale)


def test_a_linear_spring_that_stays_closed_keeps_its_energy():
    """The work of the force between two steps is the change of the energy stored between steps, to rounding."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        before, now, x = 1e-6 * (1.0 + rng.random(3))
        force, _ = press_on_path(x, now, before, (1e8, 1.0, 0.0, 0.0, 0.0), STEP)
        stored = 1e8 * (between(x, now, 1.0) - between(now, before, 1.0))
        assert 0.5 * force * (x - before) == pytest.approx(stored, rel=1e-9, abs=1e-16)


def test_the_quotient_is_the_change_of_energy():
    for exponent in (1.0, 1.5, 2.7):
        for x, before in ((2e-6, 1e-6), (1e-6, -1e-6), (1e-6, 1.001e-6), (-1e-6, -2e-6)):
            inside, was = max(x, 0.0), max(before, 0.0)
            known = (inside ** (exponent + 1.0) - was ** (exponent + 1.0)) / (exponent + 1.0) / (x - before)
            assert quotient(x, before, exponent)[0] == pytest.approx(known, rel=1e-6)
