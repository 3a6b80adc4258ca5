"""Run and draw the cases, and write the table of expected and obtained values."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ..checks import ArgumentError
from ..disk import write
from ..plot import save as save_figure
from ..version import __version__
from .case import Case, Outcome, Row, Sketch, table_row
from .cases import CASES


def verify(
    folder: str | Path,
    only: str | None = None,
    report: Callable[[str], None] = lambda line: None,
    cases: Sequence[Case] = CASES,
) -> list[dict[str, Any]]:
    """Run the cases and write `verification.json`, `verification.md` and a figure of each into a folder.

    Parameters
    ----------
    folder : str or Path
        Folder to write to, created if necessary.
    only : str, optional
        Run only the cases with this word in their name or title.
    report : callable, optional
        Called with a line about each case before it runs.
    cases : sequence of Case, optional
        Cases to choose from.

    Returns
    -------
    list of dict
        The rows of `verification.json`.

    Raises
    ------
    ValueError
        If no case has the word.
    OSError
        If the folder cannot be written.
    """
    chosen = [case for case in cases if only is None or only.lower() in f"{case.name} {case.title}".lower()]
    if not chosen:
        raise ArgumentError(
            "only", f"be part of the name or title of a case: {', '.join(case.name for case in cases)}", only
        )
    target = Path(folder)
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise type(error)(f"folder must be writable, got {str(folder)!r}") from error
    began = time.perf_counter()
    outcomes = []
    for number, case in enumerate(chosen, start=1):
        report(f"{number} of {len(chosen)}: {case.title}")
        outcomes.append((case, _run(case, target)))
    rows = [table_row(case, row) for case, outcome in outcomes for row in outcome.rows]
    write(target / "verification.json", (json.dumps(rows, indent=2, ensure_ascii=False) + "\n").encode())
    write(target / "verification.md", page(outcomes, time.perf_counter() - began).encode())
    return rows


def _run(case: Case, target: Path) -> Outcome:
    try:
        outcome = case.run()
    except Exception as error:
        # A case that raises counts as failed, and the others still run.
        outcome = _broken(f"{type(error).__name__}: {error}")
    # Imported here because Matplotlib is slow, and a word without a case should be reported at once.
    from .figures import draw

    save_figure(draw(case, outcome.sketch), target / f"{case.name}.png")
    return outcome


def _broken(words: str) -> Outcome:
    row = Row(f"runs to its end ({' '.join(words.split())})", 1.0, math.nan, 0.0, "a case must run")
    return Outcome([row], Sketch("", "", []))


def closing_line(rows: Sequence[dict[str, Any]]) -> str:
    """Return the number of rows within their tolerance in one line."""
    missed = [f"{row['case']}: {row['quantity']} {row['scheme']}".rstrip() for row in rows if not row["holds"]]
    line = f"{len(rows) - len(missed)} of {len(rows)} quantities within their tolerance"
    return f"{line}; not: {'; '.join(missed)}" if missed else line


def page(outcomes: Sequence[tuple[Case, Outcome]], seconds: float) -> str:
    """Return the verification as a Markdown page."""
    rows = [table_row(case, row) for case, outcome in outcomes for row in outcome.rows]
    lines = ["# Verification", "", f"stridula {__version__}, {seconds:.0f} s. {closing_line(rows)}.", ""]
    for case, outcome in outcomes:
        lines += [f"## {case.title}", "", f"{case.name}. Source: {case.source}.", ""]
        lines += [f"![{case.title}]({case.name}.png)", ""]
        lines += ["| quantity | scheme | expected | obtained | error | tolerance | within | tolerance from |"]
        lines += ["|---|---|---|---|---|---|---|---|"]
        lines += [_line(table_row(case, row)) for row in outcome.rows]
        lines += ["", *(f"- {note}" for note in outcome.notes), ""]
    return "\n".join(lines)


def _line(row: dict[str, Any]) -> str:
    unit = "" if row["units"] == "1" else f" {row['units']}"
    cells = [
        row["quantity"].replace("|", "\\|"),
        row["scheme"],
        f"{figure(row['expected'])}{unit}",
        f"{figure(row['obtained'])}{unit}",
        figure(row["error"], 2),
        figure(row["tolerance"], 2),
        "yes" if row["holds"] else "**no**",
        row["reason"].replace("|", "\\|"),
    ]
    return f"| {' | '.join(cells)} |"


def figure(value: float | None, digits: int = 7) -> str:
    """Return a number of a row as text."""
    return "none" if value is None else f"{value:.{digits}g}"
