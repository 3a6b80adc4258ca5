"""Lines as which bodies of the plane are drawn: places along them."""

from __future__ import annotations

import numpy as np

from ..arrays import Array

# Pieces of a line, so that it is smooth and not drawn finer than a picture is.
FEWEST_PIECES, MOST_PIECES = 20, 400


def places_between(ends: tuple[float, float], pieces: int) -> Array:
    """Return places from one end to the other [m], with a number of pieces between them where that can be drawn."""
    return np.linspace(*ends, min(max(pieces, FEWEST_PIECES), MOST_PIECES) + 1)
