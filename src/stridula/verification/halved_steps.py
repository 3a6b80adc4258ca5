"""The beginnings of the shipped cases at their default step and at half of it."""

from __future__ import annotations

import numpy as np

from ..scenarios import list_scenarios, load_scenario
from ..studies.step_checks import Moved, check_step
from .case import Case, Curve, Outcome, Row, Sketch

# Share of the duration of a case that is run; smaller for cases with surfaces in contact, which take longer.
BEGINNING, OF_SURFACES = 0.2, 0.02
REASON = "an engineer's accuracy: 1 % in frequency and growth, 0.5 dB in level, 0.02 in shares of the time"
RELATIVE = ("frequency", "growth")


def halved_steps() -> Outcome:
    """Return frequency, level and shares of each shipped case, held against those at half the step."""
    rows, names, largest = [], [], []
    for case in list_scenarios():
        scenario = load_scenario(case.name)
        share = OF_SURFACES if scenario.system.faces else BEGINNING
        found = check_step(scenario.simulate(duration=share * scenario.duration))
        results = [one for one in found.before or found.moved if np.isfinite([one.value, one.finer]).all()]
        rows += [_row(case.name, one) for one in results]
        names.append(case.name)
        largest.append(max((abs(one.change) / one.allowed for one in results), default=0.0))
    curve = Curve(np.arange(1.0, len(names) + 1.0), np.array(largest), "largest change", marks=True)
    return Outcome(rows, Sketch(f"case: {', '.join(names)}", "change over the allowed one [1]", [curve]))


def _row(case: str, moved: Moved) -> Row:
    tolerance = moved.allowed * (abs(moved.finer) if moved.name in RELATIVE else 1.0)
    return Row(f"{case}: {moved.name}", moved.finer, moved.value, tolerance, REASON, moved.units)


CASES = (
    Case(
        "halved-steps",
        "Shipped cases at their default step",
        "the same cases at half the step, up to the time from which their forces differ by a tenth",
        halved_steps,
    ),
)
