"""The tables of bodies of revolution and of bodies meshed in space, in a scenario file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from .. import bodies
from ..bodies.revolution.axisymmetric_body import DIRECTIONS
from ..bodies.revolution.profile_mesh import BODY
from ..bodies.solids.kinds import KINDS
from . import fields as is_
from .derived import Keys, one_of, table_of
from .schema_drives import History
from .tables import Table, one_or_by_name, text_or


class Sides(Table):
    inner: is_.Distance
    """smallest distance from the axis [m]"""
    outer: is_.Length
    """largest distance from the axis [m]"""
    bottom: is_.Position
    """lowest position along the axis [m]"""
    top: is_.Position
    """highest position along the axis [m]"""


if TYPE_CHECKING:
    PlaceOrBox = Any
    Element = Any
else:
    PlaceOrBox = text_or(Sides)
    Element = Literal[tuple(KINDS)]


class Held(Table):
    place: PlaceOrBox
    """name of a place, such as inner, top or hat.outer, or a box"""
    directions: is_.Directions = DIRECTIONS
    """held directions among r, theta and z; all if left out"""


class RectangleProfile(Sides):
    shape: Literal["rectangle"]
    """rectangle, rectangles, line, mesh or cells"""
    size: is_.Length | None = None
    """largest side of a cell, chosen for the shortest waves if left out [m]"""


class Part(Sides):
    region: str = BODY
    """name of its region; several rectangles may share one"""


class RectanglesProfile(Table):
    shape: Literal["rectangles"]
    """rectangle, rectangles, line, mesh or cells"""
    rectangles: list[Part]
    """rectangles that share sides"""
    size: is_.Length | None = None
    """largest side of a cell, chosen for the shortest waves if left out [m]"""


class LineProfile(Table):
    shape: Literal["line"]
    """rectangle, rectangles, line, mesh or cells"""
    points: list[is_.OfProfile]
    """points (r, z) of its middle line [m]"""
    thickness: is_.LengthOrEach
    """thickness, or the thickness at each point [m]"""
    size: is_.Length | None = None
    """largest side of a cell along the line, chosen for the shortest waves if left out [m]"""


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
    """distance from the axis and position along it of each node [m]"""
    cells: is_.Rows
    """nodes of each triangle or quadrilateral, numbered from 0"""
    regions: dict[str, is_.Vector] | None = None
    """cells of each region by its name"""
    edges: dict[str, is_.Rows] | None = None
    """edges that can be held, as pairs of nodes by name"""


class Placed(Table):
    rotation: is_.Rotation | None = None
    """rotation about the origin: its axis times its angle, along x, y and z [rad]"""
    offset: is_.Offset | None = None
    """shift along x, y and z, after the rotation [m]"""


class BlockMesh(Placed):
    shape: Literal["block"]
    """block, sector, extrusion, file, elements or tied"""
    lengths: is_.Lengths
    """sides along x, y and z from the origin [m]"""
    divisions: is_.Divisions
    """numbers of elements along x, y and z"""


class SectorMesh(Placed):
    shape: Literal["sector"]
    """block, sector, extrusion, file, elements or tied"""
    radii: is_.Radii
    """inner and outer radius [m]"""
    angles: is_.Angles
    """angles of start and end, from z where the axis is y [rad]"""
    height: is_.LengthOrLayers
    """length along the axis, or lengths of layers by name from the bottom up [m]"""
    divisions: is_.Divisions
    """numbers of elements along radius, angle and axis, the last for each layer"""
    axis: Literal["x", "y", "z"] = "y"
    """x, y or z"""


class ExtrusionMesh(Placed):
    shape: Literal["extrusion"]
    """block, sector, extrusion, file, elements or tied"""
    nodes: is_.Rows
    """coordinates of each node in the plane [m]"""
    quadrilaterals: is_.Rows
    """corners of each quadrilateral, counterclockwise, numbered from 0"""
    height: is_.LengthOrLayers
    """length along the axis, or lengths of layers by name from the bottom up [m]"""
    layers: is_.Count
    """number of elements along the axis in each layer"""
    axis: Literal["x", "y", "z"] = "z"
    """x, y or z"""


class FileMesh(Placed):
    shape: Literal["file"]
    """block, sector, extrusion, file, elements or tied"""
    file: str
    """file of a mesh, beside the scenario"""
    scale: is_.Length = 1.0
    """length of the file's unit [m]"""
    part: str | None = None
    """part of the file: an instance, a group of elements, a material or a property; all if left out"""


