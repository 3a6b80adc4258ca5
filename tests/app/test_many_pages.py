"""Many pages: their number, their speed, and the release of their memory."""

from __future__ import annotations

import contextlib
import json
import time

import psutil
import pytest
from websockets.exceptions import ConnectionClosed

from .conversation import RATE, conversation, parts_of
from .serving import eventually

MOST_PAGES, AHEAD, FASTEST = 16, 1.0, 1.5
# Growth of memory allowed for a hundred pages, after the first of them [bytes].
GROWTH = 30e6
WARM_UP, SESSIONS = 30, 100
SIDES = {
    "x": {"key": "contact.friction.coefficient", "low": 0.2, "high": 1.6},
    "y": {"key": "slider.angle", "low": 0.5, "high": 0.9},
}


def test_at_most_sixteen_pages_until_one_closes(own):
    with contextlib.ExitStack() as stack:
        pages = [stack.enter_context(conversation(own)) for _ in range(MOST_PAGES)]
        for page in pages:
            page.until("hello")
            page.say("repeat", on=True)
        with conversation(own) as one_more, pytest.raises(ConnectionClosed) as refused:
            one_more.hear()
        assert (refused.value.rcvd.code, refused.value.rcvd.reason) == (4429, "at most 16 pages can be open")
        # Open pages continue.
        pages[0].scene()
        assert len(pages[0].play(480).sound) == 480
        pages[-1].socket.close()

        def has_room() -> bool:
            with conversation(own) as another, contextlib.suppress(ConnectionClosed):
                return another.hear()["type"] == "hello"
            return False

        eventually(has_room, "room for another page")


def assert_rests(own, process):
    """Nothing asked before starts the process of maps again, once a page is open that asks nothing."""
    with conversation(own) as page:
        page.until("hello")
        time.sleep(0.5)
        assert not process.children()


def test_dropped_sessions_leave_nothing_behind(own):
    process = psutil.Process(own.process.pid)

    def drop(number: int) -> None:
        """Open a page and close it during an operation."""
        with conversation(own, close_timeout=0.0 if number % 2 else 1.0) as talk:
            talk.until("hello")
            if number % 4:
                talk.say("scene", revision=1)
            if number % 4 > 1:
                talk.until("scene")
                talk.say("pull", parts=5, samples=480)
            if number % 4 > 2:
                talk.say("map", revision=1, points=4, **SIDES)

    with conversation(own) as first:
        # An open page keeps the process of maps, which still has rows of closed pages to compute.
        first.until("hello")
        first.scene()
        first.say("map", revision=1, points=4, **SIDES)
        first.until("map row")
        for number in range(WARM_UP):
            drop(number)
        before = process.memory_info().rss
        for number in range(SESSIONS):
            drop(number)
        assert len(process.children()) == 1
    eventually(lambda: not process.children(), "an end of the process of maps")
    assert process.memory_info().rss < before + GROWTH
    assert_rests(own, process)


def test_unwanted_rows_start_no_process(own):
    process = psutil.Process(own.process.pid)
    with contextlib.ExitStack() as stack:
        pages = [stack.enter_context(conversation(own)) for _ in range(4)]
        for page in pages:
            page.until("hello")
            page.scene()
            page.say("map", revision=1, points=12, **SIDES)
        pages[0].until("map row")
        assert len(process.children()) == 1
    eventually(lambda: not process.children(), "an end of the process of maps")
    assert_rests(own, process)


def test_no_page_runs_faster_than_real_time_by_more_than_half(own):
    seconds = 3
    with conversation(own) as talk:
        began = time.monotonic()
        talk.until("hello")
        talk.scene()
        pulls = seconds * RATE // 9600
        # All at once: not waiting for answers does not speed them up.
        for _ in range(pulls):
            talk.socket.send(json.dumps({"type": "pull", "parts": 20, "samples": 480}))
        parts = [part for _ in range(pulls) for part in parts_of(talk.bytes())]
        took = time.monotonic() - began
    assert took > (seconds - AHEAD) / FASTEST - 0.05
    assert sum(len(part.sound) for part in parts) == seconds * RATE


def test_the_process_of_maps_ends_with_the_server(own):
    process = psutil.Process(own.process.pid)
    with conversation(own) as talk:
        talk.until("hello")
        talk.scene()
        talk.say("map", revision=1, points=8, **SIDES)
        talk.until("map row")
        (maker,) = process.children()
        own.process.kill()
        own.process.wait()
        eventually(lambda: not maker.is_running(), "an end of the process of maps")
