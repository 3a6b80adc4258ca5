"""Quality of the elements of meshes in space."""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from .kinds import ElementKind

# Scaled Jacobian below which an element is a sliver: meshes for finite elements should have none.
SLIVER = 0.2


def scaled_jacobians(kind: ElementKind, nodes: Array, elements: Array) -> Array:
    """Return the scaled Jacobian of each element: 1 for cubes and regular tetrahedra, 0 for flat elements.

    It is the least determinant of the unit vectors along the edges at a corner, for hexahedra also along the axes of
    the element, relative to that of the regular element. Nodes in the middle of edges do not count.

    Parameters
    ----------
    kind : ElementKind
        Kind of the elements.
    nodes : ndarray, shape (nodes, 3)
        Coordinates [m].
    elements : ndarray, shape (elements, nodes of one)
        Numbers of their nodes in the order of VTK.

    References
    ----------
    C. J. Stimpson et al., The Verdict Geometric Quality Library, SAND2007-1751.
    """
    corners, unit = nodes[elements[:, : len(kind.corners)]], np.array(kind.corners, dtype=float)
    found = []
    for corner in range(len(unit)):
        others = [sum(edge) - corner for edge in kind.edges if corner in edge]
        if np.linalg.det(unit[others] - unit[corner]) < 0.0:
            others = others[::-1]
        found.append(_of_vectors(corners[:, others] - corners[:, corner, None]))
    if len(unit) == 4:
        # The edges of a regular tetrahedron have a determinant of 1/sqrt(2).
        return np.asarray(np.sqrt(2.0) * np.min(found, axis=0))
    signs = 2.0 * (unit - unit.mean(axis=0))
    found.append(_of_vectors(np.einsum("ca,eci->eai", signs, corners)))
    return np.asarray(np.min(found, axis=0))


def _of_vectors(vectors: Array) -> Array:
    """Return the determinants of three vectors over their lengths, shape (elements,)."""
    lengths = np.linalg.norm(vectors, axis=2).prod(axis=1)
    return np.asarray(np.linalg.det(vectors) / np.where(lengths > 0.0, lengths, 1.0))
