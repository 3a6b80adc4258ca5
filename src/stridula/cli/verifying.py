"""`stridula verify`: table of expected and obtained values."""

from __future__ import annotations

import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import groupby
from types import FrameType
from typing import Any

from rich import box
from rich.markup import escape
from rich.table import Table

from ..verification.report import figure
from .consoles import wide_console


@contextmanager
def interrupted_at_once() -> Iterator[None]:
    """Let Ctrl-C stop between two instructions, not at the end of a run.

    A run handles Ctrl-C only after its current chunk, and a run that ends with that chunk returns normally. With
    hundreds of short runs, Ctrl-C would hardly ever have an effect.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def print_rows(rows: Sequence[dict[str, Any]]) -> None:
    """Print the rows of a verification on standard output, a table for each case with its source below."""
    console = wide_console()
    for case, group in groupby(rows, key=lambda row: row["case"]):
        console.print(_table(case, list(group)))


def _table(case: str, rows: Sequence[dict[str, Any]]) -> Table:
    table = Table(
        title=case,
        caption=f"source: {escape(rows[0]['source'])}",
        title_justify="left",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
    )
    table.add_column("quantity", overflow="fold")
    table.add_column("scheme")
    for name in ("expected", "obtained"):
        table.add_column(name, justify="right", no_wrap=True)
    for name in ("error", "tolerance"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    for row in rows:
        unit = "" if row["units"] == "1" else f" [{row['units']}]"
        table.add_row(
            escape(f"{row['quantity']}{unit}"),
            row["scheme"],
            figure(row["expected"]),
            figure(row["obtained"]),
            figure(row["error"], 2),
            figure(row["tolerance"], 2),
            "good" if row["holds"] else "[bold red]falls short[/]",
        )
    return table
