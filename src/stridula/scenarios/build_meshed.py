"""Build bodies of revolution and bodies meshed in space from checked tables."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

from ..bodies import (
    AxisymmetricBody,
    Held,
    LineProfile,
    Material,
    MeshProfile,
    Profile,
    RectangleProfile,
    SolidBody,
    SolidMesh,
)
from ..bodies.revolution.profile_mesh import BODY
from ..checks import ArgumentError
from ..disk import named
from .tables import holds_tables

Tables = dict[str, Any]
# Records errors as problems of the key with this ending.
Within = Callable[..., AbstractContextManager[None]]
# Smallest positive number: a rectangle must have an area.
TINY = math.ulp(0.0)
# Names of the outline in errors of profiles.
OUTLINES = ("rectangles", "points and thickness")
# Constructors of generated meshes, by shape.
MADE: dict[str, Callable[..., SolidMesh]] = {
    "block": SolidMesh.block,
    "sector": SolidMesh.sector,
    "extrusion": SolidMesh.extrusion,
}


def axisymmetric_body(table: Tables, within: Within) -> AxisymmetricBody | None:
    """Return a body of revolution, or None if there is a problem.

    Parameters
    ----------
    table : dict
        Its table, without the kind and with its damping built.
    within : callable
        Function of the end of a key that returns a context manager, which records errors as problems of that key.
    """
    profile: Profile | None = None
    with within("profile"):
        profile = _profile(table.pop("profile"), within)
    material = _materials("material", table, within)
    if profile is None or material is None:
        return None
    held: list[str | Held | None] = [one if isinstance(one, str) else None for one in table.get("held", ())]
    for number, one in enumerate(table.pop("held", ())):
        if not isinstance(one, str):
            with within("held", number):
                held[number] = _held(one, within, number)
    with within():
        return _revolved(profile, material, **_given(table), held=held)
    return None


def solid_body(table: Tables, within: Within) -> SolidBody | None:
    """Return a body meshed in space, or None if there is a problem; parameters as for `axisymmetric_body`."""
    mesh: SolidMesh | None = None
    with within("mesh"):
        mesh = _mesh(table.pop("mesh"), within)
    materials = _materials("materials", table, within)
    if mesh is None or materials is None:
        return None
    with within():
        return SolidBody(mesh, materials, **_given(table))
    return None


def _profile(given: Tables, within: Within) -> Profile | None:
    table = _given(given)
    shape = table.pop("shape")
    if shape == "mesh":
        return _read(MeshProfile.read, table)
    if shape == "cells":
        return MeshProfile(**table)
    if shape == "line":
        return LineProfile(**table)
    parts = table.pop("rectangles", [table])
    boxes = []
    for number, part in enumerate(parts):
        at = ("rectangles", number) if shape == "rectangles" else ()
        with within("profile", *at):
            boxes.append((part.get("region", BODY), _box(part, TINY)))
    if len(boxes) < len(parts):
        return None
    return RectangleProfile(boxes, table.get("size"))


def _revolved(profile: Profile, material: Any, **table: Any) -> AxisymmetricBody:
    try:
        return AxisymmetricBody(profile, material, **table)
    except ArgumentError as error:
        # The profile is divided into cells.
        if error.argument == "size":
            raise error.renamed("profile.size") from None
        raise error.renamed("profile") if error.argument in OUTLINES else error from None


def _held(given: Tables, within: Within, number: int) -> Held | None:
    place = given["place"]
    if isinstance(place, str):
        return Held(**given)
    with within("held", number, "place"):
        return Held(**{**given, "place": _box(place)})
    return None


def _box(sides: Tables, least: float = 0.0) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ranges of r and z, each at least `least` long."""
    for high, low in (("outer", "inner"), ("top", "bottom")):
        if sides[high] - sides[low] < least:
            words = f"{'be above' if least else 'not be below'} {low}, {sides[low]:.6g} m"
            raise ArgumentError(high, words, sides[high])
    return (sides["inner"], sides["outer"]), (sides["bottom"], sides["top"])


def _mesh(given: Tables, within: Within) -> SolidMesh | None:
    """Return a mesh, or None if there is a problem with a part of it."""
    table = _given(given)
    shape = table.pop("shape")
    place = {key: table.pop(key) for key in ("rotation", "offset") if key in table}
    if shape == "tied":
        parts: dict[str, SolidMesh | None] = dict.fromkeys(table["parts"])
        for name, part in table["parts"].items():
            with within("mesh", "parts", name):
                parts[name] = _mesh(part, within)
        if None in parts.values():
            return None
        mesh = SolidMesh.tied(**{**table, "parts": parts})
    elif shape == "file":
        mesh = _read(SolidMesh.read, table)
    else:
        mesh = SolidMesh(**table) if shape == "elements" else MADE[shape](**table)
    return mesh.moved(**place) if place else mesh


def _read(read: Callable[..., Any], table: Tables) -> Any:
    """Return the contents of a file; errors in it name the file."""
    file = table.pop("file")
    try:
        return read(file, **table)
    except ArgumentError as error:
        if error.argument in ("path", *table):
            raise
        raise error.inside(named(file)) from None


def _materials(key: str, table: Tables, within: Within) -> Any:
    """Remove the material of a body, or the materials of its parts by name, from its table and return it built."""
    given = table.pop(key)
    with within(key):
        if holds_tables(given):
            return {name: Material(**one) for name, one in given.items()}
        return Material(**given)
    return None


def _given(table: Tables) -> Tables:
    """Return the keys of a table that hold a value."""
    return {key: value for key, value in table.items() if value is not None}
