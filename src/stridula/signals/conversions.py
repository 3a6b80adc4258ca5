"""Calibration of channels: factors, conversions of units, and sensitivities of sensors."""

from __future__ import annotations

import re
from typing import Any

from ..checks import ArgumentError, finite
from ..doubtful import warn_of
from .channels import UNKNOWN, plain_units

# Kinds of quantities, and their units in SI.
UNITS: dict[str, tuple[str, float]] = {
    **{
        word: ("acceleration", size) for word, size in (("m/s2", 1.0), ("mm/s2", 1e-3), ("g", 9.80665), ("gn", 9.80665))
    },
    **{word: ("velocity", size) for word, size in (("m/s", 1.0), ("cm/s", 1e-2), ("mm/s", 1e-3), ("µm/s", 1e-6))},
    **{word: ("displacement", size) for word, size in (("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("µm", 1e-6))},
    **{
        word: ("pressure", size)
        for word, size in (("Pa", 1.0), ("mPa", 1e-3), ("hPa", 1e2), ("kPa", 1e3), ("MPa", 1e6))
    },
    "bar": ("pressure", 1e5),
    **{word: ("force", size) for word, size in (("N", 1.0), ("mN", 1e-3), ("kN", 1e3))},
    **{word: ("voltage", size) for word, size in (("V", 1.0), ("mV", 1e-3), ("µV", 1e-6))},
    **{word: ("current", size) for word, size in (("A", 1.0), ("mA", 1e-3))},
    **{word: ("charge", size) for word, size in (("C", 1.0), ("nC", 1e-9), ("pC", 1e-12))},
}
# Outputs of sensors, which a calibration turns into what they measure.
OUTPUTS = ("voltage", "current", "charge")
SENSITIVITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([^\d\s/()]+)\s*/\s*(.+?)\s*$")
# Relative difference of a factor from that between its units above which it is doubtful.
ROUNDING = 0.01


def factor_of(name: str, units: str, given: Any, wanted: str | None) -> tuple[float, str]:
    """Return the factor of a channel and the units of the result.

    Parameters
    ----------
    name, units : str
        The channel and its units.
    given : float, str or None
        Value of a sample of 1 in the units of the result, or a sensitivity such as ``"100 mV/g"``.
    wanted : str or None
        Units of the result.

    Raises
    ------
    ValueError
        If they do not fit.
    """
    if wanted is not None and (not isinstance(wanted, str) or not wanted.strip()):
        raise ArgumentError("units", "be a text, such as 'm/s2'", wanted)
    plain = None if wanted is None else plain_units(wanted)
    if isinstance(given, str):
        return _of_sensor(name, units, given, plain)
    if given is None:
        if plain is None or units in (UNKNOWN, plain):
            return 1.0, plain or units
        ratio = _ratio(units, plain)
        if ratio is None:
            raise ArgumentError("calibration", f"be given to turn {units!r} into {plain!r}", got="none")
        return ratio, plain
    if plain is None:
        raise ArgumentError("units", f"be given with the calibration of {name!r}", got="none")
    size = finite("calibration", given)
    if size == 0.0:
        raise ArgumentError("calibration", "differ from 0", given)
    if units == plain:
        allowed = f"be left out for {name!r}, which the file has in {units}: it would be scaled twice"
        raise ArgumentError("calibration", allowed, given)
    warn_of(_doubts(name, units, size, plain))
    return size, plain


def _ratio(units: str, wanted: str) -> float | None:
    """Return a unit in another one of the same quantity, None for others."""
    one, other = UNITS.get(units), UNITS.get(wanted)
    return one[1] / other[1] if one and other and one[0] == other[0] else None


def _doubts(name: str, units: str, size: float, wanted: str) -> list[str]:
    """Return a doubt about a factor between units of different quantities, or one other than that between units."""
    one, other = UNITS.get(units), UNITS.get(wanted)
    if not one or not other or one[0] in OUTPUTS:
        return []
    if one[0] != other[0]:
        article = {key: f"{'an' if key[0] == 'a' else 'a'} {key}" for key in (one[0], other[0])}
        return [f"calibration turns {name!r}, {article[one[0]]} in {units}, into {article[other[0]]} in {wanted}"]
    exact = one[1] / other[1]
    if abs(size / exact - 1.0) <= ROUNDING:
        return []
    return [f"calibration of {name!r} is {size:g}, but 1 {units} is {exact:g} {wanted}; leave it out to convert units"]


def _of_sensor(name: str, units: str, given: str, wanted: str | None) -> tuple[float, str]:
    """Return factor and units of a sensitivity, such as 100 mV/g, of a channel with the output of the sensor."""
    match = SENSITIVITY.fullmatch(given)
    output, quantity = (plain_units(match[2]), plain_units(match[3].strip("() "))) if match else ("", "")
    kind = UNITS.get(output, ("", 0.0))[0]
    if not match or kind not in OUTPUTS or UNITS.get(quantity, (OUTPUTS[0], 0.0))[0] in OUTPUTS:
        raise ArgumentError("calibration", "be a number, or a sensitivity such as '100 mV/g' or '50 mV/Pa'", given)
    size = finite("calibration", float(match[1]))
    if size == 0.0:
        raise ArgumentError("calibration", "differ from 0", given)
    into = _ratio(units, output)
    if into is None:
        allowed = f"be a number for {name!r}, whose units are {units}: a sensitivity in {output} takes a {kind}"
        raise ArgumentError("calibration", allowed, given)
    result = wanted or quantity
    ratio = 1.0 if result == quantity else _ratio(quantity, result)
    if ratio is None:
        raise ArgumentError("units", f"be those of {quantity}, as in the calibration", wanted)
    return into / size * ratio, result
