"""Features of the page: one view, instruments, two settings, the tour, dragging, recording, sharing."""

from __future__ import annotations

import re

import numpy as np
import pytest
import soundfile

from stridula.app.playable import CASES
from stridula.app.tour import STOPS

from .browsing import Browsing, plays_on, shown, stats, until
from .conversation import RATE

FRICTION, LOAD, VELOCITY = "contact.friction.coefficient", "drives.0.normal_load", "drives.0.velocity"
NOW = "stridula.scene.now"
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True}
WRITTEN = """window.written = new Set();
const write = OffscreenCanvasRenderingContext2D.prototype.fillText;
OffscreenCanvasRenderingContext2D.prototype.fillText = function (words, ...where) {
  written.add(words);
  return write.call(this, words, ...where);
};"""
PICTURES = ("beams", "timeline", "phase", "spectrogram", "map")


def slide(page, key: str, value: float) -> None:
    """Type a number as a user does."""
    field = page.locator(f"input[type=number][data-key='{key}']")
    field.fill(str(value))
    field.press("Enter")


def plays(page, key: str, value: float) -> None:
    """Wait until the server plays a value."""
    until(page, "Math.abs(stridula.now()?.values[arg[0]] - arg[1]) < 1e-9", [key, value])


def inside(page, place: str) -> bool:
    """Return whether all of an element can be seen without scrolling, and only notices lie over its corners."""
    return page.locator(place).first.evaluate(
        """(one) => {
          const { left, top, right, bottom } = one.getBoundingClientRect();
          if (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight) return false;
          return [[left + 2, top + 2], [right - 2, bottom - 2]].every(([x, y]) => {
            const found = document.elementFromPoint(x, y);
            return one.contains(found) || found.contains(one) || found.closest(".notices") !== null;
          });
        }"""
    )


@pytest.mark.parametrize("size", [(1440, 900), (1280, 800), (1920, 1080)], ids=str)
@pytest.mark.parametrize("case", ["squeal", "violin"])
def test_all_is_in_one_view(chromium, server, size, case):
    with Browsing(chromium, server, viewport=dict(zip(("width", "height"), size, strict=True))) as browsing:
        page = browsing.open(f"#case={case}")
        wanted = [*(f"#{name}" for name in PICTURES), "#now", "#play", "#sound", "#record", "#slot-a", "#tour-begin"]
        wanted += ["#instruments", "#controls", "#controls .control:not([hidden]) input[type=range]", "#volume"]
        assert [one for one in wanted if not inside(page, one)] == []
        # Pictures are large enough to be read.
        for name in PICTURES:
            box = page.locator(f"#{name}").bounding_box()
            assert box["height"] >= 150, name
            assert box["width"] >= 130, name
        assert page.evaluate("document.getElementById('controls').scrollHeight") > page.evaluate("innerHeight") / 2


def test_a_phone_has_the_bodies_and_the_first_slider_in_one_view(chromium, server):
    with Browsing(chromium, server, **PHONE) as browsing:
        page = browsing.open()
        slider = f"input[type=range][data-key='{FRICTION}']"
        for place in ("#now", "#play", "#sound", "#beams", slider, "#undo"):
            assert inside(page, place), place
        # It scrolls with the page, and can be closed.
        page.evaluate("scrollTo(0, 900)")
        assert inside(page, slider)
        page.locator("#drawer").tap()
        assert page.locator("#drawer").get_attribute("aria-expanded") == "false"
        assert page.locator(slider).is_hidden()
        page.locator("#drawer").tap()
        assert inside(page, slider)
        small = page.evaluate(
            """[...document.querySelectorAll('button, select, summary, input:not([type=file])')]
              .filter((one) => one.checkVisibility() && !one.closest('dialog'))
              .map((one) => [one.id || one.dataset.key, one.closest('label.check') ?? one])
              .map(([name, one]) => [name, one.getBoundingClientRect().height])
              .filter(([, height]) => height < 43.5)"""
        )
        assert small == []


