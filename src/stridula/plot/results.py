"""Check of the results of studies that figures draw."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import xarray as xr

from ..checks import ArgumentError, instance, listed


def check_result(name: str, value: Any, function: str, needed: Sequence[str]) -> None:
    """Raise ArgumentError unless an argument is a Dataset with the variables that a function returns."""
    instance(name, value, xr.Dataset)
    if any(one not in value for one in needed):
        raise ArgumentError(name, f"be the result of {function}", value, got=listed(map(str, value.data_vars)))
