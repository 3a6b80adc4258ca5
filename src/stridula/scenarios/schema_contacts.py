"""The tables of contacts, laws of friction and connections in a scenario file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ..contact import LinearWeakening as Linear
from ..contact import LuGre as Bristles
from ..contact import PointContact, RigidTrack
from ..contact import Stribeck as Curve
from . import fields as is_
from .fields import Table
from .schema_drives import History


class Coulomb(Table):
    law: Literal["coulomb"] = "coulomb"
    """law of friction"""
    coefficient: is_.Friction
    """coefficient of friction mu, the same in sticking and in sliding"""


class StaticKinetic(Table):
    law: Literal["static-kinetic"]
    """law of friction"""
    static: is_.Friction
    """coefficient of friction of a sticking contact"""
    kinetic: is_.Friction
    """coefficient of friction in sliding"""


class Stribeck(Table):
    law: Literal["stribeck"]
    """law of friction"""
    static: is_.Friction
    """coefficient of friction of a sticking contact"""
    kinetic: is_.Friction
    """coefficient of friction in fast sliding"""
    velocity: is_.Speed
    """slip speed over which it falls [m/s]"""
    exponent: is_.PositiveRatio = Curve.exponent
    """exponent: 2 is Gauss's curve, 1 an exponential"""
    viscous: is_.Slope = Curve.viscous
    """rise with speed [s/m]"""


class ExponentialWeakening(Table):
    law: Literal["exponential weakening"]
    """law of friction"""
    static: is_.Friction
    """coefficient of friction of a sticking contact"""
    kinetic: is_.Friction
    """coefficient of friction in fast sliding"""
    velocity: is_.Speed
    """slip speed over which it falls [m/s]"""


class LinearWeakening(Table):
    law: Literal["linear weakening"]
    """law of friction"""
    static: is_.Friction
    """coefficient of friction of a sticking contact"""
    slope: is_.Slope
    """fall with slip speed [s/m]"""
    kinetic: is_.Friction = Linear.kinetic
    """coefficient of friction at which the fall ends"""


class LuGre(Table):
    law: Literal["lugre"]
    """law of friction"""
    static: is_.Friction
    """coefficient of friction at which the bristles give way at low speed"""
    kinetic: is_.PositiveRatio
    """coefficient of friction in fast sliding"""
    velocity: is_.Speed
    """Stribeck's velocity [m/s]"""
    stiffness: is_.Bristles
    """stiffness of the bristles per unit of normal force [1/m]"""
    damping: is_.Slope = Bristles.damping
    """damping of the bristles per unit of normal force [s/m]"""
    viscous: is_.Slope = Bristles.viscous
    """rise with speed [s/m]"""
    initial_state: is_.Position = Bristles.initial_state
    """deflection of the bristles at the start [m]"""


class RateAndState(Table):
    law: Literal["rate and state"]
    """law of friction"""
    reference: is_.PositiveRatio
    """coefficient of friction in steady sliding at velocity"""
    a: is_.PositiveRatio
    """direct effect of the slip velocity"""
    b: is_.PositiveRatio
    """effect of the state"""
    slip_distance: is_.Length
    """slip over which the state changes [m]"""
    velocity: is_.Speed
    """reference slip velocity [m/s]"""
    evolution: Literal["aging", "slip"] = "aging"
    """law of evolution of the state: aging or slip"""
    initial_state: is_.Time | None = None
    """state at the start, that of steady sliding at velocity if left out [s]"""


Friction = Annotated[
    Coulomb | StaticKinetic | Stribeck | ExponentialWeakening | LinearWeakening | LuGre | RateAndState,
    Field(discriminator="law"),
]


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


class Spring(Table):
    kind: Literal["spring"]
    """spring or dashpot"""
    first: Place
    """one end"""
    second: Place | None = None
    """other end, the ground if left out"""
    stiffness: is_.Stiffness
    """stiffness [N/m]"""
    direction: Literal["x", "y"] = "x"
    """world direction along which it acts: x or y"""


class Dashpot(Table):
    kind: Literal["dashpot"]
    """spring or dashpot"""
    first: Place
    """one end"""
    second: Place | None = None
    """other end, the ground if left out"""
    coefficient: is_.Viscosity
    """force per unit of relative velocity [N s/m]"""
    direction: Literal["x", "y"] = "x"
    """world direction along which it acts: x or y"""


Connection = Annotated[Spring | Dashpot, Field(discriminator="kind")]
