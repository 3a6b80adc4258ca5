"""Dashpots whose force is not proportional to the velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np

from ..bodies import BodyPoint
from ..checks import ArgumentError
from ..declared import Axis, Each, Number, check_declared
from ..histories import Constant, History
from .ends import along, check_ends
from .nonlinear import Bend, Lines, check_table
from .table_files import table_of_file


@dataclass(frozen=True)
class TabulatedDashpot:
    """A massless damper given by a table, such as one that yields in one direction, or above a force.

    Its force brakes the first end; it lies on straight lines between the velocities of the table, and beyond them on
    those through the last two. The velocity is that of the first end relative to the other along the direction. A table
    with a force at rest is preloaded: beyond this force, it has to brake.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of the same or another body; the ground if left out.
    direction : {"x", "y", "z"} or sequence of float, optional
        World direction along which it acts: x, y, z, or its three components, of any length.
    velocity : sequence of float
        Velocities of the table [m/s], rising, two or more.
    force : sequence of float
        Force at each [N].

    Examples
    --------
    A damper of 300 N s/m as it is pressed and of 1000 N s/m as it is drawn, with a valve that opens at 0.5 m/s:

    >>> mass = st.PointMass(1.0)
    >>> damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, 0.0, 0.5, 1.0], force=[-300.0, 0.0, 500.0, 600.0])
    >>> damper.pull(0.25), damper.pull(2.0)
    (250.0, 800.0)
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "tabulated dashpot"
    # A force that does not depend on time has no history.
    moved_by: ClassVar[float] = 0.0
    history: ClassVar[History] = Constant()
    direction: Axis = field(default="x", kw_only=True)
    velocity: Annotated[Sequence[float], Each(Number("m/s"))] = field(kw_only=True)
    force: Annotated[Sequence[float], Each(Number("N"))] = field(kw_only=True)

    def __post_init__(self) -> None:
        check_ends(self.first, self.second)
        check_declared(self)
        check_table("velocity", self.velocity, self.force)
        self._check_brakes()

    def _check_brakes(self) -> None:
        """Raise unless the force beyond that at rest brakes at all velocities, also beyond the table."""
        for k, (velocity, force) in enumerate(zip(self.velocity, self.force, strict=True)):
            if (force - self.pull(0.0)) * velocity < 0.0:
                words = (
                    f"brake: at {velocity:.6g} m/s have the sign of the velocity, beyond {self.pull(0.0):.6g} N at rest"
                )
                raise ArgumentError(f"force[{k}]", words, force)
        for side, slope in (("first", self._lines.slopes[0]), ("last", self._lines.slopes[-1])):
            if slope < 0.0:
                words = f"not fall over its {side} two velocities, on whose line it goes on; repeat a force to hold it"
                raise ArgumentError("force", words, got=f"{slope:.6g} N s/m there")

    @classmethod
    def read(
        cls,
        path: str | Path,
        first: BodyPoint,
        second: BodyPoint | None = None,
        columns: Sequence[str | int] = (0, 1),
        *,
        direction: str | Sequence[float] = "x",
        velocity_unit: float = 1.0,
        force_unit: float = 1.0,
    ) -> TabulatedDashpot:
        """Read a table from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each velocity; values are separated by commas, semicolons, tabs or blanks. A first line
            may name the columns; lines that begin with ``#`` are skipped. Lines need not be in order.
        first, second : BodyPoint
            Both ends; the ground if the second is left out.
        columns : sequence, optional
            Columns of velocity and force, by name or by number from 0.
        direction : str or sequence of float, optional
            World direction along which it acts.
        velocity_unit, force_unit : float, optional
            Units in the file, such as 1e-3 for mm/s and 1e3 for kN [m/s, N].

        Raises
        ------
        ValueError
            If the file has no such table; the message names file and line.
        """
        if len(columns) != 2:
            raise ArgumentError("columns", "be two, of velocity and force", columns)
        units = {"velocity": velocity_unit, "force": force_unit}
        return table_of_file(partial(cls, first, second, direction=direction), path, columns, units)

    @cached_property
    def _lines(self) -> Lines:
        return Lines(np.array(self.velocity), np.array(self.force))

    @property
    def rates(self) -> tuple[float, float]:
        """Force of its linear part, its smallest slope, per unit of displacement [N/m] and of velocity [N s/m]."""
        return 0.0, max(float(self._lines.slopes.min()), 0.0)

    @cached_property
    def bend(self) -> Bend:
        """Its pull beyond that of its linear part."""
        return self._lines.bend(self.rates[1], of_rate=True)

    def pull(self, velocity: float) -> float:
        """Return the force that brakes the first end at a relative velocity [m/s], in N."""
        return self._lines.pull(velocity)

    def __str__(self) -> str:
        least, most = f"{self.velocity[0]:.4g}", f"{self.velocity[-1]:.4g}"
        return f"dashpot by a table from {least} to {most} m/s along {along(self)}"
