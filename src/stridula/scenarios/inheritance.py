"""Inheritance of scenario tables: from a base, and from values shared by all beams."""

from __future__ import annotations

from typing import Any

from .outline import PLATES, SHARED, SHARED_BY_CONTACTS, TAGS, Path, beams, contacts, look_up


def merged(below: Any, above: Any) -> Any:
    """Return `below` overridden by `above`: tables key by key, all other values replaced.

    A table of another kind (shape, law, kind) replaces the one below as a whole.
    """
    if not isinstance(below, dict) or not isinstance(above, dict):
        return above
    if any(tag in below and tag in above and below[tag] != above[tag] for tag in TAGS):
        return above
    joined = {key: merged(value, above[key]) if key in above else value for key, value in below.items()}
    return joined | {key: value for key, value in above.items() if key not in below}


def shared_out(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables with values shared by beams or contacts copied into each, and each friction with its law."""
    shared = {key: tables[key] for key in SHARED if key in tables}
    full = {key: value for key, value in tables.items() if key not in (*SHARED, *SHARED_BY_CONTACTS)}
    for path in beams(full):
        body = look_up(full, path)
        skipped = "section" if body.get("kind") in PLATES else None
        _replace(full, path, merged({key: value for key, value in shared.items() if key != skipped}, body))
    of_all = tables.get("friction")
    for contact in contacts(full):
        path = (*contact, "friction")
        own = look_up(full, path)
        friction = of_all if own is None else merged(of_all, own)
        if isinstance(friction, dict) and "law" not in friction:
            friction = {"law": "coulomb", **friction}
        if friction is not None:
            _replace(full, path, friction)
    return full


def spelled_out(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables with a bare ``friction = 1.5`` written as a table."""
    full = dict(tables)
    for holder in [(), *contacts(tables)]:
        path = (*holder, "friction")
        friction = look_up(full, path)
        if friction is not None and not isinstance(friction, dict):
            _replace(full, path, {"law": "coulomb", "coefficient": friction})
    return full


def _replace(tables: Any, path: Path, value: Any) -> None:
    """Set a value at a path of `tables` in place, copying the nested tables on the way."""
    for part in path[:-1]:
        tables[part] = tables[part].copy()
        tables = tables[part]
    tables[path[-1]] = value
