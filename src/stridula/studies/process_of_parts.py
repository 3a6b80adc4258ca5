"""The process of a study: a task, then points of part after part; what came of each."""

from __future__ import annotations

import math
import os
import pickle
import signal
import sys

from . import processes
from .task import use_one_thread


def main() -> None:
    """Answer until nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # What functions print is no answer.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    asked = sys.stdin.buffer
    # A module that runs a sweep when it is imported begins no processes in its turn.
    processes.COST = math.inf
    use_one_thread()
    try:
        task = pickle.load(asked)
    except Exception:
        # What cannot be imported here is computed where it was asked for.
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
        # The study is over, or its process is gone: what is left unwritten would only be complained of.
        os._exit(0)


if __name__ == "__main__":
    main()
