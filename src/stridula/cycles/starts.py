"""Starts of the search for a periodic motion: the end of a record, a mode of linear theory, or a system's own start."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import ceil, inf
from typing import Any

import numpy as np
import xarray as xr

from ..analysis.regimes import regime
from ..analysis.stability import stability_of
from ..arrays import Array
from ..checks import ArgumentError, count, instance, positive, within
from ..drives import InitialEquilibrium
from ..histories import Constant, Harmonic
from ..integration.default_step import default_step
from ..integration.equilibrium_start import in_equilibrium
from ..integration.marches import Impositions, March
from ..integration.period_map import MarchEnded, PeriodMap, carried_on, moving_along
from ..integration.restart import state_at_end
from ..integration.settings import Settings
from ..integration.simulate import simulate
from ..integration.start import state_at_start
from ..integration.state_vectors import StateVectors
from ..linear.structure import check_flat
from ..lowering import Assembly, assemble
from ..lowering.blocks import blocks_of
from ..lowering.signals import later
from ..records.state import State
from ..system import System
from .drive_periods import drive_period, settled_at
from .means import grown, repeating
from .returning import Orbit

# Periods in which a motion may come back; how much nearer it must come after more than one, unless it is as near as
# this share of its largest distance; the same where drives prescribe the time.
RETURNS, NEARER, NEAR, NEAR_DRIVEN = 4.3, 3.0, 0.02, 1e-3
# Instants of an expected period at which distances are taken, where drives do not prescribe them.
LOOKS = 480
# Share of the expected period before which a motion does not count as back.
SOONEST = 0.3
# Largest residual by default.
TOLERANCE = 1e-9
# Periods for which a system runs from its own start.
PERIODS = 300
# Samples of a period in that run.
PER_PERIOD = 64
# Fewest steps of a period, and steps after which contacts have a past.
FEWEST, PAST = 20, 5


@dataclass(frozen=True)
class Asked:
    """A search for a cycle, as asked for in `limit_cycle`.

    Attributes
    ----------
    start : xarray.Dataset, InitialEquilibrium or None
        Start of the search.
    settings : Settings
        Settings of the march and of the record.
    frequency : float or None
        Expected frequency [Hz].
    settle : int or None
        Periods that are marched before the search.
    tolerance : float, optional
        Largest residual [1].
    most : float, optional
        Periods marched after which the search takes no further step.
    """

    start: xr.Dataset | InitialEquilibrium | None
    settings: Settings
    frequency: float | None
    settle: int | None
    tolerance: float = TOLERANCE
    most: float = inf

    def check(self) -> None:
        """Raise ValueError at the first argument that no system allows."""
        if self.start is not None:
            instance("start", self.start, (xr.Dataset, InitialEquilibrium))
        if self.start is not None and not isinstance(self.start, xr.Dataset) and self.start.mode is None:
            raise ArgumentError("start", "have a mode and its amplitude", self.start)
        if self.frequency is not None:
            positive("frequency", self.frequency)
        if self.settle is not None:
            count("settle", self.settle, low=0)
        within("tolerance", self.tolerance, 1e-13, 0.1)
        self.settings.check()


@dataclass(frozen=True)
class Beginning:
    """The beginning of a search.

    Attributes
    ----------
    of_period : PeriodMap
        March of a period.
    vectors : StateVectors
        States as vectors.
    orbit : Orbit
        The motion from which the search begins.
    is_driven : bool
        Whether drives prescribe the period.
    """

    of_period: PeriodMap
    vectors: StateVectors
    orbit: Orbit
    is_driven: bool


@dataclass(frozen=True)
class _Motion:
    """A motion at one instant.

    Attributes
    ----------
    state : State
        Its state.
    step, time : float
        Step of the march, and time of the state [s].
    imposed : ndarray, shape (contacts, motions)
        Motion imposed on each contact by then [m].
    """

    state: State
    step: float
    time: float
    imposed: Array


def beginning_of(system: System, asked: Asked) -> Beginning:
    """Return the beginning of a search.

    Raises
    ------
    ValueError
        If the start does not fit the system, or if no period is known.
    MarchEnded
        If a march ends before the search.
    """
    start, settings, frequency, settle = asked.start, asked.settings, asked.frequency, asked.settle
    if start is not None and not isinstance(start, xr.Dataset):
        system = _started(system, start)
    check_flat(system, "in searches for cycles")
    flat = assemble(system)
    _check(system, flat)
    driven, settled = drive_period(flat), settled_at(flat)
    if start is None:
        period = _guessed(frequency, driven, system)
        duration = settled + (PERIODS if settle is None else settle) * period
        rate = min(settings.sample_rate, PER_PERIOD / period)
        start, settle = simulate(system, duration, **(settings.of_run | {"sample_rate": rate, "probes": ()})), 0
    if isinstance(start, xr.Dataset):
        motion = _at_end(start, flat)
        period = _expected(start, frequency, driven, system)
        if "period" not in start:
            motion = motion if driven is None else _at_whole_period(flat, settings, motion, driven)
            period = _returned(flat, settings, motion, period, driven)
        step = settings.step or motion.step
    else:
        period = _guessed(frequency, driven, system)
        step = settings.step or default_step(flat, settings.scheme, period)
        motion = _at_start(in_equilibrium(system, flat), settings, step)
    steps = max(FEWEST, ceil(period / step * (1.0 - 1e-9)))
    periods = ceil(settled / period) + 1 if settled > 0.0 else 0
    of_period = PeriodMap(flat, settings.scheme, settings.solve, steps, periods * steps)
    there = flat.motion(np.array([periods * period]), period / steps)[0]
    state = carried_on(flat, motion.state, there - motion.imposed)
    vectors = StateVectors(flat, period)
    orbit = Orbit(vectors.vector(state, motion.step), period, vectors.status(state))
    if not isinstance(start, xr.Dataset) and not settle:
        # A start has no past, which contacts carry; the motion that drives prescribe needs a whole period.
        orbit = _later(of_period, vectors, orbit, 1 if driven else PAST / steps)
    orbit = _later(of_period, vectors, orbit, settle or 0)
    if isinstance(start, xr.Dataset) and "period" not in start:
        orbit = grown(of_period, vectors, orbit) if driven is None else orbit
        orbit = repeating(of_period, vectors, orbit, driven is not None)
    return Beginning(of_period, vectors, orbit, driven is not None)


def _started(system: System, start: InitialEquilibrium) -> System:
    """Return a system with another start, and with the values of its drives in the end."""
    kept = [_settled(one) for one in system.drives if one is not system.initial_equilibrium]
    return System(system.contact, [*kept, start], system.connections)


def _check(system: System, flat: Assembly) -> None:
    """Raise unless a system may have periodic motions."""
    for number in moving_along(flat, settled_at(flat)):
        name = system.contact_names[number]
        raise ArgumentError("system", "keep its contacts in place", got=f"{name}, which travels along a track")
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        if contact.heating is not None:
            words = "have contacts without heating, as temperatures do not repeat: take friction.at(temperature)"
            raise ArgumentError("system", words, got=f"{contact.heating} under {name}")
        if contact.friction.depends_on_place:
            words = "have friction that is the same along the track: take friction.at(place)"
            raise ArgumentError("system", words, got=f"{contact.friction} under {name}")


def _settled(drive: Any) -> Any:
    """Return a drive with the value that it has in the end, if it has one."""
    history = getattr(drive, "history", None)
    if history is None or not history.settled:
        return drive
    last = float(history.factor(np.array([history.settled]))[0])
    return replace(drive, history=Constant() if last == 1.0 else Harmonic(1.0, amplitude=0.0, mean=last))


def _expected(start: xr.Dataset, frequency: float | None, driven: float | None, system: System) -> float:
    """Return the expected period of a record [s]; that of a cycle may be a multiple of that of the drives."""
    if "period" in start:
        known = float(start["period"])
        return known if driven is None else max(1, round(known / driven)) * driven
    if driven is None and frequency is None:
        found = float(regime(start)["frequency"])
        if np.isfinite(found):
            return 1.0 / found
    return _guessed(frequency, driven, system)


def _guessed(frequency: float | None, driven: float | None, system: System) -> float:
    """Return the period [s] of the drives or as given, else of the start's mode, else of the one that grows fastest."""
    if driven is not None:
        return driven
    if frequency is not None:
        return 1.0 / frequency
    if system.initial_equilibrium is not None:
        in_equilibrium(system, assemble(system))
        turned = abs(system.kept["start"].exponent.imag)
        if turned > 0.0:
            return float(2.0 * np.pi / turned)
    found = float(stability_of(system)["flutter_frequency"])
    if not found > 0.0:
        raise ArgumentError("frequency", "be given: the start has no pitch, and no mode grows about the equilibrium")
    return 1.0 / found


