"""Verification cases: runs with known answers, and the rows that compare both."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..arrays import Array
from ..integration import SCHEMES
from ..lowering.schemes import Scheme


@dataclass(frozen=True)
class Row:
    """One quantity of a case, expected and obtained.

    Attributes
    ----------
    quantity : str
        Name of the quantity.
    expected, obtained : float
        The known answer and ours.
    tolerance : float
        Largest allowed distance between the two, in the unit of the quantity.
    reason : str
        Origin of the tolerance: theory or the literature, never the obtained value.
    units : str, optional
        Unit of the quantity.
    scheme : str, optional
        Name of the scheme, if one was used.
    """

    quantity: str
    expected: float
    obtained: float
    tolerance: float
    reason: str
    units: str = "1"
    scheme: str = ""

    @property
    def error(self) -> float:
        """Distance of the obtained from the expected value."""
        return self.obtained - self.expected

    @property
    def holds(self) -> bool:
        """Whether the row is within its tolerance."""
        return abs(self.error) <= self.tolerance


@dataclass(frozen=True)
class Curve:
    """A line of a figure, or marks if `marks` is true.

    Attributes
    ----------
    x, y : ndarray
        Abscissas and ordinates.
    label : str
        Label.
    marks : bool, optional
        Whether to draw marks.
    """

    x: Array
    y: Array
    label: str
    marks: bool = False


@dataclass(frozen=True)
class Sketch:
    """Contents of the small figure of a case.

    Attributes
    ----------
    x, y : str
        Labels of the axes.
    curves : list of Curve
        The lines.
    logarithmic : bool, optional
        Whether both axes are logarithmic.
    """

    x: str
    y: str
    curves: list[Curve]
    logarithmic: bool = False


@dataclass
class Outcome:
    """Result of a case.

    Attributes
    ----------
    rows : list of Row
        Its quantities.
    sketch : Sketch
        Its figure.
    notes : list of str, optional
        Other observations, without a verdict.
    """

    rows: list[Row]
    sketch: Sketch
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Case:
    """A case with a known answer.

    Attributes
    ----------
    name : str
        Short name, also of its figure.
    title : str
        Description in a phrase.
    source : str
        Source of the answer.
    run : callable
        Function that runs the case and returns an `Outcome`.
    """

    name: str
    title: str
    source: str
    run: Callable[[], Outcome] = field(repr=False)


def schemes() -> list[Scheme]:
    """Return every time scheme."""
    return [scheme() for scheme in SCHEMES.values()]


def table_row(case: Case, row: Row) -> dict[str, Any]:
    """Return a row in the form of `verification.json`."""
    return {
        "case": case.name,
        "quantity": row.quantity,
        "scheme": row.scheme,
        "expected": _number(row.expected),
        "obtained": _number(row.obtained),
        "error": _number(row.error),
        "tolerance": _number(row.tolerance),
        "reason": row.reason,
        "units": row.units,
        "holds": bool(row.holds),
        "source": case.source,
    }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def by_scheme(rows_of: Callable[[Scheme], Sequence[Row]]) -> list[Row]:
    """Return the rows of a function of the scheme, for every scheme."""
    return [row for scheme in schemes() for row in rows_of(scheme)]
