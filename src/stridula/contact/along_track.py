"""Friction that depends on the place along the track: a law at some places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..declared import Each, Number, Own, Switch, check_declared
from .at_values import FrictionAtValues
from .friction_law import FrictionLaw
from .heating import OverStep


@dataclass(frozen=True)
class FrictionAlongTrack(FrictionAtValues):
    """Friction given at some places along a track: patches of rust, of leaves or of oil, a worn sector of a disc.

    Between the places it lies on straight lines. The place is that of the material of the track under the tip, along
    the first tangent: on a belt, or a disc that turns, the one that has come there. It takes the value that it has
    where the contact is at the end of a step for the next. Linear theory takes friction at the place of the start.

    Parameters
    ----------
    place : sequence of float
        Places along the track at which the law is given [m], rising.
    laws : sequence of FrictionLaw
        The law at each: all of one kind, `Coulomb`, `StaticKinetic`, `Stribeck`, `ExponentialWeakening` or
        `TabulatedFriction`, that differ in their coefficients alone.
    periodic : bool, optional
        Whether it repeats, as on a disc or a closed belt; the last law is then the first of the next period. Any other
        is constant before the first place and after the last.

    Raises
    ------
    ValueError
        If places do not increase, laws are not of one such kind, or the ends of a period differ.

    Examples
    --------
    A dry belt of 2 m with an oily patch of 10 cm:

    >>> import stridula as st
    >>> dry, oily = st.Coulomb(0.5), st.Coulomb(0.1)
    >>> patch = st.FrictionAlongTrack([0.0, 0.01, 0.1, 0.11, 2.0], [dry, oily, oily, dry, dry], periodic=True)
    >>> round(float(patch.at(2.05).coefficient_at(1.0)), 3)
    0.1
    """

    law: ClassVar[str] = "along track"
    over: ClassVar[str] = "place"
    unit: ClassVar[str] = "m"
    place: Annotated[Sequence[float], Each(Number("m"))]
    laws: Annotated[Sequence[FrictionLaw], Own("laws")]
    periodic: Annotated[bool, Switch()] = False

    def __post_init__(self) -> None:
        check_declared(self)
        self.check_laws()
        if self.periodic and self.laws[-1] != self.laws[0]:
            words = f"be that of the first place a period later, {self.laws[0]}"
            raise ArgumentError(f"laws[{len(self.laws) - 1}]", words, self.laws[-1])

    @property
    def depends_on_place(self) -> bool:
        """Whether friction depends on the place along the track."""
        return True

    def at(self, value: float) -> FrictionLaw:
        """Return the law at a place along the track [m]."""
        return super().at(self.within(value))

    def within(self, place: float) -> float:
        """Return a place in the first period [m], unchanged if it does not repeat."""
        low, high = self.values[0], self.values[-1]
        return float(low + np.mod(place - low, high - low)) if self.periodic else place


@dataclass(frozen=True)
class Places:
    """The place along the track under a contact, at which its law acts, in the form of a heating.

    Attributes
    ----------
    law : FrictionAlongTrack
        The law.
    first : float
        Place at the start [m].
    """

    kind: ClassVar[str] = "place"
    layers: ClassVar[int] = 2
    by_place: ClassVar[float] = 1.0
    law: Any
    first: float

    @property
    def start(self) -> Array:
        """Place at the start, within the period and not [m]."""
        return np.array([self.law.within(self.first), self.first])

    @property
    def period(self) -> float:
        """Length after which it repeats [m], 0 if it does not."""
        return self.law.values[-1] - self.law.values[0] if self.law.periodic else 0.0

    def over(self, step: float) -> OverStep:
        """Return what follows from the last place, which it replaces."""
        return OverStep(0.0, np.diag([0.0, 1.0]), *np.zeros((3, 2)))

    @property
    def history(self) -> tuple[Sequence[float], Sequence[float]]:
        """Both ends of the places, at which the place is itself."""
        ends: Any = (self.law.values[0], self.law.values[-1])
        return ends, ends
