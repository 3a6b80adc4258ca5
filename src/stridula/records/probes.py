"""Probes: declarations of further quantities to record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Self, get_args

from ..arrays import Array
from ..bodies import BodyPoint, FiniteElementBeam, ModalBeam, is_track
from ..bodies.modes import Body
from ..checks import ArgumentError, choice, count, instance
from ..connections import CONNECTIONS, Connection, elements_of, held_motions
from ..connections.elements import DISPLACEMENTS, ROTATIONS, Motion
from ..declared import Choice, CountFrom0, Way, check_declared
from ..system import System

DIRECTION = Way(("x", "y", "z", "axial", "transverse"))
COMPONENTS = ("x", "y", "moment")
# Motions against which forces and moments of connections act.
ACTIONS = dict(zip(("x", "y", "z", "moment x", "moment y", "moment z"), DISPLACEMENTS + ROTATIONS, strict=True))


class _Probe:
    quantity: ClassVar[str]
    # Kind of its first argument: point, body, or slider for that of the system.
    on: ClassVar[str]

    @classmethod
    def from_table(cls, on: Any, **keys: Any) -> Self:
        """Return the probe on a point or body with the other keys of its table in a scenario."""
        made: Callable[..., Self] = cls
        return made(on, **keys)

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of its table in a scenario, besides quantity and body."""
        return {}

    def named_in(self, system: System) -> dict[str, Any]:
        """Return what it is on as keys of its table in a scenario."""
        on: Any = self
        return {} if self.on == "slider" else {"body": system.body_name(on.body)}


@dataclass(frozen=True)
class _Motion(_Probe):
    on: ClassVar[str] = "point"
    # Order of the time derivative of the displacement.
    derivative: ClassVar[int]
    point: BodyPoint
    direction: Annotated[str | Sequence[float], DIRECTION] = "y"

    def __post_init__(self) -> None:
        instance("point", self.point, BodyPoint)
        check_declared(self)
        if self.along[2] and not self.point.body.is_spatial:
            words = "not be z" if self.direction == "z" else "have no component along z"
            raise ArgumentError("direction", f"{words} on a body in the plane", self.direction)

    @property
    def body(self) -> Body:
        """Body of the point."""
        return self.point.body

    @property
    def along(self) -> Array:
        """World components of its direction, a unit vector, shape (3,)."""
        return DIRECTION.along(self.direction, self.body.axes)

    @property
    def place(self) -> str:
        """Place on its body and direction, as text."""
        is_word = isinstance(self.direction, str)
        way = self.direction if is_word else f"({', '.join(f'{one:.6g}' for one in self.direction)})"
        return f"{_words(self.point)} {way}"

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of its table in a scenario, besides quantity and body."""
        place = self.point.position if self.point.point_name is None else self.point.point_name
        if hasattr(self.point.body, "mesh") or getattr(self.point.body, "faces", {}):
            # Records keep the modes of such bodies and the labels of their points.
            place = self.point.label
        return {"point": place, "direction": self.direction}


class Displacement(_Motion):
    """Displacement of a point of a body along a direction [m].

    Parameters
    ----------
    point : BodyPoint
        Point of the body.
    direction : {"y", "x", "z", "axial", "transverse"} or sequence of float, optional
        World x, y or z, the body's axial or transverse direction, or world components (x, y, z), of any length.
    """

    quantity = "displacement"
    derivative = 0


class Velocity(_Motion):
    """Velocity of a point of a body along a direction [m/s], centred difference over two steps.

    Parameters
    ----------
    point, direction : BodyPoint, str or sequence of float
        As of `Displacement`.
    """

    quantity = "velocity"
    derivative = 1


class Acceleration(_Motion):
    """Acceleration of a point of a body along a direction [m/s²], second difference over two steps.

    Parameters
    ----------
    point, direction : BodyPoint, str or sequence of float
        As of `Displacement`.
    """

    quantity = "acceleration"
    derivative = 2


@dataclass(frozen=True)
class Reaction(_Probe):
    """Force that the support of a slider's root exerts on it, along world x or y [N], or its moment [N m].

    Zero in a direction in which the root is free. The moment is positive when it increases the slope of the transverse
    displacement along the axis from tip to root.

    Parameters
    ----------
    body : FiniteElementBeam
        The slider.
    component : {"x", "y", "moment"}, optional
        Component of the force, or its moment.
    """

    quantity: ClassVar[str] = "reaction"
    on: ClassVar[str] = "slider"
    body: FiniteElementBeam
    component: str = "moment"

    def __post_init__(self) -> None:
        instance("body", self.body, FiniteElementBeam)
        choice("component", self.component, COMPONENTS)

    @classmethod
    def from_table(cls, on: Any, **keys: Any) -> Self:
        """Return the probe on a slider; its table names the component as direction."""
        return cls(on, keys.get("direction", "moment"))

    @property
    def place(self) -> str:
        """Place on its body and direction, as text."""
        return f"root {self.component}"

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of its table in a scenario, besides the quantity."""
        return {"direction": self.component}


