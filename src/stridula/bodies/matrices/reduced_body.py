"""A body given by its mass and stiffness matrices, as exported by a finite-element program."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, choice, instance, listed, positive
from ...ordinary import of_ordinary_size
from ..cards import FEW
from ..damping import DampingLaw, Rayleigh, checked_damping
from ..limits import LARGEST_SIZE
from ..long_searches import search_told
from ..matrix_files import POINT, files_of, read_container, read_matrices, read_nodes, write_npz
from ..matrix_input import (
    check_finite,
    check_mass,
    check_sparse_mass,
    damping_of,
    numbers,
    points_of,
    rows_of,
    sparse_square,
    sparse_symmetric,
    square,
    stays_sparse,
    symmetric,
)
from ..modes import Modes
from ..named_points import NamedPoints
from ..points import BodyPoint
from ..reduction.dense_reduction import Reduction, reduce_body
from ..reduction.sparse_reduction import DENSE, reduce_large_body, reduce_sparse_body
from ..solids.face_patches import Division, Patches, name_of_point, point_named
from ..solids.places import FacePoints
from ..solids.solid_mesh import SolidMesh
from .arguments import faces_of, from_container, from_matrices
from .faces import MatrixFace

FILES = ("path", "mass", "stiffness")
# Most modes of a lumped model: a finite-element model has motions that are not physical.
LARGEST_LUMPED = 12


@dataclass(frozen=True, eq=False, repr=False)
class ReducedBody(NamedPoints):
    """A linear body given by matrices, its mode shapes computed from ``K phi = w² M phi``.

    A mode is rigid, its frequency exactly zero, if its computed w² is below 64 eps = 1.4e-14 of the largest one, the
    rounding error of a zero: a mode slower than 1.2e-7 of the fastest cannot be distinguished from a rigid one. Bodies
    are compared and hashed by content and cannot be changed.

    Parameters
    ----------
    mass, stiffness : array_like or scipy sparse, shape (n, n)
        Mass matrix, positive definite, and stiffness matrix, positive semidefinite; real and symmetric, in SI units for
        displacements in metres. Asymmetry up to 1e-8 of the largest entry, as in text files, is averaged out. At most
        4000 degrees of freedom; for sparse matrices with a cutoff, 300 000.
    points : mapping
        Displacement of each point along world (x, y), or in space (x, y, z), by its name: rows on the degrees of
        freedom, shape (2, n) or (3, n), or the numbers of two or three degrees of freedom from 0, such as ``(0, 1)``;
        None for a direction in which the point does not move. With z the body is in space.
    damping : float, sequence of float, Rayleigh, RisingDamping, SampledDamping or array_like, optional
        One damping ratio [1] for every elastic mode, one for each mode kept by increasing frequency (without
        effect on rigid modes), a law of their frequency, or a symmetric positive semidefinite matrix C [N s/m], shape
        (n, n). With a cutoff, ``Phi^T C Phi`` of the modes kept is used: their coupling by C to the others is lost.
    translation : array_like, shape (2, n) or (3, n), optional
        Displacement of every degree of freedom when the body moves by 1 m along x (first row), along y and, in space,
        along z. Gravity and uniform initial velocities need it.
    cutoff : float, optional
        Keep the modes up to this frequency [Hz], rigid ones always; all modes if left out.
    residual_flexibility : bool, optional
        Whether the modes beyond a cutoff still respond statically to forces at the points and to gravity, so that the
        body has its full static flexibility there.
    name : str, optional
        Name in records; distinguishes equal bodies.
    faces : mapping of MatrixFace, optional
        Faces that touch other bodies by name, for bodies in space. Their contact points are points, too: those of
        "rub" are "rub[1]", "rub[2]" and so on.

    Raises
    ------
    ValueError
        If an argument is out of its range or does not fit the others, or if no mode is left.
    """

    kind: ClassVar[str] = "reduced"
    without_surface: ClassVar[str] = "whose matrices do not contain its shape"
    mass: Array
    stiffness: Array
    points: Mapping[str, Any]
    damping: float | Sequence[float] | Array | DampingLaw = 0.0
    translation: Array | None = None
    cutoff: float | None = None
    residual_flexibility: bool = True
    name: str = ""
    faces: Mapping[str, MatrixFace] = field(default_factory=dict)

    @of_ordinary_size("mass, stiffness, damping and points")
    def __post_init__(self) -> None:
        instance("name", self.name, str)
        instance("residual_flexibility", self.residual_flexibility, bool)
        if self.cutoff is not None:
            self._set("cutoff", positive("cutoff", self.cutoff))
        is_large = stays_sparse(self.mass)
        of_shape, made_symmetric = (sparse_square, sparse_symmetric) if is_large else (square, symmetric)
        self._set("mass", made_symmetric("mass", of_shape("mass", self.mass)))
        size = self.mass.shape[0]
        self._set("stiffness", made_symmetric("stiffness", of_shape("stiffness", self.stiffness, size)))
        self._set("faces", MappingProxyType(_faces(self.faces)))
        self._set("points", MappingProxyType(points_of(self._with_faces(size), size)))
        self._set("damping", checked_damping(self.damping) if is_large else damping_of(self.damping, size))
        if self.translation is not None:
            self._set("translation", rows_of("translation", self.translation, size, self._directions))
        if is_large:
            self._check_large()
        else:
            check_mass(self.mass)
        # Computed now, since stiffness, damping and cutoff are checked with the modes.
        self.modes()

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str] | None = None,
        *,
        mass: str | os.PathLike[str] | None = None,
        stiffness: str | os.PathLike[str] | None = None,
        points: Mapping[str, Any] | None = None,
        damping: Any = None,
        translation: Any = None,
        cutoff: float | None = None,
        residual_flexibility: bool | None = None,
        labels: str | os.PathLike[str] | None = None,
        mesh: str | os.PathLike[str] | None = None,
        faces: Sequence[str] | Mapping[str, Division | None] = (),
        name: str = "",
    ) -> ReducedBody:
        """Read a body from one file with all its data, or from one file for each matrix.

        One file with all data is given as `path`:

        - ``.npz`` with the arrays `mass`, `stiffness` and optionally `damping`, `translation` and ``point_<name>``,
          shape (2, n), one for each point; the format of `save`.
        - MATLAB ``.mat`` up to version 7 with variables of the same names, matrices full or sparse.

        In both formats M, K and C are accepted for mass, stiffness and damping.

        One file for each matrix is given as `mass`, `stiffness` and perhaps `damping`:

        - Matrix Market, also from Ansys' ``*EXPORT,,MMF``.
        - Harwell-Boeing, RSA or RUA, as text from Ansys' HBMAT.
        - ``.sti`` and ``.mas`` of CalculiX' ``*FREQUENCY, SOLVER=MATRIXSTORAGE``, one triangle.
        - DMIG cards of Nastran, real, square or symmetric, in small, large or free fields.
        - OUTPUT4 of Nastran, real, text or binary in either order of bytes, columns full or in strings.
        - Text of Abaqus' ``*MATRIX GENERATE``, assembled: ``FORMAT=MATRIX INPUT``, lines "node, dof, node, dof, value",
          or ``FORMAT=COORDINATE``, lines "row column value", rows from 1. Lines that start with ``*`` are ignored. If
          no entry has its mirror image in the file, the file holds one triangle and the other is filled in.

        A format is recognised by the beginning of a file, that of CalculiX by its ending. From several matrices in a
        file of Nastran, those whose names begin with M, K (but not K4) and B are read. Such a file, or one of the two
        of CalculiX, may also be given as `path`.

        MATRIX INPUT and DMIG label their rows by (node, dof). Rows of other files are labelled by ``job.dof`` beside
        ``job.sti``, by ``K.mapping`` beside ``K.matrix`` (from HBMAT), or by `labels`. Degrees of freedom of all files
        are then merged and sorted by (node, dof); internal nodes, with negative numbers, are kept.

        Degrees of freedom constrained by Abaqus (1e30 and more on the diagonal of the stiffness; Abaqus writes 1e36)
        are removed: points do not move along them. The translation of the others is chosen so that gravity still acts
        on them through the mass that they share with the removed ones. CalculiX and Ansys omit constrained ones, and
        with them that mass: near constraints, gravity is slightly too small.

        Parameters
        ----------
        path, mass, stiffness : str or Path, optional
            The files.
        points : mapping, optional
            As in `ReducedBody`, before degrees of freedom are removed; they replace those of the same name in `path`.
            With labels, a point is the number of a node, ``{"tip": 101}``, or a pair of labels, three in space:
            ``{"tip": ((101, 1), (101, 2))}`` moves along x with the first degree of freedom of node 101 and along y
            with the second. A node also moves along z if the files have a third degree of freedom anywhere, and does
            not move along directions without a degree of freedom. With `mesh`, a point may be a place, ``(x, y, z)``
            [m].
        damping : str or Path, or as in `ReducedBody`, optional
            File of the damping matrix, or damping in place of that in `path`.
        translation : array_like, shape (2, n), or pair of int, optional
            As in `ReducedBody`, before degrees of freedom are removed. With labels, the numbers of the degrees of
            freedom that are displacements along x and y at every node, usually ``(1, 2)``, in space ``(1, 2, 3)``.
        cutoff : float, optional
            As in `ReducedBody`.
        residual_flexibility : bool, optional
            As in `ReducedBody`.
        labels : str or Path, optional
            File with node and degree of freedom of every row, one a line: "node.dof" as in CalculiX' ``.dof``, or "row
            node UX" below a heading as in Ansys' ``.mapping``. Searched beside the matrices if left out.
        mesh : str or Path, optional
            Deck with the coordinates of nodes: ``*NODE`` of Abaqus or CalculiX in ``.inp``, else ``GRID`` of Nastran.
            A place must be within a thousandth of the mesh size of a node.
        faces : sequence of str or mapping, optional
            Surfaces or node sets of `mesh` that touch other bodies: their names, or divisions into contact points by
            name, as in `SolidBody`. Needs labels and the solid elements of the mesh.
        name : str, optional
            As in `ReducedBody`.

        Returns
        -------
        ReducedBody
            The body.

        Raises
        ------
        OSError
            If a file cannot be read.
        ValueError
            If a file is damaged, of another kind or too large (2 GiB, 4000 degrees of freedom, 300 000 in
            sparse ones), or as in `ReducedBody`.
        """
        given_files = {
            word: file for word, file in zip(FILES, (path, mass, stiffness), strict=True) if file is not None
        }
        if tuple(given_files) not in (FILES[:1], FILES[1:]):
            raise ArgumentError(
                "path",
                "be one file with all matrices, or mass and stiffness must be one file each",
                path,
                got=" and ".join(given_files) or "none of them",
            )
        for word, file in given_files.items():
            instance(word, file, (str, os.PathLike))
        options = {
            "damping": damping,
            "translation": translation,
            "cutoff": cutoff,
            "residual_flexibility": residual_flexibility,
            "name": name or None,
        }
        given = {word: value for word, value in options.items() if value is not None}
        added = {} if points is None else points
        instance("points", added, Mapping)
        beside = {word: file for word, file in (("labels", labels), ("mesh", mesh)) if file is not None}
        for word, file in beside.items():
            instance(word, file, (str, os.PathLike))
        if faces and mesh is None:
            raise ArgumentError("mesh", "be given with faces", mesh)
        held = None if path is None else read_container(path)
        if held is not None:
            for word, file in beside.items():
                raise ArgumentError(word, "be left out where a file holds all matrices and points", os.fspath(file))
            known = from_container(held)
            return cls(**{**known, **given, "points": {**known["points"], **added}})
        if path is not None:
            given_files = files_of(path)
            if "damping" in given:
                given_files.pop("damping", None)
        if isinstance(damping, (str, os.PathLike)):
            given_files["damping"] = given.pop("damping")
        nodes = None if mesh is None else read_nodes(mesh)
        files = read_matrices(given_files, labels)
        arguments = from_matrices(files, added, given.get("translation"), nodes)
        if mesh is not None and nodes is not None and faces:
            arguments["faces"] = faces_of(SolidMesh.read(mesh), faces, files, nodes)
        return cls(**given | arguments)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the body to an ``.npz`` file; `read` returns an equal body.

        Raises
        ------
        OSError
            If the file cannot be written; no partial file is left.
        ValueError
            If the name does not end in ``.npz``, or if the body has faces.
        """
        instance("path", path, (str, os.PathLike))
        if Path(path).suffix.lower() != ".npz":
            raise ArgumentError("path", "end in .npz", os.fspath(path))
        if self.faces:
            raise ArgumentError("faces", "be left out to be saved", got=", ".join(self.faces))
        if stays_sparse(self.mass):
            raise ArgumentError(
                "mass", f"have at most {LARGEST_SIZE} degrees of freedom to be saved", got=self.mass.shape[0]
            )
        arrays: dict[str, Any] = {"mass": self.mass, "stiffness": self.stiffness, "name": self.name}
        arrays["residual_flexibility"] = self.residual_flexibility
        arrays |= {POINT + name: rows for name, rows in self.points.items()}
        if isinstance(self.damping, Rayleigh):
            arrays["rayleigh"] = (self.damping.mass, self.damping.stiffness)
        else:
            arrays["damping"] = self.damping
        arrays |= {word: getattr(self, word) for word in ("translation", "cutoff") if getattr(self, word) is not None}
        write_npz(path, arrays)

    @property
    def is_spatial(self) -> bool:
        """Whether it also moves along world z."""
        return self._directions == 3

    @property
    def _directions(self) -> int:
        return len(next(iter(self.points.values())))

    @property
    def axes(self) -> Array:
        """World components of its axes, which are those of the world, shape (2, 2) or (3, 3)."""
        return np.eye(self._directions)

    @property
    def is_lumped(self) -> bool:
        """Whether all its motions are physical: a small model without a cutoff."""
        return self.cutoff is None and self.modes().count <= LARGEST_LUMPED

    @property
    def has_translation(self) -> bool:
        """Whether its translation is known, which gravity and uniform initial velocities need."""
        return self.translation is not None

    @property
    def point_names(self) -> tuple[str, ...]:
        """Names of its points."""
        return tuple(self.points)

    @property
    def face_names(self) -> tuple[str, ...]:
        """Names of its faces."""
        return tuple(self.faces)

    def face_points(self, name: str) -> FacePoints:
        """Return the contact points on a face: places, areas and normals."""
        return self._face(name).points

    def patches(self, name: str) -> Patches | None:
        """Return the patches of a face; None if its contact points are those of integration."""
        return self._face(name).patches

    def contact_point(self, name: str, number: int) -> BodyPoint:
        """Return a contact point of a face by its number from 0."""
        return self.at(name_of_point(name, number))

    def place(self, position: str) -> Array | None:
        """Return the world place of a contact point of a face [m], shape (3,); None for other points."""
        self.check_position(position)
        found = point_named(position, self.faces)
        if found is None or found[1] >= len(self.face_points(found[0]).area):
            return None
        return np.array(self.face_points(found[0]).place[found[1]])

    @property
    def has_modes_at_hand(self) -> bool:
        """Whether its modes are already computed, or quick to compute."""
        return "_reduction" in vars(self) or self.mass.shape[0] <= FEW

    @property
    def total_mass(self) -> float:
        """Mass in a translation [kg], the largest over the directions; nan without a translation."""
        if self.translation is None:
            return float("nan")
        return float(np.max(np.sum(self.translation @ self.mass * self.translation, axis=1)))

    @property
    def shapes(self) -> Array:
        """Mass-normalised mode shapes Phi, residual shapes last, shape (n, modes)."""
        return self._reduction.shapes

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes; their translation is zero if not given. `held_x` is for driven ends and must be false.

        The damping is a matrix if C couples modes by more than 1e-10 of their own damping and by more than rounding
        errors.
        """
        if held_x:
            raise ArgumentError("held_x", "be False for a ReducedBody: it has no driven end", held_x)
        return self._reduction.modes

    @of_ordinary_size("points")
    def trace(self, position: str, held_x: bool = False) -> Array:
        """Return the rows that give the displacement of a point from the modes, shape (2, modes) or (3, modes)."""
        self.check_position(position)
        self.modes(held_x)
        return self.points[position] @ self.shapes

    def modal_coordinates(self, vector: Any) -> Array:
        """Return ``Phi^T M x`` of displacements or velocities x of all degrees of freedom, shape (modes,).

        They are zero for residual shapes, which depend on the forces alone.
        """
        values = numbers("vector", vector)
        if values.shape != (self.mass.shape[0],):
            raise ArgumentError("vector", f"have the shape ({self.mass.shape[0]},)", vector, got=values.shape)
        check_finite("vector", values)
        return np.where(self.modes().massless, 0.0, self.shapes.T @ (self.mass @ values))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ReducedBody) and self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        name = f", name={self.name!r}" if self.name else ""
        return f"ReducedBody({self.mass.shape[0]} degrees of freedom, points {listed(self.points)}{name})"

    def __reduce__(self) -> tuple[Any, ...]:
        values = (dict(value) if isinstance(value, Mapping) else value for value in self._values)
        return ReducedBody, tuple(values)

    def _face(self, name: str) -> MatrixFace:
        return self.faces[choice("name", name, self.face_names or ("none",))]

    def _with_faces(self, size: int) -> dict[str, Any]:
        """Return the points with those of the faces."""
        instance("points", self.points, Mapping)
        found = dict(self.points)
        for name, face in self.faces.items():
            for number, rows in enumerate(face.rows(size)):
                point = name_of_point(name, number)
                # Copies of a body have the same ones already.
                if not np.array_equal(found.setdefault(point, rows), rows):
                    raise ArgumentError("points", "not have the name of a contact point of a face", point)
        return found

    @property
    def _values(self) -> tuple[Any, ...]:
        return tuple(getattr(self, field.name) for field in fields(self))

    @cached_property
    def _digest(self) -> bytes:
        content = hashlib.sha256()
        for value in self._values:
            parts: list[tuple[str, Any]] = sorted(value.items()) if isinstance(value, Mapping) else [("", value)]
            for name, part in parts:
                if stays_sparse(part):
                    content.update(b"".join(array.tobytes() for array in (part.indptr, part.indices, part.data)))
                    part = part.shape
                part = getattr(part, "digest", part)
                is_array = isinstance(part, np.ndarray)
                content.update(repr((name, part.shape if is_array else part, len(parts))).encode())
                content.update(part.tobytes() if is_array else b"")
        return content.digest()

    @cached_property
    def _reduction(self) -> Reduction:
        with search_told(self, self.mass.shape[0]):
            if stays_sparse(self.mass):
                return reduce_sparse_body(self)
            is_large = self.cutoff is not None and self.mass.shape[0] > DENSE
            return reduce_large_body(self) if is_large else reduce_body(self)

    def _check_large(self) -> None:
        """Raise ValueError if sparse matrices lack a cutoff or the mass matrix is not positive definite."""
        if self.cutoff is None:
            raise ArgumentError(
                "cutoff",
                f"be given for more than {LARGEST_SIZE} degrees of freedom",
                got=f"none for {self.mass.shape[0]}",
            )
        check_sparse_mass(self.mass)

    def _set(self, name: str, value: Any) -> None:
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
        object.__setattr__(self, name, value)


def _faces(given: Any) -> dict[str, MatrixFace]:
    """Return faces by their names after checks."""
    instance("faces", given, Mapping)
    for name, one in given.items():
        if not isinstance(name, str) or not name:
            raise ArgumentError("faces", "have names that are text", name)
        instance(f"faces[{name!r}]", one, MatrixFace)
    return dict(given)
