"""Log messages during the search for modes of large bodies."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import Any

from ..long_tasks import task_told

# With fewer degrees of freedom the modes are found before a message could be read.
LARGE = 1000


def search_told(body: Any, size: int) -> AbstractContextManager[None]:
    """Log the beginning and the end of the search for the modes of a body of many degrees of freedom, `size`."""
    if size < LARGE:
        return nullcontext()
    name = body.name or f"the {body.kind} body"
    return task_told(f"modes of {name} ({size:,} degrees of freedom)".replace(",", " "))
