"""First contacts under the exact scheme against the explicit one at a much smaller step, as a table.

Each case of the paper starts from nine gaps within 10 % of its own, so that steps and landings are out of phase.
Instants are compared in steps; impulses in percent, root mean square over the starts, with the order fitted to them.
Writes docs/step-first-contacts-table.rst in ten seconds.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import stridula as st
from stridula.integration import CentralDifference, ExactModal

TARGET = Path(__file__).resolve().parents[3] / "docs" / "step-first-contacts-table.rst"
CASES = ("stable-sliding", "squeal", "judder", "weak-pressure", "strong-pressure", "axial-sliding")
STEPS = tuple(40e-6 / n for n in (12, 8, 6, 4, 3, 2))
FINEST = 0.25e-6
DURATION = 25e-3
STARTS = tuple(1.0 + share for share in np.linspace(-0.1, 0.1, 9))
WINDOW = 1e-3
# Two instants further apart than two steps and this [s] are those of different events.
SAME = 15e-6
INSTANTS = ("first touch", "first separation", "first stick", "first slip after it")
IMPULSES = ("impulse of the first touch", "impulse over the first millisecond")


@dataclass(frozen=True)
class Start:
    """First events of a run: instants [s], and the impulse since the start [N s] over time [s]."""

    instants: dict[str, float]
    time: np.ndarray
    impulse: np.ndarray

    def impulse_from_touch(self, end: float) -> float:
        """Return the impulse up to an instant [N s]."""
        return float(np.interp(end, self.time, self.impulse))


def first(holds: np.ndarray, step: float, start: float = 0.0) -> float:
    """Return the beginning of the first step from `start` on in which `holds` is true [s], NaN if there is none."""
    since = round(start / step) if np.isfinite(start) else holds.size
    found = np.flatnonzero(holds[since:])
    return float(since + found[0]) * step if found.size else float("nan")


def run(case: str, gap: float, scheme: CentralDifference | ExactModal, step: float) -> Start:
    """Return the beginning of a case whose gap is multiplied."""
    own = st.load_scenario(case).system.contact.gap
    system = st.load_scenario(case, {"contact.gap": own * gap}).system
    record = st.simulate(system, DURATION, scheme=scheme, step=step, sample_rate=1.0 / step, probes=())
    status = record["status"].values
    touch, stick = first(status > 0, step), first(status == 1, step)
    instants = (touch, first(status == 0, step, touch), stick, first(status == 2, step, stick))
    # The force at a step acts, in the middle, at the step's beginning: its impulse is complete half a step later.
    time = record["time"].values - 0.5 * step
    impulse = step * np.cumsum(record["normal_force"].values)
    return Start(dict(zip(INSTANTS, instants, strict=True)), time, impulse)


def instant_errors(found: list[Start], exact: list[Start], name: str, step: float) -> np.ndarray:
    """Return by how many steps an instant is late, for each start."""
    return np.array([(a.instants[name] - b.instants[name]) / step for a, b in zip(found, exact, strict=True)])


def are_same(errors: np.ndarray, step: float) -> np.ndarray:
    """Return a mask of the errors, in steps, that are small enough for the same event."""
    return np.abs(errors) <= max(2.0, SAME / step)


def touch_errors(found: list[Start], exact: list[Start], step: float) -> np.ndarray:
    """Return the relative errors of the impulse of the first touch, where the same separation ends it."""
    same = are_same(instant_errors(found, exact, "first separation", step), step)
    ends = [(a.instants["first separation"], b.instants["first separation"]) for a, b in zip(found, exact, strict=True)]
    pairs = [
        a.impulse_from_touch(end) / b.impulse_from_touch(known) - 1.0
        for a, b, (end, known) in zip(found, exact, ends, strict=True)
    ]
    return np.array(pairs)[same]


def window_errors(found: list[Start], exact: list[Start]) -> np.ndarray:
    """Return the relative errors of the impulse over the first millisecond from the first touch."""
    ends = [start.instants["first touch"] + WINDOW for start in exact]
    return np.array(
        [a.impulse_from_touch(t) / b.impulse_from_touch(t) - 1.0 for a, b, t in zip(found, exact, ends, strict=True)]
    )


def root_mean_square(values: np.ndarray) -> float:
    """Return the root mean square, NaN without values."""
    return float(np.sqrt(np.mean(values**2))) if values.size else float("nan")


def order(errors: list[float]) -> float:
    """Return the fitted order of errors over the steps up to 0.4 of the limit."""
    return float(np.polyfit(np.log(STEPS[:-1]), np.log(errors[:-1]), 1)[0])


def compare(case: str) -> tuple[list[Start], list[list[Start]]]:
    """Return the starts of a case under the explicit scheme at the finest step and the exact scheme at each step."""
    exact = [run(case, gap, CentralDifference(), FINEST) for gap in STARTS]
    return exact, [[run(case, gap, ExactModal(), step) for gap in STARTS] for step in STEPS]


def instant_cell(errors: np.ndarray, step: float) -> str:
    """Return the largest error for the same event, and the number of starts in which it is another one."""
    same = errors[are_same(errors, step)]
    others = errors.size - same.size
    most = f"{np.abs(same).max():.1f}" if same.size else "—"
    return most + (f" (**{others} other**)" if others else "")


def rows(case: str) -> list[list[str]]:
    """Return the rows of a case."""
    exact, found = compare(case)
    own = exact[len(STARTS) // 2]
    lines = []
    for name in INSTANTS:
        if np.isfinite(own.instants[name]):
            cells = [instant_cell(instant_errors(a, exact, name, h), h) for a, h in zip(found, STEPS, strict=True)]
            lines.append([f"{case}: {name}", f"{1e6 * own.instants[name]:.0f} µs", *cells, ""])
    touch = [root_mean_square(touch_errors(a, exact, h)) for a, h in zip(found, STEPS, strict=True)]
    window = [root_mean_square(window_errors(a, exact)) for a in found]
    ends = (own.instants["first separation"], own.instants["first touch"] + WINDOW)
    for name, errors, end in zip(IMPULSES, (touch, window), ends, strict=True):
        whole = f"{1e3 * own.impulse_from_touch(end):.3g} mN s"
        cells = [f"{100.0 * e:.2f} %" for e in errors]
        lines.append([f"{case}: {name}", whole, *cells, f"{order(errors):.1f}"])
    return lines


def table(rows: list[list[str]]) -> str:
    """Return rows, the first of which is the header, as reStructuredText."""
    lines = [".. list-table::", "   :header-rows: 1", ""]
    for row in rows:
        lines += [f"   * - {row[0]}", *(f"     - {cell}".rstrip() for cell in row[1:])]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run every case and write the table."""
    header = ["first contacts", "explicit, 0.25 µs", *(f"{1e6 * step:.3g} µs" for step in STEPS), "order"]
    found = table([header, *(row for case in CASES for row in rows(case))])
    TARGET.write_text(found, encoding="utf-8")
    print(found)


if __name__ == "__main__":
    main()
