"""Springs and dashpots whose force is not proportional to their stretch, or to its rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint
from ..checks import ArgumentError, rising
from ..declared import Axis, Each, Number, check_declared
from ..histories import Constant, History
from .ends import along, check_ends
from .table_files import table_of_file


@dataclass(frozen=True)
class Bend:
    """The pull of a spring over its stretch s, or of a dashpot over the rate of its stretch, beyond a linear part.

    It is ``constant + linear s + cubic s³ + sum of right max(s - place, 0) + left min(s - place, 0)``. For a dashpot,
    metres are metres per second.

    Attributes
    ----------
    constant : float
        Pull without a stretch [N].
    linear : float
        Stiffness without a stretch [N/m], where the linear part does not have it.
    cubic : float
        Pull for the cube of a stretch [N/m³].
    place : ndarray, shape (kinks,)
        Stretches at which the stiffness changes, rising [m].
    right, left : ndarray, shape (kinks,)
        Change of the stiffness above each, and below it [N/m].
    of_rate : bool
        Whether it is that of a dashpot.
    """

    constant: float
    linear: float
    cubic: float
    place: Array
    right: Array
    left: Array
    of_rate: bool = False

    def pull(self, stretch: float) -> float:
        """Return the pull at a stretch [N]."""
        return float(self.pulls(np.asarray(stretch)))

    def pulls(self, stretch: Array) -> Array:
        """Return the pulls at several stretches [N]."""
        above, below = self._from_kinks(stretch[..., None])
        smooth = self.constant + self.linear * stretch + self.cubic * stretch**3
        return np.asarray(smooth + above @ self.right + below @ self.left)

    def stiffness(self, stretch: float) -> float:
        """Return the change of the pull with the stretch [N/m]."""
        above, below = self._from_kinks(stretch)
        kinked = self.right @ (above > 0.0) + self.left @ (below < 0.0)
        return float(self.linear + 3.0 * self.cubic * stretch**2 + kinked)

    def stiffness_about_rest(self) -> float:
        """Return the change of the pull for small stretches to both sides [N/m]: the mean of both at a kink."""
        kinked = self.place == 0.0
        return self.stiffness(0.0) + 0.5 * float((self.right + self.left) @ kinked)

    def energy(self, stretch: float) -> float:
        """Return the energy that the pull stores [J]."""
        above, below = self._from_kinks(stretch)
        kinked = 0.5 * (self.right @ above**2 + self.left @ below**2)
        smooth = self.constant * stretch + 0.5 * self.linear * stretch**2 + 0.25 * self.cubic * stretch**4
        return float(smooth + kinked)

    def steepest(self, stretch: float) -> float:
        """Return the largest stiffness [N/m] of a table at any stretch, or of a cubic up to a stretch [m]."""
        if not self.place.size:
            return max(self.stiffness(stretch), 0.0)
        ends = self.place[0] - 1.0, self.place[-1] + 1.0
        return max(self.stiffness(one) for one in (*ends, *(self.place[1:] + self.place[:-1]) / 2.0))

    def _from_kinks(self, stretch: float | Array) -> tuple[Array, Array]:
        """Return the stretch above each kink, and below it."""
        return np.maximum(stretch - self.place, 0.0), np.minimum(stretch - self.place, 0.0)


@dataclass(frozen=True)
class NonlinearSpring:
    """A massless spring whose force is not proportional to its stretch.

    Attributes
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint or None
        The other end, or the ground.
    direction : str or tuple of float
        World direction along which it acts.
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str]
    direction: Axis = field(default="x", kw_only=True)
    # A force that does not depend on time has no history.
    moved_by: ClassVar[float] = 0.0
    history: ClassVar[History] = Constant()

    def __post_init__(self) -> None:
        check_ends(self.first, self.second)
        check_declared(self)

    @property
    def stiffness_at_rest(self) -> float:
        """Stiffness at the start [N/m]."""
        raise NotImplementedError

    @property
    def bend(self) -> Bend:
        """Its pull beyond that of its linear part."""
        raise NotImplementedError

    @property
    def rates(self) -> tuple[float, float]:
        """Force of its linear part per unit of relative displacement [N/m] and of relative velocity [N s/m]."""
        return max(self.stiffness_at_rest, 0.0), 0.0


@dataclass(frozen=True)
class CubicSpring(NonlinearSpring):
    """A massless spring with a cubic law, between two points, or between a point and the ground.

    Its force pulls the first end back with ``stiffness s + cubic s³``, where s is the displacement of the first end
    relative to the other along the direction. It hardens where `cubic` is above zero, and softens where it is below.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of the same or another body; the ground if left out.
    direction : {"x", "y", "z"} or sequence of float, optional
        World direction along which it acts: x, y, z, or its three components, of any length.
    stiffness : float
        Stiffness without a stretch [N/m].
    cubic : float
        Force for the cube of the stretch [N/m3].

    Examples
    --------
    >>> mass = st.PointMass(1.0)
    >>> st.CubicSpring(mass.centre, stiffness=8766.2, cubic=4.6752e7).pull(0.01)
    134.414
    """

    kind: ClassVar[str] = "cubic spring"
    stiffness: Annotated[float, Number("N/m")] = field(kw_only=True)
    cubic: Annotated[float, Number("N/m3")] = field(kw_only=True)

    @property
    def stiffness_at_rest(self) -> float:
        """Stiffness at the start [N/m]."""
        return self.stiffness

    @property
    def bend(self) -> Bend:
        """Its pull beyond that of its linear part."""
        nothing = np.zeros(0)
        return Bend(0.0, min(self.stiffness, 0.0), self.cubic, nothing, nothing, nothing)

    def pull(self, stretch: float) -> float:
        """Return the force that pulls the first end back at a stretch [m], in N."""
        return self.stiffness * stretch + self.cubic * stretch**3

    def __str__(self) -> str:
        return f"cubic spring {self.stiffness:.4g} N/m, {self.cubic:.4g} N/m3 along {along(self)}"


