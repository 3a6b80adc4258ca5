"""The tables of contacts, laws of friction and connections in a scenario file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from ..connections import CONNECTIONS
from ..contact import LAWS, Coulomb, PointContact, RigidTrack
from . import fields as is_
from .derived import Keys, one_of, table_of
from .fields import Table
from .schema_drives import History

if TYPE_CHECKING:
    Friction = Any
else:
    Friction = one_of(
        "law", (table_of(law, "law", law.law, "law of friction", is_usual=law is Coulomb) for law in LAWS)
    )


class PairContact(Table):
    at: is_.Length
    """abscissa of the tip on the track at the start [m]"""
    friction: Friction
    """friction between tip and track"""
    gap: is_.Distance = PointContact.gap
    """distance between tip and track at the start [m]"""
    point: is_.Point = "tip"
    """point of the slider that touches: tip, root or a position from the tip [m]"""
    name: str = ""
    """what it is called in records"""


class Place(Table):
    body: str
    """body: its name among the bodies"""
    point: is_.Point | None = None
    """where: tip, root, centre, the name of a point or a position [m]; its tip, centre or only point if left out"""


class BeamTrack(Table):
    kind: Literal["beam"]
    """beam, plate, rigid or point"""
    body: str
    """modal beam along which it slides: its name among the bodies"""


class PlateTrack(Table):
    kind: Literal["plate"]
    """beam, plate, rigid or point"""
    body: str
    """modal plate along whose line it slides: its name among the bodies"""


class Rigid(Table):
    kind: Literal["rigid"]
    """beam, plate, rigid or point"""
    velocity: is_.Velocity = RigidTrack.velocity
    """velocity along its tangent, as of a belt [m/s]; where an acceleration is given, at the start"""
    normal_velocity: is_.Velocity = RigidTrack.normal_velocity
    """velocity along its normal, towards the tip [m/s]; where an acceleration is given, at the start"""
    acceleration: is_.AnyAcceleration = RigidTrack.acceleration
    """acceleration along its tangent [m/s²]"""
    normal_acceleration: is_.AnyAcceleration = RigidTrack.normal_acceleration
    """acceleration along its normal, towards the tip, as of shaken ground [m/s²]"""
    history: History | None = None
    """factor over time on the acceleration where one is given, else on the velocity; constant if left out"""
    normal_history: History | None = None
    """the same along its normal"""
    name: str = ""
    """what it is called in records"""


class PointTrack(Table):
    kind: Literal["point"]
    """beam, plate, rigid or point"""
    body: str
    """body that is touched: its name among the bodies"""
    point: is_.Point | None = None
    """which point of it; its tip, centre or only point if left out"""


class Contact(Table):
    name: str = ""
    """what it is called in records"""
    tip: Place
    """what touches"""
    track: Annotated[BeamTrack | PlateTrack | Rigid | PointTrack, Field(discriminator="kind")]
    """what it slides on"""
    at: is_.Position = PointContact.at
    """abscissa of the tip on the track at the start [m]"""
    gap: is_.Distance = PointContact.gap
    """distance between tip and track at the start [m]"""
    inclination: is_.Angle = PointContact.inclination
    """angle from world x to the track's tangent, counter-clockwise [rad]"""
    friction: Friction | None = None
    """friction between tip and track, none if left out"""


ENDS: Keys = {"first": (Place, ..., "one end"), "second": (Place | None, None, "other end, the ground if left out")}

if TYPE_CHECKING:
    Connection = Any
else:
    Connection = one_of(
        "kind", [table_of(kind, "kind", kind.kind, "spring or dashpot", before=ENDS) for kind in CONNECTIONS]
    )
