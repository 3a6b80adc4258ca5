"""Arrays of numbers, as annotations name them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def in_space(vector: Array) -> Array:
    """Return a vector in the plane with a third component of zero, one in space as it is, shape (3,)."""
    found: Array = np.pad(vector, (0, 3))[:3]
    return found
