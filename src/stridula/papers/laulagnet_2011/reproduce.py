"""Reproduction of the whole paper: runs, figures, records and claims in one folder."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ...disk import write
from ...plot import overview, spectrogram
from ...plot import save as save_figure
from ...records.files import save as save_record
from ...version import __version__
from .claims import CLAIMS
from .figures import FIGURES, PRESSURE_FIGURE, pressure_figure
from .runs import CASES, Runs


def reproduce(folder: str | Path, report: Callable[[str], None] = lambda name: None) -> list[dict[str, Any]]:
    """Run every case of the paper and write records, sounds, figures, `claims.json` and `claims.md` into a folder.

    Parameters
    ----------
    folder : str or Path
        Folder to write to, created if necessary.
    report : callable, optional
        Called with the name of each item before it is made.

    Returns
    -------
    list of dict
        The rows of `claims.json`.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    target = Path(folder)
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise type(error)(f"folder must be writable, got {str(folder)!r}") from error
    runs = Runs(report=report)
    for case in CASES:
        save_record(runs.record(case), target / f"{case}.nc")
        save_figure(overview(runs.record(case)), target / f"{case}.png")
        heard = runs.sound(case, target / f"{case}.wav").isel(listener=0)
        save_figure(spectrogram(heard, runs.record(case)), target / f"{case}-sound.png")
    for figure in FIGURES:
        report(figure.file_name)
        save_figure(figure.draw(runs), target / figure.file_name)
    report(PRESSURE_FIGURE)
    save_figure(pressure_figure(runs), target / PRESSURE_FIGURE)
    rows = [claim.check(runs) for claim in CLAIMS]
    write(target / "claims.json", (json.dumps(rows, indent=2, ensure_ascii=False) + "\n").encode())
    write(target / "claims.md", claims_table(rows).encode())
    return rows


def closing_line(rows: Sequence[dict[str, Any]]) -> str:
    """Return the number of claims that hold in one line."""
    missed = [f"{row['section']} {row['claim']}" for row in rows if not row["holds"]]
    line = f"{len(rows) - len(missed)} of {len(rows)} claims of the paper hold"
    return f"{line}; not: {'; '.join(missed)}" if missed else line


def measured(row: dict[str, Any]) -> str:
    """Return the value of a row with its unit and, for a median over starts, its interval."""
    if row["measured"] is None:
        return "none"
    unit = "" if row["units"] == "1" else f" {row['units']}"
    words = f"{row['measured']:.4g}{unit}"
    return "{} ({:.4g} to {:.4g})".format(words, *row["interval"]) if row.get("interval") else words


def claims_table(rows: Sequence[dict[str, Any]]) -> str:
    """Return the claims as a Markdown page."""
    lines = [
        "# Laulagnet 2011, claim by claim",
        "",
        f"stridula {__version__}. {closing_line(rows)}.",
        "",
        "| section | claim | printed | measured | holds when | holds | basis |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        claim = row["claim"].replace("|", "\\|")
        printed = row["printed"].replace("|", "\\|")
        holds = "yes" if row["holds"] else "**no**"
        cells = [row["section"], claim, printed, measured(row), row["tolerance"], holds, row["basis"]]
        lines.append(f"| {' | '.join(cells)} |")
    details = [f"- {row['section']} {row['claim']}: {row['detail']}" for row in rows if "detail" in row]
    return "\n".join([*lines, "", *details, ""])
