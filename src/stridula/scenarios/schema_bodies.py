"""The tables of bodies in a scenario file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from .. import bodies
from ..bodies import Line as Straight
from ..bodies import ModalPlate
from ..bodies.sections import SECTIONS
from . import fields as is_
from .derived import Keys, one_of, table_of
from .schema_drives import History
from .schema_meshed import meshed_tables
from .tables import Table

KINDS = "finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"
OWN_NAME = "name in records, the name of the table if left out"

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
            "material": (Material, ..., f"material of {what}"),
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
    """material of the plate"""
    thickness: is_.Length
    """thickness [m]"""
    length: is_.Length
    """one side [m]"""
    width: is_.Length
    """other side [m]"""
    bending_modes: is_.Counts = ModalPlate.bending_modes
    """numbers of half-waves along length and width of bending modes, unless there is a cutoff"""
    in_plane: bool = ModalPlate.in_plane
    """whether it also deforms in its plane; otherwise it is rigid there"""
    in_plane_modes: is_.CountsOrNone = ModalPlate.in_plane_modes
    """largest numbers of half-waves along length and width of in-plane modes, from 0, unless there is a cutoff"""
    damping: is_.ModalDamping = ModalPlate.damping
    """damping ratio of every mode, one for each, or a law of frequency"""
    cutoff: is_.Frequency | None = None
    """highest frequency of the modes [Hz]"""
    line: Line | None = None
    """line on which bodies slide, along its length in the middle of its width if left out"""
    plane: is_.Rows | None = None
    """unit vectors along its line and along its normal, [[x, y, z], [x, y, z]], of a plate in space"""
    name: str = ""
    """name in records, the name of the table if left out"""


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
    """degrees of freedom in a translation along x, y and z, a row each; gravity and initial velocities need it"""
    cutoff: is_.Frequency | None = None
    """highest frequency of the modes, all if left out [Hz]"""
    residual_flexibility: bool | None = None
    """whether modes beyond the cutoff add static flexibility at the points, true if left out"""
    labels: str | None = None
    """file with the node and degree of freedom of each row, searched beside the matrices if left out"""
    mesh: str | None = None
    """input deck with the places of nodes, for points given by place"""
    name: str = ""
    """name in records, the name of the table if left out"""


class Rigid(Table):
    kind: Literal["rigid body"]
    """finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"""
    mass: is_.Mass
    """mass [kg]"""
    inertia: is_.Inertia | None = None
    """moments of inertia about x, y and z: one, three or a matrix; without them it does not rotate [kg m2]"""
    points: is_.PlaceTable | None = None
    """positions of points relative to the centre along x, y and z, by name [m]"""
    name: str = ""
    """name in records, the name of the table if left out"""


class Turning(Table):
    velocity: is_.AngularVelocity
    """angular velocity about the axis [rad/s]"""
    pairs: is_.Rows
    """numbers of the two modes of each pair"""
    order: is_.Vector
    """number of waves around the axis of each pair"""
    drag: is_.Vector
    """phase by which the waves of each pair turn per radian of the body"""
    history: History | None = None
    """factor on the velocity over time, constant if left out"""


class OuterSurface(Table):
    normals: is_.Rows
    """outward unit normals, along x, y and z; of rings along r and z"""
    shapes: is_.Rows
    """outward displacement of each point or ring in each mode"""
    points: is_.Rows | None = None
    """places of points [m]"""
    areas: is_.Vector | None = None
    """areas represented by the points [m²]"""
    corners: is_.Rows | None = None
    """x, y and z of the four corners of each piece of the patches around points [m], squares if left out"""
    owners: is_.Vector | None = None
    """number, from 0, of the point whose patch contains each piece, that of the piece if left out"""
    places: is_.Rows | None = None
    """r and z of rings, two over each part of the profile [m]"""
    widths: is_.Vector | None = None
    """widths represented by the rings [m]"""
    orders: is_.Vector | None = None
    """number of waves around the axis of each mode, for rings"""
    sides: is_.Vector | None = None
    """0 for modes that vary as the cosine around the axis, 1 as the sine, for rings"""
    frame: is_.Rows | None = None
    """directions of theta = 0, theta = 90 degrees and the axis, for rings"""
    origin: is_.Vector | None = None
    """point on the axis where z is 0, for rings [m]"""


class Drawn(Table):
    place: is_.Rows
    """places of the corners of polygons [m], or r and z of the corners of an outline"""
    shapes: is_.Rows
    """displacements of the corners in each mode: three rows for each, along x, y, z or r, theta, z"""
    polygons: is_.Rows | None = None
    """corners of each polygon, counterclockwise around its outward normal"""
    sides: is_.Rows | None = None
    """corners of the sides of an outline"""
    orders: is_.Vector | None = None
    """number of waves around the axis of each mode, for an outline"""
    phases: is_.Vector | None = None
    """0 for modes that vary as the cosine around the axis, 1 as the sine, for an outline"""
    frame: is_.Rows | None = None
    """directions of theta = 0, theta = 90 degrees and the axis, for an outline"""
    origin: is_.Vector | None = None
    """point on the axis where z is 0, for an outline [m]"""


class Modal(Table):
    kind: Literal["modal body"]
    """finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, modal body, axisymmetric, solid"""
    angular_frequency: is_.Vector
    """angular frequencies of the modes [rad/s], none if there are only residual shapes"""
    points: is_.PointTable
    """points by name: rows of their displacements along x, y and z in each mode"""
    damping_rate: is_.Inertia = 0.0
    """twice the damping ratio times the angular frequency, one for each mode [1/s]"""
    translation: is_.Translation | None = None
    """force on each mode from an acceleration along x, y and z, a row each; gravity and initial velocities need it"""
    residual: is_.CountFrom0 = 0
    """number of residual shapes, the last columns of the rows"""
    turning: Turning | None = None
    """transport of the modes by a turning body"""
    velocities: is_.VectorTable | None = None
    """velocities of the material of a turning body along x, y and z, by name of the point [m/s]"""
    outer_surface: OuterSurface | None = None
    """outer surface and its motion in the modes, needed for sound"""
    circles: is_.VectorTable | None = None
    """circles along which others may slide, by name of a point: radius and its abscissa [m], direction there"""
    drawn: Drawn | None = None
    """surface drawn in films, and its motion in the modes"""
    places: is_.PlaceTable | None = None
    """positions of points at rest along x, y and z, by name, for films [m]"""
    name: str = ""
    """name in records, the name of the table if left out"""


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
