"""Derivatives of modes: Hoffmann's mass in closed form, the pin on a disc and the brake against modes found again."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi

import numpy as np
import xarray as xr

from ..analysis.stability import sliding_stability
from ..arrays import Array
from ..scenarios import load_scenario
from ..studies.mode_derivatives import STEPS, mode_sensitivity
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch
from .systems.mode_coupling import AT_CONTACT, hoffmann

FRICTION = "friction.coefficient"
# Coefficients of friction below and beyond the merge of Hoffmann's modes, and that at which they merge.
APART, MERGE = (0.5, 0.9), 0.75
# Differences of modes found again: step relative to the parameter, and assumed distance to the nearest merge of modes.
FOUND_AGAIN, TO_MERGE = 1e-3, 0.03
# A change whose effect is stated, and those of the figures.
TENTH, CHANGES = 0.1, np.linspace(-0.3, 0.3, 13)


def exponents_of(found: xr.Dataset) -> Array:
    """Return the exponents of modes [1/s]."""
    return np.asarray(found["growth_rate"].values + 2.0j * pi * found["frequency"].values)


def slope_of(found: xr.Dataset, key: str, number: int) -> complex:
    """Return the derivative of an exponent by a parameter."""
    one = found.sel(parameter=key).isel(mode=number)
    return complex(float(one["d_growth_rate"]), 2.0 * pi * float(one["d_frequency"]))


def _invariant(found: xr.Dataset, name: str) -> complex:
    """Return the derivative of the sum or the product of a pair."""
    real, imaginary = found[name].sel(parameter=FRICTION).isel(mode=0).values.tolist()
    return complex(real, imaginary)


def _hoffmann_known(friction: float) -> tuple[Array, Array, complex, complex]:
    """Return exponents, their derivatives by friction, and those of sum and product of both.

    The squares of the exponents are the roots of ``s⁴ + trace s² + determinant`` of the stiffness, of which friction
    moves the determinant alone.
    """
    matrix = hoffmann().sliding(friction)
    trace, determinant = float(np.trace(matrix)), float(np.linalg.det(matrix))
    by_friction = AT_CONTACT * float(matrix[1, 0])
    squares = -0.5 * trace + np.array([1.0, -1.0]) * np.sqrt(complex(0.25 * trace**2 - determinant))
    exponents = np.sqrt(squares)
    exponents = np.where(exponents.imag < 0.0, -exponents, exponents)
    slopes = (
        -by_friction / (2.0 * exponents * (2.0 * squares + trace)) if abs(friction - MERGE) > 1e-9 else 0.0 * squares
    )
    product = -np.sqrt(determinant)
    by_product = by_friction / (2.0 * product)
    return exponents, slopes, complex(by_product / np.sqrt(complex(2.0 * product - trace))), complex(by_product)


def hoffmann_derivatives() -> Outcome:
    """Derivatives by friction on both sides of the merge, of sum and product at it."""
    rows = []
    reason = "round-off of the matrices, 10 eps times the highest squared frequency over twice this one and the step"
    for friction in APART:
        exponents, slopes, *_ = _hoffmann_known(friction)
        found = mode_sensitivity(hoffmann().system(friction), [FRICTION], modes=2, near=0.22)
        for exponent, slope in zip(exponents, slopes, strict=True):
            got = slope_of(found, FRICTION, int(np.abs(exponents_of(found) - exponent).argmin()))
            tolerance = _round_off(hoffmann().highest, exponent, STEPS[0] * friction)
            words = f"friction {friction:g}, exponent {exponent.real:.3g} + {exponent.imag:.3f}i"
            rows.append(Row(f"{words}: growth by friction", slope.real, got.real, tolerance, reason, "1/s"))
            rows.append(Row(f"{words}: frequency by friction", slope.imag, got.imag, tolerance, reason, "rad/s"))
    exponents, _, by_sum, by_product = _hoffmann_known(MERGE)
    found = mode_sensitivity(hoffmann().system(MERGE), [FRICTION], modes=2, near=0.22)
    merging = int((found["kind"] == "merging").sum())
    rows.append(Row("friction 0.75: modes that merge", 2, merging, 0.0, "a count"))
    for name, known, units in (("sum", by_sum, "1/s"), ("product", by_product, "1/s2")):
        got, tolerance = _invariant(found, f"d_{name}"), _round_off(hoffmann().highest, exponents[0], STEPS[0] * MERGE)
        rows.append(Row(f"friction 0.75: {name} by friction, real", known.real, got.real, tolerance, reason, units))
        rows.append(
            Row(f"friction 0.75: {name} by friction, imaginary", known.imag, got.imag, tolerance, reason, units)
        )
    grid = np.linspace(0.3, 1.2, 181)
    growth = np.array([_hoffmann_known(float(one))[0].real.max() for one in grid])
    _, slopes, *_ = _hoffmann_known(0.9)
    there = float(_hoffmann_known(0.9)[0].real.max())
    tangent = there + float(slopes.real.max()) * (grid - 0.9)
    sketch = Sketch(
        "coefficient of friction",
        "growth [1/s]",
        [Curve(grid, growth, "closed form"), Curve(grid[tangent > 0.0], tangent[tangent > 0.0], "derivative at 0.9")],
    )
    return Outcome(rows, sketch)


def pin_on_disc() -> Outcome:
    """The growing mode of the pin on a disc by friction, moduli and a density, with two of its five nodes open."""
    keys = (FRICTION, "bodies.disc.material.young", "bodies.pin.materials.young", "bodies.disc.material.density")
    return _found_again("pin-on-disc", keys, 2273.0)


def brake() -> Outcome:
    """The growing mode of the brake by friction, a spring, the damping of a lining and the modulus of its disc."""
    keys = (FRICTION, "connections.3.stiffness", "upper lining.stiffness.damping", "bodies.disc.material.young")
    return _found_again("brake", keys, 2822.0)


def _found_again(name: str, keys: Sequence[str], near: float) -> Outcome:
    """Compare the derivatives of the growing mode with differences of modes found again, and the effect of 10 %."""
    found = mode_sensitivity(name, keys, modes=2, near=near, change=TENTH)
    number = int(found["growth_rate"].values.argmax())
    exponent = complex(exponents_of(found)[number])
    rows, notes, curves = [], [], list[Curve]()
    for key in keys:
        size = float(found["value"].sel(parameter=key))

        def there(share: float, key: str = key, size: float = size) -> tuple[complex, float]:
            return _nearest(system_with(name, key, (1.0 + share) * size), exponent)

        known, tolerance = _difference(there, exponent)
        got = size * slope_of(found, key, number)
        reason = "(h / d)⁴ of it, d = 3 % to a merge of modes, and round-off over the step h = 0.1 %"
        rows.append(Row(f"{key}: growth, for a change by all", known.real, got.real, tolerance, reason, "1/s"))
        rows.append(Row(f"{key}: frequency, for a change by all", known.imag, got.imag, tolerance, reason, "rad/s"))
        predicted = found.sel(parameter=key).isel(mode=number)
        change = complex(float(predicted["growth_rate_change"]), 2.0 * pi * float(predicted["frequency_change"]))
        true = _nearest(system_with(name, key, (1.0 + TENTH) * size), exponent + change)[0] - exponent
        notes.append(
            f"{key} + 10 %: growth {change.real:+.4g} 1/s predicted, {true.real:+.4g} found; "
            f"frequency {change.imag / (2.0 * pi):+.4g} Hz predicted, {true.imag / (2.0 * pi):+.4g} found."
        )
        if key == FRICTION:
            grown = np.array([there(float(share))[0].real for share in CHANGES])
            curves = [
                Curve(100.0 * CHANGES, exponent.real + got.real * CHANGES, "derivative"),
                Curve(100.0 * CHANGES, grown, "modes found again", marks=True),
            ]
    return Outcome(rows, Sketch("change of friction [%]", "growth [1/s]", curves), notes)


def system_with(name: str, key: str, value: float) -> System:
    """Return the system of a scenario with a value of a key, that of a surface by its name."""
    given = key.replace("upper lining.", "surfaces.0.")
    return load_scenario(name, {"friction" if key == FRICTION else given: value}).system


def _nearest(system: System, exponent: complex) -> tuple[complex, float]:
    """Return the exponent of a system nearest to another one, and the largest frequency of its modes [rad/s]."""
    found = sliding_stability(system)
    every = exponents_of(found)
    return complex(every[np.abs(every - exponent).argmin()]), float(np.abs(every.imag).max())


def _difference(there: Callable[[float], tuple[complex, float]], exponent: complex) -> tuple[complex, float]:
    """Return the difference of the fourth order of an exponent over the share of a parameter, and its error."""
    (low2, highest), (low, _), (high, _), (high2, _) = (there(FOUND_AGAIN * place) for place in (-2, -1, 1, 2))
    slope = (8.0 * (high - low) - (high2 - low2)) / (12.0 * FOUND_AGAIN)
    return slope, (FOUND_AGAIN / TO_MERGE) ** 4 * abs(slope) + 1.5 * _round_off(highest, exponent, FOUND_AGAIN)


def _round_off(highest: float, exponent: complex, step: float) -> float:
    return 10.0 * float(np.finfo(float).eps) * highest**2 / (2.0 * abs(exponent) * step)


CASES = (
    Case(
        "hoffmann-derivatives",
        "Derivatives of Hoffmann's modes by friction",
        "roots of s⁴ + trace s² + determinant of the stiffness; system of Hoffmann, Fischer, Allgaier & Gaul 2002",
        hoffmann_derivatives,
    ),
    Case(
        "pin-on-disc-derivatives",
        "Derivatives of the growing mode of a pin on a disc",
        "differences of modes found again; system of Allgaier, Gaul, Keiper & Willner 1999",
        pin_on_disc,
    ),
    Case(
        "brake-derivatives",
        "Derivatives of a growing mode of a disc brake",
        "differences of modes found again; the shipped brake",
        brake,
    ),
)
