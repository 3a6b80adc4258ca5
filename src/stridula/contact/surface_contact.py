"""A face of a meshed body on a disc, on another meshed body or on a rigid plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import AxisymmetricBody, BodyPoint, SolidBody
from ..bodies.solid_overlays import overlaid
from ..bodies.solid_places import FacePoints
from ..checks import ArgumentError, choice, finite, instance
from .coulomb import Coulomb
from .friction_law import FrictionLaw
from .point_contact import PointContact
from .rigid_track import RigidTrack
from .stiffness import STIFFNESSES, ContactStiffness, LinearStiffness, per_area

# Cosine between a face and what it touches, from which the two face each other.
FACING = 0.5
# Overlap of faces, relative to the size of the one that slides, that is rounding of their coordinates.
OVERLAP = 1e-6
# Beyond the ends of a side of a profile, relative to it, that still belongs to it.
BEYOND = 1e-9


@dataclass(frozen=True)
class SurfaceContact:
    """A face in contact, point by point: each point of integration of the face touches what lies before it.

    Gaps, areas and directions follow from the geometry; meshes need not match. Give it to a `System` among the
    contacts. Points are frozen in space, as those of point contacts of bodies in space are.

    Parameters
    ----------
    body : SolidBody
        The body whose face touches; its `contact_faces` should name the face, so that it yields there.
    face : str
        The name of the face.
    track : AxisymmetricBody, SolidBody or RigidTrack
        What it slides on. A rigid track is a plane through the foremost points of the face, square to its mean normal.
    track_face : str, optional
        The face of a `SolidBody` that is touched.
    friction : FrictionLaw, optional
        Law of friction; none if left out.
    gap : float, optional
        Distance beyond that of the geometry [m].
    stiffness : float, LinearStiffness, PowerStiffness or HertzStiffness, optional
        Stiffness of the contact for a unit of area, a number in N/m³; rigid if left out.
    tangent : sequence of float, optional
        World components of what lies along the first tangent; if left out that in which the track turns or, where it
        does not, as that of a `PointContact`.
    overlay : bool, optional
        Whether points are those of the pieces into which the faces of both bodies cut each other, where both are flat:
        more points, through which a uniform pressure goes exactly between unlike meshes.
    name : str, optional
        What it is called in records: its points are this name and their numbers from 1.

    Raises
    ------
    ValueError
        If an argument is out of its range, if a point has nothing before it, or if faces overlap or do not face each
        other.
    """

    body: SolidBody
    face: str
    track: Any
    track_face: str = ""
    friction: FrictionLaw = field(default_factory=lambda: Coulomb(0.0))
    gap: float = 0.0
    stiffness: ContactStiffness | float | None = None
    tangent: Sequence[float] | None = None
    overlay: bool = False
    name: str = "surface"

    def __post_init__(self) -> None:
        instance("body", self.body, SolidBody)
        choice("face", self.face, self.body.face_names or ("none",))
        instance("track", self.track, (AxisymmetricBody, SolidBody, RigidTrack))
        if isinstance(self.track, SolidBody):
            choice("track_face", self.track_face, self.track.face_names or ("none",))
        elif self.track_face:
            raise ArgumentError("track_face", "be left out but on a SolidBody", self.track_face)
        instance("overlay", self.overlay, bool)
        if self.overlay and not isinstance(self.track, SolidBody):
            raise ArgumentError("overlay", "be False but on a SolidBody", self.overlay)
        instance("name", self.name, str)
        object.__setattr__(self, "gap", finite("gap", self.gap))
        if isinstance(self.stiffness, (int, float)):
            object.__setattr__(self, "stiffness", LinearStiffness(float(self.stiffness)))
        elif self.stiffness is not None:
            instance("stiffness", self.stiffness, STIFFNESSES)
        self.contacts  # noqa: B018, found now, so that what is wrong is said here

    @cached_property
    def points(self) -> FacePoints:
        """The points of the face: places, areas and outward normals."""
        if self.overlay:
            return overlaid(
                self.body.face(self.face), self.body.mesh, self.track.face(self.track_face), self.track.mesh
            )
        return self.body.face_points(self.face)

    @property
    def areas(self) -> Array:
        """Areas of the points [m²], shape (points,)."""
        return self.points.area

    @cached_property
    def contacts(self) -> tuple[PointContact, ...]:
        """The contacts of its points."""
        points, size = self.points, float(np.ptp(self.points.place, axis=0).max())
        found = []
        for number, (place, area, normal) in enumerate(
            zip(points.place, points.area.tolist(), points.normal, strict=True)
        ):
            track, facing, gap = self._before(place, normal)
            if facing @ normal > -FACING:
                got = f"an angle of {np.degrees(np.arccos(-facing @ normal)):.3g} degrees"
                raise ArgumentError("track", f"face the {self.face!r} of the body", got=f"{got} at {_words(place)}")
            if gap + self.gap < -OVERLAP * size:
                got = f"an overlap of {-gap - self.gap:.3g} m at {_words(place)}"
                raise ArgumentError("gap", "leave the faces apart", self.gap, got=got)
            contact = PointContact(
                self.body.at(place.tolist()),
                track,
                friction=self.friction,
                gap=max(gap + self.gap, 0.0),
                normal=tuple(facing.tolist()),
                tangent=self._tangent(track, facing),
                stiffness=None if self.stiffness is None else per_area(self.stiffness, area),  # type: ignore[arg-type]
                name=f"{self.name} {number + 1}",
                surface=self.name,
            )
            found.append(contact)
        return tuple(found)

    def _tangent(self, track: Any, facing: Array) -> tuple[float, ...] | None:
        if self.tangent is not None:
            return tuple(self.tangent)
        moved = track.turning_velocity if isinstance(track, BodyPoint) else np.zeros(3)
        return tuple(moved.tolist()) if moved.any() else None

    def _before(self, place: Array, normal: Array) -> tuple[Any, Array, float]:
        """Return what lies before a point of the face, its normal, and how far away it is [m]."""
        if isinstance(self.track, RigidTrack):
            facing = -(self.points.area @ self.points.normal)
            facing = facing / np.linalg.norm(facing)
            heights = self.points.place @ facing
            return self.track, facing, float(place @ facing - heights.min())
        if isinstance(self.track, SolidBody):
            return _on_solid(self.track, self.track_face, place, normal)
        return _on_revolution(self.track, place, normal)


def _on_solid(body: SolidBody, face: str, place: Array, normal: Array) -> tuple[BodyPoint, Array, float]:
    """Return the point of a face of a meshed body before a place, along its normal."""
    faces = body.face(face)
    corners = len(body.mesh.element_kind.faces[0])
    nodes = body.mesh.nodes[faces.nodes[:, :corners]]
    best: tuple[float, int] | None = None
    for second in range(1, corners - 1):
        first, along, across = nodes[:, 0], nodes[:, second] - nodes[:, 0], nodes[:, second + 1] - nodes[:, 0]
        square = np.cross(along, across)
        toward = square @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            far = ((first - place) * square).sum(axis=1) / toward
            there = place + far[:, None] * normal - first
            u = (np.cross(there, across) * square).sum(axis=1) / (square**2).sum(axis=1)
            v = (np.cross(along, there) * square).sum(axis=1) / (square**2).sum(axis=1)
        inside = (np.minimum(u, v) >= -BEYOND) & (u + v <= 1.0 + BEYOND) & (np.abs(toward) > 0.0)
        for number in np.flatnonzero(inside).tolist():
            if best is None or abs(far[number]) < abs(best[0]):
                best = float(far[number]), number
    if best is None:
        raise ArgumentError("track_face", "lie before the whole face", face, got=f"nothing before {_words(place)}")
    far, number = best
    return body.at((place + far * normal).tolist()), -normal if faces.normal[number] @ normal < 0.0 else normal, far


def _on_revolution(body: AxisymmetricBody, place: Array, normal: Array) -> tuple[BodyPoint, Array, float]:
    """Return the point of the surface of a body of revolution before a place, along the normal there."""
    frame, mesh = body.frame, body.mesh
    x, y, z = frame @ (place - np.asarray(body.origin))
    r, theta = float(np.hypot(x, y)), float(np.arctan2(y, x))
    directions = np.array([np.cos(theta), np.sin(theta), 0.0]) @ frame, frame[2]
    way = np.array([one @ normal for one in directions])
    start, along = mesh.nodes[mesh.outline[:, 0]], mesh.nodes[mesh.outline[:, 1]] - mesh.nodes[mesh.outline[:, 0]]
    toward = along[:, 0] * way[1] - along[:, 1] * way[0]
    apart = start - np.array([r, z])
    with np.errstate(divide="ignore", invalid="ignore"):
        far = (along[:, 0] * apart[:, 1] - along[:, 1] * apart[:, 0]) / toward
        share = (way[0] * apart[:, 1] - way[1] * apart[:, 0]) / toward
    met = np.flatnonzero((share >= -BEYOND) & (share <= 1.0 + BEYOND) & (np.abs(toward) > 0.0) & np.isfinite(far))
    if not met.size:
        raise ArgumentError("track", "lie before the whole face", got=f"nothing before {_words(place)}")
    side = int(met[np.abs(far[met]).argmin()])
    found = start[side] + np.clip(share[side], 0.0, 1.0) * along[side]
    # The profile is to the left of its outline.
    outward = np.array([along[side, 1], -along[side, 0]]) / np.hypot(*along[side])
    facing = outward @ np.stack(directions)
    return body.at((float(found[0]), theta, float(found[1]))), facing, float(far[side])


def _words(place: Array) -> str:
    return f"({', '.join(f'{one:.4g}' for one in place)})"


def all_contacts(given: Sequence[Any]) -> tuple[PointContact, ...]:
    """Return the contacts of points, those of surfaces one by one."""
    found: list[PointContact] = []
    for one in given:
        found += one.contacts if isinstance(one, SurfaceContact) else [one]
    return tuple(found)
