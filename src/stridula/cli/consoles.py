"""Output of tables and texts."""

from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING

from ..disk import write

if TYPE_CHECKING:
    from rich.console import Console

# Columns in a file or a pipe; a terminal has its own width.
WIDTH = 150


def wide_console() -> Console:
    """Return a console on standard output, wide enough for tables if it is not a terminal."""
    from rich.console import Console

    console = Console()
    return console if console.is_terminal else Console(width=WIDTH)


def put(text: str, out: str | None) -> None:
    """Write a text to a file, or to standard output, as UTF-8 regardless of the encoding of the console."""
    if out is not None:
        write(out, text.encode())
        return
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(encoding="utf-8")
    sys.stdout.write(text)


def print_anything() -> None:
    """Print a question mark for characters that the console cannot encode, instead of failing."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
