"""The background process of the page: one line of JSON for each question and each answer."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable, Sequence
from typing import Any

# Largest number of growing modes reported.
MOST = 12


def regimes(tables: dict[str, Any], keys: Sequence[str], points: Sequence[Sequence[float]]) -> list[str]:
    """Return the regime at some points, an empty text where there is none.

    Parameters
    ----------
    tables : dict
        A complete scenario.
    keys : sequence of str
        Varied keys.
    points : sequence of sequence of float
        Their values at each point, in SI.
    """
    from ..scenarios.keys import located
    from ..studies.measures import asked_for
    from ..studies.sources import OfTables
    from ..studies.task import Task

    changed, places, problems = located(tables, dict(zip(keys, points[0], strict=True)))
    if problems:
        return [""] * len(points)
    task = Task(OfTables(changed, tuple(places[key] for key in keys)), asked_for(["regime"]), False)
    return [str(outcome["values"].get("regime", "")) for outcome in task.outcomes(points)]


def theory(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the equilibrium of a scenario, and the modes that grow about it.

    Parameters
    ----------
    tables : dict
        A complete scenario.

    Returns
    -------
    dict
        ``equilibrium`` as in `sliding_stability`, or why there is none; growing ``modes``, fastest first, with
        ``frequency`` [Hz] and ``growth_rate`` [1/s].
    """
    import numpy as np

    from ..analysis.stability import sliding_stability
    from ..scenarios.load import scenario_of_tables

    try:
        found = sliding_stability(scenario_of_tables(tables).system)
    except ValueError as error:
        return {"equilibrium": str(error), "modes": []}
    growth = found["growth_rate"].values
    growing = [k for k in np.argsort(-growth) if bool(found["unstable"].values[k])][:MOST]
    modes = [{"frequency": float(found["frequency"].values[k]), "growth_rate": float(growth[k])} for k in growing]
    return {"equilibrium": str(found.attrs["equilibrium"]), "modes": modes}


def now(**words: Any) -> dict[str, Any]:
    """Return the present regime; arguments and result are those of `measured`."""
    from .now import measured

    return measured(**words)


def fit(**words: Any) -> dict[str, Any]:
    """Return the wall of a glass of another pitch; arguments and result are those of `fitted`."""
    from .fit import fitted

    return fitted(**words)


ANSWERS: dict[str, Callable[..., Any]] = {"regimes": regimes, "theory": theory, "now": now, "fit": fit}


def main() -> None:
    """Answer questions until the input ends, with a priority that is lower by the first argument."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with contextlib.suppress(OSError, AttributeError):
        os.nice(int(sys.argv[1]))
    # Heavy imports come after the priority has been lowered.
    from ..studies.task import use_one_thread

    use_one_thread()
    for line in sys.stdin:
        asked = json.loads(line)
        found = json.dumps(ANSWERS[asked["what"]](**asked["words"]))
        try:
            print(found, flush=True)
        except BrokenPipeError:
            # The server has gone; flushing the remaining output would only fail.
            os._exit(0)


if __name__ == "__main__":
    main()
