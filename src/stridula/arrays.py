"""Types of arrays for annotations."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def in_space(vector: Array) -> Array:
    """Return a vector with three components, shape (3,): one in the plane gets a third of zero."""
    found: Array = np.pad(vector, (0, 3))[:3]
    return found
