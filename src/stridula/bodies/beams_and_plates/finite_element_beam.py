"""A straight finite-element beam that bends and stretches in the plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Annotated, ClassVar

import numpy as np
import scipy.linalg

from ...arrays import Array, in_space
from ...checks import ArgumentError, instance, within
from ...declared import Angle, Choice, Count, Frequency, Length, Name, Own, check_declared
from ...doubtful import doubts_of_size, warn_of
from ...ordinary import check_overflow, of_ordinary_size
from ..body_surfaces import HIGHEST, PointSurface, largest_part
from ..cards import HasCard
from ..damping import DampingLaw, checked_damping, damping_rates
from ..drawn_lines import places_between
from ..matrix_input import numbers
from ..modes import Modes, hashed_once
from ..points import BodyPoint
from ..sections import SHORTEST_WAVE, Circle, Material, Rectangle, Section
from .finite_elements import (
    FIXED_BY_SUPPORT,
    X,
    assemble,
    displacement_row,
    element_mass,
    element_stiffness,
    slope_row,
)
from .prism_surfaces import beam_surface, has_outline

LARGEST_ELEMENTS = 500
SUPPORTS = tuple(FIXED_BY_SUPPORT)
# Beams whose modes are cached, as sweeps use the same ones repeatedly; fewer of those with many elements, for memory.
FEW_ELEMENTS, MANY_BEAMS, FEW_BEAMS = 60, 128, 16
# Points of a beam whose traces are cached.
MANY_POINTS = 16


@hashed_once
@dataclass(frozen=True)
class FiniteElementBeam(HasCard):
    """A straight beam of Hermite cubic and bar elements, inclined to the normal of the track.

    Its axis runs from its tip E to its root A along ``e1 = (sin a, cos a)``; its transverse direction is
    ``t1 = (cos a, -sin a)``, with world x along the track and y along its normal towards the slider. Euler-Bernoulli
    bending, no shear, no rotatory inertia.

    Parameters
    ----------
    material : Material
        Material.
    section : Rectangle, Circle or Section
        Its cross-section.
    length : float
        Length [m], from tip to root.
    angle : float, optional
        Angle from the track's normal [rad], a of its axis, above zero where the root is ahead of the tip in x; strictly
        between -pi/2 and pi/2.
    elements : int, optional
        Number of finite elements; they are equal, at most 500.
    damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
        Damping ratio of every mode [1], one for each, or a law of frequency; from 0 to 1 (1 excluded), one for each
        mode kept in the order of increasing frequency, without effect on rigid modes.
    root_support : {"free", "guided", "pinned", "clamped"}, optional
        Support of the root: free, guided (no rotation), pinned or clamped; where it is guided, both translations are
        free.
    tip_support : {"free", "guided", "pinned", "clamped"}, optional
        Support of the tip: free, guided, pinned or clamped.
    mass : {"consistent", "lumped"}, optional
        Mass matrix of the elements: consistent or lumped.
    cutoff : float, optional
        Keep the modes up to this frequency, all if left out [Hz]; rigid ones always. With all modes the body is exactly
        the finite-element model.
    name : str, optional
        Name in records; distinguishes equal bodies.

    Raises
    ------
    ValueError
        If an argument is out of its range, or if no mode is left.
    """

    kind: ClassVar[str] = "finite-element beam"
    point_names: ClassVar[tuple[str, ...]] = ("tip", "root")
    is_spatial: ClassVar[bool] = False
    has_positions: ClassVar[bool] = True
    has_translation: ClassVar[bool] = True
    has_rotations: ClassVar[bool] = True
    material: Material
    section: Rectangle | Circle | Section
    length: Length
    angle: Angle = 0.0
    elements: Count = 20
    damping: Annotated[float | Sequence[float] | DampingLaw, Own("damping")] = 0.0
    root_support: Annotated[str, Choice(SUPPORTS)] = "guided"
    tip_support: Annotated[str, Choice(SUPPORTS)] = "free"
    mass: Annotated[str, Choice(("consistent", "lumped"))] = "consistent"
    cutoff: Frequency | None = None
    name: Name = ""

    def __post_init__(self) -> None:
        instance("material", self.material, Material)
        instance("section", self.section, (Rectangle, Circle, Section))
        check_declared(self)
        if abs(self.angle) >= np.pi / 2:
            raise ArgumentError("angle", "be strictly between -pi/2 and pi/2 rad (90 deg)", self.angle)
        if self.elements > LARGEST_ELEMENTS:
            raise ArgumentError("elements", f"be at most {LARGEST_ELEMENTS}", self.elements)
        object.__setattr__(self, "damping", checked_damping(self.damping))
        warn_of(doubts_of_size(self.largest_side))

    @property
    def thick_from(self) -> float:
        """Frequency [Hz] from which it has waves of bending shorter than six depths of its section, or infinity."""
        shortest, section = SHORTEST_WAVE * self.section.depth, self.section
        if 2.0 * self.length / self.elements >= shortest:
            return np.inf
        speed = np.sqrt(self.material.young * section.second_moment / (self.material.density * section.area))
        found = float(2.0 * np.pi / shortest**2 * speed)
        return found if self.cutoff is None or self.cutoff > found else np.inf

    @property
    def largest_side(self) -> float:
        """Its length [m]."""
        return self.length

    @property
    def dimensions(self) -> str:
        """Size in words."""
        return f"{self.length:.4g} m"

    @property
    def ends(self) -> tuple[float, float]:
        """Distances of its two ends from the tip [m]."""
        return 0.0, self.length

    @property
    def drawn_places(self) -> Array:
        """Distances from the tip at which it is drawn [m]: its nodes and the middles between them."""
        return places_between(self.ends, 2 * self.elements)

    @property
    def has_modes_at_hand(self) -> bool:
        """Whether its modes are already computed, or quick to compute."""
        return self.elements <= FEW_ELEMENTS

    @property
    def posture(self) -> str:
        """Orientation in words."""
        return f"leaning {np.degrees(self.angle):.4g} deg"

    @property
    def tip(self) -> BodyPoint:
        """The tip E, the end that touches the track."""
        return BodyPoint(self, 0.0)

    @property
    def root(self) -> BodyPoint:
        """The root A, the driven end."""
        return BodyPoint(self, self.length)

    def at(self, position: float) -> BodyPoint:
        """Return the point at `position` [m] from the tip along the axis."""
        return BodyPoint(self, position)

    def check_position(self, position: float) -> None:
        """Raise ValueError if `position` [m] is not on the beam."""
        within("position", position, 0.0, self.length)

    def offset(self, position: float) -> Array:
        """Return the place at rest of the point at `position` [m] relative to the tip [m], shape (3,)."""
        return position * in_space(self.axes[0])

    @property
    def axes(self) -> Array:
        """World components of the axial direction e1 (tip to root) and the transverse t1, shape (2, 2)."""
        sine, cosine = np.sin(self.angle), np.cos(self.angle)
        return np.array([[sine, cosine], [cosine, -sine]])

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""
        return self.material.density * self.section.area * self.length

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes; with `held_x` the root's x is prescribed, as under an imposed velocity."""
        return _reduced(self, held_x).modes

    def trace(self, position: float, held_x: bool = False) -> Array:
        """Return the rows that give the world displacement (x, y) at `position` from the modes, shape (2, modes)."""
        self.check_position(position)
        known = _reduced(self, held_x)
        found = known.traces.get(position)
        if found is None:
            found = displacement_row(position, self.length, self.angle, self.elements) @ known.shapes
            if len(known.traces) < MANY_POINTS:
                known.traces[position] = found
        return found.copy()

    def rotation(self, position: float, held_x: bool = False) -> Array:
        """Return the rows that give the rotation of the section at `position` about x, y and z, shape (3, modes)."""
        self.check_position(position)
        slope = slope_row(position, self.length, self.angle, self.elements) @ _reduced(self, held_x).shapes
        return np.outer(np.cross(in_space(self.axes[0]), in_space(self.axes[1])), slope)

    @property
    def has_surface(self) -> bool:
        """Whether its section has an outline, a rectangle or a circle, so that it has a surface."""
        return has_outline(self.section)

    def surface(self, frequency: float = HIGHEST, held_x: bool = False) -> PointSurface:
        """Return the outer surface as points, fine enough for sound up to a frequency [Hz], and how modes move it.

        Its tip is at the origin of the world. With `held_x` the modes are those with the root held along x.

        Raises
        ------
        ValueError
            If its section is known by its two properties only.
        """
        return _surface(self, largest_part(frequency), held_x)

    def node_traces(self, held_x: bool = False) -> Array:
        """Return the rows that give x, y and slope of every node, tip first, from the modes, shape (3 nodes, modes)."""
        return _reduced(self, held_x).shapes

    def modal_coordinates(self, nodal: Array, held_x: bool = False) -> Array:
        """Return ``Phi^T M x`` of the displacements or velocities x of the nodes, shape (modes,)."""
        values, size = numbers("nodal", nodal), 3 * (self.elements + 1)
        if values.shape[:1] != (size,):
            raise ArgumentError("nodal", f"have the shape ({size},)", nodal, got=values.shape)
        reduced = _reduced(self, held_x)
        return np.asarray(reduced.shapes.T @ (reduced.mass @ values))

    def root_reaction(self, held_x: bool = False) -> RootReaction:
        """Return the force of the root's support as a function of the motion, from the balance of the whole beam."""
        return _reduced(self, held_x).reaction

    def _reaction(self, reduced: _Reduced) -> RootReaction:
        held = np.isin(np.arange(3) + 3 * self.elements, reduced.fixed).astype(float)
        nodes = np.linspace(0.0, self.length, self.elements + 1)
        motions = np.zeros((3, 3 * (self.elements + 1)))
        motions[0, 0::3] = motions[1, 1::3] = motions[2, 2::3] = 1.0
        motions[2, 0::3], motions[2, 1::3] = np.outer(self.axes[1], nodes - self.length)
        weight = held[:, None] * (motions @ reduced.mass)
        return RootReaction(held, weight @ reduced.shapes, weight @ motions[:2].T)

    def root_lever(self, position: float) -> Array:
        """Return the force along x and y and the moment about the root of a unit world force at `position`, (3, 2)."""
        self.check_position(position)
        return np.vstack([np.eye(2), (position - self.length) * self.axes[1]])


