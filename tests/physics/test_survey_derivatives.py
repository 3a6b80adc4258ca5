"""Derivatives of the modes of a survey: differences of modes found again, columns of its tables, and refusals."""

from __future__ import annotations

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.linear.reach import equilibrium_at_start, modes_at_rest
from stridula.records.provenance import toml
from stridula.scenarios.errors import ScenarioError
from stridula.scenarios.read import read_tables
from stridula.studies.survey_task import without_start
from stridula.studies.tables import survey_table

from .test_mode_sensitivity import difference, drawn, nearest

BRIEF = {"duration": 0.02, "cycles": False, "kicks": 0}


def exponents(system: st.System) -> np.ndarray:
    """Return the modes from which the runs of a survey start, conjugates included."""
    bare, start = without_start(system, None)
    at = equilibrium_at_start(bare, start)
    found = modes_at_rest(bare, replace(start, status=at.status)).exponents
    return np.concatenate([found, found[found.imag > 0.0].conj()])


def must_agree(found, system_of, key: str, value: float, share: float = 1e-3) -> int:
    """Compare the derivatives of all growing modes of a point with differences, and return their number."""
    step = share * value
    four = [exponents(system_of(value + place * step)) for place in (-2, -1, 1, 2)]
    size = max(np.abs(one[one.imag != 0.0]).max() for one in four)
    point = found.sel(parameter=key)
    grows = np.flatnonzero(np.isfinite(point.growth_rate.values))
    known = (point.growth_rate + 2j * np.pi * point.frequency).values[grows]
    by_value = difference([nearest(each, known) for each in four], step)
    got = (point.d_growth_rate + 2j * np.pi * point.d_frequency).values[grows]
    np.testing.assert_allclose(got, by_value, rtol=1e-6, atol=1e-13 * size / abs(step))
    return grows.size


@pytest.mark.parametrize("seed", [0, 3, 5, 6, 10, 15, 17, 20, 25])
def test_derivatives_of_random_systems_are_those_of_modes_found_again(seed):
    """Random bodies on two belts at two values of friction at which a mode grows."""
    made, given = drawn(seed, space=False)
    name = next(key for key in given if "friction" in key and "velocity" not in key)
    others = [key for key in given if key != name]

    def system_of(friction: float) -> st.System:
        return made(given | {name: friction})

    def changed(key: str, friction: float):
        return lambda value: made(given | {name: friction, key: value})

    points = [{"friction": value} for value in (0.5, 0.55)]
    found = st.squeal_survey(system_of, points, by=[name, *others], **BRIEF)
    assert set(found.message.values) == {""}
    for number, point in enumerate(points):
        one = found.isel(point=number)
        assert must_agree(one, system_of, name, point["friction"])
        for key in others:
            assert float(one.parameter_value.sel(parameter=key)) == pytest.approx(given[key], rel=1e-12)
            assert must_agree(one, changed(key, point["friction"]), key, given[key])


def test_derivatives_of_the_pin_on_the_disc_are_those_of_modes_found_again(tmp_path):
    """The shipped case under its whole load from the start, as runs of a survey begin in equilibrium."""
    tables = read_tables("pin-on-disc")
    for drive in tables["drives"]:
        del drive["history"]
    path = tmp_path / "pressed.toml"
    path.write_text(toml(tables))
    friction, young = keys = ["friction.coefficient", "bodies.pin.materials.young"]
    found = st.squeal_survey(path, {"friction": [0.12, 0.152]}, by=keys, **BRIEF)
    assert set(found.message.values) == {""}
    for at in (0.12, 0.152):
        point = found.sel(friction=at)
        stiff = float(point.parameter_value.sel(parameter=young))
        assert float(point.parameter_value.sel(parameter=friction)) == pytest.approx(at, rel=1e-12)

        def system_of(value: float, young_of: float = stiff) -> st.System:
            return st.load_scenario(path, {"friction": value, young: young_of}).system

        # The merge is near: growth bends within a thousandth of the friction.
        assert must_agree(point, system_of, friction, at, share=2e-4)
        assert must_agree(point, lambda value, at=at: system_of(at, value), young, stiff)


def test_a_derivative_is_the_slope_of_the_growth_along_the_survey():
    """By the varied key itself: differences of neighbouring points, of the fourth order."""
    values = [1.0 + 1e-3 * place for place in (-2, -1, 0, 1, 2)]
    found = st.squeal_survey("weak-pressure", {"friction": values}, by=["friction"], **BRIEF)
    for name, slope in (("growth_rate", "d_growth_rate"), ("frequency", "d_frequency")):
        low2, low, _, high, high2 = found[name].values
        by_value = difference([low2, low, high, high2], 1e-3)
        np.testing.assert_allclose(found[slope].values[2, :, 0], by_value, rtol=1e-6)
    table = list(csv.DictReader(io.StringIO(survey_table(found))))
    column = [float(row["d_growth_rate by friction"]) for row in table]
    assert column == found.d_growth_rate.values[np.isfinite(found.growth_rate.values)].ravel().tolist()
    assert found.d_growth_rate.attrs["units"] == "1/s"
    assert found.parameter_units.values.tolist() == ["1"]


def test_a_wrong_key_is_refused_before_any_point_and_a_value_of_zero_at_its_point():
    with pytest.raises(ScenarioError, match="nothing"):
        st.squeal_survey("weak-pressure", {"friction": [0.9]}, by=["nothing"], **BRIEF)
    for wrong, words in (("friction", "by must be a list of keys"), (["friction"] * 2, "by must be different")):
        with pytest.raises(ValueError, match=words):
            st.squeal_survey("weak-pressure", {"friction": [0.9]}, by=wrong, **BRIEF)
    with pytest.raises(
        ValueError, match=r"by must be numbers that are given, got 'coulomb' for contact\.friction\.law"
    ):
        st.squeal_survey("weak-pressure", {"friction": [0.9]}, by=["contact.friction.law"], **BRIEF)
    found = st.squeal_survey(
        "weak-pressure",
        {"friction": [0.9]},
        by=["slider.damping.ratio"],
        overrides={"slider.damping.ratio": 0.0},
        **BRIEF,
    )
    assert "be numbers other than 0" in found.message.item()
    assert np.isnan(found.d_growth_rate.values).all()
    assert float(found.growth_rate.max()) > 0.0


def test_a_survey_without_keys_has_no_derivatives():
    found = st.squeal_survey("weak-pressure", {"friction": [0.9]}, **BRIEF)
    assert "d_growth_rate" not in found
    assert " by " not in survey_table(found).splitlines()[0]
