"""`stridula calibrate` and `stridula sensitivity`: searches and statistics over parameters, printed as tables."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..checks import ArgumentError
from ..disk import check_ending, check_writable, write
from ..records.files import save as save_file
from ..scenarios.keys import overridden
from ..scenarios.load import with_matrices
from ..scenarios.read import read_tables
from ..scenarios.show import text_of
from ..studies.calibration import CalibrationProgress, Target, calibrate
from ..studies.points import Range
from ..studies.sobol import FEWEST, sensitivity
from .consoles import wide_console
from .exits import INTERRUPTED, Stopped
from .outputs import check_record
from .sweeping import points_done


def calibrate_scenario(
    name: str,
    ranges: dict[str, Range],
    targets: list[str],
    overrides: dict[str, Any],
    out: str | None,
    search: str | None = None,
    **options: Any,
) -> bool:
    """Search for parameters that meet targets, print and write them, and return whether all targets are met."""
    if search is not None:
        check_ending("--search", search, (".nc",), "search")
    if out is not None:
        check_ending("--out", out, (".toml",), "scenario")
        check_writable(out)
    aimed = targets_of(targets)
    best: dict[str, Any] = {}

    def follow(progress: CalibrationProgress) -> None:
        best.update(progress.best)
        print(
            f"generation {progress.generation} of {progress.generations}: miss {progress.miss:.4g}",
            file=sys.stderr,
            flush=True,
        )

    try:
        found = calibrate(name, ranges, aimed, overrides=overrides, out=search, watchers=[follow], **options)
    except KeyboardInterrupt:
        words = ", ".join(f"{key}={value}" for key, value in best.items()) or "nothing yet"
        raise Stopped(f"interrupted; best so far: {words}", INTERRUPTED) from None
    _print_calibration(found, ranges, aimed)
    if out is not None:
        values = {key: _written(float(found[key]), one.unit) for key, one in ranges.items()}
        if options.get("duration") is not None:
            values["simulation.duration"] = options["duration"]
        # Runs in one batch share a step.
        values["simulation.step"] = float(found["step"])
        values["simulation.sample_rate"] = 1.0 / float(found["sample_interval"])
        # The keys were checked by `calibrate`.
        tables, _ = overridden(read_tables(name), overrides | values)
        write(out, text_of(with_matrices(tables, tables)).encode())
    return bool(found["met"].all())


def targets_of(texts: list[str]) -> dict[str, Target | str]:
    """Return the targets given by ``NAME=LOW:HIGH`` (either end optional), ``NAME=LOW:HIGH:SCALE`` or ``NAME=WORD``.

    Raises
    ------
    ValueError
        If a text has another form, or a measure appears twice.
    """
    found: dict[str, Target | str] = {}
    for text in texts:
        name, equals, wanted = (part.strip() for part in text.partition("="))
        pieces = [piece.strip() for piece in wanted.split(":")]
        if not equals or not name or not wanted or len(pieces) > 3:
            raise ArgumentError("--target", "be NAME=LOW:HIGH, NAME=LOW:HIGH:SCALE or NAME=WORD", text)
        if name in found:
            raise ArgumentError("--target", "name each measure once", name, got=f"{name!r} twice")
        found[name] = wanted if len(pieces) == 1 else _bounds(text, pieces)
    return found


def _bounds(text: str, pieces: list[str]) -> Target:
    """Return the target with two bounds and a scale."""
    try:
        low, high, scale = (float(piece) if piece else None for piece in [*pieces, ""][:3])
    except ValueError:
        raise ArgumentError("--target", "have numbers for LOW, HIGH and SCALE, in SI", text) from None
    try:
        return Target(-math.inf if low is None else low, math.inf if high is None else high, scale)
    except ArgumentError as error:
        raise error.inside(f"--target {text}") from None


def _written(number: float, unit: str) -> float | str:
    return f"{number!r} {unit}" if unit else number


def _print_calibration(found: xr.Dataset, ranges: dict[str, Range], targets: dict[str, Target | str]) -> None:
    console = wide_console()
    table = _table("key", "value", "searched")
    for key, one in ranges.items():
        searched = f"{one.number(0.0):.6g} to {one.number(1.0):.6g} {one.unit}".strip()
        table.add_row(escape(key), f"{float(found[key]):.6g} {one.unit}".strip(), searched)
    console.print(table)
    table = _table("measure", "found", "wanted", "met")
    for (name, target), met in zip(targets.items(), found["met"].values, strict=True):
        value = found[name].item()
        shown = value if isinstance(value, str) else f"{value:.5g}"
        wanted = target if isinstance(target, str) else f"{target.low:g} to {target.high:g}"
        table.add_row(escape(name), shown, wanted, "yes" if met else "[bold]no[/]")
    console.print(table)


def sensitivity_of_scenario(
    name: str, ranges: dict[str, Range], measures: list[str], overrides: dict[str, Any], out: str | None, **options: Any
) -> str:
    """Print Sobol indices and probabilities of the regimes, write them, and return the closing lines."""
    if out is not None:
        check_record(out)
        check_writable(out)
    title = str(read_tables(name).get("title", name))
    with points_done(title) as watch:
        found = sensitivity(name, ranges, measures or ["regime"], overrides=overrides, watchers=[watch], **options)
    console = wide_console()
    if "probability" in found and np.isfinite(found["probability"].values).all():
        console.print("Probability of each regime")
        console.print(_probabilities(found))
    indices = _indices(found)
    if indices.row_count:
        console.print("Share of the variance caused by each parameter alone (with others), with intervals")
        console.print(indices)
    else:
        console.print(_why_no_indices(found))
    if out is not None:
        save_file(found, out)
    runs, failed = int(found["runs"]), int(found["failed"])
    counts = f"{runs} runs: {runs - failed} done, {failed} failed" + (f"; written to {out}" if out else "")
    return f"{found.attrs['failure']}\n{counts}" if failed else counts


def _probabilities(found: xr.Dataset) -> Table:
    level = f"{100.0 * found.attrs['confidence']:g} % interval"
    table = _table("regime")
    for head in ("probability", level):
        table.add_column(head, justify="right")
    for word in found["regime"].values:
        one = found.sel(regime=word)
        low, high = one["probability_interval"].values
        table.add_row(str(word), f"{float(one['probability']):.3f}", f"{low:.3f} to {high:.3f}")
    return table


def _indices(found: xr.Dataset) -> Table:
    table = _table("output")
    for key in found["parameter"].values:
        table.add_column(escape(str(key)), overflow="fold", justify="right")
    for name in found["output"].values:
        one = found.sel(output=name)
        if not np.isfinite(one["first_order"].values).any():
            continue
        cells = []
        for key in found["parameter"].values:
            at = one.sel(parameter=key)
            (a, b), (c, d) = at["first_order_interval"].values, at["total_order_interval"].values
            cells.append(
                f"{float(at['first_order']):.2f} [{a:.2f}, {b:.2f}] "
                f"({float(at['total_order']):.2f} [{c:.2f}, {d:.2f}])".replace("[", "\\[")
            )
        table.add_row(escape(str(name)), *cells)
    return table


def _why_no_indices(found: xr.Dataset) -> str:
    """Return why no output has indices."""
    used = int(found["used"].max()) if found.sizes["output"] else 0
    if used < FEWEST:
        return f"No shares of the variance: they need {FEWEST} samples in which all runs give numbers, got {used}."
    return "No shares of the variance: no quantity varies."


def _table(*heads: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for head in heads:
        table.add_column(head, overflow="fold")
    return table
