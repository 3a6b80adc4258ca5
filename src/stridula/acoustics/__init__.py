"""Acoustics: air, sound of bodies from the motion in a record, levels, psychoacoustics, sound files."""

from __future__ import annotations

from typing import Any

from ..extras import on_first_use
from .air import Air
from .bridges import Bridge
from .radiate import radiate
from .resistance import radiation_damping, radiation_efficiency

_HOME = {
    "PlayableSound": "listening",
    "SoundFile": "wav",
    "equivalent_level": "levels",
    "harmonic_levels": "levels",
    "listen": "listening",
    "loudness": "sensation",
    "loudness_over_time": "sensation",
    "read_wav": "wav",
    "prominent_tones": "sensation",
    "roughness": "sensation",
    "sharpness": "sensation",
    "sound_level": "levels",
    "squeal_events": "squeals",
    "third_octave_levels": "levels",
    "write_wav": "wav",
}
__all__ = ["Air", "Bridge", "radiate", "radiation_damping", "radiation_efficiency", *_HOME]


def __getattr__(name: str) -> Any:
    """Import a name from its module on first use: levels and sensation need filters, which are slow to import."""
    return on_first_use(__name__, _HOME, name)


def __dir__() -> list[str]:
    return sorted(__all__)
