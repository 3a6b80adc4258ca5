"""Sequences of changes of the controls of the page: none makes a stroke freeze or end for good."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

import numpy as np

from stridula.app.controls import CHOICES, CONTROLS
from stridula.app.instrument import RATE, Instrument
from stridula.app.parts import Part, Stop
from stridula.app.playable import PRESETS, Playable, playable
from stridula.scenarios import ScenarioError

# Changes that follow each other, in one instrument.
CHANGES = 20
FAULTS = {"energy created", "not finite", "contact unsolved"}
# Case and values, as the page holds them.
Scene = tuple[str, dict[str, Any]]


def inputs(seed: int, count: int, changes: int = CHANGES) -> Iterator[list[tuple[str, Any, int]]]:
    """Yield sequences of changes: the control, its new value, and hundredths of a second played after it.

    Parameters
    ----------
    seed : int
        Seed; equal seeds yield equal sequences.
    count : int
        Number of sequences.
    changes : int, optional
        Changes in each.
    """
    for number in range(count):
        dice = random.Random(f"{seed} {number}")
        row: list[tuple[str, Any, int]] = [("case", dice.choice(PRESETS), dice.randint(1, 40))]
        for _ in range(changes):
            row.append((*_change(dice), dice.randint(1, 6)))
        yield row


def check(given: list[tuple[str, Any, int]]) -> str:
    """Play a sequence of changes; return whether any was refused, ``accepted`` or ``refused``.

    Parameters
    ----------
    given : list of tuple
        A sequence of `inputs`.

    Raises
    ------
    AssertionError
        If a stroke freezes or ends for good, or a refusal is not made of single lines.
    """
    return "refused" if played(given)["refused"] else "accepted"


def played(given: list[tuple[str, Any, int]]) -> dict[str, int]:
    """Play a sequence of changes; return how many were played, continued their stroke and were refused.

    Strokes with faults are also counted, and scenarios that end as soon as they begin: without any change, such a
    scenario may end for good.
    """
    (_, case, first), *changes = given
    counts = dict.fromkeys(("played", "went on", "refused", "faulty", "ends at once"), 0)
    scene: Scene = (case, {})
    instrument = Instrument(playable(case, None, {}))
    _play(instrument, first)
    for number, (what, where, hundredths) in enumerate(changes):
        told = f"change {number}, {what} to {where!r} in {scene}"
        wanted = _wanted(scene, what, where)
        try:
            changed = playable(wanted[0], None, wanted[1])
        except ScenarioError as error:
            _check_lines(error, told)
            counts["refused"] += 1
            continue
        scene = wanted
        counts["played"] += 1
        counts["went on"] += instrument.change(changed, number)
        samples, ended = _play(instrument, hundredths)
        counts["faulty"] += sum(why in FAULTS for why in ended)
        if instrument.ended:
            assert _ends_by_itself(changed), f"{told}: {instrument.ended}"
            counts["ends at once"] += 1
            continue
        assert samples == hundredths * RATE // 100, f"{told}: {samples} samples of {hundredths} hundredths"
    return counts


def _play(instrument: Instrument, hundredths: int) -> tuple[int, list[str]]:
    """Continue; return the number of samples and the reasons why strokes ended."""
    samples, ended = 0, []
    for _ in range(hundredths):
        for one in instrument.play(RATE // 100):
            if isinstance(one, Stop):
                ended.append(one.why)
            elif isinstance(one, Part):
                assert np.isfinite(one.sound).all()
                samples += len(one.sound)
    return samples, ended


def _ends_by_itself(scenario: Playable) -> bool:
    alone = Instrument(scenario)
    _play(alone, 100)
    return bool(alone.ended)


def _change(dice: random.Random) -> tuple[str, Any]:
    kind = dice.random()
    if kind < 0.08:
        return "case", dice.choice(PRESETS)
    if kind < 0.2:
        choice = dice.choice(CHOICES)
        return choice.key, dice.choice(list(choice.kinds))
    control = dice.choice(CONTROLS)
    # The ends of the slider are likely values.
    share = dice.choice((0.0, 1.0)) if dice.random() < 0.15 else dice.random()
    return control.key, (control.low + share * (control.high - control.low)) * control.scale


def _wanted(scene: Scene, what: str, where: Any) -> Scene:
    """Return the scene that the page asks for after a change."""
    case, overrides = scene
    if what == "case":
        return where, {}
    for choice in CHOICES:
        if choice.key == what:
            table = what[: what.rindex(".") + 1]
            kept = {key: one for key, one in overrides.items() if table == "simulation." or not key.startswith(table)}
            return case, {**kept, what: where, **choice.begins[where]}
    return case, {**overrides, what: where}


def _check_lines(error: ScenarioError, told: str) -> None:
    assert error.problems, told
    for line in error.problems:
        assert 0 < len(line) < 1000, f"{told}: {line[:80]}"
        assert "\n" not in line, f"{told}: {line}"
