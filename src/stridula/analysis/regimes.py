"""The regime of one or several contacts: sliding, sticking, stick-slip, squeal, judder or off the track."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, instance, listed, within
from ..records import checked
from ..records.by_point import by_point
from ..records.by_surface import groups
from ..records.endings import FAILED
from ..records.plain import PlainRecord, plain_of
from .regime_measures import BUDDING, Measures, Signals, Thresholds, measures, other_tones
from .several_contacts import sums

REGIMES = ("stable sliding", "sticking", "stick-slip", "squeal", "judder", "off the track")
SLIDES, STICKS, SLIPS, SQUEALS, JUDDERS, LEFT = REGIMES

LIMITS = Thresholds()
# Fraction of the record ignored by default.
TRANSIENT = 0.1
# Ratio of a tone in the second half of the time to that in the first. Below the first value it dies away; above the
# second it grows.
KEPT, GROWING = 0.5, 2.0
# Number of periods in one slip above which a tone counts as sustained. A released mode is caught within one period.
SUSTAINED = 2.0
# Required variables of a record.
NEEDED = (
    "status_share",
    "normal_force",
    "tangential_force",
    "damping_loss",
    "impact_loss",
    "friction_loss",
)
# Variables of each contact.
OF_CONTACTS = ("status_share", "normal_force", "tangential_force", "landings")
# Variables that are used. If landings are not recorded, they are counted from the shares.
TAKEN = (*NEEDED, "landings")
MEANINGS = {
    "regime": ("1", "regime of the contact"),
    "confidence": ("1", "confidence in the regime, 0.5 at a threshold"),
    "separated": ("1", "share of the time separated"),
    "sticking": ("1", "share of the time sticking"),
    "sliding": ("1", "share of the time sliding"),
    "tonality": ("1", "share of the audible power that repeats itself"),
    "audibility": ("1", "audible forces over the mean normal force"),
    "periodicity": ("1", "regularity of the slips"),
    "frequency": ("Hz", "pitch of the tone, or frequency of the slips"),
    "impact_rate": ("1/s", "landings per second"),
    "slip_rate": ("1/s", "slips from one stick phase to the next, per second"),
    "settle_time": ("s", "time from which the status does not change"),
    "level": ("1", "fluctuation of the normal force over its mean"),
}


def regime(
    run: xr.Dataset,
    *,
    start: float | None = None,
    rest: float = Thresholds.rest,
    tonal: float = Thresholds.tonal,
    faint: float = Thresholds.faint,
    lossy: float = Thresholds.lossy,
    rare: float = Thresholds.rare,
    lowest_tone: float = Thresholds.lowest_tone,
    frame: float = Thresholds.frame,
    rate: float = Thresholds.rate,
) -> xr.Dataset:
    """Return the regime of a run, of one contact or of all together, and the measures that decide it.

    A run is at rest if its status does not change over its last half: then it slides stably, sticks, or has left its
    track, but squeals if it slides with a tone that does not die away. Else it squeals if its audible forces are tonal,
    judders if it separates, and is in stick-slip if it sticks. The documentation gives the reasons.

    Several contacts have one regime: shares of the time are weighted by the load of each contact, slips are those of
    contacts that carry most of the load, and the powers of their forces are added, with the points of a surface summed
    first. Select contacts for the regime of a part: ``run.sel(contact="a")``, ``run.isel(contact=run.surface ==
    "pad")``.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`, or of some of its contacts.
    start : float, optional
        Time at the beginning that is ignored [s]; a tenth of the record if left out.
    rest : float, optional
        Fraction of the record [1]: a status that settles before this decides the regime.
    tonal : float, optional
        Share of the audible power that repeats itself within ``1 / lowest_tone``, above which it is a tone [1].
    faint : float, optional
        Audible forces over the mean normal force, below which nothing is audible [1].
    lossy : float, optional
        Energy lost to damping over that lost to friction, above which sliding hides a vibration [1].
    rare : float, optional
        Share of the time below which a status does not count [1].
    lowest_tone : float, optional
        Lowest frequency of a tone [Hz]; slower cycles are stick-slip.
    frame : float, optional
        Length of the frames in which tones are sought [s].
    rate : float, optional
        Rate to which the forces are averaged for that [Hz]; at higher sample rates the result does not depend on them.

    Returns
    -------
    xarray.Dataset
        Scalars: ``regime``, one of `REGIMES`; ``confidence`` [1], ``0.5 + 0.5 min(1, |log2 r|)`` with r the factor by
        which the least clear of the decisive measures differs from its threshold; the shares ``separated``,
        ``sticking`` and ``sliding``; ``tonality``, ``audibility``, ``periodicity``, ``frequency``, ``impact_rate``,
        ``slip_rate``, ``settle_time`` and ``level``. The frequency is that of the slips in stick-slip, else the pitch
        of the forces in the bursts; it is NaN if nothing is audible, and a lower bound if the cycle is faster than the
        samples.

    Raises
    ------
    ValueError
        If the record has fewer than 2 samples or no contact, or an argument is out of its range.
    """
    limits = Thresholds(rest, tonal, faint, lossy, rare, lowest_tone, frame, rate)
    values = regime_of(run, start=start, limits=limits)
    words = {name: {"units": units, "long_name": meaning} for name, (units, meaning) in MEANINGS.items()}
    return xr.Dataset({name: ((), values[name], words[name]) for name in MEANINGS})


def regime_of(
    run: xr.Dataset | PlainRecord, *, start: float | None = None, limits: Thresholds = LIMITS
) -> dict[str, float | str]:
    """Return the regime of a run, its confidence and the measures of `regime` by name, faster than `regime`.

    Parameters
    ----------
    run : xarray.Dataset or PlainRecord
        A record of `simulate`.
    start : float, optional
        Time at the beginning that is ignored [s]; a tenth of the record if left out.
    limits : Thresholds, optional
        The thresholds of `regime`.
    """
    instance("limits", limits, Thresholds)
    signals = signals_of(run)
    found = measures(signals, _left_aside(signals, start), limits)
    name, confidence = decide(found, limits, str(run.attrs.get("ended", "finished")))
    values: dict[str, float | str] = {"regime": name, "confidence": confidence}
    values["frequency"] = found.cycle if name == SLIPS else found.tone
    return values | {word: getattr(found, word) for word in MEANINGS if word not in values}


def tones_beside(run: xr.Dataset | PlainRecord, pitch: float, most: int = 3) -> Array:
    """Return the frequencies of the tones of the contact forces beside the pitch of a run [Hz], the strongest first.

    They are sought where the pitch is, in the bursts if there are any, and are at most 20 dB weaker than the strongest.

    Parameters
    ----------
    run : xarray.Dataset or PlainRecord
        A record of `simulate`.
    pitch : float
        Its pitch [Hz], the ``frequency`` of `regime`.
    most : int, optional
        Largest number of tones.
    """
    signals = signals_of(run)
    return other_tones(signals, _left_aside(signals, None), LIMITS, pitch, most)


def _left_aside(signals: Signals, start: float | None) -> float:
    """Return the time at the beginning that is ignored [s]."""
    length = signals.interval * signals.share.shape[0]
    return TRANSIENT * length if start is None else within("start", start, 0.0, length)


def signals_of(run: xr.Dataset | PlainRecord) -> Signals:
    """Return the plain arrays of a record that decide its regime."""
    given: Any = run
    held: PlainRecord = given if hasattr(given, "by_contact") and _is_usable(given) else _checked(given)
    time, members = held["time"], groups(held.contacts, held.surfaces)
    normal, tangential = held.by_contact("normal_force"), held.by_contact("tangential_force")
    # In space, one row for each tangent.
    along = tangential.reshape(*normal.shape, -1)
    heard = [values for number in range(along.shape[2]) for values in sums(along[..., number], members)]
    return Signals(
        interval=float((time[-1] - time[0]) / (time.size - 1)),
        share=held.by_contact("status_share"),
        normal=normal,
        forces=np.vstack([*sums(normal, members), *heard]),
        groups=len(members),
        landings=held.by_contact("landings") if "landings" in held.variables else None,
        lost=held["damping_loss"] + held["impact_loss"],
        rubbed=held["friction_loss"],
        step=float(run.attrs.get("step", 0.0)),
    )


def _is_usable(run: PlainRecord) -> bool:
    return run.time.size > 1 and all(name in run for name in NEEDED)


def _checked(run: Any) -> PlainRecord:
    """Return the plain arrays of a record; raise ValueError unless it has the required variables."""
    if isinstance(run, xr.DataArray):
        raise ArgumentError("run", "be a record, a Dataset (analysis.vibration_regime takes a signal)", run)
    given = run.labelled(*run.variables) if hasattr(run, "labelled") else run
    held = by_point(checked.record("run", given, *NEEDED, least=2))
    if "landings" in held.variables:
        checked.record("run", held, "landings")
    if not held.sizes.get("contact", 1):
        raise ArgumentError("run", "have a contact", got="none")
    for word in OF_CONTACTS:
        if word in held.variables and held[word].dims[1:2] != ("contact",) and "contact" in held.dims:
            dimensions = listed(map(str, held[word].dims))
            raise ArgumentError("run", f"have a {word} of each contact", got=f"one over {dimensions}")
    return plain_of(held.squeeze("contact") if held.sizes.get("contact") == 1 else held)


def decide(found: Measures, limits: Thresholds, ended: str = "finished") -> tuple[str, float]:
    """Return the regime that follows from measures, and the confidence in it.

    Each measure becomes a margin, the binary logarithm of its ratio to its threshold; for shares, of the ratio of odds.
    A regime that needs several conditions has the least of their margins, one that needs any of several the largest.

    Parameters
    ----------
    found : Measures
        The measures of a run.
    limits : Thresholds
        Their thresholds.
    ended : str, optional
        Ending of the run. A run off its track has that regime; a failed run is judged by its record so far.
    """
    if ended == LEFT:
        return LEFT, 1.0
    name, margin = _at_rest(found, limits) if found.last_status >= 0 else _on_the_move(found, limits)
    margin = min(margin, abs(above(found.unsettled, limits.rest)))
    if ended in FAILED or found.is_short:
        margin = 0.0
    return name, 0.5 + 0.5 * min(1.0, margin)


def _at_rest(found: Measures, limits: Thresholds) -> tuple[str, float]:
    """Return the regime of a run whose status settles, and its margin."""
    if found.last_status != 2:
        return (STICKS if found.last_status == 1 else LEFT), math.inf
    tonal, heard = _tonal(found, limits), above(found.audibility, limits.faint)
    kept = min(tonal, heard, above(found.growth, KEPT))
    growing = min(tonal, above(found.audibility, BUDDING * limits.faint), above(found.growth, GROWING))
    hidden = min(
        above(found.loss, limits.lossy),
        above(found.loss_growth, KEPT),
        -above(found.swing, limits.faint),
        above(found.tone, limits.lowest_tone),
    )
    squeals = max(kept, growing, hidden)
    return (SQUEALS, squeals) if squeals >= 0.0 else (SLIDES, -squeals)


def _on_the_move(found: Measures, limits: Thresholds) -> tuple[str, float]:
    """Return the regime of a run whose status keeps changing, and its margin."""
    # A cycle of states this fast is a limit cycle, even if its forces are faint.
    heard = max(above(found.audibility, limits.faint), above(found.change_rate, limits.lowest_tone))
    sustained = math.inf if math.isnan(found.periods) else above(found.periods, SUSTAINED)
    squeals = min(heard, _tonal(found, limits), sustained)
    if squeals >= 0.0:
        return SQUEALS, squeals
    # The share is relative to the time without sticking, so that the length of stick phases does not matter.
    moving = found.separated + found.sliding
    opens = odds_above(found.separated / moving if moving else 0.0, limits.rare)
    if opens >= 0.0:
        return JUDDERS, min(-squeals, opens)
    # A rare state is incidental, unless it recurs.
    sticks, returns = odds_above(found.sticking, limits.rare), above(found.slips, 2.0)
    if sticks < 0.0 and returns < 0.0:
        return SLIDES, min(-squeals, -opens, -sticks)
    holds = odds_above(found.sticking, 1.0 - limits.rare)
    if holds >= 0.0 and returns < 0.0:
        return STICKS, min(-squeals, holds)
    return SLIPS, min(-squeals, -opens, max(returns, min(sticks, -holds)))


def _tonal(found: Measures, limits: Thresholds) -> float:
    """Return how far the tonality is above its threshold; power without a pitch repeats itself as cycles do."""
    return -math.inf if math.isnan(found.tone) else odds_above(found.tonality, limits.tonal)


def above(value: float, threshold: float) -> float:
    """Return the number of factors of two by which a measure is above its threshold; an unknown one is below it."""
    return math.log2(value / threshold) if value > 0.0 else -math.inf


def odds_above(share: float, threshold: float) -> float:
    """Return the number of factors of two by which the odds of a share are above those of its threshold."""
    if not 0.0 < share < 1.0:
        return math.inf if share >= 1.0 else -math.inf
    return above(share / (1.0 - share), threshold / (1.0 - threshold))
