"""Conversion of a system and its simulation to the text of a scenario file."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from numbers import Integral, Real
from typing import Any

import numpy as np
import tomli_w

from ..arrays import Array
from ..bodies import AxisymmetricBody, BodyPoint, FiniteElementBeam, ModalBeam, ModalBody
from ..bodies.damping import is_damping_law
from ..bodies.drawn_surfaces import drawn_table
from ..bodies.turning import Turning
from ..connections import Connection, ends
from ..contact import PointContact
from ..drives import Drive
from ..histories import Constant
from ..system import System
from .packed import LONGEST_LIST, PACKED, packed
from .probes import Probe

# Largest size of the surface of a body that a record keeps for films [bytes].
LARGEST_DRAWN = 20_000_000
# Fields of bodies that are converted before they are written to tables.
WRITTEN_APART = ("material", "section", "points", "faces", "turning", "velocities", "circles", "drawn", "places")
# Placeholder of a packed array while the rest is written. It has a character that no text of a scenario has.
_ASIDE = "\ue000packed array "
_PUT_ASIDE = re.compile(f'"{_ASIDE}(\\d+)"')
# A list written by tomli_w, one number on a line; texts are on one line each and never match.
_LIST_OF_NUMBERS = re.compile(r"\[\n((?:\s*[-+.\dinfaeE]+,\n)+)\s*\]")


def scenario_toml(system: System, probes: Sequence[Probe], simulation: dict[str, Any]) -> str:
    """Return the scenario as TOML, as read by `stridula run`.

    A beam on a beam is written as slider, track and contact; any other system lists its bodies, contacts and
    connections. Small matrices are lists of rows, large ones lossless text.
    """
    return toml(scenario_tables(system, probes, simulation))


def scenario_tables(system: System, probes: Sequence[Probe], simulation: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of the same scenario, in plain types."""
    probed = [probe.point for probe in probes if hasattr(probe, "point")]
    tables = _pair(system) if is_pair(system) else _general(system, probed)
    tables["drives"] = [_drive(drive, system) for drive in system.drives]
    tables["simulation"] = {**_value(simulation), "probes": [_probe(probe, system) for probe in probes]}
    return tables


def toml(tables: Mapping[str, Any]) -> str:
    """Return tables as TOML, lists of numbers on one line."""
    # Packed arrays need no escaping, for which tomli_w would check every character.
    arrays: list[str] = []
    text = _LIST_OF_NUMBERS.sub(_on_one_line, tomli_w.dumps(_without_arrays(tables, arrays)))
    return _PUT_ASIDE.sub(lambda found: f'"{arrays[int(found[1])]}"', text)


def _without_arrays(value: Any, arrays: list[str]) -> Any:
    """Return tables with placeholders for the packed arrays, which are appended to `arrays`."""
    if isinstance(value, Mapping):
        return {key: _without_arrays(one, arrays) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_arrays(one, arrays) for one in value]
    if not isinstance(value, str) or not PACKED.fullmatch(value):
        return value
    arrays.append(value)
    return f"{_ASIDE}{len(arrays) - 1}"


def _on_one_line(found: re.Match[str]) -> str:
    return f"[{' '.join(found[1].split()).rstrip(',')}]"


def is_pair(system: System) -> bool:
    """Return whether a system is just a finite-element beam that slides on a modal beam."""
    return (
        len(system.contacts) == 1
        and not system.connections
        and system.slider.kind == FiniteElementBeam.kind
        and system.track.kind == ModalBeam.kind
        and system.contacts[0].touched_point is None
    )


def _pair(system: System) -> dict[str, Any]:
    contact = system.contacts[0]
    return {
        "slider": _body(system.slider),
        "track": _body(system.track),
        "contact": {**_contact(contact), "point": _point(contact.tip)},
    }


def _general(system: System, probed: Sequence[BodyPoint]) -> dict[str, Any]:
    def place(point: BodyPoint) -> dict[str, Any]:
        return {"body": system.body_name(point.body), "point": _point(point)}

    def track(contact: PointContact) -> dict[str, Any]:
        rigid, touched, body = contact.rigid_track, contact.touched_point, contact.path_body
        if rigid is not None:
            return {"kind": rigid.kind, **_plain(rigid, "history", "normal_history"), **_histories(rigid)}
        if body is not None:
            return {"kind": body.kind.removeprefix("modal "), "body": system.body_name(body)}
        if contact.circle is not None:
            circle = contact.circle
            velocity = {"velocity": circle.velocity, **_histories(circle)} if circle.velocity else {}
            return {"kind": "circle", **place(touched or circle), **velocity}
        return {"kind": "point", **(place(touched) if touched is not None else {})}

    tables: dict[str, Any] = {
        "bodies": {system.body_name(body): _general_body(body, system, probed) for body in system.bodies},
        "contacts": [
            {**_contact(contact), "tip": place(contact.tip), "track": track(contact)} for contact in system.contacts
        ],
    }
    if system.connections:
        tables["connections"] = [
            {
                "kind": connection.kind,
                **_plain(connection, "first", "second", *_unmoved(connection)),
                **_histories(connection),
                "first": place(connection.first),
                **({"second": place(connection.second)} if connection.second is not None else {}),
            }
            for connection in system.connections
        ]
    return tables


