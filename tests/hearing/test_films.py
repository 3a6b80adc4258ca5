"""Films: the motion is that of the record, closed contacts are drawn closed, and scales are shown."""

from __future__ import annotations

import subprocess
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import stridula as st
from stridula import plot
from stridula.integration.settings import Given
from stridula.lines import lines_of
from stridula.plot import reels
from stridula.plot.colours import STATUS_COLOURS
from stridula.plot.films import Picture
from stridula.plot.motion import motion_of
from stridula.plot.plane_motion import plane_motion
from stridula.records.variables import STATUS_WORDS

FRAME = 4e-5


@pytest.fixture(scope="module")
def pair():
    """Return the squealing pair."""
    return st.load_scenario("squeal")


def filmed(system, start, duration, scheme=None):
    """Return the motion of a system in the plane over a window."""
    return plane_motion(system, motion_of(system, (start, duration), FRAME, Given(scheme=scheme)))


def pair_of(motion, exaggeration=1.0):
    """Return places of a slider, its tip first, and of its track."""
    places = [one[:, : line.count] for line, one in zip(motion.lines, motion.drawn(exaggeration), strict=True)]
    (touch,) = motion.touches
    return places[touch.tip[0]], places[touch.touched[0]]


@pytest.fixture(scope="module")
def motion(pair):
    """Return its motion over 4 ms that hold every status."""
    return filmed(pair.system, 0.022, 0.004, pair.scheme)


def on_track(track, x):
    """Return the height of a drawn track at an abscissa."""
    return np.interp(x, track[:, 0], track[:, 1])


def test_the_motion_is_that_of_the_record(pair, motion):
    run = pair.simulate(duration=0.026, probes=[st.Displacement(pair.system.slider.root, "y")])
    per = round(FRAME / run.attrs["sample_interval"])
    forces = run.normal_force.values.reshape(-1, per).mean(axis=1)[-100:]
    np.testing.assert_allclose(motion.run.normal_force, forces, rtol=1e-12, atol=1e-15)
    assert motion.run.attrs["step"] == run.attrs["step"]
    assert motion.run.sizes["time"] == 100
    assert float(motion.run.time[0]) == pytest.approx(0.022 + FRAME)
    slider, _ = pair_of(motion)
    root = slider[:, -1, 1] - slider[0, -1, 1]
    moved = run.displacement.values[per - 1 :: per, 0][-100:]
    # Two low-passes, of one frame and of one sample, for a root that moves slowly.
    np.testing.assert_allclose(root, moved - moved[0], atol=2e-6)


@pytest.mark.parametrize("exaggeration", [1.0, 30.0, 1000.0])
def test_a_closed_contact_is_closed_in_the_picture_and_a_gap_is_drawn(motion, exaggeration):
    slider, track = pair_of(motion, exaggeration)
    gaps = np.array([tip[0, 1] - on_track(line, tip[0, 0]) for tip, line in zip(slider, track, strict=True)])
    status = motion.run.status.values
    assert set(status) == {0, 1, 2}
    recorded = motion.run.gap.values
    # The record's gap is not low-passed, and the track is drawn by straight pieces.
    open_for_long = recorded > 0.5 * recorded.max()
    np.testing.assert_allclose(gaps[open_for_long], exaggeration * recorded[open_for_long], rtol=0.05)
    closed = motion.run.status_share.sel(contact_status="separated").values == 0.0
    assert np.abs(gaps[closed]).max() < 0.05 * exaggeration * recorded.max()


def test_slide_and_mean_shape_stay_to_scale(motion):
    once, track_once = pair_of(motion)
    more, track_more = pair_of(motion, 500.0)
    np.testing.assert_allclose(more[:, 0, 0], once[:, 0, 0], atol=1e-12)
    np.testing.assert_allclose(track_more.mean(axis=0), track_once.mean(axis=0), atol=1e-12)


def test_the_picture_shows_time_status_and_scales(motion):
    picture = Picture(motion, 200.0, 1000.0, "Squeal")
    beams = picture.figure.axes[0]
    for frame in (0, 50, 99):
        picture.show(frame)
        word = STATUS_WORDS[int(motion.run.status[frame])]
        scales, now = beams.get_title(loc="left").split("\n")
        assert now == f"t = {1e3 * float(motion.run.time[frame]):.3f} ms, {word}"
        assert scales == "slowed down 1000 times, vibration drawn 200 times"
        (mark,) = (one for one in picture.scene.markers.values() if len(one.get_xdata()))
        assert mark.get_markerfacecolor() == STATUS_COLOURS[word]
        assert all(cursor.get_xdata()[0] == motion.run.time[frame] for cursor in picture.cursors)
    assert (beams.get_title(loc="right"), beams.get_xlabel()) == ("", "x [m]")


