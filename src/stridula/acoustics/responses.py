"""Impulse responses from the modes of a track to listeners, in a baffle or in free air."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ..arrays import Array
from .air import Air
from .delays import Response, interpolation
from .dipoles import dipole_response, moved_area
from .listeners import check_in_front, check_off_beam
from .panels import Panel, line_of, panel_of
from .rayleigh import baffled_response
from .surfaces import surface_of


class Way(Protocol):
    """Radiation of a track: flush with a baffle, or as a slim beam in free air."""

    @property
    def panel(self) -> Panel:
        """Its surface and the modes that bend it."""

    def check(self, listeners: Array) -> None:
        """Raise ValueError if a listener is at a place without sound, inside a body or behind the baffle."""

    def responses(
        self, modes: Array, listeners: Array, air: Air, interval: float, shift: float, bandwidth: float
    ) -> list[Response]:
        """Return the responses of modes, by number in the panel, at every listener, `shift` samples later."""

    def notes(self, air: Air) -> list[str]:
        """Return notes on its validity."""


def way_of(track: Any, baffled: bool) -> Way:
    """Return how a track radiates: in a baffle, or as a slim beam in free air.

    Raises
    ------
    ValueError
        If the track cannot radiate in this way.
    """
    return Baffled(panel_of(track)) if baffled else SlimLine(track, line_of(track))


class Baffled:
    """A track that is flush with a rigid infinite wall."""

    def __init__(self, panel: Panel) -> None:
        self.panel = panel

    def check(self, listeners: Array) -> None:
        """Raise ValueError if a listener is in the wall or behind it."""
        check_in_front(listeners)

    def responses(
        self, modes: Array, listeners: Array, air: Air, interval: float, shift: float, bandwidth: float
    ) -> list[Response]:
        """Return the responses at every listener."""
        panel, kernel = self.panel.only(modes), interpolation(bandwidth * interval)
        surfaces = [surface_of(panel, listener, 2.0 * np.pi * bandwidth / air.speed) for listener in listeners]
        return [
            baffled_response(surface, listener, air, interval, kernel, shift)
            for surface, listener in zip(surfaces, listeners, strict=True)
        ]

    def notes(self, air: Air) -> list[str]:
        """Return no notes: it is always valid."""
        return []


class SlimLine:
    """A beam in free air as a line of dipoles."""

    def __init__(self, beam: Any, panel: Panel) -> None:
        self.beam, self.panel, self.area = beam, panel, moved_area(beam.section)

    def check(self, listeners: Array) -> None:
        """Raise ValueError if a listener is on the beam."""
        check_off_beam(listeners, self.beam.length, self.beam.section.across / 2.0)

    def responses(
        self, modes: Array, listeners: Array, air: Air, interval: float, shift: float, bandwidth: float
    ) -> list[Response]:
        """Return the responses at every listener."""
        panel, kernel = self.panel.only(modes), interpolation(bandwidth * interval)
        return [dipole_response(panel, self.area, one, air, interval, kernel, shift) for one in listeners]

    def notes(self, air: Air) -> list[str]:
        """Return a note on the frequency up to which it is valid."""
        return [f"a line of dipoles: the beam is slim below {slim_below(self.beam, air):.4g} Hz"]


def slim_below(beam: Any, air: Air) -> float:
    """Return the frequency [Hz] below which a beam is slim: its width is a sixth of the wavelength."""
    return float(air.speed / (6.0 * beam.section.largest_side))
