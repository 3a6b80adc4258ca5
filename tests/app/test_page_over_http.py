"""The page from another machine over plain http: browsers allow the audio thread for secure addresses only."""

from __future__ import annotations

import pytest

from .browsing import Browsing, launched, plays_on, stats, until
from .serving import Server

NAME = "bench"
# The output to the loudspeakers is recorded.
LISTENS = """const connect = AudioNode.prototype.connect;
AudioNode.prototype.connect = function (to, ...more) {
  if (to === this.context.destination) {
    window.ear = new AnalyserNode(this.context, { fftSize: 2048 });
    connect.call(this, ear);
  }
  return connect.call(this, to, ...more);
};
window.loudest = () => {
  if (!window.ear) return 0;
  const heard = new Float32Array(2048);
  ear.getFloatTimeDomainData(heard);
  return Math.max(...heard.map(Math.abs));
};"""
# Messages of browsers about plain http and their caches.
EXPECTED = ("Cross-Origin-Opener-Policy", "ScriptProcessorNode is deprecated")


@pytest.fixture(scope="module")
def chromium():
    """Start a browser that finds this machine under a name that is not localhost."""
    with launched(f"--host-resolver-rules=MAP {NAME} 127.0.0.1") as browser:
        yield browser


@pytest.fixture
def elsewhere(tmp_path):
    """Serve the page to other machines."""
    server = Server(tmp_path / "errors", arguments=["--open"])
    server.address = server.address.replace("127.0.0.1", NAME)
    yield server
    server.stop()
    assert server.complaints == ""


def test_a_page_over_http_also_has_sound(chromium, elsewhere):
    with Browsing(chromium, elsewhere) as browsing:
        browsing.context.add_init_script(LISTENS)
        page = browsing.open()
        assert not page.evaluate("isSecureContext")
        assert page.evaluate("loudest()") == 0.0
        page.locator("#sound").click()
        until(page, "loudest() > 1e-3")
        until(page, "stridula.stats.peak > 1e-3")
        assert page.evaluate("loudest()") < 0.71
        page.locator("#contact-friction-coefficient-slide").press("ArrowRight")
        until(page, "Number.isFinite(stridula.stats.latency)")
        assert stats(page, "latency") > 0.0
        plays_on(page, 48_000)
        page.locator("#sound").click()
        until(page, "ear.context.state === 'suspended'")
        browsing.complaints = [said for said in browsing.complaints if not any(word in said for word in EXPECTED)]


def test_the_audio_thread_is_used_where_available(chromium, server):
    with Browsing(chromium, server) as browsing:
        browsing.context.add_init_script(LISTENS)
        page = browsing.open()
        page.locator("#sound").click()
        until(page, "loudest() > 1e-3")
        assert page.evaluate("isSecureContext")
        assert browsing.complaints == []
