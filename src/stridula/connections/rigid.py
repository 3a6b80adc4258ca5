"""Joints and bushings: connections that act in several directions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from ..bodies import BodyPoint
from ..checks import ArgumentError
from ..declared import Choice, Each, Number, OneOrEach, Switch, check_declared
from ..histories import Constant, History
from .elements import DISPLACEMENTS, ROTATIONS, Element, Motion
from .ends import check_ends

AXES = ("x", "y", "z")


@dataclass(frozen=True)
class RigidJoint:
    """A joint between two points that lets them move only together, such as a bolt or a weld.

    Its force does no work; `ConnectionForce` records it. Displacements along `axes` are the same at both ends: all
    three by default, as in a ball joint. With `rotations` so are the rotations about these axes, as in a weld: only
    beams and rigid bodies with an inertia have rotations at a point. Other bodies are held against turning by joints at
    several points.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of another body; the ground if left out.
    axes : {"x", "y", "z"} or sequence of these, optional
        World axes along which the ends move together.
    rotations : bool, optional
        Whether the ends also turn together, about these axes; in the plane about z, which they must include.

    Examples
    --------
    >>> mass, tip = st.PointMass(0.1), st.PointMass(0.02, "tip")
    >>> print(st.RigidJoint(mass.centre, tip.centre))
    rigid joint along x, y, z
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "rigid joint"
    axes: Annotated[str | Sequence[str], OneOrEach(Choice(AXES))] = field(default=AXES, kw_only=True)
    rotations: Annotated[bool, Switch()] = field(default=False, kw_only=True)
    # It is drawn along this direction to the ground.
    direction: ClassVar[str] = "y"
    bend: ClassVar[None] = None
    moved_by: ClassVar[float] = 0.0
    history: ClassVar[History] = Constant()
    elements: ClassVar[tuple[Element, ...]] = ()

    def __post_init__(self) -> None:
        check_ends(self.first, self.second)
        check_declared(self)
        if not self.axes:
            raise ArgumentError("axes", "be one of x, y and z or several", self.axes)

    @property
    def held(self) -> tuple[Motion, ...]:
        """Relative motions that it prevents."""
        numbers = sorted({AXES.index(one) for one in self.axes})
        turns = [ROTATIONS[k] for k in numbers] if self.rotations else []
        return (*(DISPLACEMENTS[k] for k in numbers), *turns)

    def __str__(self) -> str:
        turning = ", with rotations" if self.rotations else ""
        return f"rigid joint along {', '.join(self.axes)}{turning}"


@dataclass(frozen=True)
class Bushing:
    """An elastic mount with a stiffness and a damping along and about each axis, such as a rubber bushing.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of the same or another body; the ground if left out.
    stiffness : sequence of float, length 3
        Stiffness along x, y and z [N/m].
    damping : sequence of float, length 3, optional
        Damping along x, y and z [N s/m].
    rotational_stiffness : sequence of float, length 3, optional
        Stiffness about x, y and z [N m/rad]. Only beams and rigid bodies with an inertia have rotations at a point.
    rotational_damping : sequence of float, length 3, optional
        Damping about x, y and z [N m s/rad].

    Examples
    --------
    >>> block = st.RigidBody(2.0, inertia=[0.01, 0.02, 0.015])
    >>> print(st.Bushing(block.centre, stiffness=[1e5, 4e5, 1e5], rotational_stiffness=[50.0, 20.0, 50.0]))
    bushing 1e+05, 4e+05, 1e+05 N/m along and 50, 20, 50 N m/rad about x, y, z
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "bushing"
    stiffness: Annotated[Sequence[float], Each(Number("N/m", least=0.0))] = field(kw_only=True)
    damping: Annotated[Sequence[float], Each(Number("N s/m", least=0.0))] = field(default=(0.0,) * 3, kw_only=True)
    rotational_stiffness: Annotated[Sequence[float], Each(Number("N m/rad", least=0.0))] = field(
        default=(0.0,) * 3, kw_only=True
    )
    rotational_damping: Annotated[Sequence[float], Each(Number("N m s/rad", least=0.0))] = field(
        default=(0.0,) * 3, kw_only=True
    )
    direction: ClassVar[str] = "y"
    bend: ClassVar[None] = None
    moved_by: ClassVar[float] = 0.0
    history: ClassVar[History] = Constant()

    def __post_init__(self) -> None:
        check_ends(self.first, self.second)
        check_declared(self)
        for name in ("stiffness", "damping", "rotational_stiffness", "rotational_damping"):
            values = getattr(self, name)
            if len(values) != 3:
                raise ArgumentError(name, "be three numbers, for x, y and z", values, got=f"{len(values)}")
        if not self.elements:
            raise ArgumentError("stiffness", "have a number above 0, or the damping", self.stiffness)

    @property
    def elements(self) -> tuple[Element, ...]:
        """Linear parts that act."""
        along = zip(DISPLACEMENTS, self.stiffness, self.damping, strict=True)
        about = zip(ROTATIONS, self.rotational_stiffness, self.rotational_damping, strict=True)
        return tuple(Element(*one) for one in (*along, *about) if one[1] or one[2])

    def __str__(self) -> str:
        along = f"{_listed(self.stiffness)} N/m along"
        about = f" and {_listed(self.rotational_stiffness)} N m/rad about" if any(self.rotational_stiffness) else ""
        return f"bushing {along}{about} x, y, z"


def _listed(numbers: Sequence[float]) -> str:
    return ", ".join(f"{one:.4g}" for one in numbers)
