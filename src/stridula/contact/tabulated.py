"""Friction as it is measured: a table of the coefficient over the slip speed, and over the pressure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, rising
from ..columns import read_rising
from ..declared import Each, Number, OneOrEach
from .between import Between
from .curves import OF_TABLE, Curve, flat_sections, in_pieces
from .friction_law import CURVE, FrictionLaw
from .linearised import Linearised


def on_grid(speeds: Array, others: Array, values: Array, name: str) -> tuple[list[float], list[float], list[Any]]:
    """Return rising speeds, rising numbers of another quantity, and a row of values over the speeds for each of these.

    Raises
    ------
    ValueError
        If a speed is not there once at each.
    """
    whole, each = np.unique(speeds), np.unique(others)
    order = np.lexsort([speeds, others])
    if not np.array_equal(speeds[order], np.tile(whole, each.size)):
        got = f"{speeds.size} lines for {whole.size} speeds and {each.size} {name}s"
        raise ArgumentError("table", f"have each speed once at each {name}", got=got)
    return whole.tolist(), each.tolist(), values[order].reshape(each.size, -1).tolist()


@dataclass(frozen=True)
class TabulatedFriction(FrictionLaw):
    """Friction given at some slip speeds, and at some pressures, such as measured on a test bench; sticking is exact.

    Monotone cubic interpolation between the speeds (Fritsch & Carlson 1980, SIAM J. Numer. Anal. 17): no overshoot, and
    a continuous slope. Below the first and above the last speed the coefficient is constant. It is the same in both
    senses of slip; the friction force opposes the slip. Between pressures the coefficient is on a straight line, below
    the first and above the last it is constant.

    Parameters
    ----------
    velocity : sequence of float
        Slip speeds at which the coefficient is given [m/s], rising, from 0 on.
    coefficient : sequence of float, or of sequences of float
        Coefficient of friction at each [1]; with pressures, a list for each of them.
    static : float or sequence of float, optional
        Coefficient up to which a contact at rest is held [1], at least the first of `coefficient`, which it is if left
        out; with pressures, one for each of them.
    pressure : sequence of float, optional
        Pressures at which it is given [Pa], rising, from 0 on. The contact must have an area, as the points of surfaces
        have; the pressure is its normal force over this area.

    Raises
    ------
    ValueError
        If speeds or pressures do not increase, an argument is out of its range, or the numbers of entries differ.
    """

    law: ClassVar[str] = "tabulated"
    linear_in: ClassVar[tuple[str, ...]] = ("coefficient", "static")
    velocity: Annotated[Sequence[float], Each(Number("m/s", least=0.0))]
    coefficient: Annotated[Sequence[float] | Sequence[Sequence[float]], Each(OneOrEach(Number(least=0.0)))]
    static: Annotated[float | Sequence[float], OneOrEach(Number(least=0.0))] | None = None
    pressure: Annotated[Sequence[float], Each(Number("Pa", least=0.0))] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check_rising("velocity", self.velocity)
        if self.pressure is not None:
            self._check_rising("pressure", self.pressure)
            self._check_count("coefficient", self.coefficient, "pressure", self.pressure)
            if self.static is not None:
                self._check_count("static", self.static, "pressure", self.pressure)
        for number, values in enumerate(self._rows):
            where = "coefficient" if self.pressure is None else f"coefficient[{number}]"
            self._check_count(where, values, "velocity", self.velocity)
            if self.static is not None and self._statics[number] < values[0]:
                where = "static" if self.pressure is None else f"static[{number}]"
                words = f"be at least {values[0]!r}, the coefficient in slow sliding"
                raise ArgumentError(where, words, self._statics[number])

    @classmethod
    def read(
        cls,
        path: str | Path,
        columns: Sequence[str | int] = (0, 1),
        *,
        static: float | None = None,
        speed_unit: float = 1.0,
        pressure_unit: float = 1.0,
    ) -> TabulatedFriction:
        """Read a table from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each slip speed, or each slip speed at each pressure; values are separated by commas,
            semicolons, tabs or blanks. A first line may name the columns; lines that begin with ``#`` are skipped.
            Lines need not be in order.
        columns : sequence, optional
            Columns of slip speed and coefficient, and of the pressure if there is one, by name or by number from 0.
        static : float, optional
            Coefficient up to which a contact at rest is held [1], of tables without pressures.
        speed_unit, pressure_unit : float, optional
            Units in the file, such as 1e-3 for mm/s, and 1e5 for bar [m/s, Pa].

        Raises
        ------
        ValueError
            If the file has no such table, or not the same speeds at each pressure; the message names file and line.
        """
        if len(columns) not in (2, 3):
            raise ArgumentError("columns", "be two, of speed and coefficient, or three with the pressure", columns)
        speeds, values, *others = read_rising(path, columns)
        try:
            if not others:
                return cls((speeds * speed_unit).tolist(), values.tolist(), static)
            whole, pressures, rows = on_grid(speeds * speed_unit, others[0] * pressure_unit, values, "pressure")
            return cls(whole, rows, static, pressures)
        except ArgumentError as error:
            raise error.inside(str(path)) from None

    @staticmethod
    def _check_rising(name: str, values: Any) -> None:
        if len(values) < 2:
            raise ArgumentError(name, "have two values or more", values, got=str(len(values)))
        rising(name, values)

    @staticmethod
    def _check_count(name: str, values: Any, other: str, of_other: Any) -> None:
        count = len(values) if isinstance(values, tuple) else 1
        if count != len(of_other) or (other == "velocity" and any(isinstance(one, tuple) for one in values)):
            words = f"have as many values as {other}, {len(of_other)}"
            raise ArgumentError(name, words, values, got=str(count) if count != len(of_other) else "lists of values")

    @property
    def _rows(self) -> Any:
        """Coefficients at each pressure."""
        return (self.coefficient,) if self.pressure is None else self.coefficient

    @property
    def _statics(self) -> Any:
        """Coefficient at rest at each pressure."""
        if self.static is None:
            return tuple(values[0] for values in self._rows)
        return (self.static,) if self.pressure is None else self.static

    @property
    def kernel_code(self) -> str:
        """Name of its constant in the layout of the march."""
        return CURVE

    @property
    def depends_on_pressure(self) -> bool:
        """Whether friction depends on the pressure."""
        return self.pressure is not None

    def on(self, area: float) -> TabulatedFriction:
        """Return the law of a contact that represents an area [m²], with normal forces in place of pressures."""
        return self if self.pressure is None else replace(self, pressure=[area * one for one in self.pressure])

    @cached_property
    def sections(self) -> tuple[TabulatedFriction, ...]:
        """The law at each of its pressures."""
        if self.pressure is None:
            return (self,)
        given = zip(self._rows, self._statics, strict=True)
        return tuple(replace(self, coefficient=row, static=static, pressure=None) for row, static in given)

    def under(self, normal_force: float) -> FrictionLaw:
        """Return the law over the speed alone, of a contact of 1 m² about a normal force [N]: at a pressure [Pa]."""
        if self.pressure is None:
            return self
        below = int(np.searchsorted(self.pressure, normal_force, side="right")) - 1
        if below < 0 or below == len(self.pressure) - 1:
            return self.sections[max(below, 0)]
        first, last = self.pressure[below : below + 2]
        ends = self.sections[below], self.sections[below + 1]
        return Between(*ends, (normal_force - first) / (last - first))

    def slope_over_normal(self, velocity: float, normal_force: float) -> float:
        """Return the change of the coefficient with the normal force on 1 m² [1/N], in sliding at a velocity [m/s]."""
        if self.pressure is None or not self.pressure[0] <= normal_force < self.pressure[-1]:
            return 0.0
        below = int(np.searchsorted(self.pressure, normal_force, side="right")) - 1
        first, last = (float(one.coefficient_at(velocity)) for one in self.sections[below : below + 2])
        return (last - first) / (self.pressure[below + 1] - self.pressure[below])

    @cached_property
    def curve(self) -> Curve:
        """The coefficient in sliding as a curve in pieces."""
        first = [0.0] if self.velocity[0] > 0.0 else []
        return in_pieces(self._sliding, np.array([*first, *self.velocity]), OF_TABLE, 0.0)

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        if self.pressure is None:
            return super().parameters()
        return {**self.sections[0].parameters(), "static": self.holding, "sections": len(self.pressure)}

    @property
    def pieces(self) -> Array:
        """Numbers of its curves behind its parameters in the march."""
        if self.pressure is None:
            return self.curve.flat
        return flat_sections([one.curve for one in self.sections], self.pressure, self._statics)

    @cached_property
    def _interpolant(self) -> Any:
        # Imported here, as it takes longer than many a run.
        from scipy.interpolate import PchipInterpolator

        if self.pressure is not None:
            raise ArgumentError(
                "pressure", "be chosen before friction is evaluated", got="none; use law.under(pressure)"
            )
        return PchipInterpolator(self.velocity, self.coefficient)

    def _sliding(self, speed: Array) -> Array:
        return np.asarray(self._interpolant(np.clip(speed, self.velocity[0], self.velocity[-1])))

    @property
    def fastest(self) -> float:
        """Slip speed up to which its friction was measured [m/s]; a run that goes beyond has a note."""
        return float(self.velocity[-1])

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return float(self.velocity[-1])

    @property
    def holding(self) -> float:
        """Ratio up to which a contact is held at rest [1], the largest over the pressures."""
        return float(max(self._statics))

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]; at 0, the largest at rest."""
        speed = np.abs(np.asarray(velocity, dtype=float))
        return np.asarray(np.where(speed == 0.0, self._statics[0], self._sliding(speed)))

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0."""
        if not self.velocity[0] < abs(velocity) < self.velocity[-1]:
            return Linearised()
        return Linearised(float(self._interpolant(abs(velocity), 1)))

    def __str__(self) -> str:
        values = [one for row in self._rows for one in row]
        over = "" if self.pressure is None else f", {len(self.pressure)} pressures up to {self.pressure[-1]:.3g} Pa"
        speeds = f"{len(self.velocity)} speeds up to {self.reach:.3g} m/s"
        return f"tabulated, {min(values):.4g} to {max(values):.4g} at {speeds}{over}"
