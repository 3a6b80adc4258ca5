"""Reading of mesh files in space: decks by readers of their own, others by meshio, which is imported on first use."""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy  # its parts are imported on first use
import scipy.sparse

from ..arrays import Array
from ..checks import ArgumentError, at_least, in_one_line, listed
from ..disk import named, one_line, opened
from ..doubtful import warn_of
from ..extras import named_extras
from .cut_elements import can_be_cut, cut_into_tetrahedra, triangles_of
from .decks.abaqus import read_abaqus
from .decks.deck import Deck, DeckError
from .decks.nastran import read_nastran
from .solid_kinds import KINDS, ElementKind, outer_faces

LARGEST_FILE = 2 * 1024**3
FORMATS = {
    ".msh": "gmsh",
    ".vtk": "vtk",
    ".vtu": "vtu",
}
DECKS: dict[str, Callable[[str | os.PathLike[str]], Deck]] = {
    ".inp": read_abaqus,
    ".bdf": read_nastran,
    ".nas": read_nastran,
    ".fem": read_nastran,
    ".dat": read_nastran,
}
# Kinds of cells by the beginnings of their names.
_SOLID = ("tetra", "hexahedron", "wedge", "pyramid", "polyhedron", "VTK_LAGRANGE_TETRA", "VTK_LAGRANGE_HEXA")
_SURFACE = ("triangle", "quad")
_THIN = ("vertex", "line")
# Arrays with more distinct whole numbers do not define groups.
MOST_GROUPS = 1000


@dataclass(frozen=True)
class Cells:
    """Cells of one kind.

    Attributes
    ----------
    type : str
        Name of the kind in meshio.
    data : ndarray of int, shape (cells, nodes of one)
        Indices of their points.
    """

    type: str
    data: Array


@dataclass(frozen=True)
class Held:
    """The content of a file.

    Attributes
    ----------
    points : ndarray, shape (points, 3)
        Places.
    cells : list of Cells
        Blocks of cells.
    groups : dict
        Numbers of cells in each block, by the number of the block, by the name of a group.
    point_sets : dict
        Indices of points by the name of a set.
    parts : dict
        The same as `groups` for what can be read alone besides groups: placed parts and materials.
    """

    points: Array
    cells: list[Cells]
    groups: dict[str, dict[int, Array]]
    point_sets: dict[str, Array] = field(default_factory=dict)
    parts: dict[str, dict[int, Array]] = field(default_factory=dict)


def read_mesh(path: str | os.PathLike[str], part: str | None = None) -> dict[str, Any]:
    """Return the content of a mesh file as arguments of `SolidMesh`.

    Parameters
    ----------
    path : str or Path
        The file.
    part : str, optional
        The part to read: a group of elements, an instance or a material.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is damaged, too large, of another format, or holds no solid elements, several kinds of them, or several
        parts.
    """
    held = read_held(path)
    try:
        components = _components(held)
        if part is not None:
            held = _only(replace(held, parts=held.parts | components), part)
            components = _components(held)
        if components:
            remedy = f"choose one by part={listed(map(repr, components), ' or ')}"
            raise ArgumentError("path", "hold one part", got=f"{len(components)} that share no node: {remedy}")
        return _parts(held)
    except (ArithmeticError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"cannot read {named(path)}: {in_one_line(error)}") from error


def read_held(path: str | os.PathLike[str]) -> Held:
    """Return the content of a mesh file; its errors are those of `read_mesh`."""
    ending = Path(path).suffix.lower()
    if ending not in (*FORMATS, *DECKS):
        raise ArgumentError("path", f"end in {', '.join([*DECKS, *FORMATS])}", os.fspath(path))
    prefix = f"cannot read {os.fspath(path)!r}"
    opened(path).close()
    with one_line(prefix):
        size = os.stat(path).st_size
    if size > LARGEST_FILE:
        raise ValueError(f"{prefix}: {at_least(size / 1024**3, 3)} GiB, but at most 2 GiB are read")
    if not size:
        raise ValueError(f"{prefix}: the file is empty")
    if ending in DECKS:
        return _of_deck(path, ending, prefix)
    read = _read(path, FORMATS[ending], prefix)
    try:
        groups = _grouped(read, FORMATS[ending])
        cells = [Cells(block.type, np.asarray(block.data, dtype=np.int64)) for block in read.cells]
        sets = {name: np.asarray(nodes, dtype=np.int64) for name, nodes in getattr(read, "point_sets", {}).items()}
        return Held(np.asarray(read.points, dtype=float), cells, groups, sets)
    except (ArithmeticError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"{prefix}: {in_one_line(error)}") from error


