"""What acts on the tracks of a record, from its scenario: contacts along them, and everything else."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import xarray as xr

from .changes import played

START = "initial equilibrium"
COMPONENTS = ("axial", "transverse", "x", "y", "z")
# Components of a force that bend a track in the plane.
BENDING = ("transverse", "y")


@dataclass(frozen=True)
class OnTrack:
    """What acts on a track.

    Attributes
    ----------
    others : list of str
        Drives and connections that act on it, in words.
    touching : list of str
        Contacts of the record at fixed points of it.
    elsewhere : list of str
        Contacts of the record on other bodies.
    in_equilibrium : bool
        Whether the run starts in equilibrium.
    """

    others: list[str]
    touching: list[str]
    elsewhere: list[str]
    in_equilibrium: bool


def on_track(run: xr.Dataset, name: str) -> OnTrack | None:
    """Return what acts on a track of a record, None if the record has no scenario.

    Parameters
    ----------
    run : xarray.Dataset
        The record.
    name : str
        Name of the track. If no body of the record has this name, all its tracks are meant.
    """
    texts = [text for _, text in played(run)] or [str(run.attrs.get("scenario", ""))]
    try:
        scenarios = [tomllib.loads(text) for text in texts]
        found = [_on_track(tables, name, run) for tables in scenarios if tables]
    except (tomllib.TOMLDecodeError, AttributeError, KeyError, TypeError):
        return None
    if not found:
        return None
    others, touching, elsewhere = (
        list(dict.fromkeys(word for one in found for word in getattr(one, part)))
        for part in ("others", "touching", "elsewhere")
    )
    return OnTrack(others, touching, elsewhere, found[0].in_equilibrium)


def _on_track(tables: dict[str, Any], name: str, run: xr.Dataset) -> OnTrack:
    contacts = _contacts(tables, run)
    paths = {under["body"] for under in contacts.values() if _is_along(under) and "body" in under}
    # A beam on a beam is described by tables of its own.
    bodies = {name} if name in tables.get("bodies", {}) else paths or {"track"}
    touching = [word for word, under in contacts.items() if not _is_along(under) and under.get("body") in bodies]
    elsewhere = [word for word, under in contacts.items() if "body" in under and under["body"] not in bodies]
    in_equilibrium = any(drive["kind"] == START for drive in tables.get("drives", []))
    others = [*_drives(tables, bodies), *_connections(tables, bodies)]
    return OnTrack(others, touching, elsewhere, in_equilibrium)


def _contacts(tables: dict[str, Any], run: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Return the tracks of the contacts of a record by their names, or their surfaces if it has these."""
    shown = run["contact"].values.ravel().tolist() if "contact" in run.coords else None
    found = {}
    for number, one in enumerate(tables.get("contacts", []), 1):
        word = one.get("name", f"contact {number}")
        if shown is None or word in shown or one.get("surface") in shown:
            found[word if shown is None or word in shown else one["surface"]] = one["track"]
    return found


def _is_along(under: dict[str, Any]) -> bool:
    return under.get("kind") not in ("point", "circle")


def _is_in_the_plane(tables: dict[str, Any]) -> bool:
    return not any("normal" in one for one in tables.get("contacts", []))


def _drives(tables: dict[str, Any], bodies: set[str]) -> Iterator[str]:
    for drive in tables.get("drives", []):
        kind = drive["kind"]
        if kind == START and "mode" in drive:
            yield "a mode of vibration at the start"
        if kind == "gravity":
            yield "gravity"
        if drive.get("body") not in bodies:
            continue
        if kind != "force":
            yield kind
            continue
        felt = [drive.get(word, 0.0) for word in (BENDING if _is_in_the_plane(tables) else COMPONENTS)]
        if any(felt):
            size = math.hypot(*felt) * _largest(drive["history"])
            yield f"{drive['history']['kind']} force of up to {size:.3g} N at {_place(drive['point'])}"


def _connections(tables: dict[str, Any], bodies: set[str]) -> Iterator[str]:
    for one in tables.get("connections", []):
        places = [one[end]["point"] for end in ("first", "second") if end in one and one[end]["body"] in bodies]
        if places and not (one["direction"] == "x" and _is_in_the_plane(tables)):
            yield f"{one['kind']} at {_place(places[0])}"


def _largest(history: dict[str, Any]) -> float:
    """Return the largest factor of a history."""
    if "value" in history:
        return max(map(abs, history["value"]))
    return abs(history.get("mean", 0.0)) + abs(history.get("amplitude", 1.0))


def _place(point: Any) -> str:
    return f"{point:.4g} m" if isinstance(point, float) else str(point)