@dataclass(frozen=True)
class SupportForce(_Probe):
    """Force along y that a modal beam exerts on the support of one of its ends [N]: the bridge force of a string.

    With the tension T it is ``T w' - EI w'''`` at the left end and ``EI w''' - T w'`` at the right end, positive
    towards +y: a beam that is pressed down pushes its supports down. It is the sum over the modes kept, without
    damping, which is internal. The sum converges slowly: for a constant force at the distance a from the support, the n
    modes kept miss a share of at most ``2 / (pi (n + 1) sin(pi a / 2L))`` of the force, and landing and breakaway of a
    contact excite the highest mode. Keep modes well beyond the frequencies of interest.

    Parameters
    ----------
    body : ModalBeam
        The beam or string.
    end : {"left", "right"}, optional
        Left or right end of the beam.
    """

    quantity: ClassVar[str] = "support_force"
    on: ClassVar[str] = "body"
    body: ModalBeam
    end: Annotated[str, Choice(("left", "right"))] = "left"

    def __post_init__(self) -> None:
        instance("body", self.body, ModalBeam)
        check_declared(self)

    @property
    def place(self) -> str:
        """Place on its body, as text."""
        return f"{self.end} end"

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of its table in a scenario, besides quantity and body."""
        return {"end": self.end}


@dataclass(frozen=True)
class ConnectionForce(_Probe):
    """Force of a connection on its first end [N], or its moment [N m]: the signal of a load cell, or that of a bolt.

    The other end feels the opposite. That of a spring is ``-stiffness s``, where s is the displacement of the first end
    relative to the other: above zero it pushes the first end towards the positive direction. Velocities and
    accelerations in it are centred differences over two steps. The force of a rigid joint is that which keeps the
    motions of both bodies equal.

    Parameters
    ----------
    connection : Spring, Dashpot, Bushing, RigidJoint or another connection
        A connection of the system.
    component : {"x", "y", "z", "moment x", "moment y", "moment z"}, optional
        Component along or about an axis of the world; along the direction of the connection if left out, which bushings
        and rigid joints that act in several must not.
    """

    quantity: ClassVar[str] = "connection_force"
    on: ClassVar[str] = "connection"
    connection: Connection
    component: Annotated[str, Choice(tuple(ACTIONS))] | None = None

    def __post_init__(self) -> None:
        instance("connection", self.connection, CONNECTIONS)
        check_declared(self)
        if self.component is None:
            if len(self._motions) > 1:
                words = f"be given for a {self.connection.kind} that acts in several: one of {', '.join(ACTIONS)}"
                raise ArgumentError("component", words, self.component)
        elif not any(self.share(one) for one in self._motions):
            raise ArgumentError("component", f"be one in which the {self.connection.kind} acts", self.component)

    @property
    def _motions(self) -> list[Motion]:
        return [*(one.motion for one in elements_of(self.connection)), *held_motions(self.connection)]

    def share(self, motion: Motion) -> float:
        """Return the share in it of a force or moment against a motion [1]."""
        component = self._motions[0] if self.component is None else ACTIONS[self.component]
        return float(component.way @ motion.way) if motion.turns == component.turns else 0.0

    @property
    def body(self) -> Body:
        """Body of the first end."""
        return self.connection.first.body

    def named_in(self, system: System) -> dict[str, Any]:
        """Return the number of its connection as a key of its table in a scenario."""
        return {"connection": system.connections.index(self.connection)}

    def label(self, system: System) -> str:
        """Return its label in a record: number, kind and component."""
        (number,) = self.named_in(system).values()
        return " ".join(filter(None, (f"connections[{number}]", self.connection.kind, self.component)))

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of its table in a scenario, besides quantity and connection."""
        return {} if self.component is None else {"component": self.component}


