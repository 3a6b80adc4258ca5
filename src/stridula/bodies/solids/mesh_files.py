"""Reading of mesh files in space: decks by readers of their own, others by meshio, which is imported on first use."""

from __future__ import annotations

import contextlib
import io
import os
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, at_least, in_one_line, listed
from ...disk import named, one_line, opened
from ...doubtful import LeftOut, warn_of
from ...extras import named_extras
from ..decks.abaqus import read_abaqus
from ..decks.deck import Deck, Elastic, Lump
from ..decks.med import read_med
from ..decks.medit import read_medit
from ..decks.nastran import read_nastran
from ..decks.universal import read_universal
from ..reading.deck_error import DeckError
from .cut_elements import can_be_cut, cut_into_tetrahedra, triangles_of
from .file_content import SOLID, Cells, Held, OfBlocks
from .file_parts import called, components, named_part, only, with_materials
from .kinds import KINDS, ElementKind, outer_faces

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
    ".unv": read_universal,
    ".uff": read_universal,
    ".med": read_med,
    ".mesh": read_medit,
}
# Beginnings of the names of other kinds of cells.
_SURFACE = ("triangle", "quad")
_THIN = ("vertex", "line")
# Arrays with more distinct whole numbers do not define groups.
MOST_GROUPS = 1000


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
    _warn_of(path, held.left_out + Counter(one.word for one in held.lumps))
    try:
        if part is not None:
            held = only(held, *named_part(held, part))
        several = components(held)
        if several:
            remedy = f"choose one by part={listed(map(repr, several), ' or ')}"
            raise ArgumentError("path", "hold one part", got=f"{len(several)} that share no node: {remedy}")
        return _mesh(held)
    except (ArithmeticError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"cannot read {named(path)}: {in_one_line(error)}") from error


@dataclass(frozen=True)
class ReadPart:
    """A part of a file.

    Attributes
    ----------
    mesh : dict
        Arguments of `SolidMesh`.
    materials : dict
        Elastic materials by the name of their group of elements.
    names : dict
        Names of the materials by that of their group.
    cells : dict
        Number of solid elements of each kind in the file, by the name of the kind in meshio.
    masses : dict
        Masses by the name of their point.
    springs : list
        Springs with the name of the part of each end, None for the ground.
    points : dict
        Places of the points of masses and springs by name.
    """

    mesh: dict[str, Any]
    materials: dict[str, Elastic]
    names: dict[str, str]
    cells: dict[str, int]
    masses: dict[str, float] = field(default_factory=dict)
    springs: list[tuple[Lump, list[str]]] = field(default_factory=list)
    points: dict[str, Array] = field(default_factory=dict)


def read_each(path: str | os.PathLike[str]) -> dict[str, ReadPart]:
    """Return the parts of a mesh file that share no node, by name; errors are those of `read_mesh`."""
    held = read_held(path)
    try:
        several = components(held)
        if not several:
            solid = {at: np.arange(len(one.data)) for at, one in enumerate(held.cells) if one.type.startswith(SOLID)}
            several = {next(called(held, solid), Path(path).stem): solid}
        found = {name: _read_part(only(held, name, part)) for name, part in several.items()}
        left_out = held.left_out + _with_lumps(held, several, found)
    except (ArithmeticError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"cannot read {named(path)}: {in_one_line(error)}") from error
    _warn_of(path, left_out)
    return found


def _with_lumps(held: Held, several: dict[str, OfBlocks], found: dict[str, ReadPart]) -> Counter[str]:
    """Add masses and springs to the parts of their points; return the number of those with a point of no part."""
    lone, part_of = Counter[str](), dict[int, str]()
    for name, part in several.items() if held.lumps else ():
        nodes = np.unique(np.concatenate([held.cells[at].data[those].ravel() for at, those in part.items()]))
        part_of |= dict.fromkeys(nodes.tolist(), name)
    for lump in held.lumps:
        if not all(point in part_of for point in lump.points):
            lone[lump.word] += 1
            continue
        parts = [part_of[point] for point in lump.points]
        for name, label, point in zip(parts, lump.labels, lump.points, strict=True):
            found[name].points[label] = held.points[point]
        first = found[parts[0]]
        if lump.direction:
            first.springs.append((lump, parts))
        else:
            first.masses[lump.labels[0]] = first.masses.get(lump.labels[0], 0.0) + lump.value
    return lone


