"""Mass and stiffness of a mesh in space, assembled by scikit-fem, which is imported on first use."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import scipy.sparse

from ...arrays import Array
from ...checks import ArgumentError
from ..matrix_input import ROUND_OFF
from ..sections import Material
from .kinds import ElementKind

# Degrees of integration, exact for the mass of quadratic elements with straight edges.
DEGREES = (2, 4, 4)
# Elements assembled at once, to bound the memory.
AT_ONCE = 2048


def check_elements(kind: ElementKind, nodes: Array, elements: Array) -> None:
    """Raise ValueError if elements do not share their nodes, or one is inverted at a point of integration."""
    _check_shared(kind, elements)
    points, _ = _integration(kind)
    element = _finite_element(kind)
    slopes = np.array([element.lbasis(points, number)[1] for number in range(len(kind.nodes))])
    ours = elements[:, _order(kind, element)]
    bad = np.zeros(len(elements), dtype=bool)
    for part in _parts(np.arange(len(elements))):
        jacobian = np.einsum("eni,njq->eqij", nodes[ours[part]], slopes)
        least = ROUND_OFF * np.linalg.norm(jacobian, axis=2).prod(axis=2)
        bad[part] = (np.linalg.det(jacobian) <= least).any(axis=1)
    if bad.any():
        first = np.flatnonzero(bad)[0]
        raise ArgumentError(
            "elements",
            "have a positive Jacobian",
            got=f"{bad.sum()} of {len(elements)} inverted or crushed, the first number {first} (from 0)",
        )


def volumes(kind: ElementKind, nodes: Array, elements: Array) -> Array:
    """Return the volume of each element [m³], shape (elements,)."""
    points, weights = _integration(kind)
    found, (_, slopes) = np.empty(len(elements)), shape_functions(kind, points.T)
    for part in _parts(np.arange(len(elements))):
        found[part] = np.linalg.det(np.einsum("eni,qnj->eqij", nodes[elements[part]], slopes)) @ weights
    return found


def shape_functions(kind: ElementKind, places: Array) -> tuple[Array, Array]:
    """Return shape functions and their derivatives at coordinates in the unit element.

    Parameters
    ----------
    kind : ElementKind
        Kind of the elements.
    places : ndarray, shape (places, 3)
        Coordinates.

    Returns
    -------
    values : ndarray, shape (places, nodes of one)
        Values, nodes in the order of VTK.
    slopes : ndarray, shape (places, nodes of one, 3)
        Derivatives along the coordinates.
    """
    element = _finite_element(kind)
    values, slopes = np.zeros((len(places), len(kind.nodes))), np.zeros((len(places), len(kind.nodes), 3))
    for number, ours in enumerate(_order(kind, element)):
        value, slope = element.lbasis(np.ascontiguousarray(places.T), number)
        values[:, ours], slopes[:, ours] = value, np.asarray(slope).T
    return values, slopes


def assembled(
    kind: ElementKind, nodes: Array, elements: Array, materials: list[tuple[Material, Array]]
) -> tuple[Any, Any]:
    """Return mass and stiffness of linear elasticity.

    Parameters
    ----------
    kind : ElementKind
        Kind of the elements.
    nodes : ndarray, shape (nodes, 3)
        Coordinates [m].
    elements : ndarray, shape (elements, nodes of one)
        Numbers of their nodes in the order of VTK.
    materials : list
        Each material with the numbers of its elements.

    Returns
    -------
    mass : csr_array, shape (nodes, nodes)
        Mass along one direction [kg]; it is the same for all three, which are not coupled.
    stiffness : csr_array, shape (3 nodes, 3 nodes)
        Stiffness [N/m], the three directions of a node one after the other.
    """
    mesh, number = _mesh(kind, nodes, elements)
    count = len(nodes)
    mass = scipy.sparse.csr_array((count, count))
    stiffness = scipy.sparse.csr_array((3 * count, 3 * count))
    for material, those in materials:
        for part in _parts(those):
            one, other = _of_part(kind, mesh, number, part, material)
            mass, stiffness = mass + one, stiffness + other
    return mass, stiffness


def _of_part(kind: ElementKind, mesh: Any, number: Array, part: Array, material: Material) -> tuple[Any, Any]:
    """Return mass and stiffness of some elements of one material.

    ``K_ij = lambda G_ij + mu G_ji + mu delta_ij tr G`` with products ``G_ij`` of derivatives of shape functions.
    """
    from skfem import Basis, BilinearForm

    points, weights = _integration(kind)
    basis = Basis(mesh, _finite_element(kind), elements=part, quadrature=(points, weights))
    count = number.size

    def matrix(product: Any) -> Any:
        held = BilinearForm(product).coo_data(basis)
        rows, columns = number[held.indices]
        return scipy.sparse.coo_array((held.data, (rows, columns)), shape=(count, count)).tocsr()

    def gradients(i: int, j: int) -> Any:
        return matrix(lambda u, v, w: v.grad[i] * u.grad[j])

    products = {(i, j): gradients(i, j) for i in range(3) for j in range(i, 3)}
    pattern = products[0, 0]
    stretch = material.young * material.poisson / ((1.0 + material.poisson) * (1.0 - 2.0 * material.poisson))
    shear = material.young / (2.0 * (1.0 + material.poisson))
    blocks = np.empty((pattern.data.size, 3, 3))
    for i, j in products:
        above, below = products[i, j].data, products[i, j].T.tocsr().data
        blocks[:, i, j] = stretch * above + shear * below
        blocks[:, j, i] = stretch * below + shear * above
    for i in range(3):
        blocks[:, i, i] += shear * sum(products[k, k].data for k in range(3))
    stiffness = scipy.sparse.bsr_array((blocks, pattern.indices, pattern.indptr), shape=(3 * count, 3 * count))
    return material.density * matrix(lambda u, v, w: u * v), stiffness.tocsr()


def _mesh(kind: ElementKind, nodes: Array, elements: Array) -> tuple[Any, Array]:
    """Return the mesh of scikit-fem, and the number of our node at each of its degrees of freedom."""
    import skfem

    element = _finite_element(kind)
    ours = elements[:, _order(kind, element)].T
    holder = skfem.MeshTet1 if len(kind.corners) == 4 else skfem.MeshHex1
    is_affine = kind.middles == 0 and len(kind.corners) == 4
    mesh = holder(np.ascontiguousarray(nodes.T), ours, elem=type(element), affine=is_affine)
    theirs = mesh.dofs.element_dofs
    number = np.zeros(int(theirs.max()) + 1, dtype=np.int64)
    number[theirs] = ours
    return mesh, number


def _order(kind: ElementKind, element: Any) -> Array:
    """Return the number of our node at each node of scikit-fem, matched by coordinates in the unit element."""
    distance = np.linalg.norm(element.doflocs[:, None] - kind.nodes[None], axis=2)
    return np.asarray(np.argmin(distance, axis=1))


def _check_shared(kind: ElementKind, elements: Array) -> None:
    """Raise ValueError if an element names a node twice, or an edge or a face has two middles."""
    twice = (np.diff(np.sort(elements, axis=1), axis=1) == 0).any(axis=1)
    if twice.any():
        raise ArgumentError(
            "elements",
            "name each node once",
            got=f"{twice.sum()} with one twice, the first number {np.argmax(twice)} (from 0)",
        )
    first = len(kind.corners)
    for sides in (kind.edges, kind.faces)[: kind.middles]:
        corners = np.sort(elements[:, np.array(sides)], axis=2).reshape(-1, len(sides[0]))
        middles = elements[:, first : first + len(sides)].reshape(-1, 1)
        first += len(sides)
        apart = len(np.unique(np.hstack([corners, middles]), axis=0))
        if not apart == len(np.unique(corners, axis=0)) == len(np.unique(middles)):
            raise ArgumentError(
                "elements",
                "share the middle node of an edge or a face if they share its corners",
                got=f"{apart} middle nodes for {len(np.unique(corners, axis=0))} edges or faces",
            )


def _finite_element(kind: ElementKind) -> Any:
    import skfem

    return getattr(skfem, kind.finite_element)()


def _integration(kind: ElementKind) -> tuple[Array, Array]:
    from skfem.quadrature import get_quadrature

    points, weights = get_quadrature(_finite_element(kind).refdom, DEGREES[kind.middles])
    return points, weights


def _parts(numbers: Array) -> Iterator[Array]:
    for start in range(0, numbers.size, AT_ONCE):
        yield numbers[start : start + AT_ONCE]
