"""Accessibility of the page: keyboard, phone, dark and light themes, screen readers."""

from __future__ import annotations

import pytest
from axe_playwright_python.sync_playwright import Axe

from .browsing import Browsing, plays_on, stats, until

AXE = Axe()
FRICTION, ANGLE = "contact.friction.coefficient", "slider.angle"
PHONE = {"viewport": {"width": 390, "height": 800}}
REACHED = "button, select, input, textarea, summary, a[href], canvas[tabindex]"
SEEN = f"""() => [...document.querySelectorAll('{REACHED}')].filter((one) =>
  !one.disabled && one.checkVisibility({{ visibilityProperty: true }}) && !one.closest('dialog:not([open])'))"""


def grave(page) -> list[str]:
    """Return the problems that axe calls serious or critical, with their places."""
    found = AXE.run(page).response
    return [
        f"{one['id']}: {node['target']} {node['failureSummary']}"
        for one in found["violations"]
        if one["impact"] in ("serious", "critical")
        for node in one["nodes"]
    ]


@pytest.fixture(params=["light", "dark", "phone"])
def shown(request, chromium, server):
    """Open the page with different settings of the browser."""
    words = {"color_scheme": "dark"} if request.param == "dark" else PHONE if request.param == "phone" else {}
    with Browsing(chromium, server, bypass_csp=True, **words) as browsing:
        yield browsing


def test_axe_finds_no_serious_problem(shown):
    page = shown.open()
    page.locator("#scenario summary").click()
    assert grave(page) == []
    # Nor while it shows an error, with a disabled button visible.
    page.locator("#toml").fill("no TOML")
    page.locator("#toml-apply").click()
    page.locator("#problem").wait_for(state="visible")
    page.locator("#play").click()
    assert grave(page) == []


def test_axe_finds_no_serious_problem_in_a_system_on_tour_and_among_instruments(shown):
    page = shown.open("#case=violin")
    assert grave(page) == []
    page.locator("#record").click()
    page.locator("#tour-begin").click()
    # The first stop is recorded; a violin in slow motion is not.
    until(page, "stridula.stats.revision >= 2")
    plays_on(page)
    page.locator("#slot-b").click()
    page.locator("#record").click()
    page.locator("#recording").wait_for(state="visible")
    assert grave(page) == []
    page.locator("#tour-leave").click()
    page.locator("#instruments").click()
    assert page.locator("#gallery").is_visible()
    assert grave(page) == []


def test_axe_finds_no_serious_problem_in_the_introduction(shown):
    page = shown.open(intro=True)
    assert page.locator("#intro").is_visible()
    assert grave(page) == []


def test_axe_finds_a_serious_problem(chromium, server):
    with Browsing(chromium, server, bypass_csp=True) as browsing:
        page = browsing.open()
        page.evaluate("document.getElementById('play').textContent = ''")
        page.evaluate("document.getElementById('case-words').style.color = '#eee'")
        assert {line.partition(":")[0] for line in grave(page)} >= {"button-name", "color-contrast"}


def test_the_theme_follows_the_system_until_it_is_chosen(chromium, server):
    with Browsing(chromium, server, color_scheme="dark") as browsing:
        page = browsing.open()
        theme = "document.documentElement.dataset.theme"
        assert page.evaluate(theme) == "dark"
        page.locator("#theme").click()
        assert page.evaluate(theme) == "light"
        page.reload()
        plays_on(page, 0)
        assert page.evaluate(theme) == "light"


@pytest.mark.parametrize("intro", [False, True])
def test_a_phone_need_not_scroll_sideways(chromium, server, intro):
    with Browsing(chromium, server, **PHONE) as browsing:
        page = browsing.open(intro=intro)
        if not intro:
            page.locator("#scenario summary").click()
        width = "document.documentElement"
        assert page.evaluate(f"{width}.scrollWidth") <= page.evaluate(f"{width}.clientWidth") == 390
        # Nothing is cut off: all visible elements lie within.
        assert page.evaluate(f"({SEEN})().filter((one) => one.getBoundingClientRect().right > 390.5).length") == 0


