"""The demonstration of the home page in a browser: what it plays, shows and says."""

from __future__ import annotations

import shutil
import sys

import numpy as np
import pytest
from app.browsing import launched
from axe_playwright_python.sync_playwright import Axe

from .pages import ROOT
from .test_demonstration import CASES, DATA, pressures

sys.path.insert(0, str(ROOT / "docs"))

from demonstration import page as written

RATE = 48_000
PAGE = """<!DOCTYPE html><html lang="en" data-theme="light"><head><title>Demonstration</title>
<link rel="stylesheet" href="_static/demonstration/style.css"></head><body><main><h1>Demonstration</h1>
{}</main></body></html>"""
SHOWN = "document.querySelector('[data-part=now]').textContent"
PLAYING = "window.stridulaDemonstration.playing"
PICTURE = "document.querySelector('[data-part=body]').toDataURL()"


@pytest.fixture(scope="module")
def chromium():
    with launched("--autoplay-policy=user-gesture-required") as browser:
        yield browser


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Write the demonstration alone on a page."""
    folder = tmp_path_factory.mktemp("page")
    shutil.copytree(ROOT / "docs" / "_static", folder / "_static")
    (folder / "index.html").write_text(PAGE.format(written.html()), encoding="utf-8")
    return (folder / "index.html").as_uri()


@pytest.fixture
def opened(chromium, address):
    """Return a function that opens the page; none may log an error."""
    contexts, complaints = [], []

    def opening(**words):
        contexts.append(chromium.new_context(**({"viewport": {"width": 1000, "height": 800}} | words)))
        page = contexts[-1].new_page()
        page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(address)
        return page

    yield opening
    for context in contexts:
        context.close()
    assert complaints == []


def numbered(case, condition):
    """Return the first setting of a case on which a condition holds, with its column and row."""
    rows = len(case["y"]["values"])
    k = next(k for k, one in enumerate(case["settings"]) if condition(one))
    return case["settings"][k], k // rows, k % rows


def sounds(one):
    return one["level"] is not None


@pytest.mark.parametrize("name", CASES)
def test_what_is_played_has_the_lines_of_the_settings(opened, name):
    """The samples of a setting are the sum of its lines [Pa]."""
    page, rng = opened(), np.random.default_rng(len(name))
    audible = [one for one in CASES[name]["settings"] if sounds(one)]
    for k in rng.choice(len(audible), 3, replace=False):
        one = audible[k]
        duration = max(20.0 / one["base"], 0.1)
        samples = page.evaluate(
            "([one, duration, rate]) => window.stridulaDemonstration.rendered(one, duration, rate)",
            [one, duration, RATE],
        )
        time = np.arange(len(samples)) / RATE
        lines = pressures(one)
        turns = np.exp(2j * np.pi * one["base"] * np.outer(time, list(lines)))
        expected = (turns @ np.array(list(lines.values()))).real
        # Browsers interpolate in tables of 4096 samples: of 27 settings Chromium renders the worst to 0.2 %.
        rms = float(np.sqrt(np.mean(expected**2)))
        assert float(np.sqrt(np.mean((samples - expected) ** 2))) < 0.02 * rms
        # Negative control: an octave higher.
        octave = (turns**2 @ np.array(list(lines.values()))).real
        assert float(np.sqrt(np.mean((samples - octave) ** 2))) > 0.5 * rms


def test_settings_follow_each_other_at_equal_power(opened):
    page = opened()
    one, *_ = numbered(CASES["glass"], sounds)
    gains = page.evaluate(
        """async (one) => {
          const { Voice, FADE } = window.stridulaDemonstration;
          const context = new OfflineAudioContext(1, 48000, 48000);
          const [first, second] = [new Voice(context, one, 1), new Voice(context, one, 1)];
          first.change = { from: 1, to: 1, start: -1 };
          first.turn(0);
          second.turn(1);
          const times = [0, 0.1, 0.3, 0.5, 0.9, 1].map((part) => part * FADE);
          return times.map((time) => [first.at(time), second.at(time)]);
        }""",
        one,
    )
    powers = np.square(gains).sum(axis=1)
    np.testing.assert_allclose(powers, 1.0, atol=1e-12)
    assert gains[0] == [1.0, 0.0]
    assert gains[-1] == [0.0, 1.0]


def test_nothing_sounds_before_a_click_nor_where_a_setting_is_silent(opened):
    page = opened()
    assert page.evaluate(f"{PLAYING}.sound.context === null")
    page.locator("[data-part=x]").focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate(f"{PLAYING}.sound.context === null")
    page.get_by_role("button", name="Sound on").click()
    page.wait_for_function(f"{PLAYING}.sound.voice !== null && {PLAYING}.sound.context.state === 'running'")
    assert page.get_by_role("button", name="Sound off").get_attribute("aria-pressed") == "true"
    # Changes during a change.
    for row in range(len(CASES["glass"]["y"]["values"])):
        page.evaluate(f"(row) => {PLAYING}.choose([1, row])", row)
        page.wait_for_timeout(30)
    _, column, row = numbered(CASES["glass"], lambda one: not sounds(one))
    page.evaluate(f"([column, row]) => {PLAYING}.choose([column, row])", [column, row])
    assert page.evaluate(f"{PLAYING}.sound.voice === null")
    assert "silent" in page.evaluate(SHOWN)


def test_keys_and_pointer_choose_settings_and_words_follow(opened):
    page = opened()
    case = CASES["glass"]
    column, row = case["start"]
    rows = len(case["y"]["values"])
    page.locator("[data-part=y]").focus()
    page.keyboard.press("ArrowUp")
    one = case["settings"][column * rows + row + 1]
    assert page.locator("[data-part=y]").get_attribute("aria-valuetext") == f"{case['y']['values'][row + 1]:g} N"
    first = DATA["words"][one["regime"]].split(" {}")[0]
    words, number, unit = page.evaluate(SHOWN).rsplit(" ", 2)
    assert (words, unit) == (first, "Hz")
    assert abs(float(number) - one["pitch"]) <= 0.5
    box = page.locator("[data-part=map]").bounding_box()
    columns = len(case["x"]["values"])
    x = box["x"] + box["width"] * 0.5 / columns
    y = box["y"] + box["height"] * (1.0 - 0.5 / rows)
    page.mouse.click(x, y)
    assert page.evaluate(f"{PLAYING}.setting()") == case["settings"][0]
    page.get_by_label("Violin string").check()
    assert page.evaluate(f"{PLAYING}.setting()") in CASES["violin"]["settings"]


def test_less_motion_is_still_until_it_is_asked_for(opened):
    page = opened(reduced_motion="reduce")
    page.wait_for_timeout(300)
    before = page.evaluate(PICTURE)
    page.wait_for_timeout(500)
    assert page.evaluate(PICTURE) == before
    page.get_by_role("button", name="Move").click()
    page.wait_for_timeout(500)
    assert page.evaluate(PICTURE) != before


@pytest.mark.parametrize("width", [390, 1440])
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_it_fits_and_axe_finds_no_problem(opened, width, theme):
    page = opened(viewport={"width": width, "height": 844})
    page.evaluate("(theme) => (document.documentElement.dataset.theme = theme)", theme)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.locator("[data-part=sound]").bounding_box()["y"] < 844
    found = Axe().run(page, options={"preload": False}).response["violations"]
    assert [(one["id"], one["nodes"][0]["target"]) for one in found] == []
