"""Laws of friction fitted to measured coefficients."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, choice, finite
from .coulomb import Coulomb
from .friction_law import SLOWEST, FrictionLaw
from .lugre import LuGre
from .weakening import ExponentialWeakening, LinearWeakening, Stribeck

# Parameters of each law that steady sliding determines.
FITTED: Mapping[type[FrictionLaw], tuple[str, ...]] = {
    Coulomb: ("coefficient",),
    Stribeck: ("static", "kinetic", "velocity", "viscous"),
    ExponentialWeakening: ("static", "kinetic", "velocity"),
    LinearWeakening: ("static", "slope", "kinetic"),
    LuGre: ("static", "kinetic", "velocity", "viscous"),
}
# Shares of the range of speeds from which the search for a velocity begins.
STARTS = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
# Smallest value of a parameter, relative to its scale: some must be above 0.
LEAST = 1e-12


@dataclass(frozen=True)
class FrictionFit:
    """A law of friction fitted to measured coefficients.

    Attributes
    ----------
    law : FrictionLaw
        The law.
    residuals : ndarray
        Measured minus fitted coefficient at each slip speed [1].
    error : float
        Root of the mean square of the residuals [1].
    """

    law: FrictionLaw
    residuals: Array
    error: float

    def __str__(self) -> str:
        return f"{self.law}; root mean square of the residuals {self.error:.3g} at {self.residuals.size} speeds"


def fit_friction(
    velocity: Array | Sequence[float],
    coefficient: Array | Sequence[float],
    law: type[FrictionLaw] = Stribeck,
    **given: float,
) -> FrictionFit:
    """Fit a law of friction to coefficients measured in steady sliding, by least squares.

    Steady sliding does not determine all parameters: the exponent of `Stribeck` is 2, and the stiffness and damping of
    the bristles of `LuGre` do not matter; give them.

    Parameters
    ----------
    velocity : array_like
        Slip velocities [m/s]; their sign does not matter.
    coefficient : array_like
        Coefficient of friction at each [1], 0 or above.
    law : type, optional
        `Coulomb`, `Stribeck`, `ExponentialWeakening`, `LinearWeakening` or `LuGre`.
    **given : float
        Parameters that are not fitted.

    Returns
    -------
    FrictionFit
        The law, with the residuals.

    Raises
    ------
    ValueError
        If the numbers of entries differ, there are fewer than parameters, or an argument is out of its range.
    """
    if law not in FITTED:
        got = getattr(law, "__name__", repr(law))
        raise ArgumentError("law", f"be one of {', '.join(one.__name__ for one in FITTED)}", got=got)
    speed, measured = _measured(velocity, coefficient)
    own = fields(law)  # type: ignore[arg-type]
    for name, value in given.items():
        finite(choice("argument", name, [field.name for field in own]), value)
    sought = [name for name in FITTED[law] if name not in given]
    for field in own:
        if field.default is MISSING and field.name not in {*sought, *given}:
            raise ArgumentError(field.name, f"be given for {law.__name__}: steady sliding does not depend on it")
    if not sought:
        raise ArgumentError("given", "leave out a parameter to fit", given)
    if speed.size < len(sought):
        got = f"{speed.size} for {', '.join(sought)}"
        raise ArgumentError("velocity", "have at least as many values as there are parameters", got=got)

    def law_at(values: Array) -> FrictionLaw:
        all_of: dict[str, Any] = {**dict(zip(sought, values.tolist(), strict=True)), **given}
        if all_of.get("static", 0.0) < all_of.get("kinetic", 0.0):
            # Friction that only rises with the speed has no weakening part.
            free, bound = ("static", "kinetic") if "static" in sought else ("kinetic", "static")
            all_of[free] = all_of[bound]
        return law(**all_of)

    def residuals(values: Array) -> Array:
        return np.asarray(law_at(values).coefficient_at(speed)) - measured

    # Imported here, as it takes longer than many a run.
    from scipy.optimize import least_squares

    low, high, fastest = float(measured.min()), float(measured.max()), float(speed.max())
    found = []
    for share in STARTS:
        start = {
            "coefficient": float(measured.mean()),
            "static": high,
            "kinetic": max(low, 1e-3 * high),
            "velocity": share * fastest,
            "viscous": 1e-3 * high / fastest,
            "slope": max(high - low, 1e-3 * high) / (share * fastest),
        }
        scale = {"velocity": share * fastest, "viscous": high / fastest, "slope": high / (share * fastest)}
        found.append(
            least_squares(
                residuals,
                [start[name] for name in sought],
                bounds=([LEAST * scale.get(name, high) for name in sought], math.inf),
                x_scale=[scale.get(name, high) for name in sought],
                xtol=1e-14,
                ftol=1e-14,
                gtol=1e-14,
            )
        )
    best = min(found, key=lambda one: float(one.cost))
    fitted = law_at(best.x)
    left = measured - np.asarray(fitted.coefficient_at(speed))
    return FrictionFit(fitted, left, float(np.sqrt(np.mean(left**2))))


def _measured(velocity: Any, coefficient: Any) -> tuple[Array, Array]:
    """Return slip speeds and coefficients, checked."""
    arrays = []
    for name, value in (("velocity", velocity), ("coefficient", coefficient)):
        try:
            array = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            array = np.empty(0)
        if array.ndim != 1 or not array.size or not np.isfinite(array).all():
            raise ArgumentError(name, "be a list of finite numbers", value)
        arrays.append(array)
    speed, measured = np.abs(arrays[0]), arrays[1]
    if speed.size != measured.size:
        got = f"{measured.size} and {speed.size}"
        raise ArgumentError("coefficient", "have as many values as velocity", got=got)
    if measured.min() < 0.0 or measured.max() == 0.0:
        raise ArgumentError("coefficient", "be 0 or above, and not all 0", float(measured.min()))
    if speed.max() == 0.0:
        raise ArgumentError("velocity", "not be all 0", velocity)
    # A speed of 0 is the slowest sliding: bristles that do not move have no force.
    return np.maximum(speed, SLOWEST * speed.max()), measured
