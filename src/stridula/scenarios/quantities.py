"""Numbers with units in scenario files: "45 deg", "1 cm/s" and "15 kHz" are converted to SI."""

from __future__ import annotations

import math
import re
from decimal import Decimal
from numbers import Real
from typing import Any

from ..checks import ArgumentError

DEGREES = "degrees"
# For each SI unit, the spellings that are read and their factors; decimal, so that "9.8 mm" is exactly 0.0098.
UNITS: dict[str, dict[str, str]] = {
    "1": {"%": "0.01"},
    "m": {"m": "1", "cm": "0.01", "mm": "1e-3", "um": "1e-6", "µm": "1e-6"},
    "m2": {"m2": "1", "cm2": "1e-4", "mm2": "1e-6"},
    "m4": {"m4": "1", "cm4": "1e-8", "mm4": "1e-12"},
    "s": {"s": "1", "ms": "1e-3", "us": "1e-6", "µs": "1e-6"},
    "Hz": {"Hz": "1", "kHz": "1e3", "MHz": "1e6"},
    "rad": {"rad": "1", "deg": DEGREES, "°": DEGREES},
    "m/s": {"m/s": "1", "cm/s": "0.01", "mm/s": "1e-3"},
    "m/s2": {"m/s2": "1"},
    "N": {"N": "1", "mN": "1e-3", "kN": "1e3"},
    "Pa": {"Pa": "1", "mPa": "1e-3", "MPa": "1e6", "GPa": "1e9"},
    "kg/m3": {"kg/m3": "1", "g/cm3": "1e3"},
    "kg": {"kg": "1", "g": "1e-3", "t": "1e3"},
    "N/m": {"N/m": "1", "N/mm": "1e3", "kN/m": "1e3", "kN/mm": "1e6"},
    "N/m3": {"N/m3": "1", "N/mm3": "1e9"},
    "N s/m": {"N s/m": "1", "N s/mm": "1e3", "kN s/m": "1e3"},
    "N m/rad": {"N m/rad": "1", "kN m/rad": "1e3", "N mm/rad": "1e-3"},
    "N m s/rad": {"N m s/rad": "1"},
    "N s/m3": {"N s/m3": "1", "N s/mm3": "1e9"},
    "1/m": {"1/m": "1", "1/mm": "1e3"},
    "1/Hz": {"1/Hz": "1", "1/kHz": "1e-3"},
    "1/s": {"1/s": "1", "1/ms": "1e3"},
    "s/m": {"s/m": "1", "s/mm": "1e3"},
    "degC": {"degC": "1", "°C": "1"},
    "J/K": {"J/K": "1", "kJ/K": "1e3"},
    "W/K": {"W/K": "1", "kW/K": "1e3"},
    "rad/s": {"rad/s": "1", "rpm": "0.1047197551196597746"},
}
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?|[+-]?inf|nan)\s*(.*?)\s*")


def quantity(value: Any, unit: str, name: str = "value") -> float:
    """Return a number in SI from a number or a text such as ``"20 mm"``.

    Parameters
    ----------
    value : float or str
        A number in `unit`, or a text with a number and a unit of the same dimension.
    unit : str
        SI unit, a key of `UNITS`; ``"1"`` for a ratio.
    name : str, optional
        Name in messages.

    Raises
    ------
    ArgumentError
        If it is not a finite number, or its unit is of another dimension.
    """
    if isinstance(value, bool) or not isinstance(value, (Real, str)):
        raise ArgumentError(name, f"be a number{_units(unit)}", value)
    if not isinstance(value, str):
        return _finite(value, name, value)
    match = _NUMBER.fullmatch(value)
    if match is None:
        raise ArgumentError(name, f"be a number{_units(unit)}", value)
    number, spelling = match.groups()
    _finite(float(number), name, value)
    factor = UNITS[unit].get(spelling.replace("²", "2").replace("³", "3"), "1" if not spelling else None)
    if factor is None:
        raise ArgumentError(name, f"be a number{_units(unit)}", value)
    return math.radians(float(number)) if factor == DEGREES else float(Decimal(number) * Decimal(factor))


def parts(value: Any) -> tuple[float, str] | None:
    """Return the number and the unit of a number or a text such as ``"20 mm"``, None if it is neither."""
    if isinstance(value, Real) and not isinstance(value, bool):
        try:
            return float(value), ""
        except OverflowError:
            return math.inf, ""
    match = _NUMBER.fullmatch(value) if isinstance(value, str) else None
    return (float(match[1]), match[2]) if match else None


def unit_of(spelling: str) -> str | None:
    """Return the SI unit of a spelling such as ``"mm"``, None if unknown."""
    plain = spelling.replace("²", "2").replace("³", "3")
    return next((unit for unit, spellings in UNITS.items() if plain in spellings), None)


def is_quantity(value: Any, unit: str) -> bool:
    """Return whether a value is a number in some unit of the dimension of `unit`."""
    try:
        quantity(value, unit)
    except ValueError:
        return False
    return True


def _finite(number: Real | float, name: str, value: Any) -> float:
    try:
        if math.isfinite(number):
            return float(number)
    except OverflowError:
        pass
    raise ArgumentError(name, "be finite", value)


def _units(unit: str) -> str:
    spellings = [word for word in UNITS[unit] if word.isascii()]
    return "" if unit == "1" else f" in {' or '.join(filter(None, [', '.join(spellings[:-1]), spellings[-1]]))}"
