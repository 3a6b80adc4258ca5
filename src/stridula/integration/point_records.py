"""Compact records of the points of surfaces at every sample, for regimes and sound."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import Array
from ..records.by_point import OF_POINTS, POINT, WHOLE, counted
from ..records.dataset import OVER_TIME
from ..records.variables import STATUS_SHARE, attributes_of


def kinds_of(steps: int) -> dict[str, tuple[tuple[int, ...], Any]]:
    """Return shape and type of the variables of a point for sample intervals of a number of steps."""
    return {
        "normal_force": ((), np.float32),
        "tangential_force": ((2,), np.float32),
        STATUS_SHARE.name: ((3,), np.uint8),
        "landings": ((), np.min_scalar_type(steps)),
    }


def bytes_of(steps: int) -> int:
    """Return the number of bytes of these variables."""
    return sum(math.prod(after) * np.dtype(kind).itemsize for after, kind in kinds_of(steps).values())


class PointRecord:
    """Forces in single precision, status shares and landings of points, chunk by chunk.

    Parameters
    ----------
    samples : int
        Samples of the run.
    points : int
        Number of points.
    steps : int
        Steps in a sample interval.
    """

    def __init__(self, samples: int, points: int, steps: int) -> None:
        self._kept: dict[str, Array] = {
            name: np.empty((samples, points, *after), kind) for name, (after, kind) in kinds_of(steps).items()
        }
        self._done = 0

    def take(self, normal: Array, tangential: Array, share: Array, landings: Array) -> None:
        """Record a chunk: forces [N], (samples, points) and along both tangents; shares, and landings."""
        here = slice(self._done, self._done + len(normal))
        for name, values in zip(OF_POINTS, (normal, tangential, counted(share), landings), strict=True):
            self._kept[name][here] = values
        self._done = here.stop

    def variables(self) -> dict[str, Any]:
        """Return the variables of a Dataset, with dimensions and attributes."""
        after = {"tangential_force": ("tangent",), STATUS_SHARE.name: ("contact_status",)}
        found = {}
        for name, values in self._kept.items():
            words = attributes_of(OVER_TIME[name])
            if name == STATUS_SHARE.name:
                words["units"] = f"1/{WHOLE}"
            found[POINT + name] = (("time", "point", *after.get(name, ())), values[: self._done], words)
        return found
