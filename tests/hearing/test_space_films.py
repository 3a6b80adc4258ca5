"""Pictures and films in space: bodies follow their modes, colours show velocities, points show statuses."""

from __future__ import annotations

import io
import pickle

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import stridula as st
from stridula import plot
from stridula.bodies.drawn_surfaces import drawn_of, drawn_table
from stridula.cards import VIEW
from stridula.integration.settings import Given
from stridula.plot import mode_films, space_films
from stridula.plot.colours import STATUS_COLOURS
from stridula.plot.motion import ModalMotion, motion_of
from stridula.plot.moved_bodies import surfaces_of
from stridula.plot.scenes import Scene
from stridula.plot.space_films import SpacePicture
from stridula.records import provenance
from stridula.records.variables import STATUS_WORDS

STEEL = st.Material(2.1e11, 7800.0, 0.3)
FRAME = 4e-5
ROOM = (0.0, 0.0, 1.0, 1.0)


@pytest.fixture(scope="module")
def rig():
    """Return the pin on a disc."""
    return st.load_scenario("pin-on-disc")


@pytest.fixture(scope="module")
def motion(rig):
    """Return its motion over 2 ms that hold every status."""
    return motion_of(rig.system, (0.018, 0.002), FRAME, Given(scheme=rig.scheme, step=rig.step), velocities=True)


def block(**options):
    """Return a block, 40 mm x 10 mm x 20 mm."""
    return st.SolidBody.block((0.04, 0.01, 0.02), (2, 1, 1), STEEL, cutoff=30e3, name="block", **options)


def on_plane(body):
    """Return a system of a body that slides on a plane."""
    touching = st.PointContact(body.at((0.02, 0.0, 0.01)), st.RigidTrack(velocity=0.1), normal=(0.0, 1.0, 0.0))
    return st.System(touching, [st.Force(body.at("top"), y=-10.0)])


def wheel():
    """Return an inclined ring away from the origin."""
    profile = st.RectangleProfile({"ring": ((0.05, 0.08), (0.0, 0.01))})
    return st.AxisymmetricBody(profile, STEEL, cutoff=6e3, axis=(1.0, 2.0, -0.5), origin=(0.3, -0.2, 0.1), name="ring")


@pytest.mark.parametrize("body", [block(), wheel(), st.SolidBody.block((0.1, 0.1, 0.1), (1, 2, 3), STEEL, linear=True)])
def test_a_surface_is_closed_and_its_normals_point_out(body):
    """By the divergence theorem it then encloses the volume of the body."""
    found = body.drawn.swept
    corners = found.place[found.polygons]
    apart = corners - corners[:, :1]
    vectors = 0.5 * np.cross(apart, np.roll(apart, -1, axis=1)).sum(axis=1)
    np.testing.assert_allclose(vectors.sum(axis=0), 0.0, atol=1e-12)
    volume = np.einsum("pi,pi->", corners.mean(axis=1), vectors) / 3.0
    # A wheel is drawn as a polygon of 60 corners or more.
    assert volume == pytest.approx(body.total_mass / STEEL.density, rel=2e-3)


@pytest.mark.parametrize(
    ("body", "positions"), [(wheel(), [(0.08, 0.0, 0.01), (0.05, np.pi, 0.0)]), (block(), [(0.02, 0.01, 0.0)])]
)
def test_corners_move_as_points_of_the_body_do(body, positions):
    found = body.drawn.swept
    for position in positions:
        place = body.place(position)
        corner = int(np.linalg.norm(found.place - place, axis=1).argmin())
        np.testing.assert_allclose(found.place[corner], place, atol=1e-15)
        expected = body.trace(position)
        np.testing.assert_allclose(found.shapes[corner], expected, atol=1e-9 * np.abs(expected).max())


