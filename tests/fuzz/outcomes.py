"""Outcomes of an input: it is accepted, or refused in one line."""

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
# Documented exceptions.
DOCUMENTED = (ValueError, TypeError, OSError, st.Diverged, st.Interrupted)
LONGEST = 2000
# Wall time after which a run that succeeds is stopped [s].
PATIENCE = 0.5


class EnoughError(Exception):
    """A run succeeds and is stopped."""


def watcher() -> Callable[[Any], None]:
    """Return a watcher that stops a run after this time."""
    began = time.monotonic()

    def watch(progress: Any) -> None:
        if time.monotonic() > began + PATIENCE:
            raise EnoughError

    return watch


def outcome(call: Callable[[], object]) -> str:
    """Return whether a call is accepted or refused as documented; other exceptions are not caught.

    Raises
    ------
    AssertionError
        If the message of a refusal is empty, long or of several lines.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # The font of figures may lack letters of a title.
        warnings.filterwarnings("ignore", "Glyph ")
        warnings.simplefilter("ignore", st.DoubtfulValue)
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
