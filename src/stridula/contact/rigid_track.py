"""A track that does not bend: floor, wall, belt, disc or shaken plane."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..checks import finite, instance
from ..histories import HISTORIES, Constant, Harmonic, Ramp, Sampled


@dataclass(frozen=True)
class RigidTrack:
    """An endless rigid plane, fixed or moving as prescribed.

    Parameters
    ----------
    velocity : float, optional
        Velocity along its tangent [m/s], as of a belt or a disc.
    normal_velocity : float, optional
        Velocity along its normal, towards the tip [m/s], as of a shaken plane.
    history, normal_history : Constant, Ramp, Harmonic or Sampled, optional
        Factors on the two velocities over time.
    name : str, optional
        What it is called in records.
    """

    velocity: float = 0.0
    normal_velocity: float = 0.0
    history: Constant | Ramp | Harmonic | Sampled = field(default_factory=Constant)
    normal_history: Constant | Ramp | Harmonic | Sampled = field(default_factory=Constant)
    name: str = ""

    def __post_init__(self) -> None:
        finite("velocity", self.velocity)
        finite("normal_velocity", self.normal_velocity)
        instance("history", self.history, HISTORIES)
        instance("normal_history", self.normal_history, HISTORIES)
        instance("name", self.name, str)

    @property
    def is_still(self) -> bool:
        """Whether it does not move."""
        return self.velocity == 0.0 and self.normal_velocity == 0.0
