"""`stridula compare`: two records side by side."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..records.compare import compare
from ..records.files import load


def print_comparison(first: str, second: str, tolerance: float) -> bool:
    """Print the differences between two records and return whether they are within the tolerance."""
    result = compare(load(first), load(second), tolerance)
    console = Console()
    console.print(_differences(result, f"{first} (a) against {second} (b)"))
    console.print(_statistics(result))
    if result.sizes["attribute"]:
        console.print(_attributes(result))
    for line in _closing(result):
        console.print(escape(line), highlight=False)
    return bool(result.attrs["within_tolerance"])


def _differences(result: xr.Dataset, title: str) -> Table:
    table = _table(title, ("variable", "unit"), ("difference", "relative", "first at [s]"))
    for name in result["variable"].values:
        row = result.sel(variable=name)
        since = float(row["first_time"])
        numbers = [
            f"{float(row['difference']):.3g}",
            f"{float(row['relative_difference']):.2g}",
            "never" if math.isnan(since) else f"{since:.6g}",
        ]
        table.add_row(escape(str(name)), escape(str(row["units"].item())), *numbers)
    return table


def _statistics(result: xr.Dataset) -> Table:
    table = _table("statistics", ("variable", "unit"), ("mean a", "mean b", "rms a", "rms b"))
    for name in result["variable"].values:
        row = result.sel(variable=name)
        numbers = [f"{value:.4g}" for word in ("mean", "rms") for value in row[word].values]
        table.add_row(escape(str(name)), escape(str(row["units"].item())), *numbers)
    return table


def _table(title: str, words: tuple[str, ...], numbers: tuple[str, ...] = ()) -> Table:
    table = Table(title=escape(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for head in words:
        table.add_column(head, overflow="fold")
    for head in numbers:
        table.add_column(head, justify="right", no_wrap=True)
    return table


def _attributes(result: xr.Dataset) -> Table:
    table = _table("other differences", ("key", "a", "b"))
    for name in result["attribute"].values:
        table.add_row(*(escape(str(text)) for text in (name, *result["value"].sel(attribute=name).values)))
    return table


def _closing(result: xr.Dataset) -> list[str]:
    counts = [result.attrs[name] for name in ("samples", "samples_a", "samples_b")]
    lines = []
    if len(set(counts)) > 1:
        lines.append(f"Compared over the {counts[0]} samples that both have; a has {counts[1]}, b has {counts[2]}.")
    relative = result["relative_difference"].values
    worst = result.isel(variable=int(np.argmax(relative)))
    tolerance = result.attrs["tolerance"]
    if result.attrs["within_tolerance"]:
        return [*lines, f"Within {tolerance:g} everywhere."]
    words = f"{worst['variable'].item()} by {float(worst['difference']):.2g} {worst['units'].item()}"
    share = f"{relative.max():.2g} relative" if math.isfinite(relative.max()) else "where a is zero"
    others = int((relative > tolerance).sum()) - 1
    beside = f"; {others} more {'is' if others == 1 else 'are'} beyond it" if others else ""
    return [*lines, f"Beyond {tolerance:g}: {words}, {share}{beside}."]
