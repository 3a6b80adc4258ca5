"""What may come of an input: it is accepted, or refused in one line."""

from __future__ import annotations

import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager
from pathlib import Path
from typing import Any

import stridula as st

ACCEPTED, REFUSED = "accepted", "refused"
# What the documentation says that is raised.
DOCUMENTED = (ValueError, TypeError, OSError, st.Diverged, st.Interrupted)
LONGEST = 2000
# How long a run that goes well is watched [s].
PATIENCE = 0.5


class EnoughError(Exception):
    """A run goes well and is stopped."""


def watcher() -> Callable[[Any], None]:
    """Return a watcher that stops a run which has gone on for long enough."""
    began = time.monotonic()

    def watch(progress: Any) -> None:
        if time.monotonic() > began + PATIENCE:
            raise EnoughError

    return watch


def outcome(call: Callable[[], object]) -> str:
    """Return whether a call is accepted or refused as documented; anything else that is raised goes through.

    Raises
    ------
    AssertionError
        If the message of a refusal is empty, long or of several lines.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # A title may be in letters that the font of figures lacks.
        warnings.filterwarnings("ignore", "Glyph ")
        try:
            call()
        except EnoughError:
            return ACCEPTED
        except DOCUMENTED as error:
            _check_words(f"{type(error).__name__}", str(error))
            return REFUSED
    return ACCEPTED


def _check_words(kind: str, text: str) -> None:
    assert text.strip(), f"{kind} without words"
    assert len(text) <= LONGEST, f"{kind} of {len(text)} characters: {text[:300]}"
    assert "\n" not in text, f"{kind} of several lines: {text[:300]!r}"


@contextmanager
def folder() -> Iterator[Path]:
    """Work in an empty folder."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as name, chdir(name):
        yield Path(name)
