"""Contact of a point of a body with a track, a rigid track or a point of another body."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

import numpy as np

from ..arrays import Array, in_space
from ..bodies import BodyPoint, CircularPath, ModalBeam, ModalPlate, Track, is_track
from ..bodies.turning import Turning
from ..checks import ArgumentError, brief, instance, within, within_a_turn
from ..declared import Angle, Distance, Each, Number, OneOrEach, Position, check_declared
from .along_track import Places
from .coulomb import Coulomb
from .elastic import ElasticFriction, check_in_series
from .friction_law import FrictionLaw
from .heating import Heating, check_heating
from .laws import check_friction
from .profile import Profile
from .rigid_track import RigidTrack
from .stiffness import ContactStiffness, checked_stiffness

# Largest sine or cosine of a right angle due to rounding.
ALONG_AN_AXIS = 1e-15
# Component along x above which a normal in space counts as along x.
ALONG_X = 0.9
# Largest normal share of the velocity of a turning surface that is due to rounding.
ALONG_SURFACE = 1e-9


@dataclass(frozen=True)
class PointContact:
    """Contact of the tip of a slider with a track: unilateral (rigid or compliant), with dry friction, no restitution.

    The normal force is compressive and never below zero; the tangential force is the force on the track along its
    tangent. On a beam, a plate or a rigid track the contact point moves along the track with the tip; against a
    point of another body it is fixed. On a circle of a body of revolution it moves with the travel of the tip along
    the first tangent, any number of times round; normal and tangents turn with it.

    Parameters
    ----------
    tip : BodyPoint
        The point of the slider that touches.
    track : ModalBeam, ModalPlate, RigidTrack, BodyPoint or CircularPath
        Track: a beam, a plate along its line, a rigid track, a point of another body, or a circle of a body of
        revolution.
    at : float, optional
        Abscissa of the tip on the track at the start [m]; strictly between the ends of a beam or of a plate's line.
    friction : FrictionLaw, optional
        Friction law, such as `Coulomb` or `Stribeck`; no friction if left out.
    gap : float, optional
        Distance between tip and track at the start [m].
    inclination : float, optional
        Angle from world x to the track's tangent, counter-clockwise [rad]; the normal, from the track to the tip, is
        the tangent turned by 90 degrees counter-clockwise. Zero on a beam or a plate.
    name : str, optional
        Name in records.
    normal : sequence of float, optional
        World components of the track's normal in space, from the track to the tip, of any length; if left out, in the
        plane of x and y by `inclination`.
    tangent : sequence of float, optional
        World components of the first tangent in space; world x, or z if the normal is along x, if left out. Its
        component along the normal is removed. The second tangent is the first times the normal. Must be left out on a
        circle, whose direction is the first tangent; on a beam or a plate the normal as well, as they follow its axes.
    surface_velocity : float or sequence of float, optional
        Velocity of the surface of a touched point's body under the tip [m/s], such as that of a disc that turns about
        its axis while its vibration is described in a frame at rest: along the tangent, in space along both.
    stiffness : float, LinearStiffness, PowerStiffness or HertzStiffness, optional
        Contact stiffness, a number in N/m; rigid if left out.
    tangential_stiffness : float, optional
        Stiffness along the tangents [N/m], in series with the friction: the contact deforms before it slips. Rigid if
        left out. For laws without an internal state that hold no more at rest than in the slowest sliding.
    tangential_damping : float, optional
        Damping along the tangents [N s/m], beside this stiffness.
    surface : str, optional
        Name of the surface that it is a point of; some points of a surface may be open in equilibrium.
    area : float, optional
        Area that it represents, as a point of a surface or under friction that depends on the pressure [m²]; unknown
        if left out.
    heating : HeatedLayers or TemperatureHistory, optional
        Temperature of the contact, on which its friction may depend: heat of friction in layers, or a given history.
    profile : Profile, optional
        Height of the surface of the touched body, towards the tip, over the place along its first tangent, in its
        material: the run-out of a disc that turns, the corrugation of a rail. The tip starts at the place `at`. Flat
        if left out; a `RigidTrack` has its own.

    Notes
    -----
    A contact of a body in space has two tangents: friction is a force in their plane, opposite to the slip.
    """

    tip: BodyPoint
    track: Track | RigidTrack | BodyPoint
    at: Position = 0.0
    friction: FrictionLaw = field(default_factory=lambda: Coulomb(0.0))
    gap: Distance = 0.0
    inclination: Angle = 0.0
    name: str = ""
    normal: Annotated[Sequence[float], Each(Number())] | None = None
    tangent: Annotated[Sequence[float], Each(Number())] | None = None
    surface_velocity: Annotated[float | Sequence[float], OneOrEach(Number("m/s"))] = 0.0
    stiffness: ContactStiffness | float | None = None
    tangential_stiffness: Annotated[float, Number("N/m", above=0.0)] | None = None
    tangential_damping: Annotated[float, Number("N s/m", least=0.0)] = 0.0
    surface: str = ""
    area: Annotated[float, Number("m2", least=0.0)] = 0.0
    heating: Heating | None = None
    profile: Profile | None = None

    def __post_init__(self) -> None:
        instance("tip", self.tip, BodyPoint)
        if self.path_body is None:
            instance("track", self.track, (ModalBeam, ModalPlate, RigidTrack, BodyPoint))
        if self.path_body is not None:
            within("at", self.at, *self.path_body.ends, ends=False)
            if self.inclination != 0.0:
                raise ArgumentError("inclination", f"be 0 on a {type(self.track).__name__}", self.inclination)
        check_declared(self)
        if self.track_body == self.tip.body:
            body = brief(self.tip.body)
            raise ArgumentError(
                "track", "be a body other than the tip's (equal bodies need names)", self.track, got=f"{body} for both"
            )
        check_friction("friction", self.friction)
        within_a_turn("inclination", self.inclination)
        for word in ("name", "surface"):
            instance(word, getattr(self, word), str)
        if self.area and not (self.surface or self.friction.depends_on_pressure):
            words = "be left out except at a point of a surface, or under friction that depends on the pressure"
            raise ArgumentError("area", words, self.area)
        if self.friction.depends_on_pressure and not self.area:
            raise ArgumentError("area", "be given under friction that depends on the pressure", self.area)
        check_heating(self.heating, self.friction.depends_on_temperature)
        self._check_place()
        if self.profile is not None:
            instance("profile", self.profile, Profile)
            if self.rigid_track is not None:
                raise ArgumentError("profile", "be left out on a rigid track, which has its own", self.profile)
        object.__setattr__(self, "stiffness", checked_stiffness(self.stiffness))
        if self.tangential_stiffness is not None:
            check_in_series(self.friction, self.tangential_stiffness)
        elif self.tangential_damping:
            raise ArgumentError("tangential_damping", "be 0 without a tangential_stiffness", self.tangential_damping)
        self._check_directions()

    def _check_place(self) -> None:
        """Raise if friction depends on a place along a track that has none, or on a temperature as well."""
        if self.friction.depends_on_angle:
            words = "not depend on the angle except under a face: use law.around(radius), which is along the track"
            raise ArgumentError("friction", words, self.friction, got=str(self.friction))
        if not self.friction.depends_on_place:
            return
        if self.heating is not None:
            raise ArgumentError("heating", "be left out under friction that depends on the place", self.heating)

    def _check_directions(self) -> None:
        for name in ("normal", "tangent"):
            given = getattr(self, name)
            if given is None:
                continue
            if len(given) != 3 or not any(given):
                raise ArgumentError(name, "be three numbers, not all zero", given)
            if not self.is_spatial:
                raise ArgumentError(name, "be left out between bodies in the plane: use inclination", given)
            if self.path_body is not None:
                raise ArgumentError(name, "be left out on a beam or a plate, whose axes it takes", given)
        self._check_surface()
        self._check_circle()
        self._check_turning()
        if self.normal is not None and self.inclination:
            raise ArgumentError("inclination", "be 0 where a normal is given", self.inclination)
        if self.tangent is not None and np.linalg.norm(np.cross(*self.frame[:2])) < 0.5:
            raise ArgumentError("tangent", "not lie along the normal", self.tangent)
        if self.is_spatial:
            return
        for name, across in (
            ("track.lateral_velocity", self.rigid_track.lateral_velocity if self.rigid_track else 0.0),
            ("friction.initial_state[1]", self.friction.states_at_start[1]),
        ):
            if across:
                raise ArgumentError(name, "be 0 under a body in the plane", across)

    def _check_turning(self) -> None:
        for name, point in (("tip", self.tip), ("track", self.touched_point)):
            velocity = np.zeros(3) if point is None else point.turning_velocity
            if not velocity.any():
                continue
            if name == "track" and np.any(self.surface_velocity):
                raise ArgumentError("surface_velocity", "be 0 against a body that turns", self.surface_velocity)
            if abs(float(self.frame[0] @ velocity)) > ALONG_SURFACE * float(np.linalg.norm(velocity)):
                words = f"be at right angles to the velocity at which the body of the {name} turns"
                raise ArgumentError("normal", words, self.normal)

    def _check_circle(self) -> None:
        if self.circle is None:
            return
        if self.tangent is not None:
            raise ArgumentError(
                "tangent", "be left out on a circle, whose direction is the first tangent", self.tangent
            )
        if abs(float(self._normal_in_space @ self.circle.direction(self.at))) > ALONG_SURFACE:
            raise ArgumentError("normal", "be at right angles to the circle at the start", self.normal)
        if self.tip.turning_velocity.any():
            raise ArgumentError("tip", "be on a body that does not turn, on a circle", self.tip)

    def _check_surface(self) -> None:
        given = np.atleast_1d(self.surface_velocity)
        if (self.touched_point is None or self.circle is not None) and given.any():
            words = "be 0 except against a point of a body: tracks have velocities of their own"
            raise ArgumentError("surface_velocity", words, self.surface_velocity)
        if given.size > (2 if self.is_spatial else 1):
            words = "be one number, or two in space, one for each tangent"
            raise ArgumentError("surface_velocity", words, self.surface_velocity)

    @property
    def contacts(self) -> tuple[PointContact]:
        """The contact itself, as a tuple."""
        return (self,)

    @property
    def surface_velocities(self) -> tuple[float, float]:
        """Velocities of the touched surface along both tangents [m/s]."""
        first, *others = np.atleast_1d(self.surface_velocity).tolist()
        return first, others[0] if others else 0.0

    @property
    def turning_velocities(self) -> tuple[tuple[Turning, Array], ...]:
        """Turning of each body that turns, and the velocity of the track past the tip that it causes [m/s]."""
        found = []
        for point, sign in ((self.tip, -1.0), (self.touched_point, 1.0)):
            if point is not None and point.turning_velocity.any():
                turning = point.body.modes().turning
                assert turning is not None
                found.append((turning, sign * self.frame[1:] @ point.turning_velocity[: len(self.frame)]))
        return tuple(found)

    @property
    def yields(self) -> ContactStiffness | None:
        """Contact stiffness, None if it is rigid."""
        found: ContactStiffness | None = self.stiffness  # type: ignore[assignment]
        return found

    @cached_property
    def law(self) -> FrictionLaw:
        """The law that acts at the start: its friction, in series with its tangential stiffness if it has one."""
        law = self.friction.on(self.area)
        return self._with_joint(law if self.acts_at is None else law.at(float(self.acts_at.start[0])))

    @property
    def acts_at(self) -> Heating | Places | None:
        """Its temperature, or its place along the track, at which its law acts; None without either."""
        return Places(self.friction, self.at) if self.friction.depends_on_place else self.heating

    @property
    def friction_words(self) -> str:
        """Its friction, with its tangential stiffness, and its heating, in words."""
        law = self._with_joint(self.friction.on(self.area))
        return f"friction {law}" + ("" if self.heating is None else f", heating {self.heating}")

    @property
    def layers_of_heat(self) -> tuple[str, int] | None:
        """Kind of its heating and number of layers, None without a temperature or a place at which its law acts."""
        return None if self.acts_at is None else (self.acts_at.kind, self.acts_at.layers)

    @property
    def laws_at_values(self) -> tuple[tuple[float, FrictionLaw], ...]:
        """Temperatures [degC] or places [m] at which its friction is given, and the law at each; none without any."""
        found = self.friction.on(self.area).at_values
        return tuple((value, self._with_joint(law)) for value, law in found)

    def _with_joint(self, law: FrictionLaw) -> FrictionLaw:
        """Return a law in series with the tangential stiffness, if there is one."""
        if self.tangential_stiffness is None:
            return law
        return ElasticFriction(law, self.tangential_stiffness, self.tangential_damping)

    @property
    def is_spatial(self) -> bool:
        """Whether one of the bodies is in space, so that there are two tangents."""
        return self.tip.body.is_spatial or getattr(self.track_body, "is_spatial", False)

    @property
    def has_state_vector(self) -> bool:
        """Whether the internal state of its friction law has a component along each of two tangents."""
        return self.is_spatial and self.law.state_is_vector

    @property
    def relief(self) -> Profile | None:
        """The profile of the surface on which it slides, None if that is flat."""
        return self.profile if self.rigid_track is None else self.rigid_track.profile

    @property
    def rigid_track(self) -> RigidTrack | None:
        """The track if it is rigid."""
        return self.track if isinstance(self.track, RigidTrack) else None

    def reaches(self, place: float) -> bool:
        """Return whether a tip at an abscissa [m] is on its track; rigid tracks and points have no ends."""
        if self.path_body is None:
            return True
        low, high = self.path_body.ends
        return bool(low < place < high)

    @property
    def placed_end(self) -> BodyPoint | None:
        """The end with a known world place, the tip first; None if there is none."""
        ends = (self.tip, self.touched_point)
        return next((one for one in ends if one is not None and one.place is not None), None)

    @property
    def touched_point(self) -> BodyPoint | None:
        """The point that the tip touches, on a circle the one at the start; None if the tip moves along a track."""
        if self.circle is not None:
            return self.circle.point_at(self.at)
        return self.track if isinstance(self.track, BodyPoint) else None

    @property
    def circle(self) -> CircularPath | None:
        """The circle along which the tip moves, None on any other track."""
        return getattr(self.track, "circle", None)

    @cached_property
    def path_body(self) -> Track | None:
        """The body along which the tip moves, None on a rigid track and against a point."""
        return self.track if is_track(self.track) else None

    @property
    def track_body(self) -> object | None:
        """The body on the track's side, None for a rigid track."""
        return self.path_body or (self.touched_point and self.touched_point.body)

    @cached_property
    def frame(self) -> Array:
        """World components of the track's normal and tangent, shape (2, 2); in space with both tangents, (3, 3)."""
        axes = self._frame_in_space if self.is_spatial else self._plane_frame
        axes.flags.writeable = False
        return axes

    @property
    def _normal_in_space(self) -> Array:
        if self.path_body is not None:
            return in_space(self.path_body.axes[1])
        normal = np.append(self._plane_frame[0], 0.0) if self.normal is None else np.array(self.normal, dtype=float)
        return np.asarray(normal / np.linalg.norm(normal))

    @property
    def _frame_in_space(self) -> Array:
        normal = self._normal_in_space
        along = np.append(self._plane_frame[1], 0.0) if self.normal is None else np.array([1.0, 0.0, 0.0])
        if self.normal is not None and abs(normal[0]) > ALONG_X:
            along = np.array([0.0, 0.0, 1.0])
        if self.tangent is not None:
            along = np.array(self.tangent, dtype=float)
        if self.circle is not None:
            along = self.circle.direction(self.at)
        if self.path_body is not None:
            along = in_space(self.path_body.axes[0])
        tangent = along - (along @ normal) * normal
        size = np.linalg.norm(tangent)
        tangent = tangent / size if size > ALONG_AN_AXIS * np.linalg.norm(along) else normal
        axes = np.stack([normal, tangent, np.cross(tangent, normal)])
        return np.where(np.abs(axes) < ALONG_AN_AXIS, 0.0, axes)

    @property
    def _plane_frame(self) -> Array:
        sine, cosine = math.sin(self.inclination), math.cos(self.inclination)
        axes = np.array([[-sine, cosine], [cosine, sine]])
        # Exact zeros where the track lies along an axis.
        return np.where(np.abs(axes) < ALONG_AN_AXIS, 0.0, axes)
