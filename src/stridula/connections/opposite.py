"""Points of two faces that lie opposite each other, for the springs of a layer between them."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint, SolidBody, SolidMesh
from ..bodies.solids.face_patches import Patches, patched
from ..bodies.solids.opposite import opposite_place, place_words
from ..checks import ArgumentError, choice, count, instance, positive


def opposite_points(
    body: SolidBody,
    face: str,
    other: SolidBody | None = None,
    other_face: str = "",
    *,
    points: int = 12,
    farthest: float | None = None,
) -> tuple[list[BodyPoint], list[BodyPoint] | None, Array]:
    """Return points on a face of a meshed body and those opposite on a face of another, for a layer between them.

    The first face is divided into patches of nearly equal area; the points are their centres, and the places that the
    normals there meet on the other face. Meshes need not match. Faces that are bonded without a layer are parts of one
    mesh, see `SolidMesh.tied`.

    Parameters
    ----------
    body : SolidBody
        Body with the first face, of which every patch needs something opposite: take the smaller face.
    face : str
        Name of the first face.
    other : SolidBody, optional
        Other body; the ground if left out.
    other_face : str, optional
        Name of its face.
    points : int, optional
        Approximate number of points.
    farthest : float, optional
        Largest distance between the faces [m]; a tenth of the first face, between its farthest points, if left out.

    Returns
    -------
    first, second : list of BodyPoint
        The points of both faces, in the same order; None in place of the second for the ground.
    area : ndarray
        Area of each patch [m²].

    Raises
    ------
    ValueError
        If nothing is opposite a patch, or if it is farther away than `farthest`.

    Examples
    --------
    >>> steel = st.Material(young=210e9, density=7800)
    >>> plate, pad = (st.SolidMesh.block((0.1, thick, 0.04), (6, 1, 2)) for thick in (0.005, 0.015))
    >>> plate = st.SolidBody(plate, steel, cutoff=10e3, name="plate")
    >>> pad = st.SolidBody(pad.moved((0.0, 0.006, 0.0)), steel, cutoff=10e3, name="pad")
    >>> first, second, area = st.opposite_points(pad, "bottom", plate, "top", points=8)
    >>> shim = {"y": [4e8], "x": [4e7], "z": [4e7]}
    >>> springs = st.viscoelastic_layer(
    ...     first, second, area=area, frequency=[2e3], stiffness=shim, loss_factor=[0.2]
    ... )
    >>> print(len(first), len(springs), f"{area.sum():.4g} m2")
    8 24 0.004 m2
    """
    _check_face("body", body, "face", face)
    if other is not None:
        _check_face("other", other, "other_face", other_face)
    patches = patched(body.mesh, face, count("points", points))
    places = _places_on_face(body.mesh, face, patches)
    first, area = [body.at(place.tolist()) for place in places], patches.points.area.copy()
    if other is None:
        return first, None, area
    size = float(np.linalg.norm(np.ptp(patches.samples.place, axis=0)))
    limit = 0.1 * size if farthest is None else positive("farthest", farthest)
    second = []
    for place, normal in zip(places, patches.points.normal, strict=True):
        met = opposite_place(other.mesh, other_face, place, normal)
        if met is None:
            got = f"nothing opposite {place_words(place)}"
            raise ArgumentError("other_face", f"lie opposite the whole face {face!r}", other_face, got=got)
        there, _, distance = met
        if abs(distance) > limit:
            got = f"{abs(distance):.4g} m at {place_words(place)}"
            raise ArgumentError("farthest", "be at least the distance between the faces", got=got)
        second.append(other.at(there.tolist()))
    return first, second, area


def _check_face(name: str, body: SolidBody, of_face: str, face: str) -> None:
    instance(name, body, SolidBody)
    choice(of_face, face, body.face_names or ("none",))


def _places_on_face(mesh: SolidMesh, face: str, patches: Patches) -> list[Array]:
    """Return the centre of each patch on its face: that of a curved face lies beside it, that of a ring in its hole."""
    places = []
    for number, (centre, normal) in enumerate(zip(patches.points.place, patches.points.normal, strict=True)):
        projected = opposite_place(mesh, face, centre, normal)
        samples = patches.samples.place[patches.owner == number]
        nearest = samples[np.argmin(np.linalg.norm(samples - centre, axis=1))]
        places.append(nearest if projected is None else projected[0])
    return places
