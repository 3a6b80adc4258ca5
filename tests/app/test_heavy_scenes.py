"""Scenes that take long are refused before any work, and their work ends with their page."""

from __future__ import annotations

import asyncio
import socket
import struct
import threading
import time

import pytest
from starlette.websockets import WebSocketDisconnect

from stridula.app import session
from stridula.app.beside import Beside
from stridula.app.playable import playable
from stridula.long_tasks import GivenUp, check_wanted, until

from .conversation import conversation
from .serving import WAIT

THIN = """base = "glass"
[bodies.glass.profile]
shape = "line"
points = [[0.002, 0.0], [0.03, 0.17]]
thickness = 1e-7
"""
HIGH = """base = "glass"
[bodies.glass]
cutoff = "200 kHz"
"""
FINE = """base = "glass"
[bodies.glass]
cutoff = "300 kHz"
[bodies.glass.profile]
size = 0.0005
"""
SOLID = """base = "pin-on-disc"
[bodies.pin]
cutoff = "8 MHz"
"""
BEYOND = """base = "glass"
[bodies.glass]
cutoff = 1e308
"""
MANY = """base = "pin-on-disc"
[bodies.pin.mesh]
divisions = [12, 12, 12]
[bodies.pin]
cutoff = "2 MHz"
"""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (THIN, "bodies.glass.cutoff must leave at most 10000 cells"),
        (HIGH, "bodies.glass.cutoff must leave at most 400000 degrees of freedom"),
        (FINE, "glass must have at most 500000 degrees of freedom in all orders to be played"),
        (BEYOND, "bodies.glass.cutoff must be below 1e.12"),
        (MANY, "pin must have at most [0-9]+ modes to be played, got [0-9]+ or more: lower cutoff"),
    ],
)
def test_heavy_scenes_are_refused_before_their_modes_are_computed(text, words, monkeypatch):
    monkeypatch.setattr(
        "stridula.bodies.solids.solid_body.reduce_sparse", lambda *given: pytest.fail("a search is begun")
    )
    monkeypatch.setattr(
        "stridula.bodies.revolution.axisymmetric_body._families", lambda body: pytest.fail("a search is begun")
    )
    with pytest.raises(ValueError, match=f"^{words}"):
        playable("squeal", text, {})


def test_work_goes_on_until_nobody_waits_for_it():
    given_up, rounds = threading.Event(), []

    def work():
        while True:
            check_wanted()
            rounds.append(None)
            if len(rounds) == 3:
                given_up.set()

    with pytest.raises(GivenUp):
        until(given_up, work)
    assert len(rounds) == 3
    # Without an event, work is always wanted.
    check_wanted()


@pytest.mark.parametrize("search", ["glass", "pin-on-disc"])
def test_a_search_for_modes_ends_when_nobody_waits_for_it(search):
    given_up = threading.Event()
    given_up.set()
    body = {"glass": "glass", "pin-on-disc": "pin"}[search]
    with pytest.raises(GivenUp):
        until(given_up, playable, search, None, {f"bodies.{body}.cutoff": 20_321.0})


class Leaving:
    """A socket whose page sends a scene, then leaves."""

    def __init__(self) -> None:
        self.messages = ['{"type": "scene", "revision": 1}', '{"type": "pull", "parts": 1, "samples": 480}']

    async def receive_text(self) -> str:
        if self.messages:
            return self.messages.pop(0)
        raise WebSocketDisconnect(1001)

    async def send_json(self, message: object) -> None:
        pass


def test_the_work_on_a_scene_ends_with_its_page(monkeypatch):
    begun, ended = threading.Event(), threading.Event()

    def endless(wanted, last):
        begun.set()
        try:
            while True:
                check_wanted()
                time.sleep(0.001)
        finally:
            ended.set()

    async def played() -> None:
        with pytest.raises(WebSocketDisconnect):
            await asyncio.wait_for(session.Session(Leaving(), Beside()).run(), WAIT)

    monkeypatch.setattr(session, "held", endless)
    asyncio.run(played())
    assert begun.is_set()
    assert ended.is_set()


def test_broken_sockets_leave_nothing_in_the_terminal(own):
    for text in (None, SOLID):
        with conversation(own) as talk:
            talk.until("hello")
            talk.scene()
            talk.say("pull", parts=20, samples=480)
            if text:
                talk.say("scene", revision=7, text=text)
            # Reset instead of closed.
            talk.socket.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            talk.socket.socket.close()
    with conversation(own) as talk:
        talk.until("hello")
        talk.scene()
        assert len(talk.play(480).sound) == 480