def test_instruments_are_one_group_of_pictures(browsing):
    page = browsing.open()
    page.locator("#instruments").click()
    cards = page.locator("#cards .card")
    assert cards.count() == len(CASES)
    # Every case of the page has its own picture.
    pictures = {card.locator("svg").inner_html() for card in cards.all()}
    assert len(pictures) == len(CASES)
    assert page.locator("#cards input:checked").input_value() == "squeal"
    page.keyboard.press("ArrowRight")
    until(page, "stridula.now().title === 'Judder'")
    assert page.locator("#gallery").is_visible()
    assert page.locator("#case").input_value() == "judder"
    page.keyboard.press("Enter")
    page.locator("#gallery").wait_for(state="hidden")
    page.locator("#instruments").click()
    cards.filter(has_text="violin").or_(cards.filter(has_text="Violin")).first.click()
    page.locator("#gallery").wait_for(state="hidden")
    until(page, "stridula.now().title.startsWith('Violin')")
    assert page.locator("#instrument").inner_html() in pictures
    page.locator("#case").select_option("belt")
    until(page, "stridula.now().title.includes('belt')")
    assert page.locator("#cards input:checked").input_value() == "belt"


def test_a_case_without_a_picture_has_a_plain_one(browsing):
    page = browsing.open()
    found = page.evaluate(
        """import('./sketches.js').then(({ sketchOf }) =>
          ['nonsense', 'toString', 'squeal'].map((name) => sketchOf(name).paths.length))"""
    )
    assert min(found) > 0


def test_two_settings_are_compared_and_each_has_its_own_undo(browsing):
    page = browsing.open("#case=stable-sliding")
    a, b = page.locator("#slot-a"), page.locator("#slot-b")
    assert (a.get_attribute("aria-pressed"), b.get_attribute("aria-pressed")) == ("true", "false")
    slide(page, FRICTION, 0.6)
    plays(page, FRICTION, 0.6)
    page.locator("#slot-b").click()
    until(page, "document.getElementById('slot-b').getAttribute('aria-pressed') === 'true'")
    # B begins as a copy.
    assert page.evaluate(NOW)["overrides"] == {FRICTION: 0.6}
    assert page.locator("#undo").is_disabled()
    slide(page, FRICTION, 0.9)
    plays(page, FRICTION, 0.9)
    stroke = page.evaluate("stridula.now().goes_on")
    assert stroke
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("b")
    plays(page, FRICTION, 0.6)
    assert a.get_attribute("aria-pressed") == "true"
    # The motion continues, and the link has the present setting.
    assert page.evaluate("stridula.now().goes_on")
    until(page, "location.hash.includes('=0.6')")
    page.locator("#undo").click()
    plays(page, FRICTION, 0.5)
    page.keyboard.press("b")
    plays(page, FRICTION, 0.9)
    until(page, "location.hash.includes('=0.9')")
    assert shown(page, FRICTION) == 0.9
    page.keyboard.press("Control+z")
    plays(page, FRICTION, 0.6)
    # In text and selection fields letters are not shortcuts.
    page.locator("#case").focus()
    page.keyboard.press("b")
    assert b.get_attribute("aria-pressed") == "true"


def test_the_tour_goes_through_its_stops_by_keys(browsing):
    page = browsing.open("#case=belt")
    tour = page.locator("#tour")
    assert tour.is_hidden()
    page.locator("#tour-begin").focus()
    page.keyboard.press("Enter")
    for number, stop in enumerate(STOPS, start=1):
        until(page, "document.getElementById('tour-title').textContent === arg", stop.title)
        assert page.locator("#tour-where").text_content() == f"Stop {number} of {len(STOPS)}"
        assert page.locator("#tour-words").text_content() == stop.words
        assert page.evaluate(NOW) == {"case": stop.case, "text": None, "overrides": stop.overrides}
        assert page.locator("figure.meant canvas").get_attribute("id") == stop.look
        until(page, "stridula.now().toml && stridula.stats.revision >= arg", number)
        assert inside(page, "figure.meant")
        assert inside(page, "#tour")
        assert page.locator("#problem").is_hidden()
        if number < len(STOPS):
            page.keyboard.press("Enter")
    # The last one compares.
    page.keyboard.press("b")
    plays(page, LOAD, STOPS[-1].compared[LOAD])
    page.locator("#tour-back").click()
    assert page.locator("#tour-title").text_content() == STOPS[-2].title
    page.locator("#tour-leave").click()
    assert tour.is_hidden()
    assert page.locator("figure.meant").count() == 0
    assert page.evaluate("document.activeElement.id") == "tour-begin"
    plays_on(page)


