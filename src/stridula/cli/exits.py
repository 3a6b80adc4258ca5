"""How the command line ends: exit codes, and one line on standard error."""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

GOOD, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
# What befalls a file on the way; any other OSError is a path that was wrong from the start.
DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


class Stopped(Exception):
    """A run that ended early, once what was recorded is written; `code` is the exit code."""

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.code = code


def failed(error: Exception) -> int:
    """Say in one line what went wrong and return the exit code; errors of the program itself are raised again."""
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
    """Take SIGTERM, by which clusters stop a job, for Ctrl-C, so that what is recorded is kept."""
    process, before = os.getpid(), signal.getsignal(signal.SIGTERM)

    def interrupt(number: int, frame: FrameType | None) -> None:
        if os.getpid() == process:
            signal.raise_signal(signal.SIGINT)
        else:
            # A child is to end.
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
    """Send what is left for standard output nowhere, so that closing it at the end cannot fail."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
