"""Meshes in space: nodes, elements and the names of their parts."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
import scipy  # its parts are imported on first use
import scipy.sparse

from ...arrays import Array
from ...checks import WHOLE_TURN, ArgumentError, choice, count, counted, finite, instance, listed, positive
from ...doubtful import doubts_of_size, warn_of
from ..matrix_input import check_finite, numbers
from ..reading.finite import check_finite_in
from . import mesh_files, shapes
from .assembly import assembly
from .cutting import without
from .elements import check_elements, volumes
from .kinds import KINDS, ElementKind, outer_faces
from .mesh_quality import scaled_jacobians
from .ties import Dependence, dependence_of

# Factors of meshes with more nodes exceed usual memory.
# Twice those of the largest body, parts of which may be held.
MOST_NODES = 200_000
# Largest distance of a point from its node, relative to the size of a mesh.
TOLERANCE = 1e-3


@dataclass(frozen=True, repr=False)
class Face:
    """A named part of the surface of a mesh.

    Attributes
    ----------
    nodes : ndarray, shape (faces, nodes of one)
        Node numbers of each face of an element: corners counter-clockwise about the outward normal, then midpoints of
        edges, then the centre.
    area : ndarray, shape (faces,)
        Areas [m²]; for curved faces, of their projection along the normal.
    normal : ndarray, shape (faces, 3)
        Outward unit normals; for curved faces, the mean.
    """

    nodes: Array
    area: Array
    normal: Array

    def __repr__(self) -> str:
        return f"Face({counted(len(self.area), 'face')} of elements, {self.area.sum():.4g} m²)"


@dataclass(frozen=True, eq=False, repr=False)
class SolidMesh:
    """A mesh of tetrahedra or hexahedra of one kind, with named parts.

    Meshes are compared and hashed by content and cannot be changed.

    Parameters
    ----------
    nodes : array_like, shape (nodes, 3)
        Coordinates [m].
    elements : array_like of int, shape (elements, nodes of one)
        Numbers from 0 of the nodes of each element, in the order of VTK: corners, middles of edges, of faces, of the
        element.
    kind : str
        "tetra", "tetra10", "hexahedron", "hexahedron20" or "hexahedron27".
    volumes : mapping, optional
        Numbers of elements, from 0, by the name of their group.
    faces : mapping, optional
        Faces of elements by the name of their group: pairs of the number of an element and of its face, shape (faces,
        2).
    node_sets : mapping, optional
        Numbers of nodes by the name of their set.
    ties : sequence of (str, str), optional
        Pairs of faces that stay together without sharing nodes, see `tied`.
    tolerance : float, optional
        Largest distance of a tied node from the other face [m], at most half the size of the element there; a twentieth
        of it if left out.

    Raises
    ------
    ValueError
        If elements are inverted, form several parts or refer to missing nodes, if a node has no element, or if a group
        refers to missing nodes, elements or faces.
    """

    nodes: Array
    elements: Array
    kind: str
    volumes: Mapping[str, Any] = field(default_factory=dict)
    faces: Mapping[str, Any] = field(default_factory=dict)
    node_sets: Mapping[str, Any] = field(default_factory=dict)
    ties: Sequence[tuple[str, str]] = ()
    tolerance: float | None = None

    def __post_init__(self) -> None:
        choice("kind", self.kind, tuple(KINDS))
        nodes = numbers("nodes", self.nodes)
        if nodes.ndim != 2 or nodes.shape[1] != 3:
            raise ArgumentError("nodes", "have the shape (nodes, 3)", self.nodes, got=nodes.shape)
        check_finite("nodes", nodes)
        if len(nodes) > MOST_NODES:
            raise ArgumentError("nodes", f"be at most {MOST_NODES}", got=len(nodes))
        elements = whole("elements", self.elements, len(nodes))
        width = len(self.element_kind.nodes)
        if elements.ndim != 2 or elements.shape[1] != width or not len(elements):
            raise ArgumentError("elements", f"have the shape (elements, {width})", self.elements, got=elements.shape)
        self._set("nodes", nodes)
        self._set("elements", elements)
        limits = {"volumes": (len(elements),), "node_sets": (len(nodes),)}
        for word, limit in limits.items():
            self._set(word, _groups(word, getattr(self, word), *limit))
        self._set("faces", _face_groups(self.faces, len(elements), len(self.element_kind.faces)))
        self._set("ties", _ties(self.ties, self.faces))
        if self.tolerance is not None:
            self._set("tolerance", positive("tolerance", self.tolerance))
        self._check_used()
        if not self.ties:
            self._check_whole()
        check_elements(self.element_kind, nodes, elements)
        if self.ties:
            self._check_whole()
        warn_of(doubts_of_size(float(self.size.max())))

    @classmethod
    def read(cls, path: str | os.PathLike[str], scale: float = 1.0, part: str | None = None) -> SolidMesh:
        """Read a mesh of gmsh, Abaqus, CalculiX, Nastran, VTK, Salome (MED), Medit or of a universal file.

        Groups of elements become volumes. Groups of faces, or of nodes that hold all nodes of a face on the surface,
        become faces. Groups of nodes remain sets of nodes. Names are those of the file: physical groups of gmsh,
        element and node sets of Abaqus, numbers of properties of Nastran; in VTK the name of an array of whole numbers
        and a number in it, such as "region 2". Nodes without a solid element are left out. Instances of parts of Abaqus
        are at their places. A warning names what a deck has besides solid elements.

        Parameters
        ----------
        path : str or Path
            The file.
        scale : float, optional
            Length of its unit [m], 0.001 for millimetres.
        part : str, optional
            The part to read of a file with several: the name of an instance, of a group of elements or of a material.

        Returns
        -------
        SolidMesh
            The mesh, with the elements of the file; wedges, pyramids and mixtures of kinds are cut into tetrahedra.

        Raises
        ------
        OSError
            If the file cannot be read.
        ValueError
            If the file is damaged, too large, of another format, or has solid elements of an unknown kind or of several
            orders, or as in `SolidMesh`.
        """
        instance("path", path, (str, os.PathLike))
        length = positive("scale", scale)
        if part is not None:
            instance("part", part, str)
        parts = mesh_files.read_mesh(path, part)
        nodes = parts.pop("nodes")
        check_finite_in(path, "nodes", nodes)
        return cls(nodes * length, **parts)

    @classmethod
    def block(cls, lengths: Sequence[float], divisions: Sequence[int]) -> SolidMesh:
        """Return a block of hexahedra of 20 nodes from the origin to `lengths`.

        Its faces are ``left`` and ``right`` across x, ``bottom`` and ``top`` across y, ``back`` and ``front`` across z.

        Parameters
        ----------
        lengths : sequence of float, length 3
            Sides along x, y and z [m].
        divisions : sequence of int, length 3
            Numbers of elements along x, y and z.
        """
        sides, parts = _three("lengths", lengths, positive), _divisions(divisions)
        return cls(**shapes.block(sides, parts))

    @classmethod
    def sector(
        cls,
        radii: Sequence[float],
        angles: Sequence[float],
        height: float | Mapping[str, float],
        divisions: Sequence[int],
        axis: str = "y",
    ) -> SolidMesh:
        """Return a sector of a ring of hexahedra of 20 nodes; a whole ring for an angle of 2 pi.

        The ring stands on the plane normal to its axis through the origin, which is its centre. Its faces are ``inner``
        and ``outer``, ``start`` and ``end`` of the sector, ``bottom`` and ``top`` along the axis.

        Parameters
        ----------
        radii : sequence of float, length 2
            Inner and outer radius [m].
        angles : sequence of float, length 2
            Angles of start and end [rad] about the axis, counted from the next axis: from z if the axis is y.
        height : float or mapping
            Length along the axis [m], or the length of each layer by name from the bottom up; each becomes a volume.
        divisions : sequence of int, length 3
            Numbers of elements along radius, angle and axis, the latter for each layer.
        axis : str, optional
            "x", "y" or "z".
        """
        choice("axis", axis, ("x", "y", "z"))
        parts = _divisions(divisions)
        inner, outer = _two("radii", radii)
        positive("radii[0]", inner)
        if outer <= inner:
            raise ArgumentError("radii", "increase", radii)
        start, end = _two("angles", angles)
        if not start < end <= start + 2.0 * np.pi * (1.0 + 1e-12):
            raise ArgumentError("angles", "increase, by at most 2 pi in all", angles)
        heights = _heights(height)
        _check_nodes("divisions", (*parts[:2], parts[2] * len(heights)), divisions)
        return cls(**shapes.sector((inner, outer), (start, end), heights, parts, axis))

    @classmethod
    def extrusion(
        cls, nodes: Any, quadrilaterals: Any, height: float | Mapping[str, float], layers: int, axis: str = "z"
    ) -> SolidMesh:
        """Return a plane mesh of quadrilaterals extruded along an axis into hexahedra of 20 nodes.

        The plane mesh has the next two coordinates: x and y for z, z and x for y. The faces are ``bottom``, ``top`` and
        ``side``.

        Parameters
        ----------
        nodes : array_like, shape (nodes, 2)
            Coordinates in the plane [m].
        quadrilaterals : array_like of int, shape (elements, 4)
            Numbers from 0 of the corners of each, counterclockwise.
        height : float or mapping
            Length along the axis [m], or the length of each layer by name from the bottom up; each becomes a volume.
        layers : int
            Number of elements along the axis for each layer.
        axis : str, optional
            "x", "y" or "z".
        """
        choice("axis", axis, ("x", "y", "z"))
        places = numbers("nodes", nodes)
        if places.ndim != 2 or places.shape[1] != 2:
            raise ArgumentError("nodes", "have the shape (nodes, 2)", nodes, got=places.shape)
        check_finite("nodes", places)
        corners = whole("quadrilaterals", quadrilaterals, len(places))
        if corners.ndim != 2 or corners.shape[1] != 4 or not len(corners):
            raise ArgumentError("quadrilaterals", "have the shape (elements, 4)", quadrilaterals, got=corners.shape)
        heights = _heights(height)
        layers = count("layers", layers, high=MOST_NODES // len(corners) // len(heights) + 1)
        nodes = (len(places) + len(corners)) * layers * len(heights)
        if nodes > MOST_NODES:
            raise ArgumentError("layers", f"make at most {MOST_NODES} nodes", layers, got=f"{nodes} and more")
        return cls(**shapes.extrusion(places, corners, heights, layers, axis))

    @classmethod
    def tied(
        cls, parts: Mapping[str, SolidMesh], ties: Sequence[tuple[str, str]], tolerance: float | None = None
    ) -> SolidMesh:
        """Return one mesh of parts that are glued together at faces, whose nodes need not match.

        Each part is a volume by its name; its own groups are "part/group". The nodes of the second face of a tie follow
        the first face as its elements move there, so that rigid motions and uniform strains are exact; the second face
        should have the smaller elements. Nodes beyond the tolerance stay free, with a warning. A node of several ties
        follows the first. Tied faces are no part of the surface for sound and drawing where the middles of their
        elements lie on the other face.

        Parts of first order get nodes in the middle of edges if others have them; hexahedra are cut into tetrahedra if
        other parts have these.

        Parameters
        ----------
        parts : mapping
            Meshes by the names of the parts.
        ties : sequence of (str, str)
            Pairs of faces, such as ``("plate/front", "lining/back")``.
        tolerance : float, optional
            Largest distance of a tied node from the other face [m], at most half the size of the element there; a
            twentieth of it if left out.

        Raises
        ------
        ValueError
            If a face is missing or too far from the other, if a part is not tied, or as in `SolidMesh`.

        Examples
        --------
        A lining on its plate::

            pad = st.SolidMesh.tied({"plate": plate, "lining": lining}, [("plate/front", "lining/back")])
            body = st.SolidBody(pad, {"plate": steel, "lining": friction}, contact_faces=["lining/front"], cutoff=8e3)
        """
        instance("parts", parts, Mapping)
        for name, part in parts.items():
            instance(f"parts[{name!r}]", part, SolidMesh)
        mesh = cls(**assembly(parts), ties=ties, tolerance=tolerance)
        warn_of(mesh._dependence.doubts)
        return mesh

    @property
    def element_kind(self) -> ElementKind:
        """Kind of its elements."""
        return KINDS[self.kind]

    @property
    def size(self) -> Array:
        """Extent along x, y and z [m], shape (3,)."""
        return np.asarray(np.ptp(self.nodes, axis=0))

    @property
    def scaled_jacobian(self) -> Array:
        """Quality of each element, shape (elements,): 1 for cubes and regular tetrahedra, 0 for flat elements.

        Least determinant of the unit vectors along the edges at a corner, as in the library Verdict; meshes for finite
        elements should have none below 0.2.
        """
        return scaled_jacobians(self.element_kind, self.nodes, self.elements)

    @property
    def volume(self) -> Array:
        """Volume of each element [m³], shape (elements,)."""
        return volumes(self.element_kind, self.nodes, self.elements)

    @property
    def shares(self) -> Any:
        """Share of each node in the displacement of each through ties, sparse, shape (nodes, nodes).

        The unit matrix without ties.
        """
        return self._dependence.shares

    @property
    def leads(self) -> Array:
        """Mask of the nodes that follow no others through ties, shape (nodes,)."""
        return np.asarray(self.shares.diagonal() == 1.0)

    @property
    def outer_faces(self) -> Array:
        """Faces on its surface that are not tied: numbers of the element and its face, shape (faces, 2)."""
        outer, sides = outer_faces(self.element_kind, self.elements), len(self.element_kind.faces)
        hidden = self._dependence.hidden @ np.array([sides, 1])
        return outer[~np.isin(outer @ np.array([sides, 1]), hidden)]

    def quadratic(self) -> SolidMesh:
        """Return the mesh with nodes in the middle of its straight edges; itself if it has them.

        Such a node is added to sets of nodes that hold both ends of its edge.
        """
        if self.element_kind.middles:
            return self
        return replace(self, **shapes.with_middles(self._values))

    def moved(
        self, offset: Sequence[float] = (0.0, 0.0, 0.0), rotation: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> SolidMesh:
        """Return the mesh turned about the origin, then shifted.

        Parameters
        ----------
        offset : sequence of float, length 3, optional
            Shift along x, y and z [m].
        rotation : sequence of float, length 3, optional
            Rotation vector: components along x, y and z of the axis times the angle [rad], at most 2 pi; (0, 0, pi) is
            upside down.

        Raises
        ------
        ValueError
            If an argument is out of its range.
        """
        shift, turn = (_three(word, those, finite) for word, those in (("offset", offset), ("rotation", rotation)))
        if (angle := float(np.linalg.norm(turn))) > WHOLE_TURN:
            raise ArgumentError(
                "rotation", "be an axis times an angle of at most 2 pi rad", rotation, got=f"{angle:.6g} rad"
            )
        matrix = scipy.spatial.transform.Rotation.from_rotvec(turn).as_matrix()
        return replace(self, nodes=self.nodes @ matrix.T + np.array(shift))

    def cut(self, inside: Callable[[Array], Any], name: str = "cut") -> SolidMesh:
        """Return the mesh without the elements whose middles are in a region: holes, slots, vanes, chamfers.

        Parameters
        ----------
        inside : callable
            Takes places, shape (elements, 3) [m], and returns whether each is in the region.
        name : str, optional
            Name of the faces that come to the surface.

        Raises
        ------
        ValueError
            If no element is left, if none is in the region, if what is left forms several parts, or if the mesh has
            ties: cut its parts first.

        Examples
        --------
        >>> disc = st.SolidMesh.sector((0.05, 0.13), (0.0, 2.0 * np.pi), 0.02, (4, 48, 2))
        >>> drilled = disc.cut(lambda place: np.hypot(place[:, 0] - 0.1, place[:, 2]) < 0.01, "hole")
        >>> print(len(disc.elements) - len(drilled.elements), drilled.face("hole"))
        4 Face(12 faces of elements, 0.001846 m²)
        """
        if self.ties:
            raise ArgumentError("ties", "be left out: cut the parts before they are tied", self.ties)
        instance("name", name, str)
        if name in self.faces:
            raise ArgumentError("name", "be that of no face yet", name)
        middles = self.nodes[self.elements[:, : len(self.element_kind.corners)]].mean(axis=1)
        removed = np.asarray(inside(middles))
        if removed.shape != (len(middles),) or removed.dtype != bool:
            got = f"{removed.dtype} of the shape {removed.shape}"
            raise ArgumentError("inside", f"return a truth value for each of {len(middles)} places", got=got)
        if not removed.any() or removed.all():
            got = "none" if not removed.any() else "all"
            raise ArgumentError("inside", "hold the middles of some elements, not of all", got=got)
        return replace(self, **without(self, removed, name))

    def named(self, name: str, nodes: Any) -> SolidMesh:
        """Return the mesh with an additional set of nodes, such as ``np.flatnonzero(mesh.nodes[:, 2] == 0.0)``."""
        instance("name", name, str)
        return replace(self, node_sets={**self.node_sets, name: nodes})

    def face(self, name: str) -> Face:
        """Return the faces of a group.

        Raises
        ------
        ValueError
            If there is no group of faces of this name.
        """
        choice("face", name, tuple(self.faces))
        element, side = self.faces[name].T
        nodes = self.elements[element[:, None], self.element_kind.face_nodes[side]]
        vectors = _area_vectors(self.nodes[nodes], self.element_kind, len(self.element_kind.faces[0]))
        area = np.linalg.norm(vectors, axis=1)
        return Face(nodes, area, vectors / area[:, None])

    def nodes_of(self, name: str) -> Array:
        """Return the numbers of the nodes of a group of faces or nodes, rising.

        Raises
        ------
        ValueError
            If there is no group of faces or nodes of this name.
        """
        choice("group", name, (*self.faces, *self.node_sets))
        return np.unique(self.face(name).nodes if name in self.faces else self.node_sets[name])

    def node_at(self, place: Sequence[float], tolerance: float | None = None) -> int:
        """Return the number of the node nearest to a place.

        Parameters
        ----------
        place : sequence of float, length 3
            Coordinates [m].
        tolerance : float, optional
            Largest distance of the node [m]; a thousandth of the size of the mesh if left out.

        Raises
        ------
        ValueError
            If the node is farther away.
        """
        there = np.array(_three("place", place, finite))
        allowed = (
            TOLERANCE * float(np.linalg.norm(self.size)) if tolerance is None else positive("tolerance", tolerance)
        )
        distance = np.linalg.norm(self.nodes - there, axis=1)
        nearest = int(np.argmin(distance))
        if distance[nearest] > allowed:
            where = ", ".join(f"{value:.6g}" for value in self.nodes[nearest])
            raise ArgumentError(
                "place",
                f"be within {allowed:.3g} m of a node",
                place,
                got=f"{tuple(there.tolist())}, {distance[nearest]:.3g} m from the nearest, ({where})",
            )
        return nearest

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._digest == getattr(other, "_digest", None)

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        names = listed(dict.fromkeys([*self.volumes, *self.faces, *self.node_sets]))
        ties = f", {counted(len(self.ties), 'tie')}" if self.ties else ""
        size = f"{len(self.nodes)} nodes, {len(self.elements)} {self.element_kind.words}"
        return f"SolidMesh({size}, groups {names}{ties})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, ({name: dict(v) if isinstance(v, Mapping) else v for name, v in self._values.items()},)

    @property
    def _values(self) -> dict[str, Any]:
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @cached_property
    def _digest(self) -> bytes:
        content = hashlib.sha256(self.kind.encode())
        for array in (self.nodes, self.elements):
            content.update(repr(array.shape).encode() + array.tobytes())
        for groups in (self.volumes, self.faces, self.node_sets):
            for name, those in sorted(groups.items()):
                content.update(repr((name, those.shape, len(groups))).encode() + those.tobytes())
        if self.ties:
            content.update(repr((self.ties, self.tolerance)).encode())
        return content.digest()

    @cached_property
    def _dependence(self) -> Dependence:
        return dependence_of(self)

    def _check_used(self) -> None:
        """Raise ValueError if a node has no element."""
        lonely = np.setdiff1d(np.arange(len(self.nodes)), self.elements)
        if lonely.size:
            raise ArgumentError(
                "nodes", "each have an element", got=f"{lonely.size} without, the first number {lonely[0]} (from 0)"
            )

    def _check_whole(self) -> None:
        """Raise ValueError if the elements form several parts that are not tied."""
        count = len(self.elements)
        rows = np.repeat(np.arange(count), self.elements.shape[1])
        held = scipy.sparse.coo_array((np.ones(rows.size), (rows, self.elements.ravel())), (count, len(self.nodes)))
        joined = scipy.sparse.block_array([[None, held], [held.T, self.shares]])
        parts, _ = scipy.sparse.csgraph.connected_components(joined, directed=False)
        if parts > 1:
            lacking = "node and no tie" if self.ties else "node"
            raise ArgumentError("elements", "form one part", got=f"{parts} that share no {lacking}")

    def _set(self, name: str, value: Any) -> None:
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
        object.__setattr__(self, name, value)


def whole(word: str, value: Any, limit: int) -> Array:
    """Return numbers from 0 to below `limit` as an array of integers."""
    given = numbers(word, value)
    if given.size and not ((given >= 0) & (given < limit) & (given == np.round(given))).all():
        raise ArgumentError(word, f"be whole numbers from 0 to {limit - 1}", value)
    return given.astype(np.int64)


def _unpickled(values: dict[str, Any]) -> SolidMesh:
    """Return a mesh from its values, which were checked when it was first created."""
    mesh = object.__new__(SolidMesh)
    for name, value in values.items():
        mesh._set(name, _frozen(value) if isinstance(value, dict) else value)
    return mesh


def _frozen(groups: dict[str, Array]) -> Mapping[str, Array]:
    for array in groups.values():
        array.flags.writeable = False
    return MappingProxyType(groups)


def _names(word: str, groups: Any) -> Mapping[str, Any]:
    instance(word, groups, Mapping)
    for name in groups:
        if not isinstance(name, str) or not name:
            raise ArgumentError(word, "have names that are text", name)
    return groups


def _groups(word: str, groups: Any, limit: int) -> Mapping[str, Array]:
    """Return numbers of elements or nodes by name, rising."""
    found = {}
    for name, value in _names(word, groups).items():
        found[name] = np.unique(whole(f"{word}[{name!r}]", value, limit))
    return _frozen(found)


def _face_groups(groups: Any, elements: int, sides: int) -> Mapping[str, Array]:
    found = {}
    for name, value in _names("faces", groups).items():
        word = f"faces[{name!r}]"
        pairs = whole(word, value, max(elements, sides))
        if pairs.ndim != 2 or pairs.shape[1] != 2 or not len(pairs):
            raise ArgumentError(word, "have the shape (faces, 2)", value, got=pairs.shape)
        if pairs[:, 0].max() >= elements or pairs[:, 1].max() >= sides:
            raise ArgumentError(word, f"name elements below {elements} and faces below {sides}", value)
        found[name] = np.unique(pairs, axis=0)
    return _frozen(found)


def _ties(given: Any, faces: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """Return pairs of different faces."""
    instance("ties", given, Sequence)
    for number, pair in enumerate(given):
        word = f"ties[{number}]"
        if isinstance(pair, str) or not isinstance(pair, Sequence) or len(pair) != 2:
            raise ArgumentError(word, "be a pair of faces, such as ('plate/front', 'lining/back')", pair)
        for side, name in enumerate(pair):
            choice(f"{word}[{side}]", name, tuple(faces) or ("none",))
        if pair[0] == pair[1]:
            raise ArgumentError(word, "name two faces", pair)
    return tuple((first, second) for first, second in given)


def _area_vectors(places: Array, kind: ElementKind, corners: int) -> Array:
    """Return area times outward normal of faces, ``1/2 oint r x dr``, exact for straight and parabolic edges."""
    first = places[:, :corners]
    second = np.roll(first, -1, axis=1)
    if not kind.middles:
        return np.asarray(0.5 * np.cross(first, second).sum(axis=1))
    middle = places[:, corners : 2 * corners]
    half = 2.0 / 3.0 * (np.cross(first, middle) + np.cross(middle, second)) - np.cross(first, second) / 6.0
    return np.asarray(half.sum(axis=1))


def _three(word: str, values: Any, check: Any) -> tuple[Any, Any, Any]:
    if isinstance(values, str) or not isinstance(values, (Sequence, np.ndarray)) or len(values) != 3:
        raise ArgumentError(word, "be three numbers, along x, y and z", values)
    first, second, third = (check(f"{word}[{number}]", value) for number, value in enumerate(values))
    return first, second, third


def _heights(given: Any) -> dict[str, float]:
    """Return the thickness of each layer by its name; the name is empty for a single layer."""
    if not isinstance(given, Mapping):
        return {"": positive("height", given)}
    if not given or not all(isinstance(name, str) and name for name in given):
        raise ArgumentError("height", "be a length or lengths of layers by their names", given)
    return {name: positive(f"height[{name!r}]", thickness) for name, thickness in given.items()}


def _divisions(values: Any) -> tuple[int, int, int]:
    """Return numbers of elements along three directions, after a check of the nodes that they make."""
    parts = _three("divisions", values, count)
    _check_nodes("divisions", parts, values)
    return parts


def _check_nodes(name: str, parts: tuple[int, int, int], value: Any) -> None:
    """Raise ValueError if a grid of hexahedra of 20 nodes has too many nodes."""
    corners = math.prod(part + 1 for part in parts)
    nodes = corners + sum(corners // (part + 1) * part for part in parts)
    if nodes > MOST_NODES:
        raise ArgumentError(name, f"make at most {MOST_NODES} nodes", value, got=nodes)


def place_of(word: str, values: Any) -> tuple[float, float, float]:
    """Return coordinates as three finite numbers."""
    return _three(word, values, finite)


def _two(word: str, values: Any) -> tuple[float, float]:
    if isinstance(values, str) or not isinstance(values, (Sequence, np.ndarray)) or len(values) != 2:
        raise ArgumentError(word, "be two numbers", values)
    return finite(f"{word}[0]", values[0]), finite(f"{word}[1]", values[1])
