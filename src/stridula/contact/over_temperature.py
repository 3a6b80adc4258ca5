"""Friction that depends on the temperature: a law at some temperatures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from ..checks import ArgumentError
from ..columns import read_rising
from ..declared import Each, Number, Own, check_declared
from .at_values import FrictionAtValues
from .friction_law import FrictionLaw
from .tabulated import TabulatedFriction, on_grid


@dataclass(frozen=True)
class FrictionOverTemperature(FrictionAtValues):
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
    over: ClassVar[str] = "temperature"
    unit: ClassVar[str] = "degC"
    temperature: Annotated[Sequence[float], Each(Number("degC"))]
    laws: Annotated[Sequence[FrictionLaw], Own("laws")]

    def __post_init__(self) -> None:
        check_declared(self)
        self.check_laws()

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
