"""Work at the points of a sweep: scenario, run, measures. A task can be sent to other machines."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Protocol

import xarray as xr
from threadpoolctl import threadpool_limits

from ..integration import simulate_many
from ..integration.settings import Settings
from ..records.plain import PlainRecord
from ..scenarios.load import Scenario
from .measures import Asked, Value, message_of
from .sources import Source

NOT_BUILT, NOT_STARTED, NOT_SIMULATED, NOT_MEASURED = "not built", "not started", "not simulated", "not measured"
# Outcome of a point: its values by name, its ending and the message of a failure, as plain numbers and texts.
Outcome = dict[str, Any]


class Stopped(Exception):
    """A part that was stopped because its study was."""


class Work(Protocol):
    """Work at each point of a study; it can be sent to other processes and machines."""

    def outcomes(
        self, points: Sequence[Sequence[Any]], workers: int = 1, watch: Callable[[], None] = lambda: None
    ) -> list[Outcome]:
        """Return the outcomes of some points, identical to the last bit for the same points."""


@dataclass(frozen=True)
class Task:
    """Work at each point of a sweep.

    Attributes
    ----------
    source : Source
        Source of the scenario of a point.
    asked : Asked
        Requested measures.
    probes : bool
        Whether the scenario's probes are recorded.
    """

    source: Source
    asked: Asked
    probes: bool

    def outcomes(
        self, points: Sequence[Sequence[Any]], workers: int = 1, watch: Callable[[], None] = lambda: None
    ) -> list[Outcome]:
        """Return the outcomes of some points, identical to the last bit for the same points.

        Parameters
        ----------
        points : sequence of sequence
            Values of the keys at each point.
        workers : int, optional
            Number of runs, or groups of runs, computed at a time.
        watch : callable, optional
            Called repeatedly; an exception that it raises ends the computation.
        """
        outcomes: list[Outcome] = []
        scenarios: dict[int, Scenario] = {}
        for number, values in enumerate(points):
            watch()
            outcomes.append({"ended": NOT_SIMULATED, "message": "", "values": {}})
            with failing(outcomes[-1], NOT_BUILT):
                scenarios[number] = self.source.scenario(values)
        for number, scenario in scenarios.items():
            watch()
            with failing(outcomes[number], NOT_MEASURED):
                outcomes[number]["values"] |= self.asked.of_system(scenario.system)
        if self.asked.needs_record:
            for numbers in _alike(scenarios, self._settings):
                chosen = [scenarios[number] for number in numbers]
                self._simulate([outcomes[number] for number in numbers], chosen, workers, watch)
        return outcomes

    def _settings(self, scenario: Scenario) -> Settings:
        """Return the settings of the run of a scenario, in which motion may be recorded less often."""
        settings = scenario.settings
        if not self.probes:
            return replace(settings, probes=(), motion_rate=None)
        rate = settings.motion_rate
        return settings if rate is None else replace(settings, motion_rate=min(rate, settings.sample_rate))

    def _simulate(
        self, outcomes: Sequence[Outcome], scenarios: Sequence[Scenario], workers: int, watch: Callable[[], None]
    ) -> None:
        """Run scenarios of the same duration and settings, and keep the measures of their records."""

        def measured(record: xr.Dataset | PlainRecord) -> Outcome:
            found: Outcome = {"ended": record.attrs["ended"], "message": record.attrs.get("message", ""), "values": {}}
            if not found["message"]:
                with failing(found, NOT_MEASURED):
                    found["values"] = self.asked.of_record(record)
            return found

        results = simulate_many(
            [scenario.system for scenario in scenarios],
            scenarios[0].duration,
            reduce=measured,
            workers=workers,
            watchers=[lambda progress: watch()],
            errors="return",
            # Labelling takes longer than the named measures, which need no labels.
            labelled=bool(self.asked.functions),
            variables=self.asked.variables,
            **vars(self._settings(scenarios[0])),
        )
        for outcome, result in zip(outcomes, results, strict=True):
            if isinstance(result, Exception):
                result = {"ended": NOT_STARTED, "message": message_of(result), "values": {}}
            # The failure of the system came first and is the one reported.
            message = outcome["message"] or result["message"]
            values: dict[str, Value] = outcome["values"] | result["values"]
            outcome |= {"ended": result["ended"], "message": message, "values": values}


def _alike(scenarios: dict[int, Scenario], settings: Callable[[Scenario], Settings]) -> list[list[int]]:
    """Return groups of numbers of scenarios of the same duration and settings."""
    groups: dict[Hashable, list[int]] = {}
    for number, scenario in scenarios.items():
        groups.setdefault((scenario.duration, settings(scenario)), []).append(number)
    return list(groups.values())


@contextmanager
def failing(outcome: Outcome, ended: str) -> Iterator[None]:
    """Record an exception, other than MemoryError and `Stopped`, as the outcome of a point."""
    try:
        yield
    except (MemoryError, Stopped):
        raise
    except Exception as error:
        outcome["ended"], outcome["message"] = ended, message_of(error)


@contextmanager
def one_thread_each() -> Iterator[None]:
    """Run linear algebra in one thread: with several threads the last bits depend on their number."""
    with threadpool_limits(1):
        yield


def use_one_thread() -> None:
    """Run linear algebra in one thread from now on, on another machine."""
    threadpool_limits(1)