class ElementsMesh(Placed):
    shape: Literal["elements"]
    """block, sector, extrusion, file, elements or tied"""
    kind: Element
    """tetra, tetra10, hexahedron, hexahedron20 or hexahedron27"""
    nodes: is_.Rows
    """coordinates of each node [m]"""
    elements: is_.Rows
    """nodes of each element, numbered from 0, in the order of VTK"""
    volumes: dict[str, is_.Vector] | None = None
    """elements of each group by its name"""
    faces: dict[str, is_.Rows] | None = None
    """pairs of an element and one of its faces, by name of the group"""
    node_sets: dict[str, is_.Vector] | None = None
    """nodes of each set by its name"""
    ties: list[is_.TiedFaces] | None = None
    """pairs of faces that stay together; the nodes of the second follow the first"""
    tolerance: is_.Length | None = None
    """largest distance of a tied node from the other face, a twentieth of an element if left out [m]"""


PROFILES = (RectangleProfile, RectanglesProfile, LineProfile, MeshProfile, CellsProfile)
PARTS = (BlockMesh, SectorMesh, ExtrusionMesh, FileMesh, ElementsMesh)

if TYPE_CHECKING:
    HeldPlaces = Any
    PartMesh = Any
else:
    HeldPlaces = list[text_or(Held)]
    PartMesh = one_of("shape", PARTS)


class TiedMesh(Placed):
    shape: Literal["tied"]
    """block, sector, extrusion, file, elements or tied"""
    parts: dict[str, PartMesh]
    """meshes by the names of the parts"""
    ties: list[is_.TiedFaces]
    """pairs of faces, such as plate/front and lining/back; the nodes of the second follow the first"""
    tolerance: is_.Length | None = None
    """largest distance of a tied node from the other face, a twentieth of an element if left out [m]"""


MESHES = (*PARTS, TiedMesh)


def meshed_tables(kinds: str, material: Any, name: Keys) -> list[type[Table]]:
    """Return the tables of a body of revolution and of one meshed in space.

    Parameters
    ----------
    kinds : str
        All kinds of bodies, as text.
    material : type
        The table of a material.
    name : mapping
        The key of its name, in the form of `table_of`.
    """
    revolved: Keys = {
        "profile": (one_of("shape", PROFILES), ..., "section through the axis, the half with r >= 0"),
        "material": (one_or_by_name(material), ..., "material, or materials of the regions by name"),
    }
    held: Keys = {
        "held": (HeldPlaces, (), "places that do not move: their names, or tables with directions"),
        "residual_at": (
            list[is_.OfProfile],
            (),
            "places (r, z) of forces, at which modes left out add static flexibility [m]",
        ),
        "turning_history": (History | None, None, "factor on the turning over time, constant if left out"),
    }
    meshed: Keys = {
        "mesh": (one_of("shape", MESHES), ..., "its mesh"),
        "materials": (one_or_by_name(material), ..., "material, or materials of the groups by name"),
        "points": (dict[str, is_.MeshNode], {}, "nodes by name: a set of one, a number or coordinates [m]"),
        "fixed": (is_.FixedGroups, (), "groups of faces or nodes that are held: their names, or directions by name"),
    }
    flags: Keys = {
        "contact_faces": (
            is_.DividedFaces,
            (),
            "faces that touch others, flexible at their points: their names, or numbers of points by name",
        ),
        "residual_flexibility": (bool, True, "whether modes beyond the cutoff add static flexibility at the points"),
        "linear": (bool, False, "whether elements without midside nodes are kept as they are"),
    }
    return [
        table_of(bodies.AxisymmetricBody, "kind", "axisymmetric", kinds, before=revolved, after={**held, **name}),
        table_of(bodies.SolidBody, "kind", "solid", kinds, before=meshed, after={**flags, **name}),
    ]
