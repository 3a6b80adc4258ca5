"""`stridula calibrate` and `stridula sensitivity`: what runs under many parameters say, in tables."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
import xarray as xr
from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..disk import check_writable, write
from ..records.files import save as save_file
from ..records.provenance import scenario_toml
from ..scenarios.load import load_scenario
from ..studies.calibration import CalibrationProgress, Target, calibrate
from ..studies.points import Range
from ..studies.sobol import sensitivity
from .exits import INTERRUPTED, Stopped

# Of a file or a pipe; a terminal has its own.
WIDTH = 150


def calibrate_scenario(
    name: str,
    ranges: dict[str, Range],
    targets: list[str],
    overrides: dict[str, Any],
    out: str | None,
    **options: Any,
) -> bool:
    """Search parameters that meet targets, print them, write the scenario, and return whether all targets are met."""
    if out is not None:
        check_writable(out)
    aimed = dict(target_of(text) for text in targets)
    best: dict[str, Any] = {}

    def follow(progress: CalibrationProgress) -> None:
        best.update(progress.best)
        print(
            f"generation {progress.generation} of {progress.generations}: miss {progress.miss:.4g}",
            file=sys.stderr,
            flush=True,
        )

    try:
        found = calibrate(name, ranges, aimed, overrides=overrides, watchers=[follow], **options)
    except KeyboardInterrupt:
        words = ", ".join(f"{key}={value}" for key, value in best.items()) or "nothing yet"
        raise Stopped(f"interrupted; best so far: {words}", INTERRUPTED) from None
    _print_calibration(found, ranges, aimed)
    if out is not None:
        values = {key: _written(float(found[key]), one.unit) for key, one in ranges.items()}
        _write_scenario(name, overrides | values, out)
    return bool(found["met"].all())


def target_of(text: str) -> tuple[str, Target | str]:
    """Return what ``NAME=LOW:HIGH``, with an end left out or not, or ``NAME=WORD`` asks for."""
    name, equals, wanted = (part.strip() for part in text.partition("="))
    if not equals or not name or not wanted:
        raise ValueError(f"--target must be NAME=LOW:HIGH or NAME=WORD, got {text!r}")
    low, colon, high = (part.strip() for part in wanted.partition(":"))
    if not colon:
        return name, wanted
    try:
        return name, Target(float(low) if low else -math.inf, float(high) if high else math.inf)
    except ValueError as error:
        raise ValueError(f"--target must have numbers for LOW and HIGH, got {text!r}: {error}") from None


def _written(number: float, unit: str) -> float | str:
    return f"{number!r} {unit}" if unit else number


def _write_scenario(name: str, overrides: dict[str, Any], out: str) -> None:
    scenario = load_scenario(name, overrides)
    simulation: dict[str, Any] = {
        "duration": scenario.duration,
        "scheme": scenario.scheme.name,
        "sample_rate": scenario.sample_rate,
    }
    if scenario.step is not None:
        simulation["step"] = scenario.step
    text = scenario_toml(scenario.system, scenario.probes or (), simulation)
    write(out, text.encode())


def _print_calibration(found: xr.Dataset, ranges: dict[str, Range], targets: dict[str, Target | str]) -> None:
    console = _console()
    table = Table(title="parameters", title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for head in ("key", "value", "searched"):
        table.add_column(head)
    for key, one in ranges.items():
        table.add_row(escape(key), f"{float(found[key]):.6g} {one.unit}".strip(), f"{one.low} to {one.high}")
    console.print(table)
    table = Table(title="targets", title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for head in ("measure", "found", "wanted", "met"):
        table.add_column(head)
    for (name, target), met in zip(targets.items(), found["met"].values, strict=True):
        value = found[name].item()
        shown = value if isinstance(value, str) else f"{value:.5g}"
        wanted = target if isinstance(target, str) else f"{target.low:g} to {target.high:g}"
        table.add_row(escape(name), shown, wanted, "yes" if met else "[bold]no[/]")
    console.print(table)


def sensitivity_of_scenario(
    name: str, ranges: dict[str, Range], measures: list[str], overrides: dict[str, Any], out: str | None, **options: Any
) -> str:
    """Print Sobol indices and probabilities of the regimes, write them, and return the closing line."""
    if out is not None:
        check_writable(out)
    found = sensitivity(name, ranges, measures or ["regime"], overrides=overrides, **options)
    console = _console()
    if "probability" in found:
        console.print(_probabilities(found))
    console.print(_indices(found))
    if out is not None:
        save_file(found, out)
    runs, failed = int(found["runs"]), int(found["failed"])
    return f"{runs} runs: {runs - failed} done, {failed} failed" + (f"; written to {out}" if out else "")


def _probabilities(found: xr.Dataset) -> Table:
    level = f"{100.0 * found.attrs['confidence']:g} % interval"
    table = Table(title="how likely each regime is", title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("regime")
    for head in ("probability", level):
        table.add_column(head, justify="right")
    for word in found["regime"].values:
        one = found.sel(regime=word)
        low, high = one["probability_interval"].values
        table.add_row(str(word), f"{float(one['probability']):.3f}", f"{low:.3f} to {high:.3f}")
    return table


def _indices(found: xr.Dataset) -> Table:
    table = Table(
        title="share of the variance: alone (in all), with intervals", title_justify="left", box=box.SIMPLE_HEAD
    )
    table.add_column("output", overflow="fold")
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


def _console() -> Console:
    console = Console()
    return console if console.is_terminal else Console(width=WIDTH)
