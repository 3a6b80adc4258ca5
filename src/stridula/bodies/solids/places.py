"""Places within meshes and points of integration on their faces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy  # its parts are imported on first use
import scipy.sparse

from ...arrays import Array
from ...checks import ArgumentError, counted
from ...long_tasks import check_wanted
from .elements import shape_functions
from .kinds import ElementKind

if TYPE_CHECKING:
    from .solid_mesh import SolidMesh

# Shares of the size of an element: bulge of curved sides beyond its nodes, and tolerance for places outside of it.
BULGE, OUTSIDE = 0.2, 1e-6
STEPS = 30
# Points of integration and weights, exact for a uniform pressure on faces of second degree.
_LINE = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
_SQUARE = np.array([(x, y) for x in _LINE for y in _LINE]), np.full(4, 0.25)
_TRIANGLE = np.array([(1.0, 1.0), (4.0, 1.0), (1.0, 4.0)]) / 6.0, np.full(3, 1.0 / 6.0)


@dataclass(frozen=True, repr=False)
class FacePoints:
    """Contact points on a part of the surface of a mesh: points of integration, or centres of patches.

    Attributes
    ----------
    place : ndarray, shape (points, 3)
        Coordinates [m].
    area : ndarray, shape (points,)
        Areas that the points represent [m²].
    normal : ndarray, shape (points, 3)
        Outward unit normals.
    """

    place: Array
    area: Array
    normal: Array

    def __repr__(self) -> str:
        return f"FacePoints({counted(len(self.area), 'point')}, {float(self.area.sum()):.4g} m2)"


@lru_cache(maxsize=32)
def face_points(mesh: SolidMesh, name: str) -> FacePoints:
    """Return the points of integration on a group of faces: four on each quadrilateral, three on each triangle."""
    return _integrated(mesh, name)[0]


@lru_cache(maxsize=32)
def face_mean(mesh: SolidMesh, name: str) -> Array:
    """Return the share of each node in the mean over a group of faces, shape (nodes,)."""
    points, nodes, values = _integrated(mesh, name)
    shares = np.zeros(len(mesh.nodes))
    np.add.at(shares, nodes, points.area[:, None] * values)
    return shares / points.area.sum()


@lru_cache(maxsize=32)
def face_values(mesh: SolidMesh, name: str) -> Any:
    """Return the share of each node in the displacement of each point of integration, sparse, shape (points, nodes)."""
    points, nodes, values = _integrated(mesh, name)
    rows = np.repeat(np.arange(len(points.area)), values.shape[1])
    return scipy.sparse.csr_array((values.ravel(), (rows, nodes.ravel())), shape=(len(points.area), len(mesh.nodes)))


@dataclass(frozen=True, repr=False)
class Sampled(FacePoints):
    """Points of integration on the face of one element.

    Attributes
    ----------
    place, area, normal : ndarray
        As in `FacePoints`.
    nodes : ndarray of int, shape (nodes of the element,)
        Its nodes.
    values : ndarray, shape (points, nodes of the element)
        Their shape functions at the points.
    """

    nodes: Array
    values: Array


def sampled(mesh: SolidMesh, facet: Array, places: Array, weights: Array) -> Sampled:
    """Return points of the unit triangle or square, shape (points, 2), as points of a facet.

    A facet is an element and the number of its face. `weights` are shares of the unit area, whose sum is 1/2 on a
    triangle and 1 on a square.
    """
    at, first, second, values = on_facet(mesh, facet, places)
    vectors = np.cross(first, second)
    size = np.linalg.norm(vectors, axis=1)
    return Sampled(at, weights * size, vectors / size[:, None], mesh.elements[facet[0]], values)


def on_facet(mesh: SolidMesh, facet: Array, places: Array) -> tuple[Array, Array, Array, Array]:
    """Return points of the unit triangle or square on a facet: places, both slopes, and the nodes' shape functions.

    All have a row for each point. A facet is an element and the number of its face.
    """
    kind, (element, side) = mesh.element_kind, facet
    corners = kind.nodes[kind.face_nodes[side]][: len(kind.faces[side])]
    shares, along, across = _on_face(places[:, 0], places[:, 1], len(corners))
    values, slopes = shape_functions(kind, shares @ corners)
    nodes = mesh.nodes[mesh.elements[element]]
    jacobian = np.einsum("pni,nj->pij", slopes, nodes)
    first = np.einsum("pi,pij->pj", along @ corners, jacobian)
    second = np.einsum("pi,pij->pj", across @ corners, jacobian)
    return values @ nodes, first, second, values


def _integrated(mesh: SolidMesh, name: str) -> tuple[FacePoints, Array, Array]:
    """Return the points of integration, the nodes of their elements and the values of the shape functions there."""
    mesh.face(name)
    kind, found = mesh.element_kind, []
    for facet in mesh.faces[name]:
        one = sampled(mesh, facet, *(_SQUARE if len(kind.faces[0]) == 4 else _TRIANGLE))
        of_element = np.broadcast_to(one.nodes, one.values.shape)
        found.append((one.place, one.area, one.normal, of_element, one.values))
    *points, numbers, values = (np.concatenate(one) for one in zip(*found, strict=True))
    return FacePoints(*points), numbers, values


def _on_face(u: Array, v: Array, corners: int) -> tuple[Array, Array, Array]:
    """Return the shares of the corners at points of a face, and their derivatives along both sides."""
    one = np.ones_like(u)
    if corners == 3:
        return np.array([1.0 - u - v, u, v]).T, np.array([-one, one, 0.0 * u]).T, np.array([-one, 0.0 * u, one]).T
    shares = np.array([(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]).T
    return shares, np.array([v - 1.0, 1.0 - v, v, -v]).T, np.array([u - 1.0, -u, u, 1.0 - u]).T


@lru_cache(maxsize=4096)
def located(mesh: SolidMesh, place: tuple[float, float, float]) -> tuple[Array, Array]:
    """Return the nodes of the element at a place of a mesh, and their shares in its displacement.

    Raises
    ------
    ValueError
        If it is outside of the mesh.
    """
    check_wanted()
    kind, there = mesh.element_kind, np.array(place)
    low, high = _boxes(mesh)
    size = (high - low).max(axis=1)
    near = np.flatnonzero(
        ((there >= low - BULGE * size[:, None]) & (there <= high + BULGE * size[:, None])).all(axis=1)
    )
    local = local_places(kind, mesh.nodes[mesh.elements[near]], there)
    beyond = _beyond(kind, local)
    if not near.size or beyond.min() > OUTSIDE:
        raise ArgumentError("position", "be the name of a point or (x, y, z) within the mesh", place)
    # The first that holds it, else the nearest.
    best = int(np.argmin(np.maximum(beyond, 0.0)))
    return mesh.elements[near[best]], shape_functions(kind, local[best : best + 1])[0][0]


@lru_cache(maxsize=8)
def _boxes(mesh: SolidMesh) -> tuple[Array, Array]:
    nodes = mesh.nodes[mesh.elements]
    return nodes.min(axis=1), nodes.max(axis=1)


def local_places(kind: ElementKind, nodes: Array, places: Array) -> Array:
    """Return places in the unit element, by Newton's method, shape (elements, 3).

    Parameters
    ----------
    kind : ElementKind
        Kind of the elements.
    nodes : ndarray, shape (elements, nodes of one, 3)
        Coordinates of their nodes [m].
    places : ndarray, shape (elements, 3) or (3,)
        The place for each element, or for all [m].
    """
    local = np.tile(kind.nodes.mean(axis=0), (len(nodes), 1))
    for _ in range(STEPS):
        values, slopes = shape_functions(kind, local)
        apart = places - np.einsum("en,eni->ei", values, nodes)
        step = np.einsum("eji,ei->ej", np.linalg.pinv(np.einsum("eni,enj->eij", nodes, slopes)), apart)
        before, local = local, np.clip(local + step, -1.0, 2.0)
        # The error that is left is of the order of the square of the last step.
        if np.abs(local - before).max(initial=0.0) < 1e-10:
            break
    return local


def _beyond(kind: ElementKind, local: Array) -> Array:
    """Return the distance of places outside of the unit element, zero or below within it."""
    far = local.sum(axis=1) if len(kind.corners) == 4 else local.max(axis=1)
    return np.asarray(np.maximum(-local.min(axis=1), far - 1.0))
