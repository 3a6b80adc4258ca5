"""Places of listeners, checked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import ArgumentError, at_least, at_most, finite, positive

FARTHEST = 1000.0
# Height of a pair of ears above the source, and distance between them [m].
HEIGHT, SPACING = 1.0, 0.18


def ears(
    track: ModalBeam | ModalPlate, height: float = HEIGHT, spacing: float = SPACING
) -> list[tuple[float, float, float]]:
    """Return the places of two ears above the middle of a track, the left one first, side by side along it.

    Parameters
    ----------
    track : ModalBeam or ModalPlate
        The track.
    height : float, optional
        Height above it [m].
    spacing : float, optional
        Distance between the ears [m].

    Returns
    -------
    list of tuple
        x, y, z of both [m].
    """
    middle = positive("height", height)
    across = getattr(track, "width", 0.0) / 2.0
    half = positive("spacing", spacing) / 2.0
    return [(track.length / 2.0 + side * half, across, middle) for side in (-1.0, 1.0)]


def listeners_of(listener: Any) -> Array:
    """Return listeners as an array, shape (listeners, 3).

    Raises
    ------
    ValueError
        If it is neither a triple of finite numbers nor a list of them, or is farther than 1000 m away.
    """
    if isinstance(listener, np.ndarray):
        listener = listener.tolist()
    if not isinstance(listener, Sequence) or isinstance(listener, (str, bytes)) or not listener:
        raise ArgumentError("listener", "be (x, y, z) or a list of these", listener)
    several = listener if isinstance(listener[0], (Sequence, np.ndarray)) else [listener]
    found = []
    for number, place in enumerate(several):
        name = "listener" if several is not listener else f"listener[{number}]"
        if not isinstance(place, (Sequence, np.ndarray)) or isinstance(place, (str, bytes)) or len(place) != 3:
            raise ArgumentError(name, "be three distances x, y, z", place)
        found.append([_distance(f"{name}.{axis}", value) for axis, value in zip("xyz", place, strict=True)])
    return np.array(found)


def _distance(name: str, value: Any) -> float:
    number = finite(name, value.item() if isinstance(value, np.generic) else value)
    if abs(number) > FARTHEST:
        raise ArgumentError(name, f"be within {FARTHEST:g} m", value)
    return number


def check_in_front(listeners: Array) -> None:
    """Raise ValueError if a listener is in the surface of a baffle or behind it."""
    for place in listeners:
        if place[2] <= 0.0:
            where = "in the surface" if place[2] == 0.0 else "behind the baffle"
            raise ArgumentError("listener", "be in front of the baffle, z above 0", got=f"z = {place[2]:g} {where}")


def check_off_beam(listeners: Array, length: float, radius: float, as_given: Array | None = None) -> None:
    """Raise ValueError if a listener is on a beam of a length whose section lies within a radius of its axis.

    Messages name the listeners as in `as_given`, if given.
    """
    for place, one in zip(listeners, listeners if as_given is None else as_given, strict=True):
        along = place[0] - min(max(place[0], 0.0), length)
        distance = float(np.hypot(along, np.hypot(place[1], place[2])))
        if distance <= radius:
            raise ArgumentError(
                "listener",
                f"be farther than {at_least(radius, 4)} m from the beam's axis",
                got=f"{tuple(one.tolist())} at {at_most(distance, 4)} m",
            )


def check_off_panel(distances: Array, nearest: float, as_given: Array) -> None:
    """Raise ValueError if a listener, named as in `as_given`, is nearer to a plate than allowed [m]."""
    for place, distance in zip(as_given, distances, strict=True):
        if distance < nearest:
            words = f"be at least {at_least(nearest, 3)} m from the plate"
            raise ArgumentError("listener", words, got=f"{tuple(place.tolist())} at {at_most(distance, 3)} m")
