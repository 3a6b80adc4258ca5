"""Doubtful values of a scenario on standard error."""

from __future__ import annotations

from contextlib import suppress

from ..analysis.doubts import doubts
from ..scenarios.errors import ScenarioError
from ..scenarios.load import load_scenario
from .exits import GOOD, say
from .warned import doubts_on_the_card


def say_doubts(name: str) -> None:
    """Print a line on standard error about each doubtful value of a scenario that can be loaded."""
    # A scenario that cannot be loaded can still be shown; `stridula run` reports why it cannot run.
    with suppress(ScenarioError, OSError), doubts_on_the_card():
        for line in doubts(load_scenario(name).system):
            say(f"doubtful: {line}", GOOD)
