"""The runs for the paper's claims, each made once and only on request."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import xarray as xr

from ...acoustics import radiate
from ...acoustics.wav import read_wav, write_wav
from ...analysis import settling_time
from ...arrays import Array
from ...integration import simulate_many
from ...scenarios.load import Scenario, load_scenario
from ...studies.ensembles import median_and_interval, perturbed_starts

CASES = ("stable-sliding", "squeal", "axial-sliding", "judder", "weak-pressure", "strong-pressure")
# Number of starts of chaotic cases, for which a measure of a single run may hold by chance.
STARTS = 16
LADDER = tuple(np.round(np.arange(0.5, 1.501, 0.05), 2))
LAST = 0.3


@dataclass
class Runs:
    """Runs of the paper's cases under one set of parameters.

    Parameters
    ----------
    overrides : mapping, optional
        Scenario keys and values that replace the shipped ones in every case, such as ``{"damping": 0.01}``.
    report : callable, optional
        Called with the name of each run before it starts.
    """

    overrides: Mapping[str, Any] = field(default_factory=dict)
    report: Callable[[str], None] = lambda name: None
    _records: dict[str, xr.Dataset] = field(default_factory=dict, repr=False)
    _sounds: dict[str, xr.DataArray] = field(default_factory=dict, repr=False)
    _made: dict[str, Any] = field(default_factory=dict, repr=False)

    def scenario(self, case: str, **overrides: Any) -> Scenario:
        """Return a case of the paper under these parameters, with further overrides."""
        return load_scenario(case, {**self.overrides, **overrides})

    def record(self, case: str) -> xr.Dataset:
        """Return the record of one of `CASES`."""
        if case not in self._records:
            self.report(case)
            self._records[case] = self.scenario(case).simulate()
        return self._records[case]

    def sound(self, case: str, path: str | Path | None = None) -> xr.DataArray:
        """Return the sound of a case from its file [Pa]: two ears a metre above the track, in a baffle.

        The file is written to `path`, or to a temporary file if left out.
        """
        if case not in self._sounds or path is not None:
            self.report(f"sound of {case}")
            pressure = radiate(self.record(case), self.scenario(case).system.track)
            with TemporaryDirectory() as folder:
                file = Path(folder) / "sound.wav" if path is None else path
                write_wav(file, pressure)
                self._sounds[case] = read_wav(file)
        return self._sounds[case]

    def ladder(self, case: str) -> dict[float, str]:
        """Return the ending of a case at each coefficient of friction of `LADDER`: sliding, stuck or vibrating."""
        found: dict[float, str] = self.once(
            f"{case} over friction", lambda: {float(friction): self._ends(case, float(friction)) for friction in LADDER}
        )
        return found

    def _ends(self, case: str, friction: float) -> str:
        self.report(f"{case} at friction {friction:g}")
        return ending(self.scenario(case, coefficient=friction).simulate())

    def once(self, name: str, make: Callable[[], Any]) -> Any:
        """Return the result of `make`, called on the first request for this name."""
        if name not in self._made:
            self._made[name] = make()
        return self._made[name]

    def over_starts(
        self, case: str, measures: Mapping[str, Callable[[Runs], float]], starts: int = STARTS
    ) -> dict[str, Array]:
        """Return measures of a case from starts that differ by parts in a million, each of shape (starts,).

        A measure receives these runs with the case's record from one of the starts.
        """
        self.report(f"{case} from {starts} starts")
        scenario = self.scenario(case)

        def measured(record: xr.Dataset) -> list[float]:
            own = self._with(case, record)
            return [float(measure(own)) for measure in measures.values()]

        systems = perturbed_starts(scenario.system, starts)
        values = simulate_many(systems, scenario.duration, measured, provenance=False)
        return dict(zip(measures, np.array(values).T, strict=True))

    def _with(self, case: str, record: xr.Dataset) -> Runs:
        other = copy(self)
        other._records = {**self._records, case: record}
        other._sounds = {name: sound for name, sound in self._sounds.items() if name != case}
        return other


def median_over_starts(values: Array) -> tuple[float, list[float] | None]:
    """Return the median over starts and its interval; NaN and None unless more than half of them have a value."""
    known = values[np.isfinite(values)]
    if 2 * known.size <= values.size:
        return float("nan"), None
    median, *interval = median_and_interval(known)
    return median, interval if np.isfinite(interval).all() else None


def ending(run: xr.Dataset) -> str:
    """Return the state of the last 0.3 s of a run: ``sliding`` or ``stuck`` at every step, or else ``vibrating``."""
    begins = float(run["time"][-1]) - LAST
    if settling_time(run) <= begins:
        return "sliding"
    sticking = run["status_share"].sel(time=slice(begins, None), contact_status="sticking")
    return "stuck" if bool((sticking == 1.0).all()) else "vibrating"
