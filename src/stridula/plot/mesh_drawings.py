"""Drawings of meshes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from ..bodies import MeshPart, SolidMesh
from ..bodies.solids.drawn_mesh import surface_of_mesh
from ..cards import VIEW, eye_of
from ..checks import ArgumentError, by_key, instance
from .moved_bodies import AWAY, ShownBody
from .scenes import checked_view
from .space_sketches import SpaceSketch


def meshes(meshes: Mapping[str, MeshPart | SolidMesh], *, view: tuple[float, float] = VIEW, title: str = "") -> Figure:
    """Draw meshes in perspective, each in a colour, with the edges of their elements.

    Parameters
    ----------
    meshes : mapping
        Meshes, or parts of a file, by name, as `read_parts` returns them.
    view : tuple of float, optional
        Elevation of the eye above the plane across y and its azimuth from z towards x [rad].
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If there are no meshes.

    Examples
    --------
    >>> import stridula as st
    >>> block = st.SolidMesh.block((0.1, 0.02, 0.05), (4, 1, 2))
    >>> figure = st.plot.meshes({"block": block})
    """
    given = by_key("meshes", meshes)
    seen, shown = checked_view(view), []
    if not given:
        raise ArgumentError("meshes", "be one or more meshes by name", meshes)
    for name, one in given.items():
        mesh = getattr(one, "mesh", one)
        instance(f"meshes[{name!r}]", mesh, SolidMesh)
        surface = surface_of_mesh(mesh, np.zeros((3 * len(mesh.nodes), 0)))
        shown.append(ShownBody(str(name), surface, surface.normals @ eye_of(seen) > AWAY))
    return MeshDrawing(shown, seen, title).figure


class MeshDrawing(SpaceSketch):
    """Drawing of meshes, with a title; other arguments as of `SpaceSketch`."""

    def __init__(self, shown: list[ShownBody], view: tuple[float, float], title: str) -> None:
        super().__init__(shown, view)
        self._draw_surfaces([one.name for one in shown], width=0.4, edges="0.25")
        self._finish(title)
