"""Bodies, contacts, connections and drives as one system, checked for consistency."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from .checks import ArgumentError, counted, instance, listed
from .connections import CONNECTIONS, Connection, ends
from .contact import PointContact, SurfaceContact, SurfacePoints
from .contact.surface_points import surfaces_among
from .doubtful import doubts_of_gap, warn_of
from .drives import DRIVES, Drive, ImposedVelocity, InitialEquilibrium
from .system_card import CLOSED, card_of, connection_words, lines_of
from .system_connections import check_connections

T = TypeVar("T")
PLACES = (PointContact, SurfaceContact)


@dataclass(frozen=True, repr=False)
class System:
    """Bodies in contact, with their connections and drives.

    Parameters
    ----------
    contact : PointContact, SurfaceContact or sequence of these
        Contacts between the bodies. The first one defines the slider (its tip's body) and the track.
    drives : sequence of Force, ImposedVelocity, Gravity, InitialVelocity, InitialState or InitialEquilibrium, optional
        Loads, prescribed motion and initial conditions.
    connections : sequence of Spring, Dashpot, Bushing, RigidJoint or another connection, optional
        Springs, dashpots, mounts and joints between bodies.

    Raises
    ------
    ValueError
        If a drive acts on a body that is in no contact and no connection, if there is more than one imposed velocity or
        initial equilibrium, or if the supports of a body keep its root from following an imposed velocity.
    """

    contact: PointContact | SurfaceContact | Sequence[PointContact | SurfaceContact]
    drives: Sequence[Drive] = ()
    connections: Sequence[Connection] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.contact, PLACES):
            object.__setattr__(self, "contact", _listed("contact", self.contact, PLACES))
            if not self.contacts:
                raise ArgumentError("contact", "hold at least one PointContact", self.contact, got="none")
        object.__setattr__(self, "drives", _listed("drives", self.drives, DRIVES))
        object.__setattr__(self, "connections", _listed("connections", self.connections, CONNECTIONS))
        self._check_names()
        for number, drive in enumerate(self.drives):
            self._check_body(f"drives[{number}]", drive)
        self._check_imposed()
        check_connections(self)
        if len(self._of_kind(InitialEquilibrium)) > 1:
            raise ArgumentError(
                "drives", "hold at most one InitialEquilibrium", self.drives, got=len(self._of_kind(InitialEquilibrium))
            )
        warn_of(self.doubts)

    @cached_property
    def contacts(self) -> tuple[PointContact, ...]:
        """All contacts; those of surfaces point by point."""
        given = (self.contact,) if isinstance(self.contact, PLACES) else tuple(self.contact)
        return tuple(point for one in given for point in one.contacts)

    @cached_property
    def faces(self) -> tuple[SurfaceContact | SurfacePoints, ...]:
        """Surfaces with known places and areas of all points: those given as surfaces, then those of points."""
        given = (self.contact,) if isinstance(self.contact, PLACES) else tuple(self.contact)
        whole: list[Any] = [one for one in given if hasattr(one, "areas")]
        alone: list[Any] = [one for one in given if not hasattr(one, "areas")]
        return (*whole, *surfaces_among(alone))

    @property
    def doubts(self) -> list[str]:
        """Doubts about the gaps of its surfaces, each with the name of the surface."""
        found = []
        for face in self.faces:
            gap = min(one.gap for one in face.contacts)
            # Places of points are needed only with a gap, and finding them takes longer.
            size = float(np.ptp(face.places, axis=0).max()) if gap > 0.0 else 0.0
            found += [f"{face.name}: {words}" for words in doubts_of_gap(gap, size)]
        return found

    @cached_property
    def bodies(self) -> tuple[Any, ...]:
        """Bodies that vibrate: those of the contacts in order, then those that only connections name."""
        found: list[Any] = []
        for contact in self.contacts:
            found += [contact.tip.body, contact.track_body]
        found += [point.body for connection in self.connections for point in ends(connection)]
        return tuple(dict.fromkeys(body for body in found if body is not None))

    @property
    def is_spatial(self) -> bool:
        """Whether any of the bodies is in space."""
        return any(body.is_spatial for body in self.bodies)

    @property
    def has_two_tangents(self) -> bool:
        """Whether any of the contacts is that of a body in space."""
        return any(contact.is_spatial for contact in self.contacts)

    @property
    def has_state_vectors(self) -> bool:
        """Whether the internal state of a law has components along two tangents."""
        return any(contact.has_state_vector for contact in self.contacts)

    @cached_property
    def kept(self) -> dict[str, Any]:
        """Cache of results derived from the system, by the function that made them; systems never change."""
        return {}

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields alone, for copies and other processes."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def slider(self) -> Any:
        """The body whose tip touches in the first contact."""
        return self.contacts[0].tip.body

    @property
    def track(self) -> Any:
        """Track of the slider: a beam, a rigid track, or the body of the point it touches."""
        first = self.contacts[0]
        return first.track if first.touched_point is None else first.touched_point.body

    @cached_property
    def imposed_velocity(self) -> ImposedVelocity | None:
        """The imposed velocity, if there is one."""
        return next(iter(self._of_kind(ImposedVelocity)), None)

    @cached_property
    def initial_equilibrium(self) -> InitialEquilibrium | None:
        """The equilibrium in which it starts, if there is one."""
        return next(iter(self._of_kind(InitialEquilibrium)), None)

    def is_held(self, body: object) -> bool:
        """Return whether the root of a body follows an imposed velocity."""
        imposed = self.imposed_velocity
        return imposed is not None and imposed.point.body == body

    @cached_property
    def contact_names(self) -> tuple[str, ...]:
        """Names of the contacts: their own, or ``contact 1``, ``contact 2``, ..."""
        return tuple(contact.name or f"contact {number}" for number, contact in enumerate(self.contacts, 1))

    @cached_property
    def surface_names(self) -> tuple[str, ...]:
        """Name of the surface of each contact, empty for none; an empty tuple for one contact or without surfaces."""
        names = tuple(contact.surface for contact in self.contacts)
        return names if len(names) > 1 and any(names) else ()

    def body_name(self, body: Any) -> str:
        """Return the name of a body: its own, slider or track, or ``body 3`` in the order of `bodies`.

        Raises
        ------
        ValueError
            If it is not a body of the system.
        """
        if not any(body is one for one in self.bodies) and body not in self.bodies:
            names = listed(self.body_name(one) for one in self.bodies)
            raise ArgumentError("body", f"be a body of the system ({names})", body)
        if body.name:
            return str(body.name)
        if body == self.slider:
            return "slider"
        if body == self.track:
            return "track"
        return f"body {self.bodies.index(body) + 1}"

    def _of_kind(self, kind: type[T]) -> list[T]:
        return [drive for drive in self.drives if isinstance(drive, kind)]

    def _check_names(self) -> None:
        for words, names in (
            ("contacts", self.contact_names),
            ("bodies", [self.body_name(body) for body in self.bodies]),
        ):
            twice = next((name for name in names if list(names).count(name) > 1), None)
            if twice is not None:
                raise ArgumentError(words, "have different names", twice, got=f"{twice!r} twice")

    def _check_body(self, name: str, drive: Drive) -> None:
        body, moved = drive.acted_on, drive.uniform_velocity
        if body is not None and body not in self.bodies:
            raise ArgumentError(name, "act on a body of this system", body)
        if moved is not None and self.is_held(body) and moved[0]:
            words = "be 0 under an imposed velocity, which already moves the slider"
            raise ArgumentError(f"{name}.x", words, float(moved[0]))
        if drive.fall is not None:
            for other in self.bodies:
                if not other.has_translation:
                    raise ArgumentError(
                        name,
                        "act on bodies whose translation is known",
                        self.body_name(other),
                        got=f"{self.body_name(other)!r} without",
                    )

    def _check_imposed(self) -> None:
        imposed = self._of_kind(ImposedVelocity)
        if len(imposed) > 1:
            raise ArgumentError("drives", "hold at most one ImposedVelocity", got=len(imposed))
        for drive in imposed:
            beam: Any = drive.point.body
            if beam.root_support not in ("guided", "free"):
                raise ArgumentError(
                    "root_support",
                    "be guided or free under an imposed velocity, so that the root can move",
                    beam.root_support,
                )
            if beam.tip_support != "free":
                raise ArgumentError("tip_support", "be free under an imposed velocity", beam.tip_support)

    def _repr_html_(self) -> str:
        """Return a card with a drawing of its bodies and a list of its parts, without a long search for modes."""
        return card_of(self)

    def __repr__(self) -> str:
        """Return a line for each body, surface and other part, without a search for modes."""
        return lines_of(self)

    def __str__(self) -> str:
        lines = [_body_line(self.body_name(body), body) for body in self.bodies]
        names = self.contact_names if len(self.contacts) > 1 else (self.contacts[0].name or "contact",)
        surfaces: dict[str, list[PointContact]] = {}
        for name, contact in zip(names, self.contacts, strict=True):
            surfaces.setdefault(contact.surface or name, []).append(contact)
        lines += [_contact_line(name, *contacts) for name, contacts in surfaces.items()]
        lines += [f"joined   {connection_words(connection, self)}" for connection in self.connections]
        return "\n".join(lines + [f"drive    {drive}" for drive in self.drives])


def _listed(name: str, given: Any, kinds: tuple[type, ...]) -> tuple[Any, ...]:
    words = {"contact": "a PointContact or a list of them"}.get(name, f"a list of {name}")
    if isinstance(given, (str, bytes)) or not isinstance(given, Sequence):
        raise ArgumentError(name, f"be {words}", given)
    for number, entry in enumerate(given):
        instance(f"{name}[{number}]", entry, kinds)
    return tuple(given)


def _body_line(name: str, body: Any) -> str:
    modes = body.modes()
    length = f"{body.dimensions}, " if body.dimensions else ""
    lean = f", {body.posture}" if body.posture else ""
    mass = f"{body.total_mass:.4g} kg" if math.isfinite(body.total_mass) else "given by matrices"
    damping = f", damping {modes.damping.max():.3g}" if modes.damping.any() else ""
    frequency, residual = modes.frequency[~modes.massless], int(modes.massless.sum())
    more = f" and {residual} residual shapes" if residual else ""
    return f"{name:<8} {length}{mass}{lean}{damping}, {frequency.size} modes to {frequency.max():.4g} Hz{more}"


def _contact_line(name: str, contact: PointContact, *others: PointContact) -> str:
    if contact.surface:
        gaps = [one.gap if abs(one.gap) > CLOSED else 0.0 for one in (contact, *others)]
        ends = dict.fromkeys(f"{gap:.3g}" for gap in (min(gaps), max(gaps)))
        return f"{name:<8} {counted(len(gaps), 'point')}, gap {' to '.join(ends)} m, {contact.friction_words}"
    kind = f" on {contact.rigid_track.words}" if contact.rigid_track else " against a point"
    if contact.circle is not None:
        kind = f" of a circle of {contact.circle.length:.4g} m"
    if contact.path_body is not None:
        low, high = contact.path_body.ends
        kind = f" of {high - low:.4g} m"
    lean = f", inclined {math.degrees(contact.inclination):.4g} deg" if contact.inclination else ""
    return f"{name:<8} at {contact.at:.4g} m{kind}, gap {contact.gap:.3g} m, {contact.friction_words}{lean}"
