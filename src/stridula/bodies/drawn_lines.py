"""Places along the lines that represent bodies in the plane in drawings."""

from __future__ import annotations

import numpy as np

from ..arrays import Array

# Pieces of a line: enough for a smooth line, not finer than a picture.
FEWEST_PIECES, MOST_PIECES = 20, 400


def places_between(ends: tuple[float, float], pieces: int) -> Array:
    """Return places from one end to the other [m], for a number of pieces within the limits of a drawing."""
    return np.linspace(*ends, min(max(pieces, FEWEST_PIECES), MOST_PIECES) + 1)
