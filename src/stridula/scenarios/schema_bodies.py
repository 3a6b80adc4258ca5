"""The tables of bodies in a scenario file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from .. import bodies
from ..bodies import FiniteElementBeam, ModalBeam, ModalPlate
from ..bodies import Line as Straight
from ..bodies.sections import SECTIONS
from . import fields as is_
from .derived import one_of, table_of
from .fields import Table

Support = Literal["free", "guided", "pinned", "clamped"]


if TYPE_CHECKING:
    Material = Any
    Section = Any
else:
    Material = table_of(bodies.Material)
    Section = one_of(
        "shape", [table_of(section, "shape", section.shape, "rectangle, circle or general") for section in SECTIONS]
    )


class Slider(Table):
    material: Material
    """what the slider is made of"""
    section: Section
    """cross-section of the slider"""
    length: is_.Length
    """length, from tip to root [m]"""
    angle: is_.Angle = FiniteElementBeam.angle
    """angle from the track's normal; above zero the root is ahead of the tip in x [rad]"""
    elements: is_.Count = FiniteElementBeam.elements
    """number of finite elements"""
    damping: is_.ModalDamping = FiniteElementBeam.damping
    """damping ratio of every mode, one for each, or a law of frequency"""
    root_support: Support = "guided"
    """support of the root: free, guided (no rotation), pinned or clamped"""
    tip_support: Support = "free"
    """support of the tip: free, guided, pinned or clamped"""
    mass: Literal["consistent", "lumped"] = "consistent"
    """mass matrix of the elements: consistent or lumped"""
    cutoff: is_.Frequency | None = None
    """keep the modes up to this frequency, all if left out [Hz]"""
    name: str = ""
    """what it is called in records"""


class Track(Table):
    material: Material
    """what the track is made of"""
    section: Section
    """cross-section of the track"""
    length: is_.Length
    """length [m]"""
    bending_modes: is_.Count = ModalBeam.bending_modes
    """number of bending modes, unless there is a cutoff"""
    axial_modes: is_.CountOrNone = ModalBeam.axial_modes
    """number of axial modes, unless there is a cutoff"""
    damping: is_.ModalDamping = ModalBeam.damping
    """damping ratio of every mode, one for each, or a law of frequency"""
    cutoff: is_.Frequency | None = None
    """keep the modes up to this frequency [Hz]"""
    name: str = ""
    """what it is called in records"""


class FiniteElementBody(Slider):
    kind: Literal["finite-element beam"]
    """finite-element beam, modal beam, modal plate, point mass or reduced"""


class ModalBody(Track):
    kind: Literal["modal beam"]
    """finite-element beam, modal beam, modal plate, point mass or reduced"""


class Line(Table):
    origin: is_.Spot
    """point of abscissa 0: distances along length and width from the corner [m]"""
    direction: is_.Angle = Straight.direction
    """angle from the plate's length to the line, towards its width [rad]"""


class Plate(Table):
    kind: Literal["modal plate"]
    """finite-element beam, modal beam, modal plate, point mass or reduced"""
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
    name: str = ""
    """what it is called in records, the table's own name if left out"""


class PointMass(Table):
    kind: Literal["point mass"]
    """finite-element beam, modal beam, modal plate, point mass or reduced"""
    mass: is_.Mass
    """mass [kg]"""
    name: str = ""
    """what it is called in records, the table's own name if left out"""


class Reduced(Table):
    kind: Literal["reduced"]
    """finite-element beam, modal beam, modal plate, point mass or reduced"""
    file: str | None = None
    """.npz or .mat file with matrices and points, beside the scenario"""
    mass: is_.Matrix | None = None
    """mass matrix: rows, or its file [SI]"""
    stiffness: is_.Matrix | None = None
    """stiffness matrix: rows, or its file [SI]"""
    points: is_.PointTable | None = None
    """points by name: rows, or the degrees of freedom along x and y"""
    damping: is_.ReducedDamping | None = None
    """damping: a ratio, one for each mode, a law of frequency, a matrix, or its file"""
    translation: is_.Translation | None = None
    """rows that say how a translation along x and y moves it; gravity and initial velocities need it"""
    cutoff: is_.Frequency | None = None
    """keep the modes up to this frequency, all if left out [Hz]"""
    name: str = ""
    """what it is called in records, the table's own name if left out"""


Body = Annotated[FiniteElementBody | ModalBody | Plate | PointMass | Reduced, Field(discriminator="kind")]
