"""Run inputs of every kind in separate processes, with limits of time and memory, and count the outcomes."""

from __future__ import annotations

import argparse
import faulthandler
import multiprocessing
import os
import pkgutil
import resource
import signal
import sys
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from itertools import islice
from multiprocessing.connection import Connection, wait
from types import ModuleType
from typing import Any

# Time limit of one input [s], and memory limit of its process beyond that at the start [bytes].
LIMIT, MEMORY = 20.0, 4 * 1024**3
WRONG = ("crashed", "hung", "traceback")
# Largest number of failures of a kind that are printed in full.
TOLD = 40
FORK = multiprocessing.get_context("fork")


def modules() -> dict[str, ModuleType]:
    """Return the kinds of inputs: every module here that has inputs."""
    names = [found.name for found in pkgutil.iter_modules([os.path.dirname(__file__)]) if found.name != "__main__"]
    every = {name: import_module(f"{__package__}.{name}") for name in names}
    return {name: module for name, module in every.items() if hasattr(module, "inputs")}


class Worker:
    """A process that runs one input after another."""

    def __init__(self, kind: ModuleType) -> None:
        self.pipe, theirs = FORK.Pipe()
        self.process = FORK.Process(target=_serve, args=(kind, theirs))
        self.process.start()
        theirs.close()
        self.number, self.given, self.since = -1, None, 0.0

    def take(self, number: int, given: Any) -> None:
        """Send the next input."""
        self.number, self.given, self.since = number, given, time.monotonic()
        self.pipe.send(given)

    def end(self) -> None:
        """Kill the process."""
        self.process.kill()
        self.process.join()
        self.pipe.close()


def _serve(kind: ModuleType, pipe: Connection) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    faulthandler.disable()
    with open("/proc/self/statm") as file:
        held = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (held + MEMORY, held + MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    null = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(null, stream)
    while True:
        try:
            given = pipe.recv()
        except EOFError:
            return
        try:
            answer = (kind.check(given), "")
        except BaseException:
            answer = ("traceback", traceback.format_exc())
        pipe.send((*answer, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024))


def counted(name: str, kind: ModuleType, seed: int, count: int, workers: int) -> tuple[Counter[str], int]:
    """Return counts of the outcomes of a kind, and the peak memory of a process [bytes]; print failures."""
    counts: Counter[str] = Counter()
    given, peak = enumerate(kind.inputs(seed, count)), 0
    busy: list[Worker] = []

    def judge(one: Worker, answer: str, words: str) -> None:
        counts[answer] += 1
        if answer in WRONG and sum(counts[word] for word in WRONG) <= TOLD:
            print(f"{name} {answer}: --kind {name} --seed {seed} --number {one.number}: {one.given!r:.600}")
            print("\n".join(f"    {line}" for line in words.strip().split("\n")[-14:]), flush=True)

    for number, one in islice(given, workers):
        busy.append(Worker(kind))
        busy[-1].take(number, one)
    while busy:
        wait([one.pipe for one in busy], timeout=0.5)
        for place, one in enumerate(list(busy)):
            answer = _answer(one)
            if answer is None:
                continue
            word, words, memory = answer
            judge(one, word, words)
            peak = max(peak, memory)
            following = next(given, None)
            if word in ("crashed", "hung") or following is None:
                one.end()
                busy[place] = Worker(kind) if following is not None else None  # type: ignore[call-overload]
            if following is not None:
                busy[place].take(*following)
        busy = [one for one in busy if one is not None]
    return counts, peak


def _answer(one: Worker) -> tuple[str, str, int] | None:
    """Return the outcome of an input, None if it is not known yet."""
    try:
        if one.pipe.poll():
            found: tuple[str, str, int] = one.pipe.recv()
            return found
    except (EOFError, ConnectionResetError):
        one.process.join()
        return "crashed", f"exit code {one.process.exitcode}", 0
    return ("hung", f"more than {LIMIT:g} s", 0) if time.monotonic() - one.since > LIMIT else None


def repeated(kind: ModuleType, seed: int, number: int) -> None:
    """Repeat one input in this process."""
    given = next(islice(kind.inputs(seed, number + 1), number, None))
    print(repr(given)[:3000])
    print(kind.check(given))


def lines(kinds: dict[str, ModuleType], seed: int, count: int, workers: int) -> Iterator[tuple[str, bool]]:
    """Return a line of counts for each kind, and whether there was no failure."""
    for name, kind in kinds.items():
        began = time.monotonic()
        counts, peak = counted(name, kind, seed, count, workers)
        words = ", ".join(f"{counts[word]} {word}" for word in ("accepted", "refused", *WRONG))
        took = time.monotonic() - began
        yield (
            f"{name}: {counts.total()} inputs, {words}, memory peak {peak / 2**20:.0f} MiB, {took:.0f} s",
            not any(counts[word] for word in WRONG),
        )


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="other inputs for another number")
    parser.add_argument("--count", type=int, default=10_000, help="inputs in all, as many of each kind")
    parser.add_argument("--kind", choices=list(modules()), help="one kind only")
    parser.add_argument("--number", type=int, help="repeat one input of a kind, here and with its traceback")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1, help="processes at a time")
    asked = parser.parse_args()
    kinds = {asked.kind: modules()[asked.kind]} if asked.kind else modules()
    if asked.number is not None:
        if asked.kind is None:
            parser.error("--number must be used with --kind")
        repeated(kinds[asked.kind], asked.seed, asked.number)
        return 0
    # Compiled, imported and cached once, before processes fork.
    for kind in kinds.values():
        kind.check(next(iter(kind.inputs(asked.seed, 1))))
    well = True
    for line, is_well in lines(kinds, asked.seed, -(-asked.count // len(kinds)), asked.workers):
        print(line, flush=True)
        well = well and is_well
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
