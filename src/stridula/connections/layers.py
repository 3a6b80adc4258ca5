"""Layers of rubber between two faces, as springs between their points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint
from ..checks import ArgumentError, instance, positive
from .viscoelastic import ViscoelasticSpring

AXES = ("x", "y", "z")


def viscoelastic_layer(
    first: Sequence[BodyPoint],
    second: Sequence[BodyPoint] | None = None,
    *,
    frequency: Sequence[float],
    stiffness: Mapping[str, Sequence[float]],
    loss_factor: Sequence[float] | Mapping[str, Sequence[float]],
    area: Sequence[float] | None = None,
) -> list[ViscoelasticSpring]:
    """Return a layer between two faces, such as the rubber of a shim or a damping layer, as springs between points.

    Each pair of points has its share of the stiffness, the same along every direction. Rotations of the faces against
    each other are resisted by the arms of the points, as by a layer without a stiffness in bending of its own.

    Parameters
    ----------
    first : sequence of BodyPoint
        Points of one face, such as ``[pad.at(place) for place in pad.face_points("top").place]``.
    second : sequence of BodyPoint, optional
        Points of the other face, each opposite that of the first; the ground if left out.
    frequency : sequence of float
        Frequencies of the tables [Hz], rising, one or more.
    stiffness : mapping of str to sequence of float
        Stiffness of the whole layer at each frequency [N/m] by direction, ``"x"``, ``"y"`` or ``"z"``: one across the
        layer, the others in shear. Directions left out have none.
    loss_factor : sequence of float, or mapping of str to sequence of float
        Loss factor at each frequency [1], of all directions or by direction.
    area : sequence of float, optional
        Area of each pair of points [m²], in proportion to which it takes the stiffness; equal if left out.

    Returns
    -------
    list of ViscoelasticSpring
        Connections for a `System`.

    Examples
    --------
    >>> pad, piston = st.PointMass(0.3, "pad"), st.PointMass(0.4, "piston")
    >>> table = {"y": [2e8], "x": [2e7]}
    >>> faces = [pad.centre], [piston.centre]
    >>> for spring in st.viscoelastic_layer(*faces, frequency=[2e3], stiffness=table, loss_factor=[0.3]):
    ...     print(spring)
    viscoelastic spring 2e+08 N/m with a loss factor of 0.3 at 2000 Hz along y
    viscoelastic spring 2e+07 N/m with a loss factor of 0.3 at 2000 Hz along x
    """
    pairs = _pairs(first, second)
    shares = _shares(area, len(pairs))
    instance("stiffness", stiffness, Mapping)
    losses = loss_factor if isinstance(loss_factor, Mapping) else dict.fromkeys(stiffness, loss_factor)
    if not stiffness or not set(stiffness) <= set(AXES):
        got = ", ".join(map(str, stiffness)) or "none"
        raise ArgumentError("stiffness", "have tables by direction, x, y or z", got=got)
    if set(losses) != set(stiffness):
        words = f"have the directions of stiffness, {', '.join(stiffness)}"
        raise ArgumentError("loss_factor", words, got=", ".join(map(str, losses)) or "none")
    return [
        ViscoelasticSpring(
            one,
            other,
            direction=direction,
            frequency=frequency,
            stiffness=(share * np.asarray(table, dtype=float)).tolist(),
            loss_factor=losses[direction],
        )
        for (one, other), share in zip(pairs, shares.tolist(), strict=True)
        for direction, table in stiffness.items()
    ]


def _pairs(first: Sequence[BodyPoint], second: Sequence[BodyPoint] | None) -> list[tuple[BodyPoint, BodyPoint | None]]:
    """Return the points that lie opposite each other."""
    ones = list(first)
    others: list[BodyPoint | None] = [None] * len(ones) if second is None else list(second)
    if not ones:
        raise ArgumentError("first", "have one point or more", got="none")
    if len(others) != len(ones):
        raise ArgumentError("second", f"have as many points as first, {len(ones)}", got=str(len(others)))
    return list(zip(ones, others, strict=True))


def _shares(area: Sequence[float] | None, count: int) -> Array:
    """Return the share of each pair of points in the stiffness."""
    areas = [1.0] * count if area is None else [positive(f"area[{k}]", one) for k, one in enumerate(area)]
    if len(areas) != count:
        raise ArgumentError("area", f"have as many values as first has points, {count}", got=str(len(areas)))
    return np.array(areas) / np.sum(areas)
