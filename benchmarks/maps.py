"""A map of the paper's system: 1600 runs of one second with their regimes and linear stability, whole."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from ratios import REPEATS, Ratio, over, seconds, show

TITLE = "map of 40 x 40 points: squeal over friction and angle, 1 s each"
LONGEST_WALL_TIME = 20.0
ASKED = ("--vary", "friction=0.2:2.0:40", "--vary", "angle=10deg:80deg:40", "--measure", "regime")
VERB = "from stridula.cli import main; main()"


def rows() -> Iterator[Ratio]:
    """Yield the wall time of the whole command over its bar, and over that of one worker."""
    all_cores, one = seconds(sweep, lambda: sweep("--workers", "1"), repeats=REPEATS)
    bar = [LONGEST_WALL_TIME] * REPEATS
    yield Ratio("whole command with its figure, over 20 s", over(all_cores, bar), most=1.0)
    yield Ratio("one worker over all processors", over(one, all_cores))


def sweep(*options: str) -> None:
    """Run the command in an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        files = ("--out", str(Path(folder) / "map.nc"), "--plot", str(Path(folder) / "map.png"))
        command = [sys.executable, "-c", VERB, "sweep", "squeal", *ASKED, *files, *options]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    show(TITLE, rows())
