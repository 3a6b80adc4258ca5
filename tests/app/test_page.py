"""The page in a browser: motion, sound, drawings and input."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
import soundfile

import stridula as st

from .browsing import plays_on, shown, stats, until
from .conversation import RATE

FRICTION = "contact.friction.coefficient"
SLIDE = f"input[type=range][data-key='{FRICTION}']"
BAD = 'base = "stable-sliding"\n[slider]\nlength = -0.5\n'
GOOD = 'base = "stable-sliding"\ntitle = "Mine"\n[slider]\nlength = 0.45\n[contact.friction]\ncoefficient = 0.3\n'


def slide(page, value: float, where: str = SLIDE) -> None:
    """Move a slider as a user does."""
    page.locator(where).evaluate(
        "(one, value) => { one.value = value; for (const type of ['input', 'change'])"
        " one.dispatchEvent(new Event(type, { bubbles: true })); }",
        value,
    )


def told(page, words: str) -> None:
    """Wait until the page plays a scenario whose text contains some words."""
    until(page, "stridula.now()?.toml.includes(arg)", words)


def upload(page, text: str) -> None:
    page.locator("#toml-open").set_input_files(
        {"name": "own.toml", "mimeType": "text/plain", "buffer": text.encode("utf-8")}
    )


def test_the_first_visit_is_introduced_and_the_second_is_not(browsing):
    page = browsing.open(intro=True)
    intro = page.locator("#intro")
    assert intro.is_visible()
    assert intro.locator("li").count() == 3
    page.keyboard.press("Enter")
    intro.wait_for(state="hidden")
    # The press that begins also allows the browser to play sound.
    until(page, "document.getElementById('sound').getAttribute('aria-pressed') === 'true'")
    until(page, "stridula.stats.peak > 1e-4")
    page.reload()
    plays_on(page, 0)
    assert not intro.is_visible()
    assert page.locator("#sound").get_attribute("aria-pressed") == "false"
    page.locator("#help").click()
    assert intro.is_visible()
    page.keyboard.press("Escape")
    intro.wait_for(state="hidden")


def test_without_a_link_the_glass_plays(browsing):
    page = browsing.open("")
    until(page, "document.getElementById('case').value === 'glass'")
    assert page.evaluate("stridula.now().source") == "probe 1"
    assert page.evaluate("stridula.now().sources['probe 1'].name").startswith("Velocity, glass")


def test_it_plays_and_draws(browsing):
    page = browsing.open()
    until(page, "stridula.stats.level > 1e-4 && stridula.stats.frames > 0")
    assert page.locator("#lost").is_hidden()
    assert page.locator("#problem").is_hidden()
    for name in ("beams", "timeline", "phase", "spectrogram"):
        until(
            page,
            """{
              const one = document.getElementById(arg);
              const { data } = one.getContext('2d').getImageData(0, 0, one.width, one.height);
              return new Set(new Uint32Array(data.buffer)).size > 3;
            }""",
            name,
        )
    until(page, "document.getElementById('theory').textContent.startsWith('Linear theory: ')")


def test_it_is_muted_until_sound_is_turned_on(browsing):
    browsing.context.add_init_script(
        """const Original = window.AudioContext;
        window.contexts = [];
        window.AudioContext = class extends Original {
          constructor(...words) {
            super(...words);
            contexts.push(this);
          }
        };"""
    )
    page = browsing.open()
    sound = page.locator("#sound")
    assert sound.get_attribute("aria-pressed") == "false"
    assert page.evaluate("contexts.length") == 0
    assert stats(page, "latency") is None
    sound.click()
    assert sound.get_attribute("aria-pressed") == "true"
    until(page, "contexts.length === 1 && contexts[0].state === 'running'")
    # The player receives samples from now on, and the sound is below full scale.
    plays_on(page, RATE // 2)
    until(page, "stridula.stats.peak > 1e-4")
    assert stats(page, "peak") < 0.71
    slide(page, 1.2)
    until(page, "Number.isFinite(stridula.stats.latency)")
    assert 0.0 < stats(page, "latency") < 30_000.0
    assert page.locator("#latency").text_content().endswith(" ms")
    sound.click()
    until(page, "contexts[0].state === 'suspended'")
    assert sound.get_attribute("aria-pressed") == "false"
    plays_on(page)


def test_the_level_follows_the_sound_and_states_its_full_scale(browsing):
    page = browsing.open("#case=strong-pressure")
    words = page.locator("#level-out")
    assert words.text_content() == "muted"
    page.locator("#sound").click()
    # At 0.1 Pa the limiter would take some 30 dB away.
    until(page, "/^full scale [\\d.]+ Pa$/.test(document.getElementById('scale-out').textContent)")
    until(page, "stridula.stats.reduction > 0.7 && stridula.stats.peak > 0.1")
    page.locator("#levelled").uncheck()
    until(page, "document.getElementById('scale-out').textContent === 'full scale 0.1 Pa'")
    until(page, "stridula.stats.reduction < 0.2")
    page.locator("#source").select_option("force")
    until(page, "document.getElementById('scale-out').textContent === 'full scale 20 N'")
    assert "20 N is full scale" in page.locator("#source-words").text_content()
    page.locator("#speed").select_option("100")
    page.wait_for_timeout(500)
    assert words.text_content() == "silent in slow motion"
    page.locator("#play").click()
    page.wait_for_timeout(500)
    assert words.text_content() == "silent while paused"
    page.locator("#sound").click()
    until(page, "document.getElementById('level-out').textContent === 'muted'")


def test_more_friction_changes_the_ribbon_within_a_second_of_time_played(browsing):
    page = browsing.open("#case=stable-sliding")
    until(page, "stridula.shares()[2] > 0.9")
    before = page.evaluate("stridula.shares()")
    slide(page, 1.5)
    told(page, "coefficient = 1.5")
    plays_on(page, RATE)
    after = page.evaluate("stridula.shares()")
    assert sum(after) == pytest.approx(1.0)
    # It squeals after some 0.4 s, the time its vibration takes to grow; before, it slid.
    assert before[1] == 0.0
    assert after[1] > 0.1
    assert shown(page, FRICTION) == 1.5
    until(page, "/sticking [1-9]\\d* %/.test(document.getElementById('shares').textContent)")


def test_every_control_has_its_unit_and_a_description(browsing):
    page = browsing.open()
    rows = page.locator("#controls .control:not([hidden])")
    assert rows.count() > 8
    for row in rows.all():
        words = row.locator("p.words")
        assert words.text_content().endswith(".")
        for one in row.locator("input, select").all():
            assert one.get_attribute("aria-describedby") == words.get_attribute("id")
    # Controls that a case does not have are hidden.
    assert page.locator("[data-key='drives.0.velocity']").first.is_hidden()
    page.locator("#drives-0-kind").select_option("imposed velocity")
    page.locator("input[type=number][data-key='drives.0.velocity']").wait_for(state="visible")
    assert page.locator("[data-key='drives.0.transverse']").first.is_hidden()
    plays_on(page)


def test_a_bad_file_is_reported_and_playing_continues(browsing, tmp_path):
    page = browsing.open()
    told(page, "coefficient = 1.5")
    page.locator("#scenario summary").click()
    upload(page, BAD)
    alert = page.locator("#problem")
    alert.wait_for(state="visible")
    (tmp_path / "bad.toml").write_text(BAD)
    with pytest.raises(ValueError) as refused:
        st.load_scenario(tmp_path / "bad.toml")
    assert alert.text_content() == str(refused.value)
    assert alert.get_attribute("role") == "alert"
    plays_on(page)
    assert "coefficient = 1.5" in page.evaluate("stridula.now().toml")
    # A valid value removes the message.
    upload(page, GOOD)
    alert.wait_for(state="hidden")
    told(page, "length = 0.45")


def test_a_user_file_plays_and_its_link_plays_the_same(browsing):
    page = browsing.open()
    upload(page, GOOD)
    told(page, "length = 0.45")
    plays_on(page)
    slide(page, 0.4)
    told(page, "coefficient = 0.4")
    until(page, "location.hash.includes('text=') && location.hash.includes('0.4')")
    other = browsing.open(page.evaluate("location.hash"))
    told(other, "coefficient = 0.4")
    now = "stridula.now()"
    assert other.evaluate(now)["toml"] == page.evaluate(now)["toml"]
    assert other.evaluate("stridula.scene.now") == page.evaluate("stridula.scene.now")
    assert shown(other, "slider.length") == 450.0


def test_a_link_holds_case_and_changes(browsing):
    page = browsing.open()
    page.locator("#case").select_option("judder")
    told(page, "coefficient = 1.1")
    slide(page, 1.3)
    slide(page, 50, "input[type=range][data-key='slider.angle']")
    page.locator("#contact-friction-law").select_option("stribeck")
    told(page, "stribeck")
    slide(page, 0.9, "input[type=range][data-key='contact.friction.static']")
    told(page, "static = 0.9")
    until(page, "location.hash.includes('static=0.9')")
    other = browsing.open(page.evaluate("location.hash"))
    told(other, "static = 0.9")
    assert other.evaluate("stridula.now().toml") == page.evaluate("stridula.now().toml")
    assert other.locator("#case").input_value() == "judder"
    assert shown(other, "slider.angle") == 50.0
    # A link also works within the same page.
    other.evaluate("location.hash = '#case=stable-sliding'")
    told(other, "coefficient = 0.5")


def test_an_invalid_link_is_reported(browsing):
    page = browsing.open("#text=%21%21%21")
    assert page.locator("#problem").is_visible()
    assert "link cannot be read" in page.locator("#problem").text_content()
    # It stays until something else is played.
    page.locator("#case").select_option("stable-sliding")
    page.locator("#problem").wait_for(state="hidden")
    until(page, "location.hash.includes('stable-sliding')")
    page.evaluate("location.hash = '#text=%21%21%21'")
    page.locator("#problem").wait_for(state="visible")


def test_undo_and_redo(browsing):
    page = browsing.open("#case=stable-sliding")
    undo, redo = page.locator("#undo"), page.locator("#redo")
    told(page, "coefficient = 0.5")
    assert undo.is_disabled()
    for value in (0.6, 0.7):
        slide(page, value)
        told(page, f"coefficient = {value}")
    undo.click()
    told(page, "coefficient = 0.6")
    page.keyboard.press("Control+z")
    told(page, "coefficient = 0.5")
    assert undo.is_disabled()
    redo.click()
    told(page, "coefficient = 0.6")
    page.keyboard.press("Control+y")
    told(page, "coefficient = 0.7")
    assert redo.is_disabled()
    until(page, "document.querySelector('input[type=number]').valueAsNumber === 0.7")


def test_slow_motion_steps_and_pauses(browsing):
    page = browsing.open()
    play, step = page.locator("#play"), page.locator("#step")
    assert step.is_disabled()
    play.click()
    assert play.text_content() == "Play"
    # Samples requested before still arrive.
    page.wait_for_timeout(500)
    before = stats(page, "samples")
    page.wait_for_timeout(700)
    assert stats(page, "samples") == before
    for taken in (1, 2, 3):
        step.click()
        until(page, f"stridula.stats.samples === {before + taken}")
    page.locator("#speed").select_option("1000")
    page.wait_for_timeout(300)
    assert stats(page, "samples") == before + 3
    play.click()
    plays_on(page, 8)
    page.locator("#speed").select_option("100")
    plays_on(page, 40)
    # Slow motion: less than a second of time was played.
    assert stats(page, "samples") < before + RATE
    page.locator("#speed").select_option("1")
    plays_on(page)


@pytest.mark.parametrize("format", ["wav", "nc", "png", "toml"])
def test_files_are_saved_and_open(browsing, format, tmp_path):
    page = browsing.open()
    plays_on(page, RATE // 4)
    if format == "toml":
        page.locator("#scenario summary").click()
    with page.expect_download() as saved:
        page.locator({"toml": "#toml-save"}.get(format, f"#save-{format}")).click()
    name = saved.value.suggested_filename
    assert name == ("scenario.toml" if format == "toml" else f"stridula.{format}")
    file = tmp_path / name
    saved.value.save_as(file)
    if format == "wav":
        assert np.abs(st.read_wav(file).values).max() > 1e-4
    elif format == "nc":
        assert st.load(file).normal_force.max() > 0.0
    elif format == "toml":
        assert st.load_scenario(file).system == st.load_scenario("squeal").system
    else:
        from matplotlib.image import imread

        height, width, _ = imread(io.BytesIO(file.read_bytes())).shape
        assert height > width / 2 > 200


def test_other_sources_are_heard(browsing):
    page = browsing.open()
    for source, unit in (("force", "[N]"), ("acceleration", "[m/s²]"), ("pressure", "[Pa]")):
        page.locator("#source").select_option(source)
        assert unit in page.locator(f"#source option[value={source}]").text_content()
        plays_on(page)
        until(page, "stridula.stats.level > 1e-5")
    with page.expect_download() as saved:
        page.locator("#save-wav").click()
    assert soundfile.info(saved.value.path()).samplerate == RATE


def test_the_map_appears_and_sets_values(browsing):
    page = browsing.open(map=True)
    until(page, "document.getElementById('map-words').textContent.includes('computed')")
    box = page.locator("#map").bounding_box()
    assert json.loads(json.dumps(page.evaluate("stridula.scene.now.overrides"))) == {}
    page.locator("#map").click(position={"x": box["width"] / 4, "y": box["height"] / 2})
    until(page, f"Object.keys(stridula.scene.now.overrides).includes('{FRICTION}')")
    overrides = page.evaluate("stridula.scene.now.overrides")
    assert set(overrides) == {FRICTION, "slider.angle"}
    assert 0.2 < overrides[FRICTION] < 0.6
    plays_on(page)
