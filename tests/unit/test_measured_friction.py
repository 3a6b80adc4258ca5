"""Tables, formulas and fits of measured friction: their values, and what is refused."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pytest
from physics.own_friction import OwnStribeck, Polymer
from scipy.interpolate import PchipInterpolator

import stridula as st
from stridula._kernels.contact import friction as marched
from stridula._kernels.layout.contact_values import Law
from stridula.lowering.own_laws import law_of_march

SPEEDS, VALUES = [0.0, 0.005, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0], [0.52, 0.49, 0.43, 0.36, 0.33, 0.34, 0.38, 0.41]


def in_march(law, speeds):
    code, row = law_of_march(law)
    own = Law(code, row[None], 0, float(row[0]), 0.0)
    return np.array([marched.sliding_ratio(own, float(speed)) for speed in speeds])


@pytest.mark.parametrize("seed", range(20))
def test_a_table_is_the_monotone_cubic_of_scipy_and_constant_beyond(seed):
    random = np.random.default_rng(seed)
    count = random.integers(2, 40)
    speeds, values = np.cumsum(random.exponential(0.1, count)), random.uniform(0.0, 1.0, count)
    law = st.TabulatedFriction(speeds, values)
    at = random.uniform(0.0, 1.3 * speeds[-1], 300)
    expected = PchipInterpolator(speeds, values)(np.clip(at, speeds[0], speeds[-1]))
    np.testing.assert_allclose(law.coefficient_at(at), expected, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(law.coefficient_at(-at), expected, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(in_march(law, at), expected, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(law.coefficient_at(speeds), values, rtol=1e-12)
    # Monotone between points: nothing overshoots.
    assert law.coefficient_at(at).max() <= values.max() + 1e-12
    assert law.coefficient_at(at).min() >= values.min() - 1e-12


def test_a_static_coefficient_holds_and_does_not_slide():
    law = st.TabulatedFriction(SPEEDS, VALUES, static=0.6)
    assert law.holding == 0.6
    assert float(law.coefficient_at(1e-9)) == pytest.approx(0.52, rel=1e-6)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([0.0, 1.0], [0.3]), "coefficient must have as many values as velocity, 2, got 1"),
        (([0.0], [0.3]), "velocity must have two values or more, got 1"),
        (([0.0, 1.0, 1.0], [0.3, 0.2, 0.1]), "velocity[2] must be above 1.0, the one before it, got 1.0"),
        (([-1.0, 1.0], [0.3, 0.2]), "velocity[0] must be 0 or above, got -1.0"),
        (([0.0, 1.0], [0.3, -0.2]), "coefficient[1] must be 0 or above, got -0.2"),
        (([0.0, 1.0], [0.3, float("nan")]), "coefficient[1] must be finite, got nan"),
        (([0.0, 1.0], [0.3, 0.2], 0.1), "static must be at least 0.3, the coefficient in slow sliding, got 0.1"),
        (([0.0, 1.0], [[0.3, 0.2]]), "coefficient must have as many values as velocity, 2, got 1"),
        (
            ([0.0, 1.0], [[0.3, 0.2], [0.2, 0.1]]),
            "coefficient must have as many values as velocity, 2, got lists of values",
        ),
        (([0.0, 1.0], [[0.3, 0.2]], None, [1e5, 2e5]), "coefficient must have as many values as pressure, 2, got 1"),
        (
            ([0.0, 1.0], [[0.3, 0.2], [0.3]], None, [1e5, 2e5]),
            "coefficient[1] must have as many values as velocity, 2, got 1",
        ),
        (
            ([0.0, 1.0], [[0.3, 0.2], [0.3, 0.1]], None, [2e5, 2e5]),
            "pressure[1] must be above 200000.0, the one before it, got 200000.0",
        ),
        (
            ([0.0, 1.0], [[0.3, 0.2], [0.3, 0.1]], [0.4, 0.2], [1e5, 2e5]),
            "static[1] must be at least 0.3, the coefficient in slow sliding, got 0.2",
        ),
        (
            ([0.0, 1.0], [[0.3, -0.2], [0.3, 0.1]], None, [1e5, 2e5]),
            "coefficient[0][1] must be 0 or above, got -0.2",
        ),
    ],
)
def test_a_table_that_cannot_be_used_is_refused(arguments, message):
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        st.TabulatedFriction(*arguments)


@pytest.mark.parametrize(
    ("text", "columns", "unit"),
    [
        ("0,0.5\n20,0.4\n5,0.45\n", (0, 1), 1e-3),
        ("# bench 3\nmu;speed\n0.5;0\n0.4;20\n\n0.45;5\n", ("speed", "mu"), 1e-3),
        ("1 0 0.5\n2  0.005 0.45\n3 0.02 0.4\n", (1, 2), 1.0),
        ("1\t0\t0.5\n2\t0.005\t0.45\n3\t0.02\t0.4\n", (1, 2), 1.0),
    ],
)
def test_a_table_is_read_from_text(tmp_path, text, columns, unit):
    path = tmp_path / "mu.csv"
    path.write_text(text)
    law = st.TabulatedFriction.read(path, columns, static=0.6, speed_unit=unit)
    assert law == st.TabulatedFriction([0.0, 0.005, 0.02], [0.5, 0.45, 0.4], 0.6)


@pytest.mark.parametrize(
    ("text", "columns", "message"),
    [
        ("1,0.5\n2,x\n", (0, 1), "mu.csv, line 2: column 2 must be a number, got 'x'"),
        ("1,0.5\n2\n", (0, 1), "mu.csv, line 2: column 2 must be a number, got nothing"),
        ("v,mu\n1,0.5\n", ("v", "nu"), "mu.csv, line 1: columns must be out of v, mu, got 'nu'"),
        ("1,0.5\n", ("v", 1), "mu.csv, line 1: columns must be out of numbers, as the file names none, got 'v'"),
        ("1,0.5\n", (0, 2), "mu.csv, line 1: columns must be below 2, the number of columns, got 2"),
        ("# nothing\n", (0, 1), "mu.csv: table must have lines of numbers, got none"),
        ("1,0.5\n1,0.4\n", (0, 1), "mu.csv: velocity[1] must be above 1.0, the one before it, got 1.0"),
    ],
)
def test_a_file_without_such_a_table_is_refused_with_its_line(tmp_path, text, columns, message):
    path = tmp_path / "mu.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=f"{re.escape(message)}$"):
        st.TabulatedFriction.read(path, columns)


def own(formula):
    @dataclass(frozen=True)
    class Own(st.FrictionLaw):
        base: float = 0.3

        def coefficient_at(self, velocity):
            return formula(self, velocity)

    return Own()


@pytest.mark.parametrize("seed", range(10))
def test_a_formula_is_marched_to_round_off(seed):
    random = np.random.default_rng(seed)
    scale = 10.0 ** random.uniform(-4.0, 1.0)
    laws = [
        OwnStribeck(0.6, random.uniform(0.1, 0.6), scale),
        Polymer(random.uniform(0.1, 0.4), random.uniform(0.0, 0.4), scale),
        own(lambda law, v: law.base / (1.0 + np.log1p(np.abs(v) / scale))),
        own(lambda law, v: np.maximum(0.5 - 0.2 * np.abs(v) / scale, 0.2)),
        own(lambda law, v: law.base),
    ]
    speeds = scale * 10.0 ** random.uniform(-6.0, 2.0, 400)
    for law in laws:
        expected = np.broadcast_to(law.coefficient_at(speeds), speeds.shape)
        np.testing.assert_allclose(in_march(law, speeds), expected, rtol=2e-12)
        assert float(law.holding) == float(np.asarray(law.coefficient_at(np.zeros(1))).flat[0])


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        (lambda law, v: np.where(np.abs(v) > 0.5, 0.2, 0.3), "be continuous near 0.5 m/s"),
        (lambda law, v: law.base if v > 0 else 0.2, "take an array of velocities .* got ValueError"),
        (lambda law, v: 0.3 + 0.1 * np.tanh(v), "be the same in both senses of slip, got .* m/s"),
        (lambda law, v: np.where(v == 0, 0.2, 0.3), "hold at rest at least its friction in sliding"),
        (lambda law, v: 0.3 + 0.1 * np.sin(1e3 * v) ** 2, "have fewer bends between 0 and"),
    ],
)
def test_a_formula_that_cannot_be_marched_is_refused_when_it_is_built(formula, message):
    with pytest.raises(ValueError, match=f"^Own: coefficient_at must {message}"):
        own(formula)


@pytest.mark.filterwarnings("ignore:invalid value")
def test_a_coefficient_below_zero_or_not_a_number_is_refused_with_its_speed():
    with pytest.raises(ValueError, match=r"^Own: coefficient_at\(-1e-15\) must be finite and 0 or above, got -1"):
        own(lambda law, v: 0.1 * v)
    with pytest.raises(ValueError, match=r"^Own: coefficient_at\(0\..*\) must be finite and 0 or above, got nan"):
        own(lambda law, v: np.sqrt(0.3 - np.abs(v)))


def test_a_formula_may_hold_more_at_rest():
    law = own(lambda law, v: np.where(np.asarray(v) == 0.0, 0.5, law.base))
    assert law.holding == 0.5
    assert in_march(law, [0.0, 1.0]) == pytest.approx(0.3)


FITTED = [
    st.Stribeck(0.6, 0.25, 0.03, viscous=0.05),
    st.ExponentialWeakening(0.5, 0.2, 0.1),
    st.LinearWeakening(0.5, 0.4, 0.2),
    st.Coulomb(0.3),
    st.LuGre(0.6, 0.3, 0.05, 1e5, 0.0, 0.1),
]


LIKE = [(st.Stribeck, {}), (st.LuGre, {"stiffness": 1e5})]


@pytest.mark.parametrize("law", FITTED, ids=lambda law: law.law)
def test_a_fit_finds_the_law_that_made_the_data(law):
    speeds = np.geomspace(1e-3, 2.0, 25)
    given = {"stiffness": 1e5} if isinstance(law, st.LuGre) else {}
    fit = st.fit_friction(speeds, law.coefficient_at(speeds), type(law), **given)
    np.testing.assert_allclose(fit.law.coefficient_at(speeds), law.coefficient_at(speeds), rtol=1e-7)
    assert fit.error < 1e-8


def test_a_speed_of_zero_is_that_of_the_slowest_sliding():
    """LuGre's curve is Stribeck's, also where the table begins at 0."""
    plain, bristles = (st.fit_friction(SPEEDS, VALUES, law, **more) for law, more in LIKE)
    assert bristles.error == pytest.approx(plain.error, rel=1e-6)
    assert bristles.law.static == pytest.approx(plain.law.static, rel=1e-4)


def test_a_fit_of_noisy_data_is_the_least_square():
    """No neighbour of the fitted parameters has a smaller sum of squares."""
    random, speeds = np.random.default_rng(3), np.geomspace(1e-3, 1.0, 40)
    measured = st.Stribeck(0.55, 0.3, 0.05).coefficient_at(speeds) + 0.01 * random.standard_normal(40)
    fit = st.fit_friction(speeds, measured)
    assert fit.error == pytest.approx(0.01, rel=0.3)
    np.testing.assert_allclose(fit.residuals, measured - fit.law.coefficient_at(speeds), atol=1e-15)
    for name in ("static", "kinetic", "velocity", "viscous"):
        for factor in (0.999, 1.001):
            values = {key: getattr(fit.law, key) for key in ("static", "kinetic", "velocity", "viscous")}
            values[name] = values[name] * factor + (1e-4 * (factor - 1.0) if values[name] == 0.0 else 0.0)
            if values["viscous"] < 0.0:
                continue
            away = measured - st.Stribeck(**values).coefficient_at(speeds)
            assert (away**2).sum() >= (fit.residuals**2).sum() * (1.0 - 1e-9)


@pytest.mark.parametrize(
    ("arguments", "given", "message"),
    [
        (([1.0], [0.2]), {}, "velocity must have at least as many values as there are parameters, got 1 for static"),
        (([1.0, 2.0], [0.2, 0.3], st.RateAndState), {}, "law must be one of Coulomb, Stribeck, .* got RateAndState"),
        (([1.0, 2.0], [0.2, -1.0]), {}, "coefficient must be 0 or above, and not all 0, got -1.0"),
        (([1.0, 2.0], [0.2]), {}, "coefficient must have as many values as velocity, got 1 and 2"),
        (([0.0, 0.0], [0.2, 0.2]), {}, "velocity must not be all 0"),
        (([1.0, 2.0], [0.2, 0.3], st.LuGre), {}, "stiffness must be given for LuGre: steady sliding does not depend"),
        (([1.0, 2.0], [0.2, 0.3]), {"speed": 1.0}, "argument must be one of static, kinetic, .* got 'speed'"),
        (([1.0, 2.0], [0.2, float("nan")]), {}, "coefficient must be a list of finite numbers"),
    ],
)
def test_data_that_cannot_be_fitted_are_refused(arguments, given, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        st.fit_friction(*arguments, **given)
