"""Films: the motion is that of the record, a closed contact is closed in the picture, which says its scales."""

from __future__ import annotations

import subprocess
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import stridula as st
from stridula import plot
from stridula.plot import reels
from stridula.plot.colours import STATUS_COLOURS
from stridula.plot.films import Picture
from stridula.plot.motion import motion_of
from stridula.records.variables import STATUS_WORDS

FRAME = 4e-5


@pytest.fixture(scope="module")
def pair():
    """Return the squealing pair."""
    return st.load_scenario("squeal")


@pytest.fixture(scope="module")
def motion(pair):
    """Return its motion over 4 ms that hold every status."""
    return motion_of(pair.system, 0.022, 0.004, FRAME, pair.scheme)


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
    root = motion.slider[:, -1, 1] - motion.slider[0, -1, 1]
    moved = run.displacement.values[per - 1 :: per, 0][-100:]
    # Two low-passes, of one frame and of one sample, of a root that moves slowly.
    np.testing.assert_allclose(root, moved - moved[0], atol=2e-6)


@pytest.mark.parametrize("exaggeration", [1.0, 30.0, 1000.0])
def test_a_closed_contact_is_closed_in_the_picture_and_a_gap_is_drawn(motion, exaggeration):
    slider, track = motion.drawn(exaggeration)
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
    once, track_once = motion.drawn(1.0)
    more, track_more = motion.drawn(500.0)
    np.testing.assert_allclose(once, motion.slider, atol=1e-15)
    np.testing.assert_allclose(track_once, motion.track, atol=1e-15)
    np.testing.assert_allclose(more[:, 0, 0], once[:, 0, 0], atol=1e-12)
    np.testing.assert_allclose(track_more.mean(axis=0), track_once.mean(axis=0), atol=1e-12)


def test_the_picture_says_time_status_and_scales(motion):
    picture = Picture(motion, 200.0, 1000.0, "Squeal")
    beams = picture.figure.axes[0]
    for frame in (0, 50, 99):
        picture.show(frame)
        word = STATUS_WORDS[int(motion.run.status[frame])]
        scales, now = beams.get_title(loc="left").split("\n")
        assert now == f"t = {1e3 * float(motion.run.time[frame]):.3f} ms, {word}"
        assert scales == "slowed down 1000 times, vibration drawn 200 times"
        assert picture.point.get_markerfacecolor() == STATUS_COLOURS[word]
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


def test_without_an_encoder_it_says_what_to_do(pair, monkeypatch, tmp_path):
    monkeypatch.setattr(reels, "_encoder", lambda: None)
    with pytest.raises(
        ValueError, match=r"out must end in \.gif without an encoder \(pip install \.\[video\] in the sources\)"
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
    motion = motion_of(st.System(contact, [st.Force(rod.root, y=-20.0)]), 0.0, 4e-3, FRAME)
    normal, _ = contact.frame
    raised = shaken.normal_velocity * shaken.normal_history.integral(motion.run.time.values)
    np.testing.assert_allclose(motion.track @ normal, np.stack([raised, raised], axis=1), atol=1e-12)
    gaps = (motion.slider[:, 0] - motion.track[:, 0]) @ normal
    np.testing.assert_allclose(gaps, motion.run.gap, atol=0.05 * float(motion.run.gap.max()))


@pytest.fixture(scope="module")
def on_plate():
    """Return the motion of a slider on a plate, along a line across it, over 2 ms that hold a stop."""
    pair = st.load_scenario("squeal-on-plate")
    contact = pair.system.contacts[0]
    plate = replace(contact.track, line=st.Line((0.3, 0.2), 0.5))
    system = st.System([replace(contact, track=plate, at=-0.1)], pair.system.drives)
    return motion_of(system, 0.018, 0.002, FRAME, pair.scheme)


def test_of_a_plate_one_sees_the_cut_along_the_line(on_plate):
    """Where a contact is closed, the cut bends as far as the tip says."""
    low, high = on_plate.track[0, [0, -1], 0]
    assert low < -0.3 < 0.3 < high
    np.testing.assert_allclose(on_plate.track[:, [0, -1], 1], 0.0, atol=1e-15)
    for exaggeration in (1.0, 500.0):
        slider, track = on_plate.drawn(exaggeration)
        gaps = np.array([tip[0, 1] - on_track(line, tip[0, 0]) for tip, line in zip(slider, track, strict=True)])
        closed = on_plate.run.status_share.sel(contact_status="separated").values == 0.0
        moved = np.ptp(track[:, :, 1], axis=0).max()
        assert closed.any()
        assert np.abs(gaps[closed]).max() < 0.02 * moved
    assert Picture(on_plate, 50.0, 1000.0, "").figure.axes[0].get_xlabel() == "x along the cut through the plate [m]"


def test_words_do_not_run_into_each_other(on_plate):
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
        (
            ("belt",),
            "system must be a FiniteElementBeam on one ModalBeam, ModalPlate or RigidTrack, or have meshes in space, "
            "to be filmed, got a PointMass on a RigidTrack\n",
        ),
        (("stable-sliding", "--from", "3"), "start must be before the run ends (off the track at 1.27624 s), got 3.0"),
    ],
)
def test_bad_input_is_one_line_and_2(stridula, tmp_path, arguments, message):
    code, out, err = stridula("animate", *arguments, "--out", "a.gif")
    assert (code, out) == (2, "")
    assert err.startswith(f"stridula: {message}")
    assert err.count("\n") == 1
    assert not any(tmp_path.iterdir())


def test_places_and_formats_that_cannot_be(stridula):
    assert (
        stridula("animate", "squeal", "--out", "a.avi")[2]
        == "stridula: out must end in one of .mp4, .gif, got 'a.avi'\n"
    )
    assert stridula("animate", "squeal", "--out", "no/a.gif")[0] == 2


def test_a_record_that_goes_on_from_another_is_refused(stridula, pair):
    first = pair.simulate(duration=1e-3)
    st.save(pair.simulate(duration=1e-3, start=first), "on.nc")
    code, _, err = stridula("animate", "on.nc", "--out", "a.gif")
    assert code == 2
    assert (
        err == "stridula: name must be a record from its start, got 'on.nc', which continues another one from 0.001 s\n"
    )


def test_several_contacts_are_not_filmed(pair, tmp_path):
    first = pair.system.contacts[0]
    both = [replace(first, name=name, at=at) for name, at in (("one", 0.2), ("other", 0.4))]
    with pytest.raises(ValueError, match=r"to be filmed, got 2 contacts$"):
        plot.animate(st.System(both, pair.system.drives), tmp_path / "a.gif")
