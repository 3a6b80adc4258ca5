"""The playable part of a scene requested by a page."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from ..scenarios.errors import ScenarioError
from .messages import Scene
from .playable import PRESETS, Playable, playable

# A number of an entry in a key.
NUMBER = re.compile(r"\b(contacts\.|surfaces\.|drives\.|connections\.|layers\.)\d+")


@dataclass(frozen=True)
class Held:
    """The playable part of a scene.

    Attributes
    ----------
    scene : Scene
        The scene without refused values.
    played : Playable
        Its playable scenario.
    refused : dict
        Problems of refused values, a list of lines by key; the key is empty if case or text are refused.
    problems : list of str
        Problems of the requested scene.
    """

    scene: Scene
    played: Playable
    refused: dict[str, list[str]]
    problems: list[str]


def held(wanted: Scene, last: Scene | None) -> Held:
    """Return the playable part of a scene.

    A refused value keeps its last value, or that of the case; the others are played. If nothing is played yet, the
    first case replaces one that cannot be played.

    Parameters
    ----------
    wanted : Scene
        Requested scene.
    last : Scene or None
        Scene played at present, if any.

    Raises
    ------
    ScenarioError
        If nothing of it can be played, with all its problems.
    """
    try:
        return Held(wanted, _playable(wanted), {}, [])
    except ScenarioError as error:
        problems = _together(error.problems)
    before = last.overrides if last is not None and is_of_one_case(wanted, last) else {}
    turned = [key for key, value in wanted.overrides.items() if before.get(key) != value]
    for key in turned:
        # A single value may cause the problem.
        found = _tried(_put_back(wanted, before, [key]))
        if found is not None:
            return Held(*found, {key: problems}, problems)
    refused = {}
    found = _tried(_put_back(wanted, before, turned))
    if found is None:
        if last is not None:
            raise ScenarioError(problems)
        first = Scene(type="scene", revision=wanted.revision, case=PRESETS[0])
        return Held(first, _playable(first), {"": problems}, problems)
    for key in turned:
        try:
            more = found[0].model_copy(update={"overrides": {**found[0].overrides, key: wanted.overrides[key]}})
            found = more, _playable(more)
        except ScenarioError as error:
            refused[key] = _together(error.problems)
    return Held(*found, refused, problems)


def is_of_one_case(one: Scene, other: Scene) -> bool:
    """Return whether two scenes differ only in values."""
    return one.text == other.text and (one.text is not None or one.case == other.case)


def _together(problems: Iterable[str]) -> list[str]:
    """Return lines that differ only in the number of a contact or drive as one, with a ``*`` for the number."""
    common: dict[str, list[str]] = {}
    for line in problems:
        common.setdefault(NUMBER.sub(r"\1*", line), []).append(line)
    return [lines[0] if len(lines) == 1 else line for line, lines in common.items()]


def _put_back(scene: Scene, before: Mapping[str, Any], keys: Iterable[str]) -> Scene:
    kept = {key: value for key, value in scene.overrides.items() if key not in keys}
    return scene.model_copy(update={"overrides": kept | {key: before[key] for key in keys if key in before}})


def _tried(scene: Scene) -> tuple[Scene, Playable] | None:
    try:
        return scene, _playable(scene)
    except ScenarioError:
        return None


def _playable(scene: Scene) -> Playable:
    try:
        return playable(scene.case, scene.text, scene.overrides)
    except RecursionError:
        raise ScenarioError(["scenario must be nested less deeply"]) from None
