"""Convergence of the paper's measures: elements doubled, cutoff doubled, step halved, each alone.

Every measure is averaged over an ensemble of starts whose gap is perturbed by parts in a million. A refinement
passes where the mean moves by less than 3 % (frequencies, durations, ratios) or 0.03 (shares), or stays within the
95 % interval of the unrefined mean. Writes docs/convergence-table.rst; a few minutes on two cores.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from stridula.papers.laulagnet_2011 import CLAIMS, Claim, Runs
from stridula.studies import mean_and_interval

STARTS = 8
PERTURBATION = 1e-6
TARGET = Path(__file__).resolve().parents[3] / "docs" / "convergence-table.rst"


def refinements() -> dict[str, dict[str, float]]:
    """Return the overrides of each refinement of the shipped cases."""
    case = Runs().scenario("squeal")
    step = float(case.simulate(duration=1e-4).attrs["step"])
    slider = case.system.slider
    return {
        "shipped": {"simulation.step": step},
        "elements doubled": {"simulation.step": step, "slider.elements": 2 * slider.elements},
        "cutoff doubled": {"simulation.step": step, "cutoff": 2.0 * slider.cutoff},
        "step halved": {"simulation.step": step / 2.0},
    }


def converging() -> list[Claim]:
    """Return the claims whose measures are averaged: all but the series over friction and over load."""
    return [claim for claim in CLAIMS if not claim.claim.startswith(("onset", "10 to 200 N", "least rise"))]


def one_start(arguments: tuple[str, int]) -> tuple[str, list[float]]:
    """Return the measures of one perturbed start under one refinement."""
    name, start = arguments
    overrides = dict(refinements()[name])
    gap = Runs().scenario("squeal").system.contact.gap
    runs = Runs({**overrides, "contact.gap": gap * (1.0 + PERTURBATION * start)})
    return name, [float(claim.measure(runs)) for claim in converging()]


def verdict(claim: Claim, base: tuple[float, float], refined: tuple[float, float]) -> bool:
    """Return whether a refined mean agrees with the unrefined one."""
    moved = abs(refined[0] - base[0])
    allowed = 0.03 if "separated" in claim.claim or "sliding in" in claim.claim else 0.03 * abs(base[0])
    return bool(moved <= allowed or moved <= base[1])


def table(results: dict[str, list[list[float]]]) -> str:
    """Return the table as reStructuredText."""
    names = list(results)
    lines = [".. list-table::", "   :header-rows: 1", ""]
    rows = [["measure", *names]]
    for number, claim in enumerate(converging()):
        pairs = {name: mean_and_interval([values[number] for values in results[name]]) for name in names}
        row = [f"{claim.section} {claim.claim}"]
        for name, (mean, half) in pairs.items():
            passed = name == names[0] or verdict(claim, pairs[names[0]], (mean, half))
            row.append(f"{mean:.4g} ± {half:.2g}" + ("" if passed else " **moved**"))
        rows.append(row)
    for row in rows:
        lines += [f"   * - {row[0]}", *(f"     - {cell}" for cell in row[1:])]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run every refinement from every start on two cores and write the table."""
    jobs = [(name, start) for name in refinements() for start in range(STARTS)]
    results: dict[str, list[list[float]]] = {name: [] for name in refinements()}
    with ProcessPoolExecutor(2) as pool:
        for number, (name, values) in enumerate(pool.map(one_start, jobs), 1):
            results[name].append(values)
            print(f"{number} of {len(jobs)}: {name}", file=sys.stderr)
    TARGET.write_text(table(results), encoding="utf-8")
    print(table(results))


if __name__ == "__main__":
    main()
