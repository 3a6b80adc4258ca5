"""The tables of bodies in a scenario file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from .. import bodies
from ..bodies import Line as Straight
from ..bodies import ModalPlate
from ..bodies.sections import SECTIONS
from . import fields as is_
from .derived import Keys, one_of, table_of
from .fields import Table
from .schema_drives import History
from .schema_meshed import meshed_tables

KINDS = "finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"
OWN_NAME = "what it is called in records, the table's own name if left out"

if TYPE_CHECKING:
    Material = Any
    Section = Any
    Slider = Any
    Track = Any
else:
    Material = table_of(bodies.Material)
    Section = one_of(
        "shape", [table_of(section, "shape", section.shape, "rectangle, circle or general") for section in SECTIONS]
    )

    def _made(what: str) -> Keys:
        return {
            "material": (Material, ..., f"what {what} is made of"),
            "section": (Section, ..., f"cross-section of {what}"),
        }

    Slider = table_of(bodies.FiniteElementBeam, title="Slider", before=_made("the slider"))
    Track = table_of(bodies.ModalBeam, title="Track", before=_made("the track"))


class Line(Table):
    origin: is_.Spot
    """point of abscissa 0: distances along length and width from the corner [m]"""
    direction: is_.Angle = Straight.direction
    """angle from the plate's length to the line, towards its width [rad]"""


class Plate(Table):
    kind: Literal["modal plate"]
    """finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"""
    material: Material
    """what the plate is made of"""
    thickness: is_.Length
    """thickness [m]"""
    length: is_.Length
    """one side [m]"""
    width: is_.Length
    """other side [m]"""
    bending_modes: is_.Counts = ModalPlate.bending_modes
    """numbers of half-waves along length and width of modes that bend, unless there is a cutoff"""
    in_plane: bool = ModalPlate.in_plane
    """whether it moves in its plane, too; else it is rigid there"""
    in_plane_modes: is_.CountsOrNone = ModalPlate.in_plane_modes
    """most half-waves along length and width of modes in its plane, counted from 0, unless there is a cutoff"""
    damping: is_.ModalDamping = ModalPlate.damping
    """damping ratio of every mode, one for each, or a law of frequency"""
    cutoff: is_.Frequency | None = None
    """keep the modes up to this frequency [Hz]"""
    line: Line | None = None
    """where bodies slide on it, along its length in the middle of its width if left out"""
    plane: is_.Rows | None = None
    """unit vectors along its line and along its normal, [[x, y, z], [x, y, z]], of a plate in space"""
    name: str = ""
    """what it is called in records, the table's own name if left out"""


class Reduced(Table):
    kind: Literal["reduced"]
    """finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"""
    file: str | None = None
    """.npz or .mat file with matrices and points, or a file of Nastran or CalculiX, beside the scenario"""
    mass: is_.Matrix | None = None
    """mass matrix: rows, or its file [SI]"""
    stiffness: is_.Matrix | None = None
    """stiffness matrix: rows, or its file [SI]"""
    points: is_.PointTable | None = None
    """points by name: rows, the degrees of freedom along x and y, or a node"""
    damping: is_.ReducedDamping | None = None
    """damping: a ratio, one for each mode, a law of frequency, a matrix, or its file"""
    translation: is_.Translation | None = None
    """rows that say how a translation along x, y and z moves it; gravity and initial velocities need it"""
    cutoff: is_.Frequency | None = None
    """keep the modes up to this frequency, all if left out [Hz]"""
    residual_flexibility: bool | None = None
    """whether modes beyond the cutoff yield statically at the points, true if left out"""
    labels: str | None = None
    """file that says which node and degree of freedom each row is, searched beside the matrices if left out"""
    mesh: str | None = None
    """deck that says where nodes are, for points by place"""
    name: str = ""
    """what it is called in records, the table's own name if left out"""


class Rigid(Table):
    kind: Literal["rigid body"]
    """finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"""
    mass: is_.Mass
    """mass [kg]"""
    inertia: is_.Inertia | None = None
    """moments of inertia about x, y and z: one, three or a matrix; without any it does not turn [kg m2]"""
    points: is_.PlaceTable | None = None
    """places of points from the centre along x, y and z by name [m]"""
    name: str = ""
    """what it is called in records, the table's own name if left out"""


