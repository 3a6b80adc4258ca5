"""Log messages during the search for modes of large bodies: logger "stridula", level INFO."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import Any

LOGGER = logging.getLogger("stridula")
# With fewer degrees of freedom the modes are found before a message could be read.
LARGE = 1000


@contextmanager
def search_told(body: Any, size: int) -> Iterator[None]:
    """Log the beginning and the end of the search for the modes of a body of many degrees of freedom, `size`.

    The first record describes the search in ``task``, the last one has None.
    """
    if size < LARGE:
        yield
        return
    name = body.name or f"the {body.kind} body"
    task = f"modes of {name} ({size:,} degrees of freedom)".replace(",", " ")
    LOGGER.info("%s ...", task, extra={"task": task})
    start = perf_counter()
    try:
        yield
    finally:
        LOGGER.info("%s: %.3g s", task, perf_counter() - start, extra={"task": None})
