"""How scenario tables build on others: a base, and what both bodies share."""

from __future__ import annotations

from typing import Any

from .outline import SHARED, TAGS


def merged(below: Any, above: Any) -> Any:
    """Return `below` with what `above` says instead: tables key by key, all else replaced.

    A table of another kind (shape, law, kind) replaces the one below as a whole.
    """
    if not isinstance(below, dict) or not isinstance(above, dict):
        return above
    if any(tag in below and tag in above and below[tag] != above[tag] for tag in TAGS):
        return above
    joined = {key: merged(value, above[key]) if key in above else value for key, value in below.items()}
    return joined | {key: value for key, value in above.items() if key not in below}


def shared_out(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables with what both bodies share put into each of them."""
    shared = {key: tables[key] for key in SHARED if key in tables}
    bodies = {name: tables[name] for name in ("slider", "track") if isinstance(tables.get(name), dict)}
    rest = {key: value for key, value in tables.items() if key not in SHARED}
    return rest | {name: merged(shared, body) for name, body in bodies.items()}


def spelled_out(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables with a bare ``friction = 1.5`` written as a table."""
    contact = tables.get("contact")
    if not isinstance(contact, dict) or "friction" not in contact or isinstance(contact["friction"], dict):
        return tables
    friction = {"law": "coulomb", "coefficient": contact["friction"]}
    return tables | {"contact": contact | {"friction": friction}}