def test_a_gif_has_every_frame(pair, tmp_path):
    told = []
    film = plot.animate(
        pair.system,
        tmp_path / "a.gif",
        duration=4e-4,
        slowdown=990.0,
        title="Squeal",
        progress=lambda *words: told.append(words),
    )
    with Image.open(tmp_path / "a.gif") as image:
        assert (image.n_frames, image.size) == (10, (reels.WIDTH, reels.HEIGHT))
        assert image.info["duration"] == 40
    assert film.frames == 10
    assert told == [(n, 10) for n in range(1, 11)]
    # A whole number of steps for each frame.
    assert film.slowdown == pytest.approx(1000.0)
    assert f"slowed down 1000 times, vibration drawn {film.exaggeration:g} times" in str(film)
    assert film.exaggeration in {factor * 10.0**power for factor in (1.0, 2.0, 5.0) for power in range(8)}


def test_an_mp4_can_be_played(pair, tmp_path):
    if reels._encoder() is None:
        pytest.skip("takes an encoder")
    plot.animate(pair.system, tmp_path / "a.mp4", duration=4e-4)
    words = [reels._encoder(), "-i", str(tmp_path / "a.mp4"), "-f", "null", "-"]
    said = subprocess.run(words, capture_output=True, text=True, check=True).stderr
    assert "960x600" in said
    assert "25 fps" in said
    assert [path.name for path in tmp_path.iterdir()] == ["a.mp4"]


def test_without_an_encoder_the_message_names_a_remedy(pair, monkeypatch, tmp_path):
    monkeypatch.setattr(reels, "_encoder", lambda: None)
    with pytest.raises(
        ValueError, match=r'out must end in \.gif without an encoder \(pip install "\.\[video\]" in the source folder\)'
    ):
        plot.animate(pair.system, tmp_path / "a.mp4")


def test_an_encoder_that_fails_leaves_nothing(pair, monkeypatch, tmp_path):
    monkeypatch.setattr(reels, "_encoder", lambda: "/bin/false")
    with pytest.raises(OSError, match="encoder"):
        plot.animate(pair.system, tmp_path / "a.mp4", duration=1.2e-4)
    assert not any(tmp_path.iterdir())


def test_a_beam_on_a_rigid_track_that_moves():
    rod = st.FiniteElementBeam(st.Material(2.1e11, 7800.0), st.Rectangle(0.01, 0.01), 0.3, angle=0.5, elements=4)
    shaken = st.RigidTrack(velocity=0.1, normal_velocity=1e-3, normal_history=st.Harmonic(500.0))
    contact = st.PointContact(rod.tip, shaken, friction=st.Coulomb(0.5), inclination=0.3)
    motion = filmed(st.System(contact, [st.Force(rod.root, y=-20.0)]), 0.0, 4e-3)
    normal, tangent = contact.frame
    raised = shaken.normal_velocity * shaken.normal_history.integral(motion.run.time.values)
    (track,), (slider,) = motion.surfaces, motion.drawn(1.0)
    np.testing.assert_allclose((track.place + track.departure) @ normal, raised, atol=1e-12)
    np.testing.assert_allclose(track.travel, 0.1 * motion.run.time, rtol=1e-12)
    np.testing.assert_allclose([track.tangent, -track.outwards], [tangent, normal])
    gaps = (slider[:, 0] - track.place - track.departure) @ normal
    np.testing.assert_allclose(gaps, motion.run.gap, atol=0.05 * float(motion.run.gap.max()))


@pytest.fixture(scope="module")
def on_plate():
    """Return the motion of a slider on a plate, along a line across it, over 2 ms that hold a stop."""
    pair = st.load_scenario("squeal-on-plate")
    contact = pair.system.contacts[0]
    plate = replace(contact.track, line=st.Line((0.3, 0.2), 0.5))
    system = st.System([replace(contact, track=plate, at=-0.1)], pair.system.drives)
    return filmed(system, 0.018, 0.002, pair.scheme)


