"""The HTTP side of a connection: slow callers are disconnected, and invalid requests are not logged."""

from __future__ import annotations

import asyncio
import logging

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

# A caller is disconnected after this time without a complete request [s].
HURRY = 10.0


class Caller(H11Protocol):
    """A caller of the server, until it requests a socket."""

    _lets_go: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for a request."""
        super().connection_made(transport)
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._stop_waiting()
        super().connection_lost(exc)

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """Stop waiting, as the socket takes over."""
        self._stop_waiting()
        super().handle_websocket_upgrade(event)

    def on_response_complete(self) -> None:
        """Wait until the caller has read the response and sends the next request."""
        self._wait()
        super().on_response_complete()

    def send_400_response(self, msg: str) -> None:
        """Refuse an invalid request; in the middle of a response, close the connection."""
        if self.conn.our_state is h11.IDLE:
            super().send_400_response(msg)
            return
        if self.cycle is not None:
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        self.transport.close()

    def _wait(self) -> None:
        self._stop_waiting()
        self._lets_go = self.loop.call_later(HURRY, self._let_go)

    def _stop_waiting(self) -> None:
        if self._lets_go is not None:
            self._lets_go.cancel()
            self._lets_go = None

    def _let_go(self) -> None:
        if self.cycle is None or self.cycle.response_complete:
            self.transport.abort()
        else:
            self._wait()


def is_news(record: logging.LogRecord) -> bool:
    """Return whether a log record is about the server and not about data sent by a page."""
    return not str(record.msg).startswith("Invalid UTF-8")
