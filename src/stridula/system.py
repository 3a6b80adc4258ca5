"""Bodies, contacts, connections and drives as one system, checked for consistency."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, TypeVar

from .bodies import BodyPoint, FiniteElementBeam, ModalBeam, ModalPlate, ReducedBody, Track
from .checks import brief, instance
from .connections import Connection, Dashpot, Spring, ends
from .contact import PointContact, RigidTrack
from .drives import Drive, Gravity, ImposedVelocity, InitialEquilibrium, InitialState, InitialVelocity

T = TypeVar("T")


@dataclass(frozen=True)
class System:
    """Bodies in contact, what joins them and what drives them.

    Parameters
    ----------
    contact : PointContact or sequence of PointContact
        Where they touch. The first one names the slider (its tip's body) and the track.
    drives : sequence of Force, ImposedVelocity, Gravity, InitialVelocity, InitialState or InitialEquilibrium, optional
        What pushes, and how it starts.
    connections : sequence of Spring or Dashpot, optional
        What joins bodies for good.

    Raises
    ------
    ValueError
        If a drive acts on a body that is in no contact and no connection, if more than one velocity is imposed or more
        than one equilibrium asked for, or if a body is supported so that its root cannot follow an imposed velocity.
    """

    contact: PointContact | Sequence[PointContact]
    drives: Sequence[Drive] = ()
    connections: Sequence[Connection] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.contact, PointContact):
            object.__setattr__(self, "contact", _listed("contact", self.contact, (PointContact,)))
            if not self.contacts:
                raise ValueError("contact must hold at least one PointContact, got none")
        object.__setattr__(
            self,
            "drives",
            _listed("drives", self.drives, Drive.__args__),
        )
        object.__setattr__(self, "connections", _listed("connections", self.connections, (Spring, Dashpot)))
        self._check_names()
        for number, drive in enumerate(self.drives):
            self._check_body(f"drives[{number}]", drive)
        self._check_imposed()
        if len(self._of_kind(InitialEquilibrium)) > 1:
            raise ValueError(
                f"drives must hold at most one InitialEquilibrium, got {len(self._of_kind(InitialEquilibrium))}"
            )

    @cached_property
    def contacts(self) -> tuple[PointContact, ...]:
        """All contacts."""
        return (self.contact,) if isinstance(self.contact, PointContact) else tuple(self.contact)

    @cached_property
    def bodies(self) -> tuple[Any, ...]:
        """The bodies that vibrate: those of the contacts in turn, then those that only connections name."""
        found: list[Any] = []
        for contact in self.contacts:
            found += [contact.tip.body, contact.track_body]
        found += [point.body for connection in self.connections for point in ends(connection)]
        return tuple(dict.fromkeys(body for body in found if body is not None))

    @cached_property
    def kept(self) -> dict[str, Any]:
        """What has been made of the system, by whom: it never changes, and is asked for in several places."""
        return {}

    def __getstate__(self) -> dict[str, Any]:
        """Return what makes the system, for copies and other processes."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def slider(self) -> Any:
        """The body whose tip touches in the first contact."""
        return self.contacts[0].tip.body

    @property
    def track(self) -> Any:
        """What it slides on: a beam, a rigid track, or the body of the point it touches."""
        track = self.contacts[0].track
        return track.body if isinstance(track, BodyPoint) else track

    @cached_property
    def imposed_velocity(self) -> ImposedVelocity | None:
        """The imposed velocity, if there is one."""
        return next(iter(self._of_kind(ImposedVelocity)), None)

    @cached_property
    def initial_equilibrium(self) -> InitialEquilibrium | None:
        """The equilibrium in which it starts, if it does."""
        return next(iter(self._of_kind(InitialEquilibrium)), None)

    def is_held(self, body: object) -> bool:
        """Return whether a body's root follows an imposed velocity."""
        imposed = self.imposed_velocity
        return imposed is not None and imposed.point.body == body

    @cached_property
    def contact_names(self) -> tuple[str, ...]:
        """Names of the contacts: their own, or ``contact 1``, ``contact 2``, ..."""
        return tuple(contact.name or f"contact {number}" for number, contact in enumerate(self.contacts, 1))

    def body_name(self, body: Any) -> str:
        """Return what a body is called: its own name, slider or track, or ``body 3`` in the order of `bodies`."""
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
                raise ValueError(f"{words} must have different names, got {twice!r} twice")

    def _check_body(self, name: str, drive: Drive) -> None:
        body = getattr(drive, "body", None) or getattr(getattr(drive, "point", None), "body", None)
        if body is not None and body not in self.bodies:
            raise ValueError(f"{name} must act on a body of this system, got {brief(body)}")
        if isinstance(drive, InitialVelocity) and self.is_held(body) and drive.x:
            raise ValueError(
                f"{name}.x must be 0 under an imposed velocity, which already moves the slider, got {drive.x!r}"
            )
        if isinstance(drive, Gravity):
            for other in self.bodies:
                if isinstance(other, ReducedBody) and not other.has_translation:
                    raise ValueError(
                        f"{name} must act on bodies whose translation is known, got {self.body_name(other)!r} without"
                    )

    def _check_imposed(self) -> None:
        imposed = self._of_kind(ImposedVelocity)
        if len(imposed) > 1:
            raise ValueError(f"drives must hold at most one ImposedVelocity, got {len(imposed)}")
        for drive in imposed:
            beam: Any = drive.point.body
            if beam.root_support not in ("guided", "free"):
                raise ValueError(
                    "root_support must be guided or free under an imposed velocity, so that the root can move, "
                    f"got {beam.root_support!r}"
                )
            if beam.tip_support != "free":
                raise ValueError(f"tip_support must be free under an imposed velocity, got {beam.tip_support!r}")
            for number, connection in enumerate(self.connections):
                if connection.direction == "x" and any(point.body == beam for point in ends(connection)):
                    raise ValueError(
                        f"connections[{number}] must not act along x on a body under an imposed velocity, which "
                        "prescribes its x; got direction 'x'"
                    )

    def __str__(self) -> str:
        lines = [_body_line(self.body_name(body), body) for body in self.bodies]
        names = self.contact_names if len(self.contacts) > 1 else (self.contacts[0].name or "contact",)
        lines += [_contact_line(name, contact) for name, contact in zip(names, self.contacts, strict=True)]
        lines += [f"joined   {_connection_words(connection, self)}" for connection in self.connections]
        return "\n".join(lines + [f"drive    {_drive_words(drive)}" for drive in self.drives])


def _listed(name: str, given: Any, kinds: tuple[type, ...]) -> tuple[Any, ...]:
    words = {"contact": "a PointContact or a list of them"}.get(name, f"a list of {name}")
    if isinstance(given, (str, bytes)) or not isinstance(given, Sequence):
        raise ValueError(f"{name} must be {words}, got {brief(given)}")
    for number, entry in enumerate(given):
        instance(f"{name}[{number}]", entry, kinds)
    return tuple(given)


def _body_line(name: str, body: Any) -> str:
    modes = body.modes()
    length = f"{body.length:.4g} m, " if isinstance(body, (FiniteElementBeam, ModalBeam)) else ""
    if isinstance(body, ModalPlate):
        length = f"{body.length:.4g} m x {body.width:.4g} m x {body.thickness:.4g} m, "
    lean = f", leaning {math.degrees(body.angle):.4g} deg" if isinstance(body, FiniteElementBeam) else ""
    mass = f"{body.total_mass:.4g} kg" if math.isfinite(body.total_mass) else "given by matrices"
    damping = f", damping {modes.damping.max():.3g}" if modes.damping.any() else ""
    return f"{name:<8} {length}{mass}{lean}{damping}, {modes.count} modes to {modes.frequency.max():.4g} Hz"


def _contact_line(name: str, contact: PointContact) -> str:
    low, high = contact.track.ends if isinstance(contact.track, Track) else (0.0, 0.0)
    of = f" of {high - low:.4g} m" if high > low else ""
    kind = {RigidTrack: " on a rigid track", BodyPoint: " against a point"}.get(type(contact.track), "")
    lean = f", inclined {math.degrees(contact.inclination):.4g} deg" if contact.inclination else ""
    return f"{name:<8} at {contact.at:.4g} m{of}{kind}, gap {contact.gap:.3g} m, friction {contact.friction}{lean}"


def _connection_words(connection: Connection, system: System) -> str:
    names = [system.body_name(point.body) for point in ends(connection)]
    value = (
        f"spring {connection.stiffness:.4g} N/m"
        if isinstance(connection, Spring)
        else f"dashpot {connection.coefficient:.4g} N s/m"
    )
    return f"{value} along {connection.direction} from {names[0]} to {names[1] if len(names) > 1 else 'the ground'}"


def _drive_words(drive: Drive) -> str:
    if isinstance(drive, Gravity):
        return f"gravity {drive.acceleration:.4g} m/s² along -y"
    if isinstance(drive, InitialVelocity):
        return f"initial velocity ({drive.x:.3g}, {drive.y:.3g}) m/s"
    if isinstance(drive, InitialState):
        return "initial state of every degree of freedom"
    if isinstance(drive, InitialEquilibrium):
        number = drive.mode if isinstance(drive.mode, str) else f"number {drive.mode}"
        mode = "" if drive.mode is None else f", mode {number} on top by {drive.amplitude:.3g} m"
        return f"initial equilibrium{mode}"
    kind = type(drive.history).__name__.lower()
    if isinstance(drive, ImposedVelocity):
        return f"imposed velocity {drive.velocity:.4g} m/s along x under {drive.normal_load:.4g} N, {kind}"
    parts = [
        f"{name} {getattr(drive, name):.4g} N" for name in ("axial", "transverse", "x", "y") if getattr(drive, name)
    ]
    place = drive.point.position
    where = f"{place:.4g} m" if isinstance(place, float) else str(place)
    if isinstance(place, tuple):
        where = f"({place[0]:.4g}, {place[1]:.4g}) m"
    return f"force {', '.join(parts) or '0 N'} at {where}, {kind}"