def _unmoved(connection: Connection) -> tuple[str, ...]:
    """Return the fields of a connection to leave out: its history, written separately, and others without effect."""
    # Only linear ones have an offset or a velocity that a history moves: others have it in their table.
    return ("history",) if connection.moved_by or connection.bend is not None else ("history", "offset", "velocity")


def _contact(contact: PointContact) -> dict[str, Any]:
    given = {"at": _value(contact.at), "gap": _value(contact.gap)}
    joint = ("tangential_stiffness", "tangential_damping")
    for name in ("inclination", "name", "normal", "tangent", "surface_velocity", "surface", "area", *joint):
        if getattr(contact, name):
            given[name] = _value(getattr(contact, name))
    if contact.profile is not None:
        given["profile"] = _plain(contact.profile)
    if contact.heating is not None:
        given["heating"] = {"kind": contact.heating.kind, **_plain(contact.heating)}
    if contact.yields is not None:
        given["stiffness"] = {"kind": contact.yields.kind, **_plain(contact.yields)}
    return {**given, "friction": {"law": contact.friction.law, **_plain(contact.friction)}}


def _histories(record: Any) -> dict[str, Any]:
    """Return the histories of a record that are not constant."""
    found = {}
    for name in ("history", "normal_history"):
        history = getattr(record, name, None)
        if history is not None and history.kind != Constant.kind:
            found[name] = _history(history)
    return found


def _history(history: Any) -> dict[str, Any]:
    return {"kind": history.kind, **_plain(history)}


def _plain(record: Any, *skipped: str) -> dict[str, Any]:
    """Return the plain fields of a dataclass that hold a value, without an empty name."""
    pairs = ((f.name, getattr(record, f.name)) for f in fields(record) if f.name not in skipped)
    return {name: _value(value) for name, value in pairs if value is not None and (name, value) != ("name", "")}


