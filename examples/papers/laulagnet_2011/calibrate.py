"""Search for one set of beams, force and start point under which the paper's numbers come out.

The paper prints neither dimensions nor material nor damping. This searches a steel pair of one section with
`st.calibrate` from a seed, in two stages:

    python examples/papers/laulagnet_2011/calibrate.py wide [SEED] [GENERATIONS]
    python examples/papers/laulagnet_2011/calibrate.py refine [SEED] [GENERATIONS]

`wide` starts all over the physical ranges below and then goes on, with narrower aims, from the best set that it found;
`refine` starts around the shipped set. The objective adds up, over the claims marked as fitted, the squares of how far
each measure lies outside its aim, in units of half the tolerance: the middle 70 % in the wide stage, all but the last
5 % in the narrower one, or more for measures that differ from one perturbed start to another. Cases are taken in turn,
and a candidate that already fails on one is not run on the others. The ladders of friction and of pressure are never
looked at.

Prints every improvement as overrides of the scenarios, at the end the claims of the best set.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import groupby
from typing import Any

import numpy as np
from scipy.stats import qmc

import stridula as st
from stridula.papers.laulagnet_2011 import CLAIMS, Claim, Runs

TRACK = 1.4
# For a track of that length; a set is then scaled as a whole.
RANGES = {
    "slider.length": st.Range(0.35, 0.65),
    "section.height": st.Range(0.006, 0.016),
    "section.width": st.Range(0.003, 0.100, logarithmic=True),
    "damping.ratio": st.Range(5e-4, 0.02, logarithmic=True),
    "damping.slope": st.Range(5e-7, 2e-5, logarithmic=True),
    "start": st.Range(0.15, 0.45),
    # Sections 3.1 to 3.3 know force and width only by their ratio.
    "force per width": st.Range(30.0, 1000.0, logarithmic=True),
    "contact.gap": st.Range(1e-6, 1e-4, logarithmic=True),
}
SCALES = np.geomspace(1.0 / 1.4, 1.4, 201)
# Claims of 3.2 whose values are times, and those that are frequencies.
TIMES, FREQUENCIES = (
    ("length of the stops", "spacing of the bursts", "length of a burst"),
    ("frequency of the limit cycle",),
)
# What grows with the scale: see `scaled`.
LENGTHS = ("slider.length", "track.length", "section.height", "contact.gap", "damping.slope", "force per width")
SCREENED, POPULATION = 3000, 64
# Starts of the cases that are chaotic in the narrower stage: each of them is to meet the aims.
STARTS = 4
# Sums of squared misses of a case from which a candidate is not run on the next ones, all over the ranges and with
# narrower aims.
GIVE_UP_WIDE, GIVE_UP_NARROW = 3.0, 30.0
# The squeal is the hardest to meet, so it comes first.
ORDER = {"3.2": 0, "3.1": 1, "3.3": 2, "3.4": 3}
CHAOTIC = {claim.chaotic for claim in CLAIMS}
FITTED = sorted((claim for claim in CLAIMS if claim.fitted), key=lambda claim: ORDER[claim.section])
CASES = {
    "3.2": ("squeal",),
    "3.1": ("stable-sliding",),
    "3.3": ("axial-sliding", "judder"),
    "3.4": ("weak-pressure", "strong-pressure"),
}


class CandidateRuns(Runs):
    """Runs under a candidate, whose force and start point enter each case in its own way."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = values
        self.force = values["force per width"] * values["section.width"]
        self.start = values["start"] * values["track.length"]
        own = {
            key: value for key, value in values.items() if key.startswith(("slider.", "track.", "section.", "contact."))
        }
        law = {"law": "rising", "ratio": values["damping.ratio"], "slope": values["damping.slope"]}
        super().__init__(own | {"damping": law})

    def scenario(self, case: str, **overrides: Any) -> Any:
        """Return a case under the candidate; the axial cases start mirrored and are pushed along the axis."""
        axial = case in ("axial-sliding", "judder")
        own = {"contact.at": self.overrides["track.length"] - self.start if axial else self.start}
        if axial:
            own["axial"] = -self.force
        elif case in ("stable-sliding", "squeal"):
            own["transverse"] = self.force
        return super().scenario(case, **own, **overrides)

    def keep(self, case: str, record: Any) -> None:
        """Keep the record of a case that was made elsewhere."""
        self._records[case] = record