def _at_start(placed: Assembly, settings: Settings, step: float) -> _Motion:
    """Return the motion of a system at its start."""
    blocks = blocks_of(placed, settings.scheme, step)
    state = state_at_start(placed, settings.scheme, step, blocks, settings.solve)
    return _Motion(state, step, 0.0, placed.motion(np.zeros(1), step)[0])


def _at_end(start: xr.Dataset, flat: Assembly) -> _Motion:
    """Return the motion at the end of a record."""
    state = state_at_end(start, flat)
    imposed = start["state_motion"].values[1:].sum(axis=0)
    step, last = float(start.attrs["step"]), int(start.attrs["last_step"])
    return _Motion(replace(state, remainder=0.0 * state.remainder), step, last * step, imposed)


def _at_whole_period(flat: Assembly, settings: Settings, motion: _Motion, period: float) -> _Motion:
    """Return a motion at the next beginning of a period of the drives."""
    left = ceil(motion.time / period - 1e-9) * period - motion.time
    if left < 1e-9 * period:
        return motion
    steps = ceil(left / motion.step)
    step = left / steps
    waiting = _since(flat, motion.time)
    state = _in_steps(flat, StateVectors(flat, period), motion, step).state
    march, imposed = _march(waiting, settings, state, step)
    chunk = march.advance([imposed.on(0, steps)], steps)[0]
    if chunk.completed < steps:
        raise MarchEnded("the record cannot be continued")
    time = motion.time + left
    return _Motion(march.states[0], step, time, flat.motion(np.array([time]), step)[0])


