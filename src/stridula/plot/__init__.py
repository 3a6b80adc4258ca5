"""Figures of Datasets and views of systems (the only package that uses matplotlib and pyvista)."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "LINE": "colours",
    "LINES": "colours",
    "STATUS_COLOURS": "colours",
    "Film": "reels",
    "animate": "films",
    "animate_mode": "mode_films",
    "animate_surface": "surfaces",
    "bodies": "space_films",
    "directivity": "directivities",
    "friction": "laws",
    "mobility": "mobilities",
    "mode_shapes": "shapes_of_modes",
    "overview": "timelines",
    "regime_map": "maps",
    "root_loci": "loci",
    "save": "files",
    "spectrogram": "spectrograms",
    "spectrum": "spectra",
    "squeal_map": "squeals",
    "surface": "surfaces",
    "system": "systems",
    "third_octaves": "bands",
    "timeline": "timelines",
    "view": "views",
    "view_mode": "views",
    "waterfall": "waterfalls",
}
__all__ = list(_HOME)


def __getattr__(name: str) -> Any:
    """Import a figure from its module on first use: films and spectra are slow to import."""
    if name not in _HOME:
        raise AttributeError(f"module 'stridula.plot' has no attribute {name!r}")
    return getattr(import_module(f".{_HOME[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted(__all__)
