"""Maps over faces in contact: recorded values are drawn at their places."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from PIL import Image
from scipy.spatial.transform import Rotation

import stridula as st
from stridula import plot
from stridula.analysis import surface
from stridula.plot import surfaces
from stridula.plot.colours import STATUS_COLOURS

STEP = 1e-5


def face(places, values, samples=1):
    """Return a result like that of `analysis.surface`, with a pressure that doubles from sample to sample."""
    values = np.multiply.outer(2.0 ** np.arange(samples), np.asarray(values, dtype=float))
    share = np.zeros((*values.shape, 3))
    share[..., 0], share[..., 2] = 0.25, 0.75
    along = ("time", "point", "tangent")
    both = np.stack([0.6 * values, 0.8 * values], axis=2)
    return xr.Dataset(
        {
            "pressure": (("time", "point"), values, {"units": "Pa", "long_name": "normal pressure"}),
            "shear": (along, 0.1 * both, {"units": "Pa", "long_name": "shear on the track"}),
            "slip_velocity": (along, both, {"units": "m/s", "long_name": "slip velocity"}),
            "status_share": (("time", "point", "contact_status"), share),
        },
        {
            "time": STEP * np.arange(1, samples + 1),
            "place": (("point", "axis"), np.asarray(places, dtype=float)),
            "area": ("point", np.full(len(places), 1e-4)),
        },
        {"surface": "lining"},
    )


def grid(columns=6, rows=4):
    """Return places of a flat face across y."""
    x, z = np.meshgrid(0.01 * np.arange(columns), 0.01 * np.arange(rows) + 0.1)
    return np.stack([x.ravel(), np.full(x.size, 0.3), z.ravel()], axis=1)


def drawn(axes):
    """Return the triangles of a map, and its values."""
    (colours,) = axes.collections
    return colours._triangulation, np.asarray(colours.get_array())


def test_the_points_of_the_face_have_their_pressure_where_they_are():
    places = grid()
    axes, bar = plot.surface(face(places, places[:, 0] + 1.0)).axes
    triangles, values = drawn(axes)
    np.testing.assert_allclose(triangles.x, places[:, 0])
    np.testing.assert_allclose(triangles.y, places[:, 2])
    np.testing.assert_allclose(values, places[:, 0] + 1.0)
    (marks,) = axes.get_lines()
    np.testing.assert_allclose(marks.get_xydata(), places[:, [0, 2]])
    assert (axes.get_xlabel(), axes.get_ylabel(), bar.get_ylabel()) == ("x [m]", "z [m]", "normal pressure [Pa]")
    assert bar.get_ylim() == pytest.approx((0.0, 1.05))


def test_a_time_shows_its_interval_and_a_span_the_mean():
    found = face(grid(), np.ones(24), samples=4)
    assert drawn(plot.surface(found, time=2.5 * STEP).axes[0])[1][0] == 4.0
    assert drawn(plot.surface(found, time=3.0 * STEP).axes[0])[1][0] == 4.0
    assert drawn(plot.surface(found, span=(1.5 * STEP, 3.5 * STEP)).axes[0])[1][0] == 3.0
    figure = plot.surface(found)
    assert drawn(figure.axes[0])[1][0] == 15.0 / 4.0
    assert figure.get_suptitle() == "lining, mean from 0.01 to 0.04 ms"


def test_slip_and_shear_are_sizes_of_vectors():
    found = face(grid(), np.full(24, 3.0))
    np.testing.assert_allclose(drawn(plot.surface(found, "slip_velocity").axes[0])[1], 3.0)
    np.testing.assert_allclose(drawn(plot.surface(found, "shear").axes[0])[1], 0.3)


def test_the_status_has_a_map_for_each():
    *maps, bar = plot.surface(face(grid(), np.ones(24)), "status").axes
    assert [axes.get_title() for axes in maps] == list(STATUS_COLOURS)
    assert [drawn(axes)[1][0] for axes in maps] == [0.25, 0.0, 0.75]
    assert (bar.get_xlabel(), bar.get_xlim()) == ("share of time [1]", (0.0, 1.0))


def test_a_face_that_leans_is_drawn_in_its_own_plane():
    places = grid() @ Rotation.from_rotvec([0.3, -0.8, 0.5]).as_matrix().T
    axes = plot.surface(face(places, np.ones(24))).axes[0]
    triangles, _ = drawn(axes)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("along the face [m]", "across the face [m]")
    assert [np.ptp(triangles.x), np.ptp(triangles.y)] == pytest.approx([0.05, 0.03])


def test_a_square_face_is_drawn_along_the_world():
    axes = plot.surface(face(grid(5, 5), np.ones(25))).axes[0]
    triangles, _ = drawn(axes)
    assert {axes.get_xlabel(), axes.get_ylabel()} == {"x [m]", "z [m]"}
    assert [np.ptp(triangles.x), np.ptp(triangles.y)] == pytest.approx([0.04, 0.04])


def test_colours_do_not_bridge_gaps_in_the_face():
    """Two strips far apart."""
    places = np.concatenate([grid(8, 2), grid(8, 2) + np.array([0.0, 0.0, 0.06])])
    triangles, _ = drawn(plot.surface(face(places, np.ones(32))).axes[0])
    heights = triangles.y[triangles.get_masked_triangles()]
    assert np.ptp(heights, axis=1).max() == pytest.approx(0.01)
    assert len(heights) == 2 * 14


def test_colours_keep_to_the_inner_edge_of_a_sector():
    radius, angle = np.meshgrid([0.08, 0.09, 0.1], np.linspace(-0.4, 0.4, 9))
    places = np.stack([radius * np.sin(angle), 0.0 * angle, radius * np.cos(angle)], axis=-1).reshape(-1, 3)
    triangles, _ = drawn(plot.surface(face(places, np.ones(27))).axes[0])
    assert len(triangles.get_masked_triangles()) == 2 * 2 * 8


def test_frames_of_a_film_are_means(monkeypatch, tmp_path):
    """At 25 frames per second and slowed down 2000 times, a frame is two samples."""
    found, seen = face(grid(), np.ones(24), samples=8), []
    whole = surfaces.write_film

    def watched(picture, *rest):
        for frame in range(picture.frames):
            picture.show(frame)
            seen.append((drawn(picture.figure.axes[0])[1][0], picture.figure.get_suptitle().split("\n")[1]))
        whole(picture, *rest)

    monkeypatch.setattr(surfaces, "write_film", watched)
    film = plot.animate_surface(found, tmp_path / "a.gif", slowdown=2100.0)
    assert seen == [(1.5, "t = 0.020 ms"), (6.0, "t = 0.040 ms"), (24.0, "t = 0.060 ms"), (96.0, "t = 0.080 ms")]
    assert str(film).endswith("4 frames, 0.08 ms from 0 s, slowed down 2000 times")
    with Image.open(tmp_path / "a.gif") as image:
        assert (image.n_frames, image.size) == (4, (960, 600))


def test_the_face_of_a_run():
    """A block on a plane: the pressures drawn carry the load."""
    mesh = st.SolidMesh.block((0.04, 0.01, 0.02), (2, 1, 1))
    pad = st.SolidBody(mesh, st.Material(5e9, 2500.0, 0.3), contact_faces=["bottom"], cutoff=20e3, damping=0.05)
    touching = st.SurfaceContact(
        pad, "bottom", st.RigidTrack(velocity=0.1), friction=st.Coulomb(0.2), stiffness=1e12, name="sole"
    )
    springs = [st.Spring(pad.at("top"), stiffness=1e6, direction=way) for way in "xz"]
    system = st.System(touching, [st.Force(pad.at("top"), y=-80.0), st.InitialEquilibrium()], springs)
    found = surface(st.simulate(system, 2e-4), touching)
    np.testing.assert_allclose(found.status_share.sum("contact_status"), 1.0)
    np.testing.assert_allclose(found.status_share.sel(contact_status="sliding"), 1.0)
    triangles, pressure = drawn(plot.surface(found, time=1e-4).axes[0])
    assert pressure @ touching.areas == pytest.approx(80.0, rel=1e-6)
    assert [np.ptp(triangles.x), np.ptp(triangles.y)] == pytest.approx(np.ptp(touching.points.place, axis=0)[[0, 2]])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda found: plot.surface(found.drop_vars("place")), "found must be the result of analysis.surface"),
        (lambda found: plot.surface(None), "found must be a Dataset"),
        (lambda found: plot.surface(found.isel(point=slice(2))), "found must have at least 3 points, got 2"),
        (lambda found: plot.surface(found, "heat"), "quantity must be one of pressure, slip_velocity, shear, status"),
        (lambda found: plot.surface(found, time=1.0), "time must be from 0 to 8e-05 s, got 1.0"),
        (lambda found: plot.surface(found, time=-1.0), "time must be from 0 to 8e-05 s, got -1.0"),
        (lambda found: plot.surface(found, time=1e-5, span=(0.0, 1.0)), "time must be left out with a span"),
        (lambda found: plot.surface(found, span=(1.0, 2.0)), "span must hold a sample"),
        (lambda found: plot.surface(found, span=(2.0, 1.0)), "span must end after it starts"),
        (lambda found: plot.surface(found, span=3.0), "span must be a start and an end"),
        (lambda found: plot.animate_surface(found, "a.avi"), "out must end in one of .mp4, .gif"),
        (lambda found: plot.animate_surface(found, "a.gif", slowdown=0.0), "slowdown must be above 0"),
        (lambda found: plot.animate_surface(found, "a.gif", slowdown=1.0), "slowdown must give from 2 to 5000 frames"),
        (lambda found: plot.animate_surface(found, "a.gif", span=(0.0, 1.5e-5)), "span must hold at least 2 samples"),
    ],
)
def test_bad_input_is_one_line(call, message, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((ValueError, TypeError)) as caught:
        call(face(grid(), np.ones(24), samples=8))
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)
    assert not any(tmp_path.iterdir())
