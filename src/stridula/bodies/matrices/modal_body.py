"""A body given by its modes: from another program, a measurement, or a record."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, choice, count, counted, instance, listed
from ...histories import Constant, History
from ..body_surfaces import HIGHEST, BodySurface, PointSurface, RingSurface, check_surface
from ..drawn_surfaces import Drawn, DrawnSurface, drawn_of, drawn_table
from ..matrix_input import check_finite, numbers, rows_of
from ..modes import Body, Modes
from ..named_points import NamedPoints
from ..planes import checked_plane
from ..points import CircularPath
from ..sections import Material
from ..turning import Turning
from .half_space import half_space_shapes, surface_frame


@dataclass(frozen=True, eq=False, repr=False)
class ModalBody(NamedPoints):
    """A linear body given by mass-normalised modes and their displacements at its points.

    Parameters
    ----------
    angular_frequency : array_like, shape (modes,)
        Undamped angular frequencies [rad/s], zero for rigid modes; may be empty where there are residual shapes.
    points : mapping
        Displacement of each point along world (x, y), or in space (x, y, z), in each mode, by its name [kg^(-1/2)]:
        shape (2, modes) or (3, modes), with residual shapes, if any, in further columns.
    damping_rate : float or array_like, shape (modes,), optional
        Twice the damping ratio times the angular frequency [1/s].
    translation : array_like, optional
        ``Phi^T M 1``: the drive of each mode by a uniform acceleration along each direction [kg^(1/2)], of the shape of
        a point; gravity and uniform initial velocities need it.
    residual : int, optional
        Number of residual shapes, of unit stiffness and without mass; they are the last columns.
    name : str, optional
        Name in records; distinguishes equal bodies.
    turning : Turning, optional
        Rotation of the modes with a body that turns, seen from a frame at rest.
    velocities : mapping, optional
        World components (x, y, z) of the velocity of the material at a point [m/s], by the point's name, for bodies
        that turn.
    outer_surface : PointSurface or RingSurface, optional
        Outer surface with its mode shapes, as from `surface` of another body; sound needs it.
    circles : mapping, optional
        Circles about the axis along which other bodies may slide, by the name of a point on each: radius [m], abscissa
        of the point [m], and world components (x, y, z) of the direction there; for bodies with `turning`, whose
        velocity may be 0.
    drawn : DrawnSurface or DrawnRings, optional
        Surface for pictures and films, the `drawn` of another body.
    places : mapping, optional
        World places (x, y, z) of points at rest [m], by name, for pictures and films.

    Raises
    ------
    ValueError
        If an argument is out of its range or does not fit the others.
    """

    kind: ClassVar[str] = "modal body"
    angular_frequency: Any
    points: Mapping[str, Any]
    damping_rate: Any = 0.0
    translation: Any = None
    residual: int = 0
    name: str = ""
    turning: Turning | None = None
    velocities: Mapping[str, Any] | None = None
    outer_surface: PointSurface | RingSurface | None = None
    circles: Mapping[str, Any] | None = None
    drawn: Drawn | None = None
    places: Mapping[str, Any] | None = None

    def __post_init__(self) -> None:
        instance("name", self.name, str)
        self._set("residual", count("residual", self.residual, low=0))
        angular = _of_modes("angular_frequency", self.angular_frequency, 0 if self.residual else 1)
        self._set("angular_frequency", angular)
        rates = numbers("damping_rate", self.damping_rate)
        rates = np.full(angular.size, float(rates)) if rates.ndim == 0 else _of_modes("damping_rate", rates, 0)
        if rates.size != angular.size:
            raise ArgumentError("damping_rate", f"have one number for each mode, {angular.size}", rates, got=rates.size)
        self._set("damping_rate", rates)
        instance("points", self.points, Mapping)
        if not self.points:
            raise ArgumentError("points", "have at least one point", self.points, got="none")
        size, directions, points = angular.size + self.residual, None, {}
        for name, rows in self.points.items():
            if not isinstance(name, str) or not name:
                raise ArgumentError("points", "have names that are text", name)
            points[name] = rows_of(f"points[{name!r}]", rows, size, directions)
            points[name].flags.writeable = False
            directions = len(points[name])
        self._set("points", MappingProxyType(points))
        if self.translation is not None:
            self._set("translation", rows_of("translation", self.translation, size, directions))
        self._check_turning(size)
        if self.outer_surface is not None:
            check_surface("outer_surface", self.outer_surface, angular.size)
        if self.drawn is not None:
            drawn_of(drawn_table(self.drawn), size)
        self._set("places", _places(self.places, self.point_names))

    def __repr__(self) -> str:
        residual = f" and {counted(self.residual, 'residual shape')}" if self.residual else ""
        name = f", name={self.name!r}" if self.name else ""
        modes = counted(len(self.angular_frequency), "mode")
        return f"ModalBody({modes}{residual}, points {listed(self.points)}{name})"

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        scaling: Any = None,
        *,
        points: Mapping[str, Any] | None = None,
        name: str = "",
        geometry: str | os.PathLike[str] | None = None,
        quantity: str | None = None,
        directions: str | None = None,
        scale: float | None = None,
        damping: Any = None,
    ) -> ModalBody:
        """Read the modes of a modal test from a universal file, or those computed by CalculiX, Nastran or Ansys.

        Short for ``MeasuredModes.read(path, scaling, ...).body(points, name)``, which has the details.

        Parameters
        ----------
        path : str or Path
            The file, with mode shapes in dataset 55 or 2414, or ``.frd``, ``.op2`` or ``.rst``.
        scaling : {"unit modal mass", "unit modal A"}, float or array_like, optional
            Scale of the shapes, or modal masses [kg], in place of those of the file.
        points : mapping, optional
            Numbers of nodes as text, or places of nodes [m], by the names of the points: ``{"tip": "7"}``,
            ``{"tip": (0.1, 0.0, 0.02)}``; all nodes by their numbers if left out.
        name : str, optional
            Name in records.
        geometry : str or Path, optional
            A universal file with the nodes, or the deck of a ``.op2``, if they are not in the same file.
        quantity : {"displacement"}, optional
            Confirms that shapes that the file calls velocities or accelerations have the scale of displacements.
        directions : {"global", "local"}, optional
            Directions of shapes at nodes with a displacement coordinate system of their own; needed there.
        scale : float, optional
            Length of the unit of the file [m] where it states none, 1e-3 for mm with N and s; without it such a file is
            taken as SI, with a warning.
        damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
            Damping ratios [1] in place of those of the file; computed modes have none without it.

        Raises
        ------
        ValueError
            If a line or a record cannot be read, the scale is not known, or a point is not measured.
        OSError
            If the file cannot be read.
        """
        from .measured_modes import MeasuredModes

        words: dict[str, Any] = {"geometry": geometry, "quantity": quantity, "directions": directions}
        return MeasuredModes.read(path, scaling, scale=scale, damping=damping, **words).body(points, name)

    @classmethod
    def placed(
        cls,
        body: Body,
        points: Mapping[str, Any],
        x: Sequence[float] = (1.0, 0.0, 0.0),
        y: Sequence[float] = (0.0, 1.0, 0.0),
        name: str = "",
        origin: Sequence[float] | None = None,
    ) -> ModalBody:
        """Return a planar body as a body in space, in any plane.

        Parameters
        ----------
        body : FiniteElementBeam, ModalBeam, PointMass or ReducedBody
            A body in the plane, without a damping matrix of its own.
        points : mapping
            Positions on it by the names of the new points, such as ``{"tip": "tip"}`` or ``{"middle": 0.5}``.
        x, y : sequence of float, optional
            World components in space of the plane's world x and y: two unit vectors at right angles.
        name : str, optional
            Name in records; that of the body if left out.
        origin : sequence of float, optional
            World place of the tip of a `FiniteElementBeam` or of abscissa 0 of a `ModalBeam` or `ModalPlate` [m]. With
            it the body has a surface for sound, and its points have places in the world.

        Raises
        ------
        ValueError
            If the body is in space or has coupled modes, a position is not on it, or the vectors are not unit vectors
            at right angles.
        """
        if not hasattr(body, "trace") or body.is_spatial:
            raise ArgumentError("body", "be a body in the plane", body)
        axes = np.array(checked_plane("x and y", (x, y)))
        modes = body.modes()
        if modes.damping_matrix is not None:
            raise ArgumentError("body", "have no damping matrix of its own", body, got="one")
        instance("points", points, Mapping)
        named = {one: getattr(body, one).position for one in body.point_names if body.has_positions}
        rows = {one: axes.T @ body.trace(named.get(place, place)) for one, place in points.items()}
        elastic = ~modes.massless
        surface, places = None, None
        if origin is not None:
            known: Any = body
            place = numbers("origin", origin)
            if place.shape != (3,) or not hasattr(known, "offset"):
                raise ArgumentError("origin", "be three numbers, for a beam or a plate only", origin)
            check_finite("origin", place)
            frame = np.array([*axes, np.cross(*axes)])
            places = {one: place + known.offset(named.get(at, at)) @ frame for one, at in points.items()}
            surface = known.surface().placed(frame, place) if known.has_surface else None
        return cls(
            modes.angular_frequency[elastic],
            rows,
            modes.damping_rate[elastic],
            axes.T @ modes.translation if body.has_translation else None,
            int(modes.massless.sum()),
            name or body.name,
            outer_surface=surface,
            places=places,
        )

    @classmethod
    def half_space(
        cls,
        material: Material,
        places: Any,
        side: float,
        normal: Sequence[float] = (0.0, 1.0, 0.0),
        along: Sequence[float] = (1.0, 0.0, 0.0),
        coupled: bool = True,
        name: str = "",
    ) -> ModalBody:
        """Return a massless elastic half-space loaded on squares of its surface.

        Each square is a point, named by its number from 1: a force at it is a uniform traction over the square, its
        displacement is that of the middle. Far away the half-space is at rest. It needs memory for ``9 squares²``
        numbers, and twice that with contacts at all squares.

        Parameters
        ----------
        material : Material
            Material; its density has no effect.
        places : array_like, shape (squares, 3)
            World places of the middles of the squares [m]; squares must not overlap. Distances along the normal are
            ignored: gaps belong to contacts.
        side : float
            Side of each square [m].
        normal : sequence of float, optional
            World components of the outward normal, of any length.
        along : sequence of float, optional
            World components of one direction of the sides, at right angles to the normal.
        coupled : bool, optional
            Whether pressure also moves the surface tangentially, and shear along the normal, by ``1 - 2 nu``. False for
            a half-space of half Young's modulus that represents two equal ones in contact, where both cancel.
        name : str, optional
            Name in records.

        Raises
        ------
        ValueError
            If an argument is out of its range, or squares overlap.
        """
        instance("material", material, Material)
        instance("coupled", coupled, bool)
        middles = numbers("places", places)
        if middles.ndim != 2 or middles.shape[1] != 3 or not middles.size:
            raise ArgumentError("places", "be a list of places, three numbers each", places, got=middles.shape)
        check_finite("places", middles)
        shapes = half_space_shapes(material, middles, side, surface_frame(normal, along), coupled)
        points = {str(number + 1): shapes[3 * number : 3 * number + 3] for number in range(len(middles))}
        return cls(np.empty(0), points, residual=len(shapes), name=name)

    def _check_turning(self, size: int) -> None:
        if self.turning is not None:
            instance("turning", self.turning, Turning)
            if max((number for pair in self.turning.pairs for number in pair), default=0) >= size:
                raise ArgumentError("turning.pairs", f"be numbers of modes, below {size}", self.turning.pairs)
        given_velocities = {} if self.velocities is None else self.velocities
        instance("velocities", given_velocities, Mapping)
        velocities = {}
        for name, given in given_velocities.items():
            choice("velocities", name, self.point_names)
            velocity = numbers(f"velocities[{name!r}]", given)
            if velocity.shape != (3,) or self.turning is None:
                raise ArgumentError(f"velocities[{name!r}]", "be three numbers, for a body with turning only", given)
            check_finite(f"velocities[{name!r}]", velocity)
            velocity.flags.writeable = False
            velocities[name] = velocity
        self._set("velocities", MappingProxyType(velocities) if velocities else None)
        given_circles = {} if self.circles is None else self.circles
        instance("circles", given_circles, Mapping)
        circles = {}
        for name, given in given_circles.items():
            choice("circles", name, self.point_names)
            circle = numbers(f"circles[{name!r}]", given)
            if circle.shape != (5,) or self.turning is None or not (circle[0] > 0.0 and circle[2:].any()):
                words = "be a radius above 0, an abscissa and a direction, five numbers, for a body with turning only"
                raise ArgumentError(f"circles[{name!r}]", words, given)
            check_finite(f"circles[{name!r}]", circle)
            circle.flags.writeable = False
            circles[name] = circle
        self._set("circles", MappingProxyType(circles) if circles else None)

    @property
    def is_spatial(self) -> bool:
        """Whether it also moves along world z."""
        return len(next(iter(self.points.values()))) == 3

    @property
    def axes(self) -> Array:
        """World components of its axes, which are those of the world."""
        return np.eye(3 if self.is_spatial else 2)

    @property
    def has_translation(self) -> bool:
        """Whether its modal translation is known."""
        return self.translation is not None

    @property
    def has_surface(self) -> bool:
        """Whether its outer surface is known."""
        return self.outer_surface is not None

    def surface(self, frequency: float = HIGHEST) -> BodySurface:
        """Return the outer surface, as fine as it was given, with its mode shapes.

        Raises
        ------
        ValueError
            If it is not known.
        """
        if self.outer_surface is None:
            raise ArgumentError("outer_surface", "be given for sound", got="none")
        return self.outer_surface

    @property
    def is_drawn(self) -> bool:
        """Whether its surface for drawing is known."""
        return self.drawn is not None

    @property
    def drawn_at_rest(self) -> DrawnSurface | None:
        """Surface for drawing, without modes; None if it is not known."""
        return None if self.drawn is None else self.drawn.at_rest

    def place(self, position: str) -> Array | None:
        """Return the world place of a point at rest [m], shape (3,), None if it is not known."""
        self.check_position(position)
        return (self.places or {}).get(position)

    @property
    def point_names(self) -> tuple[str, ...]:
        """Names of its points."""
        return tuple(self.points)

    @property
    def total_mass(self) -> float:
        """Modal mass in a translation [kg], the largest over the directions; nan without a translation."""
        if self.translation is None:
            return float("nan")
        return float(np.max(np.sum(np.asarray(self.translation) ** 2, axis=1)))

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes, residual shapes last; `held_x` is for bodies with a driven end, must be false."""
        if held_x:
            raise ArgumentError("held_x", "be False for a ModalBody: it has no driven end", held_x)
        return self._modes

    def trace(self, position: str, held_x: bool = False) -> Array:
        """Return the rows that give the displacement of a point from the modes."""
        self.check_position(position)
        self.modes(held_x)
        return np.asarray(self.points[position])

    def turning_velocity(self, position: str) -> Array:
        """Return the velocity of the material at a point of a body that turns [m/s], shape (3,)."""
        return np.asarray((self.velocities or {}).get(position, np.zeros(3)))

    def circle(self, position: str, velocity: float = 0.0, history: History | None = None) -> CircularPath:
        """Return the circle through a point of `circles`, as a track for other bodies; see `CircularPath`."""
        self.check_position(position)
        return CircularPath(self, position, velocity, Constant() if history is None else history)

    def circle_at(self, position: str, abscissa: float | None = None) -> tuple[float, Any, Array]:
        """Return the radius of a point's circle [m], the point at an abscissa [m], its direction there, shape (3,)."""
        circles = self.circles or {}
        if position not in circles:
            raise ArgumentError("position", f"be one of the points with circles, {listed(circles) or 'none'}", position)
        radius, here, *direction = np.asarray(circles[position]).tolist()
        if abscissa is not None and abscissa != here:
            raise ArgumentError("at", f"be {here!r} m, where {position} is on its circle", abscissa)
        return radius, position, np.array(direction) / np.linalg.norm(direction)

    @property
    def waves_round(self) -> Turning:
        """Pairs of modes and the way they are carried round."""
        assert self.turning is not None
        return self.turning

    @cached_property
    def _modes(self) -> Modes:
        further = np.zeros(self.residual)
        size = self.angular_frequency.size + self.residual
        moved = np.zeros((len(self.axes), size)) if self.translation is None else np.asarray(self.translation)
        angular, rates = np.append(self.angular_frequency, further + np.inf), np.append(self.damping_rate, further)
        return Modes(angular, rates, moved, turning=self.turning)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._content == other._content

    def __hash__(self) -> int:
        return hash(self._content)

    def __reduce__(self) -> tuple[Any, ...]:
        given = self.angular_frequency, dict(self.points), self.damping_rate, self.translation, self.residual
        turned = self.turning, dict(self.velocities or {}), self.outer_surface, dict(self.circles or {})
        return ModalBody, (*given, self.name, *turned, self.drawn, dict(self.places or {}))

    @cached_property
    def _content(self) -> tuple[Any, ...]:
        points = tuple((name, rows.tobytes()) for name, rows in sorted(self.points.items()))
        moved = None if self.translation is None else np.asarray(self.translation).tobytes()
        passed = tuple((name, velocity.tobytes()) for name, velocity in sorted((self.velocities or {}).items()))
        modes = self.angular_frequency.tobytes(), self.damping_rate.tobytes()
        surface = None if self.outer_surface is None else self.outer_surface.content
        round_about = tuple((name, circle.tobytes()) for name, circle in sorted((self.circles or {}).items()))
        drawn = {} if self.drawn is None else drawn_table(self.drawn)
        seen = tuple(array.tobytes() for array in drawn.values())
        placed = tuple((name, place.tobytes()) for name, place in sorted((self.places or {}).items()))
        kept = *modes, surface, points, moved, self.residual, self.turning, passed, round_about
        return *kept, seen, placed, self.name

    def _set(self, name: str, value: Any) -> None:
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
        object.__setattr__(self, name, value)


def _places(given: Any, points: Sequence[str]) -> Mapping[str, Array] | None:
    """Return places in space of points by name, None without any."""
    instance("places", {} if given is None else given, Mapping)
    found = {}
    for name, value in (given or {}).items():
        choice("places", name, tuple(points))
        place = numbers(f"places[{name!r}]", value)
        if place.shape != (3,):
            raise ArgumentError(f"places[{name!r}]", "be three numbers", value)
        check_finite(f"places[{name!r}]", place)
        place.flags.writeable = False
        found[name] = place
    return MappingProxyType(found) if found else None


def _of_modes(name: str, value: Any, fewest: int) -> Array:
    """Return numbers of modes as an array, none below zero."""
    array = numbers(name, value)
    if array.ndim != 1 or array.size < fewest:
        raise ArgumentError(name, "be a list of numbers, one for each mode", value, got=array.shape)
    check_finite(name, array)
    if array.min(initial=0.0) < 0.0:
        raise ArgumentError(name, "be 0 or above", value, got=array.min())
    return array
