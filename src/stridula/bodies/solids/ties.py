"""Ties: faces of a mesh whose nodes move with another face, without sharing nodes with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy  # its parts are imported on first use
import scipy.sparse

from ...arrays import Array
from ...checks import ArgumentError
from ...long_tasks import check_wanted
from .elements import shape_functions, volumes
from .kinds import ElementKind
from .places import local_places

if TYPE_CHECKING:
    from .solid_mesh import SolidMesh

# Largest distance of a tied node from the other face, relative to the size of the element there: usual and in any case.
NEAR, FARTHEST = 0.05, 0.5
# Bulge of a curved face of an element beyond its nodes, relative to its radius.
BULGE = 0.2
# Shares of nodes that are due to rounding.
NOTHING = 1e-12
# Size of the elements that follow over those that they follow, from which the order of a tie is doubted.
COARSER = 1.25
# Places that are sought at once, to bound the memory.
AT_ONCE = 2048


@dataclass(frozen=True, eq=False)
class Dependence:
    """How the nodes of a mesh follow each other through its ties.

    Attributes
    ----------
    shares : csr_array, shape (nodes, nodes)
        Share of each node in the displacement of each; rows of nodes that follow none are those of the unit matrix.
    hidden : ndarray of int, shape (faces, 2)
        Tied faces of elements, which are within the body: numbers of the element and its face.
    doubts : tuple of str
        What is probably mistaken.
    """

    shares: Any
    hidden: Array
    doubts: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Opposite:
    """Places opposite a face.

    Attributes
    ----------
    nodes : ndarray of int, shape (places, nodes of one)
        Nodes of the element at the face.
    shares : ndarray, shape (places, nodes of one)
        Values of its shape functions at the place, also slightly outside of it.
    distance : ndarray, shape (places,)
        Distance from the face [m], infinite where it is far away.
    is_near : ndarray of bool, shape (places,)
        Whether it is within the tolerance.
    """

    nodes: Array
    shares: Array
    distance: Array
    is_near: Array


def dependence_of(mesh: SolidMesh) -> Dependence:
    """Return how nodes follow each other; a node that follows others already keeps its first tie.

    Raises
    ------
    ValueError
        If faces are too far apart, or if all nodes of a face follow others already.
    """
    shares = scipy.sparse.eye_array(len(mesh.nodes), format="csr")
    hidden, doubts = [np.zeros((0, 2), dtype=np.int64)], list[str]()
    for number, (first, second) in enumerate(mesh.ties):
        nodes = mesh.nodes_of(second)
        found = opposite(mesh, first, mesh.nodes[nodes])
        near = found.is_near
        if not near.any():
            raise _too_far(mesh, number, found)
        of_near = np.repeat(np.arange(near.sum()), found.shares.shape[1])
        entries = found.shares[near].ravel(), (of_near, found.nodes[near].ravel())
        rows = scipy.sparse.csr_array(entries, shape=(int(near.sum()), len(mesh.nodes)))
        followed = _followed(shares, nodes[near], rows)
        if followed is None:
            got = f"{second!r}, whose nodes follow others already, or are followed by {first!r}"
            raise ArgumentError(f"ties[{number}]", "name a second face that is free to follow the first", got=got)
        shares = followed
        hidden += [_covered(mesh, first, second), _covered(mesh, second, first)]
        doubts += _doubts(mesh, first, second, near)
    return Dependence(shares, np.unique(np.concatenate(hidden), axis=0), tuple(doubts))


def opposite(mesh: SolidMesh, name: str, places: Array) -> Opposite:
    """Return the elements of a face at places, shape (places, 3), and their shape functions there.

    Shape functions are those at the place itself, not at its projection on the face: rigid motions and uniform strains
    are exact at any distance.
    """
    facets, face, width = mesh.faces[name], mesh.face(name), mesh.elements.shape[1]
    ours = mesh.nodes[face.nodes]
    middle = ours.mean(axis=1)
    radius = np.linalg.norm(ours - middle[:, None], axis=2).max(axis=1)
    depth = volumes(mesh.element_kind, mesh.nodes, mesh.elements[facets[:, 0]]) / face.area
    size = np.minimum(np.sqrt(face.area), 3.0 * depth if len(mesh.element_kind.corners) == 4 else depth)
    allowed = NEAR * size if mesh.tolerance is None else np.minimum(mesh.tolerance, FARTHEST * size)
    reach = (1.0 + BULGE) * radius + allowed
    tree = scipy.spatial.cKDTree(middle)
    nodes = np.zeros((len(places), width), dtype=np.int64)
    shares, distance = np.zeros((len(places), width)), np.full(len(places), np.inf)
    is_near = np.zeros(len(places), dtype=bool)
    for start in range(0, len(places), AT_ONCE):
        check_wanted()
        near = tree.query_ball_point(places[start : start + AT_ONCE], reach.max())
        pairs = [(start + place, facet) for place, those in enumerate(near) for facet in those]
        which, facet = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
        close = np.linalg.norm(places[which] - middle[facet], axis=1) <= reach[facet]
        which, facet = which[close], facet[close]
        those = mesh.elements[facets[facet, 0]]
        local = local_places(mesh.element_kind, mesh.nodes[those], places[which])
        on_face, _ = shape_functions(mesh.element_kind, _onto_face(mesh.element_kind, facets[facet, 1], local))
        apart = np.linalg.norm(places[which] - np.einsum("pn,pni->pi", on_face, mesh.nodes[those]), axis=1)
        order = np.lexsort([apart, which])
        # The nearest face of each place.
        best = order[np.unique(which[order], return_index=True)[1]]
        which = which[best]
        values, _ = shape_functions(mesh.element_kind, local[best])
        nodes[which], distance[which], is_near[which] = those[best], apart[best], apart[best] <= allowed[facet[best]]
        shares[which] = np.where(np.abs(values) > NOTHING, values, 0.0)
    return Opposite(nodes, shares, distance, is_near)


def _onto_face(kind: ElementKind, side: Array, local: Array) -> Array:
    """Return places on faces of the unit element near those given, shape (places, 3)."""
    if len(kind.corners) == 4:
        corners = np.clip(np.column_stack([1.0 - local.sum(axis=1), local]), 0.0, None)
        corners[np.arange(len(local)), np.array([6 - sum(face) for face in kind.faces])[side]] = 0.0
        return np.asarray(corners[:, 1:] / np.maximum(corners.sum(axis=1), NOTHING)[:, None])
    ends = np.array(kind.corners)[np.array(kind.faces)[side]]
    return np.clip(local, ends.min(axis=1), ends.max(axis=1))


def _followed(shares: Any, nodes: Array, rows: Any) -> Any:
    """Return shares in which further nodes follow others by their rows; None if none of them is free to do so."""
    free = shares.diagonal()[nodes] == 1.0
    nodes, rows = nodes[free], (rows @ shares)[free]
    # Nodes that would follow themselves lead; so do, then, those that would follow others of them.
    for measure in (lambda own: own.diagonal(), lambda own: own.sum(axis=1)):
        free = measure(abs(rows[:, nodes])) == 0.0
        nodes, rows = nodes[free], rows[free]
    if not nodes.size:
        return None
    count = shares.shape[0]
    stay = np.ones(count)
    stay[nodes] = 0.0
    placed = scipy.sparse.csr_array((np.ones(nodes.size), (nodes, np.arange(nodes.size))), shape=(count, nodes.size))
    found = shares @ (scipy.sparse.diags_array(stay) + placed @ rows)
    found.eliminate_zeros()
    return found.tocsr()


def _covered(mesh: SolidMesh, name: str, other: str) -> Array:
    """Return the faces of elements whose middle lies on another face, shape (faces, 2)."""
    kind, (element, side) = mesh.element_kind, mesh.faces[name].T
    middles = np.array([kind.nodes[list(face)].mean(axis=0) for face in kind.faces])
    values, _ = shape_functions(kind, middles)
    places = np.einsum("fn,fni->fi", values[side], mesh.nodes[mesh.elements[element]])
    return mesh.faces[name][opposite(mesh, other, places).is_near]


def _too_far(mesh: SolidMesh, number: int, found: Opposite) -> ArgumentError:
    first, second = mesh.ties[number]
    distance = float(found.distance.min())
    if not np.isfinite(distance):
        ours, theirs = (mesh.nodes[mesh.nodes_of(name)] for name in (first, second))
        distance = float(scipy.spatial.cKDTree(ours).query(theirs)[0].min())
    got = f"{second!r} {distance:.3g} m from {first!r}; are both in place, in the same unit?"
    near = f"{NEAR:.0%} of" if mesh.tolerance is None else f"{mesh.tolerance:.3g} m and half"
    return ArgumentError(f"ties[{number}]", f"name faces within {near} an element of each other", got=got)


def _doubts(mesh: SolidMesh, first: str, second: str, near: Array) -> list[str]:
    """Return what is doubtful in a tie: a part that is not tied, or a coarse face that follows a fine one."""
    found = list[str]()
    if not near.all():
        found.append(f"{second!r} is tied to {first!r} at {near.sum()} of its {near.size} nodes; the rest is free")
    ours, theirs = (mesh.face(name).area.mean() for name in (first, second))
    coarser = float(np.sqrt(theirs / ours))
    if coarser > COARSER:
        sizes = f"elements at {second!r} are {coarser:.2g} times as large as those at {first!r}"
        found.append(f"{sizes}, which they follow; did you mean to tie ({second!r}, {first!r})?")
    return found
