"""Sound from the command line: `stridula sound` and `stridula run --wav`."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest
import soundfile

import stridula as st
from stridula.bars import rich_bars
from stridula.scenarios.load import Scenario


@pytest.fixture(scope="module")
def records():
    """Return records of a squeal, of a tip that does not land, of a rigid track and of a failed run."""
    failed = st.load_scenario("squeal", {"duration": "2 ms"}).simulate()
    failed.attrs["ended"] = "not finite"
    return {
        "run.nc": st.load_scenario("squeal", {"duration": "60 ms"}).simulate(),
        "open.nc": st.load_scenario("squeal", {"duration": "5 ms"}).simulate(),
        "coarse.nc": st.load_scenario("squeal", {"duration": "60 ms", "sample_rate": "2 kHz"}).simulate(),
        "belt.nc": st.load_scenario("belt", {"duration": "60 ms"}).simulate(),
        "failed.nc": failed,
    }


@pytest.fixture(scope="module")
def folder(records, tmp_path_factory):
    """Write the records into a folder and return it."""
    folder = tmp_path_factory.mktemp("records")
    for name, record in records.items():
        st.save(record, folder / name)
    return folder


@pytest.fixture
def kept(folder, tmp_path):
    """Copy the files of the records."""
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    (tmp_path / "none.toml").write_text("a = 1\n")
    round_track = "base = 'squeal'\n[track]\nsection = { shape = 'circle', diameter = '9 mm' }\n"
    (tmp_path / "round.toml").write_text(round_track)


def written(tmp_path):
    return {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}


def words_of(card):
    """Return the words of a card without its frame."""
    return " ".join(card.replace("│", " ").split())


def test_a_run_is_written_as_a_pair_of_ears_hears_it(stridula, tmp_path):
    code, out, err = stridula("run", "squeal", "--duration", "60 ms", "--wav", "run.wav", "--out", "run.nc")
    assert (code, err) == (0, "")
    rows = words_of(out)
    assert "written run.nc run.wav: 2 channels, 48 kHz, 0.06 s, peak " in rows
    assert "sound level at 1 m, at the louder ear: Leq " in rows
    record, system = st.load("run.nc"), st.load_scenario("squeal").system
    pressure = st.radiate(record, system)
    st.write_wav("same.wav", pressure)
    assert (tmp_path / "run.wav").read_bytes() == (tmp_path / "same.wav").read_bytes()
    np.testing.assert_allclose(pressure["x"], system.track.length / 2 + np.array([-0.09, 0.09]))
    assert stridula("sound", "run.nc", "--wav", "again.wav")[0] == 0
    assert (tmp_path / "run.wav").read_bytes() == (tmp_path / "again.wav").read_bytes()
    # Each body can be heard alone, and their sum is the whole.
    st.write_wav("track.wav", st.radiate(record, system.track))
    for body in ("track", "slider"):
        assert stridula("sound", "run.nc", "--body", body, "--wav", f"{body} alone.wav", "--full-scale", "1")[0] == 0
    assert stridula("sound", "run.nc", "--wav", "both.wav", "--full-scale", "1")[0] == 0
    both, track, slider = (st.read_wav(f"{name}.wav") for name in ("both", "track alone", "slider alone"))
    np.testing.assert_allclose(both, track + slider, atol=3e-7)
    assert float(np.abs(slider).max()) > 1e-3


@pytest.mark.parametrize(
    ("name", "asked", "message"),
    [
        ("brake", ("--set", "surface_rate=1 kHz"), "surface_rate must be left out, or all, for sound, got 1000.0"),
        ("squeal", ("--duration", "10 us"), "duration must be at least 2e-05 s, two samples, for its sound, got 1e-05"),
    ],
)
def test_inaudible_systems_are_refused_before_the_run(stridula, monkeypatch, tmp_path, name, asked, message):
    def fail(*_, **__):
        raise AssertionError("it ran")

    monkeypatch.setattr(Scenario, "simulate", fail)
    code, out, err = stridula("run", name, *asked, "--wav", "run.wav")
    assert (code, out, err) == (2, "", f"stridula: {message}\n")
    assert written(tmp_path) == {}


@pytest.mark.usefixtures("kept")
def test_levels_of_a_pair_of_ears_are_printed_and_nothing_is_written(stridula, tmp_path):
    before = written(tmp_path)
    code, out, err = stridula("sound", "run.nc")
    assert (code, err) == (0, "")
    assert "Leq [dB]" in out
    assert "at (0.7244, 0, 1) m" in out
    assert "at (0.9044, 0, 1) m" in out
    assert written(tmp_path) == before


@pytest.mark.usefixtures("kept")
@pytest.mark.parametrize(("rate", "hertz"), [("44.1 kHz", 44100), ("96000", 96000), ("48 kHz", 48000)])
@pytest.mark.parametrize("subtype", ["PCM_24", "FLOAT"])
def test_several_listeners_calibrated(stridula, rate, hertz, subtype):
    ears = ("--listener", "30 cm, 0, 0.5", "--listener", "0.3,0.1,0.5", "--listener", "0.9,-0.2,1")
    asked = ("--body", "track", "--full-scale", "2", "--sample-rate", rate, "--subtype", subtype, "--wav", "a.wav")
    code, out, err = stridula("sound", "run.nc", *ears, *asked)
    assert (code, err) == (0, "")
    assert out.startswith(f"a.wav: 3 channels, {hertz / 1000:g} kHz, 0.06 s, peak ")
    assert "full scale 2 Pa, calibrated\n" in out
    assert (soundfile.info("a.wav").samplerate, soundfile.info("a.wav").subtype) == (hertz, subtype)
    back = st.read_wav("a.wav")
    assert back.attrs["full_scale"] == 2.0
    assert back.sizes["listener"] == 3
    true = st.radiate(
        st.load("run.nc"), st.load_scenario("squeal").system.track, [(0.3, 0, 0.5), (0.3, 0.1, 0.5), (0.9, -0.2, 1)]
    )
    # Below 20 kHz, which all of these rates hold, there is nearly all of the sound.
    ratio = np.sqrt(np.mean(back.values**2, axis=0) / np.mean(true.values**2, axis=0))
    np.testing.assert_allclose(ratio, 1.0, atol=0.02)


@pytest.mark.usefixtures("kept")
def test_a_float_file_holds_what_is_beyond_full_scale(stridula):
    asked = ("--wav", "a.wav", "--full-scale", "0.0001", "--subtype", "FLOAT")
    assert stridula("sound", "run.nc", *asked)[0] == 0
    assert float(np.abs(st.read_wav("a.wav")).max()) > 0.001


@pytest.mark.usefixtures("kept")
def test_sound_without_a_baffle_is_quieter_and_reaches_below(stridula):
    places = ("--listener", "0.6,0,0.5", "--listener", "0.6,0,-0.5")
    alone = ("--body", "track")
    code, out, err = stridula("sound", "run.nc", *alone, "--unbaffled", *places, "--wav", "free.wav")
    assert (code, err) == (0, "")
    assert "a line of dipoles" in out
    above, below = st.read_wav("free.wav").values.T
    np.testing.assert_allclose(above, -below, atol=1e-6 * np.abs(above).max())
    assert stridula("sound", "run.nc", *alone, "--listener", "0.6,0,0.5", "--wav", "wall.wav")[0] == 0
    assert np.mean(above**2) < np.mean(st.read_wav("wall.wav").values ** 2)


@pytest.mark.usefixtures("kept")
def test_a_spectrogram_is_drawn_and_named_after_the_case(stridula, tmp_path, monkeypatch):
    from stridula import plot

    titles = []
    draw = plot.spectrogram
    monkeypatch.setattr(plot, "spectrogram", lambda *args, title: titles.append(title) or draw(*args, title=title))
    assert stridula("sound", "run.nc", "--plot", "a.png", "--bands", "b.png")[0] == 0
    assert (tmp_path / "b.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert titles == ["Squeal"]


@pytest.mark.usefixtures("kept")
def test_silence_is_reported(stridula):
    code, out, err = stridula("sound", "open.nc", "--body", "track", "--wav", "a.wav")
    assert (code, err) == (0, "")
    assert out.startswith("a.wav: 2 channels, 48 kHz, 0.005 s, silence (full scale 1 Pa)\ntrack is silent: the contact")
    assert not st.read_wav("a.wav").any()
    # A slider that is pulled into the air is still heard.
    code, out, err = stridula("run", "squeal", "--duration", "30 ms", "--set", "gap=10", "--wav", "b.wav")
    assert (code, err) == (0, "")
    assert "track is silent: the contact never presses; slider: a line of dipoles" in out
    assert st.read_wav("b.wav").any()


@pytest.mark.usefixtures("kept")
def test_a_silent_spectrogram_is_drawn(stridula):
    assert stridula("run", "squeal", "--duration", "30 ms", "--set", "gap=10", "--out", "still.nc")[0] == 0
    assert stridula("sound", "still.nc", "--plot", "still.png")[::2] == (0, "")


@pytest.mark.usefixtures("kept")
def test_omissions_of_a_coarse_record_are_reported(stridula):
    code, out, err = stridula("sound", "coarse.nc")
    assert (code, err) == (0, "")
    assert "modes above the limit of the record's sample rate are left out" in out


def with_another_track_on_the_way(records):
    """Return a record whose track was changed halfway, the two systems, and when."""
    run = records["run.nc"].copy(deep=True)
    half = float(run.time[run.sizes["time"] // 2])
    scenarios = [st.load_scenario(records["run.nc"], {"track.damping": damping}) for damping in (0.01, 0.03)]
    texts = [s.simulate(duration=1e-4).attrs["scenario"] for s in scenarios]
    run.attrs["changes"] = json.dumps(
        [{"time": time, "scenario": text} for time, text in zip((0.0, half), texts, strict=True)]
    )
    return run, [s.system for s in scenarios], half


def test_a_record_with_a_changed_track_is_heard_in_parts_only(stridula, records, tmp_path):
    run, systems, half = with_another_track_on_the_way(records)
    message = rf"run must have the same track throughout to be heard, got another one from {half:.6g} s on"
    with pytest.raises(ValueError, match=f"^{message}"):
        st.radiate(run, systems[1].track)
    with pytest.raises(ValueError, match=r"^run must have the same bodies and drives throughout to be heard"):
        st.radiate(run, systems[1], bodies=[systems[1].slider])
    st.save(run, tmp_path / "changed.nc")
    code, out, err = stridula("sound", "changed.nc")
    assert (code, out) == (2, "")
    assert message in err
    for system, other, span in zip(systems, systems[::-1], (slice(0, half), slice(half + 1e-9, None)), strict=True):
        part = run.sel(time=span)
        mine, wrong = st.radiate(part, system), st.radiate(part, other)
        assert not np.array_equal(mine, wrong)
        st.save(part, tmp_path / "part.nc")
        stridula("sound", "part.nc", "--wav", "part.wav", "--full-scale", "200 Pa", "--subtype", "FLOAT")
        st.write_wav(tmp_path / "mine.wav", mine, full_scale=200.0, subtype="FLOAT")
        np.testing.assert_array_equal(*(soundfile.read(tmp_path / f"{name}.wav")[0] for name in ("part", "mine")))


def test_only_the_track_is_heard_if_drives_were_changed(stridula, records):
    run, _, half = with_another_track_on_the_way(records)
    system = st.load_scenario(records["run.nc"]).system
    texts = [
        st.load_scenario(records["run.nc"], {"drives.0.transverse": force}).simulate(duration=1e-4).attrs["scenario"]
        for force in (-1.0, -2.0)
    ]
    changes = [{"time": time, "scenario": text} for time, text in zip((0.0, half), texts, strict=True)]
    st.save(run.assign_attrs(changes=json.dumps(changes)), "turned.nc")
    code, out, err = stridula("sound", "turned.nc", "--wav", "turned.wav", "--full-scale", "1")
    assert (code, err) == (0, "")
    assert out.startswith("track alone: the record was changed while it was played\n")
    st.write_wav("track.wav", st.radiate(records["run.nc"], system.track), full_scale=1.0)
    np.testing.assert_allclose(st.read_wav("turned.wav"), st.read_wav("track.wav"), atol=3e-7)


def test_a_plate_that_was_changed_is_another_track():
    scenarios = [st.load_scenario("squeal-on-plate", {"bodies.plate.thickness": t}) for t in (0.004, 0.008)]
    runs = [one.simulate(duration=2e-3) for one in scenarios]
    changes = [{"time": t, "scenario": run.attrs["scenario"]} for t, run in zip((0.0, 1e-3), runs, strict=True)]
    with pytest.raises(ValueError, match="run must have the same track throughout to be heard"):
        st.radiate(runs[0].assign_attrs(changes=json.dumps(changes)), scenarios[0].system.track)


def test_damaged_changes_are_refused(records):
    run = records["run.nc"].assign_attrs(changes="[{}]")
    with pytest.raises(ValueError, match=r"^run must have the attribute changes as it was saved"):
        st.radiate(run, st.load_scenario(run).system.track)


IN = ("sound", "run.nc")
WAV = ("--wav", "a.wav")
BAD = [
    ((*IN, "--listener", "0.3,0,-1"), "behind the baffle"),
    ((*IN, "--listener", "0.3,0,0"), "in the surface"),
    ((*IN, "--listener", "0.3,0"), "--listener must be X,Y,Z in m"),
    ((*IN, "--listener", "a,0,1"), "--listener must be X,Y,Z in m"),
    ((*IN, "--listener", "nan,0,1"), "--listener must be X,Y,Z in m"),
    ((*IN, "--listener", "0,0,1e9"), "within 1000 m, got '0,0,1e9'"),
    ((*IN, "--unbaffled", "--listener", "0.3,0,0"), "from the beam's axis"),
    ((*IN, "--body", "trak"), "--body must be a body that radiates sound: track, slider, got 'trak'"),
    ((*IN, "--wav", "none/a.wav"), "there is no folder 'none'"),
    ((*IN, "--wav", "."), "it is a directory"),
    ((*IN, "--wav", "run.nc"), "--wav must differ from the record"),
    ((*IN, "--wav", "a.png", "--plot", "a.png"), "--plot must differ from --wav"),
    ((*IN, *WAV, "--plot", "a.xyz"), "--plot must end in one of"),
    ((*IN, "--bands", "a.xyz"), "--bands must end in one of"),
    ((*IN, "--wav", "a.wav", "--bands", "a.wav"), "--bands must differ from --wav"),
    ((*IN, "--plot", "a.png", "--bands", "a.png"), "--bands must differ from --plot"),
    (("sound", "open.nc", *WAV, "--plot", "a.png"), "--plot must have a sound of at least 0.02 s, got 0.005 s"),
    ((*IN, *WAV, "--full-scale", "1e-6"), "--full-scale must be at least "),
    ((*IN, *WAV, "--full-scale", "0"), "--full-scale must be above 0 Pa, got '0'"),
    ((*IN, *WAV, "--full-scale", "nan"), "--full-scale must be a pressure in Pa or normalised, got 'nan'"),
    ((*IN, *WAV, "--full-scale", "1 m"), "--full-scale must be a pressure in Pa or normalised, got '1 m'"),
    ((*IN, *WAV, "--sample-rate", "22050"), "--sample-rate must be one of 44100, 48000, 96000 Hz, got '22050'"),
    ((*IN, *WAV, "--sample-rate", "1 s"), "--sample-rate must be a number in Hz or kHz"),
    ((*IN, *WAV, "--subtype", "PCM_16"), "did you mean 'PCM_24'?"),
    (("sound", "none.nc", *WAV), "cannot read 'none.nc'"),
    (("sound", "none.toml", *WAV), "must be a record"),
    (("sound", "belt.nc", *WAV), "system must have a body with a surface, which radiates sound, got none of block"),
    (("sound", "failed.nc", *WAV), "one that did not diverge, got one that ended 'not finite'"),
    (("sound", *WAV), "Missing argument"),
    (("run", "squeal", "--wav", "none/a.wav"), "there is no folder 'none'"),
    (("run", "squeal", "--wav", "."), "it is a directory"),
    (("run", "squeal", "--wav", "a.nc", "--out", "a.nc"), "--wav must differ from --out"),
    (("run", "squeal", "--wav", "a.png", "--plot", "a.png"), "--wav must differ from --plot"),
    (("run", "run.nc", "--wav", "run.nc"), "--wav must differ from the scenario"),
    (("run", "belt", "--wav", "a.wav"), "system must have a body with a surface, which radiates sound"),
    (("run", "round.toml", "--wav", "a.wav"), "track must have a Rectangle as section"),
    (("sound", "open.nc", "--body", "track", "--bands", "a.png"), "--bands must hold a sound, got silence"),
]


@pytest.mark.usefixtures("kept")
@pytest.mark.parametrize(("arguments", "message"), BAD, ids=[" ".join(words) for words, _ in BAD])
def test_bad_input_is_one_line_and_writes_nothing(stridula, tmp_path, monkeypatch, arguments, message):
    if arguments[0] == "run":
        monkeypatch.setattr(st.Scenario, "simulate", lambda self, **kwargs: pytest.fail("it ran"))
    before = written(tmp_path)
    code, out, err = stridula(*arguments)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("stridula: ")
    assert message in err
    assert written(tmp_path) == before


def test_an_interrupted_run_reports_that_no_sound_was_written(stridula, monkeypatch, tmp_path):
    def interrupt(*arguments, **fields):
        raise KeyboardInterrupt

    monkeypatch.setattr(rich_bars.RichBar, "show", interrupt)
    code, _, err = stridula("run", "squeal", "--duration", "0.25", "--wav", "part.wav")
    assert (code, err.endswith("; no sound was written\n")) == (130, True)
    assert not list(tmp_path.iterdir())


def test_a_plate_is_heard_from_above_its_middle(stridula):
    code, out, err = stridula("run", "squeal-on-plate", "--duration", "20 ms", "--out", "run.nc", "--wav", "run.wav")
    assert (code, err) == (0, "")
    assert "run.wav: 2 channels" in out
    track = st.load_scenario("run.nc").system.track
    code, out, _ = stridula("sound", "run.nc")
    assert f"at ({track.length / 2 - 0.09:.4g}, {track.width / 2:.4g}, 1) m" in out


IN_SPACE = """
[bodies.die]
kind = "rigid body"
mass = "0.2 kg"

