"""What a track sends to a listener: an impulse response for each of its modes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from .air import Air
from .delays import Interpolation, Response, interpolation
from .dipoles import dipole_response, moved_area
from .listeners import check_in_front, check_off_beam
from .panels import Panel
from .rayleigh import baffled_response
from .surfaces import surface_of


def check_listeners(listeners: Array, track: ModalBeam | ModalPlate, baffled: bool) -> None:
    """Raise ValueError if a listener is where a track cannot be heard."""
    if baffled:
        check_in_front(listeners)
        return
    section: Any = track.section  # type: ignore[union-attr]
    moved_area(section)
    check_off_beam(listeners, track.length, section.across / 2.0)


def responses(
    panel: Panel,
    track: Any,
    baffled: bool,
    listeners: Array,
    air: Air,
    interval: float,
    shift: float,
    bandwidth: float,
) -> list[Response]:
    """Return the impulse responses of the modes at every listener, `shift` samples later."""
    kernel = interpolation(bandwidth * interval)
    if baffled:
        return [_of_panel(panel, listener, air, interval, kernel, shift, bandwidth) for listener in listeners]
    area = moved_area(track.section)
    return [dipole_response(panel, area, listener, air, interval, kernel, shift) for listener in listeners]


def _of_panel(
    panel: Panel,
    listener: Array,
    air: Air,
    interval: float,
    kernel: Interpolation,
    shift: float,
    bandwidth: float,
) -> Response:
    surface = surface_of(panel, listener, 2.0 * np.pi * bandwidth / air.speed)
    return baffled_response(surface, listener, air, interval, kernel, shift)
