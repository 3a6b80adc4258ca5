"""Springs whose stiffness and loss depend on the frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint
from ..checks import ArgumentError, rising
from ..declared import Axis, Each, Number, check_declared
from ..doubtful import warn_of
from ..histories import Constant, History
from .branches import Relaxation, relaxation_of
from .elements import Element, Motion
from .ends import along, check_ends, unit
from .table_files import table_of_file

# Relative error of the branches from which there is a warning.
DOUBTFUL = 0.1


@dataclass(frozen=True)
class ViscoelasticSpring:
    """A massless spring of rubber, a damping layer or a shim, whose stiffness and loss depend on the frequency.

    Its complex stiffness is ``stiffness (1 + i loss_factor)`` at the frequencies of the table. It is fitted by a
    stiffness at rest in parallel to springs that relax, so that the force is passive and causal at every frequency;
    `complex_stiffness` has the result, and a warning says if it is off by more than a tenth. A stiffness that does not
    rise with the frequency while there is a loss is that of no material. Below the table the stiffness tends to that at
    rest, at least half of the least one; above it the loss factor falls to zero.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of the same or another body; the ground if left out.
    direction : {"x", "y", "z"} or sequence of float, optional
        World direction along which it acts: x, y, z, or its three components, of any length.
    frequency : sequence of float
        Frequencies of the table [Hz], rising, one or more.
    stiffness : sequence of float
        Real part of the stiffness at each [N/m].
    loss_factor : sequence of float
        Imaginary over real part of the stiffness at each [1].

    Warns
    -----
    DoubtfulValue
        If no passive spring has these stiffnesses and loss factors within a tenth.

    Examples
    --------
    >>> mass = st.PointMass(1.0)
    >>> shim = st.ViscoelasticSpring(mass.centre, frequency=[2e3], stiffness=[1e8], loss_factor=[0.3])
    >>> print(shim)
    viscoelastic spring 1e+08 N/m with a loss factor of 0.3 at 2000 Hz along x
    >>> complex(shim.complex_stiffness(2e3)).imag / 1e8
    0.3
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "viscoelastic spring"
    direction: Axis = field(default="x", kw_only=True)
    frequency: Annotated[Sequence[float], Each(Number("Hz", above=0.0))] = field(kw_only=True)
    stiffness: Annotated[Sequence[float], Each(Number("N/m", above=0.0))] = field(kw_only=True)
    loss_factor: Annotated[Sequence[float], Each(Number("1", least=0.0))] = field(kw_only=True)
    bend: ClassVar[None] = None
    moved_by: ClassVar[float] = 0.0
    history: ClassVar[History] = Constant()

    def __post_init__(self) -> None:
        check_ends(self.first, self.second)
        check_declared(self)
        if not len(self.frequency):
            raise ArgumentError("frequency", "have one value or more", got="none")
        rising("frequency", self.frequency)
        for name in ("stiffness", "loss_factor"):
            if len(getattr(self, name)) != len(self.frequency):
                words = f"have as many values as frequency, {len(self.frequency)}"
                raise ArgumentError(name, words, got=str(len(getattr(self, name))))
        error = self.relaxation.error
        if error > DOUBTFUL:
            words = (
                f"no passive spring has these stiffnesses and loss factors within {error:.0%}; see complex_stiffness"
            )
            warn_of([f"{self}: {words}"])

    @classmethod
    def read(
        cls,
        path: str | Path,
        first: BodyPoint,
        second: BodyPoint | None = None,
        columns: Sequence[str | int] = (0, 1, 2),
        *,
        direction: str | Sequence[float] = "x",
        frequency_unit: float = 1.0,
        stiffness_unit: float = 1.0,
    ) -> ViscoelasticSpring:
        """Read a table from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each frequency; values are separated by commas, semicolons, tabs or blanks. A first
            line may name the columns; lines that begin with ``#`` are skipped. Lines need not be in order.
        first, second : BodyPoint
            Both ends; the ground if the second is left out.
        columns : sequence, optional
            Columns of frequency, stiffness and loss factor, by name or by number from 0.
        direction : str or sequence of float, optional
            World direction along which it acts.
        frequency_unit, stiffness_unit : float, optional
            Units in the file, such as 1e3 for kHz and 1e6 for N/µm [Hz, N/m].

        Raises
        ------
        ValueError
            If the file has no such table; the message names file and line.
        """
        if len(columns) != 3:
            raise ArgumentError("columns", "be three, of frequency, stiffness and loss factor", columns)
        units = {"frequency": frequency_unit, "stiffness": stiffness_unit, "loss_factor": 1.0}
        return table_of_file(partial(cls, first, second, direction=direction), path, columns, units)

    @property
    def relaxation(self) -> Relaxation:
        """Its stiffness at rest and its branches."""
        return relaxation_of(tuple(self.frequency), tuple(self.stiffness), tuple(self.loss_factor))

    @property
    def elements(self) -> tuple[Element, ...]:
        """Its stiffness for fast motion, with the branches that relax."""
        return (Element(Motion(unit(self)), self.relaxation.fast, 0.0, self.relaxation.branches),)

    def complex_stiffness(self, frequency: float | Sequence[float] | Array) -> Array:
        """Return the complex stiffness with which it acts at frequencies [Hz], in N/m.

        Parameters
        ----------
        frequency : float or sequence of float
            Frequencies [Hz].
        """
        return self.relaxation.stiffness(2.0 * np.pi * np.asarray(frequency, dtype=float))

    def __str__(self) -> str:
        ends = [f"{one[0]:.4g} to {one[-1]:.4g}" if len(one) > 1 else f"{one[0]:.4g}" for one in self._table]
        return f"viscoelastic spring {ends[1]} N/m with a loss factor of {ends[2]} at {ends[0]} Hz along {along(self)}"

    @property
    def _table(self) -> tuple[Sequence[float], ...]:
        return self.frequency, self.stiffness, self.loss_factor
