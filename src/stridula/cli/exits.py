"""Exit codes of the command line, and its one-line errors on standard error."""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

GOOD, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
# Errors while a file is being written; any other OSError is due to a wrong path.
DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


class Stopped(Exception):
    """A run that ended early, after the samples recorded so far are written; `code` is the exit code."""

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.code = code


def failed(error: Exception) -> int:
    """Print an error in one line and return the exit code; errors of the program itself are raised again."""
    usage = getattr(error, "format_message", None)
    if usage is not None:
        return say(usage(), BAD_INPUT)
    if isinstance(error, Stopped):
        return say(str(error), error.code)
    if isinstance(error, BrokenPipeError):
        _drop_output()
        return GOOD
    if isinstance(error, OSError):
        return _failed_file(error)
    if isinstance(error, MemoryError):
        return say("not enough memory for this run", FAILED)
    if isinstance(error, ValueError):
        return say(str(error), BAD_INPUT)
    raise error


@contextmanager
def terminated_as_interrupted() -> Iterator[None]:
    """Treat SIGTERM, by which clusters stop a job, as Ctrl-C, so that recorded samples are kept."""
    process, before = os.getpid(), signal.getsignal(signal.SIGTERM)

    def interrupt(number: int, frame: FrameType | None) -> None:
        if os.getpid() == process:
            signal.raise_signal(signal.SIGINT)
        else:
            # A child process must end.
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)

    if before is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        if before is signal.SIG_DFL:
            signal.signal(signal.SIGTERM, before)


def say(message: str, code: int) -> int:
    """Print one line on standard error and return the exit code."""
    with suppress(OSError):
        print(f"stridula: {' '.join(message.split())}", file=sys.stderr, flush=True)
    return code


def _failed_file(error: OSError) -> int:
    on_the_way = error.errno in DISK
    if on_the_way:
        _drop_output()
    words = ": ".join(str(part) for part in (error.strerror, error.filename) if part)
    return say(words or str(error), FAILED if on_the_way else BAD_INPUT)


def _drop_output() -> None:
    """Discard the remaining standard output, so that closing it at exit cannot fail."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
