"""Views in space: bodies, colours and contact points are those of the film."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from matplotlib.figure import Figure

import stridula as st
from stridula import plot
from stridula.cards import VIEW
from stridula.integration.settings import Given
from stridula.plot import space_films
from stridula.plot.mode_films import FRAMES
from stridula.plot.motion import motion_of
from stridula.plot.scenes import Scene
from stridula.records.variables import STATUS_WORDS

pyvista = pytest.importorskip("pyvista")
START, DURATION, FRAME = 0.018, 4e-4, 4e-5


@pytest.fixture(autouse=True)
def off_screen(monkeypatch):
    """Open no window."""
    monkeypatch.setattr(pyvista, "OFF_SCREEN", True)
    yield
    pyvista.close_all()


@pytest.fixture(scope="module")
def rig():
    """Return the pin on a disc."""
    return st.load_scenario("pin-on-disc")


def dataset(plotter, name):
    return plotter.actors[name].mapper.dataset


def words_of(plotter):
    """Return the text in the upper left corner."""
    return plotter.actors["words"].GetText(2)


def slide_to(plotter, frame):
    slider = plotter.widgets.slider_widgets[0]
    slider.GetRepresentation().SetValue(frame)
    slider.InvokeEvent("InteractionEvent")


def test_at_rest_bodies_and_contacts_are_where_they_are(rig):
    plotter = plot.view(rig.system)
    for body in rig.system.bodies:
        rest = body.drawn_at_rest.swept
        shown = dataset(plotter, rig.system.body_name(body))
        np.testing.assert_allclose(shown.points, rest.place, rtol=1e-6, atol=1e-9)
        assert shown.n_cells == len(rest.polygons)
    ends = [contact.placed_end for contact in rig.system.contacts]
    places = [end.body.place(end.position) for end in ends]
    np.testing.assert_allclose(dataset(plotter, "contacts").points, places, rtol=1e-6)
    # The picture has the pale colour of bodies, dark points and a white background.
    picture = plotter.screenshot(return_img=True)
    assert (picture == 255).all(axis=2).mean() > 0.3
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 50


def test_motion_colours_and_points_are_those_of_the_film(rig):
    plotter = plot.view(rig.system, START, DURATION, scheme=rig.scheme, step=rig.step)
    motion = motion_of(rig.system, (START, DURATION), FRAME, Given(scheme=rig.scheme, step=rig.step), velocities=True)
    times = space_films.exaggeration_of(rig.system, motion.modes, None)
    scene = Scene(Figure(), (0.0, 0.0, 1.0, 1.0), rig.system, motion.modes, times, VIEW)
    title, last = "velocity outwards [m/s]", motion.modes.frames - 1
    for frame in (0, last, 3):
        slide_to(plotter, frame)
        scene.show(frame, np.atleast_1d(motion.run.status.values[frame]))
        first = 0
        for one in scene.bodies:
            shown = dataset(plotter, one.name)
            places = one.surface.polygons[one.seen]
            corners = scene._polygons(frame)[first : first + len(places), : places.shape[1]]
            np.testing.assert_allclose(shown.points[places], corners, rtol=1e-5, atol=1e-7)
            values = scene.values[first : first + len(places)]
            np.testing.assert_allclose(shown.cell_data[title][one.seen], values, rtol=1e-5, atol=1e-9)
            first += len(places)
        for word in STATUS_WORDS:
            marked = np.transpose(scene.markers[word].get_data_3d()).reshape(-1, 3)
            assert (word in plotter.actors) == bool(len(marked))
            if len(marked):
                np.testing.assert_allclose(dataset(plotter, word).points, marked, rtol=1e-5, atol=1e-7)
        assert f"{1e3 * float(motion.run.time[frame]):.3f} ms" in words_of(plotter)
    # Another frame differs.
    assert np.abs(scene._polygons(0) - scene._polygons(last)).max() > 1e-4
    low, high = plotter.actors["disc"].mapper.scalar_range
    assert high == -low == pytest.approx(scene.moved.largest_velocity, rel=0.5)
    assert plotter.actors["disc"].mapper.lookup_table.cmap.name == "RdBu_r"


def test_a_mode_goes_round_once(rig):
    theory = st.sliding_stability(rig.system)
    number = int(np.argmax(theory.growth_rate.values))
    plotter = plot.view_mode(rig.system, theory, number)
    rest = rig.system.track.drawn_at_rest.swept.place
    name = rig.system.body_name(rig.system.track)
    first = dataset(plotter, name).points.copy()
    slide_to(plotter, FRAMES // 2)
    half = dataset(plotter, name).points.copy()
    np.testing.assert_allclose(0.5 * (first + half), rest, atol=1e-6)
    assert np.abs(first - half).max() > 0.0
    assert plotter.actors["disc"].mapper.scalar_range == (-1.0, 1.0)
    largest = []
    for frame in range(FRAMES):
        slide_to(plotter, frame)
        largest += [np.abs(dataset(plotter, one).active_scalars).max() for one in ("disc", "pin")]
    assert max(largest) == pytest.approx(1.0, rel=1e-6)
    assert f"{float(theory.frequency[number]):.6g} Hz" in words_of(plotter)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda rig: plot.view(rig.system, 0.0, 1.0), "duration must give from 2 to 5000 frames"),
        (lambda rig: plot.view(rig.system, 0.0, 1e-3, slowdown=0.0), "slowdown must be above 0"),
        (lambda rig: plot.view(rig.system, view=3.0), "view must be an elevation and an azimuth"),
        (
            lambda rig: plot.view(st.load_scenario("squeal").system),
            "system must have a SolidBody or an AxisymmetricBod",
        ),
    ],
)
def test_bad_input_is_one_line(rig, call, message):
    with pytest.raises(ValueError) as caught:
        call(rig)
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


def test_without_pyvista_one_line_reports_it(rig, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(
        ImportError,
        match=r'^views need pyvista, which is not installed: pip install "\.\[view\]" in the source folder$',
    ):
        plot.view(rig.system)
