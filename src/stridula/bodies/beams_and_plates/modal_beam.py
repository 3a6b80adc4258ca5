"""A beam or a string given by its exact modes: simply supported in bending, clamped in traction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, ClassVar

import numpy as np

from ...arrays import Array, in_space
from ...checks import ArgumentError, at_least, instance, within
from ...declared import Count, CountFrom0, Frequency, Length, Name, Own, Tension, check_declared
from ...doubtful import doubts_of_size, warn_of
from ...ordinary import check_first_modes, check_mode_count, of_ordinary_size
from ..body_surfaces import HIGHEST, PointSurface, largest_part
from ..damping import DampingLaw, check_damping_count, checked_damping, damping_rates
from ..drawn_lines import places_between
from ..modes import Modes, hashed_once
from ..paths import Path, along_one_angle
from ..planes import InPlane, checked_plane
from ..points import BodyPoint
from ..sections import SHORTEST_WAVE, Circle, Material, Rectangle, Section
from .prism_surfaces import beam_surface, has_outline


@hashed_once
@dataclass(frozen=True)
class ModalBeam(InPlane):
    """A straight beam or string along world x in its exact modes ``sin(k pi x / L)``, bending first, then axial ones.

    Euler-Bernoulli, simply supported in bending: ``w_k = (k pi/L)² sqrt(EI / rho S)``; clamped in traction:
    ``w_k = (k pi/L) sqrt(E / rho)``; modal mass ``rho S L / 2``. Displacements: u along x, w along y, towards the
    slider. Under a tension T it is a stiff string: bending has ``w_k² = (k pi/L)⁴ EI / rho S + (k pi/L)² T / rho S``
    (Fletcher 1964, Journal of the Acoustical Society of America 36).

    Parameters
    ----------
    material : Material
        Material.
    section : Rectangle, Circle or Section
        Its cross-section.
    length : float
        Length [m], from x = 0 to its right end.
    bending_modes : int, optional
        Number of bending modes, unless there is a cutoff.
    axial_modes : int, optional
        Number of axial modes, unless there is a cutoff.
    damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
        Damping ratio of every mode [1], one for each in their order, or a law of frequency; from 0 to 1 (1 excluded).
    cutoff : float, optional
        Keep the modes up to this frequency [Hz]; instead of the counts above.
    name : str, optional
        Name in records; distinguishes equal bodies.
    tension : float, optional
        Tension [N]; constant, it stiffens bending and does not change the axial modes.
    plane : sequence, optional
        Unit vectors along it and towards the slider, [[x, y, z], [x, y, z]], for a beam in space; they replace world x
        and y above.

    Raises
    ------
    ValueError
        If an argument is out of its range, or if no bending mode lies below `cutoff`.
    """

    kind: ClassVar[str] = "modal beam"
    point_names: ClassVar[tuple[str, ...]] = ("centre",)
    has_positions: ClassVar[bool] = True
    has_translation: ClassVar[bool] = True
    has_rotations: ClassVar[bool] = True
    material: Material
    section: Rectangle | Circle | Section
    length: Length
    bending_modes: Count = 40
    axial_modes: CountFrom0 = 20
    damping: Annotated[float | Sequence[float] | DampingLaw, Own("damping")] = 0.0
    cutoff: Frequency | None = None
    name: Name = ""
    tension: Tension = 0.0
    plane: Annotated[Sequence[Sequence[float]], Own("plane")] | None = None

    @of_ordinary_size("material, section and length")
    def __post_init__(self) -> None:
        instance("material", self.material, Material)
        instance("section", self.section, (Rectangle, Circle, Section))
        check_declared(self)
        object.__setattr__(self, "damping", checked_damping(self.damping))
        if self.plane is not None:
            object.__setattr__(self, "plane", checked_plane("plane", self.plane))
        if self.cutoff is not None:
            check_first_modes((self._bending(1), self._axial(1)), self.cutoff)
            if self.harmonics[0] < 1:
                first = at_least(float(self._bending(1)) / (2 * np.pi))
                raise ArgumentError(
                    "cutoff",
                    f"leave at least one bending mode (first at {first} Hz)",
                    self.cutoff,
                    got=f"{self.cutoff!r} Hz",
                )
        check_mode_count(sum(self.harmonics), self.cutoff)
        check_damping_count(self.damping, sum(self.harmonics))
        warn_of(doubts_of_size(self.largest_side))

    @property
    def ends(self) -> tuple[float, float]:
        """Abscissas of its two ends [m]."""
        return 0.0, self.length

    @property
    def drawn_places(self) -> Array:
        """Abscissas at which it is drawn [m], four for each half-wave of bending."""
        return places_between(self.ends, 4 * self.harmonics[0])

    @property
    def thick_from(self) -> float:
        """Frequency [Hz] from which it has waves of bending shorter than six depths of its section, or infinity."""
        harmonic = 2.0 * self.length / (SHORTEST_WAVE * self.section.depth)
        stiff, stretched = self._of_stiffness(harmonic), self._of_tension(harmonic)
        # The frequency of a string does not depend on its depth.
        is_thick = self.harmonics[0] > harmonic and stiff > stretched
        return float(self._bending(harmonic)) / (2.0 * np.pi) if is_thick else np.inf

    @property
    def largest_side(self) -> float:
        """Its length [m]."""
        return self.length

    @property
    def dimensions(self) -> str:
        """Size in words."""
        return f"{self.length:.4g} m"

    @property
    def posture(self) -> str:
        """Orientation in words: empty, as tracks lie along world x."""
        return ""

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

    def offset(self, position: float) -> Array:
        """Return the place at rest of abscissa `position` [m] relative to its left end [m], shape (3,)."""
        return position * in_space(self.axes[0])

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
        # The root k of w_k = highest in a form without cancellation for any tension.
        stiff, stretched = self._of_stiffness(1), self._of_tension(1)
        half = 0.5 * stretched / stiff * (stretched / highest)
        return int(np.sqrt(highest / stiff / (half + np.hypot(1.0, half)))), int(highest / self._axial(1))

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes, bending ones first; `held_x` is for bodies with a driven root and must be false."""
        if held_x:
            raise ArgumentError("held_x", "be False for a ModalBeam: its ends are fixed", held_x)
        return _modes(self)

    def trace(self, position: float, held_x: bool = False) -> Array:
        """Return the rows that give the displacement at abscissa `position` along the world's axes from the modes.

        Without a plane the rows are (u, w), shape (2, modes), else the shape is (3, modes).
        """
        self.check_position(position)
        bending, axial = self.harmonics
        rows = np.zeros((2, bending + axial))
        rows[1, :bending] = self.amplitude * np.sin(np.arange(1, bending + 1) * np.pi * position / self.length)
        rows[0, bending:] = self.amplitude * np.sin(np.arange(1, axial + 1) * np.pi * position / self.length)
        return self.in_the_world(rows)

    def rotation(self, position: float, held_x: bool = False) -> Array:
        """Return the rows that give the rotation of the section at an abscissa about x, y and z, shape (3, modes)."""
        self.check_position(position)
        (along, normal), slope = map(in_space, self.axes), np.zeros(sum(self.harmonics))
        number = np.arange(1, self.harmonics[0] + 1) * np.pi / self.length
        slope[: number.size] = self.amplitude * number * np.cos(number * position)
        return np.outer(np.cross(along, normal), slope)

    def path(self) -> Path:
        """Return the path along which other bodies slide: its axis."""
        return _path(self)

    @property
    def has_surface(self) -> bool:
        """Whether its section has an outline, a rectangle or a circle, so that it has a surface."""
        return has_outline(self.section)

    def surface(self, frequency: float = HIGHEST) -> PointSurface:
        """Return the outer surface as points, fine enough for sound up to a frequency [Hz], and how modes move it.

        Its axis begins at the origin of the world.

        Raises
        ------
        ValueError
            If its section is known by its two properties only.
        """
        return _surface(self, largest_part(frequency))

    def support_force(self, end: str) -> Array:
        """Return the rows that give the force along its normal on the support of an end from the modes, shape (modes,).

        ``T w' - EI w'''`` at the left end, its opposite at the right end. For a mode this is ``w_k²`` times its inertia
        about the other end, ``rho S L / k pi`` times its amplitude.
        """
        numbers = np.arange(1, self.harmonics[0] + 1)
        inertia = self._line_density * self.length / (numbers * np.pi)
        upwards = np.where((end == "left") | (numbers % 2 == 1), 1.0, -1.0)
        rows = np.zeros(sum(self.harmonics))
        rows[: numbers.size] = upwards * self.amplitude * inertia * self._bending(numbers) ** 2
        return rows

    @property
    def _line_density(self) -> float:
        return self.material.density * self.section.area

    def _bending(self, harmonic: float | Array) -> Array:
        # Without tension this is exactly the frequency by stiffness alone.
        return np.asarray(np.hypot(self._of_stiffness(harmonic), self._of_tension(harmonic)))

    def _of_stiffness(self, harmonic: float | Array) -> Array:
        rigidity = self.material.young * self.section.second_moment
        return np.asarray((harmonic * np.pi / self.length) ** 2 * np.sqrt(rigidity / self._line_density))

    def _of_tension(self, harmonic: float | Array) -> Array:
        return np.asarray(harmonic * np.pi / self.length * np.sqrt(self.tension / self._line_density))

    def _axial(self, harmonic: int | Array) -> Array:
        return np.asarray(harmonic * np.pi / self.length * np.sqrt(self.material.young / self.material.density))


@lru_cache(maxsize=16)
def _path(beam: ModalBeam) -> Path:
    bending, axial = (along_one_angle(np.arange(1, count + 1), beam.amplitude) for count in beam.harmonics)
    return Path(beam.ends, np.array([np.pi / beam.length, 0.0]), np.zeros(2), bending, axial)


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
    # Tension stores energy without a loss.
    bent = np.append((beam._of_stiffness(bending) / beam._bending(bending)) ** 2, np.ones(axial.size))
    rates = damping_rates(beam.damping, angular, beam.material.loss_factor * bent)
    return Modes(angular, rates, beam.in_the_world(translation))


@lru_cache(maxsize=4)
def _surface(beam: ModalBeam, largest: float) -> PointSurface:
    return beam_surface(beam, max(beam.harmonics), largest)
