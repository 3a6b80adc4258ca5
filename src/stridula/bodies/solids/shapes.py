"""Meshes in space without a mesher: blocks, sectors of rings, extrusions; nodes in the middle of edges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...arrays import Array
from .kinds import KINDS

_SIDES = ("left", "right", "bottom", "top", "back", "front")


def with_middles(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the parts of a linear mesh with nodes in the middle of its edges, as arguments of `SolidMesh`."""
    kind = KINDS[values["kind"]]
    nodes, elements = values["nodes"], values["elements"]
    ends = np.sort(elements[:, np.array(kind.edges)].reshape(-1, 2), axis=1)
    edges, of_element = np.unique(ends, axis=0, return_inverse=True)
    middles = len(nodes) + of_element.reshape(len(elements), -1)
    sets = {}
    for name, those in values.get("node_sets", {}).items():
        is_in = np.zeros(len(nodes), dtype=bool)
        is_in[those] = True
        sets[name] = np.append(those, len(nodes) + np.flatnonzero(is_in[edges].all(axis=1)))
    return {
        **values,
        "nodes": np.vstack([nodes, nodes[edges].mean(axis=1)]),
        "elements": np.hstack([elements, middles]),
        "kind": kind.quadratic,
        "node_sets": sets,
    }


def block(lengths: tuple[float, float, float], divisions: tuple[int, int, int]) -> dict[str, Any]:
    """Return a block of hexahedra of 20 nodes, as arguments of `SolidMesh`."""
    unit = with_middles(_grid(divisions))
    unit["nodes"] = unit["nodes"] * np.array(lengths)
    return unit


def sector(
    radii: tuple[float, float],
    angles: tuple[float, float],
    heights: Mapping[str, float],
    divisions: tuple[int, int, int],
    axis: str,
) -> dict[str, Any]:
    """Return a sector of a ring of hexahedra of 20 nodes, which lie on circles, as arguments of `SolidMesh`."""
    unit = _grid((*divisions[:2], divisions[2] * len(heights)))
    count = len(unit["elements"])
    unit["volumes"] = _layers(heights, np.arange(count) // divisions[2] % len(heights))
    unit["nodes"][:, 2] = np.interp(unit["nodes"][:, 2], *_levels(heights))
    is_ring = angles[1] - angles[0] >= 2.0 * math.pi * (1.0 - 1e-12)
    names = dict(zip(_SIDES, ("inner", "outer", "start", "end", "bottom", "top"), strict=True))
    unit["faces"] = {names[side]: faces for side, faces in unit["faces"].items()}
    if is_ring:
        unit["faces"] = {name: faces for name, faces in unit["faces"].items() if name not in ("start", "end")}
    # Middles are set on straight edges, then bent with them.
    bent = with_middles(unit)
    radius = radii[0] + (radii[1] - radii[0]) * bent["nodes"][:, 0]
    angle = angles[0] + (angles[1] - angles[0]) * bent["nodes"][:, 1]
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), bent["nodes"][:, 2]], axis=1)
    if is_ring:
        places, bent = _closed(places, bent)
    return {**bent, "nodes": _about(places, axis)}


def extrusion(
    places: Array, quadrilaterals: Array, heights: Mapping[str, float], through_each: int, axis: str
) -> dict[str, Any]:
    """Return a plane mesh of quadrilaterals extruded along an axis, as arguments of `SolidMesh`."""
    layers = through_each * len(heights)
    level = np.repeat(np.interp(np.linspace(0.0, 1.0, layers + 1), *_levels(heights)), len(places))
    nodes = np.column_stack([np.tile(places, (layers + 1, 1)), level])
    lower = quadrilaterals[None] + len(places) * np.arange(layers)[:, None, None]
    elements = np.concatenate([lower, lower + len(places)], axis=2).reshape(-1, 8)
    count = len(quadrilaterals)
    # Sides of one quadrilateral only, as the faces 2, 1, 3, 0 of a hexahedron.
    pairs = np.sort(np.stack([quadrilaterals, np.roll(quadrilaterals, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, which, times = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    element, edge = np.divmod(np.flatnonzero(times[which.ravel()] == 1), 4)
    side = np.array([2, 1, 3, 0])[edge]
    every = np.concatenate([np.column_stack([element + count * layer, side]) for layer in range(layers)])
    faces = {
        "bottom": np.column_stack([np.arange(count), np.full(count, 4)]),
        "top": np.column_stack([np.arange(count) + count * (layers - 1), np.full(count, 5)]),
        "side": every,
    }
    volumes = _layers(heights, np.arange(len(elements)) // (count * through_each))
    drawn = with_middles(
        {"nodes": nodes, "elements": elements, "kind": "hexahedron", "faces": faces, "volumes": volumes}
    )
    return {**drawn, "nodes": _about(drawn["nodes"], axis)}


def _levels(heights: Mapping[str, float]) -> tuple[Array, Array]:
    """Return the ends of layers of equal thickness from 0 to 1, and their true coordinates [m]."""
    return np.linspace(0.0, 1.0, len(heights) + 1), np.append(0.0, np.cumsum(list(heights.values())))


def _layers(heights: Mapping[str, float], of_element: Array) -> dict[str, Array]:
    """Return the elements of each named layer."""
    return {name: np.flatnonzero(of_element == number) for number, name in enumerate(heights) if name}


def _grid(divisions: tuple[int, int, int]) -> dict[str, Any]:
    """Return the unit cube cut into hexahedra, as arguments of `SolidMesh`."""
    cuts = [np.linspace(0.0, 1.0, parts + 1) for parts in divisions]
    nodes = np.stack(np.meshgrid(*cuts, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(nodes)).reshape([parts + 1 for parts in divisions])
    corners = np.array(KINDS["hexahedron"].corners)
    elements = np.stack(
        [
            number[tuple(slice(at, at + parts) for at, parts in zip(corner, divisions, strict=True))]
            for corner in corners
        ],
        axis=-1,
    ).reshape(-1, 8)
    cell = np.arange(len(elements)).reshape(divisions)
    faces = {}
    for side, name in enumerate(_SIDES):
        those = np.take(cell, -(side % 2), axis=side // 2).ravel()
        faces[name] = np.column_stack([those, np.full(those.size, side)])
    return {"nodes": nodes, "elements": elements, "kind": "hexahedron", "faces": faces}


def _closed(places: Array, parts: dict[str, Any]) -> tuple[Array, dict[str, Any]]:
    """Return a ring whose end is joined to its start."""
    unit = parts["nodes"]
    at_end, at_start = np.flatnonzero(unit[:, 1] == 1.0), np.flatnonzero(unit[:, 1] == 0.0)
    order = [np.lexsort(unit[those][:, [0, 2]].T) for those in (at_end, at_start)]
    same = np.arange(len(unit))
    same[at_end[order[0]]] = at_start[order[1]]
    kept, number = np.unique(same, return_inverse=True)
    return places[kept], {**parts, "elements": number[parts["elements"]]}


def _about(places: Array, axis: str) -> Array:
    """Return places given in two directions and along an axis as x, y and z."""
    return np.roll(places, "xyz".index(axis) + 1, axis=1)