def _read_part(held: Held) -> ReadPart:
    held, names = with_materials(held)
    cells = Counter[str]()
    for block in held.cells:
        if block.type.startswith(SOLID) and len(block.data):
            cells[block.type] += len(block.data)
    return ReadPart(
        _mesh(held), {name: held.materials.get(of, Elastic()) for name, of in names.items()}, names, dict(cells)
    )


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
    """Return the content of a deck."""
    try:
        deck = DECKS[ending](path)
    except DeckError as error:
        raise ValueError(f"{prefix}: {in_one_line(error)}") from error
    blocks, groups = [*deck.blocks], {name: _by_block(deck, those) for name, those in deck.element_sets.items()}
    for name, faces in deck.surfaces.items():
        if faces:
            groups[_surface_name(deck, name)] = {
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
    return Held(
        deck.points,
        cells,
        groups,
        dict(deck.node_sets),
        parts,
        dict(deck.materials),
        of_materials,
        deck.lumps,
        deck.left_out,
    )


def _warn_of(path: str | os.PathLike[str], left_out: Counter[str]) -> None:
    """Warn of what is not read."""
    if left_out:
        words = listed(f"{count} {name}" for name, count in left_out.items())
        warn_of([f"{named(path)}: not read: {words}"], LeftOut)


def _surface_name(deck: Deck, name: str) -> str:
    """Return the name of a surface, with a word before it if an element set or a set of other nodes has the name."""
    nodes = deck.node_sets.get(name)
    if name not in deck.element_sets and nodes is None:
        return name
    if name not in deck.element_sets and nodes is not None:
        corners = np.concatenate([block.corners.ravel() for block in deck.blocks])
        of_surface = np.concatenate([faces.nodes.ravel() for faces in deck.surfaces[name]])
        if np.array_equal(np.intersect1d(nodes, corners), np.unique(of_surface)):
            return name
    return f"surface {name}"


def _by_block(deck: Deck, numbers: Array) -> OfBlocks:
    """Return numbers of elements of a deck as numbers in its blocks."""
    start, found = 0, {}
    for at, block in enumerate(deck.blocks):
        inside = numbers[(numbers >= start) & (numbers < start + len(block.nodes))] - start
        if inside.size:
            found[at] = inside
        start += len(block.nodes)
    return found


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


def _mesh(held: Held) -> dict[str, Any]:
    """Return nodes, elements and named groups, without nodes that have no element."""
    groups = held.groups
    blocks = [block for block in held.cells if block.type.startswith(SOLID) and len(block.data)]
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


def _volumes(held: Held, groups: dict[str, OfBlocks], number: Array, owner: Array) -> dict[str, Array]:
    """Return the elements of each group of solid elements, with duplicates merged.

    They are parts of the elements of the file, whose numbers are in `owner`.
    """
    start, found = 0, dict[str, Array]()
    for at, block in enumerate(held.cells):
        if block.type.startswith(SOLID):
            for name, of_block in groups.items():
                if at in of_block and of_block[at].size:
                    those = number[np.isin(owner, start + of_block[at])]
                    found[name] = np.append(found.get(name, those[:0]), those)
            start += len(block.data)
    return found


def _faces_and_sets(
    held: Held,
    groups: dict[str, OfBlocks],
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


def _grouped(held: Any, form: str) -> dict[str, OfBlocks]:
    """Return the named groups of cells: numbers in each block by the number of the block, by name."""
    if form == "gmsh":
        return _of_gmsh(held)
    found: dict[str, OfBlocks] = {}
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


def _of_gmsh(held: Any) -> dict[str, OfBlocks]:
    """Return the physical groups; groups without a name get their number."""
    names = {(int(dimension), int(tag)): name for name, (tag, dimension) in held.field_data.items()}
    found: dict[str, OfBlocks] = {}
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