[bodies.sheet]
kind = "modal plate"
material = { young = "70 GPa", density = 2700 }
thickness = "3 mm"
length = "30 cm"
width = "25 cm"
cutoff = "500 Hz"
damping = "2 %"
plane = [[0, 0, 1], [1, 0, 0]]

[[contacts]]
tip = { body = "die", point = "centre" }
track = { kind = "plate", body = "sheet" }
at = "10 cm"

[[drives]]
kind = "force"
body = "die"
point = "centre"
x = -20.0

[simulation]
duration = "30 ms"
"""


def test_a_plate_in_space_is_heard_in_open_air_or_in_a_wall(stridula, tmp_path):
    (tmp_path / "die.toml").write_text(IN_SPACE, encoding="utf-8")
    code, out, err = stridula("run", "die.toml", "--out", "run.nc", "--wav", "run.wav")
    assert (code, err) == (0, "")
    assert "run.wav: 2 channels" in out
    assert "not included, without a surface: die; modes end at: sheet" in out
    # Its length is along z, its normal along x, its width along y: the ears are a metre from it along its normal.
    ears = ("--listener", "1,0,0.15", "--listener=-1,0,0.15")
    assert stridula("sound", "run.nc", *ears, "--wav", "open.wav")[0] == 0
    before, behind = st.read_wav("open.wav").values.T
    np.testing.assert_allclose(before, -behind, atol=1e-5 * np.abs(before).max())
    code, out, err = stridula("sound", "run.nc", "--baffled", "--wav", "wall.wav")
    assert (code, err) == (0, "")
    assert "at (1, 0, 0.06) m" in out
    assert np.mean(st.read_wav("wall.wav").values ** 2) > 1.2 * np.mean(before**2)
    code, _, err = stridula("sound", "run.nc", "--baffled", *ears)
    assert (code, err) == (2, "stridula: listener must be in front of the baffle, got (-1.0, 0.0, 0.15)\n")


@pytest.mark.parametrize("floor", [False, True])
def test_only_contacts_on_a_track_drive_it(stridula, tmp_path, floor):
    """Two feet of one body: one on a floor and one on a beam, or both on the beam."""
    feet = st.ReducedBody(
        np.eye(4) * 0.1, np.eye(4) * 1e5, {"left": (0, 1), "right": (2, 3)}, damping=st.Rayleigh(1.0, 1e-6)
    )
    track = st.load_scenario("squeal").system.track
    under = (st.RigidTrack(), 0.0) if floor else (track, 0.8)
    left = st.PointContact(feet.at("left"), *under, st.Coulomb(0.2), name="left foot")
    right = st.PointContact(feet.at("right"), track, 0.4, st.Coulomb(0.2), name="right foot")
    pushes = [st.Force(feet.at(foot), y=-20.0) for foot in ("left", "right")]
    run = st.simulate(st.System([left, right], pushes), duration=0.06)
    st.save(run, "feet.nc")
    code, out, err = stridula("sound", "feet.nc", "--wav", "feet.wav", "--plot", "feet.png")
    assert (code, err) == (0, "")
    assert "not included, without a surface: " in out
    pressure = st.radiate(run.isel(contact=[1]) if floor else run, track)
    assert float(np.abs(pressure).max()) > 0.0
    st.write_wav("same.wav", pressure)
    assert (tmp_path / "feet.wav").read_bytes() == (tmp_path / "same.wav").read_bytes()


def test_sound_that_has_not_arrived_is_silence(stridula):
    assert stridula("run", "judder", "--duration", "3 ms", "--out", "early.nc")[0] == 0
    code, out, _ = stridula("sound", "early.nc", "--body", "track", "--wav", "early.wav")
    assert code == 0
    assert "\ntrack is silent: the sound does not arrive within the record; modes end at: track" in out
    assert not soundfile.read("early.wav")[0].any()


@pytest.mark.usefixtures("kept")
def test_a_coarse_record_reports_its_bandwidth(stridula):
    code, out, _ = stridula("sound", "coarse.nc")
    assert code == 0
    assert "complete only up to 833.3 Hz" in out


@pytest.mark.usefixtures("kept")
@pytest.mark.parametrize("verb", [("sound", "run.nc"), ("run", "squeal")])
def test_a_sound_file_ends_as_its_format(stridula, tmp_path, verb):
    before = sorted(tmp_path.iterdir())
    code, _, error = stridula(*verb, "--wav", "sound.mp3")
    assert (code, error) == (2, "stridula: --wav must end in .wav, got 'sound.mp3'\n")
    assert sorted(tmp_path.iterdir()) == before
