"""The server on its port, and the browser that opens."""

from __future__ import annotations

import errno
import gc
import ipaddress
import logging
import os
import socket
import sys
import threading
import time
import webbrowser
from contextlib import suppress

import uvicorn

from ..checks import ArgumentError
from ..integration.compiled_code import tell_of_compiling
from ..studies.task import use_one_thread
from .caller import Caller, is_news
from .instrument import RATE, Instrument
from .messages import LARGEST
from .playable import PRESETS, SYSTEMS, playable
from .server import create_app

# Time to wait for pages when the server stops [s].
GRACE = 2
# Interval at which the end of the server is looked for [s].
SOON = 0.2
# Host names that stand for all addresses of this machine.
EVERYWHERE = ("0.0.0.0", "::")
# An unused address and port.
ELSEWHERE = ("192.0.2.1", 9)
# Longest time for which a thread keeps the interpreter while another waits [s].
HANDED_OVER = 0.001
COMPILING = "stridula: compiling, once for all later starts, while the page waits: "


def serve(host: str, port: int, is_open: bool, opens_browser: bool) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    host : str
        Address to listen on.
    port : int
        Port; 0 for any free one.
    is_open : bool
        Whether other machines may connect.
    opens_browser : bool
        Whether to open a browser.

    Raises
    ------
    ValueError
        If the host is not a loopback address and `is_open` is false, or the port is not free.
    """
    if not (is_open or is_loopback(host)):
        raise ArgumentError("host", "be an address of this machine, such as 127.0.0.1, unless --open is given", host)
    listening = _bound(host, port)
    use_one_thread()
    # Threads that prepare a change must not hold up the sound.
    sys.setswitchinterval(HANDED_OVER)
    address, *others = addresses(host, listening.getsockname()[1])
    print("\n".join([f"stridula plays at {address} (Ctrl-C stops it)", *others]), flush=True)
    # Pages that disconnect during a response are not logged.
    logging.getLogger("asyncio").setLevel(logging.ERROR)
    if opens_browser:
        threading.Timer(0.5, webbrowser.open, [address]).start()
    ready = threading.Event()
    threading.Thread(target=_get_ready, args=[ready], daemon=True).start()
    running = server(is_open, ready)
    threading.Thread(target=_end_at_last, args=[running], daemon=True).start()
    # Ctrl-C ends the server normally.
    with suppress(KeyboardInterrupt):
        running.run(sockets=[listening])


def server(is_open: bool, ready: threading.Event | None = None) -> uvicorn.Server:
    """Return the server of the page.

    Parameters
    ----------
    is_open : bool
        Whether other machines may connect.
    ready : Event, optional
        Set once the code is compiled, for which pages wait.
    """
    config = uvicorn.Config(
        create_app(is_open, ready),
        http=Caller,
        ws="websockets-sansio",
        ws_max_size=LARGEST,
        ws_per_message_deflate=False,
        # Errors of callers are reported to them only.
        log_level="error",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=GRACE,
        limit_concurrency=200,
    )
    logging.getLogger("uvicorn.error").addFilter(is_news)
    return uvicorn.Server(config)


def _end_at_last(running: uvicorn.Server) -> None:
    """End the process some time after its server was told to end: threads that compile would keep it for minutes."""
    while not running.should_exit:
        time.sleep(SOON)
    time.sleep(2 * GRACE)
    os._exit(0)


def _get_ready(ready: threading.Event) -> None:
    """Play a moment of every kind of system, with a notice if that compiles its code, then set an event."""
    told = threading.Event()

    def tell(time: str) -> None:
        if not told.is_set():
            told.set()
            print(COMPILING + time, file=sys.stderr, flush=True)

    try:
        with tell_of_compiling(tell):
            _play_a_moment()
        # Existing objects are permanent: searching them for garbage would interrupt the sound.
        gc.collect()
        gc.freeze()
    finally:
        ready.set()


def _play_a_moment() -> None:
    # Cases with a force and with an imposed velocity, and changes of friction and of modes.
    for case in PRESETS[:3:2]:
        instrument = Instrument(playable(case, None, {}))
        for number, key in enumerate(("contact.friction.coefficient", "slider.length")):
            list(instrument.play(RATE // 100))
            instrument.change(playable(case, None, {key: 0.5}), number)
        list(instrument.play(RATE // 100))
    # Cases with several contacts, coupled modes and a rigid track.
    for case in SYSTEMS:
        list(Instrument(playable(case, None, {})).play(RATE // 100))


def addresses(host: str, port: int) -> list[str]:
    """Return the address of the page on this machine, followed by a line for other machines if they may connect.

    Parameters
    ----------
    host : str
        Address on which the server listens.
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
    """Return the address of this machine in its network, if any; nothing is sent to find it."""
    with suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asked:
        asked.connect(ELSEWHERE)
        return [asked.getsockname()[0]]
    return []


def is_loopback(host: str) -> bool:
    """Return whether an address is a loopback address."""
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
        # The address may be used at once; a connection then waits until it is accepted.
        found.listen()
    except OSError as error:
        taken = " (another program listens there: choose another --port)" if error.errno == errno.EADDRINUSE else ""
        raise ArgumentError("host and port", "be free", got=f"{host}:{port}: {error.strerror}{taken}") from error
    return found
