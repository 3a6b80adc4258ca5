"""Figures of Datasets and views of systems (the only package that uses matplotlib and pyvista)."""

from __future__ import annotations

from typing import Any

from ..extras import on_first_use

_HOME = {
    "LINE": "colours",
    "LINES": "colours",
    "STATUS_COLOURS": "colours",
    "Film": "reels",
    "animate": "films",
    "animate_mode": "mode_films",
    "animate_surface": "surfaces",
    "basin": "dynamics",
    "bifurcation": "branches",
    "bodies": "space_films",
    "calibration": "calibrations",
    "directivity": "directivities",
    "friction": "laws",
    "mac": "shape_agreements",
    "meshes": "mesh_drawings",
    "mobility": "mobilities",
    "mode_probability": "probabilities",
    "mode_sensitivity": "effects",
    "mode_shapes": "shapes_of_modes",
    "multipliers": "branches",
    "orbit_diagram": "dynamics",
    "order_spectrum": "order_spectra",
    "overview": "timelines",
    "regime_map": "maps",
    "root_loci": "loci",
    "save": "files",
    "spectrogram": "spectrograms",
    "spectrum": "spectra",
    "squeal_events": "squeal_levels",
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
    return on_first_use(__name__, _HOME, name)


def __dir__() -> list[str]:
    return sorted(__all__)
