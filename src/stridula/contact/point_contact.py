"""A point of one body on the track of another, on a rigid track or against a point of another body."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint, Track
from ..checks import ArgumentError, brief, instance, within
from ..declared import Angle, Distance, Position, check_declared
from .coulomb import Coulomb
from .friction_law import FrictionLaw
from .laws import LAWS
from .rigid_track import RigidTrack

# Sine or cosine that rounding leaves of a right angle.
ALONG_AN_AXIS = 1e-15


@dataclass(frozen=True)
class PointContact:
    """The tip of a slider on a track: unilateral (Signorini), with dry friction, without restitution.

    The normal force is compressive and never below zero; the tangential force is the force on the track along its
    tangent. On a beam, a plate or a rigid track the contact point moves along the track with the tip; against a
    point of another body it is frozen.

    Parameters
    ----------
    tip : BodyPoint
        The point of the slider that touches.
    track : ModalBeam, ModalPlate, RigidTrack or BodyPoint
        What it slides on: a beam, a plate along its line, a rigid track, or a point of another body.
    at : float, optional
        Abscissa of the tip on the track at the start [m]; strictly between the ends of a beam or of a plate's line.
    friction : Coulomb, StaticKinetic, Stribeck, ExponentialWeakening, LinearWeakening, LuGre or RateAndState, optional
        Law of friction; none if left out.
    gap : float, optional
        Distance between tip and track at the start [m].
    inclination : float, optional
        Angle from world x to the track's tangent, counter-clockwise [rad]; the normal, from the track to the tip, is
        the tangent turned by 90 degrees counter-clockwise. Zero on a beam or a plate.
    name : str, optional
        What it is called in records.
    """

    tip: BodyPoint
    track: Track | RigidTrack | BodyPoint
    at: Position = 0.0
    friction: FrictionLaw = field(default_factory=lambda: Coulomb(0.0))
    gap: Distance = 0.0
    inclination: Angle = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        instance("tip", self.tip, BodyPoint)
        instance("track", self.track, (*Track.__args__, RigidTrack, BodyPoint))
        if self.path_body is not None:
            within("at", self.at, *self.path_body.ends, ends=False)
            if self.inclination != 0.0:
                raise ArgumentError("inclination", f"be 0 on a {type(self.track).__name__}", self.inclination)
        check_declared(self)
        if self.track_body == self.tip.body:
            body = brief(self.tip.body)
            raise ArgumentError(
                "track", "be another body than the tip's (equal ones need names)", self.track, got=f"{body} for both"
            )
        instance("friction", self.friction, LAWS)
        if abs(self.inclination) > 2.0 * math.pi:
            raise ArgumentError("inclination", "be from -2 pi to 2 pi rad", self.inclination)
        instance("name", self.name, str)

    @property
    def rigid_track(self) -> RigidTrack | None:
        """The track if it is rigid."""
        return self.track if isinstance(self.track, RigidTrack) else None

    @property
    def touched_point(self) -> BodyPoint | None:
        """The point that the tip touches, None where it moves along a track."""
        return self.track if isinstance(self.track, BodyPoint) else None

    @property
    def path_body(self) -> Track | None:
        """The body that the tip moves along, None on a rigid track and against a point."""
        return self.track if isinstance(self.track, Track) else None

    @property
    def track_body(self) -> object | None:
        """The body on the track's side, None for a rigid track."""
        return self.path_body or (self.touched_point and self.touched_point.body)

    @property
    def frame(self) -> Array:
        """Unit vectors of the track's normal and tangent in the world frame, shape (2, 2)."""
        sine, cosine = math.sin(self.inclination), math.cos(self.inclination)
        axes = np.array([[-sine, cosine], [cosine, sine]])
        # Exact zeros where the track lies along an axis.
        return np.where(np.abs(axes) < ALONG_AN_AXIS, 0.0, axes)
