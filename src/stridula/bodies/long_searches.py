"""What is said while the modes of large bodies are found: records of the logger "stridula", at INFO."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import Any

LOGGER = logging.getLogger("stridula")
# Modes of fewer degrees of freedom are found before one has read that they are.
LARGE = 1000


@contextmanager
def search_told(body: Any, size: int) -> Iterator[None]:
    """Tell of the search for the modes of a body of `size` degrees of freedom, when it begins and when it ends.

    Where there are many. The first record has what is done as ``doing``, the last one None.
    """
    if size < LARGE:
        yield
        return
    name = body.name or f"the {body.kind} body"
    doing = f"modes of {name} ({size:,} degrees of freedom)".replace(",", " ")
    LOGGER.info("%s ...", doing, extra={"doing": doing})
    start = perf_counter()
    try:
        yield
    finally:
        LOGGER.info("%s: %.3g s", doing, perf_counter() - start, extra={"doing": None})
