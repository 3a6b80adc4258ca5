"""Tracks as flat rectangles whose modes are sines, as the integrals over their surface need them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import singledispatch
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import ArgumentError


@dataclass(frozen=True)
class Panel:
    """A flat rectangle and the modes in which it moves out of its plane.

    Attributes
    ----------
    length, width : float
        Sides along x and y [m]; x is zero at the left end.
    edge : float
        Smallest y [m].
    amplitude : float
        Largest value of a mass-normalised mode shape [kg^(-1/2)].
    wavenumbers : ndarray, shape (modes, 2)
        Wavenumbers of the sines along x and y [rad/m]; zero where a mode is uniform across.
    angular_frequency, damping_rate : ndarray, shape (modes,)
        Angular frequencies w [rad/s] and ``2 zeta w`` [1/s].
    ends : tuple of float
        Least and largest abscissa of a contact point [m].
    place : callable
        Takes abscissas of contact points (...), returns their x and y [m], each (...).
    """

    length: float
    width: float
    edge: float
    amplitude: float
    wavenumbers: Array
    angular_frequency: Array
    damping_rate: Array
    ends: tuple[float, float]
    place: Callable[[Array], tuple[Any, Any]]

    def shapes(self, x: Array, y: Array) -> Array:
        """Return the mass-normalised mode shapes [kg^(-1/2)] at points x, y [m], shape (..., modes)."""
        along, across = self.wavenumbers.T
        shapes = self.amplitude * _sines(x, along)
        if across.any():
            shapes = shapes * _sines(y - self.edge, across)
        return np.broadcast_to(shapes, (*shapes.shape[:-1], len(along)))

    def sines(self, x: Array, y: Array) -> tuple[Array, list[tuple[Array, Array]]]:
        """Return the factors of the mode shapes at abscissas x and, in general others, y [m].

        Returns
        -------
        across : ndarray, shape (points of y, factors)
            Their different factors along y, with the amplitude [kg^(-1/2)].
        along : list of tuple
            For each of these, the numbers of its modes and their sines along x, shape (points of x, modes).
        """
        along, across = self.wavenumbers.T
        different, number = np.unique(across, return_inverse=True)
        factors = np.sin((y - self.edge)[:, None] * different) if across.any() else np.ones((len(y), 1))
        modes = [np.flatnonzero(number == one) for one in range(len(different))]
        return self.amplitude * factors, [(ours, np.sin(x[:, None] * along[ours])) for ours in modes]

    def distances(self, places: Array) -> Array:
        """Return the distances from places x, y, z to the nearest points of the panel [m], shape (places,)."""
        low = np.array([0.0, self.edge])
        away = places[:, :2] - np.clip(places[:, :2], low, low + np.array([self.length, self.width]))
        return np.asarray(np.hypot(np.hypot(away[:, 0], away[:, 1]), places[:, 2]))

    def only(self, modes: Any) -> Panel:
        """Return the panel with only the chosen modes, an index or a slice."""
        return replace(
            self,
            wavenumbers=self.wavenumbers[modes],
            angular_frequency=self.angular_frequency[modes],
            damping_rate=self.damping_rate[modes],
        )


@singledispatch
def panel_of(track: Any) -> Panel:
    """Return the surface of a track: a plate, or a beam as a strip that moves uniformly across its width.

    Axial modes, and those in the plane of a plate, move in the plane of the surface and are left out.

    Parameters
    ----------
    track : ModalBeam or ModalPlate
        The track. The strip's y is zero on the beam's axis, that of a plate on its first edge.

    Raises
    ------
    ValueError
        If it is no such track, or a beam whose section is no rectangle.
    """
    raise ArgumentError("track", "be a ModalBeam or a ModalPlate", track)


def is_flat(body: Any) -> bool:
    """Return whether a body has a flat surface: a plate, or a beam whose section is a rectangle."""
    if panel_of.dispatch(type(body)) is panel_of.dispatch(object):
        return False
    return hasattr(getattr(body, "section", body), "width")


@panel_of.register
def _of_a_beam(track: ModalBeam) -> Panel:
    if not hasattr(track.section, "width"):
        raise ArgumentError("track", "have a Rectangle as section to have a flat surface in a baffle", track.section)
    return _bent(track, track.section.width)


def line_of(track: ModalBeam) -> Panel:
    """Return the bending modes of a beam as a panel without width."""
    if not isinstance(track, ModalBeam):
        raise ArgumentError("track", "be a ModalBeam to radiate without a baffle", track)
    return _bent(track, 0.0)


def _sines(places: Array, wavenumbers: Array) -> Array:
    """Return the sines at places (...) for each wavenumber, shape (..., modes), or (..., 1) if all are equal."""
    different, number = np.unique(wavenumbers, return_inverse=True)
    sines = np.sin(places[..., None] * different)
    in_order = len(different) == 1 or (len(different) == len(number) and bool((np.diff(number) > 0).all()))
    return sines if in_order else sines[..., number]


def _bent(beam: ModalBeam, width: float) -> Panel:
    modes, count = beam.modes(), beam.harmonics[0]
    along = np.arange(1, count + 1) * np.pi / beam.length
    return Panel(
        length=beam.length,
        width=width,
        edge=-width / 2.0,
        amplitude=beam.amplitude,
        wavenumbers=np.stack([along, np.zeros(count)], axis=1),
        angular_frequency=modes.angular_frequency[:count],
        damping_rate=modes.damping_rate[:count],
        ends=(0.0, beam.length),
        place=lambda position: (position, np.zeros_like(position)),
    )


@panel_of.register
def _of_a_plate(plate: ModalPlate) -> Panel:
    modes, count = plate.modes(), plate.harmonics[0]
    return Panel(
        length=plate.length,
        width=plate.width,
        edge=0.0,
        amplitude=plate.amplitude,
        wavenumbers=plate.wavenumbers,
        angular_frequency=modes.angular_frequency[:count],
        damping_rate=modes.damping_rate[:count],
        ends=plate.ends,
        place=plate.track_line.point,
    )
