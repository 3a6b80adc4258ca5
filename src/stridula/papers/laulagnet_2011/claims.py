"""Claims of the paper, and their measurement on our runs.

Tolerances were declared before the search for the parameters. A claim used in the search is `fitted`, any other
`predicted`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr

from ... import analysis
from ...acoustics import Air
from ...acoustics.pressures import channels
from ...acoustics.weighting import a_weighted
from ...arrays import Array
from .pressure import LOADS, ladder_words, relaxation, relaxations, rise_without_a_fall
from .runs import Runs, median_over_starts


@dataclass(frozen=True)
class Claim:
    """One claim of the paper.

    Attributes
    ----------
    claim : str
        Description of the claim.
    section : str
        Section of the paper.
    printed : str
        Value or words printed in the paper.
    low, high : float
        Range, ends included, in which the measured value must lie.
    units : str
        Unit of the measured value.
    measure : callable
        Function of `Runs` that returns the value.
    fitted : bool
        Whether the search for the parameters used it.
    detail : callable, optional
        Function of `Runs` that returns a sentence with details of the value.
    chaotic : str, optional
        Case whose runs diverge from starts that differ by parts in a million: the value is the median over starts.
    """

    claim: str
    section: str
    printed: str
    low: float
    high: float
    units: str
    measure: Callable[[Runs], float]
    fitted: bool = True
    detail: Callable[[Runs], str] | None = None
    chaotic: str = ""

    @property
    def tolerance(self) -> str:
        """The range as text."""
        unit = f" {self.units}" if self.units != "1" else ""
        if np.isinf(self.high):
            return f"at least {self.low:.4g}{unit}"
        if np.isinf(self.low):
            return f"at most {self.high:.4g}{unit}"
        return f"{self.low:.4g} to {self.high:.4g}{unit}"

    def check(self, runs: Runs) -> dict[str, Any]:
        """Return the row of `claims.json`."""
        values = self.values(runs)
        value, interval = median_over_starts(values)
        row: dict[str, Any] = {
            "claim": self.claim,
            "section": self.section,
            "printed": self.printed,
            "measured": value if np.isfinite(value) else None,
            "units": self.units,
            "tolerance": self.tolerance,
            "holds": bool(self.low <= value <= self.high),
            "basis": "fitted" if self.fitted else "predicted",
        }
        if self.chaotic:
            row |= {"starts": values.size, "interval": interval}
        if self.detail is not None:
            row["detail"] = self.detail(runs)
        return row

    def values(self, runs: Runs) -> Array:
        """Return the value from each start, shape (starts,), or (1,) if one start suffices."""
        if not self.chaotic:
            return np.array([float(self.measure(runs))])
        together = {claim.claim: claim.measure for claim in CLAIMS if claim.chaotic == self.chaotic}
        values = runs.once(f"{self.chaotic} over starts", lambda: runs.over_starts(self.chaotic, together))
        return np.asarray(values[self.claim])


def near(printed: float, share: float) -> tuple[float, float]:
    """Return the range of plus or minus a fraction of a printed number."""
    return printed * (1.0 - share), printed * (1.0 + share)


# Section 3.1


def slides_from(runs: Runs) -> float:
    """Return the time from which 3.1 slides permanently [s]; NaN unless that lasts to the end at 1 s or later."""
    run = runs.record("stable-sliding")
    lasted = run.attrs["ended"] == "finished" and float(run["time"][-1]) >= 1.0 - 1e-9
    return analysis.settling_time(run) if lasted else float("nan")


def _settled(run: xr.Dataset) -> xr.Dataset:
    return run.sel(time=slice(analysis.settling_time(run), None)).isel(time=slice(1, None))


def friction_cone(runs: Runs) -> float:
    """Return the largest ``| |tangential| / (friction normal) - 1 |`` [1] once 3.1 slides permanently."""
    run = _settled(runs.record("stable-sliding"))
    friction = runs.scenario("stable-sliding").system.contacts[0].friction.coefficient_at(1.0)
    return float(np.abs(np.abs(run.tangential_force) / (friction * run.normal_force) - 1.0).max())


def force_jump(runs: Runs) -> float:
    """Return the largest jump of the normal force at 10 kHz over its mean [1], once 3.1 slides permanently."""
    force = _settled(runs.record("stable-sliding"))["normal_force"]
    return analysis.largest_jump(force) / float(force.mean())


# Section 3.2


def stop_length(runs: Runs) -> float:
    """Return the median length of the complete stops of 3.2 [s]."""
    run = runs.record("squeal")
    return _median_length(analysis.complete(analysis.stops(run), run))


def burst_spacing(runs: Runs) -> float:
    """Return the median time between the starts of successive bursts of 3.2 [s]."""
    starts = analysis.bursts(runs.record("squeal"))[:, 0]
    return float(np.median(np.diff(starts))) if starts.size > 1 else float("nan")


def burst_irregularity(runs: Runs) -> float:
    """Return the interquartile range of the times from burst to burst of 3.2 over their median [1]."""
    spacings = np.diff(analysis.bursts(runs.record("squeal"))[:, 0])
    if not spacings.size:
        return float("nan")
    low, middle, high = np.percentile(spacings, [25.0, 50.0, 75.0])
    return float((high - low) / middle)


def burst_length(runs: Runs) -> float:
    """Return the median length of the bursts of 3.2 [s]."""
    return _median_length(analysis.bursts(runs.record("squeal")))


def squeal_frequency(runs: Runs) -> float:
    """Return the dominant frequency of the normal force inside the bursts of 3.2 [Hz]."""
    run = runs.record("squeal")
    return analysis.dominant_frequency(run["normal_force"], analysis.bursts(run))


def burst_separation(runs: Runs) -> float:
    """Return the median share of a burst of 3.2 after 0.2 s that is separated [1]."""
    run = runs.record("squeal")
    shares = [analysis.status_share(run, "separated", burst[None]) for burst in _late_bursts(run)]
    return float(np.median(shares)) if shares else float("nan")


def burst_swing(runs: Runs) -> float:
    """Return the median peak-to-peak over mean of the normal force in the bursts of 3.2 after 0.2 s [1]."""
    run = runs.record("squeal")
    return analysis.swing(run["normal_force"], _late_bursts(run))


def stops_in_a_second(runs: Runs) -> float:
    """Return the number of stops of 3.2 in its first second."""
    return float(len(analysis.stops(runs.record("squeal").sel(time=slice(0.0, 1.0)))))


def advance_in_stops(runs: Runs) -> float:
    """Return the share of the advance of 3.2 made during stops [1]."""
    run = runs.record("squeal")
    return abs(analysis.advance(run, analysis.stops(run)) / analysis.advance(run))


def last_burst(runs: Runs) -> float:
    """Return the start of the last burst of 3.2 that is separated for at least 10 % of its length [s]."""
    run = runs.record("squeal")
    starts = [burst[0] for burst in analysis.bursts(run) if _lifts_off(run, burst)]
    return float(starts[-1]) if starts else float("nan")


def _lifts_off(run: xr.Dataset, burst: Any) -> bool:
    return analysis.status_share(run, "separated", burst[None]) >= 0.1


def _lift_offs(runs: Runs) -> str:
    run = runs.record("squeal")
    late = _late_bursts(run)
    count = sum(_lifts_off(run, burst) for burst in late)
    return f"{count} of {len(late)} bursts after 0.2 s lift off (separated at least 10 %); the others only slip"


def _late_bursts(run: xr.Dataset) -> Any:
    found = analysis.bursts(run)
    return found[found[:, 0] >= 0.2]


def _median_length(intervals: Any) -> float:
    return float(np.median(np.diff(intervals, axis=1))) if len(intervals) else float("nan")


# Section 3.3


def axial_slides_from(runs: Runs) -> float:
    """Return the time from which the axial case below friction 1 slides permanently [s]."""
    run = runs.record("axial-sliding")
    return analysis.settling_time(run)


def unchanged(case: str) -> Callable[[Runs], float]:
    """Return the measure of the longest time without a change of status [s]."""
    return lambda runs: analysis.longest_unchanged(runs.record(case))


def separated(case: str) -> Callable[[Runs], float]:
    """Return the measure of the share of the time that is separated [1]."""
    return lambda runs: analysis.status_share(runs.record(case), "separated")


def peaks_over_squeal(case: str) -> Callable[[Runs], float]:
    """Return the measure of a case's 99.9th percentile of the normal force over that of 3.2 [1]."""

    def ratio(runs: Runs) -> float:
        peak, squeal = (analysis.peak_level(runs.record(name)["normal_force"]) for name in (case, "squeal"))
        return peak / squeal

    return ratio


