"""A setting of the demonstration: its run, its regime, the lines of its sound, and its motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

import stridula as st

from .drawn import Array, Drawn
from .instruments import Instrument
from .tones import amplitudes, base_of, lines_of, looped, power

RATE = 48e3
# Largest numbers of lines of a sound and of harmonics of a motion; lines weaker than this [dB] are left out.
LINES, HARMONICS, WEAK = 64, 16, 60.0
# Share of the power that the multiples of a base carry in a cycle.
CYCLE = 0.9
# A run is steady if its vibration changes by less than this between the last quarters of a part [dB].
STEADY = 0.1
REFERENCE = 20e-6
SILENT = ("stable sliding", "sliding", "sticking", "off the track")


@dataclass(frozen=True)
class Setting:
    """What a run of a setting has shown.

    Attributes
    ----------
    regime : str
        Regime of the end of the run.
    pitch : float
        Its pitch [Hz]; nan if it is silent.
    base : float
        Frequency whose multiples are the lines [Hz]; nan if it is silent.
    share : float
        Share of the power of the sound in the lines kept [1].
    level : float
        Level of the sound [dB]; nan if it is silent.
    repeated : bool
        Whether there is no cycle, and a stretch of the run is repeated.
    lines : ndarray of complex, shape (lines,)
        Amplitudes of the pressure at the multiples of the base [Pa].
    motion : dict of int to ndarray of complex, shape (points, 3)
        Displacement of the drawn points at multiples of the base [m].
    marks : list of int
        Points that are marked.
    """

    regime: str
    pitch: float
    base: float
    share: float
    level: float
    repeated: bool
    lines: Array
    motion: dict[int, Array]
    marks: list[int]


def record(instrument: Instrument, x: float, y: float) -> Setting:
    """Run a setting until it is steady, and return what it shows.

    Parameters
    ----------
    instrument : Instrument
        The case.
    x, y : float
        Values of its axes.
    """
    system = instrument.scenario(x, y).system
    drawn = instrument.drawn(system)
    run = settled(instrument, system)
    regime, pitch = instrument.regime(run)
    if regime in SILENT:
        return Setting(regime, *[float("nan")] * 2, 1.0, float("nan"), False, np.zeros(0, complex), {}, drawn.marks)
    samples = round(instrument.heard * RATE)
    pressure = instrument.pressure(run, system)[-samples:, None]
    velocity = run.modal_motion.values[-samples:].astype(float)
    base, share = base_of(pressure[:, 0], RATE, pitch, instrument.highest)
    repeated = share < CYCLE
    if repeated:
        count = round(instrument.loop * RATE)
        base = RATE / count
        pressure, velocity = looped(pressure, count), looped(velocity, count)
        lines, moved = lines_of(pressure), lines_of(velocity)
    else:
        number = int(instrument.highest / base)
        lines, moved = (amplitudes(signals, RATE, base, number) for signals in (pressure, velocity))
    lines = strongest(lines[: int(instrument.highest / base), 0], LINES)
    carried = float(0.5 * np.sum(np.abs(lines) ** 2))
    # What still changes has other power under another window: no more than all is in the lines.
    whole = max(float(np.var(pressure)) if repeated else power(pressure[:, 0]), carried)
    share = carried / whole
    level = 10.0 * float(np.log10(whole / REFERENCE**2))
    motion = motion_of(run, moved, drawn, base)
    # Forces may have an octave of the tone that is heard.
    pitch = min(pitch, base * (int(np.abs(lines).argmax()) + 1))
    return Setting(regime, pitch, base, share, level, repeated, lines, motion, drawn.marks)


def strongest(lines: Array, count: int) -> Array:
    """Return lines without all but the strongest, and without those that are weak."""
    sizes = np.abs(lines)
    least = max(10.0 ** (-WEAK / 20.0) * sizes.max(), np.sort(sizes)[-min(count, sizes.size)])
    return np.asarray(np.where(sizes < least, 0.0, lines))


def settled(instrument: Instrument, system: st.System) -> xr.Dataset:
    """Return the last part of a run, once its vibration changes no more or the longest time is over."""
    moving = [body for body in system.bodies if system.body_name(body) in instrument.moving]
    probes: list[Any] = [st.ModalMotion(body) for body in moving]
    if instrument.at_bridge:
        probes.append(st.SupportForce(moving[0], "left"))
    run, lasted = None, 0.0
    while True:
        run = st.simulate(system, instrument.part, start=run, sample_rate=RATE, probes=probes)
        lasted += instrument.part
        if steady(run) or lasted >= instrument.longest:
            return run


def steady(run: xr.Dataset) -> bool:
    """Return whether the vibration of the last quarter of a record is as large as that of the quarter before."""
    motion = run.modal_motion.values
    quarter = len(motion) // 4
    last, before = (float(np.mean(part**2)) for part in (motion[-quarter:], motion[-2 * quarter : -quarter]))
    return abs(10.0 * np.log10(last / before)) < STEADY


def motion_of(run: xr.Dataset, moved: Array, drawn: Drawn, base: float) -> dict[int, Array]:
    """Return the displacement of the drawn points [m], (points, 3), by the strongest multiples of a frequency."""
    names = run.modal_motion_body.values
    number = np.arange(1, len(moved) + 1)
    amounts = moved / (2j * np.pi * base * number)[:, None]
    kept = np.sort(np.linalg.norm(amounts, axis=1).argsort()[-HARMONICS:])
    traces = [(drawn.traces[name], names == name) for name in drawn.traces]
    return {
        int(number[k]): np.asarray(sum(np.einsum("pim,m->pi", trace, amounts[k, own]) for trace, own in traces))
        for k in kept
    }
