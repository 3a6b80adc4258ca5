"""Figures: the drawing agrees with the law and the record."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgba
from matplotlib.contour import ContourSet

import stridula as st
from stridula import analysis, plot
from stridula.plot.colours import FAILED_COLOUR, REGIME_COLOURS

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


def test_velocities_are_those_requested():
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
def test_bad_arguments_are_refused(law, velocities, message):
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
def test_measures_need_one_contact(two, measure):
    with pytest.raises(ValueError, match=r"must be of one contact, got those of 'never', 'always': choose one with "):
        measure(two)
    measure(two.sel(contact="always"))


def a_sweep(regimes, grows=None, kinds=None, x=(0.1, 0.2, 0.3), y=(10.0, 20.0)):
    """Return a result like that of a sweep over friction and angle, made by hand."""
    shape = (len(x), len(y))
    grows = np.zeros(shape) if grows is None else np.asarray(grows, dtype=float)
    kinds = np.full(shape, "sliding", dtype=object) if kinds is None else np.array(kinds, dtype=object)
    both = ("friction", "angle")
    data = {
        "regime": (both, np.array(regimes, dtype=object).reshape(shape)),
        "unstable_modes": (both, grows),
        "growth_rate": (both, np.where(grows > 0, 10.0 * np.arange(1.0, grows.size + 1).reshape(shape), -1.0)),
        "equilibrium": (both, kinds),
    }
    axes = {"friction": ("friction", list(x), {"units": "1"}), "angle": ("angle", list(y), {"units": "deg"})}
    return xr.Dataset(data, axes, {"title": "By hand"})


def drawn_map(found):
    """Return the axes, the colour of each cell over x and y, and the words of the legend."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = plot.regime_map(found)
        figure.canvas.draw()
    (axes,) = figure.axes
    mesh = next(one for one in axes.collections if isinstance(one, QuadMesh))
    colours = mesh.to_rgba(mesh.get_array()).transpose(1, 0, 2)
    return axes, colours, [text.get_text() for text in figure.legends[0].get_texts()]


def test_a_map_has_a_colour_for_each_regime_and_counts_them():
    found = a_sweep([["squeal", "squeal"], ["judder", ""], ["stable sliding", "squeal"]])
    axes, colours, words = drawn_map(found)
    for at, word in {(0, 0): "squeal", (1, 0): "judder", (2, 0): "stable sliding", (2, 1): "squeal"}.items():
        np.testing.assert_allclose(colours[at], to_rgba(REGIME_COLOURS[word]), atol=1e-6)
    np.testing.assert_allclose(colours[1, 1], to_rgba(FAILED_COLOUR), atol=1e-6)
    assert words == ["stable sliding (1)", "squeal (3)", "judder (1)", "failed (1)"]
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_title()) == ("friction", "angle [deg]", "By hand")
    assert axes.get_xlim() == pytest.approx((0.05, 0.35))


def test_bounds_of_linear_theory_lie_between_cells():
    kinds = [["sliding", "sliding"], ["sliding", "held"], ["held", "held"]]
    found = a_sweep(["squeal"] * 6, grows=[[0, 0], [2, 0], [2, 0]], kinds=kinds)
    axes, _, words = drawn_map(found)
    assert words[1:] == ["linear theory: bound of growth", "linear theory: bound of steady sliding"]
    growth, *_, sliding = (one for one in axes.collections if isinstance(one, ContourSet))
    (line,) = growth.get_paths()
    # Between the first two values of friction, as far as both slide: nothing grows where friction holds.
    corners = {(round(x, 6), round(y, 6)) for x, y in line.vertices.tolist()}
    assert {(0.15, 5.0), (0.15, 15.0)} <= corners
    assert {x for x, _ in corners} == {0.15}
    assert growth.get_linewidths()[0] > sliding.get_linewidths()[0]
    # Elsewhere it is the bound of sliding, beyond which the contact is held.
    assert (0.15, 25.0) in {(round(x, 6), round(y, 6)) for x, y in sliding.get_paths()[0].vertices.tolist()}


def test_a_mode_that_grows_everywhere_is_noted_and_has_contours():
    axes, _, words = drawn_map(a_sweep(["squeal"] * 6, grows=np.ones((3, 2))))
    assert words == ["squeal (6)", "linear theory: a mode grows everywhere", "its growth rate"]
    assert {text.get_text() for text in axes.texts} == {"20 /s", "30 /s", "50 /s"}


def test_all_cells_may_have_failed():
    _, colours, words = drawn_map(a_sweep([""] * 6, grows=np.full((3, 2), np.nan), kinds=[["", ""]] * 3))
    assert words == ["failed (6)"]
    np.testing.assert_allclose(colours, np.broadcast_to(to_rgba(FAILED_COLOUR), colours.shape))


def test_numbers_are_drawn_in_rising_order_and_words_as_they_come():
    regimes = ["squeal", "judder", "sticking", "stick-slip", "stable sliding", "squeal"]
    axes, colours, _ = drawn_map(a_sweep(regimes, x=(0.3, 0.1, 0.2), y=("guided", "clamped")))
    np.testing.assert_allclose(colours[0, 0], to_rgba(REGIME_COLOURS["sticking"]), atol=1e-6)
    np.testing.assert_allclose(colours[2, 1], to_rgba(REGIME_COLOURS["judder"]), atol=1e-6)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["guided", "clamped"]
    twice, _, _ = drawn_map(a_sweep(regimes, x=(0.1, 0.1, 0.1)))
    assert twice.get_xlim() == pytest.approx((-0.4, 0.6))


@pytest.mark.parametrize(
    ("found", "message"),
    [
        (3, "found must be a Dataset, got 3"),
        (xr.Dataset(), "over two parameters of at least 2 values each, got none"),
        (a_sweep(["squeal"] * 6).isel(angle=[0]), r"got {'friction': 3, 'angle': 1}"),
        (a_sweep(["squeal"] * 6).isel(angle=0), r"got {'friction': 3}"),
    ],
)
def test_other_datasets_are_refused_as_maps(found, message):
    with pytest.raises(ValueError, match=message):
        plot.regime_map(found)
