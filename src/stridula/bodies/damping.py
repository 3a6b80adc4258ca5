"""Modal damping of a body: one ratio, one for each mode, or a law of the frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Protocol, TypeGuard

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, rising
from ..declared import DAMPING_RATIO, DampingRatio, Each, Number, check_declared


class DampingLaw(Protocol):
    """Damping of a mode as a function of its frequency; with ratios of 1 and more, modes are overdamped."""

    form: ClassVar[str]

    def rates(self, angular_frequency: Array) -> Array:
        """Return ``2 zeta w`` [1/s] for modes of angular frequency w [rad/s], zero for rigid ones."""


def is_damping_law(given: Any) -> TypeGuard[DampingLaw]:
    """Return whether an object is a law of damping, not a class of them."""
    return hasattr(given, "form") and hasattr(given, "rates") and not isinstance(given, type)


@dataclass(frozen=True)
class Rayleigh:
    """Damping ``C = alpha M + beta K``: the ratio of a mode is ``alpha / (2 w) + beta w / 2``.

    It is common in finite-element programs. ``Rayleigh(0, beta)`` is the Kelvin-Voigt material, whose stress is
    ``E (strain + beta strain rate)``. The share of mass also brakes rigid modes.

    Parameters
    ----------
    mass : float
        Share alpha of the mass matrix [1/s].
    stiffness : float
        Share beta of the stiffness matrix [s].

    Raises
    ------
    ValueError
        If a share is negative or not finite.
    """

    mass: Annotated[float, Number("1/s", least=0.0)]
    stiffness: Annotated[float, Number("s", least=0.0)]
    form: ClassVar[str] = "rayleigh"

    def __post_init__(self) -> None:
        check_declared(self)

    def rates(self, angular_frequency: Array) -> Array:
        """Return ``2 zeta w = alpha + beta w²`` [1/s]."""
        return np.asarray(self.mass + self.stiffness * angular_frequency**2)


@dataclass(frozen=True)
class RisingDamping:
    """Damping whose ratio rises with the frequency f of a mode: ``ratio + rise f``.

    A material with a loss factor independent of frequency, ``2 ratio``, and a viscous part; a Kelvin-Voigt material
    has a rise of ``pi beta``.

    Parameters
    ----------
    ratio : float
        Damping ratio at low frequencies [1].
    rise : float
        Rise of the damping ratio with the frequency of a mode [1/Hz].

    Raises
    ------
    ValueError
        If an argument is negative or not finite, or if the ratio is not below 1.
    """

    ratio: DampingRatio
    rise: Annotated[float, Number("1/Hz", least=0.0)]
    form: ClassVar[str] = "rising"

    def __post_init__(self) -> None:
        check_declared(self)

    def rates(self, angular_frequency: Array) -> Array:
        """Return ``2 zeta w`` [1/s]."""
        frequency = angular_frequency / (2.0 * np.pi)
        return np.asarray(2.0 * angular_frequency * (self.ratio + self.rise * frequency))


@dataclass(frozen=True)
class SampledDamping:
    """Damping ratios given at some frequencies, such as measured ones.

    Linear between them, constant beyond the first and the last.

    Parameters
    ----------
    frequency : sequence of float
        Frequencies at which the ratio is given [Hz], rising.
    ratio : sequence of float
        Damping ratio at each [1], linear between them; from 0 to 1 (1 excluded).

    Raises
    ------
    ValueError
        If frequencies do not increase, an argument is out of its range, or the numbers of entries differ.
    """

    frequency: Annotated[Sequence[float], Each(Number("Hz", least=0.0))]
    ratio: Annotated[Sequence[float], Each(DAMPING_RATIO)]
    form: ClassVar[str] = "sampled"

    def __post_init__(self) -> None:
        check_declared(self)
        frequencies, ratios = self.frequency, self.ratio
        if not frequencies or len(frequencies) != len(ratios):
            raise ArgumentError(
                "ratio",
                "have as many values as frequency, one or more",
                self.ratio,
                got=f"{len(ratios)} and {len(frequencies)}",
            )
        rising("frequency", frequencies)

    def rates(self, angular_frequency: Array) -> Array:
        """Return ``2 zeta w`` [1/s]."""
        ratios = np.interp(angular_frequency / (2.0 * np.pi), self.frequency, self.ratio)
        return np.asarray(2.0 * angular_frequency * ratios)


Damping = float | Sequence[float] | Array | DampingLaw
DAMPING_LAWS = (Rayleigh, RisingDamping, SampledDamping)


def checked_damping(given: Any) -> float | tuple[float, ...] | DampingLaw:
    """Return one ratio, one for each mode, or a law.

    Raises
    ------
    ValueError
        If a ratio is not from 0 to 1, 1 excluded.
    """
    if is_damping_law(given):
        return given
    if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str):
        if np.ndim(given) != 1:
            raise ArgumentError("damping", "be one ratio, a list of one for each mode or a law such as Rayleigh", given)
        return Each(DAMPING_RATIO).check("damping", given)
    return DAMPING_RATIO.check("damping", given)


def check_damping_count(damping: Any, modes: int) -> None:
    """Raise ValueError if damping is a list whose length is not the number of modes."""
    if isinstance(damping, (tuple, np.ndarray)) and len(damping) != modes:
        raise ArgumentError("damping", f"have one ratio or {modes}, one for each mode kept", damping, got=len(damping))


def damping_rates(damping: Any, angular_frequency: Array, loss_factor: float | Array = 0.0) -> Array:
    """Return ``2 zeta w`` [1/s] of every mode under checked damping and the losses of its materials, shape (modes,)."""
    lost = np.asarray(loss_factor * angular_frequency)
    if is_damping_law(damping):
        return np.asarray(damping.rates(angular_frequency) + lost)
    check_damping_count(damping, angular_frequency.size)
    return np.asarray(2.0 * np.asarray(damping) * angular_frequency + lost)