def _value(value: Any) -> Any:
    """Return a value for TOML: NumPy's numbers as Python's, arrays as lists or packed."""
    if isinstance(value, np.ndarray):
        return value.tolist() if value.size <= LONGEST_LIST else packed(value)
    if isinstance(value, (tuple, list)):
        return [_value(entry) for entry in value]
    if isinstance(value, Mapping):
        return {name: _value(entry) for name, entry in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        law, form = getattr(value, "law", None), value.form if is_damping_law(value) else None
        tags = {name: word for name, word in (("law", law), ("form", form)) if word is not None}
        return tags | _plain(value)
    if isinstance(value, bool):
        return value
    if isinstance(value, Integral):
        return int(value)
    return float(value) if isinstance(value, Real) else value


def _body(body: Any) -> dict[str, Any]:
    given = _plain(body, *WRITTEN_APART)
    if hasattr(body, "material"):
        given["material"] = _plain(body.material)
    if hasattr(body, "points"):
        places = body.kind == "rigid body"
        given["points"] = {name: _value(rows) if places else _rows(rows) for name, rows in body.points.items()}
    if getattr(body, "turning", None) is not None:
        velocities = {name: body.turning_velocity(name) for name in body.points}
        given |= {"turning": _turning_table(body.turning), "velocities": _value(velocities)}
    if getattr(body, "circles", None):
        given["circles"] = _value({name: circle.tolist() for name, circle in body.circles.items()})
    if getattr(body, "is_drawn", False):
        given |= _drawn(body)
    if getattr(body, "places", None):
        given["places"] = _value(body.places)
    if not hasattr(body, "section"):
        return given
    return {**given, "section": {"shape": body.section.shape, **_plain(body.section)}}


def body_table(body: Any) -> dict[str, Any]:
    """Return the table of a body in a scenario of bodies and contacts."""
    return {"kind": body.kind, **_body(body)}


def mesh_tables(body: Any) -> dict[str, Any]:
    """Return the profile or the mesh of a body with all its cells or elements, as in the table of the body."""
    if body.kind == AxisymmetricBody.kind:
        return {"profile": {"shape": "cells", **_cells(body.profile, "nodes", "cells", "regions", "edges")}}
    return {"mesh": {"shape": "elements", **_cells(body.mesh, *(field.name for field in fields(body.mesh)))}}


def _cells(mesh: Any, *names: str) -> dict[str, Any]:
    given = {name: getattr(mesh, name) for name in names}
    return {name: _value(one) for name, one in given.items() if one is not None}


def _general_body(body: Any, system: System, probed: Sequence[BodyPoint]) -> dict[str, Any]:
    """Return the table of a body, without its name if it equals the default name of the table."""
    circles = [contact for contact in system.contacts if contact.circle is not None and contact.circle.body == body]
    points = [*_points_in(system), *probed]
    given = _modes_table(body, points, circles) if _is_meshed(body) else body_table(body)
    if body.name != _default_name(body, system):
        given.pop("name", None)
    return given


def _is_meshed(body: Any) -> bool:
    """Return whether a body has a mesh, or faces of one; it is written as its modes."""
    return hasattr(body, "mesh") or (bool(getattr(body, "faces", {})) and body.modes().damping_matrix is None)


def _modes_table(body: Any, points: Sequence[BodyPoint], circles: Sequence[PointContact] = ()) -> dict[str, Any]:
    """Return the table of a body by its modes, with the points in use."""
    modes = body.modes()
    held = ~modes.massless
    # Turns -0.0 into 0.0, as in the body that is read back.
    rows = {point.label: body.trace(point.position) + 0.0 for point in points if point.body == body}
    return {
        "kind": ModalBody.kind,
        "angular_frequency": _value(modes.angular_frequency[held]),
        "damping_rate": _value(modes.damping_rate[held]),
        **({"outer_surface": _value(body.surface())} if getattr(body, "has_surface", False) else {}),
        "points": {name: _value(one) for name, one in rows.items()},
        "translation": _value(modes.translation + 0.0),
        "residual": int(modes.massless.sum()),
        **_turning(
            body.waves_round if circles else modes.turning,
            {point.label: point for point in points if point.body == body},
        ),
        **_circles(circles),
        **_drawn(body),
        "places": _places([point for point in points if point.body == body]),
        "name": body.name,
    }


def _places(points: Sequence[BodyPoint]) -> dict[str, Any]:
    """Return the places of points where they are known."""
    known = {point.label: point.place for point in points}
    return {name: _value(place) for name, place in known.items() if place is not None}


def _drawn(body: Any) -> dict[str, Any]:
    """Return the surface of a body for drawing, nothing without one or if it is too large."""
    if not hasattr(body, "drawn"):
        return {}
    arrays = drawn_table(body.drawn)
    if sum(array.nbytes for array in arrays.values()) > LARGEST_DRAWN:
        return {}
    return {"drawn": {name: _value(array) for name, array in arrays.items()}}


def _circles(contacts: Sequence[PointContact]) -> dict[str, Any]:
    """Return the circles along which contacts move, by the points where they start; nothing without any."""
    found = {}
    for contact in contacts:
        circle, start = contact.circle, contact.touched_point
        if circle is not None and start is not None:
            found[start.label] = _value([circle.radius, contact.at, *circle.direction(contact.at).tolist()])
    return {"circles": found} if found else {}


def _turning(turning: Turning | None, points: dict[str, BodyPoint]) -> dict[str, Any]:
    """Return the turning of a body and the velocities of its material at points; nothing if it does not turn."""
    if turning is None:
        return {}
    velocities = {name: _value(point.turning_velocity + 0.0) for name, point in points.items()}
    return {"turning": _turning_table(turning), "velocities": velocities}


def _turning_table(turning: Turning) -> dict[str, Any]:
    table = _plain(turning, "history")
    if turning.history.kind != Constant.kind:
        table["history"] = _history(turning.history)
    return table


def _points_in(system: System) -> list[BodyPoint]:
    """Return the points of bodies at contacts, connections and drives."""
    found = [contact.tip for contact in system.contacts]
    found += [contact.touched_point for contact in system.contacts if contact.touched_point is not None]
    found += [point for connection in system.connections for point in ends(connection)]
    return found + [drive.push[1] for drive in system.drives if drive.push is not None]


def _default_name(body: Any, system: System) -> str:
    """Return the name of a body by default."""
    if body == system.slider:
        return "slider"
    return "track" if body == system.track else f"body {system.bodies.index(body) + 1}"


def _rows(rows: Array) -> Any:
    """Return the rows of a point, or the numbers of its degrees of freedom if these are equivalent."""
    chosen = {axis: np.flatnonzero(row) for axis, row in zip("xyz"[: len(rows)], rows, strict=True)}
    if (len(rows) == 2 or chosen["z"].size) and all(
        found.size == 0 or (found.size == 1 and rows[k, found[0]] == 1.0) for k, found in enumerate(chosen.values())
    ):
        return {axis: int(found[0]) for axis, found in chosen.items() if found.size}
    return _value(rows)


def _point(point: BodyPoint) -> Any:
    if _is_meshed(point.body):
        return point.label
    return _value(point.position) if point.point_name is None else point.point_name


def _drive(drive: Drive, system: System) -> dict[str, Any]:
    table: dict[str, Any] = {"kind": drive.kind}
    body = drive.acted_on
    if body is not None and (drive.place != "root" or body != system.slider):
        table["body"] = system.body_name(body)
    if drive.push is not None and drive.place == "point":
        table["point"] = _point(drive.push[1])
    table |= _plain(drive, "point", "body", "history", *drive.vectors)
    table |= {name: _value(np.array(values)) for name, values in drive.vectors.items()}
    if hasattr(drive, "history"):
        table["history"] = _history(drive.history)
    return table


def _probe(probe: Probe, system: System) -> dict[str, Any]:
    return {
        "quantity": probe.quantity,
        **probe.named_in(system),
        **{key: _value(value) for key, value in probe.keys.items()},
    }
