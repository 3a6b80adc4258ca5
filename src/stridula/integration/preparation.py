"""Preparation of runs from their duration and settings: systems as flat arrays, sampling, sizes of records."""

from __future__ import annotations

from dataclasses import dataclass, replace

import xarray as xr

from .._kernels.layout.columns import COLUMNS, ENERGIES
from ..checks import ArgumentError, at_least, at_most, instance, positive
from ..lowering import Assembly, assemble
from ..ordinary import of_ordinary_size
from ..records import ModalMotion, Probe
from ..records.by_surface import groups
from ..records.probes import usual_probes
from ..system import System
from .point_records import PointRecord, bytes_of
from .run import Midway, Run
from .settings import Settings
from .surface_records import SurfaceRecord
from .timing import Timing, choose_timing, sampled

LARGEST_RECORD = 8e9
# Default rate of maps of surfaces [Hz].
MAP_RATE = 1e3


@dataclass(frozen=True)
class Arrays:
    """A system, its probes, and both as flat arrays.

    Attributes
    ----------
    system : System
        The system.
    probes : tuple of Probe
        Quantities recorded besides those of the contacts.
    flat : Assembly
        Both as flat arrays.
    """

    system: System
    probes: tuple[Probe, ...]
    flat: Assembly


@dataclass(frozen=True)
class Preparation:
    """Preparation of runs of one duration and of the same settings.

    Attributes
    ----------
    duration : float
        Time to simulate [s].
    settings : Settings
        Settings of the runs.
    common_step : float or None
        Time step of several systems that march together [s].
    """

    duration: float
    settings: Settings
    common_step: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "duration", positive("duration", self.duration))
        self.settings.check()

    def arrays(self, system: System) -> Arrays:
        """Return a system as flat arrays."""
        instance("system", system, System)
        wanted = self.settings.probes
        probes = usual_probes(system) if wanted is None else tuple(wanted)
        for number, probe in enumerate(probes):
            instance(f"probes[{number}]", probe, Probe.__args__)
        if self.settings.motion_rate is not None and not any(hasattr(probe, "of_each") for probe in probes):
            probes += tuple(ModalMotion(body) for body in system.bodies)
        return Arrays(system, probes, assemble(system, probes))

    def timing(self, arrays: Arrays, start: xr.Dataset | None = None) -> Timing:
        """Return the step and the sampling of a system, with the step of a record to continue if none is given."""
        step, rate = self.settings.step, self.settings.sample_rate
        if step is None and isinstance(start, xr.Dataset) and "step" in start.attrs:
            step = float(start.attrs["step"])
        if self.common_step is None:
            timing = choose_timing(arrays.flat, self.settings.scheme, self.duration, step, rate)
        else:
            timing = sampled(self.common_step, round(1.0 / (rate * self.common_step)), self.duration)
        asked = self.settings.motion_rate
        if asked is None:
            return timing
        every = _intervals("motion_rate", asked, timing)
        if every > timing.samples:
            least = at_least(1.0 / (timing.samples * timing.interval))
            raise ArgumentError("motion_rate", f"be at least 1 / duration, {least} Hz", asked)
        return replace(timing, motion_every=every, samples=every * max(1, round(timing.samples / every)))

    @of_ordinary_size("system")
    def run(
        self, arrays: Arrays, start: xr.Dataset | None = None, title: str = "", midway: Midway | None = None
    ) -> Run:
        """Return the run of a system, ready to march."""
        timing = self.timing(arrays, start)
        every = self._every(arrays.system, timing)
        self._check_size(arrays, timing, every)
        surfaces = None
        if every:
            points = sum(map(bool, arrays.system.surface_names))
            is_kept = self.settings.surface_rate is None
            kept = PointRecord(timing.samples, points, timing.ratio) if is_kept else None
            surfaces = SurfaceRecord(arrays.system, every, kept)
        return Run(
            arrays.system,
            arrays.flat,
            arrays.probes,
            self.settings,
            timing,
            start=start,
            title=title,
            surfaces=surfaces,
            midway=midway,
        )

    def _check_size(self, arrays: Arrays, timing: Timing, every: int) -> None:
        """Raise ValueError if a record would be too large."""
        system = arrays.system
        rows, more = len(system.contacts), 0
        if every:
            points = sum(map(bool, system.surface_names))
            more = bytes_of(timing.ratio) * points if self.settings.surface_rate is None else 0
            rows = len(groups(system.contact_names, system.surface_names)) + -(-rows // every)
        in_single = sum(one.is_of_body for one in arrays.flat.probes)
        plain = len(arrays.flat.probes) - in_single
        size = 8 * (plain + ENERGIES + COLUMNS * rows) + 4 * in_single / timing.motion_every + more
        if size > LARGEST_RECORD / max(timing.samples, 1):
            raise ArgumentError(
                "duration",
                f"give a record below {LARGEST_RECORD / 1e9:g} GB",
                self.duration,
                got=f"{self.duration!r} s at {1 / timing.interval:.6g} Hz: lower sample_rate",
            )

    def _every(self, system: System, timing: Timing) -> int:
        """Return the samples in an interval of maps of surfaces, 0 if all points are contacts of the record."""
        asked = self.settings.surface_rate
        if isinstance(asked, str) or (asked is None and not system.faces):
            return 0
        if asked is None:
            return min(max(1, round(1.0 / (timing.interval * MAP_RATE))), timing.samples)
        if not (system.surface_names and system.has_two_tangents):
            raise ArgumentError("surface_rate", "be left out without surfaces in contact", asked)
        return _intervals("surface_rate", asked, timing)


def _intervals(name: str, asked: float, timing: Timing) -> int:
    """Return the samples in an interval at a rate that is asked for; ValueError if it is above the sample rate."""
    # A whole number of steps in a sample may leave a rate a little lower than asked for.
    rate = (1.0 + 1e-9) / timing.interval
    if asked > rate:
        raise ArgumentError(name, f"be at most the sample rate, {at_most(rate)} Hz", asked)
    return max(1, round(rate / asked))
