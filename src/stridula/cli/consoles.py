"""Where tables are printed."""

from __future__ import annotations

from rich.console import Console

# Of a file or a pipe; a terminal has its own.
WIDTH = 150


def wide_console() -> Console:
    """Return standard output, wide enough for tables where it is no terminal."""
    console = Console()
    return console if console.is_terminal else Console(width=WIDTH)
