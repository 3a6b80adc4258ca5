"""Slim beams anywhere in the plane or in space as lines of dipoles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from .air import Air
from .delays import Sampling
from .dipoles import dipole_response, moved_area
from .listeners import check_off_beam
from .open_surfaces import STILL, Heard


@dataclass(frozen=True)
class SlimBeam:
    """A beam in open air as a line of dipoles, with the properties that `dipole_response` needs, and its place.

    Attributes
    ----------
    name : str
        Name of the body.
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

    most: ClassVar[float] = np.inf
    wall: ClassVar[None] = None
    is_line: ClassVar[bool] = True
    width: ClassVar[float] = 0.0
    edge: ClassVar[float] = 0.0
    name: str
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

    @property
    def points(self) -> Array:
        """Its two ends."""
        return np.asarray(self.origin + np.outer([0.0, self.length], self.frame[0]))

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

    def heard(self, moving: Array, places: Array, air: Air, sampling: Sampling) -> Heard:
        """Return the sound of the modes that move."""
        line: Any = self.only(np.flatnonzero(np.isin(self.numbers, moving)))
        if not line.numbers.size:
            return Heard(line.numbers, [])
        area = moved_area(self.body.section)
        responses = [dipole_response(line, area, one, air, sampling) for one in self.beside(places)]
        note = f"{self.name}: a line of dipoles, slim below {slim_below(self.body, air):.4g} Hz"
        return Heard(line.numbers, responses, notes=[note])


def line_along(name: str, beam: Any, held: bool, along: Array, across: Array, origin: Array) -> SlimBeam:
    """Return a beam as a line, with the modes that bend it, from its directions and the place of its abscissa 0."""
    section, material = beam.section, beam.material
    stiff = (material.density * section.area / (material.young * section.second_moment)) ** 0.25
    waves = np.sqrt(beam.modes(held).angular_frequency) * stiff
    frame = np.array([along, np.cross(across, along), across])
    wavenumbers = np.column_stack([waves, np.zeros(waves.size)])
    every = SlimBeam(name, beam, held, np.arange(waves.size), wavenumbers, frame, origin)
    moved = np.abs(every.shapes(beam.drawn_places, beam.drawn_places)).max(axis=0)
    return every.only(np.flatnonzero(moved > STILL * moved.max(initial=0.0)))


def slim_below(beam: Any, air: Air) -> float:
    """Return the frequency [Hz] below which a beam is slim: its width is a sixth of the wavelength."""
    return float(air.speed / (6.0 * beam.section.largest_side))
