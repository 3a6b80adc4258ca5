"""A map of the paper's system: 1600 runs of one second with their regimes and linear stability, whole."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ratios import REPEATS, SHORT, Ratio, over, seconds, show, sized

SIDE, DURATION = sized((40, 1.0), (3, 0.02))
TITLE = f"map of {SIDE} x {SIDE} points: squeal over friction and angle, {DURATION:g} s each"
LONGEST_WALL_TIME = 20.0
ASKED = ("--vary", f"friction=0.2:2.0:{SIDE}", "--vary", f"angle=10deg:80deg:{SIDE}", "--duration", f"{DURATION}")
VERB = "from stridula.cli import main; main()"
# Commit of the sources to compare with, and the bar.
BEFORE, SHARE = "4514ce1", 0.7
ROOT = Path(__file__).resolve().parents[1]


def rows() -> Iterator[Ratio | str]:
    """Yield the wall time of the command over its bar, over that of one worker, and over that of older sources."""
    all_cores, one = seconds(sweep, lambda: sweep("--workers", "1"), agree=same)
    bar = [LONGEST_WALL_TIME] * REPEATS
    yield Ratio("whole command with its figure, over 20 s", over(all_cores, bar), most=1.0)
    yield Ratio("one worker over all processors", over(one, all_cores))
    yield from over_before()


def over_before() -> Iterator[Ratio | str]:
    """Yield the wall time of the whole command over that with the older sources, or the reason why there is none."""
    if SHORT or shutil.which("git") is None:
        yield f"the map of the sources of {BEFORE} needs {'the usual form' if SHORT else 'git, which is not installed'}"
        return
    with sources_of_before() as sources:
        if sources is None:
            yield f"the earlier map needs the commit {BEFORE}, which is not in this copy of the sources"
            return
        now, before = seconds(sweep, lambda: sweep(sources=sources))
    yield Ratio("whole command with its figure, over that of an earlier commit", over(now, before), most=SHARE)


@contextmanager
def sources_of_before() -> Iterator[Path | None]:
    """Check the older sources out into a folder, if git has them."""
    with tempfile.TemporaryDirectory() as folder:
        packed = Path(folder) / "sources.tar"
        asked = ["git", "-C", str(ROOT), "archive", "--output", str(packed), BEFORE, "src"]
        if subprocess.run(asked, capture_output=True).returncode:
            yield None
            return
        shutil.unpack_archive(packed, folder, filter="data")
        yield Path(folder) / "src"


def same(found: bytes, expected: bytes) -> None:
    """Exit if two files differ."""
    if found != expected:
        raise SystemExit("maps of one worker and of all must be the same bytes, differ")


def sweep(*options: str, sources: Path | None = None) -> bytes:
    """Run the command in an empty folder, with other sources if given, and return the file that it writes."""
    environment = os.environ | ({"PYTHONPATH": str(sources)} if sources else {})
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "map.nc"
        files = ("--measure", "regime", "--out", str(out), "--plot", str(out.with_suffix(".png")))
        command = [sys.executable, "-c", VERB, "sweep", "squeal", *ASKED, *files, *options]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=environment)
        return out.read_bytes()


if __name__ == "__main__":
    show(TITLE, rows())
