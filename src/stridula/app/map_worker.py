"""The process that computes maps: a line of JSON for each row that is asked, one for each answer."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from collections.abc import Sequence
from typing import Any

from ..scenarios.keys import located
from ..studies.measures import asked_for
from ..studies.sweeps import SAMPLE_RATE
from ..studies.task import Task, use_one_thread

# The sound comes first.
NICENESS = 10


def regimes(tables: dict[str, Any], keys: Sequence[str], points: Sequence[Sequence[float]]) -> list[str]:
    """Return the regime at some points, empty where there is none.

    Parameters
    ----------
    tables : dict
        A scenario in full.
    keys : sequence of str
        What is varied.
    points : sequence of sequence of float
        Their values at each point, in SI.
    """
    changed, places, problems = located(tables, dict(zip(keys, points[0], strict=True)))
    if problems:
        return [""] * len(points)
    task = Task(changed, tuple(places[key] for key in keys), asked_for(["regime"]), SAMPLE_RATE, False)
    return [str(outcome["values"].get("regime", "")) for outcome in task.outcomes(points)]


def main() -> None:
    """Answer until nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with contextlib.suppress(OSError, AttributeError):
        os.nice(NICENESS)
    use_one_thread()
    for line in sys.stdin:
        found = json.dumps(regimes(**json.loads(line)))
        try:
            print(found, flush=True)
        except BrokenPipeError:
            # The server has gone in between; what is left unwritten would only be complained of.
            os._exit(0)


if __name__ == "__main__":
    main()