def _since(flat: Assembly, time: float) -> Assembly:
    """Return a system with the time counted from `time` [s]."""
    return replace(flat, signals=flat.signals.since(time), motion=later(flat.motion, time))


def _march(flat: Assembly, settings: Settings, state: State, step: float) -> tuple[March, Impositions]:
    blocks = blocks_of(flat, settings.scheme, step)
    begun = replace(state, energies=np.zeros_like(state.energies))
    return March([blocks], [begun], step, 1, settings.solve), Impositions(flat, blocks, step)


def _returned(flat: Assembly, settings: Settings, motion: _Motion, period: float, driven: float | None) -> float:
    """Return the time after which a motion comes back to its state [s], near a multiple of the expected period."""
    vectors = StateVectors(flat, period)
    if driven is not None:
        motion = _in_steps(flat, vectors, motion, driven / ceil(driven / motion.step))
    every = 1 if driven is not None else max(1, round(period / motion.step) // LOOKS)
    looks = ceil(RETURNS * period / (every * motion.step))
    distances = np.array(list(_distances(flat, settings, motion, vectors, looks, every)))
    times = every * motion.step * np.arange(1, looks + 1)
    if driven is not None:
        each = round(driven / motion.step)
        near = distances[each - 1 :: each]
        return float((1 + np.argmax(near <= max(NEARER * near.min(), NEAR_DRIVEN * distances.max()))) * driven)
    first, second = np.diff(distances**2), np.diff(distances**2, 2)
    back = 1 + np.flatnonzero((first[:-1] <= 0.0) & (first[1:] > 0.0) & (times[1:-1] > SOONEST * period))
    if not back.size:
        return period
    # Each lowest distance, by a parabola through three of them.
    shift = -0.5 * (first[back - 1] + first[back]) / second[back - 1]
    lowest = np.sqrt(np.maximum(distances[back] ** 2 - 0.5 * second[back - 1] * shift**2, 0.0))
    chosen = np.argmax(lowest <= max(NEARER * lowest.min(), NEAR * distances.max()))
    return float(times[back[chosen]] + shift[chosen] * every * motion.step)


def _in_steps(flat: Assembly, vectors: StateVectors, motion: _Motion, step: float) -> _Motion:
    """Return a motion in steps of another length."""
    state = vectors.state(vectors.vector(motion.state, motion.step), step, vectors.status(motion.state))
    imposed = flat.motion(np.array([motion.time]), step)[0]
    return _Motion(carried_on(flat, state, imposed - motion.imposed), step, motion.time, imposed)


def _distances(
    flat: Assembly, settings: Settings, motion: _Motion, vectors: StateVectors, looks: int, every: int
) -> Iterator[float]:
    """Yield the distance of a motion from its state after every so many steps."""
    begun = carried_on(flat, motion.state, flat.motion(np.array([motion.time]), motion.step)[0] - motion.imposed)
    march, imposed = _march(_since(flat, motion.time), settings, begun, motion.step)
    origin = begun.modal.copy()
    for number in range(looks):
        chunk = march.advance([imposed.on(number * every, every)], every)[0]
        if chunk.completed < every:
            raise MarchEnded("the record cannot be continued")
        yield vectors.norm(vectors.of_modes(march.states[0].modal - origin, motion.step))


def _later(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit, periods: float) -> Orbit:
    """Return a motion some periods later."""
    step = orbit.period / of_period.steps
    state, steps = vectors.state(orbit.vector, step, orbit.status), round(periods * of_period.steps)
    for passed in [of_period.steps] * (steps // of_period.steps) + [steps % of_period.steps]:
        if passed:
            state = of_period.after(state, orbit.period, passed).state
    return Orbit(vectors.vector(state, step), orbit.period, vectors.status(state))
