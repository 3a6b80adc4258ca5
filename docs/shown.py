"""What the gallery shows of an example: the figures that it saves or ends a block with, and sounds to play."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst


def figures(block: tuple[str, str, int], variables: dict[str, Any], gallery: dict[str, Any]) -> str:
    """Move the pictures that a block has written to the page, and draw the figure of its last line."""
    places = variables["image_path_iterator"]
    found = []
    for written in sorted(Path(variables["src_file"]).parent.glob("*.png")):
        found.append(next(places))
        shutil.move(written, found[-1])
    names = variables["example_globals"]
    last = names.get("___")
    if isinstance(last, Figure):
        found.append(next(places))
        last.savefig(found[-1])
        # It would stay the last value of the script until another block ends with one.
        names["___"] = None
    plt.close("all")
    return figure_rst(found, gallery["src_dir"])


def _get_sg_image_scraper() -> Callable[..., str]:
    """Return what sphinx-gallery asks a module for."""
    return figures