def _of_deck(path: str | os.PathLike[str], ending: str, prefix: str) -> Held:
    """Return the content of a deck, with a warning of what it has besides."""
    try:
        deck = DECKS[ending](path)
    except DeckError as error:
        raise ValueError(f"{prefix}: {in_one_line(error)}") from error
    if deck.left_out:
        words = listed(f"{count} {name}" for name, count in deck.left_out.items())
        warn_of([f"{named(path)}: not read: {words}"])
    blocks, groups = [*deck.blocks], {name: _by_block(deck, those) for name, those in deck.element_sets.items()}
    for name, faces in deck.surfaces.items():
        if faces:
            groups[_free_name(name, groups)] = {
                len(blocks) + at: np.arange(len(one.nodes)) for at, one in enumerate(faces)
            }
            blocks += faces
    parts = {name: _by_block(deck, those) for name, those in deck.parts.items()}
    materials: dict[str, list[Array]] = {}
    for of, material in deck.material_of.items():
        those = deck.element_sets.get(of, deck.parts.get(of))
        if those is not None:
            materials.setdefault(material, []).append(those)
    of_materials = {name: _by_block(deck, np.unique(np.concatenate(those))) for name, those in materials.items()}
    cells = [Cells(one.kind, one.nodes) for one in blocks]
    return Held(deck.points, cells, groups, dict(deck.node_sets), of_materials | parts)


def _free_name(name: str, groups: dict[str, Any]) -> str:
    """Return the name of a surface, which another group may have."""
    return name if name not in groups else f"surface {name}"


def _by_block(deck: Deck, numbers: Array) -> dict[int, Array]:
    """Return numbers of elements of a deck as numbers in its blocks."""
    start, found = 0, {}
    for at, block in enumerate(deck.blocks):
        inside = numbers[(numbers >= start) & (numbers < start + len(block.nodes))] - start
        if inside.size:
            found[at] = inside
        start += len(block.nodes)
    return found


def _only(held: Held, part: str) -> Held:
    """Return the content of a file with the solid elements of a part alone."""
    known = held.groups | held.parts
    solid = {
        name: {at: those for at, those in of_block.items() if held.cells[at].type.startswith(_SOLID)}
        for name, of_block in known.items()
    }
    names = [name for name, of_block in solid.items() if of_block]
    key = next((name for name in names if name.upper() == part.upper()), None)
    if key is None:
        raise ArgumentError(
            "part",
            f"be {listed(map(repr, names), ' or ')}" if names else "be left out: no group has solid elements",
            part,
        )
    cells, new = [], dict[int, Array]()
    for at, block in enumerate(held.cells):
        kept = np.arange(len(block.data))
        if block.type.startswith(_SOLID):
            kept = solid[key].get(at, kept[:0])
        new[at] = np.full(len(block.data), -1)
        new[at][kept] = np.arange(len(kept))
        cells.append(Cells(block.type, block.data[kept]))
    own = f"{key}."
    groups = {}
    for name, of_block in held.groups.items():
        left = {at: new[at][those] for at, those in of_block.items()}
        left = {at: those[those >= 0] for at, those in left.items()}
        if any(those.size for those in left.values()):
            groups[name.removeprefix(own)] = left
    sets = {name.removeprefix(own): nodes for name, nodes in held.point_sets.items()}
    return replace(held, cells=cells, groups=groups, point_sets=sets)


