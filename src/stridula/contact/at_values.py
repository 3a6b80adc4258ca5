"""Friction given as a law at some values of something else than speed and pressure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, counted, instance, rising
from .between import Between
from .friction_law import FrictionLaw
from .linearised import Linearised

# Most laws that the text of a friction shows one by one.
MOST_SHOWN = 4


class FrictionAtValues(FrictionLaw):
    """Friction that is one of some laws, or lies between two of them.

    Attributes
    ----------
    over : str
        Name of the field with the values.
    unit : str
        Unit of the values.
    laws : sequence of FrictionLaw
        The law at each value.
    """

    over: ClassVar[str]
    unit: ClassVar[str]
    laws: Any

    @property
    def values(self) -> Sequence[float]:
        """Values at which the law is given, rising."""
        found: Sequence[float] = getattr(self, self.over)
        return found

    def check_laws(self) -> None:
        """Raise ValueError unless values rise, with a law of one kind at each."""
        if len(self.values) < 2:
            raise ArgumentError(self.over, "have two values or more", got=str(len(self.values)))
        rising(self.over, self.values)
        if not isinstance(self.laws, Sequence):
            raise ArgumentError("laws", "be a list of laws of friction", self.laws)
        object.__setattr__(self, "laws", tuple(self.laws))
        if len(self.laws) != len(self.values):
            words = f"have as many laws as {self.over}s, {len(self.values)}"
            raise ArgumentError("laws", words, got=str(len(self.laws)))
        for number, one in enumerate(self.laws):
            self._check_law(f"laws[{number}]", one)

    def _check_law(self, name: str, one: Any) -> None:
        instance(name, one, FrictionLaw)
        first: Any = self.laws[0]
        if not one.linear_in:
            kinds = "Coulomb, StaticKinetic, Stribeck, ExponentialWeakening or TabulatedFriction"
            raise ArgumentError(name, f"be a {kinds}", one, got=type(one).__name__)
        if type(one) is not type(first):
            raise ArgumentError(name, f"be of the kind of the first, {type(first).__name__}", got=type(one).__name__)
        for field in fields(one):
            own, common = getattr(one, field.name), getattr(first, field.name)
            if field.name not in one.linear_in and own != common:
                raise ArgumentError(f"{name}.{field.name}", f"be that of the first law, {common!r}", own)

    @property
    def at_values(self) -> tuple[tuple[float, FrictionLaw], ...]:
        """Values at which the law is given, and the law at each."""
        return tuple(zip(self.values, self.laws, strict=True))

    def at(self, value: float) -> FrictionLaw:
        """Return the law at a value."""
        below, given = int(np.searchsorted(self.values, value, side="right")) - 1, self.values
        if below < 0 or below == len(given) - 1 or value == given[below]:
            found: FrictionLaw = self.laws[max(below, 0)]
            return found
        first, last = given[below : below + 2]
        return Between(self.laws[below], self.laws[below + 1], (value - first) / (last - first))

    def on(self, area: float) -> FrictionLaw:
        """Return the law of a contact that represents an area [m²], with normal forces in place of pressures."""
        given: Any = self
        return replace(given, laws=[one.on(area) for one in self.laws]) if self.depends_on_pressure else self

    @property
    def depends_on_pressure(self) -> bool:
        """Whether friction depends on the pressure."""
        return self.laws[0].depends_on_pressure

    @property
    def depends_on_speed(self) -> bool:  # type: ignore[override]
        """Whether friction in sliding depends on the slip speed."""
        return any(one.depends_on_speed for one in self.laws)

    @property
    def sections(self) -> tuple[FrictionLaw, ...]:
        """The law at each of its values, and pressures."""
        return tuple(section for one in self.laws for section in one.sections)

    @property
    def holding(self) -> float:
        """Ratio up to which a contact is held at rest [1], the largest over the values."""
        return max(one.holding for one in self.laws)

    @property
    def fastest(self) -> float:
        """Slip speed up to which its friction was measured [m/s], infinite for formulas."""
        return self.laws[0].fastest

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return max(one.reach for one in self.laws)

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Raise ValueError, as the coefficient depends on more than the speed: see `at`."""
        raise ArgumentError(self.over, "be chosen before friction is evaluated", got=self._none)

    def linearised_at(self, velocity: float) -> Linearised:
        """Raise ValueError, as the law depends on more than the speed: see `at`."""
        raise ArgumentError(self.over, "be chosen before friction is linearised", got=self._none)

    @property
    def _none(self) -> str:
        return f"none; use law.at({self.over})"

    def __str__(self) -> str:
        ends = f"{self.values[0]:.4g} to {self.values[-1]:.4g} {self.unit}"
        if len(self.laws) <= MOST_SHOWN:
            laws = ", ".join(map(str, self.laws))
        else:
            held = [one.holding for one in self.laws]
            laws = f"{self.laws[0]} to {self.laws[-1]}, held by {min(held):.4g} to {max(held):.4g},"
        return f"{laws} at {counted(len(self.laws), self.over)} from {ends}"
