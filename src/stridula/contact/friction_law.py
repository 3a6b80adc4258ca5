"""Base classes of friction laws."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, in_one_line
from ..declared import check_declared
from .curves import Curve, of_formula
from .linearised import Linearised

# Step of a central difference over the speed.
STEP = 1e-5
# Slip speed that stands for the slowest sliding, relative to the characteristic one.
SLOWEST = 1e-15
# Difference of coefficients that may be due to rounding, and that of those at rest and in the slowest sliding.
EQUAL, CLOSE = 1e-9, 1e-6
CURVE = "CURVE"


class FrictionLaw(ABC):
    """Base class of friction laws: a frozen dataclass with a range beside each field.

    A law of your own needs a formula, `coefficient_at`. The march computes it from a curve in pieces that equals the
    formula to round-off. A formula that cannot be used, because it is not finite, is below zero, jumps in sliding or
    depends on the sense of slip, is refused when the law is built.

    Laws of the package have formulas in the march, named by `kernel_code`, with `parameters`. A law from outside may
    use one of them if its other methods agree with it, which is checked when a system is simulated or linearised.

    Attributes
    ----------
    law : str
        Name in scenarios and titles.
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
    is_passive : bool
        Whether its contact takes energy on the whole, whatever its motion and normal force.
    linear_in : tuple of str
        Fields in which its coefficient is linear, so that friction may lie between two laws that differ in these.
    """

    law: ClassVar[str] = "own law"
    set_valued: ClassVar[bool] = True
    depends_on_speed: ClassVar[bool] = True
    over_decades: ClassVar[bool] = False
    state_units: ClassVar[str] = ""
    state_is_positive: ClassVar[bool] = False
    state_is_vector: ClassVar[bool] = False
    is_passive: ClassVar[bool] = True
    linear_in: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        check_declared(self)
        if type(self).parameters is FrictionLaw.parameters and self.set_valued:
            _ = self.curve

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
        """Name of its constant in the layout of the march, that of a curve unless the law has parameters there."""
        if type(self).parameters is FrictionLaw.parameters:
            return CURVE
        return self.law.upper().replace("-", "_").replace(" ", "_")

    @cached_property
    def curve(self) -> Curve:
        """The coefficient in sliding as a curve in pieces, for laws without parameters in the march."""
        check_formula(self)

        def sliding(speed: Array) -> Array:
            return self.coefficient_at(np.maximum(speed, SLOWEST * self.reach))

        try:
            return of_formula(sliding, self.reach)
        except ValueError as error:
            raise ArgumentError("coefficient_at", str(error), where=type(self).__name__) from None

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march, by their names there: `_kernels.layout.laws.PARAMETERS`."""
        curve = self.curve
        own = {"pieces": len(curve.coefficients), "order": curve.order, "sections": 1}
        return {"static": self.holding, **own, "end_slope": curve.end_slope}

    @property
    def pieces(self) -> Array:
        """Numbers of its curve behind its parameters in the march."""
        return self.curve.flat

    @abstractmethod
    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""

    def under(self, normal_force: float) -> FrictionLaw:
        """Return the law about a normal force [N]."""
        return self

    def on(self, area: float) -> FrictionLaw:
        """Return the law of a contact that represents an area [m²], with normal forces in place of pressures."""
        return self

    @property
    def sections(self) -> tuple[FrictionLaw, ...]:
        """The law at each pressure at which it is given, itself if it does not depend on the pressure."""
        return (self,)

    @property
    def depends_on_pressure(self) -> bool:
        """Whether friction depends on the pressure."""
        return False

    def at(self, value: float) -> FrictionLaw:
        """Return the law at a temperature [degC], or at a place [m], on which it depends."""
        return self

    @property
    def depends_on_temperature(self) -> bool:
        """Whether friction depends on the temperature."""
        return False

    @property
    def depends_on_angle(self) -> bool:
        """Whether friction depends on the angle about the axis of a turning track."""
        return False

    @property
    def depends_on_place(self) -> bool:
        """Whether friction depends on the place along the track."""
        return False

    @property
    def at_values(self) -> tuple[tuple[float, FrictionLaw], ...]:
        """Temperatures or places at which the law is given, and the law at each; none if it depends on neither."""
        return ()

    def slope_over_normal(self, velocity: float, normal_force: float) -> float:
        """Return the change of the coefficient with the normal force [1/N], in steady sliding at a velocity [m/s]."""
        return 0.0

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
        return float(np.asarray(self.coefficient_at(np.zeros(1))).flat[0])

    @property
    def fastest(self) -> float:
        """Slip speed up to which its friction was measured [m/s], infinite for formulas."""
        return math.inf

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


def check_formula(law: FrictionLaw) -> None:
    """Raise ValueError unless the formula of a law can be used: a finite coefficient of 0 or above in both senses."""
    where, speeds = type(law).__name__, law.reach * np.concatenate([[0.0, SLOWEST], np.logspace(-8.0, 4.0, 481)])
    found = [_tried(law, speeds), _tried(law, -speeds)]
    for values, sense in zip(found, (1.0, -1.0), strict=True):
        wrong = ~(np.isfinite(values) & (values >= 0.0))
        if wrong.any():
            at = f"coefficient_at({sense * speeds[wrong.argmax()]:.4g})"
            raise ArgumentError(at, "be finite and 0 or above", float(values[wrong.argmax()]), where=where)
    different = np.abs(found[0] - found[1]) > EQUAL * np.abs(found[0])
    if different.any():
        first = int(different.argmax())
        got = f"{found[0][first]:.6g} and {found[1][first]:.6g} at {speeds[first]:.4g} m/s"
        raise ArgumentError("coefficient_at", "be the same in both senses of slip", got=got, where=where)
    if found[0][0] < (1.0 - CLOSE) * found[0][1]:
        got = f"{found[0][0]:.6g} at rest and {found[0][1]:.6g} in the slowest sliding"
        raise ArgumentError("coefficient_at", "hold at rest at least its friction in sliding", got=got, where=where)


def _tried(law: FrictionLaw, velocities: Array) -> Array:
    """Return the coefficients of a formula at velocities."""
    try:
        values: Any = np.asarray(law.coefficient_at(velocities), dtype=float)
        return np.asarray(np.broadcast_to(values, velocities.shape))
    except Exception as error:
        allowed = "take an array of velocities and return an array of coefficients"
        got = f"{type(error).__name__}: {in_one_line(error)}"
        raise ArgumentError("coefficient_at", allowed, got=got, where=type(law).__name__) from error