def still_scene(body, speed):
    """Return a scene of a body in rigid motion at a velocity."""
    uniform = np.tile(speed, (len(body.mesh.nodes), 1))
    modal = body.modal_coordinates(uniform)
    motion = ModalMotion({body.name: np.stack([0.0 * modal, 1e-3 * modal])}, {body.name: np.stack([modal, modal])})
    scene = Scene(Figure(), ROOM, on_plane(body), motion, 10.0, VIEW)
    scene.colour_bar(scene.axes.figure.add_axes((0.9, 0.1, 0.02, 0.8)), scene.moved.largest_velocity)
    return scene


def test_colours_are_velocities_out_of_the_surface():
    """The top of a rising block is red; its sides, which have no normal velocity, are white."""
    scene = still_scene(block(), (0.0, 0.3, 0.0))
    scene.show(0)
    (body,) = scene.bodies
    normals = body.surface.normals[body.seen]
    np.testing.assert_allclose(scene.values, 0.3 * normals[:, 1], atol=1e-12)
    top, side = np.isclose(normals[:, 1], 1.0), np.isclose(normals[:, 1], 0.0)
    assert top.any()
    assert side.any()
    # Polygons are drawn from back to front.
    red, _, blue, _ = scene.sides.get_facecolor().T
    assert np.count_nonzero(red > 2.0 * blue) == np.count_nonzero(top)
    np.testing.assert_allclose(red[red <= 2.0 * blue], blue[red <= 2.0 * blue], rtol=0.01)
    assert scene.moved.largest_velocity == pytest.approx(0.3)
    sinking = still_scene(block(), (0.0, -0.3, 0.0))
    sinking.show(0)
    red, _, blue, _ = sinking.sides.get_facecolor().T
    assert np.count_nonzero(blue > 2.0 * red) == np.count_nonzero(top)


@pytest.mark.parametrize(
    ("speed", "unit"), [(-12.3456, "m/s"), (0.123456, "mm/s"), (0.001234, "mm/s"), (2.3e-11, "nm/s")]
)
def test_the_scale_of_colours_is_in_the_picture(speed, unit):
    figure = Figure(figsize=(9.6, 6.0), dpi=100)
    scene = still_scene(block(), (0.0, speed, 0.0))
    axes = figure.add_axes(space_films.COLOUR_BAR)
    scene._figure = figure
    scene.colour_bar(axes, scene.moved.largest_velocity)
    figure.draw_without_rendering()
    assert axes.get_ylabel() == f"velocity out of the surface [{unit}]"
    assert axes.yaxis.label.get_window_extent().x1 < 960 - 5
    size = {"m/s": 1.0, "mm/s": 1e-3, "nm/s": 1e-9}[unit]
    assert axes.get_ylim()[1] * size == pytest.approx(abs(speed))


def test_departures_from_the_mean_are_exaggerated():
    """Between two frames the block moves by 0.3 mm, drawn ten times as 3 mm about its mean."""
    scene = still_scene(block(), (0.0, 0.3, 0.0))
    first, second = scene._polygons(0), scene._polygons(1)
    np.testing.assert_allclose(second - first, np.broadcast_to([0.0, 3e-3, 0.0], first.shape), atol=1e-12)
    assert 0.5 * (first + second)[..., 1].min() == pytest.approx(0.15e-3)


def test_hidden_faces_are_not_drawn():
    (body,) = still_scene(block(), (0.0, 0.0, 0.0)).bodies
    seen = body.surface.normals[body.seen]
    assert seen[:, 1].min() > -0.5
    assert seen[:, 1].max() == pytest.approx(1.0)
    assert 0 < np.count_nonzero(body.seen) < len(body.seen)


def test_the_picture_shows_time_scales_and_status(rig, motion):
    picture = SpacePicture(rig.system, motion, 50.0, 1000.0, "Pin on disc", VIEW)
    assert set(np.unique(motion.run.status)) == {0, 1, 2}
    rest = np.array([contact.tip.body.place(contact.tip.position) for contact in rig.system.contacts])
    for frame in (0, 20, 49):
        picture.show(frame)
        scales, now = picture.words.get_text().split("\n")
        assert scales == "slowed down 1000 times, vibration drawn 50 times"
        assert now == f"t = {1e3 * float(motion.run.time[frame]):.3f} ms"
        status = motion.run.status.values[frame]
        for number, word in enumerate(STATUS_WORDS):
            marks = np.array(picture.scene.markers[word].get_data_3d()).T
            assert len(marks) == np.count_nonzero(status == number)
            np.testing.assert_allclose(marks, rest[status == number], atol=0.02)
            assert picture.scene.markers[word].get_markerfacecolor() == STATUS_COLOURS[word]
        assert all(cursor.get_xdata()[0] == motion.run.time[frame] for cursor in picture.cursors)


