"""What we keep: the table of recorded variables, probes, and their Dataset."""

from .probes import Acceleration, Displacement, Probe, Reaction, Velocity

__all__ = ["Acceleration", "Displacement", "Probe", "Reaction", "Velocity"]
