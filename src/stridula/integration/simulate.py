"""Simulation of a system: check the arguments, flatten, march, label."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from .._kernels.layout import COLUMNS, ENERGIES
from ..checks import ArgumentError, at_least, at_most, instance, positive
from ..lowering import Assembly, assemble
from ..lowering.schemes import CentralDifference, ExactModal, Scheme
from ..lowering.stepping import Stepping
from ..ordinary import of_ordinary_size
from ..records import ModalMotion, Probe
from ..records.by_surface import groups
from ..records.probes import usual_probes
from ..system import System
from .bars import time_shown
from .contact_solve import GaussSeidel
from .default_step import default_step
from .marches import March
from .point_records import PointRecord, bytes_of
from .run import Run
from .stops import Diverged, Interrupted
from .surface_records import ALL_POINTS, SurfaceRecord
from .timing import Timing
from .together import march_together
from .watchers import Watcher

LARGEST_RECORD = 8e9
LARGEST_RATIO = 1_000_000
SMALLEST_SHARE = 1e-7
# Default rate of maps of surfaces [Hz].
MAP_RATE = 1e3


def simulate(
    system: System,
    duration: float,
    *,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = 100e3,
    probes: Sequence[Probe] | None = None,
    contact_solve: GaussSeidel | None = None,
    start: xr.Dataset | None = None,
    watchers: Sequence[Watcher] = (),
    title: str = "",
    surface_rate: float | str | None = None,
    motion_rate: float | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Simulate a system in time and return its record.

    Parameters
    ----------
    system : System
        System to simulate; initially at rest unless a drive or `start` sets another state.
    duration : float
        Time to simulate [s], rounded to whole sample intervals.
    scheme : CentralDifference or ExactModal, optional
        Time scheme; the exact modal one if left out.
    step : float, optional
        Time step [s]; if left out, that of the record to continue, or one that follows from the modes kept and from the
        springs and contacts of lumped masses, reduced to a whole division of the sample interval.
    sample_rate : float, optional
        Samples per second to record [Hz]; with a step given, the nearest rate at which a sample is a whole number
        of steps.
    probes : sequence of probes, optional
        Further quantities to record: Displacement, Velocity, Acceleration, Reaction, SupportForce, ModalDisplacement,
        ModalVelocity or ModalMotion; the acceleration of the track's centre along y if left out and the track is a
        beam.
    contact_solve : GaussSeidel, optional
        Settings of the simultaneous solution of several contacts; a single contact is solved exactly.
    start : xarray.Dataset, optional
        A record to continue; the new record begins at its end. Bodies, contact point, gap, probes, scheme, step and
        sampling must be the same; friction, drives and the motion of rigid tracks may change. A belt continues from its
        present position.
    watchers : sequence of callable, optional
        Called with the `Progress` between chunks of the march.
    title : str, optional
        Title of the record.
    surface_rate : float or str, optional
        Rate of maps of surfaces [Hz], with no other record of their points; the nearest rate at which an interval is a
        whole number of samples. If left out, maps at 1 kHz, and the variables of points that sound and regimes need,
        for surfaces with known areas. With ``"all"`` every point is a contact of the record.
    motion_rate : float, optional
        Rate at which the motion of bodies is recorded, from which `radiate` computes their sound [Hz]; the nearest rate
        at which an interval is a whole number of samples. At least ``1 / duration``, as the run is rounded to whole
        intervals. The motion of all bodies, unless `probes` have a ModalMotion.
        If left out, only such probes, at the sample rate.
    progress : bool, optional
        Whether to show a bar on standard error with the simulated time, the speed and the time left, in terminals,
        notebooks and logs.

    Returns
    -------
    xarray.Dataset
        Forces (means over each sample interval), contact, energies and probes over ``time`` [s], with units and
        meanings in the attributes. ``attrs["ended"]`` is ``finished`` or ``off the track``; ``attrs["scenario"]`` is
        TOML that repeats the run. ``attrs["notes"]`` has, separated by semicolons, the parts that the model describes
        only roughly: bending with waves under six thicknesses, bodies that turn near a critical speed, contacts that
        vibrate near a cutoff, contacts and tracks without friction. Normal forces are compressive, tangential forces
        act on the track along its tangent.
        Variables of the contact have the dimension ``contact`` if there are several. Each surface is one contact,
        unless `surface_rate` is ``"all"``: forces and counts are sums over its points, all other variables are means;
        ``surface_force`` and the other resultants of `analysis.surface` are over ``face``; variables that begin with
        ``map_``, means over the interval, are over ``map_time`` [s] and ``point``; without a `surface_rate`, those that
        begin with ``point_`` are over ``time`` and ``point``, in reduced precision.

    Raises
    ------
    ValueError
        If an argument is out of its range, such as a step at or beyond the limit of the scheme.
    Interrupted
        On Ctrl-C, with the record so far.
    Diverged
        If the result is not valid: the state is not finite, contact forces did not converge, or energy was created. The
        message has the time, the last state of the contacts and the likely cause; the exception has the record so far.
    """
    if not isinstance(watchers, Sequence):
        raise ArgumentError("watchers", "be a list of callables", watchers)
    asked = Asked(duration, scheme, step, sample_rate, probes, contact_solve, surface_rate, motion_rate)
    with time_shown(progress, title or "simulate") as more:
        run = asked.run(asked.arrays(system), start, title)
        march = March([run.blocks], [run.state], run.timing.step, run.timing.ratio, asked.solve)
        interrupted = march_together([run], march, [*watchers, *more])
    record = run.record(interrupted)
    if interrupted:
        raise Interrupted(record)
    if run.has_diverged:
        raise Diverged(record, run.why_diverged())
    return record


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


