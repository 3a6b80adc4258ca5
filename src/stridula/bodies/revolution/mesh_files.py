"""Reading of mesh files by meshio."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from typing import Any

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, choice, in_one_line
from ...disk import named, opened
from ...extras import named_extras
from ..reading.finite import check_finite_in
from .profile_mesh import BODY

PLANES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
# Kinds of cells by their number of corners, which come first in cells of higher degree.
TRIANGLES, QUADRILATERALS = ("triangle", "triangle6", "triangle7"), ("quad", "quad8", "quad9")
LINES = ("line", "line3")
CORNERS = dict.fromkeys(TRIANGLES, 3) | dict.fromkeys(QUADRILATERALS, 4) | dict.fromkeys(LINES, 2)
# Name that meshio gives to the boundary of a part, which is not a group of the file.
NO_GROUP = "gmsh:bounding_entities"


def read_profile(
    path: str | os.PathLike[str], scale: float, plane: str
) -> tuple[Array, Array, dict[str, Array], dict[str, Array]]:
    """Return nodes, cells, regions and edges of the profile in a file, as arguments of `MeshProfile`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not a mesh file, or has no triangles or quadrilaterals in the plane.
    """
    columns = PLANES[choice("plane", plane, tuple(PLANES))]
    mesh = _read(path)
    points = np.asarray(mesh.points, dtype=float)
    check_finite_in(path, "nodes", points)
    out = [axis for axis in range(points.shape[1]) if axis not in columns]
    if max(columns) >= points.shape[1] or np.ptp(points[:, out], axis=0).any():
        raise ArgumentError("plane", f"be the plane in which the mesh of {named(path)} lies", plane)
    cells, numbers = _joined(mesh, (*TRIANGLES, *QUADRILATERALS))
    if not len(cells):
        raise ArgumentError("path", "be a file with triangles or quadrilaterals", got=named(path))
    groups = _groups(mesh)
    regions = {name: numbers_of(numbers, sets) for name, sets in groups.items()}
    lines = {name: _lines(mesh, sets) for name, sets in groups.items()}
    # Nodes in the middle of sides and those of no cell are left out.
    used, corners = np.unique(cells, return_inverse=True)
    new = np.full(len(points), -1)
    new[used] = np.arange(used.size)
    edges = {name: new[one] for name, one in lines.items() if len(one)}
    return points[used][:, columns] * scale, corners.reshape(cells.shape), _divided(regions, len(cells)), edges


def numbers_of(numbers: dict[int, Array], sets: dict[int, Array]) -> Array:
    """Return the numbers of the cells of a group, from those of each block."""
    found = [numbers[block][chosen].ravel() for block, chosen in sets.items() if block in numbers]
    return np.sort(np.concatenate(found)) if found else np.zeros(0, dtype=int)


def _read(path: str | os.PathLike[str]) -> Any:
    with named_extras():
        import meshio

    opened(path).close()
    said = io.StringIO()
    try:
        with redirect_stdout(said), redirect_stderr(said):
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        # meshio exits the program if no reader accepts a file, and its readers raise any exception.
        words = in_one_line(error) if isinstance(error, Exception) else "no reader accepts it"
        raise ArgumentError("path", "be a file of a mesh", got=f"{named(path)}: {words}") from error


def _joined(mesh: Any, kinds: tuple[str, ...]) -> tuple[Array, dict[int, Array]]:
    """Return the corners of all cells, and the numbers of the cells of each block of the file, a row for each.

    Where triangles and quadrilaterals are mixed, quadrilaterals are halved.
    """
    blocks = {k: np.asarray(b.data)[:, : CORNERS[b.type]] for k, b in enumerate(mesh.cells) if b.type in kinds}
    mixed = len({block.shape[1] for block in blocks.values()}) > 1
    found, numbers, first = [], {}, 0
    for number, block in blocks.items():
        halves = 2 if mixed and block.shape[1] == 4 else 1
        parts = block[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3) if halves == 2 else block
        numbers[number] = first + np.arange(len(parts)).reshape(len(block), halves)
        first += len(parts)
        found.append(parts)
    return (np.concatenate(found) if found else np.zeros((0, 3), dtype=int)), numbers


def _groups(mesh: Any) -> dict[str, dict[int, Array]]:
    """Return the named groups of a file: the cells of each block that belong to a group."""
    found = {
        name: {k: np.asarray(one, dtype=int) for k, one in enumerate(sets) if one is not None and len(one)}
        for name, sets in mesh.cell_sets.items()
        if name != NO_GROUP
    }
    if found:
        return found
    return dict(_tagged(mesh))


def _tagged(mesh: Any) -> Iterator[tuple[str, dict[int, Array]]]:
    """Yield the groups of files that mark each cell by a number."""
    tags = mesh.cell_data.get("gmsh:physical")
    for name, (number, _) in (mesh.field_data if tags else {}).items():
        yield name, {k: np.flatnonzero(np.asarray(one) == number) for k, one in enumerate(tags)}


def _lines(mesh: Any, sets: dict[int, Array]) -> Array:
    found = [np.asarray(mesh.cells[k].data)[one, :2] for k, one in sets.items() if mesh.cells[k].type in LINES]
    return np.concatenate(found) if found else np.zeros((0, 2), dtype=int)


def _divided(groups: dict[str, Array], cells: int) -> dict[str, Array]:
    """Return the groups with cells, and all other cells as one more group; no groups if any two share cells."""
    regions = {name: one for name, one in groups.items() if one.size}
    times = np.bincount(np.concatenate([np.zeros(0, dtype=int), *regions.values()]), minlength=cells)
    if times.max() > 1:
        return {}
    others = np.flatnonzero(times == 0)
    return regions | ({BODY: others} if others.size else {})
