"""What numbers can hold: sizes that neither underflow nor overflow, and counts of modes that fit into memory."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

# A hundred times what a track has that is heard: a step of so many takes a tenth of a millisecond.
MOST_MODES = 50_000
# Modes that springs and dashpots couple are marched in dense matrices.
MOST_COUPLED_MODES = 4000
ORDINARY = "numbers of ordinary size"


@contextmanager
def of_ordinary_size(names: str) -> Iterator[None]:
    """Raise ValueError, that `names` must be of ordinary size, where numbers inside overflow or divide by zero."""
    try:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            yield
    except ArithmeticError as error:
        raise ValueError(f"{names} must hold {ORDINARY}, got ones that overflow") from error


def check_first_modes(first: tuple[Any, ...], cutoff: float) -> None:
    """Raise ValueError where lowest frequencies [rad/s] are no numbers above 0, and cannot be counted to a cutoff."""
    for frequency in first:
        if not 0.0 < frequency < math.inf:
            raise ValueError(
                "material, section and length must be of ordinary size, "
                f"got a lowest mode of {float(frequency):g} rad/s below a cutoff of {cutoff!r} Hz"
            )


def check_mode_count(modes: float, cutoff: float | None) -> None:
    """Raise ValueError where a body has more than `MOST_MODES` modes."""
    if modes <= MOST_MODES:
        return
    if cutoff is None:
        raise ValueError(f"modes must be at most {MOST_MODES} in all, got {modes:.6g}")
    raise ValueError(
        f"cutoff must leave at most {MOST_MODES} modes, got {cutoff!r} Hz, below which there are {modes:.6g}"
    )


def check_coupled_count(modes: int) -> None:
    """Raise ValueError where more than `MOST_COUPLED_MODES` modes are coupled."""
    if modes > MOST_COUPLED_MODES:
        raise ValueError(
            f"connections must couple at most {MOST_COUPLED_MODES} modes, got {modes}: lower the cutoff of their bodies"
        )
