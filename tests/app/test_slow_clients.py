"""Slow clients and invalid HTTP: they do not disturb others, and the terminal shows nothing of them."""

from __future__ import annotations

import random
import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from http.client import HTTPConnection

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from stridula.app import caller, serve, session

from .serving import WAIT, eventually

HURRY = 1.0
MOST_CONNECTIONS = 200


@pytest.fixture
def hurried(monkeypatch) -> Iterator[int]:
    """Serve the page in a thread with short time limits, and return its port."""
    monkeypatch.setattr(caller, "HURRY", HURRY)
    monkeypatch.setattr(session, "HURRY", HURRY)
    server = serve.server(False)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        thread = threading.Thread(target=server.run, args=[[listening]], daemon=True)
        thread.start()
        yield listening.getsockname()[1]
        server.should_exit = True
        thread.join(WAIT)


def call(port: int) -> socket.socket:
    return socket.create_connection(("127.0.0.1", port), WAIT)


def status(port: int) -> int:
    connection = HTTPConnection("127.0.0.1", port, timeout=WAIT)
    try:
        connection.request("GET", "/main.js")
        answer = connection.getresponse()
        answer.read()
        return answer.status
    finally:
        connection.close()


def is_let_go(one: socket.socket) -> bool:
    """Wait until the server has closed a connection."""
    with suppress(ConnectionError):
        while one.recv(1 << 16):
            pass
    return True


HALVES = {
    "nothing": b"",
    "half a line": b"GET / HT",
    "half a head": b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n",
    "half a body": b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9\r\n\r\nhell",
    "half of another": b"GET /main.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\nGET / HT",
}


@pytest.mark.parametrize("half", HALVES.values(), ids=HALVES)
def test_clients_that_send_nothing_in_time_are_dropped(hurried, half):
    with call(hurried) as one:
        one.sendall(half)
        assert is_let_go(one)
    assert status(hurried) == 200


def test_many_silent_clients_give_way(hurried):
    with ExitStack() as stack:
        for number in range(MOST_CONNECTIONS + 20):
            one = stack.enter_context(call(hurried))
            one.sendall(list(HALVES.values())[number % 3])
        eventually(lambda: status(hurried) == 200, "an answer")


def test_a_page_that_asks_slowly_is_served(hurried):
    with call(hurried) as one:
        for letter in b"GET /main.js HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n":
            one.sendall(bytes([letter]))
        assert one.recv(100).startswith(b"HTTP/1.1 200")


def test_a_silent_socket_makes_room(hurried):
    words = {"origin": f"http://127.0.0.1:{hurried}", "open_timeout": WAIT}
    with connect(f"ws://127.0.0.1:{hurried}/socket", **words) as silent:
        assert '"hello"' in silent.recv(WAIT)
        with pytest.raises(ConnectionClosed) as closed:
            silent.recv(WAIT)
    assert (closed.value.rcvd.code, closed.value.rcvd.reason) == (4408, "a page must send a message within 1 s")
    # A client that has sent a request may be silent.
    with connect(f"ws://127.0.0.1:{hurried}/socket", **words) as one:
        one.recv(WAIT)
        one.send('{"type": "repeat", "on": true}')
        with pytest.raises(TimeoutError):
            one.recv(2.0 * HURRY)


GOOD = (
    "GET / HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "POST /x HTTP/1.1\r\nHost: {host}\r\nContent-Length: 5\r\n\r\nhello",
    "POST / HTTP/1.1\r\nHost: {host}\r\nTransfer-Encoding: chunked\r\nExpect: 100-continue\r\n\r\n"
    "5\r\nhello\r\n0\r\n\r\n",
    "HEAD /main.js HTTP/1.0\r\nHost: {host}\r\nConnection: keep-alive\r\n\r\n",
    "CONNECT / HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "OPTIONS * HTTP/1.1\r\nHost: {host}\r\nUpgrade: h2c\r\nConnection: upgrade\r\n\r\n",
    "GET /socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n",
)
INSERTED = (
    b"\r\n", b"\0", b"\xff\xfe", b" ", b":", b"Content-Length: -1\r\n", b"Content-Length: 1" + 40 * b"0" + b"\r\n",
    b"Transfer-Encoding: chunked\r\n", b"HTTP/9.9", 20_000 * b"A", b"%00", b"\r\n\r\n", b"GET / HTTP/1.1\r\n\r\n",
)  # fmt: skip
# Invalid frames: no UTF-8, unknown opcode, reserved bits, no mask, excessive size, no start.
FRAMES = (
    b"\x81\x82\0\0\0\0\xff\xfe", b"\x83\x81\0\0\0\0x", b"\xf1\x81\0\0\0\0x", b"\x81\x01x",
    b"\x81\xff\x7f" + 11 * b"\xff", b"\x80\x81\0\0\0\0x", b"\x88\x81\0\0\0\0x",
)  # fmt: skip


def mutated(random: random.Random, host: str) -> bytes:
    """Return one or two requests with a few bytes inserted, removed or changed."""
    data = bytearray("".join(random.choices(GOOD, k=random.randint(1, 2))).format(host=host).encode())
    for _ in range(random.randint(0, 4)):
        at = random.randrange(len(data))
        change = random.randrange(4)
        if change == 0:
            data[at:at] = random.choice(INSERTED)
        elif change == 1:
            del data[at + 1 : at + random.randint(1, 20)]
        elif change == 2:
            data[at] = random.randrange(256)
        else:
            data = data[: at + 1] + data[random.randrange(len(data)) :]
    return bytes(data)


def test_invalid_http_is_refused_without_terminal_output(own):
    dice = random.Random(7)
    for _ in range(400):
        with call(own.port) as one, suppress(ConnectionError, TimeoutError):
            one.settimeout(0.02)
            data = mutated(dice, f"127.0.0.1:{own.port}")
            half = dice.randrange(len(data))
            one.sendall(data[:half])
            one.sendall(data[half:])
            one.recv(100)
    for frame in FRAMES:
        with call(own.port) as one:
            one.sendall(GOOD[-1].format(host=f"127.0.0.1:{own.port}").encode())
            while b'"hello"' not in one.recv(1 << 16):
                pass
            one.sendall(frame)
            assert is_let_go(one)
    assert status(own.port) == 200
    assert own.complaints == ""