def test_a_plate_is_shown_by_its_cut_along_the_line(on_plate):
    """At a closed contact the cut has the displacement of the tip."""
    _, cut = pair_of(on_plate)
    low, high = cut[0, [0, -1], 0]
    assert low < -0.3 < 0.3 < high
    np.testing.assert_allclose(cut[:, [0, -1], 1], 0.0, atol=1e-15)
    for exaggeration in (1.0, 500.0):
        slider, track = pair_of(on_plate, exaggeration)
        gaps = np.array([tip[0, 1] - on_track(line, tip[0, 0]) for tip, line in zip(slider, track, strict=True)])
        closed = on_plate.run.status_share.sel(contact_status="separated").values == 0.0
        moved = np.ptp(track[:, :, 1], axis=0).max()
        assert closed.any()
        assert np.abs(gaps[closed]).max() < 0.02 * moved
    assert Picture(on_plate, 50.0, 1000.0, "").figure.axes[0].get_xlabel() == "x along the cut through the plate [m]"


def test_labels_do_not_overlap(on_plate):
    figure = Picture(on_plate, 12345.0, 123456.0, "Squeal on a plate").figure
    figure.draw_without_rendering()
    places = [text.get_window_extent() for text in (*figure.texts, figure.axes[0]._left_title)]
    assert len(places) == 2
    assert not places[0].overlaps(places[1])
    assert all(place.x0 >= 0 and place.x1 <= reels.WIDTH and place.y1 <= reels.HEIGHT for place in places)


def test_the_verb_films_a_scenario_and_its_record_alike(stridula, tmp_path):
    assert stridula("run", "squeal", "--duration", "2 ms", "--out", "run.nc")[0] == 0
    window = ("--from", "1.6 ms", "--duration", "0.4 ms", "--exaggeration", "100")
    code, out, err = stridula("animate", "squeal", "--out", "a.gif", *window)
    assert (code, err) == (0, "")
    assert out == "a.gif: 10 frames, 0.4 ms from 0.0016 s, slowed down 1000 times, vibration drawn 100 times\n"
    assert stridula("animate", "run.nc", "--out", "b.gif", *window)[0] == 0
    with Image.open(tmp_path / "a.gif") as one, Image.open(tmp_path / "b.gif") as other:
        # A record's title is the scenario's.
        for frame in range(10):
            one.seek(frame)
            other.seek(frame)
            np.testing.assert_array_equal(np.asarray(one.convert("RGB")), np.asarray(other.convert("RGB")))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nothing",), "scenario must be a file or one of"),
        (
            ("squeal", "--duration", "1"),
            "duration must give from 2 to 5000 frames of 4e-05 s, got 1.0 s (25000 frames)",
        ),
        (("squeal", "--duration", "1 us"), "duration must give from 2 to 5000 frames"),
        (("squeal", "--duration", "5 kHz"), "--duration must be a number in s, ms or us, got '5 kHz'"),
        (("squeal", "--from", "soon"), "--from must be a number in s, ms or us, got 'soon'"),
        (("squeal", "--from", "-1"), "start must be 0 or above, got -1.0"),
        (("squeal", "--slowdown", "0"), "slowdown must be above 0, got 0.0"),
        (("squeal", "--exaggeration", "-2"), "exaggeration must be above 0, got -2.0"),
        (("stable-sliding", "--from", "3"), "start must be before the run ends (off the track at 1.27624 s), got 3.0"),
    ],
)
def test_bad_input_is_one_line_with_exit_code_2(stridula, tmp_path, arguments, message):
    code, out, err = stridula("animate", *arguments, "--out", "a.gif")
    assert (code, out) == (2, "")
    assert err.startswith(f"stridula: {message}")
    assert err.count("\n") == 1
    assert not any(tmp_path.iterdir())


def test_bad_paths_and_formats_are_refused(stridula):
    assert (
        stridula("animate", "squeal", "--out", "a.avi")[2]
        == "stridula: out must end in one of .mp4, .gif, got 'a.avi'\n"
    )
    assert stridula("animate", "squeal", "--out", "no/a.gif")[0] == 2


def test_a_continued_record_is_refused(stridula, pair):
    first = pair.simulate(duration=1e-3)
    st.save(pair.simulate(duration=1e-3, start=first), "on.nc")
    code, _, err = stridula("animate", "on.nc", "--out", "a.gif")
    assert code == 2
    assert (
        err == "stridula: name must be a record from its start, got 'on.nc', which continues another one from 0.001 s\n"
    )


# Any system in the plane.


