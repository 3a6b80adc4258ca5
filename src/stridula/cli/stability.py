"""`stridula stability`: equilibrium and modes of sliding by linear theory, at one set of parameters."""

from __future__ import annotations

from typing import Any

import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..analysis.stability import sliding_stability
from ..analysis.stability_words import closing_lines, mode_columns, shown_modes
from ..checks import ArgumentError
from ..scenarios.load import load_scenario
from ..scenarios.quantities import quantity
from .consoles import wide_console


def print_stability(name: str, overrides: dict[str, Any], status: str | None, velocity: str | None) -> None:
    """Print the equilibrium and modes of a scenario: those that grow, or the few nearest to growth."""
    scenario = load_scenario(name, overrides)
    given = statuses(status)
    modes = sliding_stability(scenario.system, status=given, velocity=velocities(velocity))
    console = wide_console()
    console.print(_table(modes, scenario.title or name))
    for line in closing_lines(modes, given is not None):
        console.print(escape(line), highlight=False)


def statuses(status: str | None) -> list[str] | None:
    """Return the statuses given by an option, separated by commas."""
    return None if status is None else [word.strip() for word in status.split(",")]


def velocities(velocity: str | None) -> float | list[float] | None:
    """Return the slip velocities [m/s] given by an option: one for all contacts, or a list separated by commas."""
    if velocity is None:
        return None
    try:
        numbers = [quantity(word, "m/s") for word in velocity.split(",")]
    except ArgumentError as error:
        raise ArgumentError("--velocity", error.allowed, velocity) from None
    return numbers[0] if len(numbers) == 1 else numbers


def _table(modes: xr.Dataset, title: str) -> Table:
    table = Table(title=escape(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    columns = mode_columns(modes)
    for head in columns:
        table.add_column(head, justify="right", overflow="fold")
    grows = modes["unstable"].values[shown_modes(modes)]
    for cells, grown in zip(zip(*columns.values(), strict=True), grows, strict=True):
        table.add_row(*cells, style="bold" if grown else None)
    return table
