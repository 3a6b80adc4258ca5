"""Jumps of all that is turned on the page, one after the other: none makes a stroke freeze or end for good."""

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

# Jumps that follow each other, in one instrument.
JUMPS = 20
UNBELIEVED = {"energy created", "not finite", "contact unsolved"}
# Case and values, as the page holds them.
Scene = tuple[str, dict[str, Any]]


def inputs(seed: int, count: int, jumps: int = JUMPS) -> Iterator[list[tuple[str, Any, int]]]:
    """Yield rows of jumps: what jumps, where to, and hundredths of a second that are played then.

    Parameters
    ----------
    seed : int
        The same seed yields the same.
    count : int
        How many rows.
    jumps : int, optional
        Jumps of each.
    """
    for number in range(count):
        dice = random.Random(f"{seed} {number}")
        row: list[tuple[str, Any, int]] = [("case", dice.choice(PRESETS), dice.randint(1, 40))]
        for _ in range(jumps):
            row.append((*_jump(dice), dice.randint(1, 6)))
        yield row


def check(given: list[tuple[str, Any, int]]) -> str:
    """Play a row of jumps; return whether any was refused, ``accepted`` or ``refused``.

    Parameters
    ----------
    given : list of tuple
        What `inputs` yields.

    Raises
    ------
    AssertionError
        If a stroke freezes or ends for good, or a refusal is not in lines.
    """
    return "refused" if played(given)["refused"] else "accepted"


def played(given: list[tuple[str, Any, int]]) -> dict[str, int]:
    """Play a row of jumps; return how many were played, went on in their stroke and were refused.

    Counted, too, are strokes that were not believed, and scenarios that cannot be: one that ends as soon as it begins,
    without any jump, may end for good.
    """
    (_, case, first), *jumps = given
    counts = dict.fromkeys(("played", "went on", "refused", "unbelieved", "beyond belief"), 0)
    scene: Scene = (case, {})
    instrument = Instrument(playable(case, None, {}))
    _play(instrument, first)
    for number, (what, where, hundredths) in enumerate(jumps):
        told = f"jump {number}, {what} to {where!r} in {scene}"
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
        counts["unbelieved"] += sum(why in UNBELIEVED for why in ended)
        if instrument.ended:
            assert _ends_by_itself(changed), f"{told}: {instrument.ended}"
            counts["beyond belief"] += 1
            continue
        assert samples == hundredths * RATE // 100, f"{told}: {samples} samples of {hundredths} hundredths"
    return counts


def _play(instrument: Instrument, hundredths: int) -> tuple[int, list[str]]:
    """Play on; return the samples that came and why strokes ended."""
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


def _jump(dice: random.Random) -> tuple[str, Any]:
    kind = dice.random()
    if kind < 0.08:
        return "case", dice.choice(PRESETS)
    if kind < 0.2:
        choice = dice.choice(CHOICES)
        return choice.key, dice.choice(list(choice.kinds))
    control = dice.choice(CONTROLS)
    # Ends of the slider are where one lands first.
    share = dice.choice((0.0, 1.0)) if dice.random() < 0.15 else dice.random()
    return control.key, (control.low + share * (control.high - control.low)) * control.scale


def _wanted(scene: Scene, what: str, where: Any) -> Scene:
    """Return what the page asks for after a jump."""
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
