"""Mode shapes: panels show the displacements of modes, with frequency and damping."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.quiver import Quiver
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import stridula as st
from stridula import plot
from stridula.plot import shapes_of_modes

STEEL = st.Material(2.1e11, 7800.0, 0.3)
BEAM = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.01), 0.8, bending_modes=4, axial_modes=2, damping=0.01)
PLATE = st.ModalPlate(STEEL, 0.002, 0.4, 0.3, bending_modes=(3, 3), damping=0.005, in_plane=True)


def panels(figure, most=None):
    return figure.axes[:most]


def test_panels_of_a_beam_are_its_sines():
    figure = plot.mode_shapes(BEAM, [1, 4], title="beam")
    bending, axial = panels(figure)
    for axes, harmonic, row in ((bending, 2, 0), (axial, 1, 1)):
        across, along = axes.get_lines()[1:]
        x, shape = (across, along)[row].get_data()
        known = np.sin(harmonic * np.pi * x / 0.8)
        np.testing.assert_allclose(np.abs(shape), np.abs(known) / np.abs(known).max(), atol=1e-12)
        assert not np.any((along, across)[row].get_ydata())
        assert axes.get_xlabel() == "place on the axis [m]"
    frequency = BEAM.modes().frequency[1]
    assert bending.get_title() == f"mode 1, {frequency:.5g} Hz\ndamping ratio 1 %"


def test_displacements_of_a_beam_that_leans_are_along_and_across_its_own_axis():
    rod = st.FiniteElementBeam(STEEL, st.Circle(0.01), 0.3, 0.6, root_support="clamped")
    (axes,) = panels(plot.mode_shapes(rod, [0]))
    across, along = axes.get_lines()[1:]
    assert np.abs(across.get_ydata()).max() == pytest.approx(1.0)
    assert np.abs(along.get_ydata()).max() < 1e-9
    assert across.get_ydata()[-1] == pytest.approx(0.0, abs=1e-12)


def test_a_plate_is_coloured_by_its_normal_and_has_arrows_in_its_plane():
    bending = PLATE.harmonics[0]
    figure = plot.mode_shapes(PLATE, [1, bending])
    normal, in_plane = panels(figure, 2)
    (mesh,) = [one for one in normal.collections if isinstance(one, QuadMesh)]
    values = np.reshape(mesh.get_array(), (-1, np.unique(mesh.get_coordinates()[..., 0]).size))
    assert np.abs(values).max() == pytest.approx(1.0)
    places = mesh.get_coordinates()
    known = PLATE.shapes(places[..., 0], places[..., 1])[..., 1]
    np.testing.assert_allclose(values, known / np.abs(known).max(), atol=1e-12)
    (arrows,) = [one for one in in_plane.collections if isinstance(one, Quiver)]
    moved = PLATE.in_plane_shapes(arrows.X, arrows.Y)[..., 0]
    np.testing.assert_allclose(np.stack([arrows.U, arrows.V], axis=1), moved, atol=1e-12)
    assert figure.axes[-1].get_ylabel() == "displacement over the largest [1]"
    assert len(plot.mode_shapes(PLATE, [bending]).axes) == 1, "arrows have no bar of colours"


def test_the_lowest_six_that_vibrate_are_drawn_by_default():
    free = st.FiniteElementBeam(STEEL, st.Circle(0.01), 0.3, root_support="free")
    titles = [axes.get_title() for axes in panels(plot.mode_shapes(free))]
    assert [title.split(",")[0] for title in titles] == [f"mode {k}" for k in range(3, 9)]
    assert plot.mode_shapes(free, [0]).axes[0].get_title() == "mode 0, rigid"


@pytest.fixture(scope="module")
def block():
    return st.SolidBody.block((0.04, 0.01, 0.02), (2, 1, 1), STEEL, cutoff=40e3, fixed=["left"], damping=0.02)


def test_a_body_in_space_is_deformed_by_its_mode(block):
    figure = plot.mode_shapes(block, [0, 1])
    surface = block.drawn
    largest = np.linalg.norm(surface.shapes[..., 1], axis=1).max()
    size = shapes_of_modes.SHARE * np.ptp(surface.place, axis=0).max()
    known = surface.place + size * surface.shapes[..., 1] / largest
    (sides,) = [one for one in figure.axes[1].collections if isinstance(one, Poly3DCollection)]
    drawn = np.concatenate([np.asarray(one).reshape(-1, 3) for one in sides._faces])
    away = np.linalg.norm(drawn[:, None] - known[None], axis=2).min(axis=1)
    assert away.max() < 1e-12
    assert np.abs(known - surface.place).max() > 0.5 * size
    words = [text.get_text() for text in figure.texts]
    assert words[-1] == f"mode 1, {block.modes().frequency[1]:.5g} Hz\ndamping ratio 2 %"


def test_modes_of_a_system_are_those_of_sliding():
    system = st.load_scenario("squeal").system
    theory = st.sliding_stability(system)
    figure = plot.mode_shapes(system, [0, 3], theory=theory)
    for axes, number in zip(figure.axes, (0, 3), strict=True):
        assert axes.get_title().startswith(f"mode {number}, {float(theory.frequency[number]):.5g} Hz\n")
        assert axes.get_aspect() == 1.0
        moved = [line.get_xydata() for line in axes.get_lines()]
        # Each line at rest, then deformed.
        apart = max(np.abs(moved[k + 1] - moved[k]).max() for k in (0, 2))
        extent = np.ptp(np.concatenate([moved[0], moved[2]]), axis=0).max()
        assert apart == pytest.approx(shapes_of_modes.SHARE * extent)
    assert [axes.get_title() for axes in plot.mode_shapes(system, [3]).axes] == [figure.axes[1].get_title()]


def test_modes_that_grow_come_first():
    mass, law = st.PointMass(1.0), st.LinearWeakening(0.4, 0.1, 0.1)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.5), friction=law)
    system = st.System(contact, [st.Force(mass.centre, y=-10.0)], [st.Spring(mass.centre, stiffness=4.0)])
    theory = st.sliding_stability(system)
    grows = np.flatnonzero(theory.unstable.values & (theory.frequency.values > 0.0))
    assert grows.size == 1
    (axes,) = plot.mode_shapes(system).axes
    rate = float(theory.growth_rate[grows[0]])
    assert axes.get_title().endswith(f"grows by {rate:.4g} /s")


@pytest.mark.parametrize(
    ("what", "options", "message"),
    [
        (3.0, {}, "what must be a body or a System"),
        (st.PointMass(1.0), {}, "what must be a beam, a plate, or a body whose surface is drawn"),
        (BEAM, {"numbers": [6]}, r"numbers\[0\] must be at most 5"),
        (BEAM, {"numbers": []}, "numbers must be a list of numbers of modes"),
        (BEAM, {"numbers": "all"}, "numbers must be a list of numbers of modes"),
        (BEAM, {"numbers": [0] * 25}, "numbers must be at most 24 modes, got 25"),
        (BEAM, {"theory": 1}, "theory must be used with a System"),
    ],
)
def test_bad_arguments_are_refused(what, options, message):
    with pytest.raises(ValueError, match=message):
        plot.mode_shapes(what, **options)
