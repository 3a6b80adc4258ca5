"""Systems other than two beams on the page: playing, drawing, sound, controls and messages."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.app.instrument import Instrument
from stridula.app.now import heard, measured, said, words
from stridula.app.parts import Part
from stridula.app.playable import SYSTEMS, playable

from .browsing import plays_on, shown, until
from .conversation import RATE

SURFACE, BOW_FORCE, TENSION = "contacts.*.surface_velocity", "drives.*.x", "bodies.string.tension"
FRICTION = "contacts.0.friction.coefficient"
TWO_RODS = """
damping = 0.01
cutoff = "12 kHz"
friction = 0.6
material = { young = "210 GPa", density = 7800.0 }
section = { shape = "rectangle", width = 0.02, height = 0.008 }
[bodies]
front = { kind = "finite-element beam", length = 0.3, angle = "20 deg", elements = 8 }
back = { kind = "finite-element beam", length = 0.35, angle = "-15 deg", elements = 8 }
track = { kind = "modal beam", length = 1.2 }
[[contacts]]
tip = { body = "front" }
track = { kind = "beam", body = "track" }
at = 0.4
[[contacts]]
tip = { body = "back" }
track = { kind = "beam", body = "track" }
at = 0.7
[[connections]]
kind = "spring"
first = { body = "front", point = "root" }
second = { body = "back", point = "root" }
stiffness = 1000.0
[[drives]]
kind = "force"
body = "front"
point = "root"
x = 1.0
y = -5.0
[[drives]]
kind = "force"
body = "back"
point = "root"
x = 1.0
y = -5.0
[simulation]
duration = 0.1
"""
# A rigid body on a bushing, with a contact that heats, beside a pad on a layer.
MOUNTED = """
[bodies.block]
kind = "rigid body"
mass = 2
inertia = [0.01, 0.02, 0.015]
points = { foot = [0, "-20 mm", 0] }
[bodies.pad]
kind = "solid"
materials = { young = "5 GPa", density = 2500 }
cutoff = "12 kHz"
mesh = { shape = "block", lengths = ["80 mm", "12 mm", "40 mm"], divisions = [4, 1, 2] }
[[contacts]]
tip = { body = "block", point = "foot" }
track = { kind = "rigid", velocity = "10 cm/s" }
heating = { kind = "layers", capacity = [0.5, 4], conductance = [0.2], cooling = 0.1 }
[contacts.friction]
law = "over temperature"
temperature = [20, 200]
laws = [{ law = "coulomb", coefficient = 0.5 }, { law = "coulomb", coefficient = 0.3 }]
[[connections]]
kind = "bushing"
first = { body = "block", point = "centre" }
stiffness = [1e5, 4e5, 2e5]
damping = [20, 20, 30]
rotational_stiffness = [50, 20, 50]
[[layers]]
first = { body = "pad", face = "top" }
frequency = ["500 Hz", "2 kHz"]
stiffness = { y = "4e8 N/m", x = [4e7, 5e7] }
loss_factor = 0.2
points = 2
[[drives]]
kind = "force"
body = "block"
point = "centre"
y = -20
[simulation]
duration = "10 ms"
"""
# A spring to the ground at a point that touches nothing.
ON_A_SPRING = TWO_RODS.replace('second = { body = "back", point = "root" }\n', "")
PRESSURE_ON_PLATES = {"squeal-on-plate", "judder-on-plate"}


@pytest.mark.parametrize("case", SYSTEMS)
def test_every_system_is_played_and_drawn(talk, case):
    scene = talk.scene(case)
    assert scene["type"] == "scene"
    assert ("pressure" in scene["sources"]) == (case in PRESSURE_ON_PLATES)
    played = talk.play(4800)
    assert len(played.sound) == 4800
    assert np.isfinite(played.sound).all()
    numbers = sum(1 + len(line["places"]) for line in scene["lines"])
    for part in played.parts:
        assert part.slider.shape == (numbers, 2)
        assert part.contacts.shape == (len(scene["contacts"]), 2)
        assert set(part.contacts[:, 0]) <= {0.0, 1.0, 2.0}
    assert np.abs(played.parts[-1].slider).max() > 0.0
    for contact in scene["contacts"]:
        for line, row in filter(None, (contact["tip"], contact["touched"])):
            assert 0 <= row < len(scene["lines"][line]["places"])
    assert scene["speed"] > 0.0


def test_a_spring_to_the_ground_is_drawn_where_nothing_touches(talk):
    scene = talk.scene(text=ON_A_SPRING)
    ((line, row),) = scene["joined"][0]["ends"]
    assert scene["lines"][line]["name"] == "front"
    # Its root, at the far end of a rod of 0.3 m.
    tip = next(one["tip"] for one in scene["contacts"] if one["tip"][0] == line)
    places = np.array(scene["lines"][line]["places"])
    assert np.linalg.norm(places[row] - places[tip[1]]) == pytest.approx(0.3)


@pytest.mark.parametrize("case", SYSTEMS)
def test_all_audible_bodies_of_a_system_are_heard(talk, case):
    for name in talk.scene(case)["sources"]:
        talk.say("listen", source=name)
        sound = talk.play(2400).sound
        assert len(sound) == 2400
        assert np.isfinite(sound).all()


def test_a_violin_is_heard_at_its_bridge_as_in_a_run():
    instrument = Instrument(playable("violin", None, {}))
    assert instrument.heard_as.name == "Support force, string left end"
    parts = [part for part in instrument.play(9600) if isinstance(part, Part)]
    sound = np.concatenate([part.sound for part in parts])
    run = st.load_scenario("violin").simulate(duration=0.2, sample_rate=RATE)
    wanted = run.support_force.values[:, 0]
    later = instrument.live.delay
    assert np.abs(wanted).max() > 0.1
    assert np.allclose(sound[later:], wanted[: len(sound) - later], rtol=0.0, atol=1e-9)


def test_two_rods_on_a_beam_are_heard_together():
    instrument = Instrument(playable("", TWO_RODS, {}))
    assert instrument.name == "pressure"
    sound = np.concatenate([part.sound for part in instrument.play(4800) if isinstance(part, Part)])
    system = instrument.played.system
    run = st.simulate(system, duration=0.1, sample_rate=RATE)
    track = system.track
    wanted = st.radiate(run, track, (track.length / 2.0, 0.0, 0.5)).values[:, 0]
    inner = slice(int(np.flatnonzero(wanted)[0]), len(wanted) - 100)
    loudest = np.abs(wanted).max()
    assert loudest > 1e-3
    # The streamed signal is one sample late.
    assert np.abs(sound[1:] - wanted[:-1])[inner].max() < 1e-5 * loudest
    alone = instrument.live.advance(480)[0].contacts["normal_force"]
    assert alone.shape[0] == 2


ALONG = '[[contacts]]\ntip = { body = "back" }\ntrack = { kind = "beam", body = "track" }\nat = 0.7\n'


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ('[[drives]]\nkind = "force"\nbody = "track"\npoint = 0.3\ny = 1.0\n', "force"),
        ('[[connections]]\nkind = "spring"\nfirst = { body = "track", point = 0.3 }\nstiffness = 1e4\n', "a spring"),
        (ALONG.replace("at = 0.7", "").replace('"beam", ', '"point", point = 0.7, '), "contact 3"),
    ],
)
def test_the_page_says_why_a_track_under_other_forces_has_no_pressure(more, words):
    text = TWO_RODS.replace("[simulation]", f"{more}[simulation]")
    sources = playable("", text, {}).sources
    assert "pressure" not in sources
    assert sources["force"].words.endswith(
        f" There is no sound pressure, as more than contacts along it drives the track: {words}."
    )


def test_the_page_says_which_bodies_the_pressure_lacks():
    words = playable("", TWO_RODS, {}).sources["pressure"].words
    assert words.endswith("from contact forces. Not included: the sound of front, back.")
    weighed = TWO_RODS.replace("[simulation]", '[[drives]]\nkind = "gravity"\n[simulation]')
    assert "pressure" in playable("", weighed, {}).sources


@pytest.mark.parametrize("later", [False, True])
def test_forces_at_rest_make_no_blow(later):
    """In equilibrium from the start on, and where one begins to listen in the middle of a stroke."""
    settled = '[[drives]]\nkind = "initial equilibrium"\nstatus = "sticking"\n[simulation]'
    blow = Instrument(playable("", TWO_RODS, {}))
    loud = np.concatenate([part.sound for part in blow.play(2400) if isinstance(part, Part)])
    still = Instrument(playable("", TWO_RODS.replace("[simulation]", settled), {}))
    if later:
        still.live.advance(480)
        still.source.begin()
    sound = np.concatenate([part.sound for part in still.play(2400) if isinstance(part, Part)])
    assert np.abs(sound).max() < 1e-3 * np.abs(loud).max()


@pytest.mark.parametrize(
    ("key", "share", "goes_on"),
    [
        ("contacts.*.friction.coefficient", 0.9, True),
        ("drives.*.y", 0.9, True),
        ("bodies.track.length", 1.1, True),
        ("bodies.track.material.density", 0.9, True),
        ("connections.0.stiffness", 0.9, False),
        ("bodies.front.length", 0.9, False),
    ],
)
def test_two_rods_continue_where_their_motion_stays_valid(key, share, goes_on):
    first = playable("", TWO_RODS, {})
    instrument = Instrument(first)
    before = [part for part in instrument.play(4800) if isinstance(part, Part)][-1].chunk
    value = share * first.turned.values[key]
    assert instrument.change(playable("", TWO_RODS, {key: value}), 1) == goes_on
    after = next(part for part in instrument.play(480) if isinstance(part, Part)).chunk
    moved = np.abs(after.contacts["contact_position"][:, 0] - before.contacts["contact_position"][:, -1])
    assert (moved.max() < 1e-5) == goes_on
    gaps = after.contacts["gap"][:, 0] - before.contacts["gap"][:, -1]
    assert not goes_on or np.abs(gaps).max() < 1e-6
    assert instrument.ended == ""


def test_a_violin_is_bowed_as_a_whole(talk):
    values = talk.scene("violin")["values"]
    assert values[SURFACE] == pytest.approx(-0.2)
    assert values[BOW_FORCE] == pytest.approx(0.22)
    assert values[TENSION] == pytest.approx(44.0)
    talk.play(4800)
    turned = talk.scene("violin", {SURFACE: -0.1, BOW_FORCE: 0.3})
    assert turned["type"] == "scene"
    assert turned["goes_on"]
    assert (turned["values"][SURFACE], turned["values"][BOW_FORCE]) == (-0.1, 0.3)
    assert turned["toml"].count("surface_velocity = -0.1") == 5
    assert turned["places"][BOW_FORCE] == [f"drives.{k}.x" for k in range(5)]
    assert set(talk.play(480).stroke) == {1}


@pytest.mark.parametrize(("case", "text"), [*((case, None) for case in SYSTEMS), ("", MOUNTED)])
def test_every_control_of_a_system_changes_something(case, text):
    before = playable(case, text, {})
    assert before.turned.controls
    for control in before.turned.controls:
        value = before.turned.values[control.key]
        assert control.low < control.high
        assert control.low * control.scale <= value <= control.high * control.scale
        assert control.words
        after = playable(case, text, {control.key: 0.99 * value})
        assert after.turned.values[control.key] == pytest.approx(0.99 * value)
        assert after.system != before.system
        assert {one.key for one in after.turned.controls} >= {control.key}
        assert [one for one in after.turned.controls if one.key == control.key] == [control]


def test_entries_of_lists_have_controls_unless_they_are_samples():
    turned = playable("", MOUNTED, {}).turned
    labels = {one.key: one.label for one in turned.controls}
    assert labels["connections.0.stiffness.1"] == "Stiffness along y"
    assert labels["connections.0.rotational_stiffness.2"] == "Rotational stiffness about z"
    assert labels["contacts.0.heating.capacity.1"] == "Capacity 2"
    assert labels["contacts.0.friction.laws.1.coefficient"] == "Coefficient, law 2"
    assert labels["layers.0.stiffness.y"] == "Stiffness along y"
    # Along x the layer has a table over the frequency.
    assert not [key for key in labels if key.startswith(("layers.0.stiffness.x", "layers.0.frequency"))]


def test_the_friction_law_of_a_belt_changes_during_a_run(talk):
    assert talk.scene("belt")["values"]["contacts.0.friction.law"] == "static-kinetic"
    talk.play(4800)
    changed = {"contacts.0.friction.law": "coulomb", FRICTION: 0.5}
    scene = talk.scene("belt", changed)
    assert scene["type"] == "scene"
    assert scene["goes_on"]
    assert scene["values"][FRICTION] == 0.5
    assert "contacts.0.friction.static" not in scene["values"]


def test_a_belt_that_carries_its_block_is_not_at_rest(talk):
    talk.scene("belt")
    played = talk.play(RATE)
    assert played.stops == []
    assert set(played.status) == {1}


def test_a_record_of_several_contacts_and_probes_opens_like_any_other(talk, tmp_path):
    talk.scene("violin")
    talk.play(9600)
    file = tmp_path / "played.nc"
    file.write_bytes(talk.save("nc"))
    record = st.load(file)
    assert record.normal_force.dims == ("time", "contact")
    assert list(record.contact.values) == [f"hair {k}" for k in range(1, 6)]
    assert record.status_share.shape == (9600, 5, 3)
    assert {"acceleration", "support_force", "velocity"} <= set(record.data_vars)
    assert st.load_scenario(file).system == st.load_scenario("violin").system


def test_the_present_regime_is_described(talk):
    talk.scene("squeal")
    talk.play(RATE)
    told = talk.until("now")
    assert told["regime"] in told["words"] or told["words"]
    assert told["words"].startswith(("squeals at", "sticks and slips", "slides", "judders"))


@pytest.mark.parametrize("tone", [440.0, 2950.0])
def test_the_description_has_regime_pitch_and_level(tone):
    interval, count = 1.0 / 24e3, 24_000
    time = interval * np.arange(1, count + 1)
    sliding = np.tile([0.0, 0.0, 1.0], (count, 1))
    normal = 10.0 + 3.0 * np.sin(2.0 * np.pi * tone * time)
    variables = {"normal_force": normal, "tangential_force": 0.3 * normal, "status_share": sliding}
    variables |= {"damping_loss": 0.1 * time, "impact_loss": 0.0 * time, "friction_loss": time, "landings": 0.0 * time}
    found = measured(interval, ["contact 1"], {name: said(values) for name, values in variables.items()})
    assert found["regime"] == "squeal"
    assert found["frequency"] == pytest.approx(tone, rel=0.02)
    expected = {440.0: "squeals at 440 Hz", 2950.0: "squeals at 2.95 kHz"}[tone]
    assert words(found | {"frequency": tone}, 77.6) == f"{expected}, 78 dB"
    assert words(found | {"frequency": tone}, None) == expected
    assert np.array_equal(heard(said(normal)), normal.astype("f4").astype(float))


def test_the_page_shows_a_system_with_its_own_controls_and_sources(browsing):
    page = browsing.open("#case=violin")
    assert page.locator(f"input[type=number][data-key='{BOW_FORCE}']").input_value() == "220"
    assert page.locator("#source option").first.inner_text() == "Support force, string left end [N]"
    until(page, "stridula.now().title.startsWith('Violin')")
    page.locator(f"input[type=number][data-key='{SURFACE}']").fill("-10")
    page.keyboard.press("Enter")
    until(page, f"stridula.now().values['{SURFACE}'] === -0.1")
    plays_on(page)
    command = page.evaluate("stridula.scene.command()")
    assert command.count("surface_velocity=-0.1") == 5
    page.locator("#case").select_option("squeal")
    until(page, "stridula.now().turned === null")
    assert shown(page, "slider.angle") == pytest.approx(45.0)
    plays_on(page)


KEEP_UP = """(speeds) => speeds.map((speed) => {
  stridula.keepUp(speed);
  return [document.getElementById("speed").value, document.getElementById("pace").textContent];
})"""


def test_slow_systems_are_shown_slowly_with_a_note(browsing):
    page = browsing.open("#case=belt")
    slow, fast = page.evaluate(KEEP_UP, [0.5, 3.0])
    words = "Shown 2.2 times slower than real time, as fast as this machine can, and without sound."
    assert slow == ["2.2", words]
    assert fast == ["1", ""]


def slow(monkeypatch, *speeds):
    """Let the measured speed of an instrument be a given one, measurement by measurement."""
    found = iter(speeds)
    monkeypatch.setattr(Instrument, "speed", lambda self: (self.live.restart(), next(found))[1])


def test_steps_are_longer_where_that_keeps_up_with_the_sound(monkeypatch):
    slow(monkeypatch, 0.8, 1.4)
    instrument = Instrument(playable("violin", None, {}))
    assert instrument.live.ratio == 15
    assert instrument.keep_up() == 1.4
    assert instrument.live.ratio == 8
    # As TOML it is the run of the command line, bit for bit.
    text = instrument.played.toml
    part, *_ = (part for part in instrument.play(480) if isinstance(part, Part))
    again = st.simulate(*told(text), duration=480 / RATE, sample_rate=RATE, step=1.0 / RATE / 8, probes=())
    assert np.array_equal(again.normal_force.values[:, 0], part.chunk.contacts["normal_force"][0])
    # This remains while values change, but not for another case.
    assert instrument.change(playable("violin", None, {BOW_FORCE: 0.25}), 1)
    assert instrument.live.ratio == 8
    instrument.change(playable("lugre", None, {}), 2)
    assert instrument.longer is None
    instrument.change(playable("violin", None, {}), 3)
    assert instrument.live.ratio == 15


def told(text):
    """Return the system that a text describes, as `simulate` takes it."""
    return (playable("", text, {}).system,)


@pytest.mark.parametrize("speeds", [(1.2,), (0.8, 0.9)])
def test_steps_are_the_usual_ones_if_these_or_none_keep_up(monkeypatch, speeds):
    slow(monkeypatch, *speeds)
    instrument = Instrument(playable("violin", None, {}))
    assert instrument.keep_up() == speeds[0]
    assert (instrument.live.ratio, instrument.longer) == (15, None)
    assert "step" not in instrument.played.tables["simulation"]


def test_a_step_of_a_scenario_is_taken_as_it_is(monkeypatch):
    slow(monkeypatch, 0.5)
    text = TWO_RODS + "step = 5e-6\n"
    instrument = Instrument(playable("", text, {}))
    assert instrument.keep_up() == 0.5
    assert instrument.live.ratio == 5
    assert instrument.played.tables["simulation"]["step"] == 5e-6