@dataclass(frozen=True)
class RootReaction:
    """Force of the root's support along world x and y [N] and its moment [N m], from the balance of the whole beam.

    Reaction = mass times acceleration - drives - contact force, each with its lever about the root. It does not need
    the stiffness of modes beyond a cutoff; damping is internal and does not contribute. The moment is positive when it
    increases the slope of the transverse displacement along the axis.

    Attributes
    ----------
    held : ndarray, shape (3,)
        1 where the support holds the root, 0 where it is free and the reaction is zero.
    mass : ndarray, shape (3, modes)
        Rows on the modal accelerations.
    inertia : ndarray, shape (3, 2)
        Shares of a uniform acceleration along x and y.
    """

    held: Array
    mass: Array
    inertia: Array


@dataclass(frozen=True)
class _Reduced:
    """Cached properties of a beam, used again at every point of a sweep."""

    beam: FiniteElementBeam
    modes: Modes
    shapes: Array
    mass: Array
    fixed: Array
    traces: dict[float, Array] = field(default_factory=dict)

    @cached_property
    def reaction(self) -> RootReaction:
        """Force of the root's support as a function of the motion."""
        return self.beam._reaction(self)


def _reduced(beam: FiniteElementBeam, held_x: bool) -> _Reduced:
    return (_small if beam.elements <= FEW_ELEMENTS else _large)(beam, held_x)


