"""Slim beams anywhere in the plane or in space as lines of dipoles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from .air import Air
from .delays import Response, Sampling
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
    frame : ndarray, shape (3, 3)
        Directions along it, perpendicular to it and to its bending, and across it along its bending, in the axes of
        places.
    origin : ndarray, shape (3,)
        Place of its abscissa 0 in these axes [m].
    """

    width: ClassVar[float] = 0.0
    edge: ClassVar[float] = 0.0
    body: Any
    held: bool
    numbers: Array
    wavenumbers: Array
    frame: Array
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

    def only(self, modes: Array) -> SlimBeam:
        """Return it with some of its modes, by their indices in `numbers`."""
        return replace(self, numbers=self.numbers[modes], wavenumbers=self.wavenumbers[modes])

    def beside(self, places: Array) -> Array:
        """Return listeners in its own axes, shape (listeners, 3)."""
        return np.asarray((places - self.origin) @ self.frame.T)

    def distances(self, places: Array) -> Array:
        """Return the distances of listeners to the nearest points of its axis [m].

        Raises
        ------
        ValueError
            If a listener is on the beam.
        """
        own = self.beside(places)
        check_off_beam(own, self.length, self.body.section.across / 2.0, places)
        x, y, z = own.T
        return np.asarray(np.sqrt((x - np.clip(x, 0.0, self.length)) ** 2 + y**2 + z**2))

    def responses(self, places: Array, air: Air, sampling: Sampling) -> list[Response]:
        """Return the impulse responses of its modes at every listener."""
        line: Any = self
        area = moved_area(self.body.section)
        return [dipole_response(line, area, one, air, sampling) for one in self.beside(places)]


def slim_beam(body: Any, held: bool, numbers: Array, frame: Array, origin: Array) -> SlimBeam:
    """Return a beam with the modes that are heard, at its place; arguments are attributes of a `SlimBeam`."""
    section, material = body.section, body.material
    stiff = (material.density * section.area / (material.young * section.second_moment)) ** 0.25
    along = np.sqrt(body.modes(held).angular_frequency[numbers]) * stiff
    return SlimBeam(body, held, numbers, np.column_stack([along, np.zeros(along.size)]), frame, origin)
