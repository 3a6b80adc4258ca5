"""The motion of a body that becomes another one of its kind: longer, thicker, leaning more."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..bodies import FiniteElementBeam, ModalBeam, ModalPlate
from ..bodies.modes import Array

SAME_MESH = ("elements", "root_support", "tip_support")


def carries_over(before: Any, now: Any) -> bool:
    """Return whether the motion of one body means something for another."""
    if type(before) is not type(now):
        return False
    if isinstance(before, FiniteElementBeam):
        return all(getattr(before, name) == getattr(now, name) for name in SAME_MESH)
    return isinstance(before, (ModalBeam, ModalPlate)) or before == now


def carried_over(before: Any, now: Any, held: bool, values: Array) -> Array:
    """Return modal positions or velocities of a body as those of the one that it becomes.

    A finite-element beam keeps the travel that its supports leave free, and the deflections of its nodes along and
    across its axis; a beam or plate of exact modes the amplitude of each of its sines.

    Parameters
    ----------
    before, now : body
        The body and what it becomes, for which `carries_over` holds.
    held : bool
        Whether its root follows an imposed velocity.
    values : ndarray, shape (modes before,)
        Modal positions or velocities.

    Returns
    -------
    ndarray, shape (modes now,)
    """
    if before == now:
        return values
    if isinstance(before, FiniteElementBeam):
        return _of_finite_elements(before, now, held, values)
    found = np.zeros(now.modes().count)
    ratio = before.amplitude / now.amplitude
    places = {key: place for place, key in enumerate(_sines(now))}
    for key, value in zip(_sines(before), values, strict=True):
        if key in places:
            found[places[key]] = ratio * value
    return found


def _of_finite_elements(before: FiniteElementBeam, now: FiniteElementBeam, held: bool, values: Array) -> Array:
    traces, rigid = before.node_traces(held), before.modes(held).angular_frequency == 0.0
    travel = traces[:, rigid] @ values[rigid]
    deflected = (traces[:, ~rigid] @ values[~rigid]).reshape(-1, 3)
    deflected[:, :2] = deflected[:, :2] @ before.axes.T @ now.axes
    deflected[:, 2] *= before.length / now.length
    return now.modal_coordinates(travel + deflected.ravel(), held)


def _sines(track: ModalBeam | ModalPlate) -> list[Any]:
    """Return what tells the modes of a track apart, in their order."""
    if isinstance(track, ModalPlate):
        return [tuple(pair) for pair in track.numbers.tolist()]
    bending, axial = track.harmonics
    return [("bending", k) for k in range(bending)] + [("axial", k) for k in range(axial)]
