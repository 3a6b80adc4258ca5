"""Root loci and critical values: closed forms of two coupled modes, tracking, bad arguments, the figure."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula import plot
from stridula.plot.loci import _without_decays as without_decays
from stridula.studies.loci import critical_values
from stridula.verification.systems.mode_coupling import hoffmann, sinou, sinou_limit


def hoffmann_at(friction: float) -> st.System:
    return hoffmann().system(friction)


def test_frequencies_follow_the_closed_form_and_lock_in():
    grid = np.linspace(0.0, 1.0, 41)
    loci = st.root_loci(hoffmann_at, "friction", grid)
    # w² = 2 +- sqrt(1 - 4 mu / 3).
    root = np.sqrt(1.0 - 4.0 * grid[grid < 0.75] / 3.0)
    low, high = np.sort(2.0 * np.pi * loci["frequency"].values[grid < 0.75], axis=1).T
    np.testing.assert_allclose(low, np.sqrt(2.0 - root), rtol=1e-9)
    np.testing.assert_allclose(high, np.sqrt(2.0 + root), rtol=1e-9)
    after = loci.isel(friction=grid > 0.751)
    np.testing.assert_allclose(after["frequency"][:, 0], after["frequency"][:, 1], rtol=1e-9)
    growth = np.sqrt(2.0 + 1j * np.sqrt(4.0 * grid[grid > 0.751] / 3.0 - 1.0)).imag
    np.testing.assert_allclose(after["growth_rate"].max("mode"), growth, rtol=1e-9)
    assert after["unstable"].sum("mode").values.tolist() == [1] * after.sizes["friction"]


def test_a_mode_keeps_its_number_across_a_crossing():
    # Two uncoupled modes cross without interaction: each continues straight.
    def crossing(value: float) -> st.System:
        stiffness = np.diag([1.0, (0.5 + value) ** 2, 4.0])
        body = st.ReducedBody(np.eye(3), stiffness, points={"foot": (None, 2)}, translation=np.zeros((2, 3)))
        contact = st.PointContact(body.at("foot"), st.RigidTrack(velocity=-1.0))
        return st.System(contact, [st.Force(body.at("foot"), y=-1.0)])

    grid = np.linspace(0.0, 1.0, 21)
    loci = st.root_loci(crossing, "value", grid)
    frequency = 2.0 * np.pi * loci["frequency"].values
    steady = np.argmin(np.ptp(frequency, axis=0))
    np.testing.assert_allclose(frequency[:, steady], 1.0)
    np.testing.assert_allclose(frequency[:, 1 - steady], 0.5 + grid)


def test_a_scenario_is_varied_by_key_and_unit():
    loci = st.root_loci("weak-pressure", "angle", [-50.0, -45.0], units="deg", highest=4e3)
    assert loci["angle"].attrs["units"] == "deg"
    modes = st.sliding_stability(st.load_scenario("weak-pressure", {"angle": "-50 deg"}).system)
    expected = modes["frequency"].values[modes["frequency"].values <= 4e3]
    found = loci["frequency"].sel(angle=-50.0).dropna("mode").values
    np.testing.assert_allclose(np.sort(found), np.sort(expected), rtol=1e-9, atol=1e-9)
    assert found.max() <= 4e3


def test_critical_value_is_bracketed():
    found = st.critical_value(hoffmann_at, "friction", 0.5, 1.0, tolerance=1e-10)
    assert float(found["value"]) == pytest.approx(0.75, abs=1e-10)
    assert float(found["stable"]) < float(found["unstable"]) <= float(found["stable"]) + 1e-10
    assert 2.0 * np.pi * float(found["frequency"]) == pytest.approx(sqrt(2.0), rel=1e-4)


@pytest.mark.parametrize("damping", [(0.0, 0.0), (0.02, 0.02), (0.02, 0.06)])
def test_critical_value_with_damping(damping):
    found = st.critical_value(lambda mu: sinou(damping).system(mu), "friction", 0.1, 0.5, tolerance=1e-8)
    assert float(found["value"]) == pytest.approx(sinou_limit(damping), abs=1e-7)


def test_a_mode_may_become_stable_again():
    # More damping on both modes stabilises a pair that would flutter.
    found = st.critical_value(lambda e: sinou((e, e)).system(0.3), "damping", 0.001, 0.2, tolerance=1e-6)
    assert float(found["unstable"]) < float(found["stable"])
    assert sinou_limit((float(found["value"]),) * 2) == pytest.approx(0.3, rel=1e-5)


def test_every_change_of_stability_is_found_along_loci():
    loci = st.root_loci(hoffmann_at, "friction", np.linspace(0.5, 1.0, 6))
    found = critical_values(loci, lambda low, high: st.critical_value(hoffmann_at, "friction", low, high))
    assert [float(one["value"]) for one in found] == [pytest.approx(0.75, abs=1e-6)]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: st.root_loci(hoffmann_at, "friction", [1.0, 0.5]),
            "values must be at least 2 increasing finite numbers",
        ),
        (lambda: st.root_loci(hoffmann_at, "friction", [1.0]), "values must be at least 2 increasing finite numbers"),
        (
            lambda: st.root_loci(hoffmann_at, "friction", [0.0, np.nan]),
            "values must be at least 2 increasing finite numbers",
        ),
        (lambda: st.root_loci(hoffmann_at, "friction", "much"), "values must be at least 2 increasing finite numbers"),
        (lambda: st.root_loci("squeal", "frition", [0.1, 0.2]), "did you mean 'friction'"),
        (
            lambda: st.root_loci(hoffmann_at, "frequency", [0.1, 0.2]),
            "key must not have the name of a result of the loci",
        ),
        (
            lambda: st.root_loci("squeal", "friction", [0.1, 0.2], overrides={"friction": 1.0}),
            "key must be set or varied, got both for 'friction'",
        ),
        (lambda: st.root_loci("squeal", "angle", [0.1, 0.2], units="kg"), "slider.angle must be a number in rad or"),
        (lambda: st.root_loci(hoffmann_at, "friction", [0.1, 0.2], highest=0.0), "highest must be above 0"),
        (lambda: st.critical_value(hoffmann_at, "friction", 0.1, 0.2), "got stable at 0.1 and stable at 0.2"),
        (lambda: st.critical_value(hoffmann_at, "friction", 0.8, 0.9), "got unstable at 0.8 and unstable at 0.9"),
        (lambda: st.critical_value("squeal", "friction", 0.5, 1.5), "got stable at 0.5 and held at 1.5"),
        (lambda: st.critical_value(hoffmann_at, "friction", 1.0, 0.5), "high must be above low"),
        (lambda: st.critical_value(hoffmann_at, "friction", 0.5, 1.0, tolerance=0.0), "tolerance must be above 0"),
    ],
)
def test_bad_arguments(call, message):
    with pytest.raises(ValueError) as error:
        call()
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_untracked_modes_still_count():
    loci = st.root_loci(hoffmann_at, "friction", np.linspace(0.5, 1.0, 6), highest=1e-3)
    assert loci.sizes["mode"] == 0
    assert loci["unstable_modes"].values.tolist() == [0, 0, 0, 1, 1, 1]
    assert loci["equilibria"].values.tolist() == ["one"] * 6
    (found,) = critical_values(loci, lambda low, high: st.critical_value(hoffmann_at, "friction", low, high))
    assert float(found["value"]) == pytest.approx(0.75, abs=1e-6)


def test_a_parameter_may_be_a_whole_number():
    loci = st.root_loci("squeal", "elements", [4, 5], highest=1e3)
    assert loci["elements"].values.tolist() == [4.0, 5.0]


def test_labels_of_critical_values_do_not_cover_each_other():
    loci = st.root_loci(hoffmann_at, "friction", np.linspace(0.0, 1.0, 5))
    (real,) = critical_values(loci, lambda low, high: st.critical_value(hoffmann_at, "friction", low, high))
    near = [real.assign(value=value) for value in (0.5, 0.52, 0.54, 0.99)]
    above = plot.root_loci(loci, near).axes[0]
    heights = [text.xy[1] for text in above.texts]
    assert len(set(heights[:3])) == 3
    assert [text.get_horizontalalignment() for text in above.texts] == ["left", "left", "left", "right"]


def test_other_datasets_are_refused():
    with pytest.raises(ValueError, match="loci must be the result of root_loci"):
        plot.root_loci(st.critical_value(hoffmann_at, "friction", 0.5, 1.0))
    with pytest.raises(ValueError, match="loci must be a Dataset"):
        plot.root_loci(0.5)


def test_figure_shows_modes_bands_and_critical_values():
    loci = st.root_loci("weak-pressure", "friction", np.linspace(0.6, 2.0, 8), highest=4e3)
    critical = [st.critical_value("weak-pressure", "friction", 0.6, 1.0)]
    figure = plot.root_loci(loci, critical)
    above, below = figure.axes
    assert below.get_xlabel() == "friction"
    assert above.get_ylabel() == "frequency [Hz]"
    assert [text.get_text() for text in above.get_legend().get_texts()] == [
        "decays, not within a period",
        "grows",
        "jammed",
    ]
    assert any("0.877" in text.get_text() for text in above.texts)
    # The loci themselves, thin and thick, then one line for each critical value.
    assert len(above.lines) >= 2 * loci.sizes["mode"] + 1


def test_modes_that_decay_within_a_period_are_not_drawn_and_the_legend_says_so():
    """A dashpot of contacts that decays at a rate of 1e8 1/s would hide all that vibrates."""
    loci = st.root_loci(hoffmann_at, "friction", np.linspace(0.0, 1.0, 5))
    above = plot.root_loci(loci).axes[0]
    assert [one.get_text() for one in above.get_legend().get_texts()] == ["decays", "grows"]
    frequency = [[100.0, 50.0, 0.0, 5e7], [100.0, 50.0, 0.0, 5e7]]
    growth = [[-1.0, -60.0, -5.0, -1.0], [1.0, -60.0, -5.0, 2.0]]
    four = xr.Dataset(
        {name: (("mu", "mode"), one) for name, one in (("frequency", frequency), ("growth_rate", growth))}
    ).assign(unstable=(("mu", "mode"), np.array(growth) > 0.0))
    drawn, hidden = without_decays(four)
    assert hidden
    for name in ("frequency", "growth_rate"):
        np.testing.assert_array_equal(np.isfinite(drawn[name].values), [[True, False, False, True]] * 2)
    swift = loci.assign(frequency=loci["frequency"].copy(), growth_rate=loci["growth_rate"].copy())
    swift["frequency"][:, 1], swift["growth_rate"][:, 1] = 1e7, -1e8
    swift["unstable"][:, 1] = False
    above = plot.root_loci(swift).axes[0]
    assert above.get_ylim()[1] < 2.0 * float(loci["frequency"].max())
    assert above.get_legend().get_texts()[0].get_text() == "decays, not within a period"
