"""Pictures of the other setting that stay while one plays, and reasons why there is no microphone."""

from __future__ import annotations

import pytest

from .browsing import pixels, until

TEXT = "document.getElementById('{}').textContent"
REFUSED = "navigator.mediaDevices.getUserMedia = () => Promise.reject(new DOMException('no', {!r}))"
MISSING = "Object.defineProperty(navigator, 'mediaDevices', { value: undefined })"


@pytest.mark.parametrize(
    ("script", "words"),
    [
        (REFUSED.format("NotAllowedError"), "The browser does not let this page use the microphone: allow it"),
        (REFUSED.format("NotFoundError"), "No microphone was found: connect one"),
        (REFUSED.format("NotReadableError"), "The microphone cannot be read: another program may be using it."),
        (REFUSED.format("OddError"), "The microphone cannot be used: no."),
        (MISSING, "Browsers give the microphone to pages on this machine and over https only"),
    ],
)
def test_a_missing_microphone_has_its_reason_in_a_sentence(browsing, script, words):
    browsing.context.add_init_script(script)
    page = browsing.open("#case=squeal")
    page.locator("#microphone").click()
    until(page, f"{TEXT.format('microphone-words')}.startsWith(arg)", words)
    assert page.locator("#microphone-words").is_visible()
    assert page.locator("#microphone").get_attribute("aria-pressed") == "false"
    assert page.locator("#mine").is_hidden()
    assert page.locator("#microphone").is_enabled()


def test_the_other_setting_stays_in_the_pictures(browsing):
    browsing.context.add_init_script(
        """window.written = new Set();
        const write = CanvasRenderingContext2D.prototype.fillText;
        CanvasRenderingContext2D.prototype.fillText = function (words, ...where) {
          written.add(words);
          return write.call(this, words, ...where);
        };"""
    )
    page = browsing.open("#case=stable-sliding")
    page.locator("#as-spectrum").check()
    until(page, "stridula.stats.samples > 96000")
    assert pixels(page, "timeline", "held") == 0
    page.keyboard.press("b")
    until(page, "written.has('A, held') && written.has('B, playing')")
    assert page.locator("#said").text_content().startswith("Setting A stays")
    # Before B is changed, both curves lie over each other; a larger friction parts them.
    field = page.locator("input[type=number][data-key='contact.friction.coefficient']")
    field.fill("1.5")
    field.press("Enter")
    until(page, "stridula.now().values['contact.friction.coefficient'] === 1.5")
    page.wait_for_timeout(1500)
    assert pixels(page, "timeline", "held") > 50
    assert pixels(page, "spectrogram", "held") > 50
    page.evaluate("written.clear(); document.activeElement.blur()")
    page.keyboard.press("b")
    until(page, "written.has('B, held') && !written.has('B, playing') || (written.clear(), false)")
    # Two other settings begin without.
    page.locator("#tour-begin").click()
    for _ in range(5):
        page.locator("#tour-next").click()
    page.evaluate("written.clear()")
    page.wait_for_timeout(500)
    assert not page.evaluate("[...written].some((one) => one.includes('held'))")
