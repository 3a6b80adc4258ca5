"""A process of a study, which reads a task, then the points of parts, and writes their outcomes."""

from __future__ import annotations

import math
import os
import pickle
import signal
import sys

from . import processes
from .task import use_one_thread


def main() -> None:
    """Answer requests until the input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # This keeps output printed by functions out of the answers.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    asked = sys.stdin.buffer
    # A module that runs a sweep on import must not start processes itself.
    processes.COST = math.inf
    use_one_thread()
    try:
        task = pickle.load(asked)
    except Exception:
        # A task that cannot be imported here is computed in the calling process.
        os._exit(1)
    try:
        answers.write(processes.READY)
        answers.flush()
        while True:
            points = pickle.load(asked)
            try:
                found = task.outcomes(points)
            except MemoryError:
                found = None
            answers.write(pickle.dumps(found))
            answers.flush()
    except (EOFError, BrokenPipeError):
        # The study has ended or its process is gone; flushing the remaining output would only fail.
        os._exit(0)


if __name__ == "__main__":
    main()
