"""Write figures to files."""

from __future__ import annotations

import io
from pathlib import Path

from matplotlib.figure import Figure

from ..checks import instance
from ..disk import check_path, write


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure in the format of the file suffix, whole or not at all.

    Raises
    ------
    ValueError
        If matplotlib does not know the format.
    OSError
        If the file cannot be written.
    """
    instance("figure", figure, Figure)
    check_path("path", path)
    kind = Path(path).suffix.lower().removeprefix(".")
    image = io.BytesIO()
    figure.savefig(image, format=kind)
    write(path, image.getvalue())