@pytest.fixture(scope="module")
def bowed():
    """Return the motion of the bowed string over 2 ms at the beginning of a note."""
    violin = st.load_scenario("violin")
    return filmed(violin.system, 0.018, 0.002, violin.scheme)


def test_a_string_is_a_line_under_the_hairs_of_a_bow(bowed):
    string = next(line for line in bowed.lines if line.name == "string")
    assert len(bowed.lines) == 6
    assert (string.count, string.place[0].tolist()) == (401, [0.0, 0.0])
    for touch in bowed.touches:
        line, row = touch.touched
        assert bowed.lines[line] is string
        tip = bowed.lines[touch.tip[0]].place[touch.tip[1]]
        np.testing.assert_allclose(tip, string.place[row], atol=1e-15)
    x = [string.place[touch.touched[1], 0] for touch in bowed.touches]
    np.testing.assert_allclose(x, [0.0358, 0.0374, 0.039, 0.0406, 0.0422])


def test_sticking_points_move_with_the_strokes(bowed):
    """The bow moves up, and so does the sticking string, except for the point that models its torsion."""
    assert len(bowed.surfaces) == 5
    stuck = bowed.run.status_share.sel(contact_status="sticking").values == 1.0
    drawn, seen = bowed.drawn(50.0), 0
    for number, (touch, bow) in enumerate(zip(bowed.touches, bowed.surfaces, strict=True)):
        assert bow.is_exaggerated
        np.testing.assert_allclose(bow.tangent, [0.0, 1.0])
        still = stuck[1:, number] & stuck[:-1, number]
        (line, row), (tip, own) = touch.touched, touch.tip
        apart = (drawn[line][:, row] - drawn[tip][:, own])[:, 1]
        # Near a slip the low-pass includes a part of it.
        assert np.median(np.diff(apart)[still]) == pytest.approx(50.0 * np.diff(bow.travel)[0], rel=0.01)
        seen += np.count_nonzero(still)
    assert seen > 50
    np.testing.assert_allclose(np.diff(bow.travel), 0.2 * np.diff(bowed.run.time), rtol=1e-9)


def test_each_contact_is_marked_where_it_touches(bowed):
    picture = Picture(bowed, 20.0, 1000.0, "Violin")
    drawn = bowed.drawn(20.0)
    for frame in (0, 49):
        picture.show(frame)
        for number, word in enumerate(STATUS_WORDS):
            ours = [
                t.touched for t, one in zip(bowed.touches, bowed.run.status.values[frame], strict=True) if one == number
            ]
            expected = np.array([drawn[line][frame, row] for line, row in ours]).reshape(-1, 2)
            np.testing.assert_allclose(picture.scene.markers[word].get_xydata(), expected)
    assert "vibration of" in picture.figure.axes[0].texts[0].get_text()
    assert picture.figure.axes[1].get_legend_handles_labels()[1] == ["normal", "tangential"]


def test_a_beam_on_two_tracks_is_closed_on_both():
    """Its tip is on a beam; another point presses on a stop, whose place follows from the beam."""
    steel = st.Material(2.1e11, 7800.0)
    beam = st.ModalBeam(steel, st.Rectangle(0.02, 0.005), 1.0, bending_modes=6, axial_modes=0, damping=0.02)
    rod = st.FiniteElementBeam(steel, st.Rectangle(0.01, 0.01), 0.3, angle=0.6, elements=4, damping=0.02)
    stop = st.RigidTrack()
    contacts = [
        st.PointContact(rod.tip, beam, 0.4, st.Coulomb(0.3), name="tip"),
        st.PointContact(rod.at(0.2), stop, inclination=0.2, name="middle"),
    ]
    motion = filmed(st.System(contacts, [st.Force(rod.root, x=3.0, y=-40.0)]), 0.0, 8e-3)
    drawn = motion.drawn(30.0)
    closed = motion.run.status_share.sel(contact_status="separated").values == 0.0
    assert closed.any(axis=0).all()
    (tip, middle), (ground,) = motion.touches, motion.surfaces
    slider, track = drawn[tip.tip[0]], drawn[tip.touched[0]]
    moved = 30.0 * motion.largest
    below = [on_track(line[:-1], one[tip.tip[1], 0]) for line, one in zip(track, slider, strict=True)]
    assert np.abs(slider[:, tip.tip[1], 1] - below)[closed[:, 0]].max() < 0.02 * moved
    apart = (slider[:, middle.tip[1]] - ground.place - 30.0 * ground.departure) @ contacts[1].frame[0]
    assert np.abs(apart)[closed[:, 1]].max() < 0.02 * moved
    np.testing.assert_allclose(slider[0, middle.tip[1]], [0.4 + 0.2 * np.sin(0.6), 0.2 * np.cos(0.6)], atol=moved)


