"""Profiles of bodies of revolution: unions of rectangles, lines with a thickness, meshes in the half-plane."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, Protocol

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, brief, finite, instance, non_negative, positive
from ..modes import hashed_once
from .profile_mesh import BODY, MOST_MADE, SAME_PLACE, ProfileMesh, checked_mesh, lines, merged, overlap

Range = tuple[float, float]
# Whole numbers from here on are not exact as floats.
LARGEST_WHOLE = 2**53
# Largest side [m] of the cells of a part, given its thickness [m] and its region.
Size = Callable[[float, str], float]


class Profile(Protocol):
    """The section of a body of revolution through its axis, the half with r >= 0.

    Attributes
    ----------
    shape : str
        Name in scenarios.
    """

    shape: ClassVar[str]

    @property
    def size(self) -> float | None:
        """Largest side of its cells [m], None if it depends on the shortest waves."""

    @property
    def follows_waves(self) -> bool:
        """Whether its cells are chosen for the shortest waves."""

    @property
    def region_names(self) -> tuple[str, ...]:
        """Names of its regions, each with one material."""

    def mesh(self, size: Size) -> ProfileMesh:
        """Return its cells, with sides up to `size` for the thickness of each part unless the cells are given."""


@hashed_once
@dataclass(frozen=True)
class RectangleProfile:
    """A profile made of rectangles that share sides: discs, rings, discs with hats, stepped wheels.

    Lines through all corners divide it, so that the cells of neighbours of any size fit together.

    Parameters
    ----------
    rectangles : mapping or sequence of tuple
        Rectangle of each region by its name: range of r and range of z [m], such as
        ``{"disc": ((0.05, 0.15), (0.0, 0.01))}``. With a sequence of pairs of a name and a rectangle, a region may have
        several rectangles.
    size : float, optional
        Largest side of a cell [m]; if left out, chosen for the shortest waves below the cutoff. There are at least two
        cells across every rectangle.

    Raises
    ------
    ValueError
        If a range does not increase, if a rectangle crosses the axis or overlaps another one, or if they are not
        connected by their sides.
    """

    shape: ClassVar[str] = "rectangles"
    rectangles: Any
    size: float | None = None

    def __post_init__(self) -> None:
        given = self.rectangles.items() if isinstance(self.rectangles, Mapping) else self.rectangles
        object.__setattr__(self, "rectangles", _rectangles(given))
        if self.size is not None:
            positive("size", self.size)
        shared = overlap(dict(enumerate(self._boxes)), self._margin)
        if shared:
            (first, _), (second, _) = (self.rectangles[number] for number in shared)
            raise ArgumentError("rectangles", "not overlap", got=f"{first!r} and {second!r} with an area in common")
        self.mesh(_any_size)

    @property
    def follows_waves(self) -> bool:
        """Whether its cells are chosen for the shortest waves."""
        return self.size is None

    @property
    def region_names(self) -> tuple[str, ...]:
        """Names of its regions."""
        return tuple(dict.fromkeys(name for name, _ in self.rectangles))

    def mesh(self, size: Size) -> ProfileMesh:
        """Return its cells, in each rectangle with sides up to `size` for its shorter side."""
        boxes = self._boxes
        sizes = np.array([size(float(np.diff(box).min()), name) for name, box in self.rectangles])
        r, z = (self._lines(axis, sizes) for axis in (0, 1))
        # Lines also divide the space between rectangles.
        _check_count(float(len(r)) * len(z) * len(boxes) / 50.0)
        middle = np.stack(np.meshgrid(0.5 * (r[1:] + r[:-1]), 0.5 * (z[1:] + z[:-1]), indexing="ij"), axis=2)
        low, high = boxes[:, None, None, :, 0], boxes[:, None, None, :, 1]
        inside: Array = np.all((middle[None] > low) & (middle[None] < high), axis=3)
        i, j = np.nonzero(inside.any(axis=0))
        owner = inside[:, i, j].argmax(axis=0)
        corner = i * len(z) + j
        cells = np.stack([corner, corner + len(z), corner + len(z) + 1, corner + 1], axis=1)
        used, cells = np.unique(cells, return_inverse=True)
        nodes = np.stack([r[used // len(z)], z[used % len(z)]], axis=1)
        named = np.array([self.region_names.index(name) for name, _ in self.rectangles])[owner]
        regions = {name: np.flatnonzero(named == k) for k, name in enumerate(self.region_names)}
        return checked_mesh("rectangles", nodes, cells.reshape(-1, 4), regions)

    def _lines(self, axis: int, sizes: Array) -> Array:
        """Return the coordinates of the dividing lines along an axis, given the size of the cells of each rectangle."""
        values, spans = merged(self._boxes[:, axis].ravel(), self._margin), self._boxes[:, axis]
        middle = 0.5 * (values[1:] + values[:-1])
        inside = (spans[:, :1] < middle) & (middle < spans[:, 1:])
        # Intervals without a rectangle have no limit.
        allowed = np.minimum(np.where(inside, sizes[:, None], math.inf).min(axis=0), np.diff(values))
        _check_count(float((np.diff(values) / allowed).sum()))
        return lines(values, allowed, least=2)

    @property
    def _boxes(self) -> Array:
        return np.array([box for _, box in self.rectangles])

    @property
    def _margin(self) -> float:
        return SAME_PLACE * float(np.ptp(self._boxes, axis=(0, 2)).max())


@hashed_once
@dataclass(frozen=True)
class LineProfile:
    """A profile given by its middle line and thickness: glasses, bells, shells, wheels with curved webs.

    Half the thickness lies on either side of the line. At an end on the axis the end section lies on the axis.

    Parameters
    ----------
    points : sequence of tuple
        Points (r, z) of the middle line in order [m]; it is straight between them.
    thickness : float or sequence of float
        Thickness, or thickness at each point, linear between them [m].
    size : float, optional
        Largest side of a cell along the line [m]; if left out, chosen for the shortest waves below the cutoff. There
        are two cells across.

    Raises
    ------
    ValueError
        If there are fewer than two points, if consecutive points coincide, if the profile crosses the axis or itself,
        or if the line bends too sharply for its thickness.
    """

    shape: ClassVar[str] = "line"
    points: Any
    thickness: float | Sequence[float]
    size: float | None = None

    def __post_init__(self) -> None:
        points = tuple(_pair(f"points[{k}]", point) for k, point in enumerate(_sequence("points", self.points)))
        object.__setattr__(self, "points", points)
        if len(points) < 2:
            raise ArgumentError("points", "be two or more", got=len(points))
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        if steps.min() <= SAME_PLACE * float(np.ptp(points, axis=0).max()):
            at = int(np.argmin(steps))
            raise ArgumentError(f"points[{at + 1}]", "differ from the one before it", points[at + 1])
        if isinstance(self.thickness, (Sequence, np.ndarray)) and not isinstance(self.thickness, str):
            each = tuple(positive(f"thickness[{k}]", one) for k, one in enumerate(self.thickness))
            if len(each) != len(points):
                raise ArgumentError("thickness", f"be one or {len(points)}, one for each point", got=len(each))
            object.__setattr__(self, "thickness", each)
        else:
            positive("thickness", self.thickness)
        if self.size is not None:
            positive("size", self.size)
        self.mesh(_any_size)

    @property
    def follows_waves(self) -> bool:
        """Whether its cells are chosen for the shortest waves."""
        return self.size is None

    @property
    def region_names(self) -> tuple[str, ...]:
        """Name of its only region."""
        return (BODY,)

    def mesh(self, size: Size) -> ProfileMesh:
        """Return its cells, with sides along the line up to `size` for the thickness there."""
        points = np.array(self.points)
        thick = np.broadcast_to(np.asarray(self.thickness, dtype=float), len(points))
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        sizes = np.array([min(size(float(min(pair)), BODY), steps.sum()) for pair in pairwise(thick)])
        _check_count(2.0 * float((steps / sizes).sum()))
        place = np.concatenate([[0.0], np.cumsum(steps)])
        along = lines(place, sizes)
        offset = 0.5 * thick[:, None] * _across(points)
        middle, half = (np.stack([np.interp(along, place, c) for c in one.T], axis=1) for one in (points, offset))
        nodes = np.stack([middle - half, middle, middle + half], axis=1).reshape(-1, 2)
        first = 3 * np.arange(len(along) - 1)[:, None] + [0, 1]
        cells = np.stack([first, first + 3, first + 4, first + 1], axis=2).reshape(-1, 4)
        end = 3 * (len(along) - 1)
        edges = {"start": np.array([[0, 1], [1, 2]]), "end": end + np.array([[0, 1], [1, 2]])}
        return checked_mesh("points and thickness", nodes, cells, {BODY: np.arange(len(cells))}, edges)


@dataclass(frozen=True, eq=False, repr=False)
class MeshProfile:
    """A profile given by the cells of a mesh, all of them triangles or all quadrilaterals, with straight sides.

    Profiles are compared and hashed by content and cannot be changed.

    Parameters
    ----------
    nodes : array_like, shape (nodes, 2)
        Distance r from the axis and place z along it of each node [m].
    cells : array_like of int, shape (cells, 3) or (cells, 4)
        Nodes of each cell from 0, in either sense of rotation.
    regions : mapping, optional
        Numbers of the cells of each region by its name; each cell must be in exactly one.
    edges : mapping, optional
        Pairs of nodes of each named edge, which can be held, shape (sides, 2).

    Raises
    ------
    ValueError
        If numbers of nodes or cells are wrong, if the cells cross the axis or each other or form several pieces, or if
        the regions do not contain each cell once.
    """

    shape: ClassVar[str] = "mesh"
    size: ClassVar[float | None] = None
    follows_waves: ClassVar[bool] = False
    nodes: Any
    cells: Any
    regions: Any = field(default_factory=dict)
    edges: Any = field(default_factory=dict)

    def __post_init__(self) -> None:
        nodes, cells = _numbers("nodes", self.nodes, float), _numbers("cells", self.cells, int)
        if nodes.ndim != 2 or nodes.shape[1] != 2 or not np.isfinite(nodes).all():
            raise ArgumentError("nodes", "be finite numbers of shape (nodes, 2)", got=f"shape {nodes.shape}")
        if cells.ndim != 2 or cells.shape[1] not in (3, 4) or not len(cells):
            raise ArgumentError("cells", "have the shape (cells, 3) or (cells, 4)", got=f"shape {cells.shape}")
        instance("regions", self.regions, Mapping)
        instance("edges", self.edges, Mapping)
        named = {name: _numbers(f"regions[{name!r}]", one, int).ravel() for name, one in self.regions.items()}
        regions = named or {BODY: np.arange(len(cells))}
        edges = {name: _numbers(f"edges[{name!r}]", one, int).reshape(-1, 2) for name, one in self.edges.items()}
        for name, one in (("cells", cells), *((f"edges[{name!r}]", one) for name, one in edges.items())):
            if one.size and not (one.min() >= 0 and one.max() < len(nodes)):
                raise ArgumentError(name, f"be numbers of nodes, from 0 to {len(nodes) - 1}", got=f"{one.max()}")
        _check_division(regions, len(cells))
        object.__setattr__(self, "_mesh", checked_mesh("cells", nodes, cells, regions, edges))
        for name in ("nodes", "cells", "regions", "edges"):
            object.__setattr__(self, name, getattr(self._mesh, name))  # type: ignore[attr-defined]

    @classmethod
    def read(cls, path: str | os.PathLike[str], scale: float = 1.0, plane: str = "xy") -> MeshProfile:
        """Read a profile from a mesh file: gmsh, Abaqus, Nastran, VTK or any other format of meshio.

        Parameters
        ----------
        path : str or path
            The file. Named groups of cells become regions, cells of no group a region named ``body``; if any groups
            share cells, all groups are ignored. Named groups of lines become edges that can be held. If triangles and
            quadrilaterals are mixed, the latter are halved; sides are taken as straight.
        scale : float, optional
            Length of the file's unit [m]: 1e-3 for millimetres.
        plane : {"xy", "xz", "yz"}, optional
            Coordinates of the file that are r and z.

        Raises
        ------
        OSError
            If the file cannot be read.
        ValueError
            If it holds no profile.
        """
        from .mesh_files import read_profile

        return cls(*read_profile(path, positive("scale", scale), plane))

    @property
    def region_names(self) -> tuple[str, ...]:
        """Names of its regions."""
        return tuple(self.regions)

    def mesh(self, size: Size) -> ProfileMesh:
        """Return its cells; `size` has no effect."""
        found: ProfileMesh = self._mesh  # type: ignore[attr-defined]
        return found

    def __eq__(self, other: object) -> bool:
        return type(other) is MeshProfile and self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        return f"MeshProfile({len(self.cells)} cells, {', '.join(self.regions)})"

    def __reduce__(self) -> tuple[Any, ...]:
        return MeshProfile, (self.nodes, self.cells, dict(self.regions), dict(self.edges))

    @cached_property
    def _digest(self) -> bytes:
        content = hashlib.sha256(repr((self.nodes.shape, self.cells.shape)).encode())
        for group in ({"nodes": self.nodes, "cells": self.cells}, self.regions, self.edges):
            for name, one in group.items():
                content.update(repr((name, one.shape)).encode())
                content.update(one.tobytes())
        return content.digest()


def _across(points: Array) -> Array:
    """Return the mitre vectors of a line at its points, to its left, for an offset of 1, shape (n, 2)."""
    along = np.diff(points, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    normals = np.stack([-along[:, 1], along[:, 0]], axis=1)
    before, after = np.vstack([normals[:1], normals]), np.vstack([normals, normals[-1:]])
    # The offset lines at a distance of 1 meet at the mitre vector.
    share = 1.0 + np.sum(before * after, axis=1)
    if share.min() <= SAME_PLACE:
        at = int(np.argmin(share))
        raise ArgumentError("points", "not double back", got=f"a turn at {tuple(points[at].tolist())}")
    across = (before + after) / share[:, None]
    for end in (0, -1):
        if abs(points[end, 0]) <= SAME_PLACE * np.ptp(points, axis=0).max():
            across[end] = [0.0, math.copysign(1.0, across[end, 1])]
    return np.asarray(across)


def _rectangles(given: Any) -> tuple[tuple[str, tuple[Range, Range]], ...]:
    found = []
    for one in _sequence("rectangles", given):
        if not isinstance(one, Sequence) or len(one) != 2 or not isinstance(one[0], str):
            raise ArgumentError("rectangles", "be ranges of r and z by the name of their region", one)
        name, box = one
        if not name or "." in name:
            raise ArgumentError("rectangles", "have names without a dot", name)
        if not isinstance(box, (Sequence, np.ndarray)) or len(box) != 2:
            raise ArgumentError(f"rectangles[{name!r}]", "be a range of r and one of z", box)
        r, z = (_rising(f"{axis} of {name!r}", values) for axis, values in zip("rz", box, strict=True))
        non_negative(f"r of {name!r}", r[0])
        found.append((name, (r, z)))
    if not found:
        raise ArgumentError("rectangles", "be one or more", given)
    return tuple(found)


def _rising(name: str, values: Any) -> Range:
    low, high = _pair(name, values)
    if low >= high:
        raise ArgumentError(name, "increase from its first to its second number", values)
    return low, high


def _pair(name: str, values: Any) -> Range:
    if isinstance(values, str) or not isinstance(values, (Sequence, np.ndarray)) or len(values) != 2:
        raise ArgumentError(name, "be two numbers", values)
    return finite(f"{name}[0]", values[0]), finite(f"{name}[1]", values[1])


def _sequence(name: str, values: Any) -> list[Any]:
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise ArgumentError(name, "be a list", values)
    return list(values)


def _numbers(name: str, values: Any, kind: type) -> Array:
    try:
        given: Array | None = np.asarray(values)
    except (TypeError, ValueError, OverflowError):
        given = None
    if given is None or given.dtype.kind not in "iuf":
        raise ArgumentError(name, "be an array of numbers", got=brief(values))
    if kind is int and not ((given == np.round(given)) & (np.abs(given) < LARGEST_WHOLE)).all():
        raise ArgumentError(name, "be whole numbers", got=brief(values))
    return given.astype(kind)


def _check_division(regions: Mapping[str, Array], cells: int) -> None:
    every = np.concatenate(list(regions.values()))
    if not np.array_equal(np.sort(every), np.arange(cells)):
        raise ArgumentError("regions", f"hold each of the {cells} cells once", got=f"{every.size} in {len(regions)}")


def _any_size(thickness: float, region: str) -> float:
    return math.inf


def _check_count(count: float) -> None:
    if not count <= MOST_MADE:
        number = f"{count:.0f}" if count < 1e9 else f"{count:.3g}"
        got = f"{number} and more: give a larger size, or a larger thickness"
        raise ArgumentError("size", f"leave at most {MOST_MADE} cells", got=got)


PROFILES = (RectangleProfile, LineProfile, MeshProfile)
