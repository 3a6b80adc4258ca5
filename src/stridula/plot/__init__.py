"""Figures from Datasets (matplotlib lives here and nowhere else)."""

from .colours import LINE, LINES, STATUS_COLOURS
from .files import save
from .laws import friction
from .loci import root_loci
from .maps import regime_map
from .timelines import overview, timeline

__all__ = [
    "LINE",
    "LINES",
    "STATUS_COLOURS",
    "friction",
    "overview",
    "regime_map",
    "root_loci",
    "save",
    "timeline",
]
