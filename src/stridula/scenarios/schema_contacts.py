"""The tables of contacts, laws of friction and connections in a scenario file."""

from __future__ import annotations

from dataclasses import fields
from inspect import signature
from typing import TYPE_CHECKING, Any, Literal

from ..connections import CONNECTIONS
from ..contact import (
    HEATINGS,
    LAWS,
    STIFFNESSES,
    Coulomb,
    FrictionAlongTrack,
    FrictionAroundTrack,
    FrictionField,
    FrictionOverTemperature,
    PointContact,
    Profile,
    RigidTrack,
    RunOut,
    SurfaceContact,
)
from . import fields as is_
from .derived import Keys, one_of, table_of
from .schema_drives import History
from .tables import Table, number_or


def from_file(kind: Any) -> Keys | None:
    """Return the keys with which a file has the table of a kind, if it reads any."""
    if not hasattr(kind, "read"):
        return None
    units = [name for name in signature(kind.read).parameters if name.endswith("_unit")]
    size = "size of the {} of 1 in the file in SI units, such as 1e-3; 1 if left out"
    return {
        "file": (str | None, None, "text file that has the lists, such as a CSV, found beside this file"),
        "columns": (list[int | str] | None, None, "columns of the file, by name or by number from 0"),
        **{name: (float | None, None, size.format(name.removesuffix("_unit"))) for name in units},
    }


if TYPE_CHECKING:
    Friction = Any
    Heating = Any
    Stiffness = Any
    StiffnessOfArea = Any
    Relief = Any
else:
    _repeats = {"periodic": (bool, False, "whether it repeats: the last point is then the first of the next period")}
    Relief = table_of(Profile, after=_repeats, from_file=from_file(Profile))
    _laws = [
        table_of(law, "law", law.law, "law of friction", is_usual=law is Coulomb, from_file=from_file(law))
        for law in LAWS
        if law not in (FrictionOverTemperature, FrictionAlongTrack, FrictionAroundTrack)
    ]
    _at_each = {
        FrictionOverTemperature: "law of friction at each temperature, all of one kind",
        FrictionAlongTrack: "law of friction at each place, all of one kind",
        FrictionAroundTrack: "law of friction at each angle, all of one kind",
    }
    _of_several = [
        table_of(
            law,
            "law",
            law.law,
            "law of friction",
            after={"laws": (list[one_of("law", _laws)] | None, None, words)},
            from_file=from_file(law),
        )
        for law, words in _at_each.items()
    ]
    Friction = one_of("law", [*_laws, *_of_several])
    Heating = one_of("kind", (table_of(kind, "kind", kind.kind, "layers or history") for kind in HEATINGS))
    _law = one_of("kind", (table_of(kind, "kind", kind.kind, "linear, power law or hertz") for kind in STIFFNESSES))
    Stiffness, StiffnessOfArea = number_or(is_.Stiffness, _law), number_or(is_.StiffnessOfArea, _law)
HEATS = "temperature of the contact, on which its friction may depend; none if left out"
OF_AREA = "stiffness of the contact per unit of area: a number [N/m3] or a table, rigid if left out"
YIELDS = "stiffness of the contact itself: a number [N/m] or a table, rigid if left out"


class PairContact(Table):
    at: is_.Length
    """abscissa of the tip on the track at the start [m]"""
    friction: Friction
    """friction between tip and track"""
    gap: is_.Distance = PointContact.gap
    """distance between tip and track at the start [m]"""
    stiffness: Stiffness | None = None
    """stiffness of the contact itself: a number [N/m] or a table, rigid if left out"""
    tangential_stiffness: is_.Stiffness | None = None
    """stiffness along the tangents, in series with the friction [N/m]; rigid if left out"""
    tangential_damping: is_.Viscosity = PointContact.tangential_damping
    """damping beside this stiffness [N s/m]"""
    heating: Heating | None = None
    """temperature of the contact, on which its friction may depend; none if left out"""
    profile: Relief | None = None
    """height of the track's surface over the place along it; flat if left out"""
    point: is_.Point = "tip"
    """point of the slider that touches: tip, root or a position from the tip [m]"""
    name: str = ""
    """name in records"""


class Place(Table):
    body: str
    """body: its name among the bodies"""
    point: is_.Point | None = None
    """point: tip, root, centre, the name of a point or a position [m]; its tip, centre or only point if left out"""


class BeamTrack(Table):
    kind: Literal["beam"]
    """beam, plate, rigid, point or circle"""
    body: str
    """modal beam along which it slides: its name among the bodies"""


class PlateTrack(Table):
    kind: Literal["plate"]
    """beam, plate, rigid, point or circle"""
    body: str
    """modal plate along whose line it slides: its name among the bodies"""


