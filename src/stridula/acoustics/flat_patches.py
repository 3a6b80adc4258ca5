"""Integrals over flat patches in closed form.

Integrals of 1 / R and of x . n / R³, with x from a place to a point of the patch and R = |x|, edge by edge (Wilton et
al. 1984, IEEE Trans. Antennas Propag. 32, 276-281). The latter is the solid angle of the patch, positive from behind.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array

# Fraction of the size of a patch below which edges have no length and places lie on the line of an edge.
NONE = 1e-12
# Fraction of the size of a patch within which a place lies in its plane.
FLAT = 1e-9


def patch_integrals(places: Array, corners: Array) -> tuple[Array, Array]:
    """Return the integrals of 1 / R [m] and of x . n / R³ over patches, one for each place, shape (places,) each.

    Parameters
    ----------
    places : ndarray, shape (places, 3)
        Places [m].
    corners : ndarray, shape (places, 4, 3)
        Corners of the patches, round their normals [m]; two may coincide.
    """
    first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normals = np.cross(first, second)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    height = ((corners.mean(axis=1) - places) * normals).sum(axis=1)
    foot, above = places + height[:, None] * normals, np.abs(height)
    least = NONE * np.linalg.norm(first, axis=1)
    inverse, angle = np.zeros((2, len(places)))
    for start, end in zip(np.moveaxis(corners, 1, 0), np.moveaxis(np.roll(corners, -1, axis=1), 1, 0), strict=True):
        edge = end - start
        length = np.linalg.norm(edge, axis=1)
        along = edge / np.maximum(length, least)[:, None]
        outward = ((start - foot) * np.cross(along, normals)).sum(axis=1)
        low, high = (((one - foot) * along).sum(axis=1) for one in (start, end))
        from_edge = outward**2 + above**2
        near, far = np.sqrt(from_edge + low**2), np.sqrt(from_edge + high**2)
        counts = (length > least) & (np.abs(outward) > least)
        turn = np.arctan2(outward * high, from_edge + above * far) - np.arctan2(outward * low, from_edge + above * near)
        turn = np.where(counts, turn, 0.0)
        beside = np.where(counts, np.sqrt(from_edge), 1.0)
        rise = np.where(counts, np.arcsinh(high / beside) - np.arcsinh(low / beside), 0.0)
        inverse += outward * rise - above * turn
        angle += turn
    # From within its plane a patch has no solid angle.
    return inverse, np.where(above > FLAT * np.linalg.norm(first, axis=1), np.sign(height), 0.0) * angle
