"""Impulse responses from the modes of a track to listeners, in a baffle or in free air."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any, ClassVar, Protocol

import numpy as np

from ..arrays import Array
from ..bodies import ModalPlate
from ..bodies.body_surfaces import HIGHEST as FINE_ENOUGH
from .air import Air
from .delays import Sampling
from .dipoles import dipole_response, moved_area
from .distances import NEAREST
from .free_responses import STOP_BEYOND, WHOLE_BEYOND
from .listeners import check_off_beam, check_off_panel
from .open_surfaces import HIGHEST, Heard, by_fits
from .panels import Panel, line_of, panel_of
from .rayleigh import baffled_response
from .sheets import Sheet, sheet_of
from .slim_beams import slim_below
from .surfaces import surface_of


class Way(Protocol):
    """Radiation of a track: flush with a baffle, or in free air.

    Attributes
    ----------
    most : float
        Largest bandwidth of its sound [Hz].
    in_a_wall : bool
        Whether it is flush with a rigid infinite wall.
    """

    most: ClassVar[float]
    in_a_wall: ClassVar[bool]

    @property
    def panel(self) -> Panel:
        """Its surface and the modes that bend it."""

    def distances(self, listeners: Array, as_given: Array) -> Array:
        """Return the distances of listeners [m]; raise ValueError, with the place as given, for one on the track."""

    def heard(self, modes: Array, listeners: Array, air: Air, sampling: Sampling) -> Heard:
        """Return the sound of modes, by number in the panel, at every listener."""


def way_of(track: Any, baffled: bool, name: str = "") -> Way:
    """Return how a track radiates: in a baffle, or in free air as a thin plate or a slim beam.

    Raises
    ------
    ValueError
        If the track cannot radiate in this way.
    """
    if baffled:
        return Baffled(panel_of(track))
    return Thin(track, name or track.name) if hasattr(track, "track_line") else SlimLine(track, line_of(track))


class Baffled:
    """A track that is flush with a rigid infinite wall."""

    most: ClassVar[float] = np.inf
    in_a_wall: ClassVar[bool] = True

    def __init__(self, panel: Panel) -> None:
        self.panel = panel

    def distances(self, listeners: Array, as_given: Array) -> Array:
        """Return the distances of listeners from its surface."""
        return self.panel.distances(listeners)

    def heard(self, modes: Array, listeners: Array, air: Air, sampling: Sampling) -> Heard:
        """Return the responses at every listener."""
        panel, wavenumber = self.panel.only(modes), 2.0 * np.pi * sampling.bandwidth / air.speed
        surfaces = [surface_of(panel, listener, wavenumber) for listener in listeners]
        responses = [
            baffled_response(surface, listener, air, sampling)
            for surface, listener in zip(surfaces, listeners, strict=True)
        ]
        return Heard(modes, responses)


class SlimLine:
    """A beam in free air as a line of dipoles."""

    most: ClassVar[float] = np.inf
    in_a_wall: ClassVar[bool] = False

    def __init__(self, beam: Any, panel: Panel) -> None:
        self.beam, self.panel, self.area = beam, panel, moved_area(beam.section)

    def distances(self, listeners: Array, as_given: Array) -> Array:
        """Return the distances of listeners from its axis."""
        check_off_beam(listeners, self.beam.length, self.beam.section.across / 2.0, as_given)
        return self.panel.distances(listeners)

    def heard(self, modes: Array, listeners: Array, air: Air, sampling: Sampling) -> Heard:
        """Return the responses at every listener, with a note on the frequency up to which they are valid."""
        panel = self.panel.only(modes)
        responses = [dipole_response(panel, self.area, one, air, sampling) for one in listeners]
        note = f"a line of dipoles: the beam is slim below {slim_below(self.beam, air):.4g} Hz"
        return Heard(modes, responses, notes=[note])


class Thin:
    """A thin plate in free air as a sheet of dipoles."""

    most: ClassVar[float] = HIGHEST
    in_a_wall: ClassVar[bool] = False

    def __init__(self, plate: ModalPlate, name: str) -> None:
        self.plate, self.name, self.panel = plate, name or "the plate", panel_of(plate)
        self.nearest = NEAREST * float(np.hypot(plate.length, plate.width))

    def distances(self, listeners: Array, as_given: Array) -> Array:
        """Return the distances of listeners from the plate."""
        found = self.panel.distances(listeners)
        check_off_panel(found, self.nearest, as_given)
        return found

    def heard(self, modes: Array, listeners: Array, air: Air, sampling: Sampling) -> Heard:
        """Return the responses at every listener, with a note if the sheet has too few points for the bandwidth."""
        sheet, distances = _sheet(self.plate), self.panel.distances(listeners)
        numbers = np.arange(len(sheet.parities))
        frequency = self.panel.angular_frequency[numbers] / (2.0 * np.pi)
        sent = by_fits(self.name, sheet, numbers, frequency, listeners, distances, air, sampling)
        if sheet.frequency < min(sampling.bandwidth, WHOLE_BEYOND * float(frequency.max())):
            note = f"{self.name}: the points of its sheet are enough only up to {sheet.frequency:.4g} Hz"
            sent = replace(sent, notes=[*sent.notes, note])
        return sent.only(modes)


@lru_cache(maxsize=8)
def _sheet(plate: ModalPlate) -> Sheet:
    """Return a plate as a sheet; the same object each time, as fits are cached by it."""
    panel = panel_of(plate)
    frequency = panel.angular_frequency / (2.0 * np.pi)
    low = panel.only(frequency <= max(FINE_ENOUGH, float(frequency[0])))
    return sheet_of(low, min(FINE_ENOUGH, STOP_BEYOND * float(low.angular_frequency.max()) / (2.0 * np.pi)))