def test_the_motion_is_that_of_the_record(rig, motion):
    run = rig.simulate(duration=0.02)
    per = round(FRAME / run.attrs["sample_interval"])
    forces = run.normal_force.values.reshape(-1, per, 5).mean(axis=1)[-50:]
    np.testing.assert_allclose(motion.run.normal_force, forces, rtol=1e-12, atol=1e-12)
    (pin,) = (body for body in rig.system.bodies if body.name == "pin")
    speed = motion.modes.velocity["pin"] @ pin.trace("node 0")[0]
    # The low-pass of a sample, then one of a frame.
    smooth = np.convolve(run.velocity.values[:, 0], np.bartlett(2 * per + 1) / per, "same")
    recorded = smooth[per - 1 :: per][-50:]
    assert np.corrcoef(speed[2:-2], recorded[2:-2])[0, 1] > 0.995
    assert np.ptp(speed) == pytest.approx(np.ptp(recorded), rel=0.1)


def test_bodies_fill_the_picture_from_everywhere(rig, motion):
    for view in (VIEW, (0.1, -2.0), (1.4, 1.0)):
        figure = SpacePicture(rig.system, motion, 1.0, None, "", view).figure
        image = io.BytesIO()
        figure.savefig(image, format="png")
        dark = np.asarray(Image.open(image))[90:400, :800, :3].min(axis=2) < 250
        rows, columns = np.flatnonzero(dark.any(axis=1)), np.flatnonzero(dark.any(axis=0))
        assert max(np.ptp(rows) / 310.0, np.ptp(columns) / 800.0) > 0.55
        assert columns.min() > 0


def test_a_still_picture(rig):
    figure = plot.bodies(rig.system, 0.004, scheme=rig.scheme, step=rig.step, title="Pin")
    assert figure.get_suptitle() == "Pin"
    assert "t = 4.000 ms" in [text.get_text().split("\n")[-1] for text in figure.texts]


def test_a_gif_has_every_frame(rig, tmp_path):
    told = []
    film = plot.animate(
        rig.system,
        tmp_path / "a.gif",
        start=0.018,
        duration=4e-4,
        step=rig.step,
        progress=lambda *one: told.append(one),
    )
    with Image.open(tmp_path / "a.gif") as image:
        assert (image.n_frames, image.size) == (10, (960, 600))
        frames = []
        for number in range(10):
            image.seek(number)
            frames.append(np.asarray(image.convert("RGB")))
    assert all((one != other).any() for one, other in zip(frames[1:], frames, strict=False))
    assert told == [(n, 10) for n in range(1, 11)]
    assert film.exaggeration in {factor * 10.0**power for factor in (1.0, 2.0, 5.0) for power in range(8)}


BOX = {f"corner {k}": place for k, place in enumerate(np.ndindex(2, 2, 2))}