def test_points_are_where_contacts_and_springs_have_them():
    """Two masses on a belt, and a third one that hangs on a spring."""
    first, second, third = (st.PointMass(1.0, name=name) for name in ("first", "second", "third"))
    belt, places = st.RigidTrack(velocity=0.1), (0.3, 0.5)
    contacts = [
        st.PointContact(one.centre, belt, at=at, name=one.name) for one, at in zip((first, second), places, strict=True)
    ]
    springs = [
        st.Spring(first.centre, second.centre, stiffness=10.0),
        st.Spring(third.centre, second.centre, stiffness=10.0),
    ]
    lines, touches = lines_of(st.System(contacts, connections=springs))
    assert {line.name: line.place.tolist() for line in lines} == {
        "first": [[0.3, 0.0]],
        "second": [[0.5, 0.0]],
        "third": [[0.5, 0.0]],
    }
    assert [lines[touch.tip[0]].name for touch in touches] == ["first", "second"]


def test_points_of_a_reduced_body_are_where_they_touch():
    beam = st.ModalBeam(st.Material(2.1e11, 7800.0), st.Rectangle(0.02, 0.005), 1.0, bending_modes=6, axial_modes=0)
    pad = st.ReducedBody(np.eye(4), 1e4 * np.eye(4), {"leading": (0, 1), "back": (2, 3)})
    contacts = [st.PointContact(pad.at(name), beam, at, name=name) for name, at in (("leading", 0.3), ("back", 0.4))]
    lines, _ = lines_of(st.System(contacts))
    points = [line for line in lines if line.count == 1]
    assert [line.place.tolist() for line in points] == [[[0.3, 0.0]], [[0.4, 0.0]]]
    np.testing.assert_allclose(points[1].shapes[0], pad.trace("back"))


def test_a_point_beside_the_cut_is_no_part_of_its_line():
    plate = st.ModalPlate(st.Material(2.1e11, 7800.0, 0.3), 0.002, 0.6, 0.4, bending_modes=(3, 3))
    mass = st.PointMass(0.1)
    lines, (touch,) = lines_of(st.System(st.PointContact(mass.centre, plate.at((0.2, 0.1)))))
    number, row = touch.touched
    assert row >= lines[number].count
    np.testing.assert_allclose(lines[number].place[row], [0.2, 0.0])
    np.testing.assert_allclose(lines[number].shapes[row], plate.trace((0.2, 0.1)))
    assert lines[number].is_cut


def test_a_body_whose_root_is_moved_travels_with_it():
    moved = st.load_scenario("weak-pressure")
    motion = filmed(moved.system, 0.0, 4e-3, moved.scheme)
    slider, _ = pair_of(motion)
    imposed = moved.system.imposed_velocity
    travel = imposed.velocity * imposed.history.integral(motion.run.time.values)
    assert travel[-1] > 0.0
    np.testing.assert_allclose(slider[:, -1, 0] - slider[0, -1, 0], travel - travel[0], atol=0.02 * travel[-1])


def test_the_verb_films_a_bowed_string_and_its_record_alike(stridula):
    assert stridula("run", "violin", "--duration", "1 ms", "--out", "run.nc")[0] == 0
    window = ("--duration", "0.12 ms", "--exaggeration", "50")
    for name in ("violin", "run.nc"):
        assert stridula("animate", name, "--out", f"{name}.gif", *window)[0] == 0
    with Image.open("violin.gif") as one, Image.open("run.nc.gif") as other:
        assert one.n_frames == other.n_frames == 3
        one.seek(2)
        other.seek(2)
        np.testing.assert_array_equal(np.asarray(one.convert("RGB")), np.asarray(other.convert("RGB")))


def test_bodies_in_space_without_a_surface_are_refused(tmp_path):
    weight = st.RigidBody(0.2, name="weight")
    touching = st.PointContact(weight.centre, st.RigidTrack(velocity=0.1), normal=(0.0, 1.0, 0.0))
    with pytest.raises(ValueError, match=r"^system must be in the plane, or have .*, to be filmed, got RigidBody$"):
        plot.animate(st.System(touching), tmp_path / "a.gif")
