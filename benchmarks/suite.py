"""All benchmarks as one table of ratios, each measured in one run with its sides in turns; `make bench`.

    python benchmarks/suite.py                               print the table
    python benchmarks/suite.py --write docs/performance.md   also write it there, between its two marks
    python benchmarks/suite.py --short                       check in seconds that everything runs and agrees

Each section also runs alone: `python benchmarks/scaling.py`. A ratio whose median is on the wrong side of its bar
is marked; the exit status is still 0, because a machine may be busy. It is 1, with a message,
if the two sides of a ratio do not agree.
"""

from __future__ import annotations

from pathlib import Path

import against_c
import brake
import faces
import gpu
import limit_cycles
import linear_theory
import machine
import many_contacts
import many_runs
import maps
import meshes
import peer_speed
import real_time
import scaling
import short_runs
import space
import speed_and_memory
import startup
import surveys
from ratios import arguments, as_markdown, as_text, write_between

# Memory first: see `speed_and_memory`.
SECTIONS = (
    speed_and_memory,
    against_c,
    many_contacts,
    brake,
    peer_speed,
    real_time,
    many_runs,
    short_runs,
    space,
    meshes,
    faces,
    linear_theory,
    limit_cycles,
    maps,
    surveys,
    scaling,
    startup,
    gpu,
)
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def measure() -> list[str]:
    """Print each line as soon as it is measured and return the same in Markdown."""
    words = machine.description()
    print("\n".join(words), flush=True)
    page = [f"- {line}" for line in words]
    for section in SECTIONS:
        found = []

        def kept(rows=section.rows, found=found):
            for row in rows():
                found.append(row)
                yield row

        for line in as_text(section.TITLE, kept()):
            print(line, flush=True)
        page += as_markdown(section.TITLE, found)
    return page


def main() -> None:
    """Measure, and write if asked to."""
    words = arguments(__doc__)
    words.add_argument("--write", type=Path, metavar="FILE", help="also write the table to this page")
    chosen = words.parse_args()
    if chosen.write and chosen.short:
        words.error("--short has no measurements to write")
    page = measure()
    if chosen.write:
        write_between(BEGIN, END, chosen.write, page)


if __name__ == "__main__":
    main()
