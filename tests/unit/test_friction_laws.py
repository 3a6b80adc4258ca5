"""Laws of friction: what they refuse, and their curves."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

NAN, INF = float("nan"), float("inf")
NUMBERS = [NAN, INF, True, "1", None]
STATE = {"reference": 0.6, "a": 0.01, "b": 0.015, "slip_distance": 1e-5, "velocity": 1e-3}
SOUND = {
    st.StaticKinetic: {"static": 0.5, "kinetic": 0.3},
    st.Stribeck: {"static": 0.5, "kinetic": 0.3, "velocity": 0.1},
    st.ExponentialWeakening: {"static": 0.5, "kinetic": 0.3, "velocity": 0.1},
    st.LinearWeakening: {"static": 0.5, "slope": 1.0, "kinetic": 0.3},
    st.LuGre: {"static": 0.5, "kinetic": 0.3, "velocity": 0.1, "stiffness": 1e5},
    st.RateAndState: STATE,
}
NOT_NEGATIVE = [*NUMBERS, -1e-9]
POSITIVE = [*NOT_NEGATIVE, 0.0]
BAD = {
    st.StaticKinetic: {"static": [*NOT_NEGATIVE, 0.2], "kinetic": NOT_NEGATIVE},
    st.Stribeck: {
        "static": [*NOT_NEGATIVE, 0.2],
        "kinetic": NOT_NEGATIVE,
        "velocity": POSITIVE,
        "exponent": POSITIVE,
        "viscous": NOT_NEGATIVE,
    },
    st.ExponentialWeakening: {"static": [*NOT_NEGATIVE, 0.2], "kinetic": NOT_NEGATIVE, "velocity": POSITIVE},
    st.LinearWeakening: {"static": [*NOT_NEGATIVE, 0.2], "slope": NOT_NEGATIVE, "kinetic": NOT_NEGATIVE},
    st.LuGre: {
        "static": [*NOT_NEGATIVE, 0.2],
        "kinetic": POSITIVE,
        "velocity": POSITIVE,
        "stiffness": POSITIVE,
        "damping": NOT_NEGATIVE,
        "viscous": NOT_NEGATIVE,
    },
    st.RateAndState: {
        **dict.fromkeys(STATE, POSITIVE),
        "evolution": ["ageing", None, 1],
        "initial_state": [NAN, INF, True, "1", 0.0, -1.0],
    },
}
CASES = [
    pytest.param(law, name, value, id=f"{law.__name__}.{name}={value!r}")
    for law, names in BAD.items()
    for name, values in names.items()
    for value in values
]


@pytest.mark.parametrize(("law", "name", "value"), CASES)
def test_bad_arguments_are_named_with_value_and_range(law, name, value):
    with pytest.raises(ValueError, match=rf"^{name} must ") as caught:
        law(**SOUND[law] | {name: value})
    assert repr(value) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_misspelt_evolution_is_suggested():
    with pytest.raises(ValueError, match="did you mean 'aging'"):
        st.RateAndState(**STATE, evolution="ageing")


V = np.array([-0.2, -1e-3, 0.0, 1e-3, 0.05, 0.2])


def test_curves_are_their_formulas():
    speed = np.abs(V)
    gauss = 0.3 + 0.2 * np.exp(-((speed / 0.1) ** 2))
    np.testing.assert_allclose(st.Coulomb(0.4).coefficient_at(V), 0.4)
    np.testing.assert_allclose(st.StaticKinetic(0.5, 0.3).coefficient_at(V), np.where(V == 0, 0.5, 0.3))
    np.testing.assert_allclose(st.Stribeck(0.5, 0.3, 0.1).coefficient_at(V), gauss)
    np.testing.assert_allclose(st.Stribeck(0.5, 0.3, 0.1, 2.0, 0.7).coefficient_at(V), gauss + 0.7 * speed)
    exponential = 0.3 + 0.2 * np.exp(-speed / 0.1)
    np.testing.assert_allclose(st.ExponentialWeakening(0.5, 0.3, 0.1).coefficient_at(V), exponential)
    np.testing.assert_allclose(st.Stribeck(0.5, 0.3, 0.1, 1.0).coefficient_at(V), exponential)
    linear = np.maximum(0.5 - 2.0 * speed, 0.3)
    np.testing.assert_allclose(st.LinearWeakening(0.5, 2.0, 0.3).coefficient_at(V), linear)
    bristles = st.LuGre(0.5, 0.3, 0.1, 1e4, 3.0, 0.7).coefficient_at(V)
    np.testing.assert_allclose(bristles, np.where(V == 0, 0.0, gauss + 0.7 * speed))


@pytest.mark.parametrize("evolution", ["aging", "slip"])
def test_steady_rate_and_state(evolution):
    """theta = D / V: reference + (a - b) ln(V / V0) where a asinh(x) is a ln(2 x)."""
    law = st.RateAndState(**STATE, evolution=evolution)
    speed = np.array([1e-5, 1e-3, 0.1])
    np.testing.assert_allclose(law.coefficient_at(speed), 0.6 - 0.005 * np.log(speed / 1e-3), rtol=1e-9)
    assert law.coefficient_at(0.0) == 0.0
    assert np.all(np.isfinite(law.coefficient_at(np.array([1e-300, 1e300]))))
    assert law.state_at_start == 1e-5 / 1e-3
    assert st.RateAndState(**STATE, initial_state=3.0).state_at_start == 3.0


def test_laws_are_values_and_say_what_they_are():
    laws = [kind(**words) for kind, words in SOUND.items()]
    again = [kind(**words) for kind, words in SOUND.items()]
    assert laws == again
    assert len(set(laws)) == len(laws)
    for law in laws:
        assert str(law)
        assert "\n" not in str(law)


@pytest.mark.parametrize("law", [None, 0.5, "coulomb", st.Coulomb])
def test_a_contact_takes_laws_only(law):
    with pytest.raises(ValueError, match=r"^friction must be a Coulomb or StaticKinetic or Stribeck"):
        st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(), friction=law)
