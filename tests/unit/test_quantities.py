"""Quantities with units and numbers in scenarios."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from stridula.scenarios.quantities import quantity


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("45 deg", "rad", math.pi / 4),
        ("1 cm/s", "m/s", 0.01),
        ("20 mm", "m", 0.020),
        ("9.8mm", "m", 0.0098),
        ("5 us", "s", 5e-6),
        ("15 kHz", "Hz", 15e3),
        ("2.1e11", "Pa", 2.1e11),
        ("210 GPa", "Pa", 2.1e11),
        ("-3 N", "N", -3.0),
        ("7.8 g/cm³", "kg/m3", 7800.0),
        ("75.5e-2 %", "1", 0.00755),
        (np.float32(0.5), "m", 0.5),
        (3, "m", 3.0),
    ],
)
def test_quantities_become_exact_si(text, unit, expected):
    assert quantity(text, unit) == expected


@given(some.floats(allow_nan=False, allow_infinity=False))
def test_every_number_is_read_as_python_reads_it(number):
    assert quantity(repr(number), "m") == number
    assert quantity(f"{number!r} m", "m") == number


@pytest.mark.parametrize("value", ["20 mm", "x", "", "1 2", "0x10", True, None, [1.0], "1e5 rad/s"])
def test_a_quantity_of_another_dimension_is_refused(value):
    with pytest.raises(ValueError, match="must be a number in rad or deg"):
        quantity(value, "rad")


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e999", math.nan, math.inf, 10**400])
def test_a_quantity_must_be_finite(value):
    with pytest.raises(ValueError, match="must be finite"):
        quantity(value, "m")
