"""Search for one set of beams, force and start point that reproduces the paper's numbers.

The paper prints neither dimensions nor material nor damping. This searches for a pair of steel beams of one section,
whose damping rises with frequency, with `st.calibrate` from a seed:

    python examples/papers/laulagnet_2011/calibrate.py wide [SEED] [GENERATIONS]
    python examples/papers/laulagnet_2011/calibrate.py refine [SEED] [GENERATIONS] [LINE]

`wide` samples the whole of the ranges below, computes the growing modes of sliding of each set by linear theory, runs
the suitable sets, and searches from the best of them; then it searches with narrower targets from the best set of that
search. `refine` searches with narrower targets from a set of `sets.jsonl`, the last one or that of a line. The
objective is the sum over the claims of the squared distances of each measure from its target, in units of half the
tolerance. The target is the middle 70 % of the tolerance in the wide stage and the middle 90 % in the narrower one, in
which four starts of each chaotic case must meet it. Three targets are not claims: the ratios of the growing modes to
each other and to the swing of the stuck tip are those of the paper's 2500 Hz, 900 Hz and 0.1 s, and the upper mode
grows faster. Cases are taken in turn, and a candidate that fails one is not run on the others. The sounds, the rise
under the four loads and the series over friction are included in the narrower stage only.

Prints every improvement, and at the end the best set and its claims. Improvements of the narrower stage are appended to
`sets.jsonl`.
"""

from __future__ import annotations

import json
import math
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from functools import partial
from itertools import groupby, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import qmc

import stridula as st
from stridula.papers.laulagnet_2011 import CLAIMS, Claim, Runs
from stridula.papers.laulagnet_2011.claims import friction_cone, last_burst, near, pressure_raises_frequency
from stridula.papers.laulagnet_2011.pressure import LOADS, PRESSURES, relaxation, rise_without_a_fall
from stridula.papers.laulagnet_2011.runs import median_over_starts
from stridula.studies.ensembles import perturbed_starts

# Sets found so far, one a line: the miss by the objective of its search, and the parameters.
SETS = Path(__file__).with_name("sets.jsonl")
TRACK = 1.4
# For a track of this length; a set is then scaled as a whole.
RANGES = {
    "slider.length": st.Range(0.35, 0.65),
    "section.height": st.Range(0.006, 0.016),
    "damping.ratio": st.Range(5e-4, 0.005, logarithmic=True),
    "damping.rise": st.Range(5e-7, 2e-5, logarithmic=True),
    "start": st.Range(0.15, 0.45),
    "force per width": st.Range(30.0, 1000.0, logarithmic=True),
    "contact.gap": st.Range(1e-6, 1e-4, logarithmic=True),
}
# Sections 3.1 to 3.3 depend on force and width only by their ratio, and 3.4 on that of load and width. The width is
# chosen by 3.4: loads have the same spacing as the widths, so that one series of loads at the smallest width contains
# 2 N, 50 N and loads between 10 N and 200 N for every width.
RUNG = 25.0 ** (1.0 / 8.0)
WIDTHS = tuple(0.003 * RUNG**k for k in range(8))
WEAK, STRONG, LADDER = 0, 8, range(4, 12)
RUNGS = range(WEAK - len(WIDTHS) + 1, LADDER[-1] + 1)
SCALES = np.geomspace(1.0 / 1.4, 1.4, 201)
# With narrower targets, width and scale are also searched.
NARROW = RANGES | {
    "section.width": st.Range(WIDTHS[0], WIDTHS[-1], logarithmic=True),
    "scale": st.Range(float(SCALES[0]), float(SCALES[-1]), logarithmic=True),
}
# Claims of 3.2 whose values are times, and those that are frequencies.
TIMES, FREQUENCIES = (
    ("length of the stops", "spacing of the bursts", "length of a burst"),
    ("frequency of the limit cycle",),
)
# Parameters proportional to the scale: see `scaled`.
LENGTHS = ("slider.length", "track.length", "section.height", "contact.gap", "damping.rise", "force per width")
# Numbers of sets for linear theory, of sets that are run, of forces and gaps with each, and of initial sets of a
# search.
SAMPLED, SCREENED, DRAWS, POPULATION = 8192, 2048, 8, 64
# Sets of a generation with narrower targets, and their spread.
NEAR, SPREAD = 24, 0.01
UNKNOWN_TO_LINEAR_THEORY = ("force per width", "contact.gap")
# Starts of the chaotic cases in the narrower stage, each of which must meet the targets.
STARTS = 4
# Sums of squared misses of a case above which a candidate is not run on the next ones, in the wide and the narrower
# stage.
GIVE_UP_WIDE, GIVE_UP_NARROW = 3.0, 30.0
# Linear theory is cheap. The squeal is the hardest case to meet, so it is run first. The series take longest.
STAIR, HEARD, ONSET = "stair", "heard", "onset"
ORDER = {"3.2": 0, "3.1": 1, "3.3": 2, "3.4": 3, HEARD: 4, STAIR: 5, ONSET: 6}
CHAOTIC = {claim.chaotic for claim in CLAIMS}


