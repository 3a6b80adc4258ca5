"""Checks that the output files of a command can be written."""

from __future__ import annotations

from pathlib import Path

from ..checks import ArgumentError
from ..disk import RECORDS, check_ending, check_writable

# Option of a record.
RECORD = "--out"


def check_outputs(out: str | None, plot: str | None, word: str = RECORD, figure: str = "--plot") -> None:
    """Raise ValueError or OSError if a file or a figure cannot be written; write nothing.

    Parameters
    ----------
    out, plot : str or None
        Paths of the file and the figure, None if not requested.
    word, figure : str, optional
        Their options, for messages.
    """
    if out is not None and plot is not None and Path(out).resolve() == Path(plot).resolve():
        raise ArgumentError(figure, f"differ from {word}", plot, got=f"{plot!r} for both")
    if plot is not None:
        from matplotlib.figure import Figure

        formats = sorted(Figure().canvas.get_supported_filetypes())
        if _format(plot) not in formats:
            raise ArgumentError(figure, f"end in one of {', '.join(f'.{word}' for word in formats)}", plot)
    for path in (out, plot):
        if path is not None:
            check_writable(path)


def check_record(out: str | None) -> None:
    """Raise ValueError if the file of the option ``--out`` has the ending of another format than a record."""
    if out is not None:
        check_ending(RECORD, out, RECORDS, "NetCDF file", "`stridula export` writes tables, --plot figures")


def _format(path: str) -> str:
    return Path(path).suffix.lower().removeprefix(".")
