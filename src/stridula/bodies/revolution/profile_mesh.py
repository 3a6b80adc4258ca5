"""The cells of a profile in the half-plane (r, z), with checks, named places and a search for points."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations, pairwise

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError

# Distance below which two places are the same, relative to the profile's size.
SAME_PLACE = 1e-9
# Most cells of a profile, and of one whose cells are not given.
MOST_CELLS, MOST_MADE = 100_000, 10_000
# Name of the only region of a profile, and of cells in no other region.
BODY = "body"
# Sides of the smallest box around a region.
SIDES = ("inner", "outer", "bottom", "top")
# Growth of the sides of cells with the distance from smaller ones, and samples of an interval to integrate it.
GROWTH, SAMPLES = 0.5, 257
# Number of sides that are checked against all others at once.
SIDES_AT_ONCE = 256
# Largest number of points whose cells, and whose displacements in modes, are kept.
MOST_KNOWN = 4096


@dataclass(frozen=True, eq=False)
class ProfileMesh:
    """Triangles or quadrilaterals with straight sides that make up a profile.

    Attributes
    ----------
    nodes : ndarray, shape (nodes, 2)
        Distance r from the axis and place z along it of each node [m].
    cells : ndarray, shape (cells, 3) or (cells, 4)
        Nodes of each cell, counter-clockwise.
    regions : dict
        Numbers of the cells of each region, by its name.
    edges : dict, optional
        Pairs of nodes of each named edge, shape (sides, 2).
    """

    nodes: Array
    cells: Array
    regions: Mapping[str, Array]
    edges: Mapping[str, Array] = field(default_factory=dict)

    @property
    def size(self) -> float:
        """Larger side of the smallest box around it, the axis included [m]."""
        heights = self.nodes[:, 1]
        return float(max(self.nodes[:, 0].max(), heights.max() - heights.min()))

    @cached_property
    def sides(self) -> Array:
        """Pairs of nodes of all sides of cells, each once, the smaller number first, shape (sides, 2)."""
        return np.unique(np.sort(_sides(self.cells).reshape(-1, 2)), axis=0)

    @property
    def unknowns(self) -> int:
        """Degrees of freedom of quadratic elements for each order round the axis."""
        inside = len(self.cells) if self.cells.shape[1] == 4 else 0
        return 3 * (len(self.nodes) + len(self.sides) + inside)

    @property
    def volumes(self) -> Array:
        """Volume that each cell sweeps round the axis [m³], ``2 pi`` times its integral of r, shape (cells,)."""
        r, z = np.moveaxis(self.nodes[self.cells], -1, 0)
        other_r, other_z = np.roll(r, -1, axis=1), np.roll(z, -1, axis=1)
        return np.asarray(np.pi / 3.0 * ((r + other_r) * (r * other_z - other_r * z)).sum(axis=1))

    @cached_property
    def outline(self) -> Array:
        """Pairs of nodes of the sides that belong to one cell only, the profile to their left, shape (sides, 2)."""
        sides = _sides(self.cells).reshape(-1, 2)
        _, which, times = np.unique(np.sort(sides), axis=0, return_inverse=True, return_counts=True)
        return np.asarray(sides[times[which.ravel()] == 1])

    @cached_property
    def thinnest(self) -> float:
        """Least thickness of the profile, along the normals at the middles of the sides of its outline [m]."""
        ends = self.nodes[self.outline]
        start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
        inward = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
        middle, least = start + 0.5 * along, math.inf
        for first in range(0, len(ends), SIDES_AT_ONCE):
            rows = slice(first, first + SIDES_AT_ONCE)
            across = _cross(inward[rows, None], along[None])
            to_start = start[None] - middle[rows, None]
            with np.errstate(divide="ignore", invalid="ignore"):
                away = _cross(to_start, along[None]) / across
                share = _cross(to_start, inward[rows, None]) / across
            meets = (away > SAME_PLACE * self.size) & (share >= -SAME_PLACE) & (share <= 1.0 + SAME_PLACE)
            least = min(least, float(np.where(meets, away, math.inf).min()))
        return least

    @property
    def place_names(self) -> tuple[str, ...]:
        """Names of the places that can be held."""
        alone = tuple(self.regions) if len(self.regions) > 1 else ()
        return (*SIDES, *self.edges, *alone, *(f"{region}.{side}" for region in alone for side in SIDES))

    def sides_of(self, place: str) -> Array:
        """Return the sides of cells that a named place holds, shape (sides, 2); none for an unknown one."""
        if place in self.edges:
            return np.sort(self.edges[place], axis=1)
        if place in self.regions:
            return self._sides_of_cells(self.regions[place])
        region, _, side = place.rpartition(".")
        cells = self.regions.get(region, np.arange(len(self.cells))) if side in SIDES else np.zeros(0, dtype=int)
        if not len(cells) or (region and region not in self.regions):
            return np.zeros((0, 2), dtype=int)
        across = 0 if side in ("inner", "outer") else 1
        found = self._sides_of_cells(cells)
        values = self.nodes[:, across]
        reached = values[found].min() if side in ("inner", "bottom") else values[found].max()
        return np.asarray(found[(np.abs(values[found] - reached) <= SAME_PLACE * self.size).all(axis=1)])

    def sides_within(self, r: tuple[float, float], z: tuple[float, float]) -> Array:
        """Return the sides of cells that lie within a box [m], shape (sides, 2)."""
        margin = SAME_PLACE * self.size
        low, high = np.array([r[0], z[0]]) - margin, np.array([r[1], z[1]]) + margin
        inside: Array = np.all((self.nodes >= low) & (self.nodes <= high), axis=1)
        return np.asarray(self.sides[inside[self.sides].all(axis=1)])

    def cell_at(self, r: float, z: float) -> int | None:
        """Return the number of the cell that contains a point [m], None outside."""
        cell = self._cells_known.get((r, z))
        if cell is None:
            cell = int(self.cells_at(np.array([[r, z]]))[0])
            if len(self._cells_known) < MOST_KNOWN:
                self._cells_known[r, z] = cell
        return None if cell < 0 else cell

    @cached_property
    def _cells_known(self) -> dict[tuple[float, float], int]:
        """Cells of points that were searched, -1 outside: systems in series have the same points."""
        return {}

    def cells_at(self, places: Array) -> Array:
        """Return the numbers of the cells that contain points (r, z) [m], -1 outside, shape (points,)."""
        sides = self.nodes[_sides(self.cells)]
        along = sides[:, :, 1] - sides[:, :, 0]
        lengths = np.linalg.norm(along, axis=-1)
        found = np.full(len(places), -1)
        for number, place in enumerate(places):
            deepest = (_cross(along, place - sides[:, :, 0]) / lengths).min(axis=1)
            cell = int(np.argmax(deepest))
            if deepest[cell] >= -SAME_PLACE * self.size:
                found[number] = cell
        return found

    def _sides_of_cells(self, cells: Array) -> Array:
        return np.unique(np.sort(_sides(self.cells[cells]).reshape(-1, 2)), axis=0)


def checked_mesh(
    name: str, nodes: Array, cells: Array, regions: Mapping[str, Array], edges: Mapping[str, Array] | None = None
) -> ProfileMesh:
    """Return the cells of a profile, counter-clockwise; nodes within rounding of the axis are put on it.

    Raises
    ------
    ValueError
        If they cross the axis or each other, are not convex, form several pieces or are too many.
    """
    if len(cells) > MOST_CELLS:
        raise ArgumentError(name, f"have at most {MOST_CELLS} cells", got=f"{len(cells)}: try coarser cells")
    nodes, cells = np.array(nodes, dtype=float), np.array(cells, dtype=np.int64)
    extent = float(np.ptp(nodes, axis=0).max())
    margin = SAME_PLACE * extent
    if nodes[:, 0].min() < -margin:
        raise ArgumentError(name, "not cross the axis: r >= 0", got=f"r = {nodes[:, 0].min():.6g} m")
    nodes[nodes[:, 0] <= margin, 0] = 0.0
    cells = _counter_clockwise(name, nodes, cells)
    mesh = ProfileMesh(nodes, cells, dict(regions), dict(edges or {}))
    _check_whole(name, mesh)
    _check_edge(name, mesh)
    for array in (nodes, cells, *mesh.regions.values(), *mesh.edges.values()):
        array.flags.writeable = False
    return mesh


def _cross(first: Array, second: Array) -> Array:
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])


def _sides(cells: Array) -> Array:
    """Return the pairs of nodes along each cell, shape (cells, sides, 2)."""
    return np.stack([cells, np.roll(cells, -1, axis=1)], axis=2)


def _corners(nodes: Array, cells: Array) -> Array:
    """Return twice the area of the triangle at each corner of each cell [m²], shape (cells, corners)."""
    here, before, after = nodes[cells], nodes[np.roll(cells, 1, axis=1)], nodes[np.roll(cells, -1, axis=1)]
    return _cross(here - before, after - here)


def _counter_clockwise(name: str, nodes: Array, cells: Array) -> Array:
    turned = (_corners(nodes, cells) < 0.0).all(axis=1)
    cells[turned] = cells[turned, ::-1]
    bad = np.flatnonzero((_corners(nodes, cells) <= 0.0).any(axis=1))
    if bad.size:
        r, z = nodes[cells[bad[0]]].mean(axis=0)
        raise ArgumentError(name, "not fold back on itself", got=f"a cell that does near r = {r:.6g} m, z = {z:.6g} m")
    return cells


def _check_whole(name: str, mesh: ProfileMesh) -> None:
    """Raise ValueError unless all cells are connected by their sides."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    corners = mesh.cells.shape[1]
    _, side = np.unique(np.sort(_sides(mesh.cells).reshape(-1, 2)), axis=0, return_inverse=True)
    owner = np.repeat(np.arange(len(mesh.cells)), corners)
    links = coo_matrix((np.ones(side.size), (owner, side.ravel())))
    pieces, _ = connected_components(links @ links.T, directed=False)
    if pieces > 1:
        raise ArgumentError(name, "be in one piece, its cells joined by whole sides", got=f"{pieces} pieces")


