"""Kinds of elements in space: coordinates of their nodes, and the nodes of their edges and faces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array

Numbers = tuple[tuple[int, ...], ...]

_TETRA = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
_TETRA_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_TETRA_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
_HEXA = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
_HEXA_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
# In VTK's order of the nodes in the middle of faces; corners counter-clockwise about the outward normal.
_HEXA_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))


@dataclass(frozen=True)
class ElementKind:
    """A kind of elements, its nodes in the order of VTK: corners, middles of edges, of faces, of the element.

    Attributes
    ----------
    name : str
        Name in meshio.
    words : str
        Name in messages.
    corners : tuple
        Coordinates of the corners in the unit element.
    edges, faces : tuple
        Numbers of the corners of each edge and of each face, the latter counter-clockwise about the outward normal.
    middles : int
        Nodes besides corners: 0 for none; 1 for middles of edges; 2 also for middles of faces and of the element.
    finite_element : str
        Name of its class in scikit-fem.
    quadratic : str
        Kind with nodes in the middle of edges, itself if it has them.
    """

    name: str
    words: str
    corners: Numbers
    edges: Numbers
    faces: Numbers
    middles: int
    finite_element: str
    quadratic: str

    @cached_property
    def nodes(self) -> Array:
        """Coordinates of the nodes in the unit element, shape (nodes, 3)."""
        corners = np.array(self.corners, dtype=float)
        found = [corners]
        if self.middles:
            found.append(np.array([corners[list(edge)].mean(axis=0) for edge in self.edges]))
        if self.middles == 2:
            found.append(np.array([corners[list(face)].mean(axis=0) for face in self.faces]))
            found.append(corners.mean(axis=0)[None])
        return np.vstack(found)

    @cached_property
    def face_nodes(self) -> Array:
        """Node numbers of each face, shape (faces, nodes): corners, then midpoints of edges, then the centre."""
        pairs = [frozenset(edge) for edge in self.edges]
        found = []
        for number, face in enumerate(self.faces):
            nodes = list(face)
            if self.middles:
                round_it = zip(face, (*face[1:], face[0]), strict=True)
                nodes += [len(self.corners) + pairs.index(frozenset(pair)) for pair in round_it]
            if self.middles == 2:
                nodes.append(len(self.corners) + len(self.edges) + number)
            found.append(nodes)
        return np.array(found)


_TETRAHEDRA = (_TETRA, _TETRA_EDGES, _TETRA_FACES)
_HEXAHEDRA = (_HEXA, _HEXA_EDGES, _HEXA_FACES)
KINDS = {
    kind.name: kind
    for kind in (
        ElementKind("tetra", "tetrahedra of 4 nodes", *_TETRAHEDRA, 0, "ElementTetP1", "tetra10"),
        ElementKind("tetra10", "tetrahedra of 10 nodes", *_TETRAHEDRA, 1, "ElementTetP2", "tetra10"),
        ElementKind("hexahedron", "hexahedra of 8 nodes", *_HEXAHEDRA, 0, "ElementHex1", "hexahedron20"),
        ElementKind("hexahedron20", "hexahedra of 20 nodes", *_HEXAHEDRA, 1, "ElementHexS2", "hexahedron20"),
        ElementKind("hexahedron27", "hexahedra of 27 nodes", *_HEXAHEDRA, 2, "ElementHex2", "hexahedron27"),
    )
}


# Words of elements of any kind, and their number of corners.
_WORDS = {
    "tetra": ("tetrahedra", 4),
    "hexahedron": ("hexahedra", 8),
    "wedge": ("wedges", 6),
    "pyramid": ("pyramids", 5),
}


def words_of(kind: str) -> str:
    """Return the name of a kind for messages from its name in meshio."""
    plain = kind.rstrip("0123456789")
    words, corners = _WORDS.get(plain, (plain, 0))
    return f"{words} of {kind.removeprefix(plain) or corners} nodes"


def outer_faces(kind: ElementKind, elements: Array) -> Array:
    """Return the faces that belong to one element only: numbers of the element and its face, shape (faces, 2)."""
    corners = np.sort(elements[:, np.array(kind.faces)], axis=2).reshape(-1, len(kind.faces[0]))
    _, which, times = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    return np.stack(np.divmod(np.flatnonzero(times[which.ravel()] == 1), len(kind.faces)), axis=1)
