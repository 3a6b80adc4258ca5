"""Build layers between faces of meshed bodies from checked tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..bodies import SolidBody
from ..checks import ArgumentError
from ..connections import ViscoelasticSpring, opposite_points, viscoelastic_layer

# Keys of the arguments of opposite_points.
KEYS = {"face": "first.face", "other_face": "second.face"}


def layer_of(table: Mapping[str, Any], body: SolidBody, other: SolidBody | None = None) -> list[ViscoelasticSpring]:
    """Return the springs of a layer.

    Parameters
    ----------
    table : mapping
        Its table.
    body, other : SolidBody
        Bodies of both faces; the ground if the other is left out.

    Raises
    ------
    ArgumentError
        If a face does not exist, nothing lies opposite it, or a value is not allowed; named by its key.
    """
    given = {name: table[name] for name in ("points", "farthest") if table.get(name) is not None}
    other_face = "" if other is None else table["second"]["face"]
    try:
        first, second, area = opposite_points(body, table["first"]["face"], other, other_face, **given)
    except ArgumentError as error:
        raise (error.renamed(KEYS[error.argument]) if error.argument in KEYS else error) from None
    frequency = _each(table["frequency"], 1)
    count, losses = len(frequency), table["loss_factor"]
    return viscoelastic_layer(
        first,
        second,
        area=area.tolist(),
        frequency=frequency,
        stiffness=_by_direction(table["stiffness"], count),
        loss_factor=_by_direction(losses, count) if isinstance(losses, Mapping) else _each(losses, count),
    )


def _by_direction(table: Mapping[str, Any], count: int) -> dict[str, list[float]]:
    return {axis: _each(value, count) for axis, value in table.items() if value is not None}


def _each(value: Any, count: int) -> list[float]:
    """Return one value for each frequency, the same for all if it is a number."""
    return list(value) if isinstance(value, (list, tuple)) else [value] * count