def _check_edge(name: str, mesh: ProfileMesh) -> None:
    """Raise ValueError if the outline of the profile crosses or touches itself."""
    every, times = np.unique(np.sort(_sides(mesh.cells).reshape(-1, 2)), axis=0, return_counts=True)
    outline = every[times == 1]
    found = np.flatnonzero(times > 2)
    if found.size:
        r, z = mesh.nodes[every[found[0]]].mean(axis=0)
    else:
        crossing = _first_crossing(mesh.nodes, outline, SAME_PLACE * mesh.size)
        if crossing is None:
            return
        r, z = mesh.nodes[outline[crossing]].mean(axis=0)
    raise ArgumentError(
        name, "not cross or touch itself", got=f"an outline that does near r = {r:.6g} m, z = {z:.6g} m"
    )


def _first_crossing(nodes: Array, outline: Array, margin: float) -> int | None:
    """Return the number of the first side that meets another one without a common node."""
    a, b = nodes[outline[:, 0]], nodes[outline[:, 1]]
    length = np.linalg.norm(b - a, axis=1)
    low, high = np.minimum(a, b) - margin, np.maximum(a, b) + margin
    # By their places along the longer side of the profile, so that only a few are near each.
    axis = int(np.argmax(np.ptp(nodes, axis=0)))
    order = np.argsort(low[:, axis], kind="stable")
    begins = low[order, axis]
    for start in range(0, len(outline), SIDES_AT_ONCE):
        rows = order[start : start + SIDES_AT_ONCE, None]
        others = order[None, start : np.searchsorted(begins, high[rows, axis].max(), side="right")]
        near = ((low[rows] <= high[others]) & (low[others] <= high[rows])).all(axis=2)
        shared = (outline[rows][..., :, None] == outline[others][..., None, :]).any(axis=(2, 3))
        one, other = np.nonzero(near & ~shared)
        first, second = rows[one, 0], others[0, other]
        if not first.size:
            continue
        meets = _straddles(a, b, length, first, second, margin) & _straddles(a, b, length, second, first, margin)
        if meets.any():
            return int(min(first[meets].min(), second[meets].min()))
    return None


