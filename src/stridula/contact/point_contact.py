"""A point of one body on the track of another."""

from __future__ import annotations

from dataclasses import dataclass

from ..bodies import BodyPoint, FiniteElementBeam, ModalBeam
from ..checks import instance, non_negative, within
from .coulomb import Coulomb


@dataclass(frozen=True)
class PointContact:
    """The tip of a slider on a track: unilateral (Signorini), with dry friction, without restitution.

    The normal force is compressive and never below zero; the tangential force is the force on the track along +x. The
    contact point moves along the track with the tip.

    Parameters
    ----------
    tip : BodyPoint
        The point of the slider that touches.
    track : ModalBeam
        The body it slides on.
    at : float
        Abscissa of the tip on the track at the start [m], strictly between its ends.
    friction : Coulomb
        Law of friction.
    gap : float, optional
        Distance between tip and track at the start [m].
    """

    tip: BodyPoint
    track: ModalBeam
    at: float
    friction: Coulomb
    gap: float = 0.0

    def __post_init__(self) -> None:
        instance("tip", self.tip, BodyPoint)
        instance("tip.body", self.tip.body, FiniteElementBeam)
        instance("track", self.track, ModalBeam)
        within("at", self.at, 0.0, self.track.length, ends=False)
        instance("friction", self.friction, Coulomb)
        non_negative("gap", self.gap)