def part(claim: Claim) -> str:
    """Return the part of the search that includes a claim: its section, the sounds, or the series over a parameter."""
    if claim.measure in (rise_without_a_fall, pressure_raises_frequency):
        return STAIR
    return next((name for name in (HEARD, ONSET) if claim.claim.startswith(name)), claim.section)


# The law of friction holds by construction.
AIMED_AT = sorted((claim for claim in CLAIMS if claim.measure is not friction_cone), key=lambda one: ORDER[part(one)])
CASES = {
    "3.2": ("squeal",),
    "3.1": ("stable-sliding",),
    "3.3": ("axial-sliding", "judder"),
    "3.4": ("weak-pressure", "strong-pressure"),
    HEARD: (),
    ONSET: (),
}
# Targets that are not claims. Modes: ratios of the paper's frequencies and time, independent of the scale, each with
# its tolerance of 10 %; an upper mode that does not grow faster than the lower one disappears at single loads. Series
# of loads: its claim in two parts, so that a search can compare sets that fail it.
MODE_AIMS = {
    "lower growing mode over the swing of the stuck tip": st.Target(*near(900.0 * 0.1, 0.2)),
    "upper growing mode over the lower one": st.Target(*near(2500.0 / 900.0, 0.2)),
    "growth of the upper mode over that of the lower one": st.Target(low=2.0, scale=1.0),
}
STAIR_AIMS = {
    "falls": st.Target(high=0.0, scale=0.3),
    "rise": st.Target(low=2.2, scale=0.5),
}
LOAD_AIMS = {"least rise under the four loads": st.Target(low=1.03, scale=0.3)}
NEITHER = (math.nan, math.nan)
# The second of 3.2 ends while bursts continue.
LASTS = st.Target(low=0.9, scale=0.2)


class CandidateRuns(Runs):
    """Runs with the parameters of a candidate, whose force and start point differ between cases."""

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
        """Return a case with the parameters; the axial cases start mirrored and are pushed along the axis."""
        axial = case in ("axial-sliding", "judder")
        own = {"contact.at": self.overrides["track.length"] - self.start if axial else self.start}
        if axial:
            own["axial"] = -self.force
        elif case in ("stable-sliding", "squeal"):
            own["transverse"] = self.force
        return super().scenario(case, **own, **overrides)

    def keep(self, case: str, record: Any) -> None:
        """Keep the record of a case computed elsewhere."""
        self._records[case] = record

    def widened(self, width: float) -> CandidateRuns:
        """Return runs of the same beams of another width, without records."""
        return CandidateRuns(self.values | {"section.width": width})

    def under_pressure(self, record: Any) -> CandidateRuns:
        """Return these runs with a record of 3.4 at any load."""
        other = copy(self)
        other._records = {**self._records, "weak-pressure": record, "strong-pressure": record}
        return other


def scaled(values: Mapping[str, float], scale: float | None = None) -> dict[str, float]:
    """Return a set scaled by a factor, its own if left out: times grow by it, and frequencies fall.

    Similarity: if lengths, height and gap grow by a factor, so do all times; forces grow with it and with the width,
    and the rise of damping with frequency becomes less steep.
    """
    full = {"track.length": TRACK, "section.width": WIDTHS[0], **values}
    factor = full.pop("scale", 1.0) if scale is None else scale
    return {key: value * factor if key in LENGTHS else value for key, value in full.items()}


