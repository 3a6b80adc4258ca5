"""Messages between a page and the server, without a page."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from websockets.sync.client import connect

from .serving import WAIT, Server

RATE = 48_000
MOST_PARTS = 20


@dataclass
class Part:
    """A part of the stream, unpacked from `stridula.app.parts.packed`."""

    revision: int
    clock: float
    stroke: int
    place: float
    sound: np.ndarray
    normal_force: np.ndarray
    tangential_force: np.ndarray
    status: np.ndarray
    places: np.ndarray
    slip_velocity: np.ndarray
    height: float
    slider: np.ndarray
    track: np.ndarray
    contacts: np.ndarray


def parts_of(data: bytes) -> list[Part]:
    """Return the successive parts in an answer."""
    found, at = [], 0
    while at < len(data):
        samples, seen, nodes, points, contacts = (int(number) for number in np.frombuffer(data, "<f8", 5, at + 24))
        count = samples + 5 * seen + 1 + 2 * nodes + points + 2 * contacts
        found.append(unpacked(data[at : at + 72 + 4 * count]))
        at += 72 + 4 * (count + count % 2)
    assert at == len(data)
    return found


def unpacked(data: bytes) -> Part:
    head = np.frombuffer(data, "<f8", 9)
    revision, _, stroke, samples, seen, nodes, points, contacts = (int(number) for number in head[:8])
    sizes = [samples, *[seen] * 5, 1, 2 * nodes, points, 2 * contacts]
    values = np.frombuffer(data, "<f4", offset=72)
    assert len(values) == sum(sizes)
    sound, force, tangential, status, moved, slip, height, slider, track, touching = np.split(
        values, np.cumsum(sizes)[:-1]
    )
    return Part(
        revision, head[1], stroke, head[8], sound, force, tangential, status.astype(int), head[8] + moved, slip,
        float(height[0]), slider.reshape(-1, 2), track, touching.reshape(-1, 2),
    )  # fmt: skip


@dataclass
class Played:
    """Parts, and the reasons why strokes ended."""

    parts: list[Part] = field(default_factory=list)
    stops: list[dict[str, Any]] = field(default_factory=list)

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("__"):
            raise AttributeError(name)
        return np.concatenate([np.atleast_1d(getattr(part, name)) for part in self.parts])

    @property
    def shares(self) -> np.ndarray:
        """Shares of separated, sticking and sliding."""
        return np.bincount(self.status, minlength=3) / len(self.status)


class Conversation:
    """An open socket; `others` keeps messages that were not waited for."""

    def __init__(self, socket: Any) -> None:
        self.socket, self.revision = socket, 0
        self.others: list[Any] = []

    def say(self, type: str, **words: Any) -> None:
        self.socket.send(json.dumps({"type": type, **words}))

    def hear(self) -> Any:
        message = self.socket.recv(timeout=WAIT)
        return json.loads(message) if isinstance(message, str) else message

    def until(self, *types: str) -> Any:
        """Return the first message of a type."""
        while True:
            message = self.hear()
            if isinstance(message, dict) and message["type"] in types:
                return message
            self.others.append(message)

    def bytes(self) -> bytes:
        """Return the first bytes."""
        while True:
            message = self.hear()
            if isinstance(message, bytes):
                return message
            self.others.append(message)

    def asks(self, type: str, *answers: str, **words: Any) -> Any:
        self.say(type, **words)
        return self.until(*answers)

    def scene(self, case: str = "squeal", overrides: dict[str, Any] | None = None, text: str | None = None) -> Any:
        """Ask for a scene and return the answer, which names its revision."""
        self.revision += 1
        words = {"case": case, "overrides": overrides or {}, "text": text}
        answer = self.asks("scene", "scene", "refused", revision=self.revision, **words)
        assert answer["revision"] == self.revision
        return answer

    def play(self, samples: int, each: int = 480) -> Played:
        """Continue, in parts of a number of samples."""
        played, before = Played(), self.others
        while samples:
            size = min(each, samples)
            parts = min(MOST_PARTS, samples // size)
            self.others = []
            self.say("pull", parts=parts, samples=size)
            found = parts_of(self.bytes())
            played.parts += found
            played.stops += [one for one in self.others if isinstance(one, dict) and one["type"] == "stroke"]
            # A slow system sends less at once, an ended one nothing.
            samples -= sum(len(part.sound) for part in found) or parts * size
        self.others = before
        return played

    def save(self, format: str) -> bytes:
        answer = self.asks("save", "file", "problem", format=format)
        assert answer["type"] == "file"
        content = self.hear()
        assert len(content) == answer["size"]
        assert answer["format"] == format
        return content


@contextmanager
def conversation(server: Server, **words: Any) -> Iterator[Conversation]:
    """Open a socket as a page does."""
    words = {"origin": server.origin, "max_size": 2**24, "compression": None, "open_timeout": WAIT} | words
    with connect(f"ws://127.0.0.1:{server.port}/socket", **words) as socket:
        yield Conversation(socket)