def _components(held: Held) -> dict[str, dict[int, Array]]:
    """Return the solid elements that are joined by nodes, by a group of just these or a number; none if all are."""
    blocks = {at: one for at, one in enumerate(held.cells) if one.type.startswith(_SOLID) and len(one.data)}
    if not blocks:
        return {}
    counts = [len(one.data) for one in blocks.values()]
    rows = np.repeat(
        np.arange(sum(counts)), np.concatenate([np.full(len(b.data), b.data.shape[1]) for b in blocks.values()])
    )
    columns = sum(counts) + np.concatenate([one.data.ravel() for one in blocks.values()])
    size = sum(counts) + len(held.points)
    joined = scipy.sparse.coo_array((np.ones(rows.size), (rows, columns)), shape=(size, size))
    of = scipy.sparse.csgraph.connected_components(joined, directed=False)[1][: sum(counts)]
    numbers = np.unique(of)
    if numbers.size < 2:
        return {}
    of_block = dict(zip(blocks, np.split(of, np.cumsum(counts)[:-1]), strict=True))
    found = {}
    for k, number in enumerate(numbers.tolist()):
        those = {at: np.flatnonzero(one == number) for at, one in of_block.items()}
        those = {at: one for at, one in those.items() if one.size}
        found[next(_called(held, those), f"component {k + 1}")] = those
    return found


def _called(held: Held, those: dict[int, Array]) -> Iterator[str]:
    """Yield the names of parts and groups that hold just these elements."""
    for name, of_block in {**held.parts, **held.groups}.items():
        solid = {at: one for at, one in of_block.items() if one.size and held.cells[at].type.startswith(_SOLID)}
        if solid.keys() == those.keys() and all(np.array_equal(np.sort(solid[at]), those[at]) for at in those):
            yield name


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


def _parts(held: Held) -> dict[str, Any]:
    """Return nodes, elements and named groups, without nodes that have no element."""
    groups = held.groups
    blocks = [block for block in held.cells if block.type.startswith(_SOLID) and len(block.data)]
    kinds = sorted({block.type for block in blocks})
    is_whole = len(kinds) == 1 and kinds[0] in KINDS
    if not kinds or not (is_whole or can_be_cut(kinds)):
        known = listed(kind.words for kind in KINDS.values())
        cut = "tetrahedra, wedges, pyramids and hexahedra of one order, without nodes in the middle of faces"
        raise ArgumentError("path", f"hold solid elements of one kind ({known}) or {cut}", got=listed(kinds))
    places = held.points
    of_blocks = [(block.type, block.data) for block in blocks]
    meant = np.concatenate([block.ravel() for _, block in of_blocks])
    if meant.size and (meant.min() < 0 or meant.max() >= len(places)):
        raise ArgumentError("path", f"refer to nodes that it contains, {len(places)} in all", got=int(meant.max()))
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
    for name, nodes in held.point_sets.items():
        _add(sets, name, renumbered[nodes])
    further = renumbered[len(places) - len(ends) :]
    for name, nodes in sets.items():
        _add(sets, name, further[np.isin(renumbered[ends], nodes).all(axis=1)])
    for name, nodes in sets.items():
        if name not in faces:
            _add(faces, name, _faces_in(kind, elements, surface, nodes))
    found["faces"] = faces
    found["node_sets"] = sets
    return found


def _volumes(held: Held, groups: dict[str, dict[int, Array]], number: Array, owner: Array) -> dict[str, Array]:
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
    held: Held,
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
            nodes = renumbered[block.data[those]]
            nodes = nodes[(nodes >= 0).all(axis=1)]
            if not len(nodes):
                continue
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


def _grouped(held: Any, form: str) -> dict[str, dict[int, Array]]:
    """Return the named groups of cells: numbers in each block by the number of the block, by name."""
    if form == "gmsh":
        return _of_gmsh(held)
    found: dict[str, dict[int, Array]] = {}
    for array, of_block in held.cell_data.items():
        for at, values in enumerate(of_block):
            for value, those in _by_value(values):
                found.setdefault(f"{array} {value}", {})[at] = those
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