def wide_target(claim: Claim) -> st.Target:
    """Return the middle 70 % of a tolerance."""
    if claim.measure is last_burst:
        return LASTS
    if math.isinf(claim.high):
        return st.Target(low=1.1 * claim.low, scale=0.25 * claim.low)
    if math.isinf(claim.low):
        return st.Target(high=0.9 * claim.high, scale=0.25 * claim.high)
    middle, half = (claim.low + claim.high) / 2.0, (claim.high - claim.low) / 2.0
    return st.Target(middle - 0.7 * half, middle + 0.7 * half, half)


def narrow_target(claim: Claim) -> st.Target:
    """Return the middle 90 % of a tolerance."""
    if claim.measure is last_burst:
        return LASTS
    if math.isinf(claim.high):
        return st.Target(low=1.03 * claim.low, scale=0.1 * claim.low)
    if math.isinf(claim.low):
        return st.Target(high=0.97 * claim.high, scale=0.1 * claim.high)
    middle, half = (claim.low + claim.high) / 2.0, (claim.high - claim.low) / 2.0
    return st.Target(middle - 0.9 * half, middle + 0.9 * half, 0.1 * half)


class Measured:
    """Measures of the targets for candidates, part by part, with the runs of a case side by side."""

    def __init__(self, targets: Mapping[str, st.Target], give_up: float, starts: int) -> None:
        self.targets, self.give_up, self.starts = targets, give_up, starts

    def __call__(self, points: Sequence[Mapping[str, float]]) -> list[dict[str, float]]:
        """Return the value of each target for each candidate; NaN for those that were not computed."""
        values: list[dict[str, float]] = [dict.fromkeys(self.targets, math.nan) for _ in points]
        first = [CandidateRuns(scaled(point)) for point in points]
        for one, run in zip(values, first, strict=True):
            one |= growing(run)
        left = self.promising(range(len(points)), MODE_AIMS, values)
        runs = dict(zip(left, self.to_scale([points[k] for k in left]), strict=True))
        for section, claims in groupby(AIMED_AT, key=part):
            names = list(STAIR_AIMS | LOAD_AIMS) if section == STAIR else [claim.claim for claim in claims]
            names = [name for name in names if name in self.targets]
            if not left or not names:
                continue
            for k, measured in zip(left, self.looked_at(section, [runs[k] for k in left]), strict=True):
                values[k] |= measured
                if "width" in measured:
                    runs[k] = runs[k].widened(measured["width"])
            left = self.promising(left, names, values)
        if self.starts == 1:
            for k, one in enumerate(values):
                own = runs.get(k, first[k]).values
                one |= {"scale": own["track.length"] / TRACK, "width": own["section.width"]}
        return values

    def promising(self, which: Iterable[int], names: Iterable[str], values: Sequence[Mapping[str, float]]) -> list[int]:
        """Return the candidates that do not miss targets by too much."""
        names = list(names)
        return [k for k in which if self.miss(names, values[k]) <= self.give_up]

    def miss(self, names: Iterable[str], values: Mapping[str, float]) -> float:
        """Return the sum of the squared misses of targets."""
        return sum(self.targets[name].miss(values[name]) ** 2 for name in names)

    def looked_at(self, section: str, runs: Sequence[CandidateRuns]) -> list[dict[str, float]]:
        """Return the values of a part for each candidate."""
        if section == STAIR:
            series = (stair,) if self.starts == 1 else (stair, rise_from_load_to_load)
            return [{key: value for find in series for key, value in find(one, self.starts).items()} for one in runs]
        claims = [claim for claim in AIMED_AT if part(claim) == section]
        if section == "3.4" and self.starts == 1:
            return [self.at_best_width(claims, one) for one in runs]
        for case in CASES[section]:
            if case != "squeal" and (self.starts == 1 or case not in CHAOTIC):
                self.run(case, runs)
        with ThreadPoolExecutor() as pool:
            return list(pool.map(partial(self.measured, claims), runs))

    def at_best_width(self, claims: Sequence[Claim], runs: CandidateRuns) -> dict[str, float]:
        """Return the claims of 3.4 at the width that meets them and the series of loads best, and that width."""

        def measure(record: xr.Dataset) -> tuple[dict[str, float], tuple[float, float]]:
            own = runs.under_pressure(record)
            return {claim.claim: measured(claim, own) for claim in claims}, relaxation(record)

        failed = {claim.claim: math.nan for claim in claims}, NEITHER
        rungs = under_loads(runs, [2.0 * RUNG**rung for rung in RUNGS], measure, failed)
        found = []
        for k, width in enumerate(WIDTHS):
            first = len(WIDTHS) - 1 - k
            at = {"weak-pressure": rungs[first + WEAK][0], "strong-pressure": rungs[first + STRONG][0]}
            values = {claim.claim: at[claim.chaotic][claim.claim] for claim in claims} | {"width": width}
            falls, rise = climb([rungs[first + rung][1] for rung in LADDER])
            stair = STAIR_AIMS["falls"].miss(falls) ** 2 + STAIR_AIMS["rise"].miss(rise) ** 2
            found.append((self.miss([claim.claim for claim in claims], values) + stair, k, values))
        return min(found)[2]

    def to_scale(self, points: Sequence[Mapping[str, float]]) -> list[CandidateRuns]:
        """Return runs of each candidate, with its squeal, at its scale or else at the best scale for its squeal."""
        runs = [CandidateRuns(scaled(point)) for point in points]
        self.run("squeal", runs)
        if self.starts > 1:
            return runs
        scales = [self.best_scale(one) for one in runs]
        changed = [k for k, scale in enumerate(scales) if scale != 1.0]
        for k in changed:
            runs[k] = CandidateRuns(scaled(points[k], scales[k]))
        if changed:
            self.run("squeal", [runs[k] for k in changed])
        return runs

    def best_scale(self, runs: CandidateRuns) -> float:
        """Return the scale with the smallest misses of times and frequency of the squeal, 1 if these have no value."""
        misses = np.zeros(SCALES.size)
        for claim in AIMED_AT:
            if claim.claim in (*TIMES, *FREQUENCIES):
                values = measured(claim, runs) * (SCALES if claim.claim in TIMES else 1.0 / SCALES)
                middle = st.Target(
                    (claim.low + claim.high) / 2.0, (claim.low + claim.high) / 2.0, claim.high - claim.low
                )
                misses += [middle.miss(value) ** 2 for value in values]
        return float(SCALES[np.argmin(misses)]) if np.ptp(misses) > 0.0 else 1.0

    def run(self, case: str, runs: Sequence[CandidateRuns]) -> None:
        """Run a case for several candidates at once."""
        if not runs:
            return
        scenarios = [one.scenario(case) for one in runs]
        records = st.simulate_many([one.system for one in scenarios], scenarios[0].duration, errors="return")
        for one, record in zip(runs, records, strict=True):
            one.keep(case, record)

    def measured(self, claims: Sequence[Claim], runs: CandidateRuns) -> dict[str, float]:
        """Return the value of each claim; for several starts, the one that misses its target most."""
        values = {}
        for claim in claims:
            target = self.targets[claim.claim]
            values[claim.claim] = max(from_starts(claim, runs, self.starts), key=target.miss)
        return values


