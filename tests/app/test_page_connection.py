"""The page without its server, and when the server is there again."""

from __future__ import annotations

from contextlib import ExitStack

from .browsing import Browsing, plays_on, stats, until
from .conversation import conversation
from .serving import Server

FRICTION = "contact.friction.coefficient"


def test_the_page_reconnects_and_continues_unchanged(chromium, own, tmp_path):
    with Browsing(chromium, own) as browsing:
        # A socket without server logs an error, as expected here.
        browsing.complains = False
        page = browsing.open(f"#case=stable-sliding&{FRICTION}=0.62")
        until(page, "stridula.now()?.toml.includes('coefficient = 0.62')")
        lost = page.locator("#lost")
        assert lost.is_hidden()
        own.kill()
        lost.wait_for(state="visible")
        assert lost.text_content().startswith("Connection lost")
        assert lost.get_attribute("role") == "alert"
        assert stats(page, "connected") is False
        again = Server(tmp_path / "again", own.port)
        try:
            lost.wait_for(state="hidden")
            plays_on(page, 48_000)
            assert "coefficient = 0.62" in page.evaluate("stridula.now().toml")
            assert page.evaluate("stridula.now().revision") >= 2
            assert not [said for said in browsing.complaints if "WebSocket" not in said]
        finally:
            again.stop()
        assert again.complaints == ""


def test_an_excess_page_waits_until_there_is_room(chromium, own):
    with ExitStack() as stack, Browsing(chromium, own) as browsing:
        browsing.complains = False
        pages = [stack.enter_context(conversation(own)) for _ in range(16)]
        for one in pages:
            one.say("repeat", on=True)
        page = browsing.context.new_page()
        page.goto(own.address)
        page.locator("#lost").wait_for(state="visible")
        assert page.locator("#lost").text_content() == (
            "No room: at most 16 pages can be open. This page tries again every 5 s."
        )
        pages[0].socket.close()
        page.locator("#lost").wait_for(state="hidden")
        plays_on(page)


def test_buttons_that_need_the_server_wait_for_it(chromium, own):
    names = ("instruments", "tour-begin", "challenges-open")
    with Browsing(chromium, own) as browsing:
        browsing.complains = False
        # Without the script of the connection the page never hears from its server.
        browsing.context.route("**/stream.js", lambda route: route.abort())
        page = browsing.begin("")
        until(page, "window.stridula")
        assert all(page.locator(f"#{name}").is_disabled() for name in names)
        browsing.context.unroute("**/stream.js")
        page = browsing.begin("")
        for name in names:
            until(page, "!document.getElementById(arg).disabled", name)
