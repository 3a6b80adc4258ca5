"""Modal damping ratios as they are given: one for every mode, or one for each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..checks import brief, non_negative
from .modes import Array

Damping = float | Sequence[float] | Array


def checked_damping(given: Any) -> float | tuple[float, ...]:
    """Return one ratio, or one for each mode.

    Raises
    ------
    ValueError
        If a ratio is not from 0 to 1, 1 excluded.
    """
    if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str):
        if np.ndim(given) != 1:
            raise ValueError(f"damping must be one ratio or a list of one for each mode, got {brief(given)}")
        return tuple(_ratio(f"damping[{number}]", ratio) for number, ratio in enumerate(np.asarray(given).tolist()))
    return _ratio("damping", given)


def _ratio(name: str, value: Any) -> float:
    if non_negative(name, value) >= 1.0:
        raise ValueError(f"{name} must be below 1 (critical), got {brief(value)}")
    return float(value)


def check_damping_count(damping: float | tuple[float, ...], modes: int) -> None:
    """Raise ValueError unless there is a ratio for each mode, or one for all."""
    if isinstance(damping, tuple) and len(damping) != modes:
        raise ValueError(f"damping must have one ratio or {modes}, one for each mode kept, got {len(damping)}")


def damping_of_modes(damping: Damping, modes: int) -> Array:
    """Return the ratio of every mode, shape (modes,)."""
    return np.array(np.broadcast_to(np.asarray(damping, dtype=float), (modes,)))
