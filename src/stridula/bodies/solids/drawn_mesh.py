"""The outer surface of a mesh for drawing."""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from ..drawn_surfaces import DrawnSurface
from .solid_mesh import SolidMesh


def surface_of_mesh(mesh: SolidMesh, shapes: Array) -> DrawnSurface:
    """Return the faces that belong to one element only and are not tied, with the middles of their edges.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh.
    shapes : ndarray, shape (3 nodes, modes)
        Shapes of the modes at its nodes.
    """
    kind = mesh.element_kind
    corners = len(kind.faces[0])
    element, side = mesh.outer_faces.T
    outer = mesh.elements[element[:, None], kind.face_nodes[side]]
    if kind.middles:
        # Round the face: corner, middle of the next edge, corner.
        outer = np.stack([outer[:, :corners], outer[:, corners : 2 * corners]], axis=2).reshape(len(outer), -1)
    used, polygons = np.unique(outer, return_inverse=True)
    moved = shapes.reshape(len(mesh.nodes), 3, -1)[used]
    return DrawnSurface(mesh.nodes[used], polygons.reshape(outer.shape), moved)
