"""Pages in a browser, and what they say of themselves."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Any

from .serving import WAIT, Server

STALL = "GPU stall due to ReadPixels"
PLAYS = "window.stridula && stridula.stats.samples > 4800"


class Browsing(AbstractContextManager["Browsing"]):
    """A visitor: pages opened share what the browser remembers, and none may complain."""

    def __init__(self, chromium: Any, server: Server, **words: Any) -> None:
        self.server, self.complaints = server, []
        self.context = chromium.new_context(**({"viewport": {"width": 1280, "height": 900}} | words))
        self.context.set_default_timeout(1000.0 * WAIT)
        self.complains = True

    def open(self, hash: str = "", intro: bool = False, map: bool = False) -> Any:
        """Open the page, its introduction read and its map left out unless asked for, and wait until it plays."""
        if not intro:
            self.context.add_init_script("localStorage.setItem('visited', '1')")
        page = self.begin(hash)
        until(page, PLAYS)
        if not map:
            # A map takes a processor for a while.
            page.evaluate("document.getElementById('map-on').click()")
        return page

    def begin(self, hash: str) -> Any:
        """Open the page, and listen to what it complains of."""
        page = self.context.new_page()
        page.on("console", self._heard)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.goto(self.server.address + hash)
        return page

    def _heard(self, said: Any) -> None:
        # A browser that draws by the processor tells of itself how long that takes.
        if said.type in ("error", "warning") and STALL not in said.text:
            self.complaints.append(said.text)

    def __exit__(self, *raised: Any) -> None:
        self.context.close()
        if raised[0] is None and self.complains:
            assert self.complaints == []


def until(page: Any, true: str, arg: Any = None) -> None:
    """Wait until an expression in `arg` is true; as a function, for the page lets nobody evaluate texts."""
    page.wait_for_function(f"(arg) => {true}", arg=arg)


def stats(page: Any, name: str) -> Any:
    """Return a number that the page keeps of itself."""
    return page.evaluate(f"stridula.stats.{name}")


def plays_on(page: Any, samples: int = 4800) -> None:
    """Wait until so many more samples were played."""
    before = stats(page, "samples")
    until(page, f"stridula.stats.samples >= {before + samples}")


def shown(page: Any, key: str) -> float:
    """Return the number that the page shows of a key, in the unit shown."""
    return float(page.locator(f"input[type=number][data-key='{key}']").input_value())
