"""A map of the paper's system: 1600 runs of one second with their regimes and linear stability, whole."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from ratios import REPEATS, Ratio, over, seconds, show, sized

SIDE, DURATION = sized((40, 1.0), (3, 0.02))
TITLE = f"map of {SIDE} x {SIDE} points: squeal over friction and angle, {DURATION:g} s each"
LONGEST_WALL_TIME = 20.0
ASKED = ("--vary", f"friction=0.2:2.0:{SIDE}", "--vary", f"angle=10deg:80deg:{SIDE}", "--duration", f"{DURATION}")
VERB = "from stridula.cli import main; main()"


def rows() -> Iterator[Ratio]:
    """Yield the wall time of the whole command over its bar, and over that of one worker."""
    all_cores, one = seconds(sweep, lambda: sweep("--workers", "1"), agree=same)
    bar = [LONGEST_WALL_TIME] * REPEATS
    yield Ratio("whole command with its figure, over 20 s", over(all_cores, bar), most=1.0)
    yield Ratio("one worker over all processors", over(one, all_cores))


def same(found: bytes, expected: bytes) -> None:
    """Stop where two files differ."""
    if found != expected:
        raise SystemExit("maps of one worker and of all must be the same bytes, differ")


def sweep(*options: str) -> bytes:
    """Run the command in an empty folder and return the file it writes."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "map.nc"
        files = ("--measure", "regime", "--out", str(out), "--plot", str(out.with_suffix(".png")))
        command = [sys.executable, "-c", VERB, "sweep", "squeal", *ASKED, *files, *options]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return out.read_bytes()


if __name__ == "__main__":
    show(TITLE, rows())