@of_ordinary_size("material, section and length")
def _reduce(beam: FiniteElementBeam, held_x: bool) -> _Reduced:
    section, material = beam.section, beam.material
    le = beam.length / beam.elements
    stiffness = assemble(
        element_stiffness(material.young * section.area, material.young * section.second_moment, le),
        beam.angle,
        beam.elements,
    )
    mass = assemble(element_mass(material.density * section.area, le, beam.mass), beam.angle, beam.elements)
    check_overflow(stiffness, mass)
    fixed = _fixed(beam, held_x)
    free = np.setdiff1d(np.arange(mass.shape[0]), fixed)
    rigid = _rigid_shapes(beam, mass, fixed)

    squared, shapes = np.zeros(0), np.zeros((mass.shape[0], 0))
    if free.size:
        squared, free_shapes = scipy.linalg.eigh(stiffness[np.ix_(free, free)], mass[np.ix_(free, free)])
        shapes = np.zeros((mass.shape[0], free.size))
        shapes[free] = free_shapes
    elastic = shapes[:, rigid.shape[1] :]
    elastic = elastic - rigid @ (rigid.T @ mass @ elastic)
    shapes = np.hstack([rigid, elastic])
    angular = np.concatenate([np.zeros(rigid.shape[1]), np.sqrt(np.maximum(squared[rigid.shape[1] :], 0.0))])

    if beam.cutoff is not None:
        kept = angular <= 2.0 * np.pi * beam.cutoff
        angular, shapes = angular[kept], shapes[:, kept]
    if angular.size == 0:
        raise ArgumentError("cutoff", "leave at least one mode", beam.cutoff, got=f"{beam.cutoff!r} Hz")
    directions = np.zeros((2, mass.shape[0]))
    directions[0, 0::3] = directions[1, 1::3] = 1.0
    modes = Modes(angular, damping_rates(beam.damping, angular, material.loss_factor), directions @ mass @ shapes)
    return _Reduced(beam, modes, shapes, mass, fixed)


