"""Measures that decide the regime of a contact, or of several together, from the plain arrays of a record."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, at_least, positive, within
from .heard import Frames, frames
from .pitch import AudibleSpectrum, audible_spectrum
from .several_contacts import cycles, landings_of, loads, mean_shares, statuses, stretches, together
from .status_changes import MIXED, last_rest
from .status_cycles import StatusCycles

STICKING = 1
# If the status changes within more than this share of the samples, the cycle is faster than the samples. A cycle with
# eight samples per period has a share of a quarter.
UNRESOLVED = 0.5
# A growing tone counts from this fraction of `faint` on.
BUDDING = 0.02
# If the level in bursts is less than this fraction of that of the whole record, the bursts are not what is heard [1].
FAINTER = 0.5
# Length of the shortest cycle of the status that samples show [samples].
SHORTEST_CYCLE = 1.5


class Signals(NamedTuple):
    """The arrays of a record that decide the regime.

    Attributes
    ----------
    interval : float
        Interval of the samples [s].
    share : ndarray, shape (samples, contacts, 3)
        Share of each status [1].
    normal : ndarray, shape (samples, contacts)
        Normal force of each contact [N].
    forces : ndarray, shape (forces, samples)
        Normal forces of the groups of contacts that count as one, then tangential forces [N].
    groups : int
        Number of such groups.
    landings : ndarray, shape (samples, contacts), or None
        Landings in each sample [1]; counted from the shares if None.
    lost, rubbed : ndarray, shape (samples,)
        Energy lost to damping and impacts, and to friction, since the start [J].
    step : float
        Time step [s], 0 if unknown.
    """

    interval: float
    share: Array
    normal: Array
    forces: Array
    groups: int
    landings: Array | None
    lost: Array
    rubbed: Array
    step: float


@dataclass(frozen=True)
class Thresholds:
    """Thresholds between the regimes; see `regime`.

    Attributes
    ----------
    rest, tonal, faint, lossy, rare : float
        Shares and ratios [1].
    lowest_tone : float
        Frequency [Hz].
    frame : float
        Length [s].
    rate : float
        Samples per second [Hz].
    """

    rest: float = 0.5
    tonal: float = 0.5
    faint: float = 0.05
    lossy: float = 0.01
    rare: float = 0.05
    lowest_tone: float = 300.0
    frame: float = 30e-3
    rate: float = 10e3

    def __post_init__(self) -> None:
        for name in ("rest", "tonal", "rare"):
            within(name, getattr(self, name), 0.0, 1.0, ends=False)
        for name in ("faint", "lossy", "rate"):
            positive(name, getattr(self, name))
        within("lowest_tone", self.lowest_tone, 1e-3, 1e6)
        within("frame", self.frame, 1e-6, 1e4)
        if self.rate < 2.0 * self.lowest_tone:
            raise ArgumentError(
                "rate", f"be at least twice the lowest tone, {at_least(2.0 * self.lowest_tone)} Hz", self.rate
            )


@dataclass(frozen=True)
class Measures:
    """Measures that decide the regime of a run, without the ignored beginning.

    Attributes
    ----------
    separated, sticking, sliding : float
        Shares of the time [1].
    tonality : float
        Share of the audible power that repeats itself [1]; for cycles of faint forces the share of them that recur, for
        cycles faster than the samples their similarity.
    audibility : float
        Root mean square of the audible forces over the mean normal force [1].
    growth : float
        Audibility of the later half of the time over that of the earlier half [1], NaN for one frame.
    tone : float
        Pitch of the forces in bursts, or frequency of a cycle faster than the samples [Hz]; NaN if nothing is audible.
    cycle : float
        Frequency of the cycles of stick and slip, or of a cycle faster than the samples [Hz]; NaN for fewer than two.
    periodicity : float
        Regularity of the ends of the slips [1], NaN for fewer than three.
    impact_rate, slip_rate : float
        Landings, and slips, per second [1/s].
    change_rate : float
        Least number of cycles of changing status per second that explains the samples [1/s], or their frequency in
        bursts if they recur.
    settle_time : float
        Time, since the first sample interval, after which the status no longer changes [s]; NaN if it does.
    level, swing : float
        Root mean square of the fluctuation over the mean normal force [1]: of the normal force, and of both forces.
    unsettled : float
        Share of the record before the status settles [1], 1 if it does not.
    loss, loss_growth : float
        Energy lost to damping and impacts in the later half of the time over that lost to friction, and over that
        lost to damping and impacts in the earlier half [1].
    last_status : int
        Status in which the run settles: 0 separated, 1 sticking, 2 sliding if any contact slides, -1 none.
    slips : int
        Number of slips that end in a stick phase.
    periods : float
        Periods of the tone in the slips that make up half of the slip time, slips faster than the lowest tone counted
        as one [1]; infinite if it always slips, NaN without an audible tone.
    is_short : bool
        Whether there are fewer than two frames.
    """

    separated: float
    sticking: float
    sliding: float
    tonality: float
    audibility: float
    growth: float
    tone: float
    cycle: float
    periodicity: float
    impact_rate: float
    slip_rate: float
    change_rate: float
    settle_time: float
    level: float
    swing: float
    unsettled: float
    loss: float
    loss_growth: float
    last_status: int
    slips: int
    periods: float
    is_short: bool


class Listened(NamedTuple):
    """A record without the ignored beginning.

    Attributes
    ----------
    first : int
        First sample that counts.
    carried : ndarray, shape (contacts,)
        Share of the load on each contact [1].
    status : ndarray, shape (contacts that count, samples)
        Statuses, of the whole record.
    rest : int
        First sample of the last rest.
    settles : bool
        Whether the rest decides the regime.
    heard_from : int
        First sample whose forces are heard: that of the rest if it settles.
    slipping : StatusCycles
        Cycles of the status from the first sample on.
    heard : Frames
        Audible forces.
    spectrum : AudibleSpectrum
        Their spectrum in bursts.
    """

    first: int
    carried: Array
    status: Array
    rest: int
    settles: bool
    heard_from: int
    slipping: StatusCycles
    heard: Frames
    spectrum: AudibleSpectrum


def _listened(signals: Signals, start: float, limits: Thresholds) -> Listened:
    interval, count = signals.interval, signals.share.shape[0]
    first = min(round(start / interval), count - 1)
    carried = loads(signals.normal[first:], limits.rare)
    status = statuses(signals.share, carried)
    rest = last_rest(stretches(status))
    settles = rest <= limits.rest * count
    heard_from = min(max(first, rest), count - 1) if settles else first
    sticking = together(signals.share[first:, :, STICKING], carried)
    slipping = StatusCycles(sticking, signals.step / interval, 1.0 / (limits.lowest_tone * interval))
    forces = signals.forces[:, heard_from:]
    heard = _heard(forces, interval, limits)
    spectrum = _spectrum(forces, interval, None if settles else slipping.bursts, heard, limits)
    return Listened(first, carried, status, rest, settles, heard_from, slipping, heard, spectrum)


def other_tones(signals: Signals, start: float, limits: Thresholds, pitch: float, most: int) -> Array:
    """Return the frequencies of tones beside a pitch, and not partials of it [Hz], the strongest first.

    Parameters
    ----------
    signals : Signals
        Arrays of a record.
    start : float
        Time at the beginning that is ignored [s].
    limits : Thresholds
        Thresholds of settled and audible motion.
    pitch : float
        The pitch [Hz].
    most : int
        Largest number of tones.
    """
    return _listened(signals, start, limits).spectrum.beside(pitch, most)


def measures(signals: Signals, start: float, limits: Thresholds) -> Measures:
    """Return the measures of a run.

    Parameters
    ----------
    signals : Signals
        Arrays of its record.
    start : float
        Time at the beginning that is ignored [s].
    limits : Thresholds
        Thresholds of settled, audible and tonal motion.
    """
    interval, count = signals.interval, signals.share.shape[0]
    first, carried, status, rest, settles, heard_from, slipping, heard, spectrum = _listened(signals, start, limits)
    time = (count - first) * interval
    normal = signals.forces[: signals.groups, first:]
    mean = math.hypot(*np.abs(normal).mean(axis=1).tolist()) or 1.0
    landings = None if signals.landings is None else signals.landings[first:]
    landed = landings_of(landings, signals.share[first:, :, 0])
    change_rate = cycles(status[:, first:], landed[carried > 0.0]) / time
    loss, loss_growth = _losses(signals, heard_from)
    swing = float(np.sqrt(signals.forces[:, heard_from:].var(axis=1).sum())) / mean
    counted = heard.later_half() if settles else heard
    audibility = counted.level / mean
    recurring = 1.0 / (slipping.period * interval)
    # Cycles that recur in bursts are faster than the mean rate of changes.
    change_rate = max(change_rate, recurring) if recurring > 0.0 else change_rate
    tonality, tone, cycle = counted.tonality, float("nan"), 1.0 / (slipping.rhythm * interval)
    cycle = recurring if recurring > 0.0 else cycle
    if audibility < limits.faint and recurring >= limits.lowest_tone:
        tonality = max(tonality, slipping.recurrence)
    is_loud = audibility >= limits.faint or change_rate >= limits.lowest_tone
    is_hidden = np.mean(status[:, first:] == MIXED, axis=1).max() >= UNRESOLVED
    if audibility < limits.faint and is_hidden and spectrum.level < limits.faint * mean:
        tonality, tone = _likeness(signals.forces[:, first:], mean), change_rate
        if slipping.period >= SHORTEST_CYCLE:
            tonality, tone = slipping.recurrence, recurring
        cycle = tone
    elif is_loud or (heard.growth > 1.0 and audibility >= BUDDING * limits.faint):
        tone = spectrum.pitch_among(recurring)
    elif settles and loss >= limits.lossy and swing < limits.faint:
        # A vibration that the samples do not show is at their rate, or a multiple of it.
        tonality, tone = 1.0, 1.0 / interval
    separated, stuck, sliding = mean_shares(signals.share[first:], carried).tolist()
    return Measures(
        separated=separated,
        sticking=stuck,
        sliding=sliding,
        tonality=tonality,
        audibility=audibility,
        growth=heard.growth,
        tone=tone,
        cycle=cycle,
        periodicity=slipping.periodicity,
        impact_rate=float(landed.sum()) / time,
        slip_rate=len(slipping.cycles) / time,
        change_rate=change_rate,
        settle_time=rest * interval if rest < count else float("nan"),
        level=math.hypot(*normal.std(axis=1).tolist()) / mean,
        swing=swing,
        unsettled=rest / count,
        loss=loss,
        loss_growth=loss_growth,
        last_status=int(status[:, -1].max()) if settles else MIXED,
        slips=len(slipping.caught),
        periods=slipping.prevailing_vibration * interval * tone,
        is_short=(count - heard_from) * interval < 1.5 * limits.frame,
    )


def _spectrum(
    forces: Array, interval: float, bursts: Array | None, heard: Frames, limits: Thresholds
) -> AudibleSpectrum:
    """Return the audible spectrum of the forces in bursts, or of all where there are none or these are fainter."""
    if bursts is not None:
        found = audible_spectrum(forces, interval, bursts, limits.frame, limits.lowest_tone)
        if found.level >= FAINTER * heard.level:
            return found
    whole = np.array([[0, forces.shape[1]]])
    return audible_spectrum(forces, interval, whole, limits.frame, limits.lowest_tone)


def _heard(forces: Array, interval: float, limits: Thresholds) -> Frames:
    """Return the audible forces, averaged to about the rate over whole numbers of samples.

    Recorded forces are means over the sample interval, so that this equals a record at a lower rate.
    """
    ratio = max(1, int(min(1.0 / (limits.rate * interval), forces.shape[1]) * (1.0 + 1e-9)))
    end = forces.shape[1] // ratio * ratio
    means = np.asarray(sum(forces[:, i:end:ratio] for i in range(ratio)) / ratio)
    return frames(means, ratio * interval, limits.frame, limits.lowest_tone)


def _likeness(forces: Array, mean: float) -> float:
    """Return the similarity of successive samples: 1 minus the rms of their differences over the mean force."""
    return max(0.0, 1.0 - float(np.sqrt(np.mean(np.diff(forces, axis=1) ** 2) * len(forces))) / mean)


def _losses(signals: Signals, first: int) -> tuple[float, float]:
    """Return the loss to damping and impacts in the later half, over that to friction and over that in the earlier."""
    middle = (first + signals.lost.size - 1) // 2
    early, late = float(signals.lost[middle] - signals.lost[first]), float(signals.lost[-1] - signals.lost[middle])
    rubbed = float(signals.rubbed[-1] - signals.rubbed[middle])
    return late / rubbed if rubbed > 0.0 else 0.0, late / early if early > 0.0 else float("nan")
