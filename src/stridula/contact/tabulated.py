"""Friction as it is measured: a table of the coefficient over the slip speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..declared import Each, Number
from .columns import read_columns
from .curves import OF_TABLE, Curve, in_pieces
from .friction_law import FrictionLaw
from .linearised import Linearised


@dataclass(frozen=True)
class TabulatedFriction(FrictionLaw):
    """Friction given at some slip speeds, such as measured on a test bench; sticking is exact.

    Monotone cubic interpolation between the points (Fritsch & Carlson 1980, SIAM J. Numer. Anal. 17): no overshoot, and
    a continuous slope. Below the first and above the last speed the coefficient is constant. It is the same in both
    senses of slip; the friction force opposes the slip.

    Parameters
    ----------
    velocity : sequence of float
        Slip speeds at which the coefficient is given [m/s], rising, from 0 on.
    coefficient : sequence of float
        Coefficient of friction at each [1].
    static : float, optional
        Coefficient up to which a contact at rest is held [1], at least the first of `coefficient`, which it is if left
        out.

    Raises
    ------
    ValueError
        If speeds do not increase, an argument is out of its range, or the numbers of entries differ.
    """

    law: ClassVar[str] = "tabulated"
    velocity: Annotated[Sequence[float], Each(Number("m/s", least=0.0))]
    coefficient: Annotated[Sequence[float], Each(Number(least=0.0))]
    static: Annotated[float, Number(least=0.0)] | None = None

    @classmethod
    def read(
        cls,
        path: str | Path,
        columns: tuple[str | int, str | int] = (0, 1),
        *,
        static: float | None = None,
        speed_unit: float = 1.0,
    ) -> TabulatedFriction:
        """Read a table from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each slip speed; values are separated by commas, semicolons, tabs or blanks. A first
            line may name the columns; lines that begin with ``#`` are skipped. Lines need not be in order.
        columns : tuple, optional
            Columns of slip speed and coefficient, by name or by number from 0.
        static : float, optional
            Coefficient up to which a contact at rest is held [1].
        speed_unit : float, optional
            Unit of the speeds in the file [m/s], such as 1e-3 for mm/s.

        Raises
        ------
        ValueError
            If the file has no such table; the message names file and line.
        """
        speeds, values = read_columns(path, columns)
        order = np.argsort(speeds, kind="stable")
        try:
            return cls([speeds[k] * speed_unit for k in order], [values[k] for k in order], static)
        except ArgumentError as error:
            raise error.inside(str(path)) from None

    def _check_table(self) -> None:
        speeds, values = self.velocity, self.coefficient
        if len(speeds) < 2 or len(speeds) != len(values):
            got = f"{len(values)} and {len(speeds)}"
            raise ArgumentError("coefficient", "have as many values as velocity, two or more", values, got=got)
        for number, (before, after) in enumerate(pairwise(speeds), start=1):
            if after <= before:
                raise ArgumentError(f"velocity[{number}]", f"be above {before!r}, the one before it", after)
        if self.static is not None and self.static < values[0]:
            raise ArgumentError("static", f"be at least {values[0]!r}, the coefficient in slow sliding", self.static)

    @cached_property
    def curve(self) -> Curve:
        """The coefficient in sliding as a curve in pieces."""
        self._check_table()
        first = [0.0] if self.velocity[0] > 0.0 else []
        return in_pieces(self._sliding, np.array([*first, *self.velocity]), OF_TABLE, 0.0)

    @cached_property
    def _interpolant(self) -> Any:
        # Imported here, as it takes longer than many a run.
        from scipy.interpolate import PchipInterpolator

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

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]; at 0, the largest at rest."""
        speed = np.abs(np.asarray(velocity, dtype=float))
        at_rest = self.coefficient[0] if self.static is None else self.static
        return np.asarray(np.where(speed == 0.0, at_rest, self._sliding(speed)))

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0."""
        if not self.velocity[0] < abs(velocity) < self.velocity[-1]:
            return Linearised()
        return Linearised(float(self._interpolant(abs(velocity), 1)))

    def __str__(self) -> str:
        low, high = min(self.coefficient), max(self.coefficient)
        return f"tabulated, {low:.4g} to {high:.4g} at {len(self.velocity)} speeds up to {self.reach:.3g} m/s"
