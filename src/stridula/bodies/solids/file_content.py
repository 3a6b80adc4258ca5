"""The content of a mesh file: places, blocks of cells and named groups of them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from ...arrays import Array
from ..decks.deck import Elastic, Lump

# Beginnings of the names of kinds of solid cells.
SOLID = ("tetra", "hexahedron", "wedge", "pyramid", "polyhedron", "VTK_LAGRANGE_TETRA", "VTK_LAGRANGE_HEXA")
# Numbers of cells in each block, by the number of the block.
OfBlocks = dict[int, Array]


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
        The same as `groups` for placed parts, which can be read alone besides groups.
    materials : dict
        Elastic materials by name.
    of_materials : dict
        The same as `groups` for the elements of each material.
    lumps : list of Lump
        Masses and springs.
    left_out : Counter
        Number of other things that are not read, by name.
    """

    points: Array
    cells: list[Cells]
    groups: dict[str, OfBlocks]
    point_sets: dict[str, Array] = field(default_factory=dict)
    parts: dict[str, OfBlocks] = field(default_factory=dict)
    materials: dict[str, Elastic] = field(default_factory=dict)
    of_materials: dict[str, OfBlocks] = field(default_factory=dict)
    lumps: list[Lump] = field(default_factory=list)
    left_out: Counter[str] = field(default_factory=Counter)
