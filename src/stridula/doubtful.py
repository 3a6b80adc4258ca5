"""Warnings about values that are allowed but probably mistaken, as when the prefix of a unit is left out."""

from __future__ import annotations

import contextlib
import sys
import warnings
from collections.abc import Iterable
from pathlib import Path

# Range from soft rubber to diamond [Pa]. A value between the last number and the lower end of the range is probably in
# MPa: that of aluminium is 7e4.
MODULUS, MEGA = (1e6, 2e12), 2e3
# Size of a body [m] above which it is probably in millimetres.
LARGEST_SIZE = 50.0
# A face farther from its track than this share of its size is probably misplaced.
FARTHEST = 0.05
# Files whose frames a warning skips: this package, and the code of dataclasses and of decorators.
_PASSED = (str(Path(__file__).parent), "<", contextlib.__file__)


class DoubtfulValue(UserWarning):
    """A value that is allowed but probably mistaken: a Young's modulus in GPa, a mesh in mm."""


class LeftOut(DoubtfulValue):
    """Content of a file that is not read."""


def warn_of(doubts: Iterable[str], kind: type[DoubtfulValue] = DoubtfulValue) -> None:
    """Warn of each doubt, in the name of the line outside of the package that led to it."""
    for words in doubts:
        warnings.warn(words, kind, stacklevel=_depth())


def doubts_of_modulus(name: str, modulus: float) -> list[str]:
    """Return a doubt about an elastic modulus [Pa], none if a solid has it."""
    if MODULUS[0] <= modulus <= MODULUS[1]:
        return []
    unit = "MPa" if MEGA <= modulus < MODULUS[0] else "GPa"
    return [f"{name} of {modulus:.4g} Pa; did you mean {unit}?"]


def doubts_of_size(size: float) -> list[str]:
    """Return a doubt about the largest side of a body or a mesh [m], none if it is of ordinary size."""
    return [f"size of {size:.4g} m; did you mean mm?"] if size > LARGEST_SIZE else []


def doubts_of_gap(gap: float, size: float) -> list[str]:
    """Return a doubt about the least gap of a face [m] of a given size [m], none unless it is far from its track."""
    if gap <= FARTHEST * size:
        return []
    return [f"nothing within {gap:.4g} m of the face, {size:.4g} m in size; did you mean to move it there?"]


def _depth() -> int:
    """Return the number of frames from the caller to the first one outside of the package, for `warnings.warn`."""
    frame, depth = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PASSED):
        frame, depth = frame.f_back, depth + 1
    return depth
