"""What is heard: air, the track's motion from a record, its sound in time, levels, sensation, sound files."""

from .air import Air
from .bridges import Bridge
from .radiate import radiate
from .resistance import radiation_damping, radiation_efficiency

__all__ = ["Air", "Bridge", "radiate", "radiation_damping", "radiation_efficiency"]