def scaled(values: Mapping[str, float], scale: float) -> dict[str, float]:
    """Return a set whose times are longer by a factor, and its frequencies lower.

    Similarity: where lengths, height and gap grow by a factor, so do all times; forces grow with it and with the width,
    and a damping that rises with frequency rises less steeply.
    """
    full = {"track.length": TRACK, **values}
    return {key: value * scale if key in LENGTHS else value for key, value in full.items()}


def shipped() -> dict[str, float]:
    """Return the parameters of the shipped scenarios, scaled to the track of the search."""
    system = Runs().scenario("squeal").system
    section, damping = system.track.section, system.track.damping
    full = {
        "slider.length": system.slider.length,
        "track.length": system.track.length,
        "section.height": section.height,
        "section.width": section.width,
        "damping.ratio": damping.ratio,
        "damping.slope": damping.slope,
        "start": system.contact.at / system.track.length,
        "force per width": system.drives[0].transverse / section.width,
        "contact.gap": system.contact.gap,
    }
    return {key: value for key, value in scaled(full, TRACK / full["track.length"]).items() if key in RANGES}


def wide_target(claim: Claim) -> st.Target:
    """Return the middle 70 % of a tolerance."""
    if math.isinf(claim.high):
        return st.Target(low=1.1 * claim.low, scale=0.25 * claim.low)
    if math.isinf(claim.low):
        return st.Target(high=0.9 * claim.high, scale=0.25 * claim.high)
    middle, half = (claim.low + claim.high) / 2.0, (claim.high - claim.low) / 2.0
    return st.Target(middle - 0.7 * half, middle + 0.7 * half, half)


def narrow_target(claim: Claim) -> st.Target:
    """Return the middle 90 % of a tolerance."""
    if math.isinf(claim.high):
        return st.Target(low=1.03 * claim.low, scale=0.1 * claim.low)
    if math.isinf(claim.low):
        return st.Target(high=0.97 * claim.high, scale=0.1 * claim.high)
    middle, half = (claim.low + claim.high) / 2.0, (claim.high - claim.low) / 2.0
    return st.Target(middle - 0.9 * half, middle + 0.9 * half, 0.1 * half)


class Measured:
    """The claims of candidates, case by case, the runs of a case side by side."""

    def __init__(self, targets: Mapping[str, st.Target], give_up: float, starts: int) -> None:
        self.targets, self.give_up, self.starts = targets, give_up, starts

    def __call__(self, points: Sequence[Mapping[str, float]]) -> list[dict[str, float]]:
        """Return the value of each claim for each candidate; NaN for those that were not looked at."""
        runs = self.to_scale(points)
        values: list[dict[str, float]] = [dict.fromkeys(self.targets, math.nan) for _ in points]
        left = list(range(len(points)))
        for section, claims in groupby(FITTED, key=lambda claim: claim.section):
            if not left:
                break
            for case in CASES[section]:
                if case != "squeal" and (self.starts == 1 or case not in CHAOTIC):
                    self.run(case, [runs[k] for k in left])
            asked, kept = list(claims), []
            with ThreadPoolExecutor() as pool:
                found = list(pool.map(partial(self.measured, asked), [runs[k] for k in left]))
            for k, measured in zip(left, found, strict=True):
                values[k] |= measured
                miss = sum(self.targets[name].miss(value) ** 2 for name, value in measured.items())
                kept += [k] if miss <= self.give_up else []
            left = kept
        return values

    def to_scale(self, points: Sequence[Mapping[str, float]]) -> list[CandidateRuns]:
        """Return runs of each candidate at the scale that suits its squeal best, with that run."""
        runs = [CandidateRuns(scaled(point, 1.0)) for point in points]
        self.run("squeal", runs)
        scales = [self.best_scale(one) for one in runs]
        changed = [k for k, scale in enumerate(scales) if scale != 1.0]
        for k in changed:
            runs[k] = CandidateRuns(scaled(points[k], scales[k]))
        if changed:
            self.run("squeal", [runs[k] for k in changed])
        return runs

    def best_scale(self, runs: CandidateRuns) -> float:
        """Return the scale at which times and frequency of the squeal miss least, 1 where they have no value."""
        misses = np.zeros(SCALES.size)
        for claim in FITTED:
            if claim.claim in (*TIMES, *FREQUENCIES):
                values = measured(claim, runs) * (SCALES if claim.claim in TIMES else 1.0 / SCALES)
                middle = st.Target(
                    (claim.low + claim.high) / 2.0, (claim.low + claim.high) / 2.0, claim.high - claim.low
                )
                misses += [middle.miss(value) ** 2 for value in values]
        return float(SCALES[np.argmin(misses)]) if np.ptp(misses) > 0.0 else 1.0

    def run(self, case: str, runs: Sequence[CandidateRuns]) -> None:
        """Run a case under several candidates at once."""
        scenarios = [one.scenario(case) for one in runs]
        records = st.simulate_many([one.system for one in scenarios], scenarios[0].duration, errors="return")
        for one, record in zip(runs, records, strict=True):
            one.keep(case, record)

    def measured(self, claims: Sequence[Claim], runs: CandidateRuns) -> dict[str, float]:
        """Return the value of each claim, of several starts the one that misses its aim most."""
        values = {}
        for claim in claims:
            target = self.targets[claim.claim]
            values[claim.claim] = max(from_starts(claim, runs, self.starts), key=target.miss)
        return values


