"""Slim beams anywhere in a system in the plane, as lines of dipoles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from .air import Air
from .delays import Response, interpolation
from .dipoles import dipole_response, moved_area
from .listeners import check_off_beam


@dataclass(frozen=True)
class SlimBeam:
    """A beam as a line of dipoles, with the properties that `dipole_response` needs, and its place.

    Attributes
    ----------
    body : FiniteElementBeam or ModalBeam
        The beam.
    held : bool
        Whether its root follows an imposed velocity.
    numbers : ndarray of int, shape (modes,)
        The modes that are heard.
    wavenumbers : ndarray, shape (modes, 2)
        Wavenumbers of bending at their frequencies, along it and across [rad/m].
    origin : ndarray, shape (2,)
        Place of its abscissa 0 in the plane [m].
    """

    width: ClassVar[float] = 0.0
    edge: ClassVar[float] = 0.0
    body: Any
    held: bool
    numbers: Array
    wavenumbers: Array
    origin: Array

    @property
    def length(self) -> float:
        """Length [m]."""
        return float(self.body.length)

    def shapes(self, x: Array, y: Array) -> Array:
        """Return the transverse mode shapes at abscissas x, shape (places, modes) [kg^(-1/2)]."""
        across = self.body.axes[1]
        rows = [across @ self.body.trace(float(place), self.held) for place in x]
        return np.array(rows)[:, self.numbers]

    def beside(self, places: Array) -> Array:
        """Return listeners, given along the track, across it and above it, in its own axes, shape (listeners, 3).

        These are along it, perpendicular to the plane, and across it in the plane.
        """
        along, across = self.body.axes
        away = places[:, [0, 2]] - self.origin
        return np.column_stack([away @ along, places[:, 1], away @ across])

    def check(self, places: Array) -> None:
        """Raise ValueError if a listener is on the beam."""
        check_off_beam(self.beside(places), self.length, self.body.section.across / 2.0)

    def distances(self, places: Array) -> Array:
        """Return the distances of listeners to the nearest points of its axis [m]."""
        x, y, z = self.beside(places).T
        return np.asarray(np.sqrt((x - np.clip(x, 0.0, self.length)) ** 2 + y**2 + z**2))

    def responses(self, places: Array, air: Air, interval: float, shift: float, bandwidth: float) -> list[Response]:
        """Return the impulse responses of its modes at every listener, `shift` samples later."""
        kernel, area = interpolation(bandwidth * interval), moved_area(self.body.section)
        line: Any = self
        return [dipole_response(line, area, one, air, interval, kernel, shift) for one in self.beside(places)]


def slim_beam(body: Any, held: bool, numbers: Array, origin: Array) -> SlimBeam:
    """Return a beam with the modes that are heard, at its place."""
    section, material = body.section, body.material
    stiff = (material.density * section.area / (material.young * section.second_moment)) ** 0.25
    along = np.sqrt(body.modes(held).angular_frequency[numbers]) * stiff
    return SlimBeam(body, held, numbers, np.column_stack([along, np.zeros(along.size)]), origin)
