"""Pairs of modes of bodies that turn, or round which contacts move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies.turning import Turning
from ..checks import ArgumentError
from ..histories import Constant
from .coordinates import Coordinates


@dataclass(frozen=True)
class TurningModes:
    """The modes of a body that turns.

    Attributes
    ----------
    turning : Turning
        Its turning.
    pairs : ndarray of int, shape (pairs, 2)
        Numbers of the modes of each pair.
    span : tuple of int
        First mode of the body and end of its range.
    has_circle : bool
        Whether a contact moves round it.
    """

    turning: Turning
    pairs: Array
    span: tuple[int, int] = (0, 0)
    has_circle: bool = False

    @property
    def is_steady(self) -> bool:
        """Whether the body turns at a constant velocity."""
        return type(self.turning.history) is Constant

    @property
    def orders(self) -> Array:
        """Number of waves round the axis of each pair, shape (pairs,)."""
        return np.array(self.turning.order)

    @property
    def others(self) -> Array:
        """Numbers of the modes of the body without waves round the axis."""
        return np.setdiff1d(np.arange(*self.span), self.pairs)

    def turned(self, modal: Array, by: Array) -> Array:
        """Return the change of modal values, shape (modes,), when pairs turn by angles [rad], shape (pairs,)."""
        (first, second), added = self.pairs.T, np.zeros_like(modal)
        sine, versine = np.sin(by), 2.0 * np.sin(0.5 * by) ** 2
        added[first] = -versine * modal[first] - sine * modal[second]
        added[second] = sine * modal[first] - versine * modal[second]
        return added


def turning_modes(coordinates: Coordinates) -> tuple[TurningModes, ...]:
    """Return the bodies of a system that turn, or round which its contacts move."""
    found = []
    tracks = [contact.track_body for contact in coordinates.system.contacts if contact.circle is not None]
    for body in coordinates.order:
        turning = body.waves_round if body in tracks else coordinates.modes(body).turning
        if body in tracks:
            _check_round(coordinates, body, turning)
        if turning is not None and turning.pairs:
            span = coordinates.spans[body]
            found.append(TurningModes(turning, span[0] + np.array(turning.pairs), span, body in tracks))
    return tuple(found)


def _check_round(coordinates: Coordinates, body: Any, turning: Any) -> None:
    """Raise unless a body is the same all round its axis."""
    name, modes = coordinates.system.body_name(body), coordinates.modes(body)
    if not turning.pairs:
        raise ArgumentError("track", f"have waves round its axis: {name} has none below its cutoff", got="a circle")
    if body in coordinates.joined and len(coordinates.blend):
        words = f"not join {name}, round which a contact moves, if joined bodies have residual shapes"
        raise ArgumentError("connections", words, got="one to it")
    first, second = np.array(turning.pairs).T
    if (modes.damping_rate[first] != modes.damping_rate[second]).any():
        words = f"be the same for both modes of each pair of {name}, round which a contact moves"
        raise ArgumentError("damping", words, body.damping)