@dataclass(frozen=True)
class Lines:
    """A pull on straight lines between points, and beyond them on those through the last two.

    Attributes
    ----------
    at : ndarray, shape (points,)
        Stretches, or their rates, rising [m or m/s].
    force : ndarray, shape (points,)
        Pull at each [N].
    """

    at: Array
    force: Array

    @cached_property
    def slopes(self) -> Array:
        """Slope of each straight line."""
        return np.asarray(np.diff(self.force) / np.diff(self.at))

    @property
    def slope_at_rest(self) -> float:
        """Slope at the origin; at a kink, that above it."""
        return float(self.slopes[self._line(0.0)])

    def pull(self, stretch: float) -> float:
        """Return the pull at a stretch [N]."""
        line = self._line(stretch)
        return float(self.force[line] + self.slopes[line] * (stretch - self.at[line]))

    def bend(self, linear: float, of_rate: bool = False) -> Bend:
        """Return the pull beyond that of a linear part with a given slope."""
        place, change = self.at[1:-1], np.diff(self.slopes)
        above = place > 0.0
        right, left = np.where(above, change, 0.0), np.where(above, 0.0, -change)
        return Bend(self.pull(0.0), self.slope_at_rest - linear, 0.0, place, right, left, of_rate)

    def _line(self, stretch: float) -> int:
        return int(np.searchsorted(self.at[1:-1], stretch, side="right"))


def check_table(name: str, at: Sequence[float], force: Sequence[float]) -> None:
    """Raise ArgumentError unless the table of a pull rises in its first list, called `name`, and is complete."""
    if len(at) < 2:
        raise ArgumentError(name, "have two values or more", got=str(len(at)))
    rising(name, at)
    if len(force) != len(at):
        raise ArgumentError("force", f"have as many values as {name}, {len(at)}", got=str(len(force)))


@dataclass(frozen=True)
class TabulatedSpring(NonlinearSpring):
    """A massless spring given by a table, such as a bump stop, a play or a bilinear spring.

    Its force pulls the first end back; it lies on straight lines between the displacements of the table, and beyond
    them on those through the last two. The displacement is that of the first end relative to the other along the
    direction. A table with a force without a displacement is preloaded.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of the same or another body; the ground if left out.
    direction : {"x", "y", "z"} or sequence of float, optional
        World direction along which it acts: x, y, z, or its three components, of any length.
    displacement : sequence of float
        Displacements of the table [m], rising, two or more.
    force : sequence of float
        Force at each [N].

    Examples
    --------
    A mount with a play of 1 mm to either side, then 50 N/mm:

    >>> mass = st.PointMass(1.0)
    >>> play = st.TabulatedSpring(mass.centre, displacement=[-2e-3, -1e-3, 1e-3, 2e-3], force=[-50.0, 0.0, 0.0, 50.0])
    >>> play.pull(3e-3)
    100.0
    """

    kind: ClassVar[str] = "tabulated spring"
    displacement: Annotated[Sequence[float], Each(Number("m"))] = field(kw_only=True)
    force: Annotated[Sequence[float], Each(Number("N"))] = field(kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        check_table("displacement", self.displacement, self.force)

    @classmethod
    def read(
        cls,
        path: str | Path,
        first: BodyPoint,
        second: BodyPoint | None = None,
        columns: Sequence[str | int] = (0, 1),
        *,
        direction: str | Sequence[float] = "x",
        displacement_unit: float = 1.0,
        force_unit: float = 1.0,
    ) -> TabulatedSpring:
        """Read a table from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each displacement; values are separated by commas, semicolons, tabs or blanks. A first
            line may name the columns; lines that begin with ``#`` are skipped. Lines need not be in order.
        first, second : BodyPoint
            Both ends; the ground if the second is left out.
        columns : sequence, optional
            Columns of displacement and force, by name or by number from 0.
        direction : str or sequence of float, optional
            World direction along which it acts.
        displacement_unit, force_unit : float, optional
            Units in the file, such as 1e-3 for mm and 1e3 for kN [m, N].

        Raises
        ------
        ValueError
            If the file has no such table; the message names file and line.
        """
        if len(columns) != 2:
            raise ArgumentError("columns", "be two, of displacement and force", columns)
        units = {"displacement": displacement_unit, "force": force_unit}
        return table_of_file(partial(cls, first, second, direction=direction), path, columns, units)

    @cached_property
    def _lines(self) -> Lines:
        return Lines(np.array(self.displacement), np.array(self.force))

    @property
    def stiffness_at_rest(self) -> float:
        """Stiffness at the start [N/m]; at a kink, that above it."""
        return self._lines.slope_at_rest

    @cached_property
    def bend(self) -> Bend:
        """Its pull beyond that of its linear part."""
        return self._lines.bend(self.rates[0])

    def pull(self, stretch: float) -> float:
        """Return the force that pulls the first end back at a stretch [m], in N."""
        return self._lines.pull(stretch)

    def __str__(self) -> str:
        least, most = f"{self.displacement[0]:.4g}", f"{self.displacement[-1]:.4g}"
        return f"spring by a table from {least} to {most} m along {along(self)}"
