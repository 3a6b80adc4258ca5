"""Whether what a verb is to write can be written."""

from __future__ import annotations

from pathlib import Path

from ..checks import ArgumentError
from ..disk import check_writable


def check_outputs(out: str | None, plot: str | None, word: str = "--out", figure: str = "--plot") -> None:
    """Raise ValueError or OSError if a file and a figure cannot be written there; write nothing.

    Parameters
    ----------
    out, plot : str or None
        The files, None for one that is not asked for.
    word, figure : str, optional
        The options of both.
    """
    if out is not None and plot is not None and Path(out).resolve() == Path(plot).resolve():
        raise ArgumentError(figure, f"be another file than {word}", plot, got=f"{plot!r} for both")
    if plot is not None:
        from matplotlib.figure import Figure

        formats = sorted(Figure().canvas.get_supported_filetypes())
        if _format(plot) not in formats:
            raise ArgumentError(figure, f"end in one of {', '.join(f'.{word}' for word in formats)}", plot)
    for path in (out, plot):
        if path is not None:
            check_writable(path)


def _format(path: str) -> str:
    return Path(path).suffix.lower().removeprefix(".")
