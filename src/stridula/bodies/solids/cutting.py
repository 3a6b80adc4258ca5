"""Meshes without some of their elements."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import Array
from .kinds import outer_faces


def without(mesh: Any, removed: Array, name: str) -> dict[str, Any]:
    """Return the values of a mesh without some of its elements; groups of which nothing is left are left out.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh, without ties.
    removed : ndarray of bool, shape (elements,)
        Elements to leave out.
    name : str
        Name of the faces that come to the surface.
    """
    kept = np.flatnonzero(~removed)
    elements, used = np.full(len(removed), -1), np.unique(mesh.elements[kept])
    elements[kept] = np.arange(kept.size)
    nodes = np.full(len(mesh.nodes), -1)
    nodes[used] = np.arange(used.size)
    left = {group: numbers[elements[numbers] >= 0] for group, numbers in mesh.volumes.items()}
    sides = {group: pairs[elements[pairs[:, 0]] >= 0] for group, pairs in mesh.faces.items()}
    sets = {group: nodes[numbers][nodes[numbers] >= 0] for group, numbers in mesh.node_sets.items()}
    faces = {group: np.stack([elements[pairs[:, 0]], pairs[:, 1]], axis=1) for group, pairs in sides.items()}
    return {
        "nodes": mesh.nodes[used],
        "elements": nodes[mesh.elements[kept]],
        "volumes": {group: elements[numbers] for group, numbers in left.items() if numbers.size},
        "faces": {**{group: pairs for group, pairs in faces.items() if len(pairs)}, name: _bared(mesh, kept)},
        "node_sets": {group: numbers for group, numbers in sets.items() if numbers.size},
    }


def _bared(mesh: Any, kept: Array) -> Array:
    """Return the faces of the kept elements that were inside the mesh: numbers among the kept ones and of the face."""
    kind = mesh.element_kind
    now = outer_faces(kind, mesh.elements[kept])
    code = np.array([len(kind.faces), 1])
    before = outer_faces(kind, mesh.elements) @ code
    return now[~np.isin(np.stack([kept[now[:, 0]], now[:, 1]], axis=1) @ code, before)]
