"""Ratios of times measured in turns in one process, their table, and the agreement of the sides of a ratio.

With `--short` among the arguments of any benchmark, everything `sized` is small: a run of seconds shows that all parts
work and agree, but its ratios mean nothing.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

import machine

SHORT = "--short" in sys.argv
# Arguments for child processes.
FORM = ("--short",) if SHORT else ()
Size, Found = TypeVar("Size"), TypeVar("Found")


def sized(usual: Size, short: Size) -> Size:
    """Return the usual size, or that of the short form if it is asked for."""
    return short if SHORT else usual


# Rounds that count, and rounds before them for compilation.
REPEATS, WARM_UP = sized((5, 1), (1, 0))
HEAD = ("quantity", "bar", "min", "median", "max", "")


@dataclass(frozen=True)
class Ratio:
    """A ratio: its quantity, its value in each repeat, and its bar: the smallest or largest median allowed.

    Attributes
    ----------
    quantity : str
        Description, as "one quantity over another".
    values : list of float
        One value for each repeat.
    least, most : float or None
        Smallest or largest median allowed, None without a bar.
    """

    quantity: str
    values: list[float]
    least: float | None = None
    most: float | None = None

    @property
    def misses(self) -> bool:
        """Whether the median is on the wrong side of the bar."""
        median = statistics.median(self.values)
        return (self.least is not None and median < self.least) or (self.most is not None and median > self.most)

    def cells(self) -> tuple[str, ...]:
        """Return the cells of its line in the table."""
        bar = f">= {self.least:g}" if self.least is not None else f"<= {self.most:g}" if self.most is not None else ""
        spread = (min(self.values), statistics.median(self.values), max(self.values))
        return self.quantity, bar, *map(short, spread), "misses" if self.misses and not SHORT else ""


# A line that is not a ratio gives the reason why there is none.
Lines = Iterable[Ratio | str]


def short(value: float) -> str:
    """Return a number to three digits, or as an integer from 100 on."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def seconds(*sides: Callable[[], Found], agree: Callable[[Found, Found], None] | None = None) -> list[list[float]]:
    """Return the wall times of each side in each repeat [s], taken in turns after a first round that compiles.

    Parameters
    ----------
    *sides : callable
        Functions to time.
    agree : callable, optional
        Function that exits if the result of a side differs from that of the first.
    """
    taken: list[list[float]] = [[] for _ in sides]
    for repeat in range(WARM_UP + REPEATS):
        returned = []
        for times, side in zip(taken, sides, strict=True):
            began = time.perf_counter()
            returned.append(side())
            if repeat >= WARM_UP:
                times.append(time.perf_counter() - began)
        if agree and repeat == 0:
            first, *others = returned
            for other in others:
                agree(other, first)
    return taken


def must_agree(quantity: str, found: object, expected: object, tolerance: float) -> None:
    """Exit with a one-line message if two sides differ by more than a share of the largest value."""
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    same_shape = found.shape == expected.shape
    apart = np.abs(found - expected).max() / (np.abs(expected).max() or 1.0) if same_shape else np.inf
    if not apart <= tolerance:
        raise SystemExit(f"{quantity} must agree to {tolerance:g}, differ by {apart:.1e}")


def arguments(description: str) -> argparse.ArgumentParser:
    """Return a parser of a benchmark's own arguments; `--short` has taken effect before."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--short", action="store_true", help="run everything small, to check that it works and agrees; measures nothing"
    )
    return parser


def over(above: list[float], below: list[float], factor: float = 1.0) -> list[float]:
    """Return the ratios of two sides for each repeat."""
    return [factor * one / other for one, other in zip(above, below, strict=True)]


def as_text(title: str, lines: Lines) -> Iterator[str]:
    """Yield the lines of a section as text, each as soon as it is measured."""
    yield ""
    yield laid_out((title, *HEAD[1:]))
    for line in lines:
        yield f"  {line}" if isinstance(line, str) else laid_out(line.cells())


def laid_out(cells: tuple[str, ...]) -> str:
    """Return a line of the table for a terminal."""
    quantity, bar, *numbers, verdict = cells
    return f"{quantity:<66}{bar:>8}{''.join(f'{number:>9}' for number in numbers)}  {verdict}".rstrip()


def as_markdown(title: str, lines: Lines) -> Iterator[str]:
    """Yield a section as a table in Markdown."""
    found = list(lines)
    ratios = [line for line in found if isinstance(line, Ratio)]
    yield from ("", f"### {title[0].upper()}{title[1:]}", "")
    if ratios:
        yield from (f"| {' | '.join(HEAD)} |", "|---|---|---:|---:|---:|---|")
        yield from (f"| {' | '.join(one.cells())} |" for one in ratios)
    yield from (f"{line}." for line in found if isinstance(line, str))


def show(title: str, lines: Lines) -> None:
    """Print the machine and one section."""
    print("\n".join(machine.description()))
    for line in as_text(title, lines):
        print(line, flush=True)


def write_between(begin: str, end: str, target: Path, lines: list[str]) -> None:
    """Replace the lines between two marks of a page."""
    before, _, rest = target.read_text(encoding="utf-8").partition(begin)
    _, mark, after = rest.partition(end)
    if not mark:
        raise SystemExit(f"{target} must have the lines {begin} and {end}")
    target.write_text("\n".join([f"{before}{begin}", "", *lines, "", f"{end}{after}"]), encoding="utf-8")


def peak_memory(script: str) -> float:
    """Return the peak memory of a fresh process that runs a script with the argument ``child`` [bytes]."""
    process = subprocess.Popen([sys.executable, script, "child", *FORM])
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"the run for the memory measurement ended with exit code {process.returncode}")
    return float(usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024))
