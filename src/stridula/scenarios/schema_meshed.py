"""The tables of bodies of revolution and of bodies meshed in space, in a scenario file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from .. import bodies
from ..bodies.profile_mesh import BODY
from ..bodies.solid_kinds import KINDS
from . import fields as is_
from .derived import Keys, one_of, table_of
from .fields import Table
from .schema_drives import History


class Sides(Table):
    inner: is_.Distance
    """least distance from the axis [m]"""
    outer: is_.Length
    """largest distance from the axis [m]"""
    bottom: is_.Position
    """least place along the axis [m]"""
    top: is_.Position
    """largest place along the axis [m]"""


if TYPE_CHECKING:
    PlaceOrBox = Any
    Element = Any
else:
    PlaceOrBox = is_.text_or(Sides)
    Element = Literal[tuple(KINDS)]


class Held(Table):
    place: PlaceOrBox
    """name of a place, such as inner, top or hat.outer, or a box"""
    directions: is_.Directions = bodies.axisymmetric_body.DIRECTIONS
    """those in which it is held, of r, theta and z; all if left out"""


class RectangleProfile(Sides):
    shape: Literal["rectangle"]
    """rectangle, rectangles, line, mesh or cells"""
    size: is_.Length | None = None
    """largest side of a cell, as the shortest waves need it if left out [m]"""


class Part(Sides):
    region: str = BODY
    """its region; several rectangles may be of one"""


class RectanglesProfile(Table):
    shape: Literal["rectangles"]
    """rectangle, rectangles, line, mesh or cells"""
    rectangles: list[Part]
    """rectangles that share sides"""
    size: is_.Length | None = None
    """largest side of a cell, as the shortest waves need it if left out [m]"""


class LineProfile(Table):
    shape: Literal["line"]
    """rectangle, rectangles, line, mesh or cells"""
    points: list[is_.OfProfile]
    """points (r, z) of its middle line [m]"""
    thickness: is_.LengthOrEach
    """thickness, or that at each point [m]"""
    size: is_.Length | None = None
    """largest side of a cell along the line, as the shortest waves need it if left out [m]"""


class MeshProfile(Table):
    shape: Literal["mesh"]
    """rectangle, rectangles, line, mesh or cells"""
    file: str
    """file of a mesh, beside the scenario"""
    scale: is_.Length = 1.0
    """length of the file's unit [m]"""
    plane: Literal["xy", "xz", "yz"] = "xy"
    """coordinates of the file that are r and z"""


class CellsProfile(Table):
    shape: Literal["cells"]
    """rectangle, rectangles, line, mesh or cells"""
    nodes: is_.Rows
    """distance from the axis and place along it of each node [m]"""
    cells: is_.Rows
    """nodes of each triangle or quadrilateral, from 0 on"""
    regions: dict[str, is_.Vector] | None = None
    """cells of each region by its name"""
    edges: dict[str, is_.Rows] | None = None
    """pairs of nodes of edges that can be held by their names"""


class Placed(Table):
    rotation: is_.Rotation | None = None
    """axis of a turn about the origin times its angle, along x, y and z [rad]"""
    offset: is_.Offset | None = None
    """shift along x, y and z, after the turn [m]"""


class BlockMesh(Placed):
    shape: Literal["block"]
    """block, sector, extrusion, file or elements"""
    lengths: is_.Lengths
    """sides along x, y and z from the origin [m]"""
    divisions: is_.Divisions
    """numbers of elements along x, y and z"""


class SectorMesh(Placed):
    shape: Literal["sector"]
    """block, sector, extrusion, file or elements"""
    radii: is_.Radii
    """inner and outer radius [m]"""
    angles: is_.Angles
    """angles of start and end, from z where the axis is y [rad]"""
    height: is_.LengthOrLayers
    """length along the axis, or that of each layer by its name from the bottom up [m]"""
    divisions: is_.Divisions
    """numbers of elements along radius, angle and axis, there through each layer"""
    axis: Literal["x", "y", "z"] = "y"
    """x, y or z"""


