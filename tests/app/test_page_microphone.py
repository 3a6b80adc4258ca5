"""The microphone beside the computed sound, and a glass of its pitch, with the fake devices of the browser."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

from .browsing import Browsing, launched, pixels, until
from .conversation import RATE
from .serving import START

TEXT = "document.getElementById('{}').textContent"
TONE = 784.0


@pytest.fixture(scope="module")
def hears(tmp_path_factory):
    """Start a browser whose microphone hears a tapped glass in noise."""
    dice = np.random.default_rng(1)
    time = np.arange(10 * RATE) / RATE
    tones = sum(a * np.sin(2.0 * np.pi * TONE * f * time) for f, a in ((1.0, 0.2), (2.31, 0.08), (4.3, 0.04)))
    path = tmp_path_factory.mktemp("heard") / "glass.wav"
    soundfile.write(path, tones + 0.02 * dice.normal(size=len(time)), RATE)
    flags = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
    with launched(*flags, f"--use-file-for-fake-audio-capture={path}") as browser:
        yield browser


def test_a_tone_is_named_beside_the_computed_one_and_the_glass_is_fitted_to_it(hears, server):
    with Browsing(hears, server) as browsing:
        page = browsing.open("#case=glass")
        asked = []
        browsing.context.on("request", lambda request: asked.append(request.url))
        assert page.locator("#mine").is_hidden()
        page.locator("#microphone").click()
        until(page, f"{TEXT.format('mine-pitch')}.includes('G5')")
        assert float(page.locator("#mine-pitch").text_content().split()[0]) == pytest.approx(TONE, rel=1e-3)
        assert page.locator("#microphone").get_attribute("aria-pressed") == "true"
        # The spectrum shows both.
        assert page.locator("#as-spectrum").is_checked()
        assert page.locator("#heard-title").text_content() == "Spectrum"
        page.wait_for_timeout(500)
        assert pixels(page, "spectrogram", "mine") > 100
        until(page, f"{TEXT.format('ours-pitch')}.includes('F5')")
        # Several systems are computed and marched.
        page.set_default_timeout(1000.0 * START)
        page.locator("#fit").click()
        until(page, f"{TEXT.format('fit-words')}.includes('sings at')")
        until(page, "Object.keys(stridula.scene.now.overrides).some((key) => key.includes('thickness'))")
        until(page, f"{TEXT.format('ours-pitch')}.includes('G5')")
        assert float(page.locator("#ours-pitch").text_content().split()[0]) == pytest.approx(TONE, rel=0.01)
        # Only the message with the pitch has left the page, over the socket.
        assert [url for url in asked if not url.endswith("icon.svg")] == []
        page.locator("#microphone").click()
        assert page.locator("#mine").is_hidden()
        page.wait_for_timeout(500)
        assert pixels(page, "spectrogram", "mine") == 0


def test_systems_without_a_glass_offer_no_fit(hears, server):
    with Browsing(hears, server) as browsing:
        page = browsing.open("#case=squeal")
        page.locator("#microphone").click()
        until(page, f"{TEXT.format('mine-pitch')}.includes('G5')")
        assert page.locator("#fit").is_hidden()