@dataclass(frozen=True)
class _OfMode(_Probe):
    on: ClassVar[str] = "body"
    derivative: ClassVar[int]
    body: Body
    mode: CountFrom0

    def __post_init__(self) -> None:
        check_body(self.body)
        count("mode", self.mode, low=0, high=self.body.modes().count - 1)

    @property
    def place(self) -> str:
        """Mode of its body, as text."""
        return f"mode {self.mode}"

    @property
    def keys(self) -> dict[str, Any]:
        """Keys of its table in a scenario, besides quantity and body."""
        return {"mode": self.mode}


class ModalDisplacement(_OfMode):
    """Displacement of a mode of a body [kg^(1/2) m]; times the mode shape it is the part of the mode in displacements.

    Parameters
    ----------
    body : Body
        The body.
    mode : int
        Number of the mode from 0, by increasing frequency, residual shapes last.
    """

    quantity = "modal_displacement"
    derivative = 0


class ModalVelocity(_OfMode):
    """Velocity of a mode of a body [kg^(1/2) m/s], centred difference over two steps.

    Parameters
    ----------
    body, mode : Body and int
        As of `ModalDisplacement`.
    """

    quantity = "modal_velocity"
    derivative = 1


@dataclass(frozen=True)
class ModalMotion(_Probe):
    """Velocities of all modes of a body [kg^(1/2) m/s], in single precision, from which `radiate` computes sound.

    Centred differences over two steps.

    Parameters
    ----------
    body : Body
        The body.
    """

    quantity: ClassVar[str] = "modal_motion"
    on: ClassVar[str] = "body"
    body: Body

    def __post_init__(self) -> None:
        check_body(self.body)

    def of_each(self, modes: int) -> list[ModalVelocity]:
        """Return a probe for each mode of its body."""
        return [ModalVelocity(self.body, mode) for mode in range(modes)]


Probe = (
    Displacement
    | Velocity
    | Acceleration
    | Reaction
    | SupportForce
    | ConnectionForce
    | ModalDisplacement
    | ModalVelocity
    | ModalMotion
)
PROBES: tuple[type[Probe], ...] = get_args(Probe)


def check_body(body: Any) -> None:
    """Raise ValueError unless this is a body."""
    if isinstance(body, type) or not hasattr(body, "modes"):
        raise ArgumentError("body", "be a body of stridula", body)


def _words(point: BodyPoint) -> str:
    if point.point_name is not None:
        return point.point_name
    if isinstance(point.position, tuple):
        return f"({', '.join(f'{one:.6g}' for one in point.position)}) m"
    return f"{point.position:.6g} m"


def usual_probes(system: System) -> tuple[Probe, ...]:
    """Return the default probes of a run: the acceleration in the middle of its track, along its normal."""
    if not is_track(system.track):
        return ()
    return (Acceleration(system.track.centre, "transverse" if system.track.is_spatial else "y"),)


def displacements_of_tip(system: System) -> tuple[Probe, ...]:
    """Return the displacements of the tip of the first contact along all axes."""
    tip = system.contacts[0].tip
    return tuple(Displacement(tip, axis) for axis in "xyz"[: 3 if tip.body.is_spatial else 2])
