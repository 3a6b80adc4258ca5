"""Search for one set of beams, force and start point under which the paper's numbers come out.

The paper prints neither dimensions nor material nor damping. This searches a steel pair of one section, whose damping
rises with frequency, with `st.calibrate` from a seed:

    python examples/papers/laulagnet_2011/calibrate.py wide [SEED] [GENERATIONS]
    python examples/papers/laulagnet_2011/calibrate.py refine [SEED] [GENERATIONS]

`wide` takes a sample all over the ranges below and goes on from the best of it, and then, with narrower aims, from the
best set that it found; `refine` starts around the shipped set. The objective adds up, over the claims marked as fitted,
the squares of how far each measure lies outside its aim, in units of half the tolerance: the middle 70 % in the wide
stage, the middle 90 % in the narrower one, in which four starts of each chaotic case are to meet it. Cases are taken in
turn, and a candidate that already fails on one is not run on the others. The sounds are looked at in the narrower stage
only, the ladders of friction and of pressure never.

Prints every improvement, at the end the best set and its claims.
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
    "damping.ratio": st.Range(5e-4, 0.005, logarithmic=True),
    "damping.rise": st.Range(5e-7, 2e-5, logarithmic=True),
    "start": st.Range(0.15, 0.45),
    "force per width": st.Range(30.0, 1000.0, logarithmic=True),
    "contact.gap": st.Range(1e-6, 1e-4, logarithmic=True),
}
# Sections 3.1 to 3.3 know force and width only by their ratio; the width is then chosen by 3.4, whose loads are given.
WIDTHS = tuple(float(width) for width in np.round(np.geomspace(0.003, 0.05, 8), 5))
NARROW = RANGES | {"section.width": st.Range(WIDTHS[0], WIDTHS[-1], logarithmic=True)}
SCALES = np.geomspace(1.0 / 1.4, 1.4, 201)
# Claims of 3.2 whose values are times, and those that are frequencies.
TIMES, FREQUENCIES = (
    ("length of the stops", "spacing of the bursts", "length of a burst"),
    ("frequency of the limit cycle",),
)
# What grows with the scale: see `scaled`.
LENGTHS = ("slider.length", "track.length", "section.height", "contact.gap", "damping.rise", "force per width")
SCREENED, POPULATION = 2000, 64
# Starts of the cases that are chaotic in the narrower stage: each of them is to meet the aims.
STARTS = 4
# Sums of squared misses of a case from which a candidate is not run on the next ones, all over the ranges and with
# narrower aims.
GIVE_UP_WIDE, GIVE_UP_NARROW = 3.0, 30.0
# The squeal is the hardest to meet, so it comes first.
HEARD = "heard"
ORDER = {"3.2": 0, "3.1": 1, "3.3": 2, "3.4": 3, HEARD: 4}
CHAOTIC = {claim.chaotic for claim in CLAIMS}


def part(claim: Claim) -> str:
    """Return the part of the search in which a claim is looked at: its section, or the sounds, which take longest."""
    return HEARD if claim.claim.startswith(HEARD) else claim.section


FITTED = sorted((claim for claim in CLAIMS if claim.fitted), key=lambda claim: ORDER[part(claim)])
CASES = {
    "3.2": ("squeal",),
    "3.1": ("stable-sliding",),
    "3.3": ("axial-sliding", "judder"),
    "3.4": ("weak-pressure", "strong-pressure"),
    HEARD: (),
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
        form = {"form": "rising", "ratio": values["damping.ratio"], "rise": values["damping.rise"]}
        super().__init__(own | {"damping": form})

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

    def drop(self, case: str) -> None:
        """Forget the record of a case."""
        del self._records[case]

    def widened(self, width: float) -> CandidateRuns:
        """Return runs of the same beams of another width, with the squeal, whose forces are in proportion."""
        other = CandidateRuns(self.values | {"section.width": width})
        squeal = self.record("squeal")
        share = width / self.values["section.width"]
        other.keep("squeal", squeal.assign(normal_force=squeal["normal_force"] * share))
        return other


def scaled(values: Mapping[str, float], scale: float) -> dict[str, float]:
    """Return a set whose times are longer by a factor, and its frequencies lower.

    Similarity: where lengths, height and gap grow by a factor, so do all times; forces grow with it and with the width,
    and a damping that rises with frequency rises less steeply.
    """
    full = {"track.length": TRACK, "section.width": WIDTHS[0], **values}
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
        "damping.rise": damping.rise,
        "start": system.contact.at / system.track.length,
        "force per width": system.drives[0].transverse / section.width,
        "contact.gap": system.contact.gap,
    }
    return {key: value for key, value in scaled(full, TRACK / full["track.length"]).items() if key in NARROW}


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
        for section, claims in groupby(FITTED, key=part):
            if not left or not {claim.claim for claim in FITTED if part(claim) == section} <= set(self.targets):
                break
            asked = list(claims)
            widening = section == "3.4" and "section.width" not in points[0]
            for case in CASES[section]:
                if case != "squeal" and not widening and (self.starts == 1 or case not in CHAOTIC):
                    self.run(case, [runs[k] for k in left])
            measure = self.at_best_width if widening else self.measured
            with ThreadPoolExecutor() as pool:
                found = list(pool.map(partial(measure, asked), [runs[k] for k in left]))
            for k, measured in zip(left, found, strict=True):
                values[k] |= measured
            left = [k for k in left if self.miss(asked, values[k]) <= self.give_up]
        for one, run in zip(values, runs, strict=True):
            one |= {"scale": run.values["track.length"] / TRACK, "width": one.get("width", run.values["section.width"])}
        return values

    def miss(self, claims: Sequence[Claim], values: Mapping[str, float]) -> float:
        """Return the sum of the squared misses of claims."""
        return sum(self.targets[one.claim].miss(values[one.claim]) ** 2 for one in claims)

    def at_best_width(self, claims: Sequence[Claim], runs: CandidateRuns) -> dict[str, float]:
        """Return the claims of 3.4 at the width that suits them best, and that width."""
        candidates = [runs.widened(width) for width in WIDTHS]
        values: list[dict[str, float]] = [{"width": width} for width in WIDTHS]
        for case in CASES["3.4"]:
            self.run(case, candidates)
            asked = [claim for claim in claims if claim.chaotic == case]
            for found, one in zip(values, candidates, strict=True):
                found |= self.measured(asked, one)
                one.drop(case)
        return min(values, key=partial(self.miss, claims))

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
    if starts == 1 or not claim.chaotic or part(claim) == HEARD:
        return [measured(claim, runs)]
    measures = {
        one.claim: partial(measured, one) for one in FITTED if one.chaotic == claim.chaotic and part(one) != HEARD
    }
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
        misses += [evaluate.miss([one for one in FITTED if part(one) != HEARD], values) for values in found]
        print(f"screened {len(misses)}: {math.sqrt(min(misses)):.4f}", flush=True)
    return [points[k] for k in np.argsort(misses, kind="stable")[:POPULATION]]


def search(
    ranges: Mapping[str, st.Range],
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
        ranges,
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
        targets = {claim.claim: wide_target(claim) for claim in FITTED if part(claim) != HEARD}
        found = search(RANGES, targets, GIVE_UP_WIDE, 1, int(seed), int(generations), screened(targets, int(seed)))
        start = {key: float(found[key]) for key in RANGES} | {"section.width": float(found["width"])}
        print("narrower aims, from there", flush=True)
    targets = {claim.claim: narrow_target(claim) for claim in FITTED}
    found = search(NARROW, targets, GIVE_UP_NARROW, STARTS, int(seed), int(generations), start)
    best = {key: float(found[key]) for key in NARROW}
    runs = CandidateRuns(scaled(best, float(found["scale"])))
    print(f"the best set: {runs.values}", flush=True)
    rows = [claim.check(runs) for claim in FITTED]
    for row in rows:
        print(f"{'holds' if row['holds'] else 'FAILS'}  {row['claim']}: {row['measured']} (printed {row['printed']})")
    print(f"{sum(row['holds'] for row in rows)} of {len(rows)} fitted claims hold")


if __name__ == "__main__":
    main(*sys.argv[1:4])
