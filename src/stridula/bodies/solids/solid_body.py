"""A body meshed in space."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property, lru_cache
from numbers import Integral
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

import numpy as np
import scipy.linalg
import scipy.sparse

from ...arrays import Array
from ...checks import ArgumentError, at_most, choice, count, instance, listed
from ...declared import FREQUENCY, Frequency, Own
from ...doubtful import warn_of
from ...memory import GIB, available_memory
from ...ordinary import of_ordinary_size
from ..body_surfaces import HIGHEST, PointSurface, largest_part
from ..cards import FEW
from ..damping import DampingLaw, checked_damping
from ..drawn_surfaces import DrawnSurface
from ..limits import LARGEST_SIZE, LARGEST_SPARSE, check_size
from ..long_searches import search_told
from ..losses import losses_of, one_loss, with_losses
from ..matrix_input import check_finite, numbers
from ..modes import Modes
from ..named_points import NamedPoints
from ..points import BodyPoint
from ..reduction import sparse_reduction
from ..reduction.factorisation import dissection
from ..reduction.sparse_reduction import SparseProblem, modes_of, reduce_sparse
from ..sections import Material
from .drawn_mesh import surface_of_mesh
from .elements import assembled
from .face_patches import Division, Patches, divided, means_of, name_of_point, patches_of, point_named, points_of
from .places import FacePoints, face_mean, located
from .solid_mesh import Face, SolidMesh, place_of
from .surfaces import cut_faces

DIRECTIONS = "xyz"
# Waves in diamond travel at 18 km/s; a higher speed indicates mixed units.
FASTEST = 30e3
# Rigid motions that move held nodes by less than this share of the size of a body count as free.
RIGID = 1e-9
# Memory [bytes] of the factors of a body of n degrees of freedom over n^(4/3), measured from 36 000 to 109 000, and
# arrays of the size of all residual shapes that exist at a time.
FACTOR, ARRAYS = 700.0, 6.0
# Time of a residual shape over the memory of the factors [s/byte], measured on one core, and the time from which it is
# mentioned [s].
PER_BYTE, LONG = 3.5e-10, 90.0
# Expected modes over the most that are searched for, from which a search is not begun.
FAR = 4.0


@dataclass(frozen=True)
class SolidReduction:
    """Modes of a body in space.

    Attributes
    ----------
    modes : Modes
        The modes, residual shapes last.
    shapes : ndarray, shape (3 nodes, modes)
        Their shapes, the three directions of a node one after the other; zero where nodes are held.
    mass : csr_array, shape (nodes, nodes)
        Mass along one direction [kg].
    """

    modes: Modes
    shapes: Array
    mass: Any


@dataclass(frozen=True, eq=False, repr=False)
class SolidBody(NamedPoints):
    """A linear elastic body given by a mesh in space; its modes are computed on first use.

    Its coordinates are those of the world. Rigid motions not held by `fixed`, six if nothing is fixed, have exactly
    zero frequency. Bodies are compared and hashed by content and cannot be changed.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh. Nodes in the middle of edges are added if missing, as linear elements are too stiff in bending.
    materials : Material or mapping
        One material, or the material of each group of elements by its name; each element must be in one group.
    points : mapping, optional
        Nodes by name: each the name of a set of one node, the number of a node from 0, or coordinates [m] within a
        thousandth of the size of the mesh of a node. Sets of one node are also points by their own names.
    fixed : sequence of str or mapping, optional
        Held groups of faces or nodes: their names, or a mapping from names to the held directions, such as "z" or
        "xyz".
    cutoff : float, optional
        Keep the modes up to this frequency [Hz], rigid ones always; all modes if left out. Must be given for more
        than 4000 degrees of freedom.
    damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
        One damping ratio [1] for every elastic mode, one for each mode kept in the order of increasing frequency, or a
        law of their frequency.
    residual_flexibility : bool, optional
        Whether the modes beyond a cutoff still respond statically to forces at the points and to gravity, so that the
        body has its full static flexibility there.
    linear : bool, optional
        Whether to keep linear elements, without nodes in the middle of their edges.
    contact_faces : sequence of str or mapping, optional
        Groups of faces that touch other bodies, whose full static flexibility is kept as well: their names, or a
        mapping from names to divisions into points. A division is the approximate number of patches, the numbers of
        cells along the longer and the shorter side, such as ``(6, 5)``, or "integration" for every point of
        integration. Each patch carries a uniform pressure and moves as its mean. If left out, a face of at most 64
        points of integration has these, any other some 30 patches.
    name : str, optional
        Name in records; distinguishes equal bodies.

    Raises
    ------
    ValueError
        If an argument is out of its range or does not fit the others.
    """

    kind: ClassVar[str] = "solid"
    has_translation: ClassVar[bool] = True
    has_surface: ClassVar[bool] = True
    is_spatial: ClassVar[bool] = True
    mesh: SolidMesh
    materials: Material | Mapping[str, Material]
    points: Mapping[str, Any] = field(default_factory=dict)
    fixed: Sequence[str] | Mapping[str, str] = ()
    cutoff: Frequency | None = None
    damping: Annotated[float | Sequence[float] | Array | DampingLaw, Own("damping")] = 0.0
    residual_flexibility: bool = True
    linear: bool = False
    contact_faces: Sequence[str] | Mapping[str, Division | None] = ()
    name: str = ""

    def __post_init__(self) -> None:
        instance("mesh", self.mesh, SolidMesh)
        instance("name", self.name, str)
        for word in ("residual_flexibility", "linear"):
            instance(word, getattr(self, word), bool)
        if self.cutoff is not None:
            self._set("cutoff", FREQUENCY.check("cutoff", self.cutoff))
        self._set("damping", checked_damping(self.damping))
        self._set("materials", _materials(self.materials))
        _elements_of(self.materials, self.mesh)
        if not self.linear:
            self._set("mesh", self.mesh.quadratic())
        self._set("points", MappingProxyType(_points(self.points, self.mesh)))
        self._set("fixed", MappingProxyType(_fixed(self.fixed, self.mesh)))
        self._set("contact_faces", MappingProxyType(divided(self.contact_faces, self.mesh, "contact_faces")))
        for name in self.points:
            if self._patch(name) is not None:
                raise ArgumentError("points", "not have the name of a contact point of a face", name)
        size = int(self._free.sum())
        if not size:
            raise ArgumentError("fixed", "leave something free", got="all nodes held")
        check_size("mesh", size, LARGEST_SPARSE)
        if self.cutoff is None and size > LARGEST_SIZE:
            raise ArgumentError(
                "cutoff", f"be given for more than {LARGEST_SIZE} degrees of freedom", got=f"none for {size}"
            )

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        materials: Material | Mapping[str, Material],
        *,
        scale: float = 1.0,
        part: str | None = None,
        **options: Any,
    ) -> SolidBody:
        """Read a body from a mesh file.

        Parameters
        ----------
        path : str or Path
            File of gmsh (``.msh``), Abaqus or CalculiX (``.inp``), Nastran (``.bdf``, ``.nas``, ``.fem``, ``.dat``) or
            VTK (``.vtk``, ``.vtu``), see `SolidMesh.read`.
        materials : Material or mapping
            As in `SolidBody`.
        scale : float, optional
            Length of the unit of the file [m], 0.001 for millimetres.
        part : str, optional
            The part to read of a file with several, see `SolidMesh.read`; `read_parts` reads all, with materials.
        **options
            As in `SolidBody`: `points`, `fixed`, `cutoff` and so on.

        Raises
        ------
        OSError
            If the file cannot be read.
        ValueError
            As in `SolidMesh.read` and `SolidBody`.
        """
        return cls(SolidMesh.read(path, scale, part), materials, **options)

    @classmethod
    def block(
        cls,
        lengths: Sequence[float],
        divisions: Sequence[int],
        materials: Material | Mapping[str, Material],
        **options: Any,
    ) -> SolidBody:
        """Return a block, see `SolidMesh.block`.

        Parameters
        ----------
        lengths : sequence of float, length 3
            Sides along x, y and z [m]; one corner is the origin.
        divisions : sequence of int, length 3
            Numbers of elements along x, y and z.
        materials : Material or mapping
            As in `SolidBody`.
        **options
            As in `SolidBody`.
        """
        return cls(SolidMesh.block(lengths, divisions), materials, **options)

    def face(self, name: str) -> Face:
        """Return a named part of its surface: nodes, areas and normals."""
        return self.mesh.face(name)

    def face_points(self, name: str) -> FacePoints:
        """Return the contact points on a named part of its surface: places, areas and normals.

        They are those of `contact_faces`: points of integration, or the centres of patches.
        """
        choice("name", name, self.face_names or ("none",))
        return points_of(self.mesh, name, self._division(name))

    def patches(self, name: str) -> Patches | None:
        """Return the patches of a named part of its surface; None if its contact points are those of integration."""
        return patches_of(self.mesh, name, self._division(name))

    def contact_point(self, name: str, number: int) -> BodyPoint:
        """Return a contact point of a named part of its surface by its number from 0."""
        if self.patches(name) is None:
            return self.at(self.face_points(name).place[number].tolist())
        return self.at(name_of_point(name, number))

    def at(self, position: str | Sequence[float]) -> BodyPoint:
        """Return the point of a name, the mean over a named face, or the point at (x, y, z) within the mesh [m].

        A force on the mean over a face is distributed evenly over it, along a constant direction. The patches of a face
        "rub" are "rub[1]", "rub[2]" and so on.
        """
        return BodyPoint(self, position if isinstance(position, str) else place_of("position", position))

    def check_position(self, position: Any) -> None:
        """Raise ValueError unless `position` is the name of a point or of a face, or (x, y, z) within the mesh."""
        if isinstance(position, str):
            if position not in self.points and self._patch(position) is None:
                choice("position", position, (*self.point_names, *self.face_names))
        else:
            located(self.mesh, place_of("position", position))

    @property
    def axes(self) -> Array:
        """World components of its axes, which are x, y and z, shape (3, 3)."""
        return np.eye(3)

    @property
    def point_names(self) -> tuple[str, ...]:
        """Names of its points."""
        return tuple(self.points)

    @property
    def face_names(self) -> tuple[str, ...]:
        """Names of the parts of its surface."""
        return tuple(self.mesh.faces)

    @property
    def largest_side(self) -> float:
        """Largest of its sides along x, y and z [m]."""
        return float(self.mesh.size.max())

    # The argument that gives points residual shapes.
    yields_by: ClassVar[str] = "points"

    def yields_at(self, position: str | Sequence[float]) -> bool:
        """Return whether a place has residual shapes of its own, as points with a name do."""
        return isinstance(position, str)

    @property
    def dimensions(self) -> str:
        """Size in words."""
        sides = " x ".join(f"{side:.4g}" for side in self.mesh.size)
        return f"{sides} m, {len(self.mesh.elements)} {self.mesh.element_kind.words}"

    @property
    def has_modes_at_hand(self) -> bool:
        """Whether its modes are already computed, or quick to compute."""
        return "_reduction" in vars(self) or 3 * len(self.mesh.nodes) <= FEW

    @property
    def has_mass_at_hand(self) -> bool:
        """Whether its mass is known or quick to compute: it is computed with the modes."""
        return self.has_modes_at_hand

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""
        return float(self._reduction.mass.sum())

    @property
    def shapes(self) -> Array:
        """Mass-normalised mode shapes at the nodes, residual shapes last, shape (3 nodes, modes)."""
        return self._reduction.shapes

    def surface(self, frequency: float = HIGHEST) -> PointSurface:
        """Return the outer surface as points with its mode shapes, fine enough for sound up to a frequency [Hz]."""
        return _surface(self, largest_part(frequency))

    @property
    def expected_modes(self) -> float:
        """Lower bound of the number of modes below the cutoff; zero without one."""
        return 0.0 if self.cutoff is None else _expected(self, float(_assembled(self)[0].sum()))

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes; `held_x` is for bodies with a driven end and must be false."""
        if held_x:
            raise ArgumentError("held_x", "be False for a SolidBody: it has no driven end", held_x)
        return self._reduction.modes

    def trace(self, position: Any, held_x: bool = False) -> Array:
        """Return the rows that give the displacement (x, y, z) of a point from the modes, shape (3, modes)."""
        self.check_position(position)
        self.modes(held_x)
        if position in self.points:
            node = self.points[position]
            return self.shapes[3 * node : 3 * node + 3]
        if isinstance(position, str):
            patch = self._patch(position)
            if patch is None:
                mean = face_mean(self.mesh, position)
                nodes, shares = np.flatnonzero(mean), mean[mean != 0.0]
            else:
                mean = patch[0].mean[[patch[1]]]
                nodes, shares = mean.indices, mean.data
        else:
            nodes, shares = located(self.mesh, place_of("position", position))
        return np.einsum("n,nim->im", shares, self.shapes.reshape(len(self.mesh.nodes), 3, -1)[nodes])

    def place(self, position: Any) -> Array:
        """Return the world place of a point at rest [m], shape (3,); for a face its middle."""
        self.check_position(position)
        if position in self.points:
            return np.asarray(self.mesh.nodes[self.points[position]])
        if isinstance(position, str):
            patch = self._patch(position)
            if patch is not None:
                return np.array(patch[0].points.place[patch[1]])
            return np.asarray(face_mean(self.mesh, position) @ self.mesh.nodes)
        return np.array(place_of("position", position))

    @property
    def drawn(self) -> DrawnSurface:
        """Surface for drawing: the faces that belong to one element only and are not tied, with their mode shapes."""
        return surface_of_mesh(self.mesh, self.shapes)

    @property
    def drawn_at_rest(self) -> DrawnSurface:
        """Surface for drawing, without modes, which need not be known."""
        return surface_of_mesh(self.mesh, np.zeros((3 * len(self.mesh.nodes), 0)))

    def modal_coordinates(self, vector: Any) -> Array:
        """Return ``Phi^T M x`` of displacements or velocities x of all nodes, shape (nodes, 3), as shape (modes,).

        They are zero for residual shapes, which depend on the forces alone.
        """
        values = numbers("vector", vector)
        count = len(self.mesh.nodes)
        if values.shape not in ((3 * count,), (count, 3)):
            raise ArgumentError("vector", f"have the shape ({count}, 3)", vector, got=values.shape)
        check_finite("vector", values)
        moved = (self._reduction.mass @ values.reshape(count, 3)).ravel()
        return np.where(self.modes().massless, 0.0, self.shapes.T @ moved)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._digest == getattr(other, "_digest", None)

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        name = f", name={self.name!r}" if self.name else ""
        return f"SolidBody({self.dimensions}, points {listed(self.points)}{name})"

    def __getstate__(self) -> dict[str, Any]:
        # The modes are included, so that another process need not compute them again.
        return {
            name: dict(value) if isinstance(value, MappingProxyType) else value for name, value in vars(self).items()
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name, value in state.items():
            self._set(name, MappingProxyType(value) if isinstance(value, dict) else value)
        for array in (self._reduction.shapes,) if "_reduction" in state else ():
            array.flags.writeable = False

    def _division(self, name: str) -> Division | None:
        """Return the division of a face into contact points, None if none is given."""
        return self.contact_faces.get(name)  # type: ignore[union-attr]

    def _patch(self, position: str) -> tuple[Patches, int] | None:
        """Return the patches of a face and a number from 0 if a position names one of them, such as "rub[7]"."""
        found = point_named(position, self.mesh.faces)
        patches = None if found is None else self.patches(found[0])
        if found is None or patches is None or found[1] >= len(patches.points.area):
            return None
        return patches, found[1]

    @property
    def _free(self) -> Array:
        """Mask of the degrees of freedom that neither are held nor follow others, shape (3 nodes,)."""
        held = np.zeros((len(self.mesh.nodes), 3), dtype=bool)
        for name, directions in self.fixed.items():  # type: ignore[union-attr]
            for direction in directions:
                held[self.mesh.nodes_of(name), DIRECTIONS.index(direction)] = True
        # Nodes are held if others that follow them are.
        held = abs(self.mesh.shares).T @ held > 0.0
        return (~held & self.mesh.leads[:, None]).ravel()

    @cached_property
    def _digest(self) -> bytes:
        content = hashlib.sha256(self.mesh._digest)
        for one in fields(self)[1:]:
            value = getattr(self, one.name)
            content.update(repr(sorted(value.items()) if isinstance(value, Mapping) else value).encode())
        return content.digest()

    @cached_property
    def _reduction(self) -> SolidReduction:
        return _reduced(self)

    def _set(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)


def _assembled(body: SolidBody) -> tuple[Any, Any]:
    mesh = body.mesh
    materials = _elements_of(body.materials, mesh)
    return assembled(mesh.element_kind, mesh.nodes, mesh.elements, materials)


def _losses(body: SolidBody, stiffness: Any, shapes: Array) -> float | Array:
    """Return the loss factor of each mode, or that of all."""
    mesh = body.mesh
    materials, elements = zip(*_elements_of(body.materials, mesh), strict=True)
    same = one_loss(materials)
    if same is not None:
        return same
    stiffer = list(zip(with_losses(materials), elements, strict=True))
    return losses_of(stiffness, assembled(mesh.element_kind, mesh.nodes, mesh.elements, stiffer)[1], shapes)


@lru_cache(maxsize=4)
@of_ordinary_size("mesh and materials")
def _reduced(body: SolidBody) -> SolidReduction:
    """Return the modes of a body; equal bodies share them."""
    with search_told(body, 3 * len(body.mesh.nodes)):
        return _searched(body)


def _searched(body: SolidBody) -> SolidReduction:
    node_mass, stiffness = _assembled(body)
    mesh, free = body.mesh, body._free
    if body.cutoff is not None and free.sum() > LARGEST_SIZE:
        _check_modes(body, float(node_mass.sum()))
    _check_memory(int(free.sum()), 3 * sum(len(body.face_points(name).area) for name in body.contact_faces))
    mass = scipy.sparse.kron(node_mass, scipy.sparse.eye_array(3), format="csr")
    uniform = np.tile(np.eye(3), (len(mesh.nodes), 1))
    pulled = mass @ uniform
    nodes = np.array(list(body.points.values()), dtype=np.int64)
    onto = scipy.sparse.kron(mesh.shares, scipy.sparse.eye_array(3), format="csr")[:, free]
    forces = onto.T @ pulled
    if body.residual_flexibility:
        at_points = np.zeros((free.size, 3 * nodes.size))
        at_points[(3 * nodes[:, None] + np.arange(3)).ravel(), np.arange(3 * nodes.size)] = 1.0
        at_integration, on_patches = _on_faces(body)
        forces = np.hstack([onto.T @ at_points, onto.T @ at_integration, forces])
        patches = onto.T @ on_patches if on_patches.size else None
    else:
        forces, patches = forces[:, :0], None
    own_mass, own_stiffness = (onto.T @ matrix @ onto for matrix in (mass, stiffness))
    problem = SparseProblem(
        own_mass,
        own_stiffness,
        forces,
        patches,
        _rigid(mesh, free, own_mass),
        _order(mesh, mesh.shares.T @ node_mass @ mesh.shares, free),
    )
    found = reduce_sparse(problem, body.cutoff)
    shapes = onto @ found.shapes
    shapes.flags.writeable = False
    lost = _losses(body, stiffness, shapes)
    return SolidReduction(modes_of(found, body.damping, pulled.T @ shapes, lost), shapes, node_mass)


@lru_cache(maxsize=4)
def _surface(body: SolidBody, largest: float) -> PointSurface:
    moving = ~body.modes().massless
    shapes = body.shapes.reshape(len(body.mesh.nodes), 3, -1)[:, :, moving]
    return cut_faces(body.mesh, shapes, largest)


def _check_memory(size: int, shapes: int) -> None:
    """Raise ValueError if factors and residual shapes exceed the memory of the machine, before they are computed.

    Much time is mentioned in a warning.
    """
    factor = FACTOR * size ** (4.0 / 3.0)
    needed = factor + 8.0 * ARRAYS * size * shapes
    if needed > available_memory():
        got = (
            f"some {needed / GIB:.2g} of {available_memory() / GIB:.2g} GiB for {shapes} residual shapes of "
            f"{size} degrees of freedom; give fewer points, such as {{'rub': 30}}, or a coarser mesh"
        )
        raise ArgumentError("contact_faces", "need less memory than there is", got=got)
    seconds = PER_BYTE * factor * shapes
    if seconds > LONG:
        words = f"{shapes} residual shapes of {size} degrees of freedom take some {seconds / 60.0:.1g} min and"
        warn_of([f"{words} {needed / GIB:.1g} GiB; give contact_faces fewer points, such as {{'rub': 30}}"])


def _check_modes(body: SolidBody, mass: float) -> None:
    """Raise ValueError if far too many modes lie below the cutoff, before any is searched for."""
    expected = _expected(body, mass)
    if expected > FAR * sparse_reduction.MOST_MODES:
        words = f"leave at most {sparse_reduction.MOST_MODES} modes of a mesh"
        got = f"{body.cutoff:.6g} Hz, below which there are {at_most(expected, 2)} or more"
        raise ArgumentError("cutoff", words, body.cutoff, got=got)


def _expected(body: SolidBody, mass: float) -> float:
    """Return a lower bound of the number of modes below the cutoff.

    Shear waves alone have ``V 8 pi / 3 (f / c)³`` modes below f in a volume V (Debye 1912), and thin bodies more; the
    heaviest and the fastest material give a lower bound.
    """
    materials = list(body.materials.values()) if isinstance(body.materials, Mapping) else [body.materials]
    fastest = max(one.young / (2.0 * (1.0 + one.poisson) * one.density) for one in materials) ** 0.5
    volume = mass / max(one.density for one in materials)
    return float(volume * 8.0 * np.pi / 3.0 * ((body.cutoff or 0.0) / fastest) ** 3)


def _on_faces(body: SolidBody) -> tuple[Array, Array]:
    """Return unit forces at the points of integration and on the patches of faces, along x, y and z each."""
    at_points, on_patches = list[Any](), list[Any]()
    for name in body.contact_faces:
        found = at_points if body.patches(name) is None else on_patches
        found.append(means_of(body.mesh, name, body._division(name)))
    return _along_axes(body, at_points), _along_axes(body, on_patches)


def _along_axes(body: SolidBody, shares: list[Any]) -> Array:
    """Return unit forces along x, y and z from the share of each node, shape (3 nodes, forces)."""
    if not shares:
        return np.zeros((3 * len(body.mesh.nodes), 0))
    return np.asarray(scipy.sparse.kron(scipy.sparse.vstack(shares), scipy.sparse.eye_array(3)).T.toarray())


def _rigid(mesh: SolidMesh, free: Array, mass: Any) -> Array:
    """Return the rigid motions that held nodes allow, mass-normalised, shape (free, motions)."""
    size = float(np.linalg.norm(mesh.size))
    places = (mesh.nodes - mesh.nodes.mean(axis=0)) / size
    turns = [np.cross(axis, places).ravel() for axis in np.eye(3)]
    motions = np.column_stack([np.tile(np.eye(3), (len(places), 1)), *turns])
    held = motions[~free & np.repeat(mesh.leads, 3)]
    if held.size:
        _, share, ways = scipy.linalg.svd(held, full_matrices=len(held) < 6)
        share = np.append(share, np.zeros(6 - share.size))
        motions = motions @ ways[share <= RIGID * max(share[0], 1.0)].T
    own = motions[free]
    # Cholesky twice, so that they are as accurate as the coordinates.
    for _ in range(2 if own.shape[1] else 0):
        factor = np.linalg.cholesky(own.T @ (mass @ own))
        own = scipy.linalg.solve_triangular(factor, own.T, lower=True).T
    return own


def _order(mesh: SolidMesh, graph: Any, free: Array) -> Array:
    """Return an order of elimination of the degrees of freedom that are not held."""
    every = (3 * dissection(graph, mesh.nodes)[:, None] + np.arange(3)).ravel()
    number = np.cumsum(free) - 1
    return np.asarray(number[every[free[every]]])


def _materials(given: Any) -> Any:
    """Return one material, or materials by name, after checks of their units."""
    if isinstance(given, Mapping):
        if not given:
            raise ArgumentError("materials", "be a material, or hold at least one", given)
        for name, material in given.items():
            _check_material(f"materials[{name!r}]", material)
        return MappingProxyType(dict(given))
    _check_material("materials", given)
    return given


def _check_material(word: str, material: Any) -> None:
    instance(word, material, Material)
    speed = np.sqrt(material.young / material.density)
    if speed > FASTEST:
        raise ArgumentError(
            word,
            f"carry waves of at most {at_most(FASTEST / 1000.0)} km/s",
            material,
            got=(
                f"{speed / 1000.0:.4g} km/s from young={material.young:g} and density={material.density:g}: give "
                "Pa and kg/m³, not tonnes and millimetres"
            ),
        )


def _elements_of(materials: Any, mesh: SolidMesh) -> list[tuple[Material, Array]]:
    """Return each material with the numbers of its elements, which must cover the mesh once."""
    if not isinstance(materials, Mapping):
        return [(materials, np.arange(len(mesh.elements)))]
    times = np.zeros(len(mesh.elements), dtype=np.int64)
    found = []
    for name, material in materials.items():
        choice("materials", name, tuple(mesh.volumes) or ("none",))
        times[mesh.volumes[name]] += 1
        found.append((material, mesh.volumes[name]))
    for bad, words in ((times == 0, "without a material"), (times > 1, "of two")):
        if bad.any():
            others = listed(name for name in mesh.volumes if name not in materials)
            raise ArgumentError(
                "materials",
                "give each element a material",
                got=f"{bad.sum()} of {bad.size} {words}; other groups: {others}",
            )
    return found


def _points(given: Any, mesh: SolidMesh) -> dict[str, int]:
    """Return the numbers of nodes by the names of points."""
    instance("points", given, Mapping)
    own = {name: int(nodes[0]) for name, nodes in mesh.node_sets.items() if nodes.size == 1}
    return own | {name: _node(name, where, mesh, own) for name, where in given.items()}


def _node(name: Any, where: Any, mesh: SolidMesh, own: Mapping[str, int]) -> int:
    if not isinstance(name, str) or not name:
        raise ArgumentError("points", "have names that are text", name)
    word = f"points[{name!r}]"
    if isinstance(where, str):
        return own[choice(word, where, tuple(own) or ("none",))]
    if isinstance(where, Integral):
        return count(word, where, low=0, high=len(mesh.nodes) - 1)
    try:
        return mesh.node_at(where)
    except ArgumentError as error:
        raise error.renamed(word) from None


def _fixed(given: Any, mesh: SolidMesh) -> dict[str, str]:
    """Return the held directions of groups by their names."""
    if isinstance(given, str) or not isinstance(given, (Sequence, Mapping)):
        raise ArgumentError("fixed", "be names of groups, or directions by name", given)
    found = {}
    for name in given:
        choice("fixed", name, (*mesh.faces, *mesh.node_sets) or ("none",))
        directions = given[name] if isinstance(given, Mapping) else DIRECTIONS
        word = f"fixed[{name!r}]"
        is_text = isinstance(directions, str) and directions
        if not is_text or set(directions) - set(DIRECTIONS) or len(set(directions)) < len(directions):
            raise ArgumentError(word, "be directions of x, y and z, such as 'xz'", directions)
        found[name] = "".join(sorted(directions))
    return found
