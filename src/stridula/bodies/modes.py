"""Mass-normalised modes, to which every linear body is reduced, and the protocol of bodies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np

from ..arrays import Array
from ..checks import counted
from .turning import Turning


@dataclass(frozen=True, repr=False)
class Modes:
    """Mass-normalised modes of a body: ``q''' + d q' + w² q = Phi^T f``.

    With a damping matrix D, ``D q'`` stands in place of ``d q'``. Residual shapes, which may come last, have unit
    stiffness and no mass: ``q = Psi^T f``.

    Attributes
    ----------
    angular_frequency : ndarray, shape (modes,)
        Undamped angular frequencies w [rad/s], rising; exactly zero for rigid modes, infinite for residual shapes.
    damping_rate : ndarray, shape (modes,)
        ``d = 2 zeta w`` [1/s] for a damping ratio zeta; from ``2 w`` on a mode is overdamped.
    translation : ndarray, shape (2, modes) or (3, modes)
        ``Phi^T M 1``: the drive of each mode by a uniform acceleration along world x, y and, in space, z [kg^(1/2)].
    damping_matrix : ndarray, shape (modes, modes), optional
        Modal damping matrix ``Phi^T C Phi`` [1/s] if it is not diagonal; `damping_rate` is then its diagonal.
    turning : Turning, optional
        Rotation of the modes with a body that turns.
    """

    angular_frequency: Array
    damping_rate: Array
    translation: Array
    damping_matrix: Array | None = None
    turning: Turning | None = None

    def __repr__(self) -> str:
        vibrating, residual = self.frequency[~self.massless], int(self.massless.sum())
        ends = f" to {vibrating.max():.4g} Hz" if vibrating.size else ""
        more = f" and {counted(residual, 'residual shape')}" if residual else ""
        return f"Modes({counted(vibrating.size, 'mode')}{ends}{more})"

    @property
    def count(self) -> int:
        """Number of modes."""
        return int(self.angular_frequency.size)

    @property
    def massless(self) -> Array:
        """Mask of the residual shapes, shape (modes,)."""
        return np.isinf(self.angular_frequency)

    @property
    def stiffness(self) -> Array:
        """Modal stiffnesses, shape (modes,): w² [1/s²], and 1 for residual shapes."""
        return np.where(self.massless, 1.0, self.angular_frequency) ** 2

    @property
    def damping(self) -> Array:
        """Damping ratios zeta [1], shape (modes,); zero for rigid modes."""
        elastic = self.angular_frequency > 0.0
        return np.where(elastic, self.damping_rate / np.where(elastic, 2.0 * self.angular_frequency, 1.0), 0.0)

    @property
    def frequency(self) -> Array:
        """Natural frequencies [Hz], shape (modes,)."""
        return self.angular_frequency / (2.0 * np.pi)


Described = TypeVar("Described", bound=type)


def hashed_once(described: Described) -> Described:
    """Make a frozen dataclass cache its hash: bodies are looked up by all their fields many times in a run."""
    by_value: Callable[[Any], int] = described.__hash__  # type: ignore[assignment]

    def hashed(self: Any) -> int:
        known = self.__dict__.get("_hash")
        if known is None:
            known = self.__dict__["_hash"] = by_value(self)
        found: int = known
        return found

    def state(self: Any) -> dict[str, Any]:
        # Hashes of texts differ between processes.
        return {name: value for name, value in self.__dict__.items() if name != "_hash"}

    described.__hash__ = hashed  # type: ignore[method-assign, assignment]
    described.__getstate__ = state  # type: ignore[method-assign, assignment]
    return described


class Body(Protocol):
    """Protocol of all bodies; a position of a point is anything that `check_position` accepts.

    Attributes
    ----------
    kind : str
        Name in scenarios.
    has_positions : bool
        Whether positions along it are points, besides the named ones.
    """

    kind: ClassVar[str]
    has_positions: ClassVar[bool]

    @property
    def is_spatial(self) -> bool:
        """Whether it also moves along world z; else it is rigid there."""

    @property
    def point_names(self) -> tuple[str, ...]:
        """Names of its points."""

    @property
    def has_translation(self) -> bool:
        """Whether its modal translation is known."""

    @property
    def dimensions(self) -> str:
        """Size in words, empty if it has none."""

    @property
    def posture(self) -> str:
        """Orientation in words, empty if it has none."""

    @property
    def name(self) -> str:
        """Name in records; distinguishes equal bodies."""

    @property
    def axes(self) -> Array:
        """World components of its two axes, shape (2, 2)."""

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes; with `held_x` those with the driven end held along x."""

    def trace(self, position: Any, held_x: bool = False) -> Array:
        """Return the rows that give the world displacement at `position` from the modes.

        Shape (2, modes) along x and y, or (3, modes) for a body in space.
        """

    def check_position(self, position: Any) -> None:
        """Raise ValueError if there is no point at `position`."""
