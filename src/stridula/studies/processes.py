"""Parts of a study in processes of this machine, for work in which threads would wait for the interpreter."""

from __future__ import annotations

import os
import pickle
import pickletools
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from .task import Outcome, Work

# Expected waiting time above which processes are started [s]: the time to start one.
COST = 2.0
# Sent by a process once it can compute.
READY = b"ready\n"


class Helpers:
    """Processes that are started once they save time, and compute parts in place of the calling threads.

    Parameters
    ----------
    task : Work
        Work at each point.
    parts : int
        Number of parts.
    threads : int
        Number of parts computed at a time; one thread continues in this process.
    """

    def __init__(self, task: Work, parts: int, threads: int) -> None:
        self.task, self.parts, self.threads, self.done = task, parts, threads, 0
        self.began, self.spent, self.decided = time.perf_counter(), time.process_time(), threads < 2
        self.lock, self.all, self.idle = threading.Lock(), list[Helper](), list[Helper]()
        self.closed = False

    def outcomes(self, points: Sequence[Sequence[Any]], workers: int, watch: Callable[[], None]) -> list[Outcome]:
        """Return the outcomes of some points, from a process if one is free, else computed here."""
        with self.lock:
            helper = self.idle.pop() if self.idle else None
        found = None if helper is None else helper.outcomes(points)
        if found is None:
            # A lost process may have run out of memory or been killed; its points are computed here.
            watch()
            found = self.task.outcomes(points, workers, watch)
        elif helper is not None:
            self._take(helper)
        with self.lock:
            self.done += 1
            pays = not self.decided and self._pays()
            self.decided = self.decided or pays
        if pays:
            self._begin()
        return found

    def close(self) -> None:
        """Kill the processes."""
        with self.lock:
            self.closed = True
        for helper in self.all:
            helper.end()

    def _pays(self) -> bool:
        """Return whether threads, at their present rate, would lose more time waiting than processes cost."""
        passed = time.perf_counter() - self.began
        waiting = 1.0 - (time.process_time() - self.spent) / (passed * self.threads)
        return waiting * passed * (self.parts - self.done) / self.done > COST

    def _begin(self) -> None:
        asked, begun = portable(self.task), list[Helper]()
        if asked is not None:
            # If no process can be started, threads continue.
            with suppress(OSError):
                begun += [Helper(asked, self._take) for _ in range(self.threads - 1)]
        with self.lock:
            self.all += begun
            closed = self.closed
        for helper in begun if closed else ():
            helper.end()

    def _take(self, helper: Helper) -> None:
        """Add a process that is free."""
        with self.lock:
            self.idle.append(helper)


class Helper:
    """A process that computes parts of one task.

    Parameters
    ----------
    asked : bytes
        The task, as `portable` returns it.
    ready : callable
        Called with this object, from a thread, once the process can compute.
    """

    def __init__(self, asked: bytes, ready: Callable[[Helper], None]) -> None:
        paths = os.pathsep.join(path or os.getcwd() for path in sys.path)
        self._process = subprocess.Popen(
            [sys.executable, "-m", "stridula.studies.process_of_parts"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=os.environ | {"PYTHONPATH": paths},
        )
        threading.Thread(target=self._begin, args=(asked, ready), daemon=True).start()

    def _begin(self, asked: bytes, ready: Callable[[Helper], None]) -> None:
        with suppress(OSError, ValueError):
            self._send(asked)
            assert self._process.stdout is not None
            if self._process.stdout.readline() == READY:
                ready(self)

    def _send(self, message: bytes) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(message)
        self._process.stdin.flush()

    def outcomes(self, points: Sequence[Sequence[Any]]) -> list[Outcome] | None:
        """Return the outcomes of some points, None if the process is gone.

        Raises
        ------
        MemoryError
            If it ran out of memory.
        """
        try:
            self._send(pickle.dumps(points))
            assert self._process.stdout is not None
            found: list[Outcome] | None = pickle.load(self._process.stdout)
        except (OSError, EOFError, ValueError, pickle.UnpicklingError):
            self.end()
            return None
        if found is None:
            raise MemoryError("out of memory in a process of the study")
        return found

    def end(self) -> None:
        """Kill the process."""
        with suppress(OSError):
            self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(OSError):
                assert pipe is not None
                pipe.close()


def portable(task: Work) -> bytes | None:
    """Return a task pickled for another process, None if it holds functions that no other process can import."""
    try:
        asked = pickle.dumps(task)
    except Exception:
        return None
    names = (argument for _, argument, _ in pickletools.genops(asked))
    return None if any(name == "__main__" for name in names) else asked
