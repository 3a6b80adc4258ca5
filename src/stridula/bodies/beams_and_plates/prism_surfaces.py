"""The outer surface of beams and plates as points: straight prisms, cut into patches as meshes are."""

from __future__ import annotations

from collections.abc import Callable
from functools import singledispatch
from typing import Any

import numpy as np

from ...arrays import Array, in_space
from ...checks import ArgumentError
from ..body_surfaces import PointSurface
from ..sections import Circle, Rectangle
from ..solids.shapes import block, extrusion
from ..solids.solid_mesh import SolidMesh
from ..solids.surfaces import cut_faces

# Cells of a prism for each half-wave of its modes, quadratic ones, and at least.
CELLS_A_WAVE, FEWEST_CELLS = 3, 4
# Squares along each side of the middle of a circle; as many times four go round it.
INNER, OF_RADIUS = 4, 0.6


def cells_of(half_waves: float) -> int:
    """Return the number of cells into which a length with a number of half-waves is cut."""
    return max(FEWEST_CELLS, CELLS_A_WAVE * int(np.ceil(half_waves)))


@singledispatch
def beam_mesh(section: Any, length: float, cells: int) -> SolidMesh:
    """Return a beam as a mesh: x along it, y across it in the plane of bending and z square to both, from its axis.

    Raises
    ------
    ValueError
        If the section has no outline.
    """
    words = "be a Rectangle or a Circle for a beam to have a surface; the sound of strings needs an st.Bridge"
    raise ArgumentError("section", words, section)


@beam_mesh.register
def _of_a_rectangle(section: Rectangle, length: float, cells: int) -> SolidMesh:
    mesh = SolidMesh(**block((length, section.height, section.width), (cells, 1, 1)))
    return _moved(mesh, np.array([0.0, -0.5 * section.height, -0.5 * section.width]))


@beam_mesh.register
def _of_a_circle(section: Circle, length: float, cells: int) -> SolidMesh:
    return SolidMesh(**extrusion(*_disc(section.area), {"": length}, cells, "x"))


def plate_mesh(sides: tuple[float, float], thickness: float, cells: tuple[int, int]) -> SolidMesh:
    """Return a plate as a mesh: x and y along its sides, from its corner, z from its middle plane."""
    mesh = SolidMesh(**block((*sides, thickness), (*cells, 1)))
    return _moved(mesh, np.array([0.0, 0.0, -0.5 * thickness]))


def prism_surface(
    mesh: SolidMesh, frame: Array, origin: Array, trace: Callable[[Array], Array], largest: float
) -> PointSurface:
    """Return the surface of a prism all of whose points on a line across it move alike.

    Parameters
    ----------
    mesh : SolidMesh
        The prism in its own axes.
    frame : ndarray, shape (3, 3)
        World components of these axes, a row each, which are right-handed.
    origin : ndarray, shape (3,)
        World place of their origin [m].
    trace : callable
        Takes places on them (n, 3) [m], returns the world displacements of the modes there, shape (n, 3, modes).
    largest : float
        Largest part of the surface for sound [m].
    """
    placed = SolidMesh(origin + mesh.nodes @ frame, mesh.elements, mesh.kind)
    return cut_faces(placed, trace(mesh.nodes), largest)


def has_outline(section: Any) -> bool:
    """Return whether the outline of a section is known, so that a beam has a surface."""
    return beam_mesh.dispatch(type(section)) is not beam_mesh.dispatch(object)


def beam_surface(beam: Any, half_waves: float, largest: float, held_x: bool = False) -> PointSurface:
    """Return the surface of a beam whose axis begins at the origin of the world; sections move as their middle does.

    Parameters
    ----------
    beam : FiniteElementBeam or ModalBeam
        The beam.
    half_waves : float
        How many half-waves its modes have at most.
    largest : float
        Largest part of the surface for sound [m].
    held_x : bool, optional
        Whether its root is held along x.
    """
    mesh = beam_mesh(beam.section, beam.length, cells_of(half_waves))

    def moved(places: Array) -> Array:
        along, which = np.unique(np.clip(places[:, 0], 0.0, beam.length), return_inverse=True)
        rows = [beam.trace(place, held_x) for place in along.tolist()]
        return np.array([np.pad(row, ((0, 3 - len(row)), (0, 0))) for row in rows])[which.ravel()]

    first, second = (in_space(axis) for axis in beam.axes)
    return prism_surface(mesh, np.array([first, second, np.cross(first, second)]), np.zeros(3), moved, largest)


def _moved(mesh: SolidMesh, away: Array) -> SolidMesh:
    return SolidMesh(mesh.nodes + away, mesh.elements, mesh.kind)


def _disc(area: float) -> tuple[Array, Array]:
    """Return places and quadrilaterals of a regular polygon with the area of a circle, about the origin."""
    line = np.linspace(-1.0, 1.0, INNER + 1)
    square = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    number = np.arange(len(square)).reshape(INNER + 1, INNER + 1)
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    inner = np.stack(corners, axis=-1).reshape(-1, 4)
    rim = np.concatenate([number[:-1, 0], number[-1, :-1], number[:0:-1, -1], number[0, :0:-1]])
    angle = np.arctan2(square[rim[0], 1], square[rim[0], 0]) + 2.0 * np.pi * np.arange(len(rim)) / len(rim)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    outer = len(square) + np.arange(len(rim))
    between = np.stack([rim, outer, np.roll(outer, -1), np.roll(rim, -1)], axis=1)
    radius = np.sqrt(2.0 * area / (len(rim) * np.sin(2.0 * np.pi / len(rim))))
    places = radius * np.concatenate([OF_RADIUS / np.sqrt(2.0) * square, circle])
    return places, np.concatenate([inner, between])
