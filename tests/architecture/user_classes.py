"""A track and a law of friction defined by a user, without registration in the package."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stridula.bodies import BodyPoint, Modes, Path, Waves
from stridula.contact import FrictionLaw


@dataclass(frozen=True)
class Cable:
    """A taut cable with transverse motion: w_k = (k pi / L) c, shapes sin(k pi x / L)."""

    length: float
    mass: float
    speed: float
    count: int
    name: str = ""
    kind: ClassVar[str] = "cable"
    has_positions: ClassVar[bool] = True
    is_spatial: ClassVar[bool] = False
    has_translation: ClassVar[bool] = False
    point_names: ClassVar[tuple[str, ...]] = ("centre",)
    posture: ClassVar[str] = ""
    axes = np.eye(2)

    @property
    def dimensions(self):
        return f"{self.length:.4g} m"

    @property
    def total_mass(self):
        return self.mass

    @property
    def ends(self):
        return 0.0, self.length

    @property
    def centre(self):
        return BodyPoint(self, self.length / 2)

    def check_position(self, position):
        assert 0.0 <= position <= self.length

    def modes(self, held_x=False):
        numbers = np.arange(1, self.count + 1)
        still = np.zeros(self.count)
        return Modes(numbers * np.pi / self.length * self.speed, still + 2.0, np.zeros((2, self.count)))

    def path(self):
        numbers = np.arange(1, self.count + 1)
        amplitude = np.sqrt(2 / self.mass) * np.eye(1, 2).repeat(self.count, 0)
        across = Waves(np.stack([numbers, 0 * numbers], axis=1), amplitude)
        nothing = Waves(np.zeros((0, 2), dtype=int), np.zeros((0, 2)))
        return Path(self.ends, np.array([np.pi / self.length, 0.0]), np.zeros(2), across, nothing)

    def trace(self, position, held_x=False):
        return self.path().traces(position)[0]


@dataclass(frozen=True)
class Halving(FrictionLaw):
    """Friction that falls to its half with the slip speed, in a form known to the march."""

    coefficient: float
    velocity: float
    law: ClassVar[str] = "halving"
    kernel_code: ClassVar[str] = "STRIBECK"

    def parameters(self):
        return {
            "static": self.coefficient,
            "kinetic": self.coefficient / 2,
            "velocity": self.velocity,
            "exponent": 1.0,
            "viscous": 0.0,
        }

    def coefficient_at(self, velocity):
        return self.coefficient / 2 * (1 + np.exp(-np.abs(velocity) / self.velocity))