class Asked:
    """Checked arguments of `simulate`."""

    def __init__(
        self,
        duration: float,
        scheme: Scheme | None,
        step: float | None,
        sample_rate: float,
        probes: Sequence[Probe] | None,
        contact_solve: GaussSeidel | None,
        surface_rate: float | str | None = None,
        motion_rate: float | None = None,
    ) -> None:
        self.duration, self.step, self.sample_rate = positive("duration", duration), step, sample_rate
        self.common_step: float | None = None
        self.surface_rate = checked_rate(surface_rate)
        self.motion_rate = None if motion_rate is None else positive("motion_rate", motion_rate)
        self.scheme: Scheme = ExactModal() if scheme is None else scheme
        instance("scheme", self.scheme, (CentralDifference, ExactModal))
        if probes is not None and not isinstance(probes, Sequence):
            raise ArgumentError("probes", "be a list of probes", probes)
        self.probes = probes
        self.solve = GaussSeidel() if contact_solve is None else contact_solve
        instance("contact_solve", self.solve, GaussSeidel)

    def arrays(self, system: System) -> Arrays:
        """Return a system as flat arrays."""
        instance("system", system, System)
        probes = usual_probes(system) if self.probes is None else tuple(self.probes)
        for number, probe in enumerate(probes):
            instance(f"probes[{number}]", probe, Probe.__args__)
        if self.motion_rate is not None and not any(hasattr(probe, "of_each") for probe in probes):
            probes += tuple(ModalMotion(body) for body in system.bodies)
        return Arrays(system, probes, assemble(system, probes))

    def timing(self, arrays: Arrays, start: xr.Dataset | None = None) -> Timing:
        """Return the step and the sampling of a system, with the step of a record to continue if none is given."""
        step = self.step
        if step is None and isinstance(start, xr.Dataset) and "step" in start.attrs:
            step = float(start.attrs["step"])
        if self.common_step is None:
            timing = choose_timing(arrays.flat, self.scheme, self.duration, step, self.sample_rate)
        else:
            timing = _sampled(self.common_step, round(1.0 / (self.sample_rate * self.common_step)), self.duration)
        if self.motion_rate is None:
            return timing
        every = _intervals("motion_rate", self.motion_rate, timing)
        if every > timing.samples:
            least = at_least(1.0 / (timing.samples * timing.interval))
            raise ArgumentError("motion_rate", f"be at least 1 / duration, {least} Hz", self.motion_rate)
        return replace(timing, motion_every=every, samples=every * max(1, round(timing.samples / every)))

    @of_ordinary_size("system")
    def run(self, arrays: Arrays, start: xr.Dataset | None = None, title: str = "") -> Run:
        """Return the run of a system, ready to march."""
        timing = self.timing(arrays, start)
        every = self._every(arrays.system, timing)
        self._check_size(arrays, timing, every)
        surfaces = None
        if every:
            points = sum(map(bool, arrays.system.surface_names))
            kept = PointRecord(timing.samples, points, timing.ratio) if self.surface_rate is None else None
            surfaces = SurfaceRecord(arrays.system, arrays.flat.firsts, every, kept)
        return Run(arrays.system, arrays.flat, self.scheme, timing, arrays.probes, self.solve, start, title, surfaces)

    def _check_size(self, arrays: Arrays, timing: Timing, every: int) -> None:
        """Raise ValueError if a record would be too large."""
        system = arrays.system
        rows, more = len(system.contacts), 0
        if every:
            points = sum(map(bool, system.surface_names))
            more = bytes_of(timing.ratio) * points if self.surface_rate is None else 0
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
        asked = self.surface_rate
        if isinstance(asked, str) or (asked is None and not system.faces):
            return 0
        if asked is None:
            return max(1, round(1.0 / (timing.interval * MAP_RATE)))
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


def checked_rate(surface_rate: float | str | None) -> float | str | None:
    """Return a rate of maps of surfaces, ``"all"`` or None; ValueError for anything else."""
    if surface_rate is None or (isinstance(surface_rate, str) and surface_rate == ALL_POINTS):
        return surface_rate
    if isinstance(surface_rate, str):
        raise ArgumentError("surface_rate", f"be a rate in Hz or {ALL_POINTS!r}", surface_rate)
    return positive("surface_rate", surface_rate)


def choose_timing(arrays: Assembly, scheme: Scheme, duration: float, step: float | None, sample_rate: float) -> Timing:
    """Return the step and the sampling for the arguments of `simulate`."""
    positive("duration", duration)
    wanted = 1.0 / positive("sample_rate", sample_rate)
    if step is None:
        ratio = max(1, int(np.ceil(wanted / default_step(arrays, scheme, duration) - 1e-9)))
        step = wanted / ratio
    else:
        step, limit = positive("step", step), Stepping(arrays, scheme).limit
        if step >= limit:
            raise ArgumentError("step", f"be below the {scheme.name} scheme's limit of {at_most(limit)} s", step)
        if step < SMALLEST_SHARE * limit < np.inf:
            raise ArgumentError("step", f"be at least {at_least(SMALLEST_SHARE * limit, 3)} s for these modes", step)
        ratio = max(1, round(wanted / step))
    if ratio > LARGEST_RATIO:
        raise ArgumentError(
            "sample_rate",
            f"be at least {at_least(1.0 / (LARGEST_RATIO * step), 3)} Hz at a step of {step:.3g} s",
            sample_rate,
        )
    return _sampled(step, ratio, duration)


def _sampled(step: float, ratio: int, duration: float) -> Timing:
    interval = step * ratio
    if duration < 0.5 * interval:
        raise ArgumentError("duration", f"be at least half a sample interval of {at_least(interval)} s", duration)
    return Timing(step, ratio, max(1, round(duration / interval)))
