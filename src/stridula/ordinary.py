"""Checks that numbers neither underflow nor overflow, and that modes fit into memory."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from .checks import ArgumentError

# A hundred times the number of modes of a track in the audible range: a step with so many takes a tenth of a
# millisecond.
MOST_MODES = 50_000
# Modes coupled by springs and dashpots need dense matrices in the march.
MOST_COUPLED_MODES = 4000


class NotOrdinary(ArgumentError):
    """Numbers so large or so small that results from them overflow or underflow."""

    def __init__(self, names: str) -> None:
        super().__init__(names, "hold numbers of ordinary size", got="ones that overflow")

    def __reduce__(self) -> tuple[Any, ...]:
        return NotOrdinary, (self.argument,)


@contextmanager
def of_ordinary_size(names: str) -> Iterator[None]:
    """Raise NotOrdinary for `names` where numbers inside overflow, are divided by zero or have no inverse."""
    try:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            yield
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        raise NotOrdinary(names) from error


def check_overflow(*arrays: np.ndarray) -> None:
    """Raise OverflowError if an array holds values that are not finite."""
    if not all(np.isfinite(array).all() for array in arrays):
        raise OverflowError


def check_first_modes(first: tuple[Any, ...], cutoff: float) -> None:
    """Raise ValueError if a lowest frequency [rad/s] is not a finite number above 0."""
    for frequency in first:
        if not 0.0 < frequency < math.inf:
            raise ArgumentError(
                "material, section and length",
                "be of ordinary size",
                got=f"a lowest mode of {float(frequency):g} rad/s below a cutoff of {cutoff!r} Hz",
            )


def check_mode_count(modes: float, cutoff: float | None) -> None:
    """Raise ValueError if a body has more than `MOST_MODES` modes."""
    if modes <= MOST_MODES:
        return
    if cutoff is None:
        raise ArgumentError("modes", f"be at most {MOST_MODES} in all", modes, got=f"{modes:.6g}")
    raise ArgumentError(
        "cutoff", f"leave at most {MOST_MODES} modes", cutoff, got=f"{cutoff!r} Hz, below which there are {modes:.6g}"
    )


def check_coupled_count(modes: int) -> None:
    """Raise ValueError if more than `MOST_COUPLED_MODES` modes are coupled."""
    if modes > MOST_COUPLED_MODES:
        raise ArgumentError(
            "connections",
            f"couple at most {MOST_COUPLED_MODES} modes",
            got=f"{modes}: lower the cutoff of their bodies",
        )
