"""Wedges, pyramids and mixtures of kinds cut into tetrahedra that fit those of their neighbours."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError
from .kinds import KINDS, Numbers, outer_faces

_WEDGE_EDGES = ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))
_WEDGE_FACES = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
_PYRAMID_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4))
_PYRAMID_FACES = ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))


@dataclass(frozen=True)
class CutKind:
    """A kind of elements that can be cut: edges and faces by their corners, faces counter-clockwise from outside.

    Attributes
    ----------
    words : str
        Name in messages.
    corners : int
        Number of corners.
    edges, faces : tuple
        Numbers of the corners of each.
    through : tuple
        Pairs of opposite corners of the element.
    has_middles : bool
        Whether there are also nodes in the middle of edges.
    """

    words: str
    corners: int
    edges: Numbers
    faces: Numbers
    through: Numbers
    has_middles: bool


def _both_orders(
    first: str, second: str, words: str, edges: Numbers, faces: Numbers, through: Numbers
) -> Mapping[str, CutKind]:
    corners = 1 + max(max(edge) for edge in edges)
    return {
        first: CutKind(f"{words} of {corners} nodes", corners, edges, faces, through, False),
        second: CutKind(f"{words} of {corners + len(edges)} nodes", corners, edges, faces, through, True),
    }


_TETRA, _HEXA = KINDS["tetra"], KINDS["hexahedron"]
CUT_KINDS = {
    **_both_orders("tetra", "tetra10", "tetrahedra", _TETRA.edges, _TETRA.faces, ()),
    **_both_orders("wedge", "wedge15", "wedges", _WEDGE_EDGES, _WEDGE_FACES, ()),
    **_both_orders("pyramid", "pyramid13", "pyramids", _PYRAMID_EDGES, _PYRAMID_FACES, ()),
    **_both_orders(
        "hexahedron", "hexahedron20", "hexahedra", _HEXA.edges, _HEXA.faces, ((0, 6), (1, 7), (2, 4), (3, 5))
    ),
}


@dataclass(frozen=True, eq=False)
class CutMesh:
    """Elements cut into tetrahedra.

    Attributes
    ----------
    nodes : ndarray, shape (nodes, 3)
        Coordinates, those of nodes in the middle of cuts last.
    elements : ndarray, shape (tetrahedra, 4 or 10)
        Their nodes, in the order of VTK.
    owner : ndarray, shape (tetrahedra,)
        Number of the element that each is part of.
    ends : ndarray, shape (further nodes, 2)
        Nodes at both ends of the cut of each further node.
    """

    nodes: Array
    elements: Array
    owner: Array
    ends: Array


def can_be_cut(kinds: list[str]) -> bool:
    """Return whether elements of these kinds (names of meshio) can be cut together: all of one order."""
    return all(kind in CUT_KINDS for kind in kinds) and len({CUT_KINDS[kind].has_middles for kind in kinds}) == 1


def cut_into_tetrahedra(nodes: Array, blocks: list[tuple[str, Array]]) -> CutMesh:
    """Cut elements from their corner of the lowest number, and each face from its own (Dompierre et al. 1999).

    A face is then cut alike from both of its sides. Nodes in the middle of edges stay; further nodes are placed where
    the shape functions of the face, or of the element, have the middle of the cut.

    Parameters
    ----------
    nodes : ndarray, shape (nodes, 3)
        Coordinates.
    blocks : list
        Pairs of a kind and its elements, nodes in the order of meshio.

    Raises
    ------
    ValueError
        If a triangle of one element lies on a quadrilateral of another that is cut the other way.
    """
    corners, owner, first = [], [], 0
    for name, elements in blocks:
        for tetrahedra, those in _cut(CUT_KINDS[name], elements):
            corners.append(tetrahedra)
            owner.append(first + those)
        first += len(elements)
    found, owners = np.concatenate(corners), np.concatenate(owner)
    _check_fit(blocks, found)
    order = np.argsort(owners, kind="stable")
    found, owners = found[order], owners[order]
    if not CUT_KINDS[blocks[0][0]].has_middles:
        return CutMesh(nodes, found, owners, np.zeros((0, 2), dtype=np.int64))
    return _with_middles(nodes, blocks, found, owners)


def triangles_of(quadrilaterals: Array) -> Array:
    """Return the two triangles that each face of four corners is cut into, shape (faces, 2, 3)."""
    lowest = quadrilaterals.argmin(axis=1)
    turned = np.take_along_axis(quadrilaterals, (lowest[:, None] + np.arange(4)) % 4, axis=1)
    return turned[:, [[0, 1, 2], [0, 2, 3]]]


def _cut(kind: CutKind, elements: Array) -> Iterator[tuple[Array, Array]]:
    """Yield the corners of tetrahedra, and the elements that they are part of."""
    lowest = elements[:, : kind.corners].argmin(axis=1)
    for corner in range(kind.corners):
        those = np.flatnonzero(lowest == corner)
        for face in kind.faces:
            if corner in face or not those.size:
                continue
            sides = elements[those][:, list(face)]
            triangles = sides[:, None] if len(face) == 3 else triangles_of(sides)
            for number in range(triangles.shape[1]):
                # Seen from the top of a tetrahedron its base goes round the other way.
                yield np.column_stack([triangles[:, number, ::-1], elements[those, corner]]), those


def _check_fit(blocks: list[tuple[str, Array]], corners: Array) -> None:
    """Raise ValueError where an outer triangle lies across a face that is cut the other way."""
    quadrilaterals = [
        elements[:, list(face)] for name, elements in blocks for face in CUT_KINDS[name].faces if len(face) == 4
    ]
    faces = np.concatenate([np.zeros((0, 4), dtype=np.int64), *quadrilaterals])
    across = np.roll(triangles_of(faces).reshape(-1, 6)[:, [0, 1, 2, 5]], -1, axis=1)
    element, side = outer_faces(_TETRA, corners).T
    outer = np.sort(corners[element[:, None], np.array(_TETRA.faces)[side]], axis=1)
    # Round a face from its lowest corner a: abc and acd are its triangles, bcd and bda those across.
    others = np.sort(np.concatenate([across[:, [0, 1, 2]], across[:, [0, 2, 3]]]), axis=1)
    both = np.concatenate([np.unique(outer, axis=0), np.unique(others, axis=0)])
    _, times = np.unique(both, axis=0, return_counts=True)
    if (times > 1).any():
        raise ArgumentError(
            "path",
            "have pyramids where triangles of some elements meet quadrilaterals of others",
            got=f"{(times > 1).sum()} triangles on quadrilaterals",
        )


def _with_middles(nodes: Array, blocks: list[tuple[str, Array]], corners: Array, owner: Array) -> CutMesh:
    count = len(nodes)

    def codes(pairs: Array) -> Array:
        low, high = np.sort(pairs.reshape(-1, 2), axis=1).T
        return np.asarray(low * count + high)

    edges, middles, cuts, places = [], [], [], []
    for name, elements in blocks:
        kind = CUT_KINDS[name]
        edges.append(codes(elements[:, np.array(kind.edges)]))
        middles.append(elements[:, kind.corners :].ravel())
        for pairs, place in _middles_of_cuts(kind, nodes, elements):
            cuts.append(codes(pairs))
            places.append(place)
    known, first = np.unique(np.concatenate(edges), return_index=True)
    needed = codes(corners[:, np.array(_TETRA.edges)])
    further = np.setdiff1d(needed, known)
    cut, at = np.unique(np.concatenate([further[:0], *cuts]), return_index=True)
    between = np.concatenate([np.zeros((0, 3)), *places])[at][np.searchsorted(cut, further)]
    all_codes = np.concatenate([known, further])
    numbers = np.concatenate([np.concatenate(middles)[first], count + np.arange(further.size)])
    order = np.argsort(all_codes)
    of_edges = numbers[order][np.searchsorted(all_codes[order], needed)].reshape(-1, 6)
    ends = np.stack(np.divmod(further, count), axis=1)
    return CutMesh(np.vstack([nodes, between]), np.hstack([corners, of_edges]), owner, ends)


def _middles_of_cuts(kind: CutKind, nodes: Array, elements: Array) -> Iterator[tuple[Array, Array]]:
    """Yield pairs of corners that a cut may join, and the middle of the cut by the shape functions."""
    pairs = [frozenset(edge) for edge in kind.edges]
    for face in kind.faces:
        if len(face) == 4:
            round_it = [pairs.index(frozenset(edge)) for edge in zip(face, (*face[1:], face[0]), strict=True)]
            sides = nodes[elements[:, [kind.corners + number for number in round_it]]].sum(axis=1)
            place = 0.5 * sides - 0.25 * nodes[elements[:, list(face)]].sum(axis=1)
            for diagonal in (face[::2], face[1::2]):
                yield elements[:, list(diagonal)], place
    for across in kind.through:
        ours = nodes[elements]
        place = 0.25 * (ours[:, kind.corners :].sum(axis=1) - ours[:, : kind.corners].sum(axis=1))
        yield elements[:, list(across)], place
