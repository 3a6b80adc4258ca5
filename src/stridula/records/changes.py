"""Scenarios that were changed during a live run, as kept in its record."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from typing import Any

import xarray as xr

from ..checks import ArgumentError


def played(run: xr.Dataset) -> list[tuple[float, str]]:
    """Return the scenarios of a record that was changed during the run, each with the time [s] from which it applied.

    Only those within the times of the record are returned; none for a record that was never changed.

    Raises
    ------
    ValueError
        If the attribute ``changes`` is damaged.
    """
    text = run.attrs.get("changes")
    if text is None:
        return []
    try:
        every = [(float(change["time"]), str(change["scenario"])) for change in json.loads(text)]
    except (ValueError, TypeError, KeyError):
        raise ArgumentError("run", "have the attribute changes as it was saved", run, got="a damaged one") from None
    times = run["time"].values
    if not times.size:
        return []
    # Times are at the ends of sample intervals: a change at a sample has an effect from the next one on.
    begins = [*(time for time, _ in every[1:]), float("inf")]
    return [change for change, end in zip(every, begins, strict=True) if end >= times[0] and change[0] < times[-1]]


def check_one_track(run: xr.Dataset) -> None:
    """Raise ValueError if the track was changed within the times of a record."""
    _check_same(run, "track", _tracks)


def check_one_system(run: xr.Dataset) -> None:
    """Raise ValueError if more than friction was changed within the times of a record."""
    _check_same(run, "bodies and drives", _but_friction)


def _check_same(run: xr.Dataset, what: str, part: Callable[[dict[str, Any]], Any]) -> None:
    changes = played(run)
    if not changes:
        return
    first, *others = (part(tomllib.loads(text)) for _, text in changes)
    for (time, _), other in zip(changes[1:], others, strict=True):
        if other != first:
            raise ArgumentError(
                "run",
                f"have the same {what} throughout to be heard",
                run,
                got=(
                    f"another one from {time:.6g} s on: select the times of one with run.sel(time=slice(START, "
                    f"STOP)), and give its {what}"
                ),
            )


def _tracks(tables: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Return the tracks of a scenario: its own table, or the bodies that contacts slide along."""
    under = [one.get("track") for one in tables.get("contacts", [])]
    named = {one["body"] for one in under if isinstance(one, dict) and "body" in one}
    return tables.get("track"), {name: tables.get("bodies", {}).get(name) for name in sorted(named)}


def _but_friction(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the part of a scenario that determines the response of its bodies to forces."""
    told = {key: value for key, value in tables.items() if key not in ("friction", "title", "description")}
    return {key: _without_friction(value) for key, value in told.items()}


def _without_friction(value: Any) -> Any:
    if isinstance(value, list):
        return [_without_friction(one) for one in value]
    return {key: one for key, one in value.items() if key != "friction"} if isinstance(value, dict) else value
