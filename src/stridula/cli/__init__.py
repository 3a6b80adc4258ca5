"""The command line: thin verbs over the public API."""

from __future__ import annotations

import atexit
import gc
import sys

from ..extras import MissingPackage, named_extras
from .consoles import print_anything
from .exits import BAD_INPUT, GOOD, INTERRUPTED, failed, say, terminated_as_interrupted
from .long_tasks import tasks_shown
from .warned import doubts_said


def main() -> None:
    """Run `stridula` and exit: 0 good, 1 a failed run or a full disk, 2 bad input, 130 interrupted."""
    # At exit, Python would search all imported objects for garbage, which takes longer than a short run.
    atexit.register(gc.freeze)
    print_anything()
    with terminated_as_interrupted():
        code = _run()
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError as error:
        code = failed(error)
    raise SystemExit(code)


def _run() -> int:
    try:
        with tasks_shown(), doubts_said(), named_extras():
            from .commands import app

            result = app(standalone_mode=False)
    except SystemExit as stop:
        # Rich leaves this way when its output is closed.
        return GOOD if stop.code == 1 else int(stop.code or GOOD)
    except KeyboardInterrupt:
        result = INTERRUPTED
    except MissingPackage as error:
        return say(str(error), BAD_INPUT)
    except Exception as error:
        return failed(error)
    return say("interrupted; nothing was kept", INTERRUPTED) if result == INTERRUPTED else int(result or GOOD)
