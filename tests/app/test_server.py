"""The server: files, allowed clients and refusals."""

from __future__ import annotations

import ipaddress
import json
import re
import socket
import time
from importlib.resources import files

import pytest
from kernels.caches import incomplete_cache
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from stridula.app import serve
from stridula.app.serve import COMPILING, addresses, outward

from .conversation import conversation
from .serving import START, WAIT, Server, app

# Time in which a server ends, whatever it computes [s].
ENDS = 30.0
FOLDER = files("stridula.app").joinpath("page")
PAGE = [entry for entry in FOLDER.iterdir() if entry.is_file()]


@pytest.mark.parametrize("entry", PAGE, ids=lambda entry: entry.name)
def test_every_file_of_the_page_is_served_unchanged_with_its_type(server, entry):
    answer, content = server.get(f"/{entry.name}")
    kinds = {"js": "text/javascript", "css": "text/css", "html": "text/html", "svg": "image/svg+xml"}
    assert (answer.status, content) == (200, entry.read_bytes())
    assert answer.getheader("content-type").partition(";")[0] == kinds[entry.name.rpartition(".")[2]]


@pytest.mark.parametrize("entry", list(FOLDER.joinpath("vendor").iterdir()), ids=lambda entry: entry.name)
def test_third_party_files_are_served_unchanged_with_their_licence(server, entry):
    answer, content = server.get(f"/vendor/{entry.name}")
    kinds = {"js": "text/javascript", "txt": "text/plain"}
    assert (answer.status, content) == (200, entry.read_bytes())
    assert answer.getheader("content-type").partition(";")[0] == kinds[entry.name.rpartition(".")[2]]
    assert b"MIT" in content
    # The page contacts nobody: no address in it is requested.
    assert not re.search(rb"import\s*\(|from\s*[\"']https?:", content)


def test_the_page_may_contact_only_its_server(server):
    answer, content = server.get("/")
    policy = dict(part.strip().partition(" ")[::2] for part in answer.getheader("content-security-policy").split(";"))
    assert policy["default-src"] == policy["frame-ancestors"] == policy["base-uri"] == "'none'"
    assert policy["script-src"] == policy["worker-src"] == "'self'"
    host = f"127.0.0.1:{server.port}"
    assert policy["connect-src"].split() == ["'self'", f"ws://{host}", f"wss://{host}"]
    assert not any("unsafe" in words for words in policy.values())
    assert answer.getheader("x-content-type-options") == "nosniff"
    assert answer.getheader("referrer-policy") == "no-referrer"
    assert answer.getheader("cross-origin-resource-policy") == "same-origin"
    assert answer.getheader("access-control-allow-origin") is None
    assert answer.getheader("server") is None
    assert b"<canvas" in content


@pytest.mark.parametrize("entry", PAGE, ids=lambda entry: entry.name)
def test_nothing_on_the_page_comes_from_elsewhere(entry):
    written = re.sub(r'xmlns(:\w+)?="[^"]*"', "", entry.read_text(encoding="utf-8"))
    assert not re.findall(r"https?://|(?:src|href)=[\"']//|url\(", written)


@pytest.mark.parametrize(
    "path",
    [
        "/no-such-file",
        "/../server.py",
        "/%2e%2e/server.py",
        "/..%2fserver.py",
        "/page/../../server.py",
        "/%2e%2e%2f%2e%2e%2f%2e%2e%2fetc%2fpasswd",
        "//etc/passwd",
        "/main.js%00.txt",
    ],
)
def test_no_path_leads_out_of_the_page(server, path):
    answer, content = server.get(path)
    assert (answer.status, content.lower()) == (404, b"not found")


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "192.168.0.1", ""])
def test_requests_for_another_host_name_are_refused(server, host):
    assert server.get("/", Host=host)[0].status == 421


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "192.168.0.1"])
def test_sockets_for_another_host_name_are_refused(server, host):
    with (
        socket.create_connection(("127.0.0.1", server.port), WAIT) as wire,
        pytest.raises(InvalidStatus) as refused,
        connect(f"ws://{host}:{server.port}/socket", sock=wire, origin=f"http://{host}:{server.port}"),
    ):
        pass
    assert refused.value.response.status_code == 403


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1", "[::1]"])
def test_this_machine_has_three_names(server, host):
    answer, _ = server.get("/", Host=f"{host}:{server.port}")
    assert answer.status == 200
    # A policy cannot hold an IPv6 address: browsers would log an error.
    assert "[" not in answer.getheader("content-security-policy")
    assert "connect-src 'self'" in answer.getheader("content-security-policy")


