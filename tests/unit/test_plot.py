"""Figures: what is drawn is what the law and the record say."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula import analysis, plot

LAWS = {
    "Coulomb, 0.4": st.Coulomb(0.4),
    "Static-kinetic, 0.4 static, 0.25 kinetic": st.StaticKinetic(0.4, 0.25),
    "Stribeck, 0.5 to 0.3 over 0.01 m/s": st.Stribeck(0.5, 0.3, 0.01, viscous=1.0),
    "Exponential, 0.4 to 0.2 over 0.1 m/s": st.ExponentialWeakening(0.4, 0.2, 0.1),
    "Linear, 0.4 falling by 0.3 s/m to 0.1": st.LinearWeakening(0.4, 0.3, 0.1),
}
BRISTLES = st.LuGre(1.5, 1.0, 1e-3, 1e5, 316.0, 0.4)
AGEING = st.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6)


def lines(figure):
    """Return the axes and the lines of a figure of friction: backward, forward, rest if it is drawn."""
    (axes,) = figure.axes
    return axes, [line.get_xydata() for line in axes.get_lines()]


@pytest.mark.parametrize("title", LAWS)
def test_a_law_is_drawn_on_both_sides_and_as_a_jump_where_it_sticks(title):
    law = LAWS[title]
    axes, (backward, forward, rest, _) = lines(plot.friction(law))
    np.testing.assert_allclose(forward[:, 1], law.coefficient_at(forward[:, 0]))
    np.testing.assert_allclose(backward[:, 1], -law.coefficient_at(-backward[:, 0]))
    assert backward[:, 0].max() < 0.0 < forward[:, 0].min()
    held = float(law.coefficient_at(np.zeros(1))[0])
    np.testing.assert_array_equal(rest, [[0.0, -held], [0.0, held]])
    assert axes.get_title() == title
    assert axes.get_xlabel() == "slip velocity [m/s]"
    assert axes.get_ylabel() == "tangential over normal force [1]"


def test_bristles_hold_on_a_dotted_line():
    axes, (_, forward, rest, _) = lines(plot.friction(BRISTLES))
    assert forward[0, 1] == pytest.approx(1.5, rel=1e-6)
    np.testing.assert_array_equal(rest[:, 1], [-1.5, 1.5])
    assert axes.get_lines()[2].get_linestyle() == ":"


def test_rate_and_state_goes_over_decades():
    axes, (_, forward) = lines(plot.friction(AGEING))
    assert axes.get_xscale() == "log"
    decade = np.interp([1e-5, 1e-4], *forward.T)
    assert decade[1] - decade[0] == pytest.approx(-0.005 * np.log(10.0), rel=1e-2)


def test_velocities_are_those_asked_for():
    _, (backward, forward, *rest) = lines(plot.friction(LAWS["Coulomb, 0.4"], [3.0, 1.0, 2.0]))
    assert list(forward[:, 0]) == [1.0, 2.0, 3.0]
    assert backward.size == 0
    assert len(rest) == 1, "rest is not in sight"
    _, (_, _, at_rest, _) = lines(plot.friction(LAWS["Coulomb, 0.4"], [0.0, 1.0]))
    np.testing.assert_array_equal(at_rest[:, 1], [0.0, 0.4])


@pytest.mark.parametrize(
    ("law", "velocities", "message"),
    [
        (0.4, None, "law must be a Coulomb or "),
        (LAWS["Coulomb, 0.4"], [1.0], "velocities must be a list of at least 2 finite numbers"),
        (LAWS["Coulomb, 0.4"], ["a", "b"], "velocities must be a list of at least 2 finite numbers"),
        (LAWS["Coulomb, 0.4"], [0.0, np.nan], "velocities must be a list of at least 2 finite numbers"),
        (AGEING, [-1.0, 1.0], "velocities must be at least 2 above 0 for rate and state"),
    ],
)
def test_what_cannot_be_drawn_is_told(law, velocities, message):
    with pytest.raises(ValueError, match=message):
        plot.friction(law, velocities)


@pytest.fixture(scope="module")
def two():
    mass, other = st.PointMass(1.0), st.PointMass(2.0)
    contacts = [
        st.PointContact(mass.centre, st.RigidTrack(), gap=1.0, name="never"),
        st.PointContact(other.centre, st.RigidTrack(velocity=0.1), friction=st.Coulomb(0.3), name="always"),
    ]
    system = st.System(contacts, [st.Force(other.centre, y=-5.0)])
    return st.simulate(system, 1e-3, probes=[st.Velocity(other.centre), st.Velocity(mass.centre, "x")])


def test_each_contact_is_a_line_with_its_name(two):
    figure = plot.timeline(two, ["normal_force", "velocity"])
    force, velocity = figure.axes
    np.testing.assert_array_equal([line.get_ydata() for line in force.get_lines()], two["normal_force"].values.T)
    assert [text.get_text() for text in force.get_legend().get_texts()] == ["never", "always"]
    assert len({line.get_color() for line in force.get_lines()}) == 2
    assert [text.get_text() for text in velocity.get_legend().get_texts()] == list(two["velocity_probe"].values)


def test_each_contact_has_its_ribbon_the_first_on_top(two):
    (axes,) = plot.timeline(two, ["status"]).axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["never", "always"]
    assert axes.get_yticks()[0] > axes.get_yticks()[1]
    boxes = {}
    for band in axes.collections:
        ends = band.get_datalim(axes.transData)
        if ends.height > 0.5 and band.get_array() is None and len(band.get_facecolor()):
            boxes[round(ends.y0)] = tuple(band.get_facecolor()[0])
    assert boxes[1] == pytest.approx(rgb("separated"))
    assert boxes[0] == pytest.approx(rgb("sliding"))


def rgb(status):
    from matplotlib.colors import to_rgba

    return to_rgba(plot.STATUS_COLOURS[status])


def test_one_line_has_no_legend():
    run = st.load_scenario("belt").simulate(duration=0.1)
    figure = plot.overview(run)
    assert [axes.get_legend() is None for axes in figure.axes] == [True, True, True, False]


@pytest.mark.parametrize(
    "measure",
    [
        lambda run: analysis.status_share(run, "sliding"),
        analysis.stops,
        analysis.settling_time,
        analysis.longest_unchanged,
        analysis.advance,
        lambda run: analysis.dominant_frequency(run["normal_force"]),
        lambda run: analysis.peak_level(run["normal_force"]),
    ],
)
def test_measures_ask_which_contact(two, measure):
    with pytest.raises(ValueError, match=r"must be of one contact, got those of 'never', 'always': choose one with "):
        measure(two)
    measure(two.sel(contact="always"))