@pytest.mark.parametrize("points", [{}, {name: 0.02 * np.array(place) - 0.01 for name, place in BOX.items()}])
def test_rigid_bodies_are_hulls_of_their_points_or_balls(points):
    given = {name: tuple(place.tolist()) for name, place in points.items()}
    rigid = st.RigidBody(0.2, 1e-4, points=given, name="weight")
    point = "corner 0" if points else "centre"
    body = block()
    spring = st.Spring(rigid.at(point), body.at((0.04, 0.01, 0.02)), stiffness=1e4, direction=(0.0, 1.0, 0.0))
    alone = on_plane(body)
    found = surfaces_of(st.System(alone.contacts[0], connections=[spring]), np.zeros(3))
    shown = {one.name: one.surface for one in found}
    assert set(shown) == {"block", "weight"}
    surface = shown["weight"]
    centre = np.array([0.04, 0.01, 0.02]) - rigid.offset(point)
    apart = surface.place - centre
    middles = apart[surface.polygons].mean(axis=1)
    assert (np.einsum("pi,pi->p", middles, surface.normals) > 0.0).all()
    if points:
        assert {tuple(np.round(place, 12)) for place in apart} == {tuple(np.round(p, 12)) for p in given.values()}
    else:
        np.testing.assert_allclose(np.linalg.norm(apart, axis=1), 0.03 * 0.04, rtol=1e-12)
    np.testing.assert_allclose(rigid.shapes_at(np.array([rigid.offset(point)]))[0], rigid.trace(point), atol=1e-15)
    turned = rigid.modal_coordinates([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    np.testing.assert_allclose(surface.shapes @ turned, np.cross([0.0, 0.0, 1.0], apart), atol=1e-12)


def test_rigid_bodies_are_where_other_rigid_bodies_have_them():
    """The last one hangs on the middle one, which is named later among the connections."""
    middle = st.RigidBody(0.2, 1e-4, points={"end": (0.03, 0.0, 0.0)}, name="middle")
    last = st.RigidBody(0.1, name="last")
    body = block()
    springs = [
        st.Spring(last.centre, middle.at("end"), stiffness=1e3),
        st.Spring(middle.centre, body.at((0.04, 0.01, 0.02)), stiffness=1e4),
    ]
    found = surfaces_of(st.System(on_plane(body).contacts[0], connections=springs), np.zeros(3))
    centres = {one.name: one.surface.place.mean(axis=0) for one in found}
    np.testing.assert_allclose(centres["middle"], [0.04, 0.01, 0.02], atol=1e-4)
    np.testing.assert_allclose(centres["last"], [0.07, 0.01, 0.02], atol=1e-4)


def test_rigid_bodies_in_no_known_place_are_not_drawn():
    body = block()
    touching = st.PointContact(
        st.RigidBody(0.2, name="weight").centre, st.RigidTrack(velocity=0.1), normal=(0.0, 1.0, 0.0)
    )
    system = st.System([*on_plane(body).contacts, touching])
    assert [one.name for one in surfaces_of(system, np.zeros(3))] == ["block"]


def test_a_ball_touches_what_it_carries():
    system = st.load_scenario("wheel").system
    shown = {one.name: one.surface for one in surfaces_of(system, np.zeros(3))}
    lowest = shown["wheel"].place[:, 1].min()
    rail = shown["rail"].place[:, 1]
    tread = system.contacts[0].tip.body.place(system.contacts[0].tip.position)[1]
    assert rail.max() == pytest.approx(tread, abs=0.1 * np.ptp(rail))
    assert rail.max() < tread
    assert rail.min() < lowest


def frames_of(path):
    with Image.open(path) as image:
        found = []
        for number in range(image.n_frames):
            image.seek(number)
            found.append(np.asarray(image.convert("RGB")).astype(int))
    return np.array(found)


def test_the_verb_films_a_scenario_and_its_record_alike(stridula, tmp_path):
    window = ("--from", "1 ms", "--duration", "0.12 ms", "--elevation", "60 deg")
    code, out, err = stridula("animate", "pin-on-disc", "--out", "a.gif", *window, "--exaggeration", "100")
    assert (code, err) == (0, "")
    assert out == "a.gif: 3 frames, 0.12 ms from 0.001 s, slowed down 1000 times, vibration drawn 100 times\n"
    assert stridula("run", "pin-on-disc", "--duration", "1 ms", "--out", "run.nc")[0] == 0
    assert stridula("run", "run.nc", "--out", "again.nc")[0] == 0
    for record in ("run.nc", "again.nc"):
        assert stridula("animate", record, "--out", "b.gif", *window, "--exaggeration", "100")[0] == 0
        unlike = np.abs(frames_of("a.gif") - frames_of("b.gif")).max(axis=3) > 16
        # Single precision may move an edge by a pixel.
        assert unlike.mean() < 1e-3
    assert stridula("animate", "pin-on-disc", "--out", "c.gif", "--azimuth", "3 m")[0] == 2
    assert not (tmp_path / "c.gif").exists()


def test_a_record_keeps_no_surface_that_is_too_large(stridula, tmp_path, monkeypatch):
    monkeypatch.setattr(provenance, "LARGEST_DRAWN", 1000)
    assert stridula("run", "pin-on-disc", "--duration", "1 ms", "--out", "run.nc")[0] == 0
    code, out, err = stridula("animate", "run.nc", "--out", "b.gif")
    assert (code, out) == (2, "")
    words = "name must be the scenario that was run: this record has no surfaces of bodies"
    assert err == f"stridula: {words}, got 'run.nc'\n"
    assert not (tmp_path / "b.gif").exists()


@pytest.mark.parametrize("body", [wheel(), block()])
def test_a_body_by_its_modes_is_drawn_as_the_one_they_are_of(body):
    modes = body.modes()
    rows = np.zeros((3, modes.count))
    held = ~modes.massless
    given = {"angular_frequency": modes.angular_frequency[held], "residual": int(modes.massless.sum())}
    kept = drawn_of(drawn_table(body.drawn), modes.count)
    copy = st.ModalBody(points={"tip": rows}, drawn=kept, places={"tip": (1.0, 2.0, 3.0)}, **given)
    found, expected = copy.drawn.swept, body.drawn.swept
    np.testing.assert_array_equal(found.polygons, expected.polygons)
    np.testing.assert_allclose(found.place, expected.place, atol=1e-15)
    np.testing.assert_allclose(found.shapes, expected.shapes, atol=1e-6 * np.abs(expected.shapes).max())
    assert copy.place("tip").tolist() == [1.0, 2.0, 3.0]
    assert pickle.loads(pickle.dumps(copy)) == copy
    bare = st.ModalBody(points={"tip": rows}, **given)
    assert bare != copy
    assert bare.place("tip") is None
    assert not bare.is_drawn


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"shapes": np.zeros((3, 2))}, r"^drawn.shapes must be finite numbers of the shape \(12, 2\), got \(3, 2\)"),
        ({"polygons": [[0, 1, 4]]}, "^drawn must name corners from 0 to 3"),
        ({"frame": np.eye(3)}, "^drawn must have place, polygons and shapes|^drawn must have place, polygons, shapes"),
    ],
)
def test_surfaces_that_do_not_fit_are_refused(change, message):
    given = {"place": np.eye(4, 3), "polygons": [[0, 1, 2]], "shapes": np.zeros((12, 2))}
    assert drawn_of(given, 2).shapes.shape == (4, 3, 2)
    with pytest.raises(ValueError, match=message):
        drawn_of(given | change, 2)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda rig: plot.bodies(rig.system, 0.0), "time must be above 0, got 0.0"),
        (lambda rig: plot.bodies(rig.system, 0.01, view=3.0), "view must be an elevation and an azimuth"),
        (lambda rig: plot.bodies(rig.system, 0.01, view=(0.0, np.inf)), "view[1] must be finite"),
        (lambda rig: plot.bodies(rig.system, 1e-3, exaggeration=-1.0), "exaggeration must be above 0"),
        (lambda rig: plot.animate(rig.system, "a.avi"), "out must end in one of .mp4, .gif"),
        (lambda rig: plot.animate(rig.system, "a.gif", duration=1.0), "duration must give from 2 to 5000 frames"),
    ],
)
def test_bad_input_is_one_line(rig, call, message, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError) as caught:
        call(rig)
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)
    assert not any(tmp_path.iterdir())


