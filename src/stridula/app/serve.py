"""The server on its port, and the browser that opens."""

from __future__ import annotations

import errno
import gc
import ipaddress
import logging
import socket
import sys
import threading
import webbrowser
from contextlib import suppress

import uvicorn

from ..checks import ArgumentError
from ..studies.task import use_one_thread
from .caller import Caller, is_news
from .instrument import RATE, Instrument
from .messages import LARGEST
from .parts import Part, packed
from .playable import PRESETS, SYSTEMS, playable
from .server import create_app

# How long pages are waited for when the server stops [s].
GRACE = 2
# After how long it is said that something is being compiled [s].
PATIENCE = 2.0
# Hosts that stand for all addresses of this machine.
EVERYWHERE = ("0.0.0.0", "::")
# An address and a port that are nobody's.
ELSEWHERE = ("192.0.2.1", 9)
COMPILING = "stridula: compiling, once; this takes some ten seconds"


def serve(host: str, port: int, is_open: bool, opens_browser: bool) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    host : str
        Address to listen on.
    port : int
        Port; 0 for any that is free.
    is_open : bool
        Whether the host may be other than this machine's own.
    opens_browser : bool
        Whether a browser is opened.

    Raises
    ------
    ValueError
        If the host is not this machine's own and `is_open` does not say that it may be, or the port cannot be had.
    """
    if not (is_open or is_loopback(host)):
        raise ArgumentError(
            "host", "be this machine's own, such as 127.0.0.1, unless --open lets other machines in", host
        )
    listening = _bound(host, port)
    use_one_thread()
    _get_ready()
    # What is there now stays: to look for garbage in it would stop the sound.
    gc.collect()
    gc.freeze()
    address, *others = addresses(host, listening.getsockname()[1])
    print("\n".join([f"stridula plays at {address} (Ctrl-C stops it)", *others]), flush=True)
    # A page that goes in the middle of what it asked for is no news.
    logging.getLogger("asyncio").setLevel(logging.ERROR)
    if opens_browser:
        threading.Timer(0.5, webbrowser.open, [address]).start()
    # Ctrl-C is how it ends.
    with suppress(KeyboardInterrupt):
        server(is_open).run(sockets=[listening])


def server(is_open: bool) -> uvicorn.Server:
    """Return what serves the page.

    Parameters
    ----------
    is_open : bool
        Whether other machines may ask.
    """
    config = uvicorn.Config(
        create_app(is_open),
        http=Caller,
        ws="websockets-sansio",
        ws_max_size=LARGEST,
        ws_per_message_deflate=False,
        # What callers do wrong is told to them.
        log_level="error",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=GRACE,
        limit_concurrency=200,
    )
    logging.getLogger("uvicorn.error").addFilter(is_news)
    return uvicorn.Server(config)


def _get_ready() -> None:
    """Play a moment, so that what must be compiled is; say so where it takes long, which it does the first time."""
    notice = threading.Timer(PATIENCE, print, [COMPILING], {"file": sys.stderr, "flush": True})
    notice.daemon = True
    notice.start()
    # Under a force and under an imposed velocity; what changes friction, and what changes modes.
    for case in PRESETS[:3:2]:
        instrument = Instrument(playable(case, None, {}))
        for number, key in enumerate(("contact.friction.coefficient", "slider.length")):
            _ = [packed(part) for part in instrument.play(RATE // 100) if isinstance(part, Part)]
            instrument.change(playable(case, None, {key: 0.5}), number)
        list(instrument.play(RATE // 100))
    # Several contacts, modes that are coupled, a rigid track.
    for case in SYSTEMS:
        list(Instrument(playable(case, None, {})).play(RATE // 100))
    notice.cancel()


def addresses(host: str, port: int) -> list[str]:
    """Return where this machine opens the page, then lines on how other machines do, if they may.

    Parameters
    ----------
    host : str
        Address that is listened on.
    port : int
        Port.
    """
    shown = "localhost" if host in EVERYWHERE else f"[{host}]" if ":" in host else host
    address = f"http://{shown}:{port}/"
    if is_loopback(host):
        return [address]
    # A name with a dot would be refused.
    names = [socket.gethostname().partition(".")[0], *outward()] if host in EVERYWHERE else [shown]
    return [address, "other machines open " + " or ".join(f"http://{name}:{port}/" for name in names)]


def outward() -> list[str]:
    """Return the address by which other machines reach this one, if it has one; nothing is sent to find it."""
    with suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asked:
        asked.connect(ELSEWHERE)
        return [asked.getsockname()[0]]
    return []


def is_loopback(host: str) -> bool:
    """Return whether an address is this machine's own."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _bound(host: str, port: int) -> socket.socket:
    if not 0 <= port <= 65535:
        raise ArgumentError("port", "be from 0 to 65535", port)
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        found = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
        found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        found.bind(address)
        # Whoever reads the address may come at once: a call waits until it is answered.
        found.listen()
    except OSError as error:
        taken = " (another program listens there: choose another --port)" if error.errno == errno.EADDRINUSE else ""
        raise ArgumentError("host and port", "be free", got=f"{host}:{port}: {error.strerror}{taken}") from error
    return found
