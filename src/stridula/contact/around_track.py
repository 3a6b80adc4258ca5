"""Friction that depends on the angle about the axis of a turning track: a law at some angles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

from ..checks import ArgumentError
from ..declared import Each, Number, Own, check_declared
from .along_track import FrictionAlongTrack
from .at_values import FrictionAtValues
from .axes import along_circle
from .friction_law import FrictionLaw
from .run_out import ROUND_OFF, TURN


@dataclass(frozen=True)
class FrictionAroundTrack(FrictionAtValues):
    """Friction of a face on a turning track, given at some angles about its axis: a disc that has rusted in a sector.

    Between the angles it lies on straight lines, from the last one to the first a turn later, too. It turns with the
    track, as a `RunOut` does, whose angles these are. Linear theory takes friction at the angles of the start.

    Parameters
    ----------
    angle : sequence of float
        Angles about the axis of the track, in its material at the start, at which the law is given [rad], rising over
        less than a turn.
    laws : sequence of FrictionLaw
        The law at each: all of one kind, `Coulomb`, `StaticKinetic`, `Stribeck`, `ExponentialWeakening` or
        `TabulatedFriction`, that differ in their coefficients alone.

    Raises
    ------
    ValueError
        If angles do not increase or do not lie within a turn, or laws are not of one such kind.

    Examples
    --------
    A disc with rust over a sixth of a turn:

    >>> import stridula as st
    >>> clean, rusty = st.Coulomb(0.4), st.Coulomb(0.55)
    >>> disc = st.FrictionAroundTrack([0.0, 0.05, 1.0, 1.05], [clean, rusty, rusty, clean])
    >>> round(float(disc.around(0.1).at(0.05).coefficient_at(1.0)), 3)
    0.55
    """

    law: ClassVar[str] = "around track"
    over: ClassVar[str] = "angle"
    unit: ClassVar[str] = "rad"
    angle: Annotated[Sequence[float], Each(Number("rad"))]
    laws: Annotated[Sequence[FrictionLaw], Own("laws")]

    def __post_init__(self) -> None:
        check_declared(self)
        self.check_laws()
        turned = self.angle[-1] - self.angle[0]
        if turned >= TURN - ROUND_OFF:
            words = "lie within less than one turn, 2 pi (6.28319 rad): the first law is also that a turn later"
            raise ArgumentError("angle", words, got=f"{turned:.6g} rad from the first to the last")

    @property
    def depends_on_angle(self) -> bool:
        """Whether friction depends on the angle about the axis of the track."""
        return True

    def at(self, value: float) -> FrictionLaw:
        """Return the law at an angle [rad]."""
        return self.around(1.0).at(value)

    def around(self, radius: float, sense: float = 1.0) -> FrictionAlongTrack:
        """Return the law along a circle, over the abscissa `sense` times radius times angle.

        Parameters
        ----------
        radius : float
            Radius of the circle [m].
        sense : {1.0, -1.0}, optional
            Direction of the abscissa: with the angle or against it.
        """
        angle, laws = [*self.angle, self.angle[0] + TURN], [*self.laws, self.laws[0]]
        return FrictionAlongTrack(*along_circle(angle, laws, radius, sense), periodic=True)
