"""The content of a deck: nodes, elements and named groups, in global coordinates."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array

CORNERS = {"tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8, "triangle": 3, "quad": 4}


@dataclass(frozen=True)
class Block:
    """Elements of one kind.

    Attributes
    ----------
    kind : str
        Name of the kind in meshio: "tetra", "tetra10", "hexahedron", "hexahedron20", "hexahedron27", "wedge",
        "wedge15", "pyramid" or "pyramid13", the nodes of each element in the order of VTK; for parts of surfaces
        "triangle" or "quad", corners alone.
    nodes : ndarray of int, shape (elements, nodes of one)
        Indices of their points.
    """

    kind: str
    nodes: Array

    @property
    def corners(self) -> Array:
        """Indices of the corners, shape (elements, corners)."""
        return self.nodes[:, : CORNERS[self.kind.rstrip("0123456789")]]


@dataclass(frozen=True)
class Elastic:
    """An isotropic elastic material in units of the deck; NaN where the deck does not give a value.

    Attributes
    ----------
    young, poisson, density : float
        Young's modulus, Poisson's ratio [1] and density.
    """

    young: float = np.nan
    poisson: float = np.nan
    density: float = np.nan


@dataclass(frozen=True)
class Lump:
    """A mass at a node, or a spring between two nodes or from one to the ground, in units of the deck.

    Attributes
    ----------
    word : str
        Name of its kind in the deck.
    points : tuple of int
        Indices of its points.
    labels : tuple of str
        Names of these points, such as "node 12", without that of their part.
    value : float
        Mass, or stiffness of a spring.
    direction : tuple of float
        Direction in which a spring acts, in global coordinates; empty for a mass.
    """

    word: str
    points: tuple[int, ...]
    labels: tuple[str, ...]
    value: float
    direction: tuple[float, ...] = ()


@dataclass
class Deck:
    """A model read from a deck.

    Attributes
    ----------
    points : ndarray, shape (points, 3)
        Places of the nodes in global coordinates, in units of the deck.
    blocks : list of Block
        Solid elements; an element is counted over all blocks in their order.
    element_sets, node_sets : dict
        Numbers of elements and indices of points, both from 0, by name.
    surfaces : dict
        Blocks of triangles and quadrilaterals by the name of a surface.
    parts : dict
        Numbers of elements by the name of a placed part, an instance or a property; every element is in one part.
    materials : dict
        Materials by name.
    material_of : dict
        Name of the material by the name of an element set or of a part.
    left_out : Counter
        Number of elements, or of cards, that are not read, by their name in the deck.
    lumps : list of Lump
        Masses and springs.
    """

    points: Array
    blocks: list[Block] = field(default_factory=list)
    element_sets: dict[str, Array] = field(default_factory=dict)
    node_sets: dict[str, Array] = field(default_factory=dict)
    surfaces: dict[str, list[Block]] = field(default_factory=dict)
    parts: dict[str, Array] = field(default_factory=dict)
    materials: dict[str, Elastic] = field(default_factory=dict)
    material_of: dict[str, str] = field(default_factory=dict)
    left_out: Counter[str] = field(default_factory=Counter)
    lumps: list[Lump] = field(default_factory=list)

    @property
    def count(self) -> int:
        """Number of solid elements."""
        return sum(len(block.nodes) for block in self.blocks)
