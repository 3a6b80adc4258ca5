"""Contents of files of matrices as arguments of a `ReducedBody`."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any

import numpy as np
import scipy.linalg
import scipy.spatial

from ...arrays import Array
from ...checks import ArgumentError
from ..damping import Rayleigh
from ..limits import LARGEST_SIZE, LARGEST_SPARSE, check_size
from ..matrix_files import AlignedMatrices, Nodes
from ..matrix_input import (
    check_mass,
    is_labelled,
    is_pair,
    point_rows,
    rows_of,
    sparse_square,
    sparse_symmetric,
    square,
    symmetric,
)
from ..reduction.factorisation import factorised
from ..solids.face_patches import divided
from ..solids.solid_mesh import SolidMesh
from .faces import MatrixFace

# Largest distance between the same node in both readings of a deck, relative to the size of the mesh.
SAME = 1e-9


def from_container(held: dict[str, Any]) -> dict[str, Any]:
    """Return the arguments of a body from the content of a file, in which numbers and texts are also arrays."""
    arguments = {word: value for word, value in held.items() if word != "rayleigh"}
    if "rayleigh" in held:
        mass, stiffness = held["rayleigh"].tolist()
        arguments["damping"] = Rayleigh(mass, stiffness)
    for word in ("cutoff", "residual_flexibility", "name"):
        if word in held:
            arguments[word] = held[word].item()
    return arguments


def from_matrices(
    files: AlignedMatrices, points: Mapping[str, Any], translation: Any, nodes: Nodes | None = None
) -> dict[str, Any]:
    """Return the arguments of a body from files of matrices, without the constrained degrees of freedom."""
    free, size = files.free, files.free.size
    check_size("stiffness", int(free.sum()), LARGEST_SPARSE)
    arguments: dict[str, Any] = {name: matrix[free][:, free] for name, matrix in files.matrices.items()}
    arguments["points"] = {
        name: point_rows(f"points[{name!r}]", _by_number(f"points[{name!r}]", value, files.labels, nodes), size)[
            :, free
        ]
        for name, value in points.items()
    }
    if translation is not None:
        motion = _translation(translation, files.labels, size)
        pulled = files.matrices["mass"][free][:, ~free] @ motion[:, ~free].T
        arguments["translation"] = motion[:, free] + _held_back(arguments["mass"], pulled).T
    return arguments


def faces_of(mesh: SolidMesh, faces: Any, files: AlignedMatrices, nodes: Nodes) -> dict[str, MatrixFace]:
    """Return faces of the mesh of a deck, whose nodes are those of the rows of files of matrices."""
    if files.labels is None:
        raise ArgumentError("faces", "be left out where files do not name the nodes of their rows", faces)
    divisions = divided(faces, mesh, "faces")
    far, nearest = scipy.spatial.KDTree(nodes.places).query(mesh.nodes)
    if far.max() > SAME * float(np.linalg.norm(mesh.size)):
        got = f"a node {far.max():.3g} m from any other"
        raise ArgumentError("mesh", "have its nodes in global coordinates, without instances", got=got)
    row = {(int(node), int(way)): k for k, (node, way) in enumerate(files.labels.tolist())}
    kept = np.where(files.free, np.cumsum(files.free) - 1, -1)
    degrees = np.full((len(mesh.nodes), 3), -1, dtype=np.int64)
    for at, number in enumerate(nodes.numbers[nearest].tolist()):
        for direction in range(3):
            found = row.get((number, direction + 1))
            degrees[at, direction] = -1 if found is None else kept[found]
    return {name: MatrixFace(mesh, name, degrees, division) for name, division in divisions.items()}


def _held_back(mass: Any, pulled: Array) -> Array:
    """Return the acceleration of the mass under loads."""
    if mass.shape[0] > LARGEST_SIZE:
        return factorised(sparse_symmetric("mass", sparse_square("mass", mass)))(pulled)
    dense = symmetric("mass", square("mass", mass))
    check_mass(dense)
    return np.asarray(scipy.linalg.solve(dense, pulled, assume_a="pos"))


def _by_number(word: str, value: Any, labels: Array | None, nodes: Nodes | None) -> Any:
    """Return a point given by a node, a place or labels as numbers of degrees of freedom; any other unchanged."""
    if labels is None and nodes is not None:
        raise ArgumentError("mesh", "be left out where files do not name the nodes of their rows", word)
    if labels is None or (isinstance(value, np.ndarray) and value.ndim > 1):
        return value
    if isinstance(value, Integral) and not isinstance(value, bool):
        return _of_node(word, int(value), labels)
    if nodes is not None and _is_place(value):
        return _of_node(word, nodes.nearest(word, value), labels)
    if not is_labelled(value, (tuple, list)) or not all(entry is None or is_pair(entry, Integral) for entry in value):
        words = "be a pair of labels (node, degree of freedom), three of them in space, or a node's number"
        raise ArgumentError(word, words + (" or place" if nodes is not None else ""), value)
    return tuple(None if label is None else _number(word, label, labels) for label in value)


def _is_place(value: Any) -> bool:
    return is_labelled(value, Real) and len(value) == 3 and all(part is not None for part in value)


def _of_node(word: str, node: int, labels: Array) -> tuple[int | None, ...]:
    """Return the degrees of freedom along x, y and, if the files have it, z; None where the node does not move."""
    directions = 3 if ((labels[:, 0] > 0) & (labels[:, 1] == 3)).any() else 2
    place = np.flatnonzero(labels[:, 0] == node)
    along = {int(labels[k, 1]): int(k) for k in place}
    found = tuple(along.get(direction) for direction in range(1, directions + 1))
    if not any(number is not None for number in found):
        known = f"node {node} has {', '.join(map(str, along))}" if along else f"no node {node}, or all of it is held"
        raise ArgumentError(word, f"name a node in the files that moves ({known})", node)
    return found


def _number(word: str, label: tuple[int, int], labels: Array) -> int:
    of_node = np.flatnonzero(labels[:, 0] == label[0])
    found = of_node[labels[of_node, 1] == label[1]]
    if found.size == 0:
        there = ", ".join(str(dof) for dof in labels[of_node, 1])
        known = f"node {label[0]} has {there}" if there else f"no node {label[0]}"
        raise ArgumentError(word, f"name degrees of freedom in the files ({known})", label)
    return int(found[0])


def _translation(value: Any, labels: Array | None, size: int) -> Array:
    """Return rows; with labels, also from the numbers of the degrees of freedom along x, y and, in space, z."""
    if labels is None or not is_labelled(value, Integral):
        return rows_of("translation", value, size)
    motion = np.stack([(labels[:, 0] > 0) & (labels[:, 1] == dof) for dof in value]).astype(float)
    for dof, row in zip(value, motion, strict=True):
        if dof is not None and not row.any():
            known = ", ".join(str(number) for number in np.unique(labels[labels[:, 0] > 0, 1]))
            raise ArgumentError("translation", f"name degrees of freedom of the nodes ({known})", dof)
    return motion
