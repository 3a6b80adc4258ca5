"""A beam given by its exact modes: simply supported in bending, clamped in traction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..checks import at_least, count, instance, positive, within
from .damping import DampingLaw, check_damping_count, checked_damping, damping_rates
from .modes import Array, BodyPoint, Modes, hashed_once
from .ordinary import check_first_modes, check_mode_count, of_ordinary_size
from .sections import Circle, Material, Rectangle, Section


@hashed_once
@dataclass(frozen=True)
class ModalBeam:
    """A straight beam along world x in its exact modes ``sin(k pi x / L)``, bending ones first, then axial ones.

    Euler-Bernoulli, simply supported in bending: ``w_k = (k pi/L)² sqrt(EI / rho S)``; clamped in traction:
    ``w_k = (k pi/L) sqrt(E / rho)``; modal mass ``rho S L / 2``. Displacements: u along x, w along y, towards the
    slider.

    Parameters
    ----------
    material : Material
        What it is made of.
    section : Rectangle, Circle or Section
        Its cross-section.
    length : float
        Length [m], from x = 0 to its right end.
    bending_modes, axial_modes : int, optional
        Number of modes kept of each kind.
    damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
        Damping ratio of every mode [1], from 0 to 1 (1 excluded), one for each mode in their order, or a law of their
        frequency.
    cutoff : float, optional
        Keep the modes up to this frequency [Hz] instead of the counts above.
    name : str, optional
        What it is called in records; tells equal bodies apart.

    Raises
    ------
    ValueError
        If an argument is out of its range, or if no bending mode lies below `cutoff`.
    """

    material: Material
    section: Rectangle | Circle | Section
    length: float
    bending_modes: int = 40
    axial_modes: int = 20
    damping: float | Sequence[float] | DampingLaw = 0.0
    cutoff: float | None = None
    name: str = ""

    @of_ordinary_size("material, section and length")
    def __post_init__(self) -> None:
        instance("material", self.material, Material)
        instance("section", self.section, (Rectangle, Circle, Section))
        positive("length", self.length)
        count("bending_modes", self.bending_modes)
        count("axial_modes", self.axial_modes, low=0)
        object.__setattr__(self, "damping", checked_damping(self.damping))
        instance("name", self.name, str)
        if self.cutoff is not None:
            positive("cutoff", self.cutoff)
            check_first_modes((self._bending(1), self._axial(1)), self.cutoff)
            if self.harmonics[0] < 1:
                first = at_least(float(self._bending(1)) / (2 * np.pi))
                raise ValueError(
                    f"cutoff must leave at least one bending mode (first at {first} Hz), got {self.cutoff!r} Hz"
                )
        check_mode_count(sum(self.harmonics), self.cutoff)
        check_damping_count(self.damping, sum(self.harmonics))

    @property
    def ends(self) -> tuple[float, float]:
        """Abscissas of its two ends [m]."""
        return 0.0, self.length

    @property
    def centre(self) -> BodyPoint:
        """The point at mid-span."""
        return BodyPoint(self, self.length / 2.0)

    def at(self, position: float) -> BodyPoint:
        """Return the point at abscissa `position` [m]."""
        return BodyPoint(self, position)

    def check_position(self, position: float) -> None:
        """Raise ValueError if abscissa `position` [m] is not on the beam."""
        within("position", position, 0.0, self.length)

    @property
    def axes(self) -> Array:
        """Unit vectors of the axial and the transverse direction in the world frame, shape (2, 2)."""
        return np.eye(2)

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""
        return self.material.density * self.section.area * self.length

    @property
    def amplitude(self) -> float:
        """Largest value of a mass-normalised mode shape [kg^(-1/2)], ``sqrt(2 / rho S L)``."""
        return float(np.sqrt(2.0 / self.total_mass))

    @property
    def harmonics(self) -> tuple[int, int]:
        """Numbers of bending and of axial modes kept."""
        if self.cutoff is None:
            return self.bending_modes, self.axial_modes
        highest = 2.0 * np.pi * self.cutoff * (1.0 + 1e-12)
        return int(np.sqrt(highest / self._bending(1))), int(highest / self._axial(1))

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes, bending ones first; `held_x` is for bodies whose root is driven and must be false."""
        if held_x:
            raise ValueError("held_x must be False for a ModalBeam: its ends are fixed, got True")
        return _modes(self)

    def trace(self, position: float, held_x: bool = False) -> Array:
        """Return the rows that give the displacement (u, w) at abscissa `position` from the modes, shape (2, modes)."""
        self.check_position(position)
        bending, axial = self.harmonics
        rows = np.zeros((2, bending + axial))
        rows[1, :bending] = self.amplitude * np.sin(np.arange(1, bending + 1) * np.pi * position / self.length)
        rows[0, bending:] = self.amplitude * np.sin(np.arange(1, axial + 1) * np.pi * position / self.length)
        return rows

    def trace_slope(self, position: float) -> Array:
        """Return the derivative of `trace` along the beam [1/m], shape (2, modes)."""
        self.check_position(position)
        bending, axial = self.harmonics
        rows = np.zeros((2, bending + axial))
        for row, kind, size in ((1, slice(0, bending), bending), (0, slice(bending, None), axial)):
            numbers = np.arange(1, size + 1) * np.pi / self.length
            rows[row, kind] = self.amplitude * numbers * np.cos(numbers * position)
        return rows

    def _bending(self, harmonic: int | Array) -> Array:
        rigidity = self.material.young * self.section.second_moment
        line_density = self.material.density * self.section.area
        return np.asarray((harmonic * np.pi / self.length) ** 2 * np.sqrt(rigidity / line_density))

    def _axial(self, harmonic: int | Array) -> Array:
        return np.asarray(harmonic * np.pi / self.length * np.sqrt(self.material.young / self.material.density))


@lru_cache(maxsize=16)
@of_ordinary_size("material, section and length")
def _modes(beam: ModalBeam) -> Modes:
    bending, axial = (np.arange(1, n + 1) for n in beam.harmonics)
    angular = np.concatenate([beam._bending(bending), beam._axial(axial)])
    # The integral of rho S sin(k pi x / L) over the length: only odd harmonics move on average.
    line = beam.total_mass * beam.amplitude
    mean_bending, mean_axial = ((1.0 - (-1.0) ** k) / (k * np.pi) for k in (bending, axial))
    translation = np.zeros((2, angular.size))
    translation[1, : bending.size] = line * mean_bending
    translation[0, bending.size :] = line * mean_axial
    return Modes(angular, damping_rates(beam.damping, angular), translation)