# Section 3.4


def acceleration_follows(runs: Runs) -> float:
    """Return the correlation of the envelopes of normal force and track-centre acceleration under 2 N [1]."""
    run = runs.record("weak-pressure")
    return analysis.envelope_correlation(run["normal_force"], run["acceleration"][:, 0])


def sticks_per_second(runs: Runs) -> float:
    """Return the number of sticks longer than 20 ms per second under 50 N [1/s]."""
    run = runs.record("strong-pressure")
    return len(analysis.stops(run)) / float(run["time"][-1])


def relaxation_share(status: str) -> Callable[[Runs], float]:
    """Return the measure of the share of a status in the relaxations under 50 N [1]."""

    def share(runs: Runs) -> float:
        run = runs.record("strong-pressure")
        return analysis.status_share(run, status, analysis.bursts(run))

    return share


def relaxation_frequency(runs: Runs) -> float:
    """Return the dominant frequency of the normal force in the relaxations under 50 N [Hz]."""
    return relaxation(runs.record("strong-pressure"))[0]


def pressure_raises_frequency(runs: Runs) -> float:
    """Return the least rise of the median frequency from load to load of `LOADS`, in units of its resolution [1]."""
    pairs = pairwise(relaxations(runs, LOADS))
    return float(min((b.median - a.median) / max(a.resolved, b.resolved) for a, b in pairs))


