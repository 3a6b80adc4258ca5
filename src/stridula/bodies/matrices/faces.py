"""Faces of bodies given by matrices, on the meshes that the matrices came from."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, choice, counted, instance
from ...doubtful import warn_of
from ..matrix_input import numbers
from ..solids.face_patches import Division, Patches, checked_division, means_of, patches_of, points_of
from ..solids.places import FacePoints
from ..solids.solid_mesh import SolidMesh

# Largest share of a node in a mean that is due to rounding.
ROUNDING = 1e-12


@dataclass(frozen=True, eq=False, repr=False)
class MatrixFace:
    """A face of a body given by matrices, such as a superelement that keeps the nodes of the face.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh from which the matrices were made, or its part with the face.
    face : str
        Name of the face in the mesh.
    degrees : array_like of int, shape (nodes, 3)
        Numbers from 0 of the degrees of freedom of each node of the mesh along x, y and z in the matrices, -1 for none.
        A node of the face without any is taken as held, which a warning mentions.
    division : int, (int, int) or "integration", optional
        Division into contact points, as in `SolidBody`.

    Raises
    ------
    ValueError
        If an argument is out of its range, or if no node of the face is in the matrices.
    """

    mesh: SolidMesh
    face: str
    degrees: Array
    division: Division | None = None

    def __post_init__(self) -> None:
        instance("mesh", self.mesh, SolidMesh)
        choice("face", self.face, tuple(self.mesh.faces) or ("none",))
        object.__setattr__(self, "division", checked_division("division", self.division))
        given = numbers("degrees", self.degrees)
        if given.shape != (len(self.mesh.nodes), 3):
            raise ArgumentError("degrees", f"have the shape ({len(self.mesh.nodes)}, 3)", got=given.shape)
        if np.any(given != given.round()) or given.min() < -1:
            raise ArgumentError("degrees", "be whole numbers from 0, or -1 for none", got=f"{given.min():g}")
        degrees = given.astype(np.int64)
        degrees.flags.writeable = False
        object.__setattr__(self, "degrees", degrees)
        mean = means_of(self.mesh, self.face, self.division)
        # Nodes of an element beside its face have no share, up to rounding.
        nodes = np.unique(mean.indices[np.abs(mean.data) > ROUNDING])
        lost = int(np.sum((degrees[nodes] < 0).all(axis=1)))
        if lost == len(nodes):
            raise ArgumentError("degrees", "keep the nodes of the face", got=f"none of {lost} of {self.face!r}")
        if lost:
            words = f"{counted(lost, 'node')} of {len(nodes)} of the face {self.face!r}"
            warn_of([f"{words} not in the matrices, taken as held"])

    @property
    def patches(self) -> Patches | None:
        """Its patches; None if its contact points are those of integration."""
        return patches_of(self.mesh, self.face, self.division)

    @property
    def points(self) -> FacePoints:
        """Its contact points: places, areas and normals."""
        return points_of(self.mesh, self.face, self.division)

    def rows(self, size: int) -> Array:
        """Return the displacement of its contact points from the degrees of freedom, shape (points, 3, size)."""
        if self.degrees.max() >= size:
            raise ArgumentError(
                "degrees", f"be numbers of degrees of freedom from 0 to {size - 1}", got=int(self.degrees.max())
            )
        mean = means_of(self.mesh, self.face, self.division).tocoo()
        rows = np.zeros((mean.shape[0], 3, size))
        for direction in range(3):
            column = self.degrees[mean.col, direction]
            kept = column >= 0
            np.add.at(rows, (mean.row[kept], direction, column[kept]), mean.data[kept])
        return rows

    @cached_property
    def digest(self) -> bytes:
        """Digest of its content."""
        words = repr((self.face, self.division, self.degrees.shape)).encode()
        return hashlib.sha256(self.mesh._digest + words + self.degrees.tobytes()).digest()

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self.digest == getattr(other, "digest", None)

    def __hash__(self) -> int:
        return hash(self.digest)

    def __repr__(self) -> str:
        return f"MatrixFace({self.face!r}, {self.points})"
