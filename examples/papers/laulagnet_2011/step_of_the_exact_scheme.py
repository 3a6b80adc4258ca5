"""Errors of the statistics of the paper's cases due to the step and the cut-off of the exact scheme.

Every case runs with the shipped modes, those below 15 kHz, under the explicit scheme at 0.5 µs, the reference, and at
1 µs, and under the exact scheme at fractions of its limit. Then the cut-off varies from 10 to 40 kHz, each at a fine
step and at the chosen fraction of the limit, so that the effects of the modes left out and of the step are separate.
Means are over starts whose gaps differ by up to 10 %: enough to separate the unstable cases at the first contact, so
that their runs are independent.

Writes docs/step-table.rst, docs/step-near-table.rst, docs/step-cutoff-table.rst and docs/images/step.png, in several
minutes on two cores.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, hypot
from pathlib import Path
from typing import Any

import first_contacts
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import stridula as st
from stridula import plot
from stridula.integration import CentralDifference, ExactModal
from stridula.lowering import assemble
from stridula.studies import share_of

DOCS = Path(__file__).resolve().parents[3] / "docs"
# Number of starts: the orderly cases hardly differ from start to start, judder differs most.
STARTS = {
    "stable-sliding": 8,
    "axial-sliding": 8,
    "squeal": 8,
    "judder": 64,
    "weak-pressure": 20,
    "strong-pressure": 32,
}
UNSTABLE = ("judder", "weak-pressure", "strong-pressure")
STATES = ("separated", "sticking", "sliding")
# A cut-off a little above the tone of strong pressure, 2.8 kHz, and the factor of the steps there.
NEAR, LONGER = 5e3, 3.0
FORCE = "99.9th percentile of force [N]"
PERTURBATION = 0.1
# Forces are compared as means over this interval [s], a whole number of every step below.
INTERVAL = 40e-6
FINEST, CHECK = 0.5e-6, 1e-6
STEPS = tuple(INTERVAL / n for n in (12, 8, 6, 4, 3, 2))
SHIPPED = 15e3
CUTOFFS = (10e3, 15e3, 20e3, 30e3)
HIGHEST = 40e3
ELEMENTS = 40
FINE = 2e-6
CHOSEN = 0.3
ALLOWED = 0.03
# Rows in which no mean changes by more than this are left out of the tables.
TOLD = 0.01


@dataclass(frozen=True)
class Mean:
    """A mean over starts and the half width of its 95 % interval."""

    value: float
    half: float


Means = dict[str, Mean]
Measure = Callable[[xr.Dataset], float]


def travel(run: xr.Dataset) -> float:
    """Return the travel of the tip [mm]."""
    position = run["contact_position"].values
    return 1e3 * abs(float(position[-1] - position[0]))


def mean_force(run: xr.Dataset) -> float:
    """Return the mean of the normal force [N]."""
    return float(run["normal_force"].mean())


def highest_force(interval: float) -> Measure:
    """Return a measure: the 99.9th percentile of the normal force [N], as means over an interval."""

    def percentile(run: xr.Dataset) -> float:
        together = round(interval / float(run["time"][0]))
        force = run["normal_force"].values
        return float(np.percentile(force[: force.size // together * together].reshape(-1, together).mean(axis=1), 99.9))

    return percentile


def measures(interval: float) -> dict[str, Measure]:
    """Return the statistics by name, forces as means over an interval."""
    return {
        **{state: share_of(state) for state in STATES},
        "travel [mm]": travel,
        "mean force [N]": mean_force,
        FORCE: highest_force(interval),
    }


def ensemble(
    case: str, scheme: CentralDifference | ExactModal, step: float, interval: float = INTERVAL, **overrides: float
) -> Means:
    """Return the means over starts of a case, recorded at every step, or every 2 µs where it is finer."""
    scenario = st.load_scenario(case, overrides)
    rate = 1.0 / max(step, 2e-6)
    found = st.ensemble(
        scenario.system,
        scenario.duration,
        measures(interval),
        runs=STARTS[case],
        perturbation=PERTURBATION,
        scheme=scheme,
        step=step,
        sample_rate=rate,
        probes=(),
    )
    print(f"{case}: {scheme.name}, {1e6 * step:.3g} µs, {overrides or 'as shipped'}", file=sys.stderr)
    middles = {name: float(found[f"{name}_mean"]) for name in measures(interval)}
    return {name: Mean(mean, float(found[f"{name}_interval"][1]) - mean) for name, mean in middles.items()}


def chosen_step(case: str, **overrides: float) -> float:
    """Return the chosen share of the limit, lowered to a whole division of the common interval [s]."""
    arrays = assemble(st.load_scenario(case, overrides).system, ())
    limit = ExactModal().limit(arrays.angular_frequency, arrays.damping)
    return INTERVAL / ceil(INTERVAL / (CHOSEN * limit))


def share_moved(found: Mean, reference: Mean) -> float:
    """Return the relative change of a mean."""
    return (found.value - reference.value) / abs(reference.value)


def marked(text: str, found: Mean, reference: Mean) -> str:
    """Return text in italics if a mean passes only by the 95 % interval of the reference, in bold if it fails."""
    if abs(share_moved(found, reference)) <= ALLOWED:
        return text
    return f"*{text}*" if abs(found.value - reference.value) <= reference.half else f"**{text}**"


def moved(name: str, found: Mean, reference: Mean) -> str:
    """Return the change of a mean in percent, ± the 95 % interval of the difference; shares also in points."""
    half = 100.0 * hypot(found.half, reference.half) / abs(reference.value)
    text = f"{signed(100.0 * share_moved(found, reference))} ± {half:.1f}"
    text += f" ({signed(100.0 * (found.value - reference.value))})" if name in STATES else ""
    return marked(text, found, reference)


def signed(number: float) -> str:
    """Return a number with its sign and one digit."""
    return f"{number:+.1f}".replace("-", "−") if abs(number) >= 0.05 else "0.0"


def worth_telling(reference: Mean, others: list[Mean]) -> bool:
    """Return whether any mean changed by more than 1 %."""
    return reference.value != 0.0 and any(abs(share_moved(other, reference)) > TOLD for other in others)


def value(mean: Mean) -> str:
    """Return a mean and its interval in percent of it."""
    return f"{mean.value:.4g} ± {100.0 * mean.half / abs(mean.value):.1f} %"


def step_rows(case: str, reference: Means, check: Means, found: list[Means]) -> list[list[str]]:
    """Return the rows of a case: the reference, its check, the exact scheme at each step."""
    return [
        [f"{case}: {name}", value(mean), *(moved(name, other[name], mean) for other in (check, *found))]
        for name, mean in reference.items()
        if worth_telling(mean, [other[name] for other in (check, *found)])
    ]


def cutoff_rows(case: str, highest: Means, fine: list[Means], chosen: list[Means]) -> list[list[str]]:
    """Return the rows of a case: all modes, the change due to each cut-off, the further change due to the step."""
    return [
        [
            f"{case}: {name}",
            value(mean),
            *(moved(name, other[name], mean) for other in fine),
            *(moved(name, other[name], own[name]) for other, own in zip(chosen, fine, strict=True)),
        ]
        for name, mean in highest.items()
        if worth_telling(mean, [other[name] for other in (*fine, *chosen)])
    ]


def draw(axes: Axes, places: list[float], found: list[Means], name: str, **style: Any) -> None:
    """Draw means with their intervals over the refined quantity."""
    values, halves = [one[name].value for one in found], [one[name].half for one in found]
    axes.errorbar(places, values, halves, markersize=4, capsize=3, **style)


def band(axes: Axes, reference: Mean) -> None:
    """Draw the allowed range, 3 % about the reference, and the interval of the reference."""
    middle = reference.value
    for half, shade in ((ALLOWED * middle, 0.12), (reference.half, 0.3)):
        axes.axhspan(middle - half, middle + half, color="black", alpha=shade, linewidth=0)
    axes.set_ylim(0.86 * middle, 1.14 * middle)


def logarithmic(axes: Axes, places: list[float], words: str) -> None:
    """Set the abscissa of a panel."""
    axes.set_xscale("log")
    axes.set_xticks(places, [f"{place:.2g}" for place in places])
    axes.minorticks_off()
    axes.set_xlabel(words)
    axes.grid(alpha=0.3, linewidth=0.5)


def draw_steps(panels: np.ndarray, case: str, reference: Means, check: Means, found: list[Means]) -> None:
    """Draw the separated share and the force of a case over the step."""
    places = [1e6 * step for step in STEPS]
    shares, forces = panels
    shares.set_title(case)
    for axes, name in ((shares, "separated"), (forces, FORCE)):
        band(axes, reference[name])
        draw(axes, [1e6 * CHECK], [check], name, fmt="s", color="black", label="explicit, 1 µs")
        draw(axes, places, found, name, marker="o", color=plot.LINES[0], label="exact")
        logarithmic(axes, [1e6 * CHECK, *places], "step [µs]")


def draw_cutoffs(axes: Axes, cutoffs: dict[str, tuple[Means, list[Means]]], name: str) -> None:
    """Draw the difference of a mean from that with all modes."""
    places = [1e-3 * cutoff for cutoff in CUTOFFS]
    for number, case in enumerate(UNSTABLE):
        highest, fine = cutoffs[case]
        moves = [100.0 * share_moved(one[name], highest[name]) for one in fine]
        halves = [100.0 * hypot(one[name].half, highest[name].half) / highest[name].value for one in fine]
        aside = [place * 1.03 ** (number - 1) for place in places]
        axes.errorbar(aside, moves, halves, marker="o", markersize=4, capsize=3, color=plot.LINES[number], label=case)
    axes.axhspan(-100 * ALLOWED, 100 * ALLOWED, color="black", alpha=0.12, linewidth=0)
    axes.set_ylim(-16.0, 16.0)
    logarithmic(axes, places, "cut-off of the modes [kHz]")


def draw_impulses(axes: Axes) -> None:
    """Draw the error of the impulse over the first millisecond of contact."""
    places = [1e6 * step for step in first_contacts.STEPS]
    for case, colour in zip(first_contacts.CASES, plot.LINES, strict=False):
        exact, found = first_contacts.compare(case)
        errors = [first_contacts.root_mean_square(first_contacts.window_errors(one, exact)) for one in found]
        axes.plot(places, 100.0 * np.array(errors), marker="o", markersize=4, color=colour, label=case)
    axes.plot(places, 0.0002 * np.array(places) ** 2, color="black", linestyle=":", label="order 2")
    axes.set_yscale("log")
    axes.set_ylim(1e-3, 10.0)
    axes.set_ylabel("error of the impulse over\nthe first millisecond [%]")
    logarithmic(axes, places, "step [µs]")
    axes.legend(fontsize=7, ncols=2, loc="upper left")


def figure_of(
    steps: dict[str, tuple[Means, Means, list[Means]]], cutoffs: dict[str, tuple[Means, list[Means]]]
) -> Figure:
    """Return the figure: statistics of the unstable cases over the step, over the cut-off, and first impulses."""
    figure = Figure(figsize=(11.0, 9.5), layout="constrained", dpi=110)
    panels = figure.subplots(3, 3)
    for column, case in enumerate(UNSTABLE):
        draw_steps(panels[:2, column], case, *steps[case])
    panels[0, 0].set_ylabel("separated share of time")
    panels[0, 0].legend(fontsize=7, loc="lower left")
    panels[1, 0].set_ylabel("99.9th percentile of force [N]")
    draw_cutoffs(panels[2, 0], cutoffs, "separated")
    panels[2, 0].set_ylabel("separated share\nagainst 40 kHz [%]")
    panels[2, 0].legend(fontsize=7, loc="upper left")
    draw_cutoffs(panels[2, 1], cutoffs, FORCE)
    panels[2, 1].set_ylabel("99.9th percentile of force\nagainst 40 kHz [%]")
    draw_impulses(panels[2, 2])
    return figure


def run_steps(case: str) -> tuple[Means, Means, list[Means]]:
    """Return the means of a case under the explicit scheme at both its steps and under the exact one at each step."""
    reference, check = (ensemble(case, CentralDifference(), step) for step in (FINEST, CHECK))
    return reference, check, [ensemble(case, ExactModal(), step) for step in STEPS]


def run_near(case: str) -> tuple[Means, Means, list[Means]]:
    """Return the same with modes cut off a little above the tone, at the same fractions of the limit."""
    schemes = [(CentralDifference(), FINEST), (CentralDifference(), CHECK), *((ExactModal(), h) for h in STEPS)]
    own = {"interval": LONGER * INTERVAL, "cutoff": NEAR}
    reference, check, *found = (ensemble(case, scheme, LONGER * step, **own) for scheme, step in schemes)
    return reference, check, found


def run_cutoffs(case: str) -> tuple[Means, list[Means], list[Means]]:
    """Return the means of a case with all modes, and below each cut-off at the fine and at the chosen step."""
    own = [{"cutoff": cutoff, "slider.elements": ELEMENTS} for cutoff in (*CUTOFFS, HIGHEST)]
    *fine, highest = (ensemble(case, ExactModal(), FINE, **overrides) for overrides in own)
    chosen = [ensemble(case, ExactModal(), chosen_step(case, **overrides), **overrides) for overrides in own[:-1]]
    return highest, fine, chosen


def write_steps(name: str, found: dict[str, tuple[Means, Means, list[Means]]], longer: float) -> None:
    """Write a table over the step, all steps multiplied."""
    shares = [f"{2.0 * SHIPPED * step:.2g} ({1e6 * longer * step:.3g} µs)" for step in STEPS]
    rows = [["statistics", *(f"explicit, {1e6 * longer * step:.3g} µs" for step in (FINEST, CHECK)), *shares]]
    for case, means in found.items():
        rows += step_rows(case, *means)
    (DOCS / name).write_text(first_contacts.table(rows), encoding="utf-8")


def main() -> None:
    """Run every case, write the tables and the figure."""
    steps = {case: run_steps(case) for case in STARTS}
    write_steps("step-table.rst", steps, 1.0)
    near = "strong-pressure"
    write_steps("step-near-table.rst", {near: run_near(near)}, LONGER)

    cutoffs = {case: run_cutoffs(case) for case in STARTS}
    kilohertz = [f"{1e-3 * cutoff:.0f} kHz" for cutoff in CUTOFFS]
    rows = [["statistics", "40 kHz", *kilohertz, *(f"{word}, step" for word in kilohertz)]]
    for case, found in cutoffs.items():
        rows += cutoff_rows(case, *found)
    (DOCS / "step-cutoff-table.rst").write_text(first_contacts.table(rows), encoding="utf-8")

    drawn = figure_of(steps, {case: found[:2] for case, found in cutoffs.items()})
    plot.save(drawn, DOCS / "images" / "step.png")


if __name__ == "__main__":
    main()
