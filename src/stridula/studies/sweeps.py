"""Sweeps: a scenario at many points of its parameters, with measures in one Dataset, saved on disk."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from ..checks import by_key
from ..version import __version__
from .computed import Plan, Watcher, check_options, computed
from .measures import asked_for
from .points import Grid, LatinHypercube, Values, laid_out, plain_python
from .sources import SystemOf, varying
from .swept import check_names, swept
from .task import Outcome, Task

# Number of points computed together on any machine; their runs have the same time step and are computed side by side.
POINTS_OF_A_PART = 64


def sweep(
    scenario: str | Path | xr.Dataset | SystemOf,
    points: Grid | LatinHypercube | Mapping[str, Values] | Sequence[Mapping[str, Any]],
    measures: Any,
    *,
    overrides: Mapping[str, Any] | None = None,
    duration: float | str | None = None,
    sample_rate: float | str | None = None,
    probes: bool | None = None,
    out: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    watchers: Sequence[Watcher] = (),
    progress: bool = False,
) -> xr.Dataset:
    """Run a scenario, or the systems made by a function, at many parameter points and return measures of each run.

    Points are computed in parts of 64, in their order. Within a part runs are computed side by side, with the shortest
    of the time steps that they would have alone. Results are the same to the last bit for any number of workers, on
    other machines of the same kind, and after a sweep was stopped and resumed. To that end, linear algebra uses one
    thread during the sweep.

    A point that cannot be built, started, simulated or measured is kept with its message, and the others continue.

    Parameters
    ----------
    scenario : str, Path, xarray.Dataset or callable
        Name of a shipped case, a TOML file or a record. Or a function that takes values by name and returns a `System`,
        a `Scenario`, or a `System` and a dictionary of arguments of `simulate`; texts such as ``"10 deg"`` are passed
        to it in SI.
    points : Grid, LatinHypercube, mapping or sequence of mapping
        Values by key, as the overrides of `load_scenario`; for a function by its parameters. A mapping is that of a
        `Grid`.
    measures : str, mapping or sequence of them
        Names of measures, or functions by names of your own. A function takes a record and returns a number or a
        text; it runs in threads, in processes, and with a `client` on other machines.
    overrides : mapping, optional
        Values of other keys, the same at every point.
    duration : float or str, optional
        Time to simulate [s]; that of the scenario or the function if left out.
    sample_rate : float or str, optional
        Samples per second recorded [Hz]; the scenario's if left out, at most 20 kHz.
    probes : bool, optional
        Whether the scenario's probes are recorded; by default if there are functions among the measures.
    out : str or Path, optional
        NetCDF file to write. Finished parts are kept in a folder beside it, ``<out>.parts``; the same call resumes
        from there. Two processes may compute the same sweep at once.
    workers : int, optional
        Parts at a time; default: one per processor. They are computed in threads, and in processes
        once threads wait for each other; with functions that no other process can import, such as those of the script
        itself, only threads are used.
    client : distributed.Client, optional
        Machines that compute the parts, in place of this one.
    watchers : sequence of callable, optional
        Called with a `SweepProgress` after each part.
    progress : bool, optional
        Whether a bar on standard error shows how many points are done and how long the others will take.

    Returns
    -------
    xarray.Dataset
        For a grid, the measures over one dimension for each key; for other points over ``point``, with the keys as
        coordinates. Texts such as ``"10 deg"`` become numbers with this unit. ``ended`` is the ending of the run, or
        ``not built``, ``not started``, ``not simulated``, ``not measured``; ``message`` the failure, empty if none.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used, or a key is not known, means several places or takes values of another kind.
    ValueError
        If another argument is invalid, a function takes other parameters or fails at both the first and the last
        point, or `out` is another file or that of another sweep, which is not changed. Functions are distinguished by
        their names only.
    OSError
        If the file or a part cannot be written; finished parts are kept.
    RuntimeError
        If a part fails on other machines; finished parts are kept.
    """
    check_options(workers, client, watchers, progress)
    plan = _planned(scenario, points, measures, by_key("overrides", overrides), duration, sample_rate, probes)
    return computed(plan, out, workers, client, watchers, progress)


def _planned(
    scenario: Any,
    points: Any,
    measures: Any,
    overrides: Mapping[str, Any],
    duration: Any,
    sample_rate: Any,
    probes: bool | None,
) -> Plan:
    """Return a checked sweep from the arguments of `sweep`."""
    asked = asked_for(measures)
    layout = laid_out(points)
    check_names(layout, asked.columns)
    fixed = {key: plain_python(value) for key, value in overrides.items()}
    timing = {"duration": plain_python(duration), "sample_rate": plain_python(sample_rate)}
    given = {name: value for name, value in timing.items() if value is not None}
    found = varying(scenario, fixed, given, layout)
    with_probes = bool(asked.functions) if probes is None else bool(probes)
    wanted: dict[str, Any] = {"points": layout.asked, "measures": list(asked.names), "functions": list(asked.functions)}
    wanted |= {"overrides": fixed, **timing, "probes": with_probes}
    attributes = found.attributes | {
        "stridula_version": __version__,
        "sweep": json.dumps(wanted, ensure_ascii=False, default=str),
    }

    def labelled(outcomes: Sequence[Outcome]) -> xr.Dataset:
        return swept(layout, found.keys, found.values, asked.columns, outcomes, attributes)

    task = Task(found.source, asked, with_probes)
    return Plan("sweep", task, found.values, POINTS_OF_A_PART, attributes, labelled)
