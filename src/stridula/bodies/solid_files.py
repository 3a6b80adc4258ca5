"""Reading of mesh files in space by meshio, which is imported on first use."""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, at_least, in_one_line, listed
from ..disk import one_line, opened
from ..extras import named_extras
from .cut_elements import can_be_cut, cut_into_tetrahedra, triangles_of
from .solid_kinds import KINDS, ElementKind, outer_faces

LARGEST_FILE = 2 * 1024**3
FORMATS = {
    ".msh": "gmsh",
    ".inp": "abaqus",
    ".bdf": "nastran",
    ".nas": "nastran",
    ".fem": "nastran",
    ".vtk": "vtk",
    ".vtu": "vtu",
}
# Kinds of cells by the beginnings of their names.
_SOLID = ("tetra", "hexahedron", "wedge", "pyramid", "polyhedron", "VTK_LAGRANGE_TETRA", "VTK_LAGRANGE_HEXA")
_SURFACE = ("triangle", "quad")
_THIN = ("vertex", "line")
# Arrays with more distinct whole numbers do not define groups.
MOST_GROUPS = 1000


def read_mesh(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the content of a mesh file as arguments of `SolidMesh`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is damaged, too large, of another format, or holds no solid elements or several kinds of them.
    """
    form = FORMATS.get(Path(path).suffix.lower())
    if form is None:
        raise ArgumentError("path", f"end in {', '.join(FORMATS)}", os.fspath(path))
    prefix = f"cannot read {os.fspath(path)!r}"
    opened(path).close()
    with one_line(prefix):
        size = os.stat(path).st_size
    if size > LARGEST_FILE:
        raise ValueError(f"{prefix}: {at_least(size / 1024**3, 3)} GiB, but at most 2 GiB are read")
    if not size:
        raise ValueError(f"{prefix}: the file is empty")
    held = _read(path, form, prefix)
    try:
        return _parts(held, _grouped(held, form, path))
    except (ArithmeticError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"{prefix}: {in_one_line(error)}") from error


def _read(path: str | os.PathLike[str], form: str, prefix: str) -> Any:
    """Return the mesh from meshio, which reports some errors by printing and exiting the program."""
    with named_extras():
        import meshio
        from meshio._mesh import topological_dimension

    # meshio reads these kinds, but does not list their dimension.
    for kind in ("wedge15", "pyramid13"):
        topological_dimension.setdefault(kind, 3)
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), np.errstate(all="ignore"):
            return meshio.read(Path(path), file_format=form)
    except OSError:
        raise
    except MemoryError:
        raise ValueError(f"{prefix}: it announces more data than fit into memory") from None
    except SystemExit:
        words = " ".join(said.getvalue().split()) or "it is damaged"
        raise ValueError(f"{prefix}: {words[:160]}") from None
    except Exception as error:
        raise ValueError(f"{prefix}: {in_one_line(error)}") from error


def _parts(held: Any, groups: dict[str, dict[int, Array]]) -> dict[str, Any]:
    """Return nodes, elements and named groups, without nodes that have no element."""
    blocks = [block for block in held.cells if block.type.startswith(_SOLID)]
    kinds = sorted({block.type for block in blocks})
    is_whole = len(kinds) == 1 and kinds[0] in KINDS
    if not kinds or not (is_whole or can_be_cut(kinds)):
        known = listed(kind.words for kind in KINDS.values())
        cut = "tetrahedra, wedges, pyramids and hexahedra of one order, without nodes in the middle of faces"
        raise ArgumentError("path", f"hold solid elements of one kind ({known}) or {cut}", got=listed(kinds))
    places = np.asarray(held.points, dtype=float)
    of_blocks = [(block.type, np.asarray(block.data, dtype=np.int64)) for block in blocks]
    named = np.concatenate([block.ravel() for _, block in of_blocks])
    if named.size and (named.min() < 0 or named.max() >= len(places)):
        raise ArgumentError("path", f"refer to nodes that it contains, {len(places)} in all", got=int(named.max()))
    if is_whole:
        given = np.concatenate([block for _, block in of_blocks])
        kind, owner, ends = KINDS[kinds[0]], np.arange(len(given)), np.zeros((0, 2), dtype=np.int64)
    else:
        cut_mesh = cut_into_tetrahedra(places, of_blocks)
        places, given, owner, ends = cut_mesh.nodes, cut_mesh.elements, cut_mesh.owner, cut_mesh.ends
        kind = KINDS["tetra10" if given.shape[1] == 10 else "tetra"]
    # An element in two groups may appear in a file twice.
    _, first, number = np.unique(np.sort(given, axis=1), axis=0, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    elements, number = given[np.sort(first)], rank[number.ravel()]
    used = np.unique(elements)
    renumbered = np.full(len(places), -1)
    renumbered[used] = np.arange(used.size)
    elements = renumbered[elements]
    surface = _surface(kind, elements)
    found: dict[str, Any] = {"nodes": places[used], "elements": elements, "kind": kind.name}
    found["volumes"] = _volumes(held, groups, number, owner)
    faces, sets = _faces_and_sets(held, groups, renumbered, surface, len(kind.faces[0]))
    for name, nodes in getattr(held, "point_sets", {}).items():
        _add(sets, name, renumbered[np.asarray(nodes, dtype=np.int64)])
    further = renumbered[len(places) - len(ends) :]
    for name, nodes in sets.items():
        _add(sets, name, further[np.isin(renumbered[ends], nodes).all(axis=1)])
    for name, nodes in sets.items():
        if name not in faces:
            _add(faces, name, _faces_in(kind, elements, surface, nodes))
    found["faces"] = faces
    found["node_sets"] = sets
    return found


def _volumes(held: Any, groups: dict[str, dict[int, Array]], number: Array, owner: Array) -> dict[str, Array]:
    """Return the elements of each group of solid elements, with duplicates merged.

    They are parts of the elements of the file, whose numbers are in `owner`.
    """
    start, found = 0, dict[str, Array]()
    for at, block in enumerate(held.cells):
        if block.type.startswith(_SOLID):
            for name, of_block in groups.items():
                if at in of_block and of_block[at].size:
                    those = number[np.isin(owner, start + of_block[at])]
                    found[name] = np.append(found.get(name, those[:0]), those)
            start += len(block.data)
    return found


def _faces_and_sets(
    held: Any,
    groups: dict[str, dict[int, Array]],
    renumbered: Array,
    surface: dict[tuple[int, ...], tuple[int, int]],
    sides: int,
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return faces on the surface, and nodes of other faces, of lines and of points, by the name of their group."""
    faces: dict[str, Array] = {}
    sets: dict[str, Array] = {}
    for name, of_block in groups.items():
        for at, those in of_block.items():
            block = held.cells[at]
            nodes = renumbered[np.asarray(block.data, dtype=np.int64)[those]]
            if block.type.startswith(_SURFACE):
                corners = nodes[:, : 3 if block.type.startswith("triangle") else 4]
                if corners.shape[1] > sides:
                    corners = triangles_of(corners).reshape(-1, 3)
                keys = [tuple(sorted(face)) for face in corners.tolist()]
                if all(key in surface for key in keys):
                    pairs = np.array([surface[key] for key in keys], dtype=np.int64).reshape(-1, 2)
                    faces[name] = np.vstack([faces.get(name, pairs[:0]), pairs])
                else:
                    _add(sets, name, nodes.ravel())
            elif block.type.startswith(_THIN):
                _add(sets, name, nodes.ravel())
    return {name: those for name, those in faces.items() if those.size}, sets


def _add(groups: dict[str, Array], name: str, those: Array) -> None:
    """Add numbers to a group; nodes without an element, numbered -1, and empty groups are left out."""
    those = those[those >= 0] if those.ndim == 1 else those
    if those.size:
        groups[name] = np.unique(np.append(groups[name], those) if name in groups else those, axis=0)


def _surface(kind: ElementKind, elements: Array) -> dict[tuple[int, ...], tuple[int, int]]:
    """Return the faces of one element only, by their sorted corners: number of the element and of its face."""
    element, side = outer_faces(kind, elements).T
    keys = map(tuple, np.sort(elements[element[:, None], np.array(kind.faces)[side]], axis=1).tolist())
    return dict(zip(keys, zip(element.tolist(), side.tolist(), strict=True), strict=True))


def _faces_in(
    kind: ElementKind, elements: Array, surface: dict[tuple[int, ...], tuple[int, int]], nodes: Array
) -> Array:
    """Return the faces on the surface all of whose nodes are in a set."""
    pairs = np.array(list(surface.values()), dtype=np.int64).reshape(-1, 2)
    of_face = elements[pairs[:, :1], kind.face_nodes[pairs[:, 1]]]
    return pairs[np.isin(of_face, nodes).all(axis=1)]


def _grouped(held: Any, form: str, path: str | os.PathLike[str]) -> dict[str, dict[int, Array]]:
    """Return the named groups of cells: numbers in each block by the number of the block, by name."""
    if form == "gmsh":
        return _of_gmsh(held)
    if form == "abaqus":
        return _of_abaqus(held, path)
    found: dict[str, dict[int, Array]] = {}
    for array, of_block in held.cell_data.items():
        is_property = array == "nastran:ref"
        for at, values in enumerate(of_block):
            for value, those in _by_value(values):
                found.setdefault(str(value) if is_property else f"{array} {value}", {})[at] = those
    if form in ("vtk", "vtu"):
        for array, values in held.point_data.items():
            for value, those in _by_value(values):
                held.point_sets[f"{array} {value}"] = those
    return found


def _by_value(values: Any) -> Iterator[tuple[int, Array]]:
    """Yield each distinct whole number of an array with its indices; nothing for other arrays or too many numbers."""
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        return
    different = np.unique(array)
    if different.size <= MOST_GROUPS:
        for value in different:
            yield int(value), np.flatnonzero(array == value)


def _of_gmsh(held: Any) -> dict[str, dict[int, Array]]:
    """Return the physical groups; groups without a name get their number."""
    names = {(int(dimension), int(tag)): name for name, (tag, dimension) in held.field_data.items()}
    found: dict[str, dict[int, Array]] = {}
    for at, tags in enumerate(held.cell_data.get("gmsh:physical", [])):
        for tag, those in _by_value(tags):
            if tag:
                found.setdefault(names.get((held.cells[at].dim, tag), str(tag)), {})[at] = those
    for name, of_block in held.cell_sets.items():
        if name in held.field_data and len(of_block) == len(held.cells):
            for at, those in enumerate(of_block):
                if those is not None and len(those) and held.cells[at].dim == held.field_data[name][1]:
                    found.setdefault(name, {})[at] = np.asarray(those, dtype=np.int64)
    return found


def _of_abaqus(held: Any, path: str | os.PathLike[str]) -> dict[str, dict[int, Array]]:
    """Return the sets of elements; those named at ``*ELEMENT`` are read from its lines."""
    found: dict[str, dict[int, Array]] = {}
    with open(path, encoding="latin-1") as file:
        at_blocks = [_parameters(line) for line in file if line.upper().startswith("*ELEMENT,")]
    named_there = {parameters.get("ELSET") for parameters in at_blocks}
    for name, of_block in held.cell_sets.items():
        whole = len(of_block) == len(held.cells) and all(isinstance(those, np.ndarray) for those in of_block)
        if whole and name not in named_there:
            found[name] = {at: np.asarray(those, dtype=np.int64) for at, those in enumerate(of_block) if those.size}
    if len(at_blocks) == len(held.cells):
        for at, parameters in enumerate(at_blocks):
            if "ELSET" in parameters:
                found.setdefault(parameters["ELSET"], {})[at] = np.arange(len(held.cells[at].data))
    return found


def _parameters(line: str) -> Mapping[str, str]:
    pairs = (word.partition("=") for word in line.split(",")[1:])
    return {name.strip().upper(): value.strip() for name, _, value in pairs if value}
