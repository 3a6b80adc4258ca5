"""The server of the page: its files, its socket, and its access control."""

from __future__ import annotations

import ipaddress
import mimetypes
import re
import threading
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from importlib.resources import files

from starlette.applications import Starlette
from starlette.requests import HTTPConnection, Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from .beside import Beside
from .session import Session

PAGE = files(__package__).joinpath("page")
# Files of third parties, unchanged.
VENDOR = "vendor"
MOST_PAGES = 16
# Codes of a closed socket: a page from another server, and too many pages.
FROM_ELSEWHERE, TOO_MANY = 4403, 4429
LOOPBACK = ("localhost", "127.0.0.1", "[::1]")
NAME = re.compile(r"[A-Za-z0-9_.-]+")
POLICY = (
    "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src {sockets}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-cache",
}


class Pages:
    """The open pages and their shared processes.

    Parameters
    ----------
    ready : Event or None
        Set once the code is compiled; None if there is nothing to wait for.
    """

    def __init__(self, ready: threading.Event | None) -> None:
        self.open, self.beside, self.ready = 0, Beside(), ready

    async def socket(self, socket: WebSocket) -> None:
        """Play for a page until it disconnects."""
        await socket.accept()
        if not _is_same_origin(socket):
            await socket.close(FROM_ELSEWHERE, "the page must come from this server")
            return
        if self.open >= MOST_PAGES:
            await socket.close(TOO_MANY, f"at most {MOST_PAGES} pages can be open")
            return
        self.open += 1
        try:
            with suppress(WebSocketDisconnect):
                await Session(socket, self.beside, self.ready).run()
        finally:
            self.open -= 1
            if not self.open:
                self.beside.close()

    @asynccontextmanager
    async def until_the_end(self, app: Starlette) -> AsyncIterator[None]:
        """Serve, and end the process with the server."""
        yield
        await self.beside.end()


def create_app(is_open: bool = False, ready: threading.Event | None = None) -> ASGIApp:
    """Return the server of the page.

    Parameters
    ----------
    is_open : bool, optional
        Whether other machines may connect; if not, requests must use a loopback name, so that no other page in the
        browser can reach the server under another name.
    ready : Event, optional
        Set once the code is compiled, for which pages wait.
    """
    pages = Pages(ready)
    known = {entry.name: entry for entry in PAGE.iterdir() if entry.is_file()}
    known |= {f"{VENDOR}/{entry.name}": entry for entry in PAGE.joinpath(VENDOR).iterdir() if entry.is_file()}

    async def page(request: Request) -> Response:
        name = request.path_params.get("name", "index.html")
        if name not in known:
            return PlainTextResponse("not found", 404, HEADERS)
        kind = mimetypes.guess_type(name)[0] or "application/octet-stream"
        policy = {"Content-Security-Policy": POLICY.format(sockets=_sockets(request.headers["host"]))}
        kind = "text/javascript" if name.endswith(".js") else kind
        return Response(known[name].read_bytes(), 200, HEADERS | policy, kind)

    routes = [Route("/", page), WebSocketRoute("/socket", pages.socket), Route("/{name:path}", page)]
    app = Starlette(routes=routes, lifespan=pages.until_the_end)
    app.state.pages = pages
    return _named_rightly(app, is_open)


def _sockets(host: str) -> str:
    """Return the addresses of sockets for the policy: some browsers do not count their own server as 'self'."""
    # A policy cannot contain an IPv6 address.
    return "'self'" if host.startswith("[") else f"'self' ws://{host} wss://{host}"


def _named_rightly(app: ASGIApp, is_open: bool) -> ASGIApp:
    """Return an app that answers only requests with an allowed Host header."""

    async def checked(scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] in ("http", "websocket"):
            host = HTTPConnection(scope).headers.get("host", "")
            if not _is_right(host, is_open):
                await _refused(scope, receive, send)
                return
        await app(scope, receive, send)

    return checked


async def _refused(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "http":
        await PlainTextResponse("host must be an address of this machine", 421, HEADERS)(scope, receive, send)
        return
    await receive()
    await send({"type": "websocket.close", "code": FROM_ELSEWHERE})


def _is_right(host: str, is_open: bool) -> bool:
    """Return whether a Host header names this machine: by a loopback name, or any address if it is open."""
    name = host.rpartition(":")[0] if host.rpartition(":")[2].isdigit() else host
    if name in LOOPBACK:
        return True
    if not is_open:
        return False
    with suppress(ValueError):
        ipaddress.ip_address(name.strip("[]"))
        return True
    return NAME.fullmatch(name) is not None and ("." not in name or name.endswith((".local", ".lan")))


def _is_same_origin(socket: WebSocket) -> bool:
    """Return whether the page that opens a socket came from this server."""
    origin = socket.headers.get("origin", "")
    return origin.partition("://")[2] == socket.headers.get("host") and origin.startswith(("http://", "https://"))
