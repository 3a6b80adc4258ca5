"""Linear theory at the points of a study, without any run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..linear.growth import Growth, Growths
from ..system import System
from .sources import Source
from .task import NOT_BUILT, NOT_SIMULATED, Outcome, failing


@dataclass(frozen=True)
class TheoryTask:
    """Linear theory at each point.

    Attributes
    ----------
    source : Source
        Source of the scenario of a point.
    velocity : float, tuple of float or None
        Slip velocity where nothing prescribes it [m/s], as for `sliding_stability`.
    """

    source: Source
    velocity: Any

    def outcomes(
        self, points: Sequence[Sequence[Any]], workers: int = 1, watch: Callable[[], None] = lambda: None
    ) -> list[Outcome]:
        """Return the outcomes of some points, identical to the last bit for the same points."""
        growths = Growths()
        return [self._outcome(values, watch, growths) for values in points]

    def kept(self, system: System, known: Growth) -> tuple[str, dict[str, Any]]:
        """Return the ending of a point, and what is kept of its growing motions."""
        raise NotImplementedError

    def _outcome(self, values: Sequence[Any], watch: Callable[[], None], growths: Growths) -> Outcome:
        watch()
        outcome: Outcome = {"ended": NOT_SIMULATED, "message": "", "values": {}}
        with failing(outcome, NOT_BUILT):
            system = self.source.scenario(values).system
            outcome["ended"], outcome["values"] = self.kept(system, growths.of(system, self.velocity))
        return outcome
