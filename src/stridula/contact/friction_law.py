"""Base classes of friction laws."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..declared import check_declared
from .linearised import Linearised

# Step of a central difference over the speed.
STEP = 1e-5


class FrictionLaw(ABC):
    """Base class of friction laws: a frozen dataclass with a range beside each field, and properties for the march.

    The march computes one of the laws of the package, by `kernel_code` and `parameters`; a law from outside whose other
    methods do not agree with that is refused when a system is simulated or linearised.

    Attributes
    ----------
    law : str
        Name in scenarios.
    set_valued : bool
        Whether a contact sticks exactly, under any force up to a limit.
    depends_on_speed : bool
        Whether friction in sliding depends on the slip speed.
    over_decades : bool
        Whether it varies over decades of the slip speed.
    state_units : str
        SI unit of its internal state, empty without one.
    state_is_positive : bool
        Whether the internal state stays above zero.
    state_is_vector : bool
        Whether the internal state has a component along each tangent in space.
    """

    law: ClassVar[str]
    set_valued: ClassVar[bool] = True
    depends_on_speed: ClassVar[bool] = True
    over_decades: ClassVar[bool] = False
    state_units: ClassVar[str] = ""
    state_is_positive: ClassVar[bool] = False
    state_is_vector: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_declared(self)

    @property
    def has_state(self) -> bool:
        """Whether it has an internal state."""
        return bool(self.state_units)

    @property
    def state_at_start(self) -> float:
        """Internal state at the start, in its unit."""
        return 0.0

    @property
    def states_at_start(self) -> tuple[float, float]:
        """Internal states at the start along both tangents of a contact in space; 0 along the second if scalar."""
        return self.state_at_start, 0.0

    @property
    def state_at_landing(self) -> float:
        """Internal state of a contact that closes later."""
        return 0.0

    def state_in_sliding(self, velocity: float, change: float = 0.0) -> float:
        """Return the internal state in steady sliding at `velocity` [m/s], not 0, with `change` in that sense."""
        return 0.0

    @property
    def kernel_code(self) -> str:
        """Name of its constant in the layout of the march."""
        return self.law.upper().replace("-", "_").replace(" ", "_")

    @abstractmethod
    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march, by their names there: `_kernels.layout.laws.PARAMETERS`."""

    @abstractmethod
    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0; by differences by default."""
        if not self.depends_on_speed:
            return Linearised()
        low, high = np.asarray(self.coefficient_at(abs(velocity) * np.array([1.0 - STEP, 1.0 + STEP])), dtype=float)
        return Linearised(slope=float(high - low) / (2.0 * STEP * abs(velocity)))

    def linearised_across(self, velocity: float) -> Linearised:
        """Return the law linearised across steady sliding at `velocity` [m/s], not 0: by default the force turns."""
        return Linearised(slope=float(self.coefficient_at(velocity)) / abs(velocity))

    @property
    def holding(self) -> float:
        """Ratio up to which a contact is held at rest [1]."""
        return float(self.coefficient_at(np.zeros(1))[0])

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return 1.0


class StaticAndKinetic(FrictionLaw):
    """A law with a static coefficient of at least the kinetic one."""

    static: float
    kinetic: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.static < self.kinetic:
            raise ArgumentError("static", f"be at least kinetic ({self.kinetic!r})", self.static)