@pytest.mark.parametrize("width", [390, 800, 1120, 1360, 1920])
def test_all_frames_are_as_wide_as_the_page(chromium, server, width):
    with Browsing(chromium, server, viewport={"width": width, "height": 900}) as browsing:
        page = browsing.open()
        # On a phone the settings of the sound lie among the pictures, without a frame.
        edges = page.evaluate(
            """(upper) => [upper, '#scenario', 'main'].map((one) => {
              const found = document.querySelector(one).getBoundingClientRect();
              return [found.left, found.right];
            })""",
            ".pictures" if width < 860 else ".sound",
        )
        (_, upper), (left, right), (first, last) = edges
        assert upper == pytest.approx(right, abs=0.5)
        assert last - right == pytest.approx(left - first, abs=0.5)
        # The beams are visible at once.
        if width >= 1360:
            assert page.locator("#beams").bounding_box()["y"] < 240


def test_the_keyboard_reaches_everything(browsing):
    page = browsing.open()
    page.locator("#scenario summary").click()
    page.locator("#tour-begin").click()
    page.locator("#tour-next").click()
    # The controls are those of the second stop.
    until(page, "stridula.stats.revision >= 3")
    page.evaluate("document.activeElement.blur()")
    page.evaluate(f"window.wanted = ({SEEN})()")
    count = page.evaluate("wanted.length")
    assert count > 40
    page.evaluate("window.reached = new Set(); window.unseen = []")
    for _ in range(count + 20):
        page.keyboard.press("Tab")
        page.evaluate(
            """() => {
              const one = document.activeElement;
              reached.add(one);
              const shown = one.closest('.file') ?? one;
              if (one !== document.body && getComputedStyle(shown).outlineStyle === 'none') unseen.push(one.id);
            }"""
        )
    name = "(one) => one.id || one.dataset.key || one.textContent"
    assert page.evaluate(f"wanted.filter((one) => !reached.has(one)).map({name})") == []
    # The focus is visible.
    assert page.evaluate("unseen") == []


def test_space_pauses_where_nothing_else_takes_it(browsing):
    page = browsing.open()
    play = page.locator("#play")
    page.keyboard.press("Space")
    assert play.text_content() == "Play"
    page.keyboard.press("Space")
    assert play.text_content() == "Pause"
    plays_on(page)
    # A dragged slider does not use the space key, but it uses the keys of a slider.
    for slide in ("#contact-friction-coefficient-slide", "#volume"):
        before = page.locator(slide).input_value()
        page.locator(slide).click(position={"x": 20, "y": 8})
        assert page.locator(slide).input_value() != before
        page.keyboard.press("Space")
        assert play.text_content() == "Play"
        page.keyboard.press("Space")
        assert play.text_content() == "Pause"
        before = page.locator(slide).input_value()
        page.keyboard.press("ArrowLeft")
        assert page.locator(slide).input_value() != before
    # On a button it presses the button, in a box it checks it.
    page.locator("#levelled").focus()
    page.keyboard.press("Space")
    assert not page.locator("#levelled").is_checked()
    assert play.text_content() == "Pause"
    page.locator("#theme").focus()
    theme = page.locator("#theme").text_content()
    page.keyboard.press("Space")
    assert page.locator("#theme").text_content() != theme
    assert play.text_content() == "Pause"


def test_arrow_keys_move_the_cross_hair(browsing):
    page = browsing.open("#case=stable-sliding")
    values = "stridula.now().values"
    before = page.evaluate(values)
    page.locator("#map").focus()
    for key, moved, sign in (
        ("ArrowRight", FRICTION, 1),
        ("ArrowLeft", FRICTION, -1),
        ("ArrowUp", ANGLE, 1),
        ("ArrowDown", ANGLE, -1),
    ):
        start = page.evaluate(values)[moved]
        page.keyboard.press(key)
        until(page, "arg[2] * (stridula.now().values[arg[0]] - arg[1]) > 1e-3", [moved, start, sign])
    after = page.evaluate(values)
    assert after[FRICTION] == pytest.approx(before[FRICTION], abs=0.01)
    assert after[ANGLE] == pytest.approx(before[ANGLE], abs=0.01)
    assert stats(page, "samples") > 0
    plays_on(page)


def test_changes_are_announced_to_screen_readers(browsing):
    page = browsing.open()
    assert page.locator("#said").get_attribute("aria-live") == "polite"
    page.locator("#link").click()
    until(page, "document.getElementById('said').textContent || !document.getElementById('problem').hidden")
    assert page.locator("#source").get_attribute("aria-describedby") == "source-words"
    for canvas in page.locator("canvas").all():
        assert canvas.get_attribute("aria-label")
        assert canvas.get_attribute("role") in ("img", "application")