def test_bodies_without_a_mesh_are_refused(tmp_path):
    system = st.load_scenario("squeal").system
    with pytest.raises(
        ValueError, match=r"^system must have a SolidBody or an AxisymmetricBody, whose surface is drawn, "
    ):
        plot.bodies(system, 1e-3)


# Modes of linear theory.


def filmed(monkeypatch, *arguments):
    """Return the picture of a film of a mode."""
    kept = []
    monkeypatch.setattr(mode_films, "write_film", lambda picture, *_: kept.append(picture))
    film = plot.animate_mode(*arguments)
    return kept[0], film


def test_a_mode_in_space_goes_round_once(rig, monkeypatch, tmp_path):
    theory = st.sliding_stability(rig.system)
    number = int(np.argmax(theory.growth_rate.values))
    picture, film = filmed(monkeypatch, rig.system, theory, number, tmp_path / "a.gif")
    assert film.duration == pytest.approx(1.0 / float(theory.frequency[number]))
    assert film.frames == picture.frames == 32
    rest = picture.scene.bodies[0].surface.place[picture.scene.bodies[0].surface.polygons[picture.scene.bodies[0].seen]]
    first, half = picture.scene._polygons(0), picture.scene._polygons(16)
    np.testing.assert_allclose(0.5 * (first + half)[: len(rest)], rest, atol=1e-12)
    places = np.concatenate([one.surface.place for one in picture.scene.bodies])
    moved = max(np.abs(picture.scene._polygons(k) - 0.5 * (first + half)).max() for k in range(32))
    assert moved == pytest.approx(0.05 * np.ptp(places, axis=0).max(), rel=0.02)
    assert "2272.54 Hz, growth 417.3 /s" in [text.get_text() for text in picture.figure.texts]


