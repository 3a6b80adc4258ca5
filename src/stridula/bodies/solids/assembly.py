"""Parts of an assembly as one mesh of one kind of elements, their names before those of their groups."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, listed
from .cut_elements import CUT_KINDS, cut_into_tetrahedra, triangles_of
from .kinds import KINDS

if TYPE_CHECKING:
    from .solid_mesh import SolidMesh


def assembly(parts: Mapping[str, SolidMesh]) -> dict[str, Any]:
    """Return the parts as arguments of `SolidMesh`: each a volume, and its groups as "part/group"."""
    if not parts:
        raise ArgumentError("parts", "hold at least one mesh", parts)
    for name, part in parts.items():
        if not isinstance(name, str) or not name or "/" in name:
            raise ArgumentError("parts", "have names that are text without '/'", name)
        if part.ties:
            raise ArgumentError(f"parts[{name!r}]", "not be tied itself: tie all parts at once", part)
    alike = _alike(parts)
    groups: dict[str, dict[str, Array]] = {"volumes": {}, "faces": {}, "node_sets": {}}
    nodes = elements = 0
    for name, one in alike.items():
        groups["volumes"][name] = elements + np.arange(len(one["elements"]))
        starts = {"volumes": elements, "faces": np.array([elements, 0]), "node_sets": nodes}
        for word, start in starts.items():
            groups[word] |= {f"{name}/{group}": start + those for group, those in one[word].items()}
        one["elements"] = one["elements"] + nodes
        nodes, elements = nodes + len(one["nodes"]), elements + len(one["elements"])
    arrays = {word: np.concatenate([one[word] for one in alike.values()]) for word in ("nodes", "elements")}
    return {**arrays, **groups, "kind": next(iter(alike.values()))["kind"]}


def _alike(parts: Mapping[str, SolidMesh]) -> dict[str, dict[str, Any]]:
    """Return the arguments of parts with elements of one kind.

    Elements of first order get middles of edges if others have them, and hexahedra are cut beside tetrahedra.
    """
    kinds = {part.kind for part in parts.values()}
    if len(kinds) > 1 and any(KINDS[kind].middles for kind in kinds):
        parts = {name: part.quadratic() for name, part in parts.items()}
        kinds = {part.kind for part in parts.values()}
    found = {name: {one.name: getattr(part, one.name) for one in fields(part)} for name, part in parts.items()}
    if len(kinds) == 1:
        return found
    if not kinds <= set(CUT_KINDS):
        words = listed(f"{name!r} {KINDS[part.kind].words}" for name, part in parts.items())
        raise ArgumentError("parts", "have nodes in the middle of faces all or none", got=words)
    return {name: one if one["kind"].startswith("tetra") else _cut(one) for name, one in found.items()}


def _cut(part: dict[str, Any]) -> dict[str, Any]:
    """Return a mesh of hexahedra cut into tetrahedra, with its groups."""
    kind = KINDS[part["kind"]]
    cut = cut_into_tetrahedra(part["nodes"], [(kind.name, part["elements"])])
    tetra = KINDS["tetra10" if kind.middles else "tetra"]
    # Triangles by their element and their corners; that element has them once.
    triangles = np.column_stack([np.repeat(cut.owner, 4), _triangles(cut.elements[:, np.array(tetra.faces)])])
    faces = {}
    for name, those in part["faces"].items():
        corners = part["elements"][those[:, :1], np.array(kind.faces)[those[:, 1]]]
        wanted = np.column_stack([np.repeat(those[:, 0], 2), _triangles(triangles_of(corners))])
        _, number = np.unique(np.vstack([wanted, triangles]), axis=0, return_inverse=True)
        at = np.flatnonzero(np.isin(number.ravel()[len(wanted) :], number.ravel()[: len(wanted)]))
        faces[name] = np.stack(np.divmod(at, 4), axis=1)
    further = len(part["nodes"]) + np.arange(len(cut.ends))
    return {
        "nodes": cut.nodes,
        "elements": cut.elements,
        "kind": tetra.name,
        "volumes": {name: np.flatnonzero(np.isin(cut.owner, those)) for name, those in part["volumes"].items()},
        "faces": faces,
        "node_sets": {
            name: np.append(those, further[np.isin(cut.ends, those).all(axis=1)])
            for name, those in part["node_sets"].items()
        },
    }


def _triangles(corners: Array) -> Array:
    """Return triangles by their corners, rising, shape (triangles, 3)."""
    return np.sort(corners.reshape(-1, 3), axis=1)
