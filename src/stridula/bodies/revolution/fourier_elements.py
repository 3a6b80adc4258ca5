"""Quadratic elements on a profile: stiffness and mass of a body of revolution for each order round its axis.

``u_r = U cos n theta``, ``u_theta = V sin n theta``, ``u_z = W cos n theta``. The strains of (U, V, W), each times its
cosine or sine, are

    rr: U,r    theta theta: (U + n V) / r    zz: W,z
    rz: U,z + W,r    r theta: V,r - V / r - n U / r    theta z: V,z - n W / r

so that the stiffness is a polynomial of second degree in n (Zienkiewicz & Taylor 2000, The Finite Element Method 2, 9).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
from skfem import Basis, BilinearForm, ElementQuad2, ElementTriP2, MeshQuad1, MeshTri1, asm

from ...arrays import Array
from ..sections import Material
from .profile_mesh import SAME_PLACE, ProfileMesh

# Integrands with 1 / r are not polynomials: with four points along a side their error is below that of the elements.
INTEGRATION_ORDER = 6
# Operators on a shape function p: p / r, p,r and p,z.
OVER_R, ALONG_R, ALONG_Z = range(3)
U, V, W = range(3)
NEWTON_STEPS = 12


def _strains() -> tuple[Array, Array]:
    """Return the coefficients of the six strains for (U, V, W) under each operator, and for n times these."""
    plain, by_order = np.zeros((6, 3, 3)), np.zeros((6, 3, 3))
    plain[0, U, ALONG_R] = plain[1, U, OVER_R] = plain[2, W, ALONG_Z] = 1.0
    plain[3, U, ALONG_Z] = plain[3, W, ALONG_R] = plain[4, V, ALONG_R] = plain[5, V, ALONG_Z] = 1.0
    plain[4, V, OVER_R] = -1.0
    by_order[1, V, OVER_R] = 1.0
    by_order[4, U, OVER_R] = by_order[5, W, OVER_R] = -1.0
    return plain, by_order


def _weights() -> Array:
    """Return the weights of products of operators in the stiffness.

    Shape (2, 3, 3, 3, 3, 3): for Lame's first constant and the shear modulus, at each power of n, for a component and
    an operator on it, and another component and an operator on that.
    """
    parts = _strains()
    dilation = [part[:3].sum(axis=0) for part in parts]
    shear = np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    found = np.zeros((2, 3, 3, 3, 3, 3))
    for i in (0, 1):
        for j in (0, 1):
            found[0, i + j] += np.einsum("ap,bq->apbq", dilation[i], dilation[j])
            found[1, i + j] += np.einsum("s,sap,sbq->apbq", shear, parts[i], parts[j])
    return found


@dataclass(frozen=True, eq=False)
class FourierElements:
    """The elements of a profile; the degrees of freedom are U of all points, then V, then W.

    Attributes
    ----------
    profile : ProfileMesh
        Its cells.
    basis : skfem.Basis
        Shape functions of one component.
    stiffness : tuple of sparse
        Stiffness of one radian at the powers 0, 1 and 2 of the order n, shape (3 points, 3 points) each.
    mass : sparse
        Mass of one radian of one component, shape (points, points).
    """

    profile: ProfileMesh
    basis: Any
    stiffness: tuple[Any, Any, Any]
    mass: Any

    @property
    def count(self) -> int:
        """Number of points: degrees of freedom of one component."""
        return int(self.basis.N)

    @property
    def places(self) -> Array:
        """r and z of each point [m], shape (2, points)."""
        return np.asarray(self.basis.doflocs)

    @property
    def axis_points(self) -> Array:
        """Numbers of the points on the axis."""
        return np.flatnonzero(self.places[0] <= SAME_PLACE * self.profile.size)

    def stiffness_of(self, order: int) -> Any:
        """Return the stiffness of one radian of (U, V, W) of an order, shape (3 points, 3 points)."""
        constant, linear, square = self.stiffness
        return (constant + float(order) * linear + float(order) ** 2 * square).tocsc()

    def points_on(self, sides: Array) -> Array:
        """Return the numbers of the points on sides of cells, shape (sides, 2), and in cells with all sides there."""
        mesh = self.basis.mesh
        known = {(int(low), int(high)): k for k, (low, high) in enumerate(np.sort(mesh.facets, axis=0).T)}
        facets = np.array([known[int(low), int(high)] for low, high in np.sort(sides, axis=1)], dtype=int)
        found = [self.basis.nodal_dofs[0, np.unique(sides)], self.basis.facet_dofs[0, facets]]
        if self.basis.interior_dofs.size:
            on = np.zeros(mesh.facets.shape[1], dtype=bool)
            on[facets] = True
            found.append(self.basis.interior_dofs[0, on[mesh.t2f].all(axis=0)])
        return np.unique(np.concatenate(found))

    def shape_functions(self, r: Any, z: Any) -> tuple[Array, Array]:
        """Return the points whose shape functions are not zero at places r, z of the profile [m], and their values.

        Both have the shape of r and z with a further dimension, the points of a cell.
        """
        places = np.stack([np.ravel(r), np.ravel(z)], axis=1)
        cells, shape = self.profile.cells_at(places), (*np.shape(r), -1)
        assert (cells >= 0).all()
        local = _reference(self.basis.mesh.p[:, self.basis.mesh.t[:, cells]], places.T)
        element = self.basis.elem
        values = [element.lbasis(local, k)[0] for k in range(len(element.doflocs))]
        return np.asarray(self.basis.element_dofs[:, cells]).T.reshape(shape), np.stack(values, axis=1).reshape(shape)


def fourier_elements(profile: ProfileMesh, materials: Sequence[Material]) -> FourierElements:
    """Return the elements of a profile with one material for each region."""
    basis = _basis(profile)
    young, poisson, density = (np.zeros(len(profile.cells)) for _ in range(3))
    for cells, material in zip(profile.regions.values(), materials, strict=True):
        young[cells], poisson[cells], density[cells] = material.young, material.poisson, material.density
    shear = young / (2.0 * (1.0 + poisson))
    lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    products = [_products(basis, one) for one in (lame, shear)]
    weights = _weights()
    stiffness = []
    for power in range(3):
        blocks = [[_block(weights[:, power, a, :, b, :], products, basis.N) for b in range(3)] for a in range(3)]
        stiffness.append(scipy.sparse.bmat(blocks, format="csr"))
    first, linear, square = stiffness
    return FourierElements(profile, basis, (first, linear, square), asm(_mass, basis, of=_at_points(basis, density)))


def _basis(profile: ProfileMesh) -> Any:
    nodes = np.ascontiguousarray(profile.nodes.T)
    cells = np.ascontiguousarray(profile.cells.T.astype(np.int32))
    if len(cells) == 3:
        return Basis(MeshTri1(nodes, cells), ElementTriP2(), intorder=INTEGRATION_ORDER)
    return Basis(MeshQuad1(nodes, cells), ElementQuad2(), intorder=INTEGRATION_ORDER)


def _at_points(basis: Any, of_cells: Array) -> Array:
    return np.repeat(of_cells[:, None], basis.X.shape[-1], axis=1)


def _operated(shape: Any, r: Array, operator: int) -> Array:
    return np.asarray(shape / r if operator == OVER_R else shape.grad[operator - 1])


@BilinearForm
def _mass(u: Any, v: Any, w: Any) -> Any:
    return w["of"] * w.x[0] * u * v


def _products(basis: Any, of_cells: Array) -> list[list[Any]]:
    """Return the integrals of all products of two operators on shape functions, weighted by r and a factor per cell."""
    found: list[list[Any]] = [[None] * 3 for _ in range(3)]
    for p in range(3):
        for q in range(p, 3):

            def product(u: Any, v: Any, w: Any, p: int = p, q: int = q) -> Any:
                return w["of"] * w.x[0] * _operated(u, w.x[0], q) * _operated(v, w.x[0], p)

            found[p][q] = asm(BilinearForm(product), basis, of=_at_points(basis, of_cells))
            found[q][p] = found[p][q].T.tocsr()
    return found


def _block(weights: Array, products: list[list[list[Any]]], size: int) -> Any:
    block = scipy.sparse.csr_matrix((size, size))
    for constant in (0, 1):
        for p in range(3):
            for q in range(3):
                if weights[constant, p, q]:
                    block = block + weights[constant, p, q] * products[constant][p][q]
    return block


def _reference(corners: Array, place: Array) -> Array:
    """Return the local coordinates, each from 0 to 1, of places in cells, shape (2, places).

    Corners have the shape (2, corners, places), places (2, places).
    """
    here, edges = np.full(place.shape, 1.0 / 3.0), corners - corners[:, :1]
    twist = edges[:, 2] - edges[:, 1] - edges[:, 3] if corners.shape[1] == 4 else np.zeros(place.shape)
    first, second = edges[:, 1], edges[:, -1]
    for _ in range(NEWTON_STEPS):
        x, y = here
        miss = place - corners[:, 0] - x * first - y * second - x * y * twist
        slopes = np.stack([first + y * twist, second + x * twist], axis=1)
        here = here + np.linalg.solve(np.moveaxis(slopes, -1, 0), miss.T[:, :, None])[:, :, 0].T
    return np.clip(here, 0.0, 1.0)
