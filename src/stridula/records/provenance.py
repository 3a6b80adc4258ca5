"""A system and its simulation written back in the words of a scenario file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from numbers import Integral, Real
from typing import Any

import tomli_w

from ..bodies import BodyPoint, FiniteElementBeam
from ..drives import Drive, Force, ImposedVelocity, InitialVelocity
from ..system import System
from .probes import Probe, Reaction


def scenario_toml(system: System, probes: Sequence[Probe], simulation: dict[str, Any]) -> str:
    """Return the scenario as TOML, in the words that `stridula run` reads."""
    contact = system.contact
    tables = {
        "slider": _body(system.slider),
        "track": _body(system.track),
        "contact": {
            "at": _value(contact.at),
            "gap": _value(contact.gap),
            "point": _point(contact.tip),
            "friction": {"law": "coulomb", "coefficient": _value(contact.friction.coefficient)},
        },
        "drives": [_drive(drive, system) for drive in system.drives],
        "simulation": {**simulation, "probes": [_probe(probe, system) for probe in probes]},
    }
    return tomli_w.dumps(tables)


def _plain(record: Any, *skipped: str) -> dict[str, Any]:
    """Return the plain fields of a dataclass that hold a value."""
    pairs = ((f.name, getattr(record, f.name)) for f in fields(record) if f.name not in skipped)
    return {name: _value(value) for name, value in pairs if value is not None}


def _value(value: Any) -> Any:
    """Return a value that TOML can write: NumPy's numbers as Python's."""
    if isinstance(value, tuple):
        return [_value(entry) for entry in value]
    if isinstance(value, Integral):
        return int(value)
    return float(value) if isinstance(value, Real) else value


def _body(body: Any) -> dict[str, Any]:
    section = {"shape": type(body.section).__name__.lower(), **_plain(body.section)}
    if section["shape"] == "section":
        section["shape"] = "general"
    return {**_plain(body, "material", "section"), "material": _plain(body.material), "section": section}


def _point(point: BodyPoint) -> str | float:
    body: Any = point.body
    named = {"tip": 0.0, "root": body.length} if isinstance(body, FiniteElementBeam) else {"centre": body.length / 2.0}
    return next((name for name, position in named.items() if position == point.position), _value(point.position))


def _body_name(body: object, system: System) -> str:
    return "slider" if body == system.slider else "track"


def _drive(drive: Drive, system: System) -> dict[str, Any]:
    kinds = {"Force": "force", "ImposedVelocity": "imposed velocity", "Gravity": "gravity"}
    table: dict[str, Any] = {"kind": kinds.get(type(drive).__name__, "initial velocity")}
    if isinstance(drive, Force):
        table |= {"body": _body_name(drive.point.body, system), "point": _point(drive.point)}
    if isinstance(drive, InitialVelocity):
        table["body"] = _body_name(drive.body, system)
    table |= _plain(drive, "point", "body", "history")
    if isinstance(drive, (Force, ImposedVelocity)):
        table["history"] = {"kind": type(drive.history).__name__.lower(), **_plain(drive.history)}
    return table


def _probe(probe: Probe, system: System) -> dict[str, Any]:
    if isinstance(probe, Reaction):
        return {"quantity": "reaction", "direction": probe.component}
    return {
        "quantity": type(probe).__name__.lower(),
        "body": _body_name(probe.point.body, system),
        "point": _point(probe.point),
        "direction": probe.direction,
    }
