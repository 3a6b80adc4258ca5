"""Pages as `make docs` builds them, in a browser: none is endless, and none loads anything from elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from app.browsing import launched

from .pages import ROOT

BUILT = ROOT / "docs" / "_build" / "html"
LIMIT = 15_000
# Those with most text, which are the longest.
COUNT = 40
WIDTH = 1280


@pytest.fixture(scope="module")
def page() -> Iterator[Any]:
    if not (BUILT / "index.html").exists():
        pytest.skip("make docs must come first")
    with launched() as chromium:
        yield chromium.new_page(viewport={"width": WIDTH, "height": 900})


def height(page: Any) -> int:
    return page.evaluate("document.documentElement.scrollHeight")


def test_no_page_is_endless_or_needs_a_network(page):
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    written = [path for path in BUILT.rglob("*.html") if not {"_static", "_modules"} & set(path.parts)]
    heights = {}
    for path in sorted(written, key=lambda path: path.stat().st_size)[-COUNT:]:
        page.goto(path.as_uri())
        heights[path.relative_to(BUILT).as_posix()] = height(page)
    assert {name: pixels for name, pixels in heights.items() if pixels > LIMIT} == {}
    assert [url for url in asked if url.startswith("http")] == []
    # Negative control.
    page.evaluate(f"document.body.append(Object.assign(document.createElement('p'), {{style: 'height: {LIMIT}px'}}))")
    assert height(page) > LIMIT