def growing(runs: CandidateRuns) -> dict[str, float]:
    """Return the ratios of the growing modes by linear theory, NaN if there are not two."""
    found = st.sliding_stability(runs.scenario("strong-pressure").system)
    grow = np.flatnonzero(found["unstable"].values)
    if grow.size < 2:
        return dict.fromkeys(MODE_AIMS, math.nan)
    frequency, growth = found["frequency"].values[grow], found["growth_rate"].values[grow]
    stuck = st.sliding_stability(runs.scenario("squeal").system, status="sticking")
    upper = 1 + int(np.argmin(np.abs(np.log(frequency[1:] / frequency[0] * 900.0 / 2500.0))))
    ratios = frequency[0] / float(stuck["frequency"][0]), frequency[upper] / frequency[0], growth[upper] / growth[0]
    return dict(zip(MODE_AIMS, map(float, ratios), strict=True))


def under_loads(
    runs: Runs, loads: Sequence[float], measure: Callable[[xr.Dataset], Any], failed: Any, starts: int = 1
) -> list[Any]:
    """Return a measure of 3.4 under each load [N], start by start; `failed` for runs that fail."""
    scenarios = [runs.scenario("strong-pressure", normal_load=load) for load in loads]
    systems = [system for one in scenarios for system in perturbed_starts(one.system, starts)]
    found = st.simulate_many(systems, scenarios[0].duration, measure, provenance=False, errors="return")
    return [failed if isinstance(one, Exception) else one for one in found]