def test_bodies_are_dragged_by_hand_and_return(browsing):
    page = browsing.open("#case=weak-pressure")
    until(page, "document.getElementById('hand').textContent.startsWith('drag')")
    before = page.evaluate(NOW)
    box = page.locator("#beams").bounding_box()
    x, y = box["x"] + box["width"] / 3, box["y"] + box["height"] / 2
    page.evaluate(
        """() => {
          const { scene } = stridula;
          const go = scene.onChange;
          stridula.asked = [];
          scene.onChange = () => {
            stridula.asked.push(structuredClone(scene.now.overrides));
            go();
          };
        }"""
    )
    page.mouse.move(x, y)
    page.mouse.down()
    # As a notice above the picture moves it.
    page.evaluate("document.querySelector('main').style.marginTop = '60px'")
    for step in range(30):
        page.mouse.move(x + 5 * step, y + 2 * step)
        page.wait_for_timeout(20)
    until(page, "stridula.asked.some((one) => one[arg] > 0)", VELOCITY)
    until(page, "stridula.now().values[arg] > 3", LOAD)
    page.mouse.up()
    plays(page, LOAD, 2.0)
    plays(page, VELOCITY, 0.01)
    assert page.evaluate(NOW) == before
    assert page.locator("#undo").is_disabled()
    asked = page.evaluate("stridula.asked")
    assert asked[-1] == {}
    assert [set(one) for one in asked[:-1]] == [{VELOCITY, LOAD}] * (len(asked) - 1)
    assert all(-0.1 <= one[VELOCITY] <= 0.1 and 0.0 <= one[LOAD] <= 100.0 for one in asked[:-1])
    assert page.locator("#problem").is_hidden()
    # The same from the keyboard.
    page.locator(f"input[type=range][data-key='{LOAD}']").press("ArrowRight")
    until(page, "stridula.now().values[arg] > 2", LOAD)