def from_starts(claim: Claim, runs: CandidateRuns, starts: int) -> list[float]:
    """Return the value of a claim from each start, NaN where it cannot be measured."""
    if starts == 1 or not claim.chaotic:
        return [measured(claim, runs)]
    measures = {one.claim: partial(measured, one) for one in FITTED if one.chaotic == claim.chaotic}
    values = runs.once(claim.chaotic, lambda: runs.over_starts(claim.chaotic, measures, starts))
    return [float(value) for value in values[claim.claim]]


def measured(claim: Claim, runs: Runs) -> float:
    """Return the value of a claim, NaN where it cannot be measured."""
    try:
        return float(claim.measure(runs))
    except (ValueError, AttributeError):
        return math.nan


def screened(targets: Mapping[str, st.Target], seed: int) -> list[dict[str, float]]:
    """Return the best of a sample all over the ranges, the first generation of a search."""
    shares = qmc.LatinHypercube(len(RANGES), rng=np.random.default_rng(seed)).random(SCREENED)
    points = [{key: one.value(float(s)) for (key, one), s in zip(RANGES.items(), row, strict=True)} for row in shares]
    evaluate, misses = Measured(targets, GIVE_UP_WIDE, 1), []
    for first in range(0, SCREENED, POPULATION):
        found = evaluate(points[first : first + POPULATION])
        misses += [sum(targets[name].miss(value) ** 2 for name, value in one.items()) for one in found]
        print(f"screened {len(misses)}: {math.sqrt(min(misses)):.4f}", flush=True)
    return [points[k] for k in np.argsort(misses, kind="stable")[:POPULATION]]


def search(
    targets: Mapping[str, st.Target],
    give_up: float,
    starts: int,
    seed: int,
    generations: int,
    start: Mapping[str, float] | Sequence[Mapping[str, float]],
) -> Any:
    """Search from a seed and print each improvement."""
    best = math.inf

    def report(progress: st.CalibrationProgress) -> None:
        nonlocal best
        if progress.miss < best:
            best = progress.miss
            print(f"{progress.generation}: {progress.miss:.4f} {progress.best}", flush=True)

    return st.calibrate(
        Measured(targets, give_up, starts),
        RANGES,
        targets,
        population=POPULATION,
        generations=generations,
        seed=seed,
        start=start,
        watchers=[report],
    )


def main(stage: str = "wide", seed: str = "1", generations: str = "300") -> None:
    """Search from a seed, and say which claims the best set meets."""
    warnings.simplefilter("ignore")
    if stage not in ("wide", "refine"):
        raise SystemExit(f"stage must be wide or refine, got {stage!r}")
    if stage == "refine":
        start = shipped()
    else:
        targets = {claim.claim: wide_target(claim) for claim in FITTED}
        found = search(targets, GIVE_UP_WIDE, 1, int(seed), int(generations), screened(targets, int(seed)))
        start = {key: float(found[key]) for key in RANGES}
        print("narrower aims, from there", flush=True)
    targets = {claim.claim: narrow_target(claim) for claim in FITTED}
    found = search(targets, GIVE_UP_NARROW, STARTS, int(seed), int(generations), start)
    (runs,) = Measured(targets, GIVE_UP_NARROW, 1).to_scale([{key: float(found[key]) for key in RANGES}])
    print(f"the best set: {runs.values}", flush=True)
    rows = [claim.check(runs) for claim in FITTED]
    for row in rows:
        print(f"{'holds' if row['holds'] else 'FAILS'}  {row['claim']}: {row['measured']} (printed {row['printed']})")
    print(f"{sum(row['holds'] for row in rows)} of {len(rows)} fitted claims hold")


if __name__ == "__main__":
    main(*sys.argv[1:4])