class Turning(Table):
    velocity: is_.AngularVelocity
    """angular velocity about the axis [rad/s]"""
    pairs: is_.Rows
    """numbers of the two modes of each pair"""
    order: is_.Vector
    """number of waves round the axis of each pair"""
    drag: is_.Vector
    """phase by which the waves of each pair turn for one radian of the body"""
    history: History | None = None
    """factor on the velocity over time, constant if left out"""


class OuterSurface(Table):
    normals: is_.Rows
    """outward unit normals, along x, y and z, of rings along r and z"""
    shapes: is_.Rows
    """by how much each mode moves each point or ring outwards"""
    points: is_.Rows | None = None
    """places of points [m]"""
    areas: is_.Vector | None = None
    """areas that points stand for [m²]"""
    corners: is_.Rows | None = None
    """x, y and z of the four corners of each piece of the patches round points [m], squares if left out"""
    owners: is_.Vector | None = None
    """number of the point in whose patch a piece lies, from 0, that of the piece if left out"""
    places: is_.Rows | None = None
    """r and z of rings, two over each part of the profile [m]"""
    widths: is_.Vector | None = None
    """widths that rings stand for [m]"""
    orders: is_.Vector | None = None
    """number of waves round the axis of each mode, of rings"""
    sides: is_.Vector | None = None
    """0 for modes that go round as the cosine, 1 for those as the sine, of rings"""
    frame: is_.Rows | None = None
    """directions theta = 0 and theta = 90 degrees and of the axis, of rings"""
    origin: is_.Vector | None = None
    """point on the axis where z is 0, of rings [m]"""


class Drawn(Table):
    place: is_.Rows
    """places of the corners of polygons [m], or r and z of the corners of an outline"""
    shapes: is_.Rows
    """by how much each mode moves the corners: three rows for each, along x, y, z or r, theta, z"""
    polygons: is_.Rows | None = None
    """corners of each polygon, round its outward normal"""
    sides: is_.Rows | None = None
    """corners of the sides of an outline"""
    orders: is_.Vector | None = None
    """number of waves round the axis of each mode, of an outline"""
    phases: is_.Vector | None = None
    """0 for modes that go round as the cosine, 1 for those as the sine, of an outline"""
    frame: is_.Rows | None = None
    """directions theta = 0 and theta = 90 degrees and of the axis, of an outline"""
    origin: is_.Vector | None = None
    """point on the axis where z is 0, of an outline [m]"""


class Modal(Table):
    kind: Literal["modal body"]
    """finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"""
    angular_frequency: is_.Vector
    """angular frequencies of the modes [rad/s], none where there are residual shapes alone"""
    points: is_.PointTable
    """points by name: rows, what each mode moves them by along x, y and z"""
    damping_rate: is_.Inertia = 0.0
    """twice the damping ratio times the angular frequency, one for each mode [1/s]"""
    translation: is_.Translation | None = None
    """rows that say how an acceleration along x, y and z drives each mode; gravity and initial velocities need it"""
    residual: int = 0
    """number of residual shapes, the last columns of the rows"""
    turning: Turning | None = None
    """how the modes are carried round by a body that turns"""
    velocities: is_.PlaceTable | None = None
    """velocities of the material of a body that turns along x, y and z, by the name of the point [m/s]"""
    outer_surface: OuterSurface | None = None
    """outer surface and how the modes move it, which a body needs to be heard"""
    circles: is_.PlaceTable | None = None
    """circles that others may move round, by the name of a point: radius and its abscissa [m], direction there"""
    drawn: Drawn | None = None
    """surface as it is drawn in films, and how modes move it"""
    places: is_.PlaceTable | None = None
    """where points are at rest along x, y and z, by name, for films [m]"""
    name: str = ""
    """what it is called in records, the table's own name if left out"""


if TYPE_CHECKING:
    Body = Any
else:
    _named = {"name": (str, "", OWN_NAME)}
    _words = {"before": _made("the beam"), "after": _named}
    _beam = table_of(
        bodies.FiniteElementBeam, "kind", "finite-element beam", KINDS, title="FiniteElementBody", **_words
    )
    _exact = table_of(bodies.ModalBeam, "kind", "modal beam", KINDS, title="ModalBody", **_words)
    _mass = table_of(bodies.PointMass, "kind", "point mass", KINDS, after=_named)
    Body = one_of("kind", [_beam, _exact, Plate, _mass, Reduced, Rigid, Modal, *meshed_tables(KINDS, Material, _named)])