class ExtrusionMesh(Placed):
    shape: Literal["extrusion"]
    """block, sector, extrusion, file or elements"""
    nodes: is_.Rows
    """coordinates of each node in the plane [m]"""
    quadrilaterals: is_.Rows
    """corners of each quadrilateral, counterclockwise, from 0 on"""
    height: is_.LengthOrLayers
    """length along the axis, or that of each layer by its name from the bottom up [m]"""
    layers: is_.Count
    """number of elements along the axis, through each such layer"""
    axis: Literal["x", "y", "z"] = "z"
    """x, y or z"""


class FileMesh(Placed):
    shape: Literal["file"]
    """block, sector, extrusion, file or elements"""
    file: str
    """file of a mesh, beside the scenario"""
    scale: is_.Length = 1.0
    """length of the file's unit [m]"""


class ElementsMesh(Placed):
    shape: Literal["elements"]
    """block, sector, extrusion, file or elements"""
    kind: Element
    """tetra, tetra10, hexahedron, hexahedron20 or hexahedron27"""
    nodes: is_.Rows
    """coordinates of each node [m]"""
    elements: is_.Rows
    """nodes of each element, from 0 on, in the order of VTK"""
    volumes: dict[str, is_.Vector] | None = None
    """elements of each group by its name"""
    faces: dict[str, is_.Rows] | None = None
    """pairs of an element and one of its faces by the name of their group"""
    node_sets: dict[str, is_.Vector] | None = None
    """nodes of each set by its name"""


PROFILES = (RectangleProfile, RectanglesProfile, LineProfile, MeshProfile, CellsProfile)
MESHES = (BlockMesh, SectorMesh, ExtrusionMesh, FileMesh, ElementsMesh)

if TYPE_CHECKING:
    HeldPlaces = Any
else:
    HeldPlaces = list[is_.text_or(Held)]


def meshed_tables(kinds: str, material: Any, name: Keys) -> list[type[Table]]:
    """Return the tables of a body of revolution and of one meshed in space.

    Parameters
    ----------
    kinds : str
        All kinds of bodies, in words.
    material : type
        The table of a material.
    name : mapping
        The key of its name, as `table_of` takes it.
    """
    revolved: Keys = {
        "profile": (one_of("shape", PROFILES), ..., "section through the axis, the half with r >= 0"),
        "material": (is_.one_or_by_name(material), ..., "what it is made of, or that of each region by its name"),
    }
    held: Keys = {
        "held": (HeldPlaces, (), "places that do not move: their names, or with directions"),
        "residual_at": (list[is_.OfProfile], (), "places (r, z) where forces act, to which modes left out yield [m]"),
        "turning_history": (History | None, None, "factor on the turning over time, constant if left out"),
    }
    meshed: Keys = {
        "mesh": (one_of("shape", MESHES), ..., "its mesh"),
        "materials": (is_.one_or_by_name(material), ..., "what it is made of, or that of each group by its name"),
        "points": (dict[str, is_.MeshNode], {}, "nodes by name: a set of one, a number or coordinates [m]"),
        "fixed": (is_.FixedGroups, (), "groups of faces or nodes that are held: their names, or directions by name"),
    }
    flags: Keys = {
        "contact_faces": (list[str], (), "faces that touch others: the body yields at their points"),
        "residual_flexibility": (bool, True, "whether modes beyond the cutoff yield statically at the points"),
        "linear": (bool, False, "whether elements without nodes in the middle of their edges stay as they are"),
    }
    return [
        table_of(bodies.AxisymmetricBody, "kind", "axisymmetric", kinds, before=revolved, after={**held, **name}),
        table_of(bodies.SolidBody, "kind", "solid", kinds, before=meshed, after={**flags, **name}),
    ]