def test_sound_is_recorded_between_two_presses(browsing):
    page = browsing.open("#case=strong-pressure")
    record = page.locator("#record")
    assert page.locator("#recording").is_hidden()
    record.click()
    assert record.get_attribute("aria-pressed") == "true"
    before = stats(page, "samples")
    plays_on(page, RATE // 2)
    record.click()
    most = stats(page, "samples") - before
    with page.expect_download() as saved:
        page.locator("#recording").click()
    assert saved.value.suggested_filename == "stridula-recording.wav"
    values, rate = soundfile.read(saved.value.path())
    assert rate == RATE
    assert RATE // 2 <= len(values) <= most + RATE // 2
    assert np.abs(values).max() == pytest.approx(10.0 ** (-1.0 / 20.0), rel=1e-3)
    with soundfile.SoundFile(saved.value.path()) as file:
        assert file.comment.endswith(" Pa")
    # Slow motion is not recorded.
    page.locator("#speed").select_option("100")
    page.wait_for_timeout(300)
    record.click()
    plays_on(page, 40)
    record.click()
    assert page.locator("#recording").is_hidden()
    assert page.locator("#unrecorded").text_content() == "There was no sound, so nothing was recorded."
    assert page.locator("#unrecorded").is_visible()


@pytest.mark.parametrize("can_share", [False, True])
def test_the_link_is_shared_where_the_browser_can(browsing, can_share):
    share = "(words) => { window.shared = words; return Promise.resolve(); }" if can_share else "undefined"
    browsing.context.add_init_script(f"Object.defineProperty(navigator, 'share', {{ value: {share} }})")
    page = browsing.open("#case=judder")
    button = page.locator("#share")
    assert button.is_visible() == can_share
    assert page.locator("#link").is_visible()
    if can_share:
        button.click()
        until(page, "window.shared?.url.endsWith('#case=judder')")


def test_the_note_is_named_where_there_is_a_tone(browsing):
    page = browsing.open("#case=squeal")
    until(page, "/^[A-G]♯?\\d( [+−]\\d+ cents)?/.test(document.getElementById('note').textContent)")
    assert re.match("squeals at|sticks and slips", page.locator("#now").text_content())
    page.locator("#case").select_option("judder")
    until(page, "document.getElementById('now').textContent.startsWith('judders')")
    assert page.locator("#note").text_content() == ""


def test_a_sticking_tip_shows_text_instead_of_a_portrait(browsing):
    browsing.context.add_init_script(WRITTEN)
    stick = STOPS[0]
    values = "&".join(f"{key}={value}" for key, value in stick.overrides.items())
    page = browsing.open(f"#case={stick.case}&{values}")
    until(page, "written.has('The tip sticks:')")
    written = page.evaluate("[...written].map(String)")
    assert {"time before now [s]", "force [N]", "frequency [kHz]", "level [dB]"} <= set(written)
    assert [one for one in written if "NaN" in one or "undefined" in one] == []


def test_before_the_first_spectrum_text_says_when_it_comes(browsing):
    browsing.context.add_init_script(WRITTEN)
    page = browsing.open()
    draw = """(samples) => import('./spectrogram.js').then(({ Spectrogram }) => {
      written.clear();
      const draw = document.createElement('canvas').getContext('2d');
      const spectrogram = new Spectrogram();
      spectrogram.hear(new Float32Array(samples).map((_, i) => Math.sin(i)));
      spectrogram.draw([draw, 300, 200], [], { line: '#000', soft: '#000' }, false);
      return [...written].map(String);
    })"""
    assert page.evaluate(draw, 1000) == ["The first spectrum appears", "after 21 ms played."]
    assert "frequency [kHz]" in page.evaluate(draw, 1024)
    # A system slower than real time states its speed first.
    page.evaluate("stridula.keepUp(0.1)")
    assert page.locator("#speed option:checked").text_content() == "Slow, 1 : 11, as fast as possible"


GAPS = """(speeds) => speeds.map((speed) => {
  stridula.follow(speed);
  stridula.fallBehind(true);
  const [behind, pace, shown] = ["behind", "pace", "speed"].map((id) => document.getElementById(id));
  return [behind.hidden, pace.textContent, shown.value];
})"""


def test_a_system_hardly_faster_than_real_time_is_shown_slower_if_its_sound_has_gaps(browsing):
    page = browsing.open("#case=belt")
    until(page, "stridula.now().speed > 1.5")
    # Gaps at an ample speed have another cause, which is stated.
    ample, barely, again, back = page.evaluate(GAPS, [2.0, 1.2, 1.2, 2.0])
    assert ample == back == [False, "", "1"]
    words = "Shown 1.2 times slower than real time, as fast as this machine can, and without sound."
    assert barely == again == [True, words, "1.2"]


def test_notices_come_and_go_without_moving_the_page(browsing):
    page = browsing.open()
    places = """() => ['beams', 'timeline', 'phase', 'spectrogram', 'map', 'controls', 'record'].map((id) => {
      const { x, y, width, height } = document.getElementById(id).getBoundingClientRect();
      return [x, y, width, height];
    })"""
    page.wait_for_timeout(500)
    before = page.evaluate(places)
    page.evaluate("stridula.fallBehind(true)")
    page.locator("#preparing").evaluate("(one) => (one.hidden = false)")
    page.locator("#scenario summary").click()
    page.locator("#toml").fill("no TOML")
    page.locator("#toml-apply").click()
    page.locator("#problem").wait_for(state="visible")
    page.locator("#record").click()
    page.wait_for_timeout(300)
    page.locator("#record").click()
    page.locator("#recording").wait_for(state="visible")
    page.evaluate("scrollTo(0, 0)")
    assert np.allclose(page.evaluate(places), before, atol=0.6)
    page.locator("#problem-close").click()
    assert page.locator("#problem").is_hidden()
    assert page.locator("#problem-close").is_hidden()


def test_three_controls_come_first_and_the_others_on_request(browsing):
    browsing.context.add_init_script("sessionStorage.getItem('asked') ?? localStorage.setItem('more', '0')")
    page = browsing.open("#case=weak-pressure")
    numbers = "[...document.querySelectorAll('#controls input[type=number]')].filter((one) => one.checkVisibility())"
    keys = f"{numbers}.map((one) => one.dataset.key)"
    main = ["contact.friction.coefficient", "drives.0.normal_load", "drives.0.velocity"]
    assert page.evaluate(keys) == main
    page.locator("#more summary").click()
    assert page.evaluate(keys)[:3] == main
    assert len(page.evaluate(keys)) > 8
    # Another law has other controls; a value that is refused opens the others.
    page.locator("#contact-friction-law").select_option("static-kinetic")
    until(page, f"{keys}[0] === 'contact.friction.static'")
    page.locator("#more summary").click()
    page.evaluate("stridula.scene.values({ 'slider.length': -1 })")
    until(page, "document.getElementById('more').open")


def test_sliders_end_where_other_values_bound_them(browsing):
    page = browsing.open("#case=squeal&track.length=0.9")
    at = page.locator("input[type=range][data-key='contact.at']")
    assert float(at.get_attribute("max")) == 899.0
    at.evaluate("(one) => { one.value = one.max; one.dispatchEvent(new Event('input')); }")
    until(page, "stridula.now().values['contact.at'] === 0.899")
    assert page.locator("#controls .refused:not([hidden])").count() == 0