def _frequencies_under_load(runs: Runs) -> str:
    return ", ".join(
        f"{one.load:g} N: {one.median:.0f} Hz (resolution {one.resolved:.0f} Hz)" for one in relaxations(runs, LOADS)
    )


# Onset


def onset(case: str) -> Callable[[Runs], float]:
    """Return the measure of the smallest coefficient of friction whose last 0.3 s are not all sliding."""
    return lambda runs: min((mu for mu, how in runs.ladder(case).items() if how != "sliding"), default=float("nan"))


def _endings(case: str) -> Callable[[Runs], str]:
    def words(runs: Runs) -> str:
        ladder = runs.ladder(case)
        groups = {how: [mu for mu, was in ladder.items() if was == how] for how in ("sliding", "vibrating", "stuck")}
        return "; ".join(f"{how} at {', '.join(f'{mu:g}' for mu in mus)}" for how, mus in groups.items() if mus)

    return words


# Strongest tones of the A-weighted sound, which the paper does not have


def heard_tone(case: str) -> Callable[[Runs], float]:
    """Return the measure of the strongest tone [Hz] of a case's A-weighted sound in its bursts."""

    def measure(runs: Runs) -> float:
        frequency, _ = _heard(runs, case)
        return float(frequency[0]) if frequency.size else float("nan")

    return measure


def _strongest(case: str) -> Callable[[Runs], str]:
    def words(runs: Runs) -> str:
        pairs = zip(*_heard(runs, case), strict=True)
        return "A-weighted: " + ", ".join(f"{tone:.0f} Hz ({level:.0f} dB)" for tone, level in list(pairs)[:4])

    return words


def _heard(runs: Runs, case: str) -> tuple[Any, Any]:
    """Return the tones of a case's A-weighted sound in its bursts, delayed by the travel time of the sound."""
    values, rate = channels(runs.sound(case).isel(listener=[0]))
    heard = xr.DataArray(a_weighted(values, rate)[:, 0], {"time": np.arange(values.shape[0]) / rate}, "time")
    late = 1.0 / Air().speed
    return analysis.tones(heard, analysis.bursts(runs.record(case)) + late)


INFINITE = float("inf")