def test_an_open_server_accepts_local_names_and_addresses(tmp_path):
    opened = Server(tmp_path / "errors", arguments=["--open"])
    try:
        for host in ("bench", "bench.local", "bench.lan:80", "192.168.0.7:87", "[fe80::1]:87"):
            assert opened.get("/", Host=host)[0].status == 200
        for host in ("evil.example", "bench; script-src *", "bench:x", "a b", "[fe80::1", ""):
            assert opened.get("/", Host=host)[0].status == 421
    finally:
        opened.stop()
    assert opened.complaints == ""


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", "file://", None])
def test_a_page_from_elsewhere_is_refused(server, origin):
    with conversation(server, origin=origin) as talk, pytest.raises(ConnectionClosed) as refused:
        talk.hear()
    assert refused.value.rcvd.code == 4403


def test_another_host_must_be_allowed():
    done = app("--host", "0.0.0.0", "--port", "0")
    assert (done.returncode, done.stdout) == (2, "")
    assert re.fullmatch(r"stridula: host must be .* unless --open is given, got '0.0.0.0'\n", done.stderr)


@pytest.mark.parametrize(
    ("host", "first", "others"),
    [
        ("0.0.0.0", "http://localhost:87/", "http://bench:87/ or http://192.168.0.9:87/"),
        ("::", "http://localhost:87/", "http://bench:87/ or http://192.168.0.9:87/"),
        ("192.168.0.7", "http://192.168.0.7:87/", "http://192.168.0.7:87/"),
    ],
)
def test_an_open_server_prints_addresses_that_work(monkeypatch, host, first, others):
    monkeypatch.setattr(socket, "gethostname", lambda: "bench.example.org")
    monkeypatch.setattr(serve, "outward", lambda: ["192.168.0.9"])
    assert addresses(host, 87) == [first, f"other machines open {others}"]


def test_there_is_one_address_for_other_machines_or_none():
    assert len(outward()) <= 1
    for found in outward():
        assert not ipaddress.ip_address(found).is_unspecified


@pytest.mark.parametrize(("host", "shown"), [("127.0.0.1", "127.0.0.1"), ("localhost", "localhost"), ("::1", "[::1]")])
def test_a_server_for_this_machine_prints_one_address(host, shown):
    assert addresses(host, 87) == [f"http://{shown}:87/"]


def test_a_port_that_is_taken_is_named_in_one_line():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = app("--port", str(port))
    assert (done.returncode, done.stdout) == (2, "")
    words = rf"stridula: host and port must be free, got 127.0.0.1:{port}: .*choose another --port\)\n"
    assert re.fullmatch(words, done.stderr)


def test_a_start_that_compiles_reports_it_and_no_problem(tmp_path):
    server = Server(tmp_path / "errors", NUMBA_CACHE_DIR=str(incomplete_cache(tmp_path)))
    try:
        assert re.fullmatch(rf"{COMPILING}(a moment|a minute or two|\d+ s last time)\n", server.said)
        assert server.complaints == ""
        with conversation(server) as talk:
            talk.until("hello")
            talk.scene()
            assert len(talk.play(480).sound) == 480
    finally:
        server.stop()


def test_a_start_that_compiles_nothing_says_nothing(own, tmp_path):
    again = Server(tmp_path / "again")
    again.stop()
    assert again.said == ""


def test_a_page_opened_while_the_server_compiles_waits_and_then_plays(tmp_path):
    environment = {"NUMBA_CACHE_DIR": str(incomplete_cache(tmp_path))}
    server = Server(tmp_path / "errors", is_ready=False, **environment)
    try:
        with conversation(server) as talk:
            assert talk.hear() == {"type": "compiling"}
            assert json.loads(talk.socket.recv(timeout=START))["type"] == "hello"
            talk.scene()
            assert len(talk.play(480).sound) == 480
    finally:
        server.stop()
    assert server.complaints == ""


