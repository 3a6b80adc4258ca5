"""What pushes: forces, an imposed velocity, gravity; and how a system starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .bodies import BodyPoint, FiniteElementBeam, ModalBeam, ModalPlate, PointMass, ReducedBody
from .checks import STATUS_WORDS, ArgumentError, choice, count, finite, instance, one_or_each, positive
from .histories import HISTORIES, Constant, History

# The mode whose amplitude grows fastest.
MOST_UNSTABLE = "most unstable"


@dataclass(frozen=True)
class Force:
    """A force at a point of a body, the sum of its components, times its history.

    Parameters
    ----------
    point : BodyPoint
        Where it acts.
    axial : float, optional
        Component along the body's axis [N]: for a slider from its tip to its root, so that a push towards the track is
        negative.
    transverse : float, optional
        Component along the body's transverse direction [N]: ``(cos a, -sin a)`` for a slider.
    x, y : float, optional
        Components along the world's axes [N].
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor over time.
    """

    point: BodyPoint
    axial: float = 0.0
    transverse: float = 0.0
    x: float = 0.0
    y: float = 0.0
    history: History = field(default_factory=Constant)

    def __post_init__(self) -> None:
        instance("point", self.point, BodyPoint)
        for name in ("axial", "transverse", "x", "y"):
            finite(name, getattr(self, name))
        instance("history", self.history, HISTORIES)


@dataclass(frozen=True)
class ImposedVelocity:
    """The root of the slider moves along x at a prescribed velocity, under a load along the track's normal.

    The whole body moves at this velocity from the start; the root stays free along y.

    Parameters
    ----------
    point : BodyPoint
        The root of the slider.
    velocity : float
        Velocity along x [m/s].
    normal_load : float, optional
        Force on the root towards the track, along -y [N], constant.
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor on the velocity over time.
    """

    point: BodyPoint
    velocity: float
    normal_load: float = 0.0
    history: History = field(default_factory=Constant)

    def __post_init__(self) -> None:
        instance("point", self.point, BodyPoint)
        instance("point.body", self.point.body, FiniteElementBeam)
        if self.point != self.point.body.root:  # type: ignore[attr-defined]
            raise ArgumentError(
                "point", "be the root of the slider", self.point, got=f"position {self.point.position!r} m"
            )
        finite("velocity", self.velocity)
        finite("normal_load", self.normal_load)
        instance("history", self.history, HISTORIES)


@dataclass(frozen=True)
class Gravity:
    """Weight of every body, along -y (from the slider towards the track).

    Parameters
    ----------
    acceleration : float, optional
        Acceleration of free fall [m/s²].
    """

    acceleration: float = 9.80665

    def __post_init__(self) -> None:
        positive("acceleration", self.acceleration)


@dataclass(frozen=True)
class InitialVelocity:
    """A uniform velocity of a body at the start.

    Parameters
    ----------
    body : FiniteElementBeam, ModalBeam, ModalPlate, PointMass or ReducedBody
        The body; a ReducedBody needs its `translation`.
    x, y : float, optional
        Velocity along the world's axes [m/s].
    """

    body: FiniteElementBeam | ModalBeam | ModalPlate | PointMass | ReducedBody
    x: float = 0.0
    y: float = 0.0

    def __post_init__(self) -> None:
        instance("body", self.body, (FiniteElementBeam, ModalBeam, ModalPlate, PointMass, ReducedBody))
        if isinstance(self.body, ReducedBody) and not self.body.has_translation:
            raise ArgumentError(
                "body", "have its translation given for a uniform velocity", self.body, got="a ReducedBody without"
            )
        finite("x", self.x)
        finite("y", self.y)


@dataclass(frozen=True)
class InitialState:
    """Displacement and velocity of every degree of freedom of a body at the start.

    Parameters
    ----------
    body : PointMass or ReducedBody
        The body.
    displacement, velocity : sequence of float, optional
        One entry per degree of freedom [m, m/s], along x and y of a PointMass; zero if left out. What modes above the
        body's cutoff would carry is left out.
    """

    body: PointMass | ReducedBody
    displacement: Sequence[float] | None = None
    velocity: Sequence[float] | None = None

    def __post_init__(self) -> None:
        instance("body", self.body, (PointMass, ReducedBody))
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


@dataclass(frozen=True)
class InitialEquilibrium:
    """The whole system starts in equilibrium, as it is or with a mode of its vibration on top.

    The equilibrium is the one of `sliding_stability` under the drives as they are at the start: bodies are deflected,
    move as a whole as belts, tracks and `velocity` have them move, and laws of friction have the state of steady
    sliding. A slider that a force accelerates starts at rest, deflected as it is while it accelerates, unless
    `velocity` is given. Other initial displacements and velocities are added.

    Parameters
    ----------
    status : str or sequence of str, optional
        ``separated``, ``sticking`` or ``sliding``, one for all contacts or one for each; if left out all must slide.
    velocity : float or sequence of float, optional
        Slip velocity at the start [m/s] of contacts for which nothing prescribes it, one for all of them, or one for
        each contact and 0 for the others; its sign is the sense of sliding.
    mode : int or "most unstable", optional
        Number of the mode on top, as `sliding_stability` counts at time 0; or, of the modes that vibrate, the one with
        the largest growth rate, though it be below 0. Of more than 600 degrees of freedom it is among the lowest 100.
    amplitude : float, optional
        Largest displacement of a contact point in that mode [m]: of the tips and of the points of the tracks that they
        touch, along x or along y.
    phase : float, optional
        Phase of that displacement at the start [rad]: at 0 it is at its positive peak, at pi/2 it falls through zero.

    Raises
    ------
    ValueError
        If an argument is out of its range. Where there is no such equilibrium a run says so.
    """

    status: str | Sequence[str] | None = None
    velocity: float | Sequence[float] | None = None
    mode: int | str | None = None
    amplitude: float = 0.0
    phase: float = 0.0

    def __post_init__(self) -> None:
        if self.status is not None:
            words = one_or_each("status", self.status, lambda name, word: choice(name, word, STATUS_WORDS))
            object.__setattr__(self, "status", words)
        if self.velocity is not None:
            object.__setattr__(self, "velocity", one_or_each("velocity", self.velocity, finite))
        finite("phase", self.phase)
        if self.mode is None:
            if finite("amplitude", self.amplitude):
                raise ArgumentError("amplitude", "be 0 without a mode that has it", self.amplitude)
            return
        if isinstance(self.mode, str):
            choice("mode", self.mode, (MOST_UNSTABLE,))
        else:
            object.__setattr__(self, "mode", count("mode", self.mode, low=0))
        positive("amplitude", self.amplitude)


Drive = Force | ImposedVelocity | Gravity | InitialVelocity | InitialState | InitialEquilibrium
