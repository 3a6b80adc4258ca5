"""A server of the page for each process of tests, a browser for each file of tests that needs one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from .browsing import Browsing, launched
from .conversation import Conversation, conversation
from .serving import Server


@pytest.fixture(scope="session")
def server(tmp_path_factory) -> Iterator[Server]:
    """Serve the page; at the end its standard error must be empty."""
    shared = Server(tmp_path_factory.mktemp("server") / "errors")
    yield shared
    shared.stop()
    assert shared.complaints == ""


@pytest.fixture
def own(tmp_path) -> Iterator[Server]:
    """Serve the page to a single test, which may end the server."""
    server = Server(tmp_path / "errors")
    yield server
    server.stop()
    assert server.complaints == ""


@pytest.fixture
def talk(server) -> Iterator[Conversation]:
    """Open a socket and receive its greeting."""
    with conversation(server) as opened:
        opened.until("hello")
        yield opened


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """Start a browser for one file of tests, since it keeps an event loop running."""
    with launched() as browser:
        yield browser


@pytest.fixture
def browsing(chromium, server) -> Iterator[Browsing]:
    """Return a visitor that opens pages, none of which may log errors."""
    with Browsing(chromium, server) as opened:
        yield opened