CLAIMS = (
    Claim("slides for good from", "3.1", "0.25 s", *near(0.25, 0.2), "s", slides_from),
    Claim("on the Coulomb cone while sliding", "3.1", "|T| = mu N", -INFINITE, 1e-9, "1", friction_cone, fitted=False),
    Claim("no jump of the normal force over its mean", "3.1", "no discontinuity", -INFINITE, 0.2, "1", force_jump),
    Claim("length of the stops", "3.2", "0.07 s", *near(0.07, 0.1), "s", stop_length),
    Claim("spacing of the bursts", "3.2", "0.1 s", *near(0.1, 0.1), "s", burst_spacing),
    Claim("spread of the spacing over its median", "3.2", "periodic", -INFINITE, 0.25, "1", burst_irregularity),
    Claim("length of a burst", "3.2", "0.02 s", *near(0.02, 0.25), "s", burst_length),
    Claim("frequency of the limit cycle", "3.2", "900 Hz", *near(900.0, 0.1), "Hz", squeal_frequency),
    Claim(
        "separated inside a burst",
        "3.2",
        "mixed sliding-separate",
        0.1,
        INFINITE,
        "1",
        burst_separation,
        detail=_lift_offs,
    ),
    Claim("limit cycle: peak to peak over mean", "3.2", "appears and disappears", 2.0, INFINITE, "1", burst_swing),
    Claim("stairs: stops in 1 s", "3.2", "periodic stops", 6.0, INFINITE, "1", stops_in_a_second),
    Claim(
        "bursts with lift-off recur: start of the last in 1 s", "3.2", "periodically", 0.8, INFINITE, "s", last_burst
    ),
    Claim("stairs: share of the advance made in stops", "3.2", "stops", -INFINITE, 0.05, "1", advance_in_stops),
    Claim("axial, friction 0.5: slides for good from", "3.3", "stable", -INFINITE, 0.5, "s", axial_slides_from),
    Claim(
        "longest time without a change",
        "3.3",
        "never stabilises",
        -INFINITE,
        0.05,
        "s",
        unchanged("judder"),
        chaotic="judder",
    ),
    Claim("separated", "3.3", "quite continuous", 0.5, INFINITE, "1", separated("judder"), chaotic="judder"),
    Claim(
        "peaks over those of 3.2",
        "3.3",
        "well higher",
        2.0,
        INFINITE,
        "1",
        peaks_over_squeal("judder"),
        chaotic="judder",
    ),
    Claim(
        "2 N: longest time without a change",
        "3.4",
        "judder",
        -INFINITE,
        0.05,
        "s",
        unchanged("weak-pressure"),
        chaotic="weak-pressure",
    ),
    Claim("2 N: separated", "3.4", "judder", 0.5, INFINITE, "1", separated("weak-pressure"), chaotic="weak-pressure"),
    Claim(
        "2 N: peaks over those of 3.2",
        "3.4",
        "judder",
        2.0,
        INFINITE,
        "1",
        peaks_over_squeal("weak-pressure"),
        chaotic="weak-pressure",
    ),
    Claim(
        "2 N: acceleration follows the force",
        "3.4",
        "similar",
        0.8,
        INFINITE,
        "1",
        acceleration_follows,
        chaotic="weak-pressure",
    ),
    Claim(
        "50 N: sticks over 20 ms per second",
        "3.4",
        "sticking phases",
        3.0,
        INFINITE,
        "1/s",
        sticks_per_second,
        chaotic="strong-pressure",
    ),
    Claim(
        "50 N: separated in relaxations",
        "3.4",
        "switches",
        0.1,
        0.9,
        "1",
        relaxation_share("separated"),
        chaotic="strong-pressure",
    ),
    Claim(
        "50 N: sliding in relaxations",
        "3.4",
        "switches",
        0.1,
        0.9,
        "1",
        relaxation_share("sliding"),
        chaotic="strong-pressure",
    ),
    Claim(
        "50 N: frequency of relaxations",
        "3.4",
        "2500 Hz",
        *near(2500.0, 0.1),
        "Hz",
        relaxation_frequency,
        chaotic="strong-pressure",
    ),
    Claim(
        "least rise of frequency from 20 to 40, 80, 150 N, in resolutions",
        "3.4",
        "higher with pressure",
        1.0,
        INFINITE,
        "1",
        pressure_raises_frequency,
        fitted=False,
        detail=_frequencies_under_load,
    ),
    Claim(
        "10 to 200 N: rise of the median frequency, without a fall",
        "3.4",
        "higher with pressure",
        2.0,
        INFINITE,
        "1",
        rise_without_a_fall,
        fitted=False,
        detail=ladder_words,
    ),
    Claim(
        "heard: the strongest tone of the bursts",
        "3.2",
        "900 Hz",
        *near(900.0, 0.1),
        "Hz",
        heard_tone("squeal"),
        fitted=False,
        detail=_strongest("squeal"),
    ),
    Claim(
        "heard: the strongest tone of the relaxations",
        "3.4",
        "2500 Hz",
        *near(2500.0, 0.1),
        "Hz",
        heard_tone("strong-pressure"),
        fitted=False,
        detail=_strongest("strong-pressure"),
        chaotic="strong-pressure",
    ),
    Claim(
        "onset, transverse force",
        "3.1",
        "tan 45° = 1",
        0.9,
        1.1,
        "1",
        onset("stable-sliding"),
        fitted=False,
        detail=_endings("stable-sliding"),
    ),
    Claim(
        "onset, axial force",
        "3.3",
        "1",
        0.9,
        1.1,
        "1",
        onset("axial-sliding"),
        fitted=False,
        detail=_endings("axial-sliding"),
    ),
)
