"""Laws of friction: refused arguments, and their curves."""

from __future__ import annotations

import ast
from dataclasses import fields
from inspect import signature
from pathlib import Path

import numpy as np
import pytest

import stridula as st
from stridula._kernels.contact import friction
from stridula._kernels.layout import columns as at
from stridula._kernels.layout.contact_values import Law
from stridula._kernels.layout.laws import CODES, LAW_COLUMNS, NEW_STATE, PARAMETERS
from stridula.contact import LAWS
from stridula.lowering.own_laws import check_law, law_of_march
from stridula.scenarios.schema import json_schema

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
    st.TabulatedFriction: {"velocity": [0.0, 0.1, 0.3], "coefficient": [0.5, 0.3, 0.35]},
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
    st.TabulatedFriction: {"static": [0.4, -1.0, NAN, "1"]},
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


def test_laws_compare_by_value_and_print_themselves():
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


def every_law():
    laws = [st.Coulomb(0.4), *(kind(**words) for kind, words in SOUND.items())]
    return [*laws, st.RateAndState(**STATE, evolution="slip")]


def test_every_law_is_tested():
    assert {type(law) for law in every_law()} == {*LAWS} - {
        st.FrictionOverTemperature,
        st.FrictionAlongTrack,
        st.FrictionAroundTrack,
    }, "they consist of others"


@pytest.mark.parametrize("law", every_law(), ids=str)
def test_declared_properties_of_laws_agree_with_the_march(law):
    code = getattr(at, law.kernel_code)
    assert law.set_valued == friction.set_valued.py_func(code)
    assert set(law.parameters()) == set(PARAMETERS[law.kernel_code])
    assert max(PARAMETERS[law.kernel_code].values()) < NEW_STATE < LAW_COLUMNS
    assert law.has_state == (not law.set_valued) == bool(law.state_units)
    slow, fast = law.coefficient_at(np.array([0.01, 0.1]))
    assert law.depends_on_speed == (slow != fast)
    assert law.linearised_at(0.1).slope == 0.0 or law.depends_on_speed
    assert (law.state_in_sliding(0.1) == law.state_in_sliding(0.2)) != law.has_state


@pytest.mark.parametrize("law", every_law(), ids=str)
def test_the_march_has_the_formulas_of_the_law(law):
    """Those of the package are marched unchecked; the check of a law from outside finds no difference either."""
    outside = type("Outside", (type(law),), {})
    check_law(outside(**{field.name: getattr(law, field.name) for field in fields(law)}))


@pytest.mark.parametrize("law", [law for law in every_law() if law.set_valued and law.depends_on_speed], ids=str)
def test_a_law_bends_within_its_reach(law):
    code, row = law_of_march(law)
    assert 0.1 * law.reach <= friction.speed_scale(Law(code, row[None], 0, law.holding, 0.0), 0.0) <= law.reach


@pytest.mark.parametrize("law", [law for law in every_law() if law.has_state], ids=str)
def test_a_state_in_steady_sliding_stays(law):
    marched = Law(getattr(at, law.kernel_code), np.array([[*law.parameters().values()]]), 0, 0.0, 0.0)
    state = law.state_in_sliding(-0.02)
    assert friction.next_state(marched, state, -0.02, 1e-4) == pytest.approx(state, rel=1e-12)


def test_the_schema_has_what_a_law_declares():
    known = json_schema()["$defs"]
    for law in LAWS:
        units = [name for name in signature(getattr(law, "read", law)).parameters if name.endswith("_unit")]
        of_files = ["file", "columns", *units] if hasattr(law, "read") else []
        assert list(known[law.__name__]["properties"]) == ["law", *(field.name for field in fields(law)), *of_files]
    velocity = known["Stribeck"]["properties"]["velocity"]
    assert velocity["anyOf"][0] == {"type": "number", "exclusiveMinimum": 0.0}
    assert velocity["description"] == "slip speed over which it falls, Stribeck's velocity [m/s]"
    assert known["RateAndState"]["properties"]["evolution"]["enum"] == ["aging", "slip"]


def compared_by_order(text):
    """Comparisons of codes of laws with each other by their order."""
    order = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
    return [
        ast.unparse(node)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Compare)
        and any(isinstance(way, order) for way in node.ops)
        and any(getattr(end, "attr", "") in CODES for end in (node.left, *node.comparators))
    ]


def test_nothing_depends_on_the_order_of_the_codes():
    package = Path(st.__file__).parent
    assert {path: found for path in package.rglob("*.py") if (found := compared_by_order(path.read_text()))} == {}
    # Negative control.
    assert compared_by_order("law <= at.LUGRE and law == at.SLIP") == ["law <= at.LUGRE"]
