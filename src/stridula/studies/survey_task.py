"""Work at the points of a survey: equilibrium, modes, and a run from each growing mode."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..linear.equilibrium import JAMMED
from ..linear.reach import equilibrium_at_start, modes_at_rest
from ..linear.structure import SLIDING
from ..scenarios.load import Scenario
from .fates import FAILED, SETTLING, Options, Runs, fate_of
from .kicks import smallest_kick
from .sources import Source
from .survey_slopes import differentiate, without_start
from .task import NOT_BUILT, NOT_STARTED, Outcome, failing

STABLE, UNSTABLE = "stable", "unstable"


@dataclass(frozen=True)
class SurveyTask:
    """Work at each point of a survey.

    Attributes
    ----------
    source : Source
        Source of the scenario of a point.
    options : Options
        Options of the runs.
    by : tuple of str
        Keys by which the growing modes are differentiated.
    """

    source: Source
    options: Options
    by: tuple[str, ...] = ()

    def outcomes(
        self, points: Sequence[Sequence[Any]], workers: int = 1, watch: Callable[[], None] = lambda: None
    ) -> list[Outcome]:
        """Return the outcomes of some points, identical to the last bit for the same points.

        Parameters
        ----------
        points : sequence of sequence
            Values of the keys at each point.
        workers : int, optional
            Not used: the runs of a point are computed in sequence.
        watch : callable, optional
            Called repeatedly; an exception that it raises ends the computation.
        """
        return [self._outcome(values, watch) for values in points]

    def _outcome(self, values: Sequence[Any], watch: Callable[[], None]) -> Outcome:
        watch()
        outcome: Outcome = {"ended": NOT_BUILT, "message": "", "values": {}}
        with failing(outcome, NOT_BUILT):
            scenario = self.source.scenario(values)
        if not outcome["message"]:
            with failing(outcome, NOT_STARTED):
                self._survey(scenario, outcome, watch)
        if self.by and outcome["values"].get("modes"):
            self._differentiate(values, scenario, outcome)
        return outcome

    def _differentiate(self, values: Sequence[Any], scenario: Scenario, outcome: Outcome) -> None:
        """Add the derivatives of the growing modes to an outcome."""
        known = outcome["values"]
        told: Outcome = {"ended": "", "message": ""}
        with failing(told, FAILED):
            tables = self.source.tables(values, scenario)
            told["message"] = differentiate(known, self.by, tables, scenario.system, self.options.velocity)
        if told["message"] and not outcome["message"]:
            outcome["message"] = told["message"]

    def _survey(self, scenario: Scenario, outcome: Outcome, watch: Callable[[], None]) -> None:
        """Add the results of linear theory and the fates of the modes to an outcome."""
        system, start = without_start(scenario.system, self.options.velocity)
        at = equilibrium_at_start(system, start)
        outcome["values"] = {"equilibrium": at.kind, "equilibria": at.found, "modes": []}
        if at.kind == JAMMED or SLIDING not in at.status:
            # Only sliding contacts feed a vibration.
            outcome["ended"] = at.kind
            outcome["values"] |= {} if at.kind == JAMMED else {"unstable_modes": 0.0}
            return
        start = replace(start, status=at.status)
        highest = 2.0 * np.pi * self.options.highest
        # Whether a mode dies away is only seen of those that have time for it.
        rest = modes_at_rest(system, start, self.options.kicks, highest, SETTLING / self.options.longest)
        runs = Runs(replace(scenario, system=system), start, rest, self.options, watch)
        outcome["ended"] = UNSTABLE if rest.reach else STABLE
        outcome["values"]["unstable_modes"] = float(len(rest.reach))
        if not rest.reach:
            self._kick(runs, outcome)
        for number in runs.followed:
            exponent = complex(rest.exponents[number])
            mode: dict[str, Any] = {"number": number, "frequency": exponent.imag / (2.0 * np.pi)}
            mode |= {"growth_rate": exponent.real, "amplitude": self.options.amplitude * rest.reach[number]}
            mode |= {"fate": FAILED, "joined": -1, "tones": []}
            outcome["values"]["modes"].append(mode)
            told: Outcome = {"ended": "", "message": ""}
            with failing(told, FAILED):
                mode |= fate_of(runs, number)
            for tone in mode["tones"]:
                tone["mode"] = (
                    abs(float(rest.exponents[tone["mode"]].imag)) / (2.0 * np.pi) if tone["mode"] >= 0 else None
                )
            if told["message"] and not outcome["message"]:
                outcome["message"] = f"mode at {mode['frequency']:.5g} Hz: {told['message']}"

    def _kick(self, runs: Runs, outcome: Outcome) -> None:
        """Add the smallest kick that starts a squeal to the outcome of a quiet point."""
        found = []
        for number, reach in runs.rest.quiet.items():
            told: Outcome = {"ended": "", "message": ""}
            with failing(told, FAILED):
                found.append(smallest_kick(runs, number, reach))
            if told["message"] and not outcome["message"]:
                frequency = float(runs.rest.exponents[number].imag) / (2.0 * np.pi)
                outcome["message"] = f"kick of the mode at {frequency:.5g} Hz: {told['message']}"
        outcome["values"] |= min((one for one in found if one), key=lambda one: float(one["kick"]), default={})
