"""The force of a contact with a stiffness over a step, against quadrature of the path in plain Python."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.integrate import quad

from stridula._kernels.contact.pressing import between, press, press_on_path, quotient, share_of
from stridula._kernels.layout.contact_values import Indentations, Yielding

STEP = 1e-5
DRAWS = 150
Path = tuple[float, float, float, float]


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


def with_damping_corrected(path: Path, numbers: tuple[float, ...], reach: float) -> float:
    """Return the same for the mean velocity of the motion, known from the indentation one step earlier.

    That of the parabola is larger by a twelfth of the third difference. Only damping that is small for the step is
    corrected, and by no more than half of the force.
    """
    x, now, before, earlier = path
    k, p, damping, rate = numbers
    force = mean_on_path(x, now, before, numbers)
    if min(now, before, earlier) <= 0.0:
        return force
    braked = damping + rate * k * now**p
    braked *= np.clip(2.0 - reach * braked / (0.25 * STEP), 0.0, 1.0)
    too_large = np.diff([earlier, before, now, x], n=3)[0] / (12.0 * STEP)
    return float(force + np.clip(-braked * too_large, -0.5 * force, 0.5 * force))


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
    found, _ = press_on_path(*path, Yielding(*numbers, 0.0), STEP)
    # The quadrature has four points in each piece; the largest force on the path is the scale.
    largest = numbers[0] * max(*path, 0.0) ** numbers[1]
    assert found == pytest.approx(known, rel=2e-3, abs=2e-4 * largest)


@pytest.mark.parametrize("seed", range(DRAWS))
@pytest.mark.parametrize("share", [0.0, 0.4])
def test_the_slope_is_that_of_the_force(seed, share):
    rng = np.random.default_rng(seed)
    (x, now, before), numbers = drawn(rng)
    earlier = before + 1e-7 * rng.normal()
    yields, change = Yielding(*numbers, 0.0), 1e-11

    def force(at: float) -> float:
        return press(at, Indentations(now, before, earlier), yields, share, STEP)[0]

    _, slope = press(x, Indentations(now, before, earlier), yields, share, STEP)
    around = (force(x + change) - force(x - change)) / (2.0 * change)
    scale = numbers[0] * numbers[1] * max(x, now, before, 1e-9) ** (numbers[1] - 1.0) + numbers[2] / STEP
    assert slope == pytest.approx(around, rel=5e-3, abs=5e-3 * scale)


@pytest.mark.parametrize("seed", range(DRAWS))
def test_the_damping_is_corrected_by_the_third_difference(seed):
    rng = np.random.default_rng(seed)
    path, numbers = drawn(rng)
    # Often deep, and as often with a step back in time that was open.
    path = (*(one + 2e-6 * rng.random() for one in path), 1e-6 * rng.normal() + 1e-6)
    braked = numbers[2] + numbers[3] * numbers[0] * max(path[1], 0.0) ** numbers[1]
    reach = float(rng.choice([0.0, 0.1, 0.4, 1.0])) * STEP / max(braked, 1e-30)
    found, _ = press(path[0], Indentations(*path[1:]), Yielding(*numbers, reach), 0.0, STEP)
    largest = numbers[0] * max(*path[:3], 0.0) ** numbers[1]
    assert found == pytest.approx(with_damping_corrected(path, numbers, reach), rel=2e-3, abs=3e-4 * largest)


def test_the_force_is_continuous_where_damping_begins_to_pull():
    """The correction fades where the contact ceases to press, so that a small change of x never changes it much."""
    yields, deep = Yielding(1e6, 1.0, 100.0, 0.0, 0.0), 1e-6
    for now, before, earlier in ((1.0, 1.4, 1.9), (0.3, 1.0, 1.4), (1.0, 1.2, 0.2)):
        path = Indentations(deep * now, deep * before, deep * earlier)
        x = np.linspace(-2.0 * deep, 4.0 * deep, 20001)
        forces = np.array([press(float(at), path, yields, 0.0, STEP)[0] for at in x])
        steepest = yields[0] + 1.5 * yields[2] / STEP
        assert np.abs(np.diff(forces)).max() < steepest * (x[1] - x[0])


@pytest.mark.parametrize("numbers", [(1e8, 1.0, 200.0, 0.0), (1e11, 1.5, 0.0, 0.5), (1e8, 1.0, 0.0, 0.5)])
def test_the_force_of_a_cubic_motion_is_its_mean_to_fourth_order(numbers):
    k, p, damping, rate = numbers
    motion = np.polynomial.Polynomial([1e-5, 0.08, 3e3, -2e8])
    velocity = motion.deriv()

    def force(time: float) -> float:
        elastic = k * motion(time) ** p
        return float(elastic + (damping + rate * elastic) * velocity(time))

    errors, without = [], []
    for step in (STEP, 0.5 * STEP):
        known = quad(lambda s, h=step: (1.0 - abs(s)) * force(s * h), -1.0, 1.0, points=[0.0], epsrel=1e-12)[0]
        x, now, before, earlier = (float(motion(n * step)) for n in (1, 0, -1, -2))
        yields = Yielding(*numbers, 0.0)
        errors.append(abs(press(x, Indentations(now, before, earlier), yields, 0.0, step)[0] - known))
        without.append(abs(press_on_path(x, now, before, yields, step)[0] - known))
    assert without[0] == pytest.approx(4.0 * without[1], rel=0.1)
    assert errors[0] < without[0] / 20.0
    assert errors[1] <= errors[0] / 14.0 + 1e-12 * force(0.0)


def largest_root(angle: float, share: float, reach: float) -> float:
    """Return the largest root of the recurrence of a mass on a linear contact, in size.

    Mass and step are one, `angle` is the advance of its vibration in a step, `share` that of the critical damping.
    """
    yields = Yielding(angle**2, 1.0, 2.0 * share * angle, 0.0, reach)
    of_quotient = share_of(1.0, Indentations(1.0, 1.0, 1.0), yields)
    deep, change = np.ones(4), 1e-7

    def force(path) -> float:
        return press(float(path[0]), Indentations(*map(float, path[1:])), yields, of_quotient, 1.0)[0]

    slopes = [(force(deep + change * one) - force(deep - change * one)) / (2.0 * change) for one in np.eye(4)]
    return float(np.abs(np.roots(np.array([1.0, -2.0, 1.0, 0.0]) + slopes)).max())


@pytest.mark.parametrize("angle", [0.05, 0.2, 0.5, 1.0, 1.6, 1.9, 2.2, 2.6, 3.0, 10.0])
def test_a_mass_on_a_damped_contact_is_stable_at_any_step(angle):
    """The size of its sawtooth under a unit force is a quarter; with a smaller one the correction would be too much."""
    for share in np.geomspace(0.01, 100.0, 41):
        assert largest_root(angle, float(share), 0.25) < 1.0
    assert max(largest_root(2.0, float(share), 0.08) for share in (1.0, 1.5)) > 1.0


def test_a_linear_spring_that_stays_closed_keeps_its_energy():
    """The work of the force between two steps is the change of the energy stored between steps, to rounding."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        before, now, x = 1e-6 * (1.0 + rng.random(3))
        force, _ = press_on_path(x, now, before, Yielding(1e8, 1.0, 0.0, 0.0, 0.0), STEP)
        stored = 1e8 * (between(x, now, 1.0) - between(now, before, 1.0))
        assert 0.5 * force * (x - before) == pytest.approx(stored, rel=1e-9, abs=1e-16)


def test_the_quotient_is_the_change_of_energy():
    for exponent in (1.0, 1.5, 2.7):
        for x, before in ((2e-6, 1e-6), (1e-6, -1e-6), (1e-6, 1.001e-6), (-1e-6, -2e-6)):
            inside, was = max(x, 0.0), max(before, 0.0)
            known = (inside ** (exponent + 1.0) - was ** (exponent + 1.0)) / (exponent + 1.0) / (x - before)
            assert quotient(x, before, exponent)[0] == pytest.approx(known, rel=1e-6)
