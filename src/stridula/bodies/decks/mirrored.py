"""Elements whose corners are in the other sense: each format has its own."""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from .deck import CORNERS

# Order of the nodes of the mirrored element, by kind; those with middle nodes begin with that of the corners.
MIRRORS = {
    "tetra": (0, 2, 1, 3, 6, 5, 4, 7, 9, 8),
    "pyramid": (0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10),
    "hexahedron": (
        *(0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17),
        *(22, 23, 20, 21, 24, 25, 26),
    ),
    "wedge": (0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13),
}
# Number of corners of the first face.
BASES = {"tetra": 3, "pyramid": 4, "hexahedron": 4, "wedge": 3}


def right_handed(kind: str, nodes: Array, points: Array) -> Array:
    """Return elements of which those with corners in the other sense are mirrored.

    Parameters
    ----------
    kind : str
        Their kind, as in `Block`.
    nodes : ndarray of int, shape (elements, nodes of one)
        Indices of their points, in the order of VTK up to the sense.
    points : ndarray, shape (points, 3)
        Places.
    """
    plain = kind.rstrip("0123456789")
    base, top = points[nodes[:, : BASES[plain]]], points[nodes[:, BASES[plain] : CORNERS[plain]]]
    middle = base.mean(axis=1)
    normal = np.cross(base - middle[:, None], np.roll(base, -1, axis=1) - middle[:, None]).sum(axis=1)
    is_left_handed = np.sum(normal * (top.mean(axis=1) - middle), axis=1) < 0.0
    return np.where(is_left_handed[:, None], nodes[:, MIRRORS[plain][: nodes.shape[1]]], nodes)