def climb(pairs: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return falls and rise of frequencies from load to load, given with their resolutions.

    Falls: the sum of the relative distances of each below the highest at a lower load, beyond the resolution. Rise: the
    last one over the first one. Both are NaN unless two loads have relaxations.
    """
    known = [pair for pair in pairs if np.isfinite(pair[0])]
    if len(known) < 2:
        return math.nan, math.nan
    falls, highest = 0.0, known[0]
    for frequency, resolution in known[1:]:
        falls += max(0.0, highest[0] - frequency - max(resolution, highest[1])) / highest[0]
        highest = max(highest, (frequency, resolution))
    return falls, known[-1][0] / known[0][0]


def stair(runs: Runs, starts: int) -> dict[str, float]:
    """Return falls and rise of the frequency of the relaxations over the load, from medians over starts."""
    return dict(zip(STAIR_AIMS, climb(medians(runs, PRESSURES, starts)), strict=True))


def rise_from_load_to_load(runs: Runs, starts: int) -> dict[str, float]:
    """Return the least rise of the frequency under the four loads, in units of its resolution."""
    rises = [(b - a) / max(own, other) for (a, own), (b, other) in pairwise(medians(runs, LOADS, starts))]
    return dict.fromkeys(LOAD_AIMS, min(rises) if np.isfinite(rises).all() else math.nan)


def medians(runs: Runs, loads: Sequence[float], starts: int) -> list[tuple[float, float]]:
    """Return the medians over starts of frequency and resolution of the relaxations under each load [Hz]."""
    found = np.array(under_loads(runs, loads, relaxation, NEITHER, starts)).reshape(-1, starts, 2)
    return [(median_over_starts(one[:, 0])[0], median_over_starts(one[:, 1])[0]) for one in found]


def from_starts(claim: Claim, runs: CandidateRuns, starts: int) -> list[float]:
    """Return the value of a claim from each start, NaN where it cannot be measured."""
    if starts == 1 or not claim.chaotic:
        return [measured(claim, runs)]
    own = part(claim)
    measures = {
        one.claim: partial(measured, one) for one in AIMED_AT if one.chaotic == claim.chaotic and part(one) == own
    }
    values = runs.once(f"{claim.chaotic} {own}", lambda: runs.over_starts(claim.chaotic, measures, starts))
    return [float(value) for value in values[claim.claim]]


def measured(claim: Claim, runs: Runs) -> float:
    """Return the value of a claim, NaN where it cannot be measured."""
    try:
        return float(claim.measure(runs))
    except (ValueError, AttributeError):
        return math.nan


def screened(targets: Mapping[str, st.Target], seed: int) -> list[dict[str, float]]:
    """Return the best of a sample of the whole ranges, the first generation of a search.

    Linear theory, which depends on neither force nor gap, is applied to the whole sample. The best sets by their modes
    are run, each with several forces and gaps.
    """
    random = np.random.default_rng(seed)
    evaluate, misses = Measured(targets, GIVE_UP_WIDE, 1), []
    points = sample(RANGES, SAMPLED, random)
    suits = [evaluate.miss(MODE_AIMS, values) for values in linear_theory(points)]
    best = [points[k] for k in np.argsort(suits, kind="stable")[: SCREENED // DRAWS]]
    print(f"linear theory: {sum(miss == 0.0 for miss in suits)} of {SAMPLED} sets have the modes", flush=True)
    pushes = sample({key: RANGES[key] for key in UNKNOWN_TO_LINEAR_THEORY}, SCREENED, random)
    points = [best[k // DRAWS] | push for k, push in enumerate(pushes)]
    for first in range(0, SCREENED, POPULATION):
        found = evaluate(points[first : first + POPULATION])
        misses += [evaluate.miss(targets, values) for values in found]
        print(f"screened {len(misses)}: {math.sqrt(min(misses)):.4f}", flush=True)
    return [points[k] for k in np.argsort(misses, kind="stable")[:POPULATION]]


def sample(ranges: Mapping[str, st.Range], size: int, random: np.random.Generator) -> list[dict[str, float]]:
    """Return a Latin hypercube over ranges."""
    shares = qmc.LatinHypercube(len(ranges), rng=random).random(size)
    return [{key: one.value(float(s)) for (key, one), s in zip(ranges.items(), row, strict=True)} for row in shares]


def linear_theory(points: Sequence[Mapping[str, float]]) -> list[dict[str, float]]:
    """Return the ratios of the growing modes of sets."""
    with ThreadPoolExecutor() as pool:
        return list(pool.map(lambda point: growing(CandidateRuns(scaled(point))), points))


def search(
    ranges: Mapping[str, st.Range],
    targets: Mapping[str, st.Target],
    give_up: float,
    starts: int,
    seed: int,
    generations: int,
    start: Mapping[str, float] | Sequence[Mapping[str, float]],
    population: int,
    found: Callable[[float, Mapping[str, float]], None] = lambda miss, values: None,
) -> Any:
    """Search from a seed, print each improvement and pass it on."""
    best = math.inf

    def report(progress: st.CalibrationProgress) -> None:
        nonlocal best
        if progress.miss < best:
            best = progress.miss
            print(f"{progress.generation}: {progress.miss:.4f} {progress.best}", flush=True)
            found(progress.miss, progress.best)

    return st.calibrate(
        Measured(targets, give_up, starts),
        ranges,
        targets,
        population=population,
        generations=generations,
        seed=seed,
        start=start,
        spread=SPREAD,
        watchers=[report],
    )


def sets() -> list[dict[str, float]]:
    """Return the parameters of the sets found so far."""
    lines = [json.loads(line) for line in SETS.read_text().splitlines()]
    return [{key: line[key] for key in NARROW} for line in lines]


def keep(seed: int, miss: float, values: Mapping[str, float]) -> None:
    """Append a set to those found so far."""
    with SETS.open("a") as file:
        file.write(json.dumps({"seed": seed, "miss": round(miss, 4), **{key: values[key] for key in NARROW}}) + "\n")


def wide(seed: int, generations: int) -> dict[str, float]:
    """Return the best set of a search of the whole ranges."""
    claims = [claim for claim in AIMED_AT if part(claim) not in (STAIR, HEARD, ONSET)]
    targets = MODE_AIMS | STAIR_AIMS | {claim.claim: wide_target(claim) for claim in claims}
    first = screened(targets, seed)
    found = search(RANGES, targets, GIVE_UP_WIDE, 1, seed, generations, first, POPULATION)
    own_size = {"section.width": float(found["width"]), "scale": float(found["scale"])}
    return {key: float(found[key]) for key in RANGES} | own_size


def main(stage: str = "wide", seed: str = "1", generations: str = "300", line: str = "-1") -> None:
    """Search from a seed, and print the claims that the best set meets."""
    warnings.simplefilter("ignore")
    if stage not in ("wide", "refine"):
        raise SystemExit(f"stage must be wide or refine, got {stage!r}")
    start = wide(int(seed), int(generations)) if stage == "wide" else sets()[int(line)]
    print("narrower targets, from there", flush=True)
    own = {claim.claim: narrow_target(claim) for claim in AIMED_AT if part(claim) != STAIR}
    targets = MODE_AIMS | STAIR_AIMS | LOAD_AIMS | own
    kept = partial(keep, int(seed))
    found = search(NARROW, targets, GIVE_UP_NARROW, STARTS, int(seed), int(generations), start, NEAR, kept)
    best = {key: float(found[key]) for key in NARROW}
    runs = CandidateRuns(scaled(best))
    print(f"the best set: {runs.values}", flush=True)
    rows = [claim.check(runs) for claim in CLAIMS]
    for row in rows:
        print(f"{'holds' if row['holds'] else 'FAILS'}  {row['claim']}: {row['measured']} (printed {row['printed']})")
    print(f"{sum(row['holds'] for row in rows)} of {len(rows)} claims hold")


if __name__ == "__main__":
    main(*sys.argv[1:5])