def test_a_closed_contact_stays_closed_in_a_mode_of_beams(monkeypatch, tmp_path):
    system = st.load_scenario("squeal").system
    theory = st.sliding_stability(system, velocity=0.1, status="sliding")
    picture, _ = filmed(monkeypatch, system, theory, 3, tmp_path / "a.gif")
    places = {
        line.name: one[:, : line.count] for line, one in zip(picture.scene.lines, picture.scene.places, strict=True)
    }
    slider, track = places["slider"], places["track"]
    below = [np.interp(tip[0, 0], line[:, 0], line[:, 1]) for tip, line in zip(slider, track, strict=True)]
    moved = np.abs(track[:, :, 1]).max()
    assert moved > 0.0
    at_rest = system.contacts[0].at
    under = [np.interp(at_rest, line[:, 0], line[:, 1]) for line in track]
    np.testing.assert_allclose(slider[:, 0, 1], under, atol=0.02 * np.ptp(slider[:, :, 1]))
    assert len(below) == 32
    picture.show(5)
    for line, drawn in zip(picture.scene.lines, picture.scene.bodies, strict=True):
        np.testing.assert_allclose(drawn.get_xydata(), places[line.name][5])


def test_a_mode_film_is_written(rig, tmp_path):
    theory = st.sliding_stability(rig.system, modes=4, near=2300.0)
    plot.animate_mode(rig.system, theory, 0, tmp_path / "a.gif", title="Pin")
    with Image.open(tmp_path / "a.gif") as image:
        assert (image.n_frames, image.size) == (32, (960, 600))


def test_modes_that_are_not_there_are_refused(rig, tmp_path):
    theory = st.sliding_stability(rig.system, modes=4, near=2300.0)
    with pytest.raises(ValueError, match=r"^number must be at most 3, got 4$"):
        plot.animate_mode(rig.system, theory, 4, tmp_path / "a.gif")
    other = on_plane(block())
    with pytest.raises(ValueError, match=r"^theory must have the modes of this system, "):
        plot.animate_mode(other, theory, 0, tmp_path / "a.gif")
    with pytest.raises(ValueError, match=r"^theory must be the result of sliding_stability"):
        plot.animate_mode(rig.system, theory.drop_vars("mode_shape"), 0, tmp_path / "a.gif")
    slow = theory.assign(frequency=0.0 * theory.frequency)
    with pytest.raises(ValueError, match=r"^number must be that of a mode that oscillates"):
        plot.animate_mode(rig.system, slow, 0, tmp_path / "a.gif")
    assert not any(tmp_path.iterdir())
