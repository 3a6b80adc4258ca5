"""Drives: forces, an imposed velocity, gravity; and the initial conditions of a system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

import numpy as np

from .arrays import Array
from .bodies import Body, BodyPoint, FiniteElementBeam, PointMass, ReducedBody, RigidBody
from .checks import STATUS_WORDS, ArgumentError, instance, positive, within_a_turn
from .declared import (
    Angle,
    Choice,
    Distance,
    Each,
    Newtons,
    Number,
    NumberOrWord,
    OneOrEach,
    Velocity,
    check_declared,
)
from .histories import HISTORIES, Constant, History

# The mode whose amplitude grows fastest.
MOST_UNSTABLE = "most unstable"


class Drive:
    """Base class of drives: a frozen dataclass with range and unit beside each number.

    Attributes
    ----------
    kind : str
        Name in scenarios.
    place : str
        Part of the system that it acts on: a ``body``, a ``point`` or the ``root`` of one, or empty for all.
    """

    kind: ClassVar[str]
    place: ClassVar[str] = ""

    def __post_init__(self) -> None:
        check_declared(self)

    @property
    def acted_on(self) -> Any:
        """Body that it acts on, None for the whole system."""
        return None

    @property
    def push(self) -> tuple[History, BodyPoint, Array] | None:
        """Force on a point: its history, the point, and its components along world x, y and z [N]."""
        return None

    @property
    def fall(self) -> Array | None:
        """Acceleration of every body along world x, y and z [m/s²]."""
        return None

    @property
    def uniform_velocity(self) -> Array | None:
        """Velocity of the body at the start, along world x, y and z [m/s]."""
        return None

    @property
    def vectors(self) -> dict[str, Sequence[float]]:
        """Displacement and velocity of every degree of freedom of the body at the start, by name."""
        return {}

    @property
    def starts_motion(self) -> bool:
        """Whether it moves bodies away from their equilibrium at the start."""
        moved = self.uniform_velocity
        return any(np.any(values) for values in [*self.vectors.values(), () if moved is None else moved])

    @property
    def velocities(self) -> tuple[float, ...]:
        """Velocities that it prescribes [m/s]."""
        return ()


@dataclass(frozen=True)
class Force(Drive):
    """A force at a point of a body: the sum of its components times its history.

    Parameters
    ----------
    point : BodyPoint
        Point at which the force acts.
    axial : float, optional
        Component along the body's axis [N], tip to root: a push towards the track is negative.
    transverse : float, optional
        Component along the body's transverse direction [N]; for a slider (cos angle, -sin angle).
    x : float, optional
        Component along world x [N].
    y : float, optional
        Component along world y [N], from the track towards the slider.
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor over time.
    z : float, optional
        Component along world z [N], on a body in space.
    """

    kind: ClassVar[str] = "force"
    place: ClassVar[str] = "point"
    point: BodyPoint
    axial: Newtons = 0.0
    transverse: Newtons = 0.0
    x: Newtons = 0.0
    y: Newtons = 0.0
    history: History = field(default_factory=Constant)
    z: Newtons = 0.0

    def __post_init__(self) -> None:
        instance("point", self.point, BodyPoint)
        super().__post_init__()
        instance("history", self.history, HISTORIES)
        _check_along_z("z", self.z, self.point.body)

    @property
    def acted_on(self) -> Any:
        """Body that it acts on."""
        return self.point.body

    @property
    def push(self) -> tuple[History, BodyPoint, Array]:
        """Its history, its point, and its components along world x, y and z [N]."""
        along, across = (np.resize(axis, 3) * np.array([1.0, 1.0, len(axis) == 3]) for axis in self.point.body.axes[:2])
        components = self.axial * along + self.transverse * across + np.array([self.x, self.y, self.z])
        return self.history, self.point, components

    def __str__(self) -> str:
        names = ("axial", "transverse", "x", "y", "z")
        parts = [f"{name} {getattr(self, name):.4g} N" for name in names if getattr(self, name)]
        return f"force {', '.join(parts) or '0 N'} at {_where(self.point)}, {self.history.kind}"


@dataclass(frozen=True)
class ImposedVelocity(Drive):
    """The root of the slider moves along x at a prescribed velocity, under a load along the track's normal.

    The whole body moves at this velocity from the start; the root stays free along y.

    Parameters
    ----------
    point : BodyPoint
        The root of the slider.
    velocity : float
        Velocity of the root along x [m/s].
    normal_load : float, optional
        Force on the root towards the track, along -y [N], constant.
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor on the velocity over time.
    """

    kind: ClassVar[str] = "imposed velocity"
    place: ClassVar[str] = "root"
    point: BodyPoint
    velocity: Velocity
    normal_load: Newtons = 0.0
    history: History = field(default_factory=Constant)

    def __post_init__(self) -> None:
        instance("point", self.point, BodyPoint)
        instance("point.body", self.point.body, FiniteElementBeam)
        if self.point != self.point.body.root:  # type: ignore[attr-defined]
            raise ArgumentError(
                "point", "be the root of the slider", self.point, got=f"position {self.point.position!r} m"
            )
        super().__post_init__()
        instance("history", self.history, HISTORIES)

    @property
    def acted_on(self) -> Any:
        """Body whose root moves."""
        return self.point.body

    @property
    def push(self) -> tuple[History, BodyPoint, Array]:
        """The load on the root, which is constant."""
        return Constant(), self.point, np.array([0.0, -self.normal_load, 0.0])

    @property
    def velocities(self) -> tuple[float, ...]:
        """The velocity along x [m/s]."""
        return (self.velocity,)

    def __str__(self) -> str:
        under = f"under {self.normal_load:.4g} N, {self.history.kind}"
        return f"imposed velocity {self.velocity:.4g} m/s along x {under}"


@dataclass(frozen=True)
class Gravity(Drive):
    """Weight of every body, along -y (from the slider towards the track) or along another direction.

    Parameters
    ----------
    acceleration : float, optional
        Acceleration of free fall [m/s²].
    direction : sequence of float, optional
        World components along x, y and z of the downward direction, of any length; -y if left out.
    """

    kind: ClassVar[str] = "gravity"
    acceleration: Annotated[float, Number("m/s2", above=0.0)] = 9.80665
    direction: Annotated[Sequence[float], Each(Number())] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.direction is not None and (len(self.direction) != 3 or not any(self.direction)):
            raise ArgumentError("direction", "be three numbers, not all zero", self.direction)

    @property
    def fall(self) -> Array:
        """Acceleration of every body along world x, y and z [m/s²]."""
        if self.direction is None:
            return np.array([0.0, -self.acceleration, 0.0])
        return np.asarray(self.acceleration / np.linalg.norm(self.direction) * np.array(self.direction))

    def __str__(self) -> str:
        along = "-y" if self.direction is None else f"({', '.join(f'{one:.3g}' for one in self.direction)})"
        return f"gravity {self.acceleration:.4g} m/s² along {along}"


@dataclass(frozen=True)
class InitialVelocity(Drive):
    """A uniform velocity of a body at the start.

    Parameters
    ----------
    body : FiniteElementBeam, ModalBeam, ModalPlate, PointMass, ReducedBody or RigidBody
        The body; a ReducedBody needs its `translation`.
    x : float, optional
        Velocity along world x [m/s].
    y : float, optional
        Velocity along world y [m/s].
    z : float, optional
        Velocity along world z [m/s], for a body in space.
    """

    kind: ClassVar[str] = "initial velocity"
    place: ClassVar[str] = "body"
    body: Body
    x: Velocity = 0.0
    y: Velocity = 0.0
    z: Velocity = 0.0

    def __post_init__(self) -> None:
        if not hasattr(self.body, "has_translation") or isinstance(self.body, type):
            raise ArgumentError("body", "be a body of stridula", self.body)
        if not self.body.has_translation:
            raise ArgumentError(
                "body", "have its translation given for a uniform velocity", self.body, got="a ReducedBody without"
            )
        super().__post_init__()
        _check_along_z("z", self.z, self.body)

    @property
    def acted_on(self) -> Any:
        """Body that moves."""
        return self.body

    @property
    def uniform_velocity(self) -> Array:
        """Velocity along world x, y and z [m/s]."""
        return np.array([self.x, self.y, self.z])

    @property
    def velocities(self) -> tuple[float, ...]:
        """Its components [m/s]."""
        return (self.x, self.y, self.z) if self.body.is_spatial else (self.x, self.y)

    def __str__(self) -> str:
        return f"initial velocity ({', '.join(f'{one:.3g}' for one in self.velocities)}) m/s"


@dataclass(frozen=True)
class InitialState(Drive):
    """Displacement and velocity of every degree of freedom of a body at the start.

    Parameters
    ----------
    body : PointMass, ReducedBody or RigidBody
        The body.
    displacement, velocity : sequence of float, optional
        One entry per degree of freedom [m, m/s]: along x and y for a PointMass; along, then about x, y and z for a
        RigidBody; zero if left out. The share of modes above the body's cutoff is left out.
    """

    kind: ClassVar[str] = "initial state"
    place: ClassVar[str] = "body"
    body: PointMass | ReducedBody | RigidBody
    displacement: Sequence[float] | None = None
    velocity: Sequence[float] | None = None

    def __post_init__(self) -> None:
        if not hasattr(self.body, "modal_coordinates") or self.body.has_positions or isinstance(self.body, type):
            words = "be a PointMass, a ReducedBody or a RigidBody"
            raise ArgumentError("body", words, self.body)
        for name in ("displacement", "velocity"):
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, self._checked(name, given))

    def _checked(self, name: str, given: Sequence[float]) -> tuple[float, ...]:
        try:
            self.body.modal_coordinates(given)
        except ArgumentError as error:
            raise error.renamed(name) from None
        return tuple(float(value) for value in np.asarray(given))

    @property
    def acted_on(self) -> Any:
        """Body that starts in this state."""
        return self.body

    @property
    def vectors(self) -> dict[str, Sequence[float]]:
        """Displacement and velocity, as far as given."""
        given = {"displacement": self.displacement, "velocity": self.velocity}
        return {name: values for name, values in given.items() if values is not None}

    def __str__(self) -> str:
        return "initial state of every degree of freedom"


@dataclass(frozen=True)
class InitialEquilibrium(Drive):
    """The whole system starts in equilibrium, alone or with a mode of vibration on top.

    The equilibrium is that of `sliding_stability` under the drives at the start: bodies are deflected and move as a
    whole as belts, tracks and `velocity` prescribe, and friction laws are in the state of steady sliding. A slider
    that a force accelerates starts at rest, deflected as during the acceleration, unless `velocity` is given. Other
    initial displacements and velocities are added.

    Parameters
    ----------
    status : str or sequence of str, optional
        Separated, sticking or sliding, one for all contacts or a list with one for each; all slide if left out.
    velocity : float or sequence of float, optional
        Slip velocity at the start where nothing prescribes it [m/s], one for all contacts or a list with one for each;
        0 for contacts where it is prescribed. Its sign is the sense of sliding.
    mode : int or "most unstable", optional
        Mode of vibration on top: its number from 0 on, by increasing frequency, or most unstable; none if left out. The
        number is that of `sliding_stability` at time 0; most unstable is the mode with the largest growth rate among
        those that vibrate, even if it is negative. With more than 600 degrees of freedom it is among the lowest 100.
    amplitude : float, optional
        Largest displacement of a contact point in that mode [m]; among the tips and the points of the tracks that they
        touch, along x or along y.
    phase : float, optional
        Phase of that displacement at the start [rad]; at 0 it is at its positive peak, at pi/2 it falls through zero;
        from -2 pi to 2 pi.

    Raises
    ------
    ValueError
        If an argument is out of its range. Runs raise it if there is no such equilibrium.
    """

    kind: ClassVar[str] = "initial equilibrium"
    status: Annotated[str | Sequence[str], OneOrEach(Choice(STATUS_WORDS))] | None = None
    velocity: Annotated[float | Sequence[float], OneOrEach(Number("m/s"))] | None = None
    mode: Annotated[int | str, NumberOrWord((MOST_UNSTABLE,))] | None = None
    amplitude: Distance = 0.0
    phase: Angle = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        within_a_turn("phase", self.phase)
        if self.mode is not None:
            positive("amplitude", self.amplitude)
        elif self.amplitude:
            raise ArgumentError("amplitude", "be 0 without a mode", self.amplitude)

    @property
    def starts_motion(self) -> bool:
        """Whether a mode of vibration is added."""
        return self.mode is not None

    @property
    def velocities(self) -> tuple[float, ...]:
        """Slip velocities that are given [m/s]."""
        return () if self.velocity is None else tuple(np.atleast_1d(self.velocity).tolist())

    def __str__(self) -> str:
        if self.mode is None:
            return "initial equilibrium"
        number = self.mode if self.mode == MOST_UNSTABLE else f"number {self.mode}"
        return f"initial equilibrium, mode {number} on top by {self.amplitude:.3g} m"


DRIVES: tuple[type[Drive], ...] = (
    Force,
    ImposedVelocity,
    Gravity,
    InitialVelocity,
    InitialState,
    InitialEquilibrium,
)


def _check_along_z(name: str, value: float, body: Any) -> None:
    if value and not body.is_spatial:
        raise ArgumentError(name, "be 0 on a body in the plane", value)


def _where(point: BodyPoint) -> str:
    match point.position:
        case (along, across):
            return f"({along:.4g}, {across:.4g}) m"
        case float(place):
            return f"{place:.4g} m"
        case place:
            return str(place)
