"""Contacts as rows on the modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..contact import LAWS, PointContact, Profile
from ..contact.stiffness import ContactStiffness, force_at, slopes_at
from .coordinates import Coordinates
from .turning_modes import TurningModes

# Laws with an internal state, which cannot be transferred to another law.
STATEFUL = tuple(law.law for law in LAWS if law.state_units)

# Sum of the terms of a row, relative to their size, that is due to rounding.
ROUND_OFF = 16.0 * np.finfo(float).eps


@dataclass(frozen=True)
class ContactRows:
    """One contact as rows on the modes: that of its normal, then one for each tangent.

    Attributes
    ----------
    contact : PointContact
        The contact.
    fixed : ndarray, shape (1 + tangents, modes)
        Displacement of the tip, minus that of a touched point, along normal and tangents.
    bending, axial : tuple of int
        Ranges of the modes of each kind of a track along which the tip moves.
    circle : TurningModes or None
        Modes of the body round which the tip moves; its rows in `fixed` are those at the start.
    """

    contact: PointContact
    fixed: Array
    bending: tuple[int, int] = (0, 0)
    axial: tuple[int, int] = (0, 0)
    circle: TurningModes | None = None

    @property
    def travel(self) -> Array:
        """Rows of the travel of the contact point, shape (tangents, modes); on a circle, of the tip alone."""
        rows = self.fixed[1:]
        if self.circle is not None:
            rows = rows.copy()
            rows[:, slice(*self.circle.span)] = 0.0
        return rows

    def force_at(self, indentation: float, velocity: float) -> float:
        """Return the normal force [N] of a compliant contact at an indentation [m] that grows with a velocity [m/s]."""
        assert self.yields is not None
        return force_at(self.yields, indentation, velocity)

    def stiffness_at(self, indentation: float) -> float:
        """Return the derivative of its elastic force by the indentation [N/m]."""
        assert self.yields is not None
        return slopes_at(self.yields, force_at(self.yields, indentation))[0]

    def round_at(self, place: float) -> Array:
        """Return the rows with the tip at an abscissa [m] of its circle."""
        assert self.circle is not None
        angle = (place - self.contact.at) * self.rate
        return self.fixed + [self.circle.turned(row, angle * self.circle.orders) for row in self.fixed]

    def slopes_round_at(self, place: float) -> Array:
        """Return the derivatives of these rows along the circle [1/m], shape (1 + tangents, modes)."""
        assert self.circle is not None
        rows, (first, second) = self.round_at(place), self.circle.pairs.T
        slopes = np.zeros_like(rows)
        slopes[:, first] = -self.rate * self.circle.orders * rows[:, second]
        slopes[:, second] = self.rate * self.circle.orders * rows[:, first]
        return slopes

    @property
    def rate(self) -> float:
        """Angle about the axis per distance along the circle [rad/m]."""
        assert self.contact.circle is not None
        return 1.0 / self.contact.circle.radius

    @property
    def at(self) -> float:
        """Abscissa along the first tangent at the start [m]."""
        return self.contact.at

    def rows_at(self, place: float) -> Array:
        """Return the rows along normal and tangents with the tip at an abscissa [m] of its track."""
        if self.circle is not None:
            return self.round_at(place)
        track = self.contact.path_body
        if track is None:
            return self.fixed
        full, (low, high) = self.fixed.copy(), track.ends
        full[:2, self.bending[0] : self.axial[1]] -= (track.axes @ track.trace(min(max(place, low), high)))[::-1]
        return full

    @property
    def yields(self) -> ContactStiffness | None:
        """Stiffness of the contact along the normal, None if it is rigid."""
        return self.contact.yields

    @property
    def profile(self) -> Profile | None:
        """Shape of the surface of its track, None if it is flat."""
        return self.contact.relief

    def height_at(self, place: float) -> float:
        """Return the height of the surface of its track at a place along its material [m]."""
        return 0.0 if self.profile is None else float(self.profile.height_at(place))

    def slope_at(self, place: float) -> float:
        """Return the slope of the surface of its track at a place along its material [1]."""
        return 0.0 if self.profile is None else float(self.profile.slope_at(place))

    def gap_at(self, position: Array) -> float:
        """Return the gap at the start [m], at modal positions and over the profile of its track."""
        rows = self.rows_at(self.at)
        return float(self.height + rows[0] @ position) - self.height_at(float(self.at + rows[1] @ position))

    @property
    def height(self) -> float:
        """Height of the tip over the plane of its track at the start, without displacements [m]."""
        return self.gap + self.height_at(self.at)

    @property
    def gap(self) -> float:
        """Gap at the start [m]."""
        return self.contact.gap


def contact_rows(contact: PointContact, coordinates: Coordinates, turning: tuple[TurningModes, ...]) -> ContactRows:
    frame = contact.frame
    traces = coordinates.trace(contact.tip)[: len(frame)]
    fixed, terms = frame @ traces, np.abs(frame) @ np.abs(traces)
    if contact.touched_point is not None:
        traces = coordinates.trace(contact.touched_point)[: len(frame)]
        fixed, terms = fixed - frame @ traces, terms + np.abs(frame) @ np.abs(traces)
    # A tip that cannot move along a tangent has no compliance there, and not that of round-off, which forces could use.
    fixed[np.abs(fixed) <= ROUND_OFF * terms] = 0.0
    if contact.law.depends_on_speed:
        # Without mass nothing balances friction that falls with the slip speed.
        fixed[1:, coordinates.massless] = 0.0
    circle = None
    if contact.circle is not None:
        span = coordinates.spans[contact.track_body]
        circle = next(one for one in turning if one.span == span)
    return ContactRows(contact, fixed, *_path_spans(contact, coordinates), circle=circle)


def _path_spans(contact: PointContact, coordinates: Coordinates) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return the ranges of modes that move a path along its normal and along its tangent, empty without a path."""
    if contact.path_body is None:
        return (0, 0), (0, 0)
    first, end = coordinates.spans[contact.path_body]
    axial = first + len(contact.path_body.path().normal.multiples)
    return (first, axial), (axial, end)