def _straddles(a: Array, b: Array, length: Array, line: Array, side: Array, margin: float) -> Array:
    """Return whether the ends of sides lie on both sides of the lines through others, or on them."""
    along = b[line] - a[line]
    distances = []
    for end in (a[side], b[side]):
        to_end = end - a[line]
        distance = _cross(along, to_end) / length[line]
        distances.append(np.where(np.abs(distance) <= margin, 0.0, distance))
    return np.asarray(distances[0] * distances[1] <= 0.0)


def lines(values: Array, sizes: Array, least: int = 1) -> Array:
    """Return rising numbers with further ones between them, `least` steps or more in each interval.

    Steps are at most as long as the size of their interval and grow by `GROWTH` times the distance from an interval
    with shorter steps.
    """
    sizes = np.minimum(sizes, np.diff(values) / least)
    found = [values[:1]]
    for low, high in pairwise(values):
        at = np.linspace(low, high, SAMPLES)
        away = np.maximum(np.maximum(values[:-1] - at[:, None], at[:, None] - values[1:]), 0.0)
        rate = 1.0 / (sizes + GROWTH * away).min(axis=1)
        steps = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(at))])
        number = max(math.ceil(steps[-1] * (1.0 - SAME_PLACE)), least)
        found.append(np.append(np.interp(steps[-1] * np.arange(1, number) / number, steps, at), high))
    return np.concatenate(found)


def merged(values: Array, margin: float) -> Array:
    """Return the sorted numbers without those within a margin of the one before."""
    ordered = np.unique(values)
    return np.asarray(ordered[np.append(True, np.diff(ordered) > margin)])


def overlap(boxes: Mapping[int, Array], margin: float) -> tuple[int, int] | None:
    """Return the first two of boxes, shape (2, 2) each, that share an area."""
    for (first, a), (second, b) in combinations(boxes.items(), 2):
        if (np.minimum(a[:, 1], b[:, 1]) - np.maximum(a[:, 0], b[:, 0]) > margin).all():
            return first, second
    return None
