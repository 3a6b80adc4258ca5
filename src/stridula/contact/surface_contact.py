"""Contact of a face of a meshed body with a disc, another meshed body or a rigid plane."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, Any, cast

import numpy as np

from ..arrays import Array
from ..bodies import AxisymmetricBody, ReducedBody, SolidBody
from ..bodies.solids.opposite import place_words
from ..bodies.solids.overlays import overlaid
from ..bodies.solids.places import FacePoints
from ..checks import ArgumentError, choice, counted, finite, instance
from ..declared import Each, Number, Position, check_declared
from ..doubtful import warn_of
from .around_track import FrictionAroundTrack
from .axes import Axis
from .coulomb import Coulomb
from .facing import BEFORE
from .friction_law import FrictionLaw
from .heating import Heating, check_heating
from .point_contact import ALONG_X, PointContact
from .profile import Profile
from .random_fields import FrictionField
from .rigid_track import RigidTrack
from .run_out import RunOut
from .stiffness import ContactStiffness, checked_stiffness, per_area

# With more points than this on a face, a note mentions the time that a run takes.
MANY = 250
# Two faces face each other if the cosine between their opposite normals is at least this.
FACING = 0.5
# Largest overlap of faces, relative to the size of the sliding face, that may be due to rounding of coordinates.
OVERLAP = 1e-6
# Smallest share of the velocity of a turning track that lies along its facets, whose normals differ from those of the
# round surface; largest distance from the axis, relative to the size of the face, that may be due to rounding.
ALONG, ON_THE_AXIS = 0.98, 1e-9


@dataclass(frozen=True, repr=False)
class SurfaceContact:
    """A face in contact, point by point: each point of integration touches the opposite point of the track.

    Gaps, areas and directions follow from the geometry; meshes need not match. Pass it to a `System` among the
    contacts. Points are fixed in space, as in point contacts of bodies in space.

    Parameters
    ----------
    body : SolidBody or ReducedBody
        Body whose face touches; `contact_faces` of a `SolidBody` should name the face, to keep its static flexibility
        there.
    face : str
        Name of the face.
    track : AxisymmetricBody, SolidBody or RigidTrack
        Body or plane on which it slides. A rigid track is a plane through the foremost points of the face,
        perpendicular to its mean normal; places along its profile are counted from the middle of the face.
    track_face : str, optional
        Touched face, if the track is a `SolidBody`.
    friction : FrictionLaw or sequence of FrictionLaw, optional
        Friction law, or one for each point, such as of a coefficient that varies over the face; no friction if left
        out.
    gap : float, optional
        Distance in addition to that of the geometry [m].
    stiffness : float, LinearStiffness, PowerStiffness or HertzStiffness, optional
        Contact stiffness per unit of area, a number in N/m³; rigid if left out.
    tangential_stiffness : float, optional
        Stiffness along the face per unit of area [N/m³], in series with the friction, such as that of a lining in
        shear; rigid if left out.
    tangential_damping : float, optional
        Damping along the face per unit of area [N s/m³], beside this stiffness.
    tangent : sequence of float, optional
        World components of the first tangent; if left out, the direction in which the track turns or, if it does not,
        as for a `PointContact`.
    overlay : bool, optional
        Whether points are those of the intersections of the faces of both bodies, which must be flat: more points,
        which transmit a uniform pressure exactly between meshes that do not match.
    name : str, optional
        Name in records; the names of its points are this one with numbers from 1.
    turning : tuple, optional
        Axis, origin and speed of a meshed track that turns under the face: direction of the axis, of any length, a
        point on it [m], and the angular velocity about it, counter-clockwise with the axis pointing at the viewer
        [rad/s]. Each point of the track then moves across the axis. The vibration of the track is described in a frame
        at rest: unlike those of a turning `AxisymmetricBody`, its waves are not carried round.
    wear : sequence of float, optional
        Depth worn off the face at each point [m], which adds to its gap; `worn` computes it from a record.
    heating : HeatedLayers or TemperatureHistory, optional
        Temperature of the face, on which its friction may depend: layers of the whole face, which its points share by
        their areas without heat from one to the next, or a given history.
    run_out : RunOut, optional
        Height of the surface of a track that turns, over the angle about its axis: in a body of revolution the angle
        of its points, on a meshed track that from the world x axis (z if the axis is along x) about the axis of
        `turning`. Its highest point is where the flat surface would be.
    friction_field : FrictionField, optional
        Random field by which the coefficients vary over the face; even if left out.

    Raises
    ------
    ValueError
        If an argument is out of its range, if nothing is opposite a point, or if faces overlap or do not face each
        other.
    """

    body: SolidBody | ReducedBody
    face: str
    track: Any
    track_face: str = ""
    friction: FrictionLaw | Sequence[FrictionLaw] = field(default_factory=lambda: Coulomb(0.0))
    gap: Position = 0.0
    stiffness: ContactStiffness | float | None = None
    tangential_stiffness: Annotated[float, Number("N/m3", above=0.0)] | None = None
    tangential_damping: Annotated[float, Number("N s/m3", least=0.0)] = 0.0
    tangent: Annotated[Sequence[float], Each(Number())] | None = None
    overlay: bool = False
    name: str = "surface"
    turning: tuple[Sequence[float], Sequence[float], float] | None = None
    wear: Annotated[Sequence[float], Each(Number("m", least=0.0))] | None = None
    heating: Heating | None = None
    run_out: RunOut | None = None
    friction_field: FrictionField | None = None

    def __post_init__(self) -> None:
        instance("body", self.body, (SolidBody, ReducedBody))
        if self.overlay and self.body.kind != SolidBody.kind:
            raise ArgumentError("overlay", "be False for a ReducedBody", self.overlay)
        choice("face", self.face, self.body.face_names or ("none",))
        instance("track", self.track, (AxisymmetricBody, SolidBody, RigidTrack))
        instance("overlay", self.overlay, bool)
        if self.track.kind == SolidBody.kind:
            choice("track_face", self.track_face, self.track.face_names or ("none",))
        else:
            for name, given in (("track_face", self.track_face), ("overlay", self.overlay)):
                if given:
                    raise ArgumentError(name, "be left out except on a SolidBody", given)
        instance("name", self.name, str)
        if hasattr(self.friction, "__iter__"):
            object.__setattr__(self, "friction", tuple(self.friction))
        check_declared(self)
        if self.turning is not None:
            object.__setattr__(self, "turning", self._checked_turning(self.turning))
        if self.run_out is not None:
            instance("run_out", self.run_out, RunOut)
            if self._axis is None:
                raise ArgumentError("run_out", "be left out on a track that does not turn", self.run_out)
        if self.friction_field is not None:
            instance("friction_field", self.friction_field, FrictionField)
        object.__setattr__(self, "stiffness", checked_stiffness(self.stiffness))
        if len(self._laws) != self.areas.size:
            words = f"be one law, or have {self.areas.size}, one for each point"
            raise ArgumentError("friction", words, got=counted(len(self._laws), "law"))
        if any(law.depends_on_place for law in self._laws):
            words = "not depend on the place along the track, as points of a face have none: use FrictionAroundTrack"
            raise ArgumentError("friction", words, self.friction)
        if self._axis is None and any(law.depends_on_angle for law in self._laws):
            raise ArgumentError("friction", "not depend on the angle on a track that does not turn", self.friction)
        check_heating(self.heating, any(law.depends_on_temperature for law in self._laws))
        if self.wear is not None and len(self.wear) != self.areas.size:
            raise ArgumentError("wear", f"have {self.areas.size} depths, one for each point", got=str(len(self.wear)))
        if len(self.contacts) > MANY:
            warn_of(
                [
                    f"{len(self.contacts)} points of {self.name!r}: a second of motion with 120 takes minutes to half "
                    "an hour, and the time grows with the third power; give the body fewer, such as "
                    f"contact_faces={{{self.face!r}: 30}}"
                ]
            )

    def __repr__(self) -> str:
        other = f"{self.track_face!r} of {type(self.track).__name__}" if self.track_face else type(self.track).__name__
        sides = f"{self.face!r} of {type(self.body).__name__} on {other}"
        return f"SurfaceContact({self.name!r}, {sides}, {counted(len(self.contacts), 'point')})"

    @cached_property
    def points(self) -> FacePoints:
        """The points of the face: places, areas and outward normals."""
        if self.overlay:
            body: Any = self.body
            return overlaid(body.face(self.face), body.mesh, self.track.face(self.track_face), self.track.mesh)
        return self.body.face_points(self.face)

    @property
    def areas(self) -> Array:
        """Areas of the points [m²], shape (points,)."""
        return self.points.area

    @property
    def places(self) -> Array:
        """Places of the points [m], shape (points, 3)."""
        return self.points.place

    @cached_property
    def _laws(self) -> tuple[FrictionLaw, ...]:
        """The law of each point."""
        friction: Any = self.friction
        given = friction if isinstance(friction, tuple) else (friction,) * self.areas.size
        if self.friction_field is None or len(given) != self.areas.size:
            return given
        return self.friction_field.laws(given, self.places)

    @cached_property
    def contacts(self) -> tuple[PointContact, ...]:
        """The contacts of its points."""
        points, size = self.points, float(np.ptp(self.points.place, axis=0).max())
        gaps = self._gaps
        found = []
        for number, (place, area, normal) in enumerate(
            zip(points.place, points.area.tolist(), points.normal, strict=True)
        ):
            position, facing, gap = BEFORE[self.track.kind](self.track, self.track_face, place, normal, points)
            track = self.track if position is None else self.track.at(position)
            gap = gap if gaps is None else float(gaps[number])
            if facing @ normal > -FACING:
                got = f"an angle of {np.degrees(np.arccos(-facing @ normal)):.3g} degrees"
                raise ArgumentError(
                    "track", f"face the {self.face!r} of the body", got=f"{got} at {place_words(place)}"
                )
            if gap + self.gap < -OVERLAP * size:
                got = f"an overlap of {-gap - self.gap:.3g} m at {place_words(place)}"
                raise ArgumentError("gap", "leave the faces apart", self.gap, got=got)
            contact = PointContact(
                self.body.at(place.tolist()) if self.overlay else self.body.contact_point(self.face, number),
                track,
                **self._friction_of(number, place),
                gap=max(gap + self.gap, 0.0) + (0.0 if self.wear is None else self.wear[number]),
                normal=tuple(facing.tolist()),
                **self._directions(track, place, facing),
                stiffness=None if self.stiffness is None else per_area(self.stiffness, area),  # type: ignore[arg-type]
                tangential_stiffness=None if self.tangential_stiffness is None else area * self.tangential_stiffness,
                tangential_damping=area * self.tangential_damping,
                heating=None if self.heating is None else self.heating.of_part(area / float(self.areas.sum())),
                name=f"{self.name} {number + 1}",
                surface=self.name,
                area=area,
            )
            found.append(contact)
        if self.run_out is not None:
            return tuple(self._on_run_out(found))
        is_flat = self.track.kind != RigidTrack.kind or self.track.profile is None
        return tuple(found if is_flat else self._on_profile(found, self.track.profile))

    def _on_profile(self, contacts: list[PointContact], profile: Profile) -> list[PointContact]:
        """Return the contacts on a plane that is not flat, as near to it as to a flat one."""
        middle = self.areas @ self.places / self.areas.sum()
        along = [
            float(contact.frame[1] @ (place - middle)) for contact, place in zip(contacts, self.places, strict=True)
        ]
        gaps = np.array([contact.gap for contact in contacts])
        over = gaps - profile.height_at(np.array(along))
        over += gaps.min() - over.min()
        return [replace(one, at=at, gap=gap) for one, at, gap in zip(contacts, along, over.tolist(), strict=True)]

    def _friction_of(self, number: int, place: Array) -> dict[str, Any]:
        """Return the law of a point, and its place along the track if it depends on that, as arguments of a contact."""
        law = self._laws[number]
        if not law.depends_on_angle:
            return {"friction": law}
        axis, around = self._axis, cast("FrictionAroundTrack", law)
        assert axis is not None
        radius, angle = axis.around(place)
        if radius <= self._reach:
            return {"friction": around.at(angle)}
        return {"friction": around.around(radius, axis.sense), "at": axis.abscissa(radius, angle)}

    @cached_property
    def _reach(self) -> float:
        """Distance from its axis within which a point stays where it is [m]."""
        return ON_THE_AXIS * float(np.ptp(self.places, axis=0).max())

    def _on_run_out(self, contacts: list[PointContact]) -> list[PointContact]:
        """Return the contacts on a track that is not flat: its highest point touches where the flat one would."""
        run_out, axis = self.run_out, self._axis
        assert run_out is not None
        assert axis is not None
        found = []
        for contact, place in zip(contacts, self.places, strict=True):
            radius, angle = axis.around(place)
            profile = run_out.around(radius, axis.sense) if radius > self._reach else None
            low = max(run_out.highest - float(run_out.height_at(angle)), 0.0)
            found.append(replace(contact, gap=contact.gap + low, at=axis.abscissa(radius, angle), profile=profile))
        return found

    @cached_property
    def _axis(self) -> Axis | None:
        """The axis about which the track turns, None if it does not."""
        if self.turning is not None:
            direction, origin, speed = self.turning
            axial = np.array(direction)
            along = np.array([1.0, 0.0, 0.0] if abs(axial[0]) < ALONG_X else [0.0, 0.0, 1.0])
            first = along - (along @ axial) * axial
            first /= np.linalg.norm(first)
            return Axis(np.array(origin), first, np.cross(axial, first), math.copysign(1.0, speed))
        speed = getattr(self.track, "turning", 0.0)
        if not speed:
            return None
        first, second, _ = self.track.frame
        return Axis(np.array(self.track.origin), first, second, math.copysign(1.0, speed))

    @cached_property
    def _gaps(self) -> Array | None:
        """Mean gap of each patch [m], None where the gap at its centre is the same: in flat faces and for points."""
        patches = None if self.overlay else self.body.patches(self.face)
        if patches is None or self.track.kind == RigidTrack.kind:
            return None
        samples = patches.samples
        before = BEFORE[self.track.kind]
        found = [
            before(self.track, self.track_face, *one, samples)
            for one in zip(samples.place, samples.normal, strict=True)
        ]
        return patches.averaged(np.array([gap for *_, gap in found]))

    def _directions(self, track: Any, place: Array, facing: Array) -> dict[str, Any]:
        """Return the first tangent of a point and the velocity of the track along it, as arguments of its contact."""
        if self.tangent is not None:
            return {"tangent": tuple(self.tangent)}
        if self.turning is None:
            moved = getattr(track, "turning_velocity", np.zeros(3))
            return {"tangent": tuple(moved.tolist())} if moved.any() else {}
        axis, origin, speed = self.turning
        moved = speed * np.cross(axis, place - np.array(origin))
        size = float(np.linalg.norm(moved))
        if size <= ON_THE_AXIS * abs(speed) * float(np.ptp(self.points.place, axis=0).max()):
            return {}
        along = moved - (moved @ facing) * facing
        if np.linalg.norm(along) < ALONG * size:
            got = (
                f"an angle of {np.degrees(np.arccos(np.linalg.norm(along) / size)):.3g} degrees at {place_words(place)}"
            )
            raise ArgumentError("turning", "move the track along its surface", self.turning, got=got)
        # Flat faces of elements stand for the round surface, along which the track moves.
        return {"tangent": tuple(along.tolist()), "surface_velocity": (size, 0.0)}

    def _checked_turning(self, given: Any) -> tuple[tuple[float, ...], tuple[float, ...], float]:
        """Return a unit vector along the axis, its origin and the speed."""
        if self.track.kind != SolidBody.kind:
            raise ArgumentError("turning", "be left out except on a SolidBody: other tracks have their own", given)
        if self.tangent is not None:
            raise ArgumentError(
                "tangent", "be left out with turning, whose direction is the first tangent", self.tangent
            )
        if isinstance(given, str) or not isinstance(given, Sequence) or len(given) != 3:
            raise ArgumentError("turning", "be an axis, an origin and a speed", given)
        axis, origin = (Each(Number()).check(f"turning[{k}]", given[k]) for k in (0, 1))
        speed = finite("turning[2]", given[2])
        for number, one in enumerate((axis, origin)):
            if len(one) != 3:
                raise ArgumentError(f"turning[{number}]", "be three numbers", one)
        length = math.hypot(*axis)
        if not 0.0 < length < math.inf:
            raise ArgumentError("turning[0]", "be a direction, of a length above 0", axis)
        if speed == 0.0:
            raise ArgumentError("turning[2]", "not be 0", speed)
        return tuple(one / length for one in axis), origin, speed