@pytest.mark.parametrize("plays", [False, True])
def test_a_signal_ends_it_while_it_prepares_a_scene_or_compiles(tmp_path, plays):
    environment = {} if plays else {"NUMBA_CACHE_DIR": str(tmp_path / "empty")}
    server = Server(tmp_path / "errors", is_ready=plays, **environment)
    with conversation(server) as talk:
        if plays:
            talk.until("hello")
            talk.scene()
            talk.say("scene", revision=9, case="brake")
        time.sleep(1.0)
        server.process.terminate()
        server.process.wait(ENDS)
    server.process.stdout.close()
    assert server.complaints == ""


def test_ctrl_c_ends_it_with_a_page_open(own):
    with conversation(own) as talk:
        talk.until("hello")
        talk.scene()
        assert own.interrupt() == 0


BAD = {
    "no JSON": "{",
    "a list": "[]",
    "a number": "1",
    "nothing": "",
    "no type": '{"parts": 1}',
    "unknown type": '{"type": "dance"}',
    "unknown key": '{"type": "restart", "now": true}',
    "too many parts": '{"type": "pull", "parts": 1000, "samples": 480}',
    "too many samples": '{"type": "pull", "parts": 1, "samples": 1000000}',
    "no parts": '{"type": "pull", "parts": 0, "samples": 480}',
    "half a part": '{"type": "pull", "parts": 0.5, "samples": 480}',
    "a text for a number": '{"type": "pull", "parts": "1", "samples": 480}',
    "NaN parts": '{"type": "pull", "parts": NaN, "samples": 480}',
    "NaN": '{"type": "scene", "revision": 9, "overrides": {"slider.length": NaN}}',
    "infinity": '{"type": "scene", "revision": 9, "overrides": {"slider.length": 1e999}}',
    "a list for a number": '{"type": "scene", "revision": 9, "overrides": {"slider.length": [1]}}',
    "a long key": json.dumps({"type": "scene", "revision": 9, "overrides": {"a" * 200: 1.0}}),
    "many keys": json.dumps({"type": "scene", "revision": 9, "overrides": {f"a{k}": 1.0 for k in range(99)}}),
    "a long text": json.dumps({"type": "scene", "revision": 9, "text": " " * 70_000}),
    "a source there is not": '{"type": "listen", "source": "light"}',
    "a file there is not": '{"type": "save", "format": "../x"}',
    "deep": '{"type":' + "[" * 20_000,
    "half a character": '{"type": "\\ud800"}',
}


@pytest.mark.parametrize("text", BAD.values(), ids=BAD)
def test_an_invalid_message_is_reported_in_one_line_and_playing_continues(talk, text):
    talk.scene()
    talk.play(480)
    talk.socket.send(text)
    (problem,) = talk.until("problem")["problems"]
    assert problem
    assert "\n" not in problem
    assert len(problem) < 300
    assert talk.play(480).parts[0].clock == pytest.approx(0.02)


def test_an_infinite_number_is_refused(talk):
    talk.socket.send('{"type": "scene", "revision": 9, "overrides": {"slider.length": 1' + 400 * "0" + "}}")
    assert set(talk.until("scene")["refused"]) == {"slider.length"}
    assert talk.scene()["type"] == "scene"


def test_bytes_are_not_a_message(talk):
    talk.socket.send(b"\x00\x01")
    (problem,) = talk.until("problem")["problems"]
    assert "text" in problem
    assert talk.scene()["type"] == "scene"


def test_nothing_is_played_before_a_scene_is_chosen(talk):
    for message in ({"type": "pull", "parts": 1, "samples": 480}, {"type": "restart"}, {"type": "no map"}):
        talk.say(**message)
        assert talk.until("problem")["problems"] == ["scene must be given first"]


def test_a_message_too_large_closes_the_socket_and_the_server_continues(server):
    with conversation(server) as talk:
        talk.until("hello")
        talk.socket.send(json.dumps({"type": "restart", "filled": "x" * 200_000}))
        with pytest.raises(ConnectionClosed) as closed:
            talk.hear()
        assert closed.value.rcvd.code == 1009
    with conversation(server) as talk:
        assert talk.until("hello")["type"] == "hello"
