"""Division of a face into patches by a grid that does not depend on the mesh."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from numbers import Integral
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import scipy  # its parts are imported on first use
import scipy.sparse
import scipy.spatial

from ...arrays import Array
from ...checks import ArgumentError, choice, count
from ...long_tasks import check_wanted
from .overlays import half
from .places import FacePoints, Sampled, face_points, face_values, sampled

if TYPE_CHECKING:
    from .solid_mesh import SolidMesh

# Most patches of a face.
MOST_PATCHES = 2000
# Most points of integration of a face that are used as they are, and approximate number of patches of others.
FEW_POINTS, USUAL = 64, 30
# Least cosine between the normals of one chart and their mean: the area of a cell then differs at most twofold.
ONE_CHART = 0.5
# Cells smaller than this share of the median cell are joined to the nearest one.
SLIVER = 0.35
# Relative difference of the areas of bounding rectangles up to which that along the world axes is preferred.
EQUAL = 0.02
# Least area of a piece of a facet, relative to the facet, that is not due to rounding.
NOTHING = 1e-12
# Points of integration on a triangle with their weights, exact for polynomials of fourth degree (Dunavant 1985).
_A, _B = 0.445948490915965, 0.091576213509771
_WA, _WB = 0.223381589678011 / 2.0, 0.109951743655322 / 2.0
_SHARES = np.array(
    [(1.0 - 2.0 * a, a, a) for a in (_A, _B)]
    + [(a, 1.0 - 2.0 * a, a) for a in (_A, _B)]
    + [(a, a, 1.0 - 2.0 * a) for a in (_A, _B)]
)
_WEIGHTS = np.array([_WA, _WB] * 3)


Division = int | tuple[int, int] | Literal["integration"]


@dataclass(frozen=True)
class Patches:
    """Patches of a face: each carries a uniform pressure, and its displacement is the mean over its area.

    Attributes
    ----------
    points : FacePoints
        Centre, area and mean normal of each patch.
    mean : scipy sparse, shape (patches, nodes)
        Share of each node in the mean over a patch.
    samples : FacePoints
        Points of integration within the patches.
    owner : ndarray of int, shape (samples,)
        Their patches.
    """

    points: FacePoints
    mean: Any
    samples: FacePoints
    owner: Array

    def averaged(self, values: Array) -> Array:
        """Return the mean over each patch of values at its samples, shape (patches,)."""
        sums = np.bincount(self.owner, self.samples.area * values, minlength=len(self.points.area))
        return np.asarray(sums / self.points.area)


def patches_of(mesh: SolidMesh, name: str, division: Division | None) -> Patches | None:
    """Return the patches of a face; None if its contact points are those of integration, by default if they are few."""
    if division is None:
        division = "integration" if len(mesh.faces[name]) * len(mesh.element_kind.faces[0]) <= FEW_POINTS else USUAL
    return None if isinstance(division, str) else patched(mesh, name, division)


def points_of(mesh: SolidMesh, name: str, division: Division | None) -> FacePoints:
    """Return the contact points of a face: places, areas and normals."""
    patches = patches_of(mesh, name, division)
    return face_points(mesh, name) if patches is None else patches.points


def means_of(mesh: SolidMesh, name: str, division: Division | None) -> Any:
    """Return the share of each node in the displacement of each contact point, sparse, shape (points, nodes)."""
    patches = patches_of(mesh, name, division)
    return face_values(mesh, name) if patches is None else patches.mean


def name_of_point(face: str, number: int) -> str:
    """Return the name of a contact point of a face by its number from 0."""
    return f"{face}[{number + 1}]"


def point_named(position: str, faces: Collection[str]) -> tuple[str, int] | None:
    """Return the face and the number from 0 of a contact point by its name, such as "rub[7]"; None for other names."""
    face, _, number = position.removesuffix("]").rpartition("[")
    is_one = face in faces and number.isdecimal() and position.endswith("]") and int(number) > 0
    return (face, int(number) - 1) if is_one else None


def divided(given: Any, mesh: SolidMesh, word: str) -> dict[str, Division | None]:
    """Return the divisions of faces into contact points by their names, None where none is given."""
    if isinstance(given, str):
        given = (given,)
    if not isinstance(given, (Sequence, Mapping)):
        raise ArgumentError(word, "be names of faces, or divisions by name", given)
    for number, name in enumerate(given):
        at = word if isinstance(given, Mapping) else f"{word}[{number}]"
        choice(at, name, tuple(mesh.faces) or ("none",))
    if not isinstance(given, Mapping):
        return dict.fromkeys(given)
    return {name: checked_division(f"{word}[{name!r}]", division) for name, division in given.items()}


def checked_division(word: str, given: Any) -> Division | None:
    """Return a division of a face after checks."""
    if given is None or given == "integration":
        return given
    if isinstance(given, Sequence) and not isinstance(given, str) and len(given) == 2:
        first, second = (count(f"{word}[{k}]", one, low=1, high=MOST_PATCHES) for k, one in enumerate(given))
        count(word, first * second, low=1, high=MOST_PATCHES)
        return first, second
    if isinstance(given, Integral):
        return count(word, given, low=1, high=MOST_PATCHES)
    raise ArgumentError(word, "be a number of patches, two numbers of cells or 'integration'", given)


@lru_cache(maxsize=32)
def patched(mesh: SolidMesh, name: str, division: int | tuple[int, int]) -> Patches:
    """Return a face in patches.

    The grid lies in the plane across the mean normal, along the sides of the smallest rectangle about the face; facets
    are cut along its lines, so that areas are exact. Small cells at the rim belong to the nearest one. A face that
    turns away from its mean normal by more than 60 degrees is divided into parts first.

    Parameters
    ----------
    mesh : SolidMesh
        The mesh.
    name : str
        Name of the face.
    division : int or (int, int)
        Approximate number of patches, or numbers of cells along the longer and the shorter side.
    """
    face = mesh.face(name)
    corners = mesh.nodes[face.nodes[:, : len(mesh.element_kind.faces[0])]]
    charts = _charts(face.area, face.normal)
    if len(charts) > 1 and not isinstance(division, int):
        got = f"{division} for {name!r}, whose normals differ by more than 60 degrees from their mean"
        raise ArgumentError("contact_faces", "have one number for a face that is not nearly flat", got=got)
    area, cell_of, found = float(face.area.sum()), list[Array](), list[Sampled]()
    cells = 0
    for those in charts:
        share = float(face.area[those].sum()) / area
        number = max(1, round(division * share)) if isinstance(division, int) else division
        normal = face.area[those] @ face.normal[those]
        flat, lines = _grid(corners[those], normal / np.linalg.norm(normal), number)
        for facet, on_plane in zip(those.tolist(), flat, strict=True):
            check_wanted()
            for cell, places, weights in _pieces(on_plane, lines):
                found.append(sampled(mesh, mesh.faces[name][facet], places, weights))
                cell_of.append(np.full(len(weights), cells + cell))
        cells += (len(lines[0]) - 1) * (len(lines[1]) - 1)
    return _joined(len(mesh.nodes), np.concatenate(cell_of), found)


def _joined(nodes: int, cell: Array, found: list[Sampled]) -> Patches:
    """Return the patches of the samples of cells, with slivers joined to the nearest patch."""
    place = np.concatenate([one.place for one in found])
    area = np.concatenate([one.area for one in found])
    normal = np.concatenate([one.normal for one in found])
    owner = _without_slivers(np.unique(cell, return_inverse=True)[1].ravel(), place, area)
    count = int(owner.max()) + 1
    sums = np.bincount(owner, area, minlength=count)
    centre, mean_normal = _moment(owner, area, place), _moment(owner, area, normal)
    points = FacePoints(centre / sums[:, None], sums, mean_normal / np.linalg.norm(mean_normal, axis=1)[:, None])
    columns = np.concatenate([np.broadcast_to(one.nodes, one.values.shape).ravel() for one in found])
    values = np.concatenate([(one.area[:, None] * one.values).ravel() for one in found])
    widths = np.concatenate([np.full(len(one.area), one.values.shape[1]) for one in found])
    rows = np.repeat(owner, widths)
    mean = scipy.sparse.csr_array((values / sums[rows], (rows, columns)), shape=(count, nodes))
    return Patches(points, mean, FacePoints(place, area, normal), owner)


def _moment(owner: Array, area: Array, vectors: Array) -> Array:
    """Return the integral of vectors at samples over each cell, shape (cells, 3)."""
    return np.stack([np.bincount(owner, area * column) for column in vectors.T], axis=1)


def _charts(area: Array, normal: Array) -> list[Array]:
    """Return the facets of each part whose normals are close to its mean: all, or one for each side of a cube."""
    mean = area @ normal
    size = float(np.linalg.norm(mean))
    if size > 0.0 and (normal @ mean).min() >= ONE_CHART * size:
        return [np.arange(len(area))]
    side = np.argmax(np.hstack([normal, -normal]), axis=1)
    return [np.flatnonzero(side == k) for k in np.unique(side)]


def _grid(corners: Array, normal: Array, division: int | tuple[int, int]) -> tuple[Array, tuple[Array, Array]]:
    """Return the corners of facets in the plane, shape (facets, corners, 2), and the lines of the grid."""
    axes = np.linalg.svd(normal[None])[2][1:]
    flat = corners @ axes.T
    turned = _along_sides(flat.reshape(-1, 2), axes)
    flat = flat @ turned.T
    low, high = flat.min(axis=(0, 1)), flat.max(axis=(0, 1))
    sides = high - low
    if isinstance(division, int):
        # The face covers a part of the rectangle.
        division = _counts(sides, division * float(sides.prod()) / float(_flat_areas(flat).sum()))
    first, second = (np.linspace(low[k], high[k], division[k] + 1) for k in range(2))
    return flat, (first, second)


def _counts(sides: Array, cells: float) -> tuple[int, int]:
    """Return the numbers of nearly square cells along both sides of a rectangle, some `cells` in all."""
    across = max(1, round(float(np.sqrt(cells * sides[1] / sides[0]))))
    return max(1, round(cells / across)), across


def _flat_areas(flat: Array) -> Array:
    """Return the areas of polygons in a plane, shape (facets,)."""
    after = np.roll(flat, -1, axis=1)
    return np.asarray(0.5 * np.abs((flat[..., 0] * after[..., 1] - flat[..., 1] * after[..., 0]).sum(axis=1)))


def _along_sides(points: Array, axes: Array) -> Array:
    """Return the directions of the longer and the shorter side of the smallest rectangle about points, as rows.

    Of rectangles of nearly equal area, that with a side nearest to a world axis is taken.
    """
    hull = points[scipy.spatial.ConvexHull(points).vertices]
    world = axes.T[np.linalg.norm(axes, axis=0) > EQUAL]
    ways = np.vstack([world, np.roll(hull, -1, axis=0) - hull])
    ways = ways / np.linalg.norm(ways, axis=1)[:, None]
    along, across = hull @ ways.T, hull @ np.stack([-ways[:, 1], ways[:, 0]])
    areas = np.ptp(along, axis=0) * np.ptp(across, axis=0)
    near = np.abs(ways @ axes).max(axis=1)
    close = areas <= (1.0 + EQUAL) * areas.min()
    best = ways[int(np.argmax(np.where(close, np.round(near, 9), -1.0)))]
    turned = np.array([best, [-best[1], best[0]]])
    lengths = np.ptp(hull @ turned.T, axis=0)
    turned = turned if lengths[0] >= (1.0 - EQUAL) * lengths[1] else turned[::-1]
    # The same signs for the same face, however its facets are ordered.
    turned_world = turned @ axes
    signs = np.sign(turned_world[np.arange(2), np.abs(turned_world.round(9)).argmax(axis=1)])
    return np.asarray(turned * signs[:, None])


def _pieces(flat: Array, lines: tuple[Array, Array]) -> list[tuple[int, Array, Array]]:
    """Return cell, local places (u, v) and weights of the pieces into which lines of a grid cut a facet.

    `flat` has its corners in the plane. Weights sum up to the area of the unit triangle or square.
    """
    if len(flat) == 3:
        local = [np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])]
        triangles = [flat]
    else:
        unit = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
        local, triangles = [unit[[0, 1, 2]], unit[[0, 2, 3]]], [flat[[0, 1, 2]], flat[[0, 2, 3]]]
    across = len(lines[1]) - 1
    found = []
    for unit, triangle in zip(local, triangles, strict=True):
        # Columns: local places, then places in the plane, both linear on the triangle.
        both = np.hstack([unit, triangle])
        for i, strip in _between(both, 2, lines[0]):
            for j, piece in _between(strip, 3, lines[1]):
                for k in range(1, len(piece) - 1):
                    ends = piece[[0, k, k + 1], :2]
                    first, second = ends[1] - ends[0], ends[2] - ends[0]
                    twice = abs(float(first[0] * second[1] - first[1] * second[0]))
                    if twice > NOTHING:
                        found.append((i * across + j, _SHARES @ ends, twice * _WEIGHTS))
    return found


def _between(polygon: Array, column: int, lines: Array) -> list[tuple[int, Array]]:
    """Return the parts of a convex polygon between lines of constant values in a column, with their numbers."""
    values = polygon[:, column]
    last = len(lines) - 2
    low = int(np.clip(np.searchsorted(lines, values.min(), side="right") - 1, 0, last))
    high = int(np.clip(np.searchsorted(lines, values.max(), side="left") - 1, low, last))
    parts = []
    for number in range(low, high + 1):
        part = polygon
        if number > low:
            part = half(part, part[:, column] - lines[number])
        if number < high:
            part = half(part, lines[number + 1] - part[:, column])
        if len(part) > 2:
            parts.append((number, part))
    return parts


def _without_slivers(owner: Array, place: Array, area: Array) -> Array:
    """Return the patch of each sample, after small cells have been joined to the patch with the nearest centre."""
    count = int(owner.max()) + 1
    size = np.bincount(owner, area, minlength=count)
    moment = _moment(owner, area, place)
    least, left, new = SLIVER * float(np.median(size)), np.ones(count, dtype=bool), np.arange(count)
    while left.sum() > 1:
        smallest = int(np.argmin(np.where(left, size, np.inf)))
        if size[smallest] >= least:
            break
        left[smallest] = False
        others = np.flatnonzero(left)
        apart = moment[others] / size[others, None] - moment[smallest] / size[smallest]
        nearest = int(others[np.argmin((apart**2).sum(axis=1))])
        size[nearest] += size[smallest]
        moment[nearest] += moment[smallest]
        new[new == smallest] = nearest
    return np.asarray(np.unique(new, return_inverse=True)[1].ravel()[owner])
