"""Figures within a page of HTML."""

from __future__ import annotations

import base64
import io
import re
from html import escape

import matplotlib as mpl
from matplotlib.figure import Figure

# Larger drawings are pixels, of this many in an inch [characters].
LARGEST_SVG, PIXELS = 1_500_000, 160
# Metadata that would differ from page to page, or name addresses.
NO_METADATA = dict.fromkeys(("Creator", "Date", "Format", "Type"))
_NAMED = re.compile(r'(\bid="|href="#|url\(#)')


def inline(figure: Figure, name: str, words: str) -> str:
    """Return a figure as an SVG element of a page, or as an image of pixels if it has too many lines.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    name : str
        Beginning of the names of its parts, different for each figure of a page.
    words : str
        Description for screen readers.
    """
    text = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": name, "svg.fonttype": "path"}):
        figure.savefig(text, format="svg", metadata=NO_METADATA)
    drawn = text.getvalue()
    if len(drawn) > LARGEST_SVG:
        image = io.BytesIO()
        figure.savefig(image, format="png", dpi=PIXELS)
        content = base64.b64encode(image.getvalue()).decode("ascii")
        return f'<img alt="{escape(words)}" src="data:image/png;base64,{content}">'
    element = _NAMED.sub(rf"\g<1>{name}-", drawn[drawn.index("<svg") :])
    return element.replace("<svg", f'<svg role="img" aria-label="{escape(words)}"', 1)
