"""Fates of growing modes: runs from equilibrium perturbed by a mode, and their limit cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from ..acoustics.hearable import check_hearable
from ..acoustics.levels import LOWEST_RATE, SHORTEST, equivalent_level
from ..acoustics.radiate import radiate
from ..analysis.regimes import regime_of
from ..checks import ArgumentError
from ..drives import InitialEquilibrium
from ..linear.reach import ModesAtRest
from ..records import ModalMotion
from ..records.repeated import repeat_cycle
from ..records.variables import STATUS_WORDS
from ..scenarios.load import Scenario
from .cycle_ends import cycle_after
from .swings import growth_in_time, linear_time, relative, swing
from .tones_of_modes import Tone, tones_of

LIVES, JOINS, CHANGES, DIES = "lives", "joins", "changes", "dies"
NOT_REACHED, LEFT, FAILED = "not reached", "off the track", "failed"
FATES = (LIVES, JOINS, CHANGES, DIES, NOT_REACHED, LEFT, FAILED)
# Fates that end in a vibration.
VIBRATES = (LIVES, JOINS, CHANGES)
# Number of periods of the mode in the window over which a limit cycle is measured, and shortest length of the window
# [s].
PERIODS, SHORTEST_WINDOW = 100.0, 0.1
# Time in which a limit cycle settles once contacts open, stick or slip, in units of 1 / growth.
SETTLING = 5.0
# Fewest samples of a run.
FEWEST_SAMPLES = 8
# Number of samples recorded in a period of the highest mode of linear theory, if no sound is computed.
SAMPLES = 20.0
# Time after which a limit cycle is searched, once contacts open, stick or slip, in units of 1 / growth.
SEARCHED = 2.0
# A limit cycle is steady if the ratio of its swings in two successive windows is at most this.
STEADY = 1.25
# A motion has left linear theory if it grows by less than this fraction of the growth there.
BENT = 0.25
# Largest relative error of a swing due to periods that are no whole number of samples, in samples over the window.
UNEVEN = 4.0
# A vibration has died if its swing is below the first value, and below the second relative to the largest swing of the
# run; number of pieces compared.
DEAD, FADED, PIECES = 0.01, 0.1, 20


@dataclass(frozen=True)
class Options:
    """Options of the runs.

    Attributes
    ----------
    duration : float or None
        Time of each run [s]; from the growth rate if None.
    longest : float
        Longest time of a run without a given duration [s].
    amplitude : float
        Initial amplitude of the mode over its reach [1].
    resolution : float
        Largest distance of a tone from its mode, relative to it [1].
    highest : float
        Highest frequency of the modes that are simulated [Hz].
    velocity : float, tuple of float or None
        Slip velocity where nothing prescribes it [m/s].
    cycles : bool
        Whether limit cycles are searched directly.
    kicks : int
        Number of decaying modes from which squeal is searched where none grows.
    """

    duration: float | None
    longest: float
    amplitude: float
    resolution: float
    highest: float
    velocity: float | tuple[float, ...] | None
    cycles: bool
    kicks: int


@dataclass(frozen=True)
class Ended:
    """The end of a run from a growing mode.

    Attributes
    ----------
    run : xarray.Dataset
        The run.
    cycle : xarray.Dataset or None
        Limit cycle near its end, if one was found.
    record : xarray.Dataset
        The run itself, or the limit cycle at which it ends, repeated.
    measured : float
        Time at the end of `record` that is measured [s].
    """

    run: xr.Dataset
    cycle: xr.Dataset | None
    record: xr.Dataset
    measured: float

    @property
    def is_periodic(self) -> bool:
        """Whether the run ends at the limit cycle."""
        return self.record is not self.run


@dataclass(frozen=True)
class Runs:
    """Runs of a scenario from its equilibrium, each perturbed by a mode.

    Attributes
    ----------
    scenario : Scenario
        System, without its own start, and settings of its simulation.
    start : InitialEquilibrium
        The equilibrium.
    rest : ModesAtRest
        The modes about it.
    options : Options
        Options of the runs.
    watch : callable
        Called repeatedly; an exception that it raises ends a run.
    """

    scenario: Scenario
    start: InitialEquilibrium
    rest: ModesAtRest
    options: Options
    watch: Callable[[], None]

    @property
    def followed(self) -> list[int]:
        """Numbers of the growing modes that are simulated."""
        exponents = self.rest.exponents
        return [number for number in self.rest.reach if exponents[number].imag <= 2.0 * np.pi * self.options.highest]

    def of(self, number: int) -> Ended:
        """Return a run perturbed by a mode, until its limit cycle is found or steady, or the longest time is reached.

        Raises
        ------
        ValueError
            If a contact is about to change its status, or the mode moves no contact point.
        """
        reach = self.rest.reach[number]
        if reach == 0.0:
            raise ArgumentError("velocity", "be given: a contact is about to stick, slip, open or land at the start")
        if not np.isfinite(reach):
            raise ArgumentError("mode", "move a contact point to be simulated", got=f"{number}, which moves none")
        start = replace(self.start, mode=number, amplitude=self.options.amplitude * reach)
        given, longest = self.options.duration, self.options.longest
        if (given or longest) * self.sample_rate < FEWEST_SAMPLES:
            words = f"last {FEWEST_SAMPLES} samples, {FEWEST_SAMPLES / self.sample_rate:.3g} s, or longer"
            raise ArgumentError("duration" if given else "longest", words, given or longest)
        if given:
            return self._ended(self.simulate(start, given), number, None)
        run = self.simulate(start, min(longest, self._time(number, SEARCHED, 1)))
        cycle, searched = self.cycle_of(run, number), length_of(run)
        if cycle is None or not self.is_at(cycle, run, number):
            run = self.longer(run, start, min(longest, self._time(number, SETTLING, 2)) - searched)
            while not self.is_settled(run, number) and length_of(run) < longest - 0.5 * self.window(run, number):
                longer = self.longer(run, start, min(length_of(run), longest - length_of(run)))
                if longer is run:
                    break
                run = longer
            if length_of(run) > searched:
                later = self.cycle_of(run, number)
                cycle = cycle if later is None else later
        return self._ended(run, number, cycle)

    def longer(self, run: xr.Dataset, start: InitialEquilibrium, lasts: float) -> xr.Dataset:
        """Return a run continued for a time, itself if it has ended or the time is none."""
        if run.attrs["ended"] != "finished" or lasts * self.sample_rate < 1.0:
            return run
        more = self.simulate(start, lasts, start=run)
        run = xr.concat([run, more], "time", data_vars="minimal", coords="minimal", compat="override").assign(
            {name: more[name] for name in more if str(name).startswith("state_")}
        )
        run.attrs = more.attrs
        return run

    def cycle_of(self, run: xr.Dataset, number: int) -> xr.Dataset | None:
        """Return the limit cycle near the end of a run, None if there is none or none is asked for."""
        if not self.options.cycles or run.attrs["ended"] != "finished":
            return None
        if self.is_dead(run, number) or not self.has_left(run, number):
            return None
        frequency = float(self.rest.exponents[number].imag) / (2.0 * np.pi)
        probes = tuple(map(ModalMotion, self.scenario.system.bodies)) if self.is_heard else ()
        return cycle_after(self.scenario, run, frequency, probes, self.watch) if frequency > 0.0 else None

    def is_at(self, cycle: xr.Dataset, run: xr.Dataset, number: int) -> bool:
        """Return whether a cycle is stable and swings like the end of a run."""
        _, after = self.swings(run, number)
        swings = swing(relative(cycle, self.rest))
        return bool(cycle["stable"]) and after > 0.0 and bool(abs(np.log(swings / after)) < np.log(STEADY))

    def _ended(self, run: xr.Dataset, number: int, cycle: xr.Dataset | None) -> Ended:
        if cycle is None or not self.is_at(cycle, run, number):
            return Ended(run, cycle, run, 2.0 * self.window(run, number))
        measured = 2.0 * self.window_of(number)
        # What sounds at the start of a record is over before its end is measured.
        return Ended(run, cycle, repeat_cycle(cycle, 1.5 * measured), measured)

    @cached_property
    def still(self) -> xr.Dataset:
        """A run from equilibrium without a mode, as long as modes stay within linear theory."""
        lasts = [linear_time(self.rest, number, self.options.amplitude) for number in self.followed]
        return self.simulate(self.start, min(max(lasts), self.options.duration or self.options.longest))

    @cached_property
    def sample_rate(self) -> float:
        """Samples per second of the runs [Hz]: those of the scenario if it radiates sound, else no more than needed."""
        highest = float(np.abs(self.rest.exponents).max()) / (2.0 * np.pi)
        rate = self.scenario.sample_rate
        return rate if self.is_heard else min(rate, SAMPLES * highest)

    @cached_property
    def is_heard(self) -> bool:
        """Whether the system is in the plane and radiates sound."""
        system = self.scenario.system
        if system.is_spatial:
            return False
        try:
            check_hearable(system)
        except ArgumentError:
            return False
        return True

    def window(self, run: xr.Dataset, number: int) -> float:
        """Return the length of the windows in which a run is analysed [s]."""
        return min(self.window_of(number), 0.5 * length_of(run))

    def is_settled(self, run: xr.Dataset, number: int) -> bool:
        """Return whether a run has reached a steady limit cycle or rest."""
        return self.is_dead(run, number) or (self.has_left(run, number) and self.is_steady(run, number))

    def has_left(self, run: xr.Dataset, number: int) -> bool:
        """Return whether a run has left linear theory: contacts change their status, or it grows much more slowly."""
        window = self.window(run, number)
        shares = last(run, 2.0 * window)["status_share"].values
        if bool(((shares > 0.0) & (shares < 1.0)).any() or np.ptp(shares, axis=0).any()):
            return True
        # Swings of whole periods grow like the mode, up to the rounding of a period to samples.
        spans = self._span(run, number)
        grown = float(self.rest.exponents[number].real) * spans
        if spans <= 0.0 or (1.0 - BENT) * grown < UNEVEN * float(run.attrs["sample_interval"]) / spans:
            return False
        before, after = self.swings(run, number)
        return after > 0.0 and np.log(after / before) < BENT * grown

    def is_steady(self, run: xr.Dataset, number: int) -> bool:
        """Return whether the swings of a run in its last two windows are similar."""
        before, after = self.swings(run, number)
        return after > 0.0 and before > 0.0 and bool(abs(np.log(after / before)) < np.log(STEADY))

    def is_dead(self, run: xr.Dataset, number: int) -> bool:
        """Return whether a run has come to rest."""
        motion = relative(run, self.rest)
        largest = max(swing(piece) for piece in np.array_split(motion, min(PIECES, len(motion))))
        _, after = self.swings(run, number)
        return after < DEAD and after < FADED * largest

    def swings(self, run: xr.Dataset, number: int) -> tuple[float, float]:
        """Return the swings in the last two windows of a run [1]."""
        motion, lasts = relative(run, self.rest), self._span(run, number) or self.window(run, number)
        samples = max(1, round(lasts / float(run.attrs["sample_interval"])))
        return swing(motion[-2 * samples : -samples]), swing(motion[-samples:])

    def _span(self, run: xr.Dataset, number: int) -> float:
        """Return the time of the whole periods of a mode in a window [s], 0 if it is shorter than one."""
        window, frequency = self.window(run, number), float(self.rest.exponents[number].imag) / (2.0 * np.pi)
        return float(np.floor(window * frequency)) / frequency if frequency > 0.0 else window

    def _time(self, number: int, settling: float, windows: int) -> float:
        """Return the time in which a mode grows, settles and is measured [s]."""
        growth = float(self.rest.exponents[number].real)
        return (float(np.log(1.0 / self.options.amplitude)) + settling) / growth + windows * self.window_of(number)

    def window_of(self, number: int) -> float:
        """Return the length of the windows in which the end of a long run is analysed [s]."""
        exponent = self.rest.exponents[number]
        slowest = max(abs(float(exponent.imag)), abs(float(exponent.real)))
        return max(SHORTEST_WINDOW, PERIODS * 2.0 * np.pi / slowest)

    def simulate(self, begins: InitialEquilibrium, lasts: float, **words: Any) -> xr.Dataset:
        """Return a run from an equilibrium."""
        system = replace(self.scenario.system, drives=(*self.scenario.system.drives, begins))
        recorded: dict[str, Any] = {
            "sample_rate": self.sample_rate,
            "probes": (),
            "surface_rate": "all",
            "motion_rate": None,
        }
        scenario = replace(self.scenario, system=system, **recorded)
        return scenario.simulate(duration=lasts, watchers=[lambda progress: self.watch()], **words)


def last(run: xr.Dataset, lasts: float) -> xr.Dataset:
    """Return the last part of a run, `lasts` long [s]."""
    return run.isel(time=slice(-max(2, round(lasts / float(run.attrs["sample_interval"]))), None))


def fate_of(runs: Runs, number: int) -> dict[str, Any]:
    """Return the fate of a mode by names of variables of a survey, as plain numbers and texts.

    Parameters
    ----------
    runs : Runs
        The runs.
    number : int
        Number of the mode.
    """
    ended, rest = runs.of(number), runs.rest
    run, measured = ended.run, ended.measured
    seen = growth_in_time(run, runs.still, rest, number, runs.options.amplitude)
    end = last(ended.record, measured)
    contact, signal = _of_contact(end, _liveliest(end, rest)), liveliest_signal(end, rest)
    grows = np.array(list(rest.reach))
    found = (
        []
        if not ended.is_periodic and runs.is_dead(run, number)
        else tones_of(signal, rest.exponents, grows, runs.options.resolution)
    )
    regime = regime_of(ended.record, start=max(0.0, length_of(ended.record) - measured))
    fate, joined = _fate(runs, ended, number, found)
    shares = end["status_share"].mean([name for name in end["status_share"].dims if name != "contact_status"])
    return {
        "seen_frequency": abs(seen.imag) / (2.0 * np.pi),
        "seen_growth_rate": seen.real,
        "duration": length_of(run),
        "reached": float(ended.is_periodic or runs.has_left(run, number)),
        "steady": float(ended.is_periodic or runs.is_steady(run, number)),
        "fate": fate,
        "joined": joined,
        "regime": str(regime["regime"]),
        "confidence": float(regime["confidence"]),
        "normal_force_rms": float(contact["normal_force"].std()),
        "slip_velocity_rms": swing(contact["slip_velocity"].values.reshape(contact.sizes["time"], -1)),
        **{f"{word}_share": float(share) for word, share in zip(STATUS_WORDS, shares.values, strict=True)},
        "sound_level": _sound_level(runs, ended.record, measured),
        **_of_cycle(ended.cycle),
        "tones": [tone._asdict() for tone in found],
    }


def _of_cycle(cycle: xr.Dataset | None) -> dict[str, float]:
    """Return the frequency of a limit cycle and its stability, nothing without one."""
    if cycle is None:
        return {}
    sizes = np.hypot(*cycle["multiplier"].values[~cycle["trivial"].values].T)
    return {
        "cycle_frequency": float(cycle["frequency"]),
        "cycle_stable": float("nan") if cycle.attrs["verdict"].startswith("unknown") else float(cycle["stable"]),
        "leading_multiplier": float(sizes[0]) if sizes.size else 0.0,
    }


def _fate(runs: Runs, ended: Ended, number: int, found: list[Tone]) -> tuple[str, int]:
    """Return the fate of a mode, and the number of the mode that it joins, -1 for none."""
    run = ended.run
    if run.attrs["ended"] == LEFT:
        return LEFT, -1
    if not ended.is_periodic and runs.is_dead(run, number):
        return DIES, -1
    if not ended.is_periodic and not runs.has_left(run, number):
        return NOT_REACHED, -1
    mode = found[0].mode if found else -1
    if mode == number:
        return LIVES, -1
    return (JOINS, mode) if mode in runs.rest.reach else (CHANGES, -1)


def liveliest_signal(end: xr.Dataset, rest: ModesAtRest) -> xr.DataArray:
    """Return the normal force of the contact where it swings most, or its slip velocity if the force is constant."""
    which = _liveliest(end, rest)
    contact = _of_contact(end, which)
    force = contact["normal_force"]
    is_constant = swing(force.values[:, None]) < 1e-6 * float(rest.normal_force[which])
    return _liveliest_slip(contact) if is_constant else force


def _liveliest(end: xr.Dataset, rest: ModesAtRest) -> int:
    """Return the number of the contact whose normal force swings most, among those closed at rest."""
    forces = end["normal_force"].values.reshape(end.sizes["time"], -1)
    return int(np.where(rest.normal_force > 0.0, forces.std(axis=0), -1.0).argmax())


def _liveliest_slip(contact: xr.Dataset) -> xr.DataArray:
    """Return the slip velocity of a contact, in space along the tangent of largest swing."""
    slip = contact["slip_velocity"]
    return slip.isel(tangent=int(slip.std("time").values.argmax())) if "tangent" in slip.dims else slip


def _of_contact(run: xr.Dataset, number: int) -> xr.Dataset:
    return run.isel(contact=number) if "contact" in run.dims else run


def _sound_level(runs: Runs, run: xr.Dataset, lasts: float) -> float:
    """Return LAeq at the end of a run at the louder ear [dB], NaN if there is no sound."""
    if not runs.is_heard or lasts < SHORTEST or runs.sample_rate < LOWEST_RATE:
        return float("nan")
    # The forces at rest act long before the start of the run, which makes no sound.
    system = runs.scenario.system
    pressure = radiate(run, replace(system, drives=(*system.drives, runs.start)))
    return float(equivalent_level(last_of(pressure, lasts, run), "A").max())


def last_of(signal: xr.DataArray, lasts: float, run: xr.Dataset) -> xr.DataArray:
    """Return the last part, `lasts` long [s], of a signal sampled like a run."""
    return signal.isel(time=slice(-round(lasts / float(run.attrs["sample_interval"])), None))


def length_of(run: xr.Dataset) -> float:
    """Return the time that a run lasts [s]."""
    return float(run.sizes["time"] * run.attrs["sample_interval"])