_small, _large = lru_cache(maxsize=MANY_BEAMS)(_reduce), lru_cache(maxsize=FEW_BEAMS)(_reduce)


def _fixed(beam: FiniteElementBeam, held_x: bool) -> Array:
    root = 3 * beam.elements
    fixed = set(FIXED_BY_SUPPORT[beam.tip_support]) | {root + k for k in FIXED_BY_SUPPORT[beam.root_support]}
    if held_x:
        fixed.add(root + X)
    return np.array(sorted(fixed), dtype=int)


def _rigid_shapes(beam: FiniteElementBeam, mass: Array, fixed: Array) -> Array:
    """Return the mass-normalised rigid motions that the supports allow, shape (degrees of freedom, rigid modes)."""
    nodes = np.linspace(0.0, beam.length, beam.elements + 1) - beam.length / 2.0
    motions = np.zeros((mass.shape[0], 3))
    motions[0::3, 0] = motions[1::3, 1] = 1.0
    # The rotation has slope 1 / length, so that all three columns are of the order of 1 for beams of any size.
    motions[0::3, 2], motions[1::3, 2] = np.outer(beam.axes[1], nodes / beam.length)
    motions[2::3, 2] = 1.0 / beam.length
    if fixed.size:
        motions = motions @ scipy.linalg.null_space(motions[fixed])
    if motions.shape[1]:
        motions = motions @ np.linalg.inv(np.linalg.cholesky(motions.T @ mass @ motions)).T
    motions[fixed] = 0.0
    return motions


@lru_cache(maxsize=4)
def _surface(beam: FiniteElementBeam, largest: float, held_x: bool) -> PointSurface:
    return beam_surface(beam, beam.elements, largest, held_x)