class PointTrack(Table):
    kind: Literal["point"]
    """beam, plate, rigid, point or circle"""
    body: str
    """body that is touched: its name among the bodies"""
    point: is_.Point | None = None
    """point of the body; its tip, centre or only point if left out"""


class CircleTrack(Table):
    kind: Literal["circle"]
    """beam, plate, rigid, point or circle"""
    body: str
    """body of revolution around whose axis it slides: its name among the bodies"""
    point: is_.Point
    """point (r, theta, z) where the abscissa is zero [m, rad, m]"""
    velocity: is_.Velocity = 0.0
    """velocity at which the sliding body is carried along the circle as a whole [m/s]"""
    history: History | None = None
    """factor on that velocity over time, constant if left out"""


class RevolvedTrack(Table):
    kind: Literal["axisymmetric"]
    """axisymmetric, solid or rigid"""
    body: str
    """body of revolution that is touched: its name among the bodies"""


class SolidTrack(Table):
    kind: Literal["solid"]
    """axisymmetric, solid or rigid"""
    body: str
    """meshed body that is touched: its name among the bodies"""
    face: str
    """name of its face"""
    turning: is_.AngularVelocity | None = None
    """angular velocity about its axis, positive counterclockwise with the axis pointing at the viewer [rad/s]"""
    axis: is_.Direction = (0.0, 0.0, 1.0)
    """world components of the axis about which it turns, of any length"""
    origin: is_.Offset = (0.0, 0.0, 0.0)
    """a point on this axis [m]"""


ENDS: Keys = {"first": (Place, ..., "one end"), "second": (Place | None, None, "other end, the ground if left out")}

if TYPE_CHECKING:
    Contact = Any
    Surface = Any
    Connection = Any
else:
    _history = "factor over time on the acceleration if one is given, else on the velocity; constant if left out"
    _moved = {
        "history": (History | None, None, _history),
        "normal_history": (History | None, None, "the same along its normal"),
        "name": (str, "", "name in records"),
    }
    _shaped = _moved | {"profile": (Relief | None, None, "height of its surface over the place; flat if left out")}
    _rigid = table_of(RigidTrack, "kind", "rigid", "beam, plate, rigid, point or circle", title="Rigid", after=_shaped)
    _sides = {
        "name": (str, "", "name in records"),
        "tip": (Place, ..., "body and point that touch"),
        "track": (
            one_of("kind", [BeamTrack, PlateTrack, _rigid, PointTrack, CircleTrack]),
            ...,
            "surface on which it slides",
        ),
    }
    _friction = {"friction": (Friction | None, None, "friction between tip and track, none if left out")}
    _friction["surface"] = (str, "", "name of the surface to which the point belongs, which may lift off in part")
    _friction["stiffness"] = (Stiffness | None, None, YIELDS)
    _friction["heating"] = (Heating | None, None, HEATS)
    _friction["profile"] = (
        Relief | None,
        None,
        "height of the surface of a body that is touched over the place along it; flat if left out",
    )
    _run_out = table_of(RunOut, from_file=from_file(RunOut))
    _plane = table_of(RigidTrack, "kind", "rigid", "axisymmetric, solid or rigid", title="Plane", after=_moved)
    _faces = {
        "name": (str, ..., "name in records, to which points add their numbers"),
        "body": (str, ..., "meshed body whose face touches: its name among the bodies"),
        "face": (str, ..., "name of the face"),
        "track": (one_of("kind", [RevolvedTrack, SolidTrack, _plane]), ..., "track on which it slides"),
    }
    _layer = {
        "friction": _friction["friction"],
        "stiffness": (StiffnessOfArea | None, None, OF_AREA),
        "heating": _friction["heating"],
        "run_out": (
            _run_out | None,
            None,
            "height of the surface of a track that turns over the angle; flat if left out",
        ),
        "friction_field": (
            table_of(FrictionField) | None,
            None,
            "random field by which the coefficients of friction vary over the face; even if left out",
        ),
        "overlay": (
            bool,
            False,
            "whether points are placed in the pieces into which flat faces of both cut each other",
        ),
    }
    Surface = table_of(SurfaceContact, title="Surface", before=_faces, after=_layer)
    Contact = table_of(PointContact, title="Contact", before=_sides, after=_friction)
    _moves = {"history": (History | None, None, "factor on the offset or the velocity over time, constant if left out")}
    _kinds = f"{', '.join(kind.kind for kind in CONNECTIONS[:-1])} or {CONNECTIONS[-1].kind}"
    _varies = {kind: any(field.name == "history" for field in fields(kind)) for kind in CONNECTIONS}
    Connection = one_of(
        "kind",
        [
            table_of(
                kind, "kind", kind.kind, _kinds, before=ENDS, after=_moves if varies else {}, from_file=from_file(kind)
            )
            for kind, varies in _varies.items()
        ],
    )
