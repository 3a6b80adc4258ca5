"""Systems in space in a browser: drawing, turning the view, and looped sound of slow systems."""

from __future__ import annotations

import io

import numpy as np
import pytest
from matplotlib.image import imread

from .browsing import Browsing, launched, pause, until
from .test_page_access import grave

SOFTWARE = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
DRAWN = "window.stridula && stridula.space.ready && Boolean(stridula.space.drawn)"
CASE = "#case=pin-on-disc"
SLIDER = """() => {
  const slider = document.querySelector("#controls .control:not([hidden]) input[type=range]");
  slider.value = (Number(slider.min) + Number(slider.max)) / 2;
  for (const name of ["input", "change"]) slider.dispatchEvent(new Event(name));
}"""
LOADED = "performance.getEntriesByType('resource').filter(({ name }) => name.includes('three')).length"


@pytest.fixture(scope="module")
def chromium():
    """Start a browser with software rendering."""
    with launched(*SOFTWARE) as browser:
        yield browser


def opened(browsing, case: str = CASE):
    """Open a page whose system is slow, and wait until it is drawn."""
    browsing.context.add_init_script("localStorage.setItem('visited', '1')")
    page = browsing.begin(case)
    until(page, DRAWN)
    return page


def seen(page) -> np.ndarray:
    """Return the visible picture in space as colours of pixels."""
    page.evaluate("stridula.space.again()")
    return imread(io.BytesIO(page.locator("#space").screenshot()))[..., :3]


def share_of(picture: np.ndarray, colour: str) -> float:
    wanted = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    return float((np.abs(picture - wanted).max(axis=2) < 0.06).mean())


def test_a_system_in_space_is_drawn_with_its_contacts(browsing):
    page = opened(browsing)
    assert page.locator("#beams").is_hidden()
    assert page.locator("#space-missing").is_hidden()
    assert page.locator("#space-high").text_content().endswith("m/s")
    pause(page)
    picture = seen(page)
    assert len(np.unique((255 * picture).astype(int).reshape(-1, 3), axis=0)) > 200
    # The lit disc is visible: much of it is as light as the panel, so its shaded sides are tested.
    assert ((picture.max(axis=2) < 0.9) & (picture.min(axis=2) > 0.4)).mean() > 0.01
    states = page.evaluate("Array.from(stridula.space.dots.geometry.attributes.color.array)")
    assert len(states) == 15
    colours = {"separated": "#56b4e9", "sticking": "#d55e00", "sliding": "#f0e442"}
    assert sum(share_of(picture, colour) for colour in colours.values()) > 1e-4


def test_the_view_turns_by_keys_and_mouse(browsing):
    page = opened(browsing)
    pause(page)
    canvas = page.locator("#space")
    first = seen(page)
    assert np.array_equal(seen(page), first)
    canvas.focus()
    different = []
    for key in ("ArrowLeft", "ArrowUp", "+", "Home"):
        page.keyboard.press(key)
        different.append(float(np.abs(seen(page) - first).mean()))
    assert min(different[:3]) > 1e-3
    assert different[-1] < 0.01 * min(different[:3])
    # Turning the view moves nothing else.
    assert page.locator("#play").text_content() == "Play"
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(box["x"] + 180, box["y"] + 130)
    page.mouse.up()
    assert np.abs(seen(page) - first).mean() > 1e-3
    assert page.evaluate("[stridula.space.orbit.azimuth, stridula.space.orbit.elevation]") != pytest.approx(
        [7 * np.pi / 36, np.pi / 6]
    )


TURNED = """async ([azimuth, others]) => {
  const { space } = stridula;
  space.orbit.turn(azimuth, 0);
  space.orbit.scale(0.5);
  const shapes = () => space.renderer.info.memory.geometries;
  space.again();
  const before = [space.orbit.azimuth, space.orbit.zoom, shapes()];
  const described = structuredClone(stridula.now());
  if (others) for (const [k, one] of described.surfaces.entries()) one.name = `other ${k}`;
  await space.describe({ ...described, drawn: `others: ${others}` });
  space.again();
  return [before, [space.orbit.azimuth, space.orbit.zoom, shapes()]];
}"""


def test_the_view_stays_while_values_of_the_same_bodies_change(browsing):
    page = opened(browsing)
    pause(page)
    before, after = page.evaluate(TURNED, [0.3, False])
    assert after == before
    (_, _, shapes), home = page.evaluate(TURNED, [0.3, True])
    assert home == [pytest.approx(7 * np.pi / 36), 1, shapes]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_serious_problem_in_space(chromium, server, scheme):
    with Browsing(chromium, server, bypass_csp=True, color_scheme=scheme) as browsing:
        page = opened(browsing)
        assert grave(page) == []


def test_only_systems_in_space_load_the_drawing_in_space(browsing):
    page = browsing.open("#case=belt")
    assert page.evaluate(LOADED) == 0
    assert page.locator("#space").is_hidden()
    page.locator("#case").select_option("glass")
    until(page, DRAWN)
    assert page.evaluate(LOADED) == 2
    page.locator("#case").select_option("belt")
    until(page, "stridula.now().lines && !document.getElementById('beams').hidden")
    assert page.locator("#space").is_hidden()
    assert page.locator("#space-legend").is_hidden()


def test_slow_systems_loop_and_have_no_map_unless_requested(browsing):
    page = opened(browsing, "#case=pad-on-disc")
    assert page.locator("#map-on").is_checked() is False
    assert page.locator("#map-words").text_content() == "computed only on request: this system is slow"
    loop = page.locator("#loop")
    until(page, "stridula.loop.isLongEnough")
    loop.click()
    until(page, "stridula.loop.source !== null && stridula.loop.context.state === 'running'")
    assert loop.get_attribute("aria-pressed") == "true"
    assert loop.text_content() == "Stop the loop"
    assert page.locator("#loop-words").text_content().startswith("The last ")
    loop.click()
    until(page, "stridula.loop.source === null")
    assert loop.get_attribute("aria-pressed") == "false"
    page.locator("#case").select_option("squeal")
    until(page, "document.getElementById('loop').hidden")
    assert page.locator("#map-on").is_checked()


def test_a_browser_without_drawing_in_space_reports_it_and_plays(browsing):
    browsing.context.add_init_script(
        """const original = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...words) {
          return kind === 'webgl2' ? null : original.call(this, kind, ...words);
        };"""
    )
    page = browsing.open("#case=glass")
    page.locator("#space-missing").wait_for(state="visible")
    assert page.locator("#space-missing").text_content().startswith("This browser has no WebGL 2")
    assert page.locator("#space").is_hidden()
    assert page.locator("#beams").is_hidden()


def test_a_drawing_that_could_not_be_loaded_is_tried_again(browsing):
    browsing.complains = False
    browsing.context.route("**/three.module.min.js*", lambda route: route.abort())
    page = browsing.open("#case=glass")
    missing = page.locator("#space-missing")
    missing.wait_for(state="visible")
    assert missing.text_content().startswith("The drawing in space could not be loaded.")
    browsing.context.unroute("**/three.module.min.js*")
    page.evaluate(SLIDER)
    until(page, DRAWN)
    assert missing.is_hidden()
