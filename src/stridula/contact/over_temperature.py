"""Friction that depends on the temperature: a law at some temperatures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, counted, instance, rising
from ..columns import read_rising
from ..declared import Each, Number, Own, check_declared
from .between import Between
from .friction_law import FrictionLaw
from .linearised import Linearised
from .tabulated import TabulatedFriction, on_grid

# Words in place of a value that depends on the temperature.
NO_TEMPERATURE = "none; use law.at(temperature)"


@dataclass(frozen=True)
class FrictionOverTemperature(FrictionLaw):
    """Friction given at some temperatures.

    Between the temperatures it lies on straight lines; below the first and above the last it is that of these. A
    contact takes it at its own temperature, which follows from its `heating`: `HeatedLayers` or a `TemperatureHistory`.
    Linear theory takes it at the temperature at the start.

    Parameters
    ----------
    temperature : sequence of float
        Temperatures at which the law is given [degC], rising.
    laws : sequence of FrictionLaw
        The law at each: all of one kind, `Coulomb`, `StaticKinetic`, `Stribeck`, `ExponentialWeakening` or
        `TabulatedFriction`, that differ in their coefficients alone. With tables that have pressures the coefficient
        depends on speed, pressure and temperature.

    Raises
    ------
    ValueError
        If temperatures do not increase, or laws are not of one such kind.

    Examples
    --------
    >>> import stridula as st
    >>> law = st.FrictionOverTemperature([20.0, 300.0], [st.Coulomb(0.5), st.Coulomb(0.3)])
    >>> round(float(law.at(160.0).coefficient_at(1.0)), 3)
    0.4
    """

    law: ClassVar[str] = "over temperature"
    temperature: Annotated[Sequence[float], Each(Number("degC"))]
    laws: Annotated[Sequence[FrictionLaw], Own("laws")]

    def __post_init__(self) -> None:
        check_declared(self)
        if len(self.temperature) < 2:
            raise ArgumentError("temperature", "have two values or more", got=str(len(self.temperature)))
        rising("temperature", self.temperature)
        if not isinstance(self.laws, Sequence):
            raise ArgumentError("laws", "be a list of laws of friction", self.laws)
        object.__setattr__(self, "laws", tuple(self.laws))
        if len(self.laws) != len(self.temperature):
            words = f"have as many laws as temperatures, {len(self.temperature)}"
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

    @classmethod
    def read(
        cls,
        path: str | Path,
        columns: Sequence[str | int] = (0, 1, 2),
        *,
        speed_unit: float = 1.0,
    ) -> FrictionOverTemperature:
        """Read tables over the slip speed at some temperatures from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each slip speed at each temperature, as for `TabulatedFriction.read`.
        columns : sequence, optional
            Columns of slip speed [m/s], coefficient [1] and temperature [degC], by name or by number from 0.
        speed_unit : float, optional
            Unit of speeds in the file, such as 1e-3 for mm/s [m/s].

        Raises
        ------
        ValueError
            If the file has no such table, or not the same speeds at each temperature; the message names the file.
        """
        if len(columns) != 3:
            raise ArgumentError("columns", "be three, of speed, coefficient and temperature", columns)
        speeds, values, temperatures = read_rising(path, columns)
        try:
            speed, temperature, rows = on_grid(speeds * speed_unit, temperatures, values, "temperature")
            return cls(temperature, [TabulatedFriction(speed, row) for row in rows])
        except ArgumentError as error:
            raise error.inside(str(path)) from None

    @property
    def depends_on_temperature(self) -> bool:
        """Whether friction depends on the temperature."""
        return True

    @property
    def at_temperatures(self) -> tuple[tuple[float, FrictionLaw], ...]:
        """Temperatures at which the law is given [degC], and the law at each."""
        return tuple(zip(self.temperature, self.laws, strict=True))

    def at(self, temperature: float) -> FrictionLaw:
        """Return the law at a temperature [degC]."""
        below = int(np.searchsorted(self.temperature, temperature, side="right")) - 1
        if below < 0 or below == len(self.temperature) - 1 or temperature == self.temperature[below]:
            return self.laws[max(below, 0)]
        first, last = self.temperature[below : below + 2]
        return Between(self.laws[below], self.laws[below + 1], (temperature - first) / (last - first))

    def on(self, area: float) -> FrictionOverTemperature:
        """Return the law of a contact that represents an area [m²], with normal forces in place of pressures."""
        return replace(self, laws=[one.on(area) for one in self.laws]) if self.depends_on_pressure else self

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
        """The law at each of its temperatures, and pressures."""
        return tuple(section for one in self.laws for section in one.sections)

    @property
    def holding(self) -> float:
        """Ratio up to which a contact is held at rest [1], the largest over the temperatures."""
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
        """Raise ValueError, as the coefficient depends on the temperature: see `at`."""
        raise ArgumentError("temperature", "be chosen before friction is evaluated", got=NO_TEMPERATURE)

    def linearised_at(self, velocity: float) -> Linearised:
        """Raise ValueError, as the law depends on the temperature: see `at`."""
        raise ArgumentError("temperature", "be chosen before friction is linearised", got=NO_TEMPERATURE)

    def __str__(self) -> str:
        ends = f"{self.temperature[0]:.4g} to {self.temperature[-1]:.4g} degC"
        return f"{self.laws[0]} to {self.laws[-1]} at {counted(len(self.laws), 'temperature')} from {ends}"
