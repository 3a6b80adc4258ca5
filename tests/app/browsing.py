"""Pages in a browser, and the state that they report."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import pytest

from .serving import WAIT, Server

CHROMIUM = Path("/usr/bin/chromium")
MISSING = f"{CHROMIUM} must be there to test the page in a browser: apt-get install chromium"
ARGUMENTS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
)
STALL = "GPU stall due to ReadPixels"
RESTS = 500  # A part comes sooner than this [ms].
PLAYS = "window.stridula && stridula.stats.samples > 4800"


@contextmanager
def launched(*more: str) -> Iterator[Any]:
    """Start a browser with more arguments."""
    if not CHROMIUM.exists():
        if os.environ.get("CI"):
            pytest.fail(MISSING, pytrace=False)
        pytest.skip(MISSING)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=[*ARGUMENTS, *more])
        yield browser
        browser.close()


class Browsing(AbstractContextManager["Browsing"]):
    """A visitor: its pages share the storage of the browser, and none may log errors."""

    def __init__(self, chromium: Any, server: Server, **words: Any) -> None:
        self.server, self.complaints = server, []
        self.context = chromium.new_context(**({"viewport": {"width": 1280, "height": 900}} | words))
        self.context.set_default_timeout(1000.0 * WAIT)
        self.complains = True

    def open(self, hash: str = "#case=squeal", intro: bool = False, map: bool = False) -> Any:
        """Open the page, without introduction and, unless requested, without map, and wait until it plays.

        All controls are shown.
        """
        self.context.add_init_script("localStorage.getItem('more') ?? localStorage.setItem('more', '1')")
        if not intro:
            self.context.add_init_script("localStorage.setItem('visited', '1')")
        page = self.begin(hash)
        until(page, PLAYS)
        if not map:
            # A map occupies a processor for a while.
            page.evaluate("document.getElementById('map-on').click()")
        return page

    def begin(self, hash: str) -> Any:
        """Open the page, and collect its errors."""
        page = self.context.new_page()
        page.on("console", self._heard)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.goto(self.server.address + hash)
        return page

    def _heard(self, said: Any) -> None:
        # A browser that renders in software logs how long that takes.
        if said.type in ("error", "warning") and STALL not in said.text:
            self.complaints.append(said.text)

    def __exit__(self, *raised: Any) -> None:
        self.context.close()
        if raised[0] is None and self.complains:
            assert self.complaints == []


def until(page: Any, true: str, arg: Any = None) -> None:
    """Wait until an expression in `arg` is true; as a function, since the page forbids evaluating texts."""
    page.wait_for_function(f"(arg) => {true}", arg=arg)


def stats(page: Any, name: str) -> Any:
    """Return a statistic of the page."""
    return page.evaluate(f"stridula.stats.{name}")


def plays_on(page: Any, samples: int = 4800) -> None:
    """Wait until a number of further samples were played."""
    before = stats(page, "samples")
    until(page, f"stridula.stats.samples >= {before + samples}")


def pause(page: Any) -> None:
    """Pause, and wait until the parts that were on their way have come."""
    page.locator("#play").click()
    before = -1
    while before != (before := stats(page, "samples")):
        page.wait_for_timeout(RESTS)


def shown(page: Any, key: str) -> float:
    """Return the number that the page shows for a key, in the unit shown."""
    return float(page.locator(f"input[type=number][data-key='{key}']").input_value())


def pixels(page, canvas: str, colour: str) -> int:
    """Return the number of pixels of a canvas near the colour of a name."""
    return page.evaluate(
        """([id, name]) => {
          const canvas = document.getElementById(id);
          const hex = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim().slice(1);
          const wanted = [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));
          const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
          copy.drawImage(canvas, 0, 0);
          const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
          let found = 0;
          for (let i = 0; i < data.length; i += 4) {
            found += data[i + 3] > 128 && wanted.every((one, k) => Math.abs(one - data[i + k]) < 40);
          }
          return found;
        }""",
        [canvas, colour],
    )
