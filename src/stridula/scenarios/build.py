"""Build a system, the dataclasses of the Python API, from checked tables."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import MISSING, replace
from functools import partial
from pathlib import Path
from typing import Any

from .. import connections, drives, histories
from ..bodies import (
    AxisymmetricBody,
    BodyPoint,
    FiniteElementBeam,
    Line,
    Material,
    ModalBeam,
    ModalBody,
    ModalPlate,
    PointMass,
    ReducedBody,
    RigidBody,
    SolidBody,
    has_root,
)
from ..bodies.body_surfaces import surface_of
from ..bodies.damping import DAMPING_LAWS
from ..bodies.drawn_surfaces import drawn_of
from ..bodies.sections import SECTIONS
from ..bodies.turning import Turning
from ..checks import ArgumentError, brief, listed, suggestion
from ..contact import (
    HEATINGS,
    LAWS,
    STIFFNESSES,
    FrictionField,
    PointContact,
    Profile,
    RigidTrack,
    RunOut,
    SurfaceContact,
)
from ..declared import declared
from ..disk import is_there
from ..drives import Drive
from ..integration import GaussSeidel
from ..ordinary import NotOrdinary
from ..records import Probe, probes
from ..system import System
from .build_layers import layer_of
from .build_meshed import axisymmetric_body, solid_body
from .errors import ScenarioError
from .quantities import quantity
from .read import FILES
from .schema import JOINING, TOUCHING

OF_SPACE: dict[str, Callable[..., Any]] = {one.kind: one for one in (RigidBody, ModalBody)}
MESHED: dict[str, Callable[..., Any]] = {AxisymmetricBody.kind: axisymmetric_body, SolidBody.kind: solid_body}
SHAPES: dict[str, Callable[..., Any]] = {section.shape: section for section in SECTIONS}
DAMPINGS: dict[str, Callable[..., Any]] = {law.form: law for law in DAMPING_LAWS}
HISTORIES: dict[str, Callable[..., Any]] = {history.kind: history for history in histories.HISTORIES}
DRIVES: dict[str, type[Drive]] = {drive.kind: drive for drive in drives.DRIVES}
PROBES = {probe.quantity: probe for probe in probes.PROBES}
FRICTIONS: dict[str, Callable[..., Any]] = {law.law: law for law in LAWS}
HEATED: dict[str, Callable[..., Any]] = {kind.kind: kind for kind in HEATINGS}
STIFFNESS: dict[str, Callable[..., Any]] = {kind.kind: kind for kind in STIFFNESSES}
OVER_SURFACE: dict[str, Callable[..., Any]] = {"profile": Profile, "run_out": RunOut, "friction_field": FrictionField}
CONNECTIONS: dict[str, Callable[..., Any]] = {connection.kind: connection for connection in connections.CONNECTIONS}
Tables = dict[str, Any]
Place = tuple[str | int, ...]
# Representation of a value left out because of another problem.
NOTHING = repr(None)
# Arguments that are keys of a table, or a pair of them.
_KEY = re.compile(r"[a-z_]\w*(?:\.\w+|\[(?:\d+|'[^']*')\])*(?: and \w+)?")
_ENTRY = re.compile(r"\[(?:(\d+)|'([^']*)')\]")


class Builder:
    """Builder of a system and its probes from tables, which collects every problem on the way.

    Parameters
    ----------
    tables : dict
        A checked scenario.
    words : callable
        Turns a path into the key as it was written.
    """

    def __init__(self, tables: Tables, words: Callable[[Place], str]) -> None:
        self.tables, self.words = tables, words
        self.problems: list[str] = []
        self.places: dict[str, Place] = {"slider": ("slider",), "track": ("track",)}
        self.bodies: dict[str, Any] = {}

    def system(self, check: Callable[[System], None] | None = None) -> System:
        """Return the system, after a further check of it, if given, before the modes of its bodies are computed."""
        if "bodies" in self.tables:
            contacts, connections = self._general()
        else:
            contacts, connections = [self._pair()], []
        drives = [self._drive(number, table) for number, table in enumerate(self.tables["drives"])]
        self._stop_at_problems()
        with self._within():
            system = System(contacts[0] if len(contacts) == 1 else contacts, drives, connections)
        self._stop_at_problems()
        if check is not None:
            check(system)
        for name, body in self.bodies.items():
            if has_root(body) or body.kind in MESHED:
                with self._within(*self.places.get(name, ("bodies", name))):
                    body.modes(system.is_held(body))
        self._stop_at_problems()
        return system

    def probes(self, system: System) -> tuple[Probe, ...] | None:
        """Return the probes, None for the default ones."""
        tables = self.tables["simulation"].get("probes")
        if tables is None:
            return None
        built = tuple(self._probe(number, dict(table), system) for number, table in enumerate(tables))
        self._stop_at_problems()
        return built

    def contact_solve(self) -> GaussSeidel | None:
        """Return the solver of several contacts, None for the default."""
        table = self.tables["simulation"].get("contact_solve")
        if table is None:
            return None
        solve = None
        with self._within("simulation", "contact_solve"):
            solve = GaussSeidel(**table)
        self._stop_at_problems()
        return solve

    def _pair(self) -> Any:
        slider = self._beam(("slider",), FiniteElementBeam, self.tables["slider"])
        track = self._beam(("track",), ModalBeam, self.tables["track"])
        self._stop_at_problems()
        self.bodies = {"slider": slider, "track": track} | {body.name: body for body in (slider, track) if body.name}
        for body, place in ((slider, "slider"), (track, "track")):
            self.places |= {body.name: (place,)} if body.name else {}
        table = dict(self.tables["contact"])
        given = self._of_contact(("contact",), table)
        tip = self._point(("contact", "point"), slider, table.pop("point", "tip"))
        with self._within("contact"):
            return PointContact(tip, track, **given, **table)

    def _general(self) -> tuple[list[Any], list[Any]]:
        tables: dict[str, Tables] = self.tables["bodies"]
        self.places = {name: ("bodies", name) for name in tables}
        used = self._check_used()
        self._stop_at_problems()
        built = {name: self._body(name, dict(table), used) for name, table in tables.items()}
        self._stop_at_problems()
        bodies = list(built.values())
        # Equal bodies are distinguished by their names in the file.
        built = {k: replace(b, name=k) if not b.name and bodies.count(b) > 1 else b for k, b in built.items()}
        aliases = {body.name: name for name, body in built.items() if body.name}
        aliases |= {"slider": used[0]}
        if self._first_track.get("body"):
            aliases |= {"track": self._first_track["body"]}
        self.bodies = {alias: built[name] for alias, name in aliases.items()} | built
        self.places = {alias: ("bodies", name) for alias, name in aliases.items()} | self.places
        contacts = [
            self._contact(number, dict(table)) for number, table in enumerate(self.tables.get("contacts") or [])
        ]
        contacts += [
            self._surface(number, dict(table)) for number, table in enumerate(self.tables.get("surfaces") or [])
        ]
        joined = self.tables.get("connections") or []
        connections = [self._connection(number, dict(table)) for number, table in enumerate(joined)]
        for number, table in enumerate(self.tables.get("layers") or []):
            connections += self._layer(("layers", number), table)
        return contacts, connections

    def _check_used(self) -> list[str]:
        """Return the names of the bodies in the order in which contacts, connections and layers name them."""
        named: dict[Place, str] = {}
        for path, contact in self._touching():
            tip: Place = ("tip",) if "tip" in contact else ()
            named[(*path, *tip, "body")] = contact.get("tip", contact)["body"]
            if contact["track"]["kind"] != "rigid":
                named[(*path, "track", "body")] = contact["track"]["body"]
        for key in JOINING:
            for number, joining in enumerate(self.tables.get(key) or []):
                for end in ("first", "second"):
                    if joining.get(end) is not None:
                        named[(key, number, end, "body")] = joining[end]["body"]
        bodies = self.tables["bodies"]
        for path, name in named.items():
            if name not in bodies:
                self.problems.append(_unknown(self.words(path), name, list(bodies)))
        for name in bodies:
            if name not in named.values():
                self.problems.append(
                    f"{self.words(('bodies', name))} must be in a contact, a connection or a layer, got none of them"
                )
        return list(dict.fromkeys(named.values()))

    def _touching(self) -> Iterator[tuple[Place, Tables]]:
        """Yield the tables of contacts, then those of surfaces."""
        for key in TOUCHING:
            for number, table in enumerate(self.tables.get(key) or []):
                yield (key, number), table

    @property
    def _first_track(self) -> Tables:
        """The table of the first track."""
        return dict(next(self._touching())[1]["track"])

    def _body(self, name: str, table: Tables, used: list[str]) -> Any:
        path = ("bodies", name)
        kind = table.pop("kind")
        table |= _damping(table)
        table["name"] = table.get("name") or ("" if name == self._default_name(name, used) else name)
        if kind == "point mass":
            with self._within(*path):
                return PointMass(**table)
            return None
        if table.get("turning_history") is not None:
            table["turning_history"] = self._history((*path, "turning_history"), table["turning_history"])
        if isinstance(table.get("turning"), dict):
            table["turning"] = self._turning((*path, "turning"), dict(table["turning"]))
        if isinstance(table.get("outer_surface"), dict):
            with self._within(*path):
                table["outer_surface"] = surface_of(table["outer_surface"])
        if isinstance(table.get("drawn"), dict):
            with self._within(*path):
                table["drawn"] = drawn_of(table["drawn"], len(table["angular_frequency"]) + (table["residual"] or 0))
        if kind in OF_SPACE:
            with self._within(*path):
                return OF_SPACE[kind](**{name: value for name, value in table.items() if value is not None})
            return None
        if kind in MESHED:
            return MESHED[kind](table, partial(self._within, *path))
        if kind == "reduced":
            return self._reduced(path, table)
        if kind == "modal plate":
            return self._plate(path, table)
        return self._beam(path, FiniteElementBeam if kind == "finite-element beam" else ModalBeam, table)

    def _default_name(self, name: str, used: list[str]) -> str:
        """Return the default name of a body without its own, so that records can leave it unnamed."""
        if name == used[0]:
            return "slider"
        return "track" if name == self._first_track.get("body") else f"body {used.index(name) + 1}"

    def _reduced(self, path: Place, table: Tables) -> Any:
        files = {key: table[key] for key in FILES if isinstance(table.get(key), str)}
        for key, file in files.items():
            if is_there(file) and not Path(file).is_file():
                self.problems.append(f"{self.words((*path, key))} must be a file, got {brief(file)}")
                return None
        for key in ("residual_flexibility", "labels", "mesh"):
            if table.get(key) is None:
                table.pop(key, None)
        with self._within(*path):
            if "file" in table or {"mass", "stiffness"} & set(files):
                container = table.pop("file", None)
                return ReducedBody.read(container, **table)
            for key, words in (("mass", "mass matrix"), ("stiffness", "stiffness matrix"), ("points", "its points")):
                if table.get(key) is None:
                    raise ArgumentError(key, f"be given: {words}, unless a file has it")
            for key in ("labels", "mesh"):
                if key in table:
                    raise ArgumentError(key, "be left out where matrices are written out", table[key])
            return ReducedBody(**table)

    def _beam(self, path: Place, kind: Callable[..., Any], given: Tables) -> Any:
        table = given | _damping(given)
        section = dict(table.pop("section"))
        shape: Any = None
        material: Any = None
        with self._within(*path, "section"):
            shape = SHAPES[section.pop("shape")](**section)
        with self._within(*path, "material"):
            material = Material(**table.pop("material"))
        with self._within(*path):
            return kind(material, shape, **table)

    def _plate(self, path: Place, table: Tables) -> Any:
        material: Any = None
        with self._within(*path, "material"):
            material = Material(**table.pop("material"))
        if table.get("line") is not None:
            with self._within(*path, "line"):
                table["line"] = Line(**table["line"])
            if not isinstance(table["line"], Line):
                return None
        with self._within(*path):
            return ModalPlate(material, **table)

    def _of_contact(self, path: Place, table: Tables) -> dict[str, Any]:
        """Remove friction, stiffness, heating and what varies over the surface from a table, and return them built."""
        heated = table.get("heating") is not None
        found = self._friction(path, table) | self._of_kind("stiffness", STIFFNESS, path, table)
        found |= self._of_kind("heating", HEATED, path, table)
        for name in OVER_SURFACE:
            given = table.pop(name, None)
            if given is not None:
                found[name] = self._over_surface((*path, name), given)
        if heated and "heating" not in found:
            # Friction would ask for the heating, whose problem is known.
            found.pop("friction", None)
        return found

    def _friction(self, path: Place, table: Tables) -> dict[str, Any]:
        """Remove the friction from the table of a contact, and return it built."""
        given = dict(table.pop("friction", None) or {})
        if not given:
            return {}
        with self._within(*path, "friction"):
            if given.get("laws"):
                given["laws"] = [self._law((*path, "friction", "laws", k), one) for k, one in enumerate(given["laws"])]
            return {"friction": made_or_read(FRICTIONS[given.pop("law")], given)}
        return {}

    def _law(self, path: Place, table: Tables) -> Any:
        """Return one of several laws of a friction."""
        with self._within(*path):
            return made_or_read(FRICTIONS[table["law"]], {key: value for key, value in table.items() if key != "law"})
        return None

    def _of_kind(self, name: str, kinds: dict[str, Callable[..., Any]], path: Place, table: Tables) -> dict[str, Any]:
        """Remove a stiffness or a heating from the table of a contact, and return it built, or the number given."""
        given = table.pop(name, None)
        if not isinstance(given, dict):
            return {} if given is None else {name: given}
        values = {key: value for key, value in given.items() if key != "kind" and value is not None}
        with self._within(*path, name):
            return {name: kinds[given["kind"]](**values)}
        return {}

    def _contact(self, number: int, table: Tables) -> Any:
        path = ("contacts", number)
        given = self._of_contact(path, table)
        tip = self._place((*path, "tip"), table.pop("tip"))
        track = self._track((*path, "track"), dict(table.pop("track")))
        with self._within(*path):
            return PointContact(tip, track, **given, **table)

    def _surface(self, number: int, table: Tables) -> Any:
        path = ("surfaces", number)
        given = self._of_contact(path, table)
        body = self._body_of_kind((*path, "body"), table.pop("body"), SolidBody.kind)
        track = dict(table.pop("track"))
        kind, face = track["kind"], track.pop("face", "")
        if kind == RigidTrack.kind:
            met = self._track((*path, "track"), track)
        else:
            met = self._body_of_kind((*path, "track", "body"), track["body"], kind)
        if body is None or met is None:
            return None
        if track.get("turning") is not None:
            axis, origin = track.get("axis", (0.0, 0.0, 1.0)), track.get("origin", (0.0, 0.0, 0.0))
            given["turning"] = (axis, origin, track["turning"])
        with self._within(*path):
            try:
                return SurfaceContact(body, table.pop("face"), met, face, **given, **table)
            except ArgumentError as error:
                raise (error.renamed("track.face") if error.argument == "track_face" else error) from None

    def _body_of_kind(self, path: Place, name: str, kind: str) -> Any:
        """Return the body with this name, or None and record a problem if it is of another kind."""
        body = self.bodies[name]
        if body.kind == kind:
            return body
        self.problems.append(f"{self.words(path)} must be a body of the kind {kind}, got {brief(name)}")
        return None

    def _track(self, path: Place, table: Tables) -> Any:
        kind = table.pop("kind")
        if kind == "point":
            return self._place(path, table)
        if kind == "circle":
            return self._circle(path, table)
        if kind != RigidTrack.kind:
            body = self.bodies[table["body"]]
            if body.kind != f"modal {kind}":
                self.problems.append(
                    f"{self.words((*path, 'body'))} must be a modal {kind}, got {brief(table['body'])}"
                )
            return body
        for name in ("history", "normal_history"):
            if table.get(name) is not None:
                table[name] = self._history((*path, name), table[name])
        if table.get("profile") is not None:
            table["profile"] = self._over_surface((*path, "profile"), table["profile"])
        with self._within(*path):
            return RigidTrack(**{name: value for name, value in table.items() if value is not None})

    def _over_surface(self, path: Place, table: Tables) -> Any:
        with self._within(*path):
            return made_or_read(OVER_SURFACE[str(path[-1])], table)
        return None

    def _circle(self, path: Place, table: Tables) -> Any:
        body = self.bodies[table["body"]]
        if not hasattr(body, "circle"):
            problem = f"must be a body of revolution, got {brief(table['body'])}"
            self.problems.append(f"{self.words((*path, 'body'))} {problem}")
            return None
        history = table.get("history")
        if history is not None:
            history = self._history((*path, "history"), history)
        with self._within(*path):
            try:
                return body.circle(table["point"], table.get("velocity", 0.0), history)
            except ArgumentError as error:
                raise (error.renamed("point") if error.argument == "position" else error) from None
        return None

    def _place(self, path: Place, table: Tables) -> Any:
        return self._point((*path, "point"), self.bodies[table["body"]], table.get("point"), "tip")

    def _connection(self, number: int, table: Tables) -> Any:
        path = ("connections", number)
        kind = table.pop("kind")
        first = self._place((*path, "first"), table.pop("first"))
        second = table.pop("second", None)
        other = None if second is None else self._place((*path, "second"), second)
        if table.get("history") is not None:
            table["history"] = self._history((*path, "history"), table["history"])
        else:
            table.pop("history", None)
        with self._within(*path):
            return made_or_read(CONNECTIONS[kind], table, first, other)

    def _layer(self, path: Place, table: Tables) -> list[Any]:
        ends = [end for end in ("first", "second") if table.get(end) is not None]
        bodies = [self._body_of_kind((*path, end, "body"), table[end]["body"], SolidBody.kind) for end in ends]
        if None in bodies:
            return []
        with self._within(*path):
            return layer_of(table, *bodies)
        return []

    def _drive(self, number: int, table: Tables) -> Any:
        path = ("drives", number)
        table = dict(table)
        made: Callable[..., Drive] = DRIVES[table["kind"]]
        place = DRIVES[table.pop("kind")].place
        body = self._named_body((*path, "body"), table.pop("body", "slider")) if place else None
        if table.get("history") is not None:
            table["history"] = self._history((*path, "history"), table["history"])
        where = self._acted_on(path, place, body, table)
        with self._within(*path):
            return made(*where, **table)

    def _acted_on(self, path: Place, place: str, body: Any, table: Tables) -> tuple[Any, ...]:
        """Return the point or body that a drive acts on, its first argument; nothing if it acts on the whole system."""
        if place == "point":
            return (self._point((*path, "point"), body, table.pop("point", None), "root"),)
        if place == "root":
            return (self._root(path, body),)
        return (body,) if place else ()

    def _root(self, path: Place, body: Any) -> Any:
        if not has_root(body):
            self.problems.append(f"{self.words((*path, 'body'))} must be a finite-element beam, whose root is driven")
            return None
        return body.root

    def _turning(self, path: Place, table: Tables) -> Turning | None:
        history = table.pop("history", None)
        with self._within(*path):
            if history is not None:
                table["history"] = self._history((*path, "history"), history)
            return Turning(**table)
        return None

    def _history(self, path: Place, table: Tables) -> Any:
        values = {name: value for name, value in table.items() if name != "kind"}
        with self._within(*path):
            return HISTORIES[table["kind"]](**values)

    def _probe(self, number: int, table: Tables, system: System) -> Any:
        path = ("simulation", "probes", number)
        made = PROBES[table.pop("quantity")]
        on = self._probed(path, made.on, table, system)
        with self._within(*path):
            return made.from_table(on, **table)

    def _probed(self, path: Place, on: str, table: Tables, system: System) -> Any:
        """Return the body, the point or the connection that a probe is on, its first argument."""
        if on == "slider":
            return system.slider
        if on == "connection":
            number, count = table.pop("connection"), len(system.connections)
            if number >= count:
                allowed = (
                    f"be a number from 0 to {count - 1}" if count else "be that of a connection, and there are none"
                )
                self.problems.append(f"{self.words((*path, 'connection'))} must {allowed}, got {number}")
            return system.connections[number] if number < count else None
        name = table.pop("body", None) or ("track" if "track" in self.bodies else "slider")
        body = self._named_body((*path, "body"), name)
        return self._point((*path, "point"), body, table.pop("point", None), "tip") if on == "point" else body

    def _named_body(self, path: Place, name: str) -> Any:
        if name not in self.bodies:
            self.problems.append(_unknown(self.words(path), name, list(self.bodies)))
        return self.bodies.get(name)

    def _point(self, path: Place, body: Any, place: Any, end: str = "") -> Any:
        """Return a point of a body; by default the `end` of a slider, the centre or the only point."""
        if body is None:
            return None
        names = body.point_names
        if place is None and not names:
            self.problems.append(f"{self.words(path)} must be given: a position, as the body has no named points")
            return None
        if place is None and len(names) > 1 and body.has_positions:
            place = end if end in names else names[0]
        if place is None and len(names) == 1:
            place = names[0]
        if place in names:
            point: BodyPoint = getattr(body, str(place)) if body.has_positions else BodyPoint(body, str(place))
            return point
        if body.has_positions or (place is not None and body.kind == SolidBody.kind):
            return self._between(path, body, place)
        if place is None:
            self.problems.append(f"{self.words(path)} must be given: one of {listed(names)}")
        else:
            self.problems.append(_unknown(self.words(path), place, names))
        return None

    def _between(self, path: Place, body: Any, place: Any) -> Any:
        """Return a point between the named ones."""
        key = self.words(path)
        try:
            is_place = isinstance(place, tuple) or not body.has_positions
            return body.at(place if is_place else quantity(place, "m"))
        except ArgumentError as error:
            if error.argument == "position":
                self.problems.append(str(error.renamed(key)))
            else:
                words = " or ".join([*body.point_names, "a position"])
                self.problems.append(f"{key} must be {words}, got {brief(place)}")
        return None

    @contextmanager
    def _within(self, *path: str | int) -> Iterator[None]:
        """Record a ValueError as a problem under its full key, unless it results from an earlier problem."""
        known = len(self.problems)
        try:
            yield
        except (OverflowError, ZeroDivisionError, NotOrdinary):
            self.problems.append(out_of_range(self.words(path)))
        except (ValueError, OSError) as error:
            follows = isinstance(error, ArgumentError) and error.got == NOTHING
            if len(self.problems) == known and not follows:
                self.problems.append(self._named(path, error))

    def _named(self, path: Place, error: ValueError | OSError) -> str:
        if not isinstance(error, ArgumentError) or error.where or not _KEY.fullmatch(error.argument):
            return f"{self.words(path)}: {error}" if path else str(error)
        entry = _ENTRY.sub(lambda found: f".{found[1] or found[2]}", error.argument)
        argument = "file" if entry == "path" else entry
        if argument in ("root_support", "tip_support") and not path:
            driven: Tables = next((drive for drive in self.tables["drives"] if drive["kind"] == "imposed velocity"), {})
            path = self.places.get(driven.get("body", "slider"), ("slider",))
        return str(error.renamed(self.words((*path, *argument.split(".")))))

    def _stop_at_problems(self) -> None:
        if self.problems:
            raise ScenarioError(self.problems)


def made_or_read(kind: Any, table: Tables, *ends: Any) -> Any:
    """Return a value of a kind from its table, or from the file that the table names."""
    if not hasattr(kind, "read"):
        return kind(*ends, **table)
    given = {name: value for name, value in table.items() if value is not None}
    needed = [field.name for field in declared(kind) if field.default is MISSING]
    if "file" in given:
        for name in needed:
            if name in given:
                raise ArgumentError("file", f"be left out with {name}", given["file"])
        return kind.read(given.pop("file"), *ends, **given)
    of_files = [name for name in given if name == "columns" or name.endswith("_unit")]
    if of_files:
        raise ArgumentError(of_files[0], "be left out without a file", given[of_files[0]])
    for name in needed:
        if name not in given:
            raise ArgumentError(name, "be given, unless a file has it", got="nothing")
    return kind(*ends, **given)


def out_of_range(key: str) -> str:
    """Return the problem of a table whose modes overflow floating-point numbers."""
    return f"{key or 'scenario'} must hold numbers of ordinary size: its modes overflow"


def _damping(table: Tables) -> Tables:
    """Return the damping law of a body's table, built; nothing if the damping is not a law."""
    given = table.get("damping")
    if not isinstance(given, dict):
        return {}
    return {"damping": DAMPINGS[given["form"]](**{key: value for key, value in given.items() if key != "form"})}


def _unknown(key: str, name: Any, known: Any) -> str:
    return f"{key} must be one of {listed(known)}, got {brief(name)}{suggestion(name, list(known))}"
