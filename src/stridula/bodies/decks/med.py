"""MED files of Salome and Code_Aster, in HDF5: nodes, elements and groups; h5py is imported on first use."""

from __future__ import annotations

import os
from collections import Counter
from typing import Any

import numpy as np

from ...arrays import Array
from ...checks import in_one_line
from ...disk import opened
from ...extras import named_extras
from ..reading.deck_error import DeckError
from .deck import CORNERS, Block, Deck
from .mirrored import right_handed

SOLIDS = {
    "TE4": "tetra",
    "T10": "tetra10",
    "PY5": "pyramid",
    "P13": "pyramid13",
    "PE6": "wedge",
    "P15": "wedge15",
    "HE8": "hexahedron",
    "H20": "hexahedron20",
    "H27": "hexahedron27",
}
# Middles of faces: bottom, the four sides, top.
TWENTY_SEVEN = [*range(20), 24, 22, 21, 23, 20, 25, 26]
SHELLS = {"TR3": "triangle", "TR6": "triangle", "TR7": "triangle", "QU4": "quad", "QU8": "quad", "QU9": "quad"}
# Largest dataset: one may announce more numbers than its file has.
LARGEST = 2**28
THIN = ("PO1", "SE2", "SE3", "SE4")


def read_med(path: str | os.PathLike[str]) -> Deck:
    """Read the mesh of a MED file.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Deck
        Its element sets, surfaces and node sets are the groups by their names. Other cells and fields are counted.

    Raises
    ------
    DeckError
        If the file is damaged or holds several meshes.
    OSError
        If the file cannot be read.
    """
    with named_extras():
        import h5py

    with opened(path) as file:
        try:
            with h5py.File(file, "r") as held:
                return _Reader(held).deck()
        except DeckError:
            raise
        except MemoryError:
            raise DeckError(0, "it announces more data than fit into memory") from None
        except Exception as error:
            # Libraries of HDF5 raise any exception for damaged files.
            raise DeckError(0, in_one_line(error)) from error


class _Reader:
    """Reader of the groups and datasets of a file."""

    def __init__(self, file: Any) -> None:
        self.file = file
        self.left_out: Counter[str] = Counter()

    def deck(self) -> Deck:
        """Return the deck of the mesh."""
        name, mesh = self._only(self._of(self.file, "ENS_MAA"), "meshes")
        if mesh.attrs.get("TYP", 0) != 0 or mesh.attrs.get("REP", 0) != 0 or mesh.attrs.get("ESP", 3) != 3:
            raise DeckError(0, f"the mesh {name!r} must be unstructured, in space, in Cartesian coordinates")
        step = mesh if "NOE" in mesh else self._only(mesh, "states")[1]
        nodes, cells = self._of(step, "NOE"), self._of(step, "MAI")
        points = self._array(nodes, "COO").reshape(3, -1).T.astype(float)
        self.deck_of = Deck(points, left_out=self.left_out)
        families = self._of(self._of(self.file, "FAS"), name) if "FAS" in self.file else {}
        of_nodes, of_cells = (self._names(families, word) for word in ("NOEUD", "ELEME"))
        if "FAM" in nodes:
            self._add_groups(
                self.deck_of.node_sets, self._families(nodes, len(points)), of_nodes, np.arange(len(points))
            )
        self.count = 0
        for kind in cells:
            self._read_cells(kind, self._of(cells, kind), of_cells)
        if "CHA" in self.file and len(self.file["CHA"]):
            self.left_out["fields"] += len(self.file["CHA"])
        return self.deck_of

    def _read_cells(self, kind: str, cells: Any, names: dict[int, list[str]]) -> None:
        """Read the cells of a kind."""
        deck = self.deck_of
        if kind not in (*SOLIDS, *SHELLS, *THIN):
            self.left_out[f"cells {kind}"] += len(cells.get("NUM", cells.get("FAM", [0])))
            return
        width = int(kind[1:]) if kind[1:].isdigit() else int(kind[2:])
        rows = self._array(cells, "NOD").reshape(width, -1).T.astype(np.int64) - 1
        if rows.size and (rows.min() < 0 or rows.max() >= len(deck.points)):
            raise DeckError(0, f"cells {kind} have nodes from 1 to {len(deck.points)}, got {rows.max() + 1}")
        families = self._families(cells, len(rows))
        if kind in SOLIDS:
            ordered = rows[:, TWENTY_SEVEN] if kind == "H27" else rows
            deck.blocks.append(Block(SOLIDS[kind], right_handed(SOLIDS[kind], ordered, deck.points)))
            self._add_groups(deck.element_sets, families, names, self.count + np.arange(len(rows)))
            self.count += len(rows)
            return
        for group, those in _members(families, names).items():
            if kind in SHELLS:
                corners = rows[those][:, : CORNERS[SHELLS[kind]]]
                deck.surfaces.setdefault(group, []).append(Block(SHELLS[kind], corners))
            else:
                _add(deck.node_sets, group, rows[those].ravel())

    def _add_groups(self, sets: dict[str, Array], families: Array, names: dict[int, list[str]], numbers: Array) -> None:
        for group, those in _members(families, names).items():
            _add(sets, group, numbers[those])

    def _families(self, group: Any, count: int) -> Array:
        """Return the family of each node or cell; 0, which has no groups, where the file gives none."""
        if "FAM" not in group:
            return np.zeros(count, dtype=np.int64)
        found = self._array(group, "FAM").ravel().astype(np.int64)
        if len(found) != count:
            raise DeckError(0, f"a list of families has {len(found)} numbers for {count} nodes or cells")
        return found

    def _names(self, families: Any, word: str) -> dict[int, list[str]]:
        """Return the names of the groups of each family."""
        found = {}
        if word in families:
            of_kind = self._of(families, word)
            for name in of_kind:
                family = self._of(of_kind, name)
                texts: Any = self._array(self._of(family, "GRO"), "NOM") if "GRO" in family else []
                words = [np.asarray(text).astype(np.uint8).tobytes().split(b"\0")[0] for text in texts]
                found[int(family.attrs["NUM"])] = [word.decode("utf-8", "replace").strip() for word in words]
        return found

    def _only(self, group: Any, words: str) -> tuple[str, Any]:
        """Return the only member of a group."""
        names = list(group)
        if len(names) != 1:
            listed = ", ".join(map(repr, names[:5])) or "none"
            raise DeckError(0, f"a file must hold one mesh in one state, got {len(names)} {words}: {listed}")
        return names[0], self._of(group, names[0])

    def _of(self, group: Any, name: str) -> Any:
        """Return a member of a group that is within the file."""
        import h5py

        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise DeckError(0, f"{name!r} is missing, or outside of the file: export the mesh again")
        return group[name]

    def _array(self, group: Any, name: str) -> Array:
        """Return a dataset that is within the file."""
        found = self._of(group, name)
        if not hasattr(found, "external") or found.external or found.is_virtual:
            raise DeckError(0, f"{name!r} must be a dataset within the file")
        if found.size > LARGEST:
            raise DeckError(0, f"{name!r} announces {found.size} numbers, but at most {LARGEST} are read")
        return np.asarray(found[()])


def _members(families: Array, names: dict[int, list[str]]) -> dict[str, Array]:
    """Return the numbers in each group."""
    found: dict[str, Array] = {}
    for family in np.unique(families).tolist():
        for name in names.get(family, []):
            _add(found, name, np.flatnonzero(families == family))
    return found


def _add(sets: dict[str, Array], name: str, those: Array) -> None:
    """Add numbers to a set."""
    if name and those.size:
        sets[name] = np.unique(np.concatenate([sets.get(name, those[:0]), those]))
