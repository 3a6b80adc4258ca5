"""Figures from Datasets (matplotlib lives here and nowhere else)."""

from .colours import LINE, LINES, STATUS_COLOURS
from .directivities import directivity
from .files import save
from .films import Film, animate
from .laws import friction
from .loci import root_loci
from .maps import regime_map
from .spectra import spectrum
from .spectrograms import spectrogram
from .timelines import overview, timeline

__all__ = [
    "LINE",
    "LINES",
    "STATUS_COLOURS",
    "Film",
    "animate",
    "directivity",
    "friction",
    "overview",
    "regime_map",
    "root_loci",
    "save",
    "spectrogram",
    "spectrum",
    "timeline",
]
