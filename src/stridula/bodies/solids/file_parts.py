"""Parts of the content of a mesh file."""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import replace
from typing import TypeVar

import numpy as np
import scipy  # its parts are imported on first use
import scipy.sparse

from ...checks import ArgumentError, listed
from .file_content import SOLID, Cells, Held, OfBlocks

T = TypeVar("T")


def named_part(held: Held, part: str) -> tuple[str, OfBlocks]:
    """Return the name of a part as it is spelled, and its solid elements."""
    known = held.groups | held.of_materials | held.parts | components(held)
    solid = {
        name: {at: those for at, those in of_block.items() if held.cells[at].type.startswith(SOLID)}
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
    return key, solid[key]


def only(held: Held, name: str, part: OfBlocks) -> Held:
    """Return the content of a file with the solid elements of a part alone, whose names begin with its own."""
    cells, new = [], OfBlocks()
    for at, block in enumerate(held.cells):
        kept = np.arange(len(block.data))
        if block.type.startswith(SOLID):
            kept = part.get(at, kept[:0])
        new[at] = np.full(len(block.data), -1)
        new[at][kept] = np.arange(len(kept))
        cells.append(Cells(block.type, block.data[kept]))
    taken = held.groups.keys() | held.point_sets.keys()
    return replace(
        held,
        cells=cells,
        groups=_without_prefix(_left(held.groups, new), f"{name}.", taken),
        point_sets=_without_prefix(held.point_sets, f"{name}.", taken),
        parts={},
        of_materials=_left(held.of_materials, new),
    )


def _without_prefix(groups: dict[str, T], prefix: str, taken: Set[str]) -> dict[str, T]:
    """Return groups by their names without a prefix, unless another group has that name."""
    return {
        name if name.removeprefix(prefix) in taken else name.removeprefix(prefix): those
        for name, those in groups.items()
    }


def _left(groups: dict[str, OfBlocks], new: OfBlocks) -> dict[str, OfBlocks]:
    """Return the groups of the cells that are left, by their new numbers, -1 for others."""
    found = {}
    for name, of_block in groups.items():
        left = {at: new[at][those] for at, those in of_block.items()}
        left = {at: those[those >= 0] for at, those in left.items()}
        if any(those.size for those in left.values()):
            found[name] = left
    return found


def components(held: Held) -> dict[str, OfBlocks]:
    """Return the solid elements that are joined by nodes, by a group of just these or a number; none if all are."""
    blocks = {at: one for at, one in enumerate(held.cells) if one.type.startswith(SOLID) and len(one.data)}
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
        found[next(called(held, those), f"component {k + 1}")] = those
    return found


def with_materials(held: Held) -> tuple[Held, dict[str, str]]:
    """Return the content with a group for each material, and the names of materials by those of their groups."""
    groups, found = dict(held.groups), {}
    for material, of_block in held.of_materials.items():
        own = {at: np.sort(one) for at, one in of_block.items() if one.size}
        name = next((one for one in called(replace(held, parts={}, of_materials={}), own)), None)
        if name is None:
            name = material if material not in groups else f"material {material}"
            groups[name] = own
        found[name] = material
    return replace(held, groups=groups), found


def called(held: Held, those: OfBlocks) -> Iterator[str]:
    """Yield the names of parts and groups that hold just these elements."""
    for name, of_block in {**held.parts, **held.groups, **held.of_materials}.items():
        solid = {at: one for at, one in of_block.items() if one.size and held.cells[at].type.startswith(SOLID)}
        if solid.keys() == those.keys() and all(np.array_equal(np.sort(solid[at]), those[at]) for at in those):
            yield name
