"""Start-up: whole fresh processes from a warm cache, over their bars."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

from ratios import Ratio, seconds, show

TITLE = "start-up: wall time of a fresh process over its bar"
# Code to run, time to divide by [s], and whether it is a bar.
PROCESSES = {
    "import stridula, over 0.7 s": (("import stridula",), 0.7, True),
    "import all that simulate needs, over 0.7 s": (("import stridula; stridula.simulate",), 0.7, False),
    "stridula run squeal, over 2 s": (("from stridula.cli import main; main()", "run", "squeal"), 2.0, True),
}


def rows() -> Iterator[Ratio]:
    """Yield the ratio of each kind of process."""
    taken = seconds(*(lambda given=given: fresh(given) for given, _, _ in PROCESSES.values()))
    for (words, (_, limit, barred)), times in zip(PROCESSES.items(), taken, strict=True):
        yield Ratio(words, [one / limit for one in times], most=1.0 if barred else None)


def fresh(given: tuple[str, ...]) -> None:
    """Run code with arguments in a fresh process."""
    subprocess.run([sys.executable, "-c", *given], check=True, capture_output=True)


if __name__ == "__main__":
    show(TITLE, rows())
