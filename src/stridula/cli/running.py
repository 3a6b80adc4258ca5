"""`stridula run`: check the outputs, simulate under a progress bar, write the outputs and print a summary."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr

from ..checks import ArgumentError, at_least
from ..disk import check_writable
from ..integration import Diverged, Interrupted
from ..integration.watchers import Progress, Watcher
from ..records.files import save
from ..scenarios.load import Scenario, load_scenario
from .bars import bar
from .card import print_card
from .doubts import doubts
from .exits import FAILED, INTERRUPTED, Stopped
from .outputs import check_outputs

# Extensions that are refused for a record.
OTHER_FORMATS = (".csv", ".mat", ".png", ".pdf", ".svg", ".wav", ".toml")


def run_scenario(
    name: str, overrides: dict[str, Any], out: str | None, plot: str | None, wav: str | None = None
) -> None:
    """Run a scenario, write the requested files, and print a summary.

    Raises
    ------
    ValueError
        If the scenario, an override or an output is invalid; nothing is written then.
    OSError
        If an output cannot be written.
    Stopped
        On Ctrl-C, or if the run failed, after the samples recorded so far are written.
    """
    check_outputs(out, plot)
    if out is not None and Path(out).suffix.lower() in OTHER_FORMATS:
        raise ArgumentError(
            "--out", "be a NetCDF file, .nc", out, got=f"{out!r}; `stridula export` writes tables, --plot figures"
        )
    scenario = load_scenario(name, overrides)
    if wav is not None:
        _check_wav(wav, name, out, plot, scenario)
    try:
        with _progress(scenario.title or name) as watcher:
            record = scenario.simulate(watchers=[watcher])
    except (Interrupted, Diverged) as stop:
        interrupted = isinstance(stop, Interrupted)
        kept = _finish(stop.record, scenario, name, out, None if interrupted else plot)
        words = [stop.reason]
        words.append("nothing was kept (no --out)" if out is None else f"the record so far is in {out}")
        if plot is not None:
            words.append(f"it is drawn in {plot}" if plot in kept else f"no figure was drawn{_why(stop)}")
        if wav is not None:
            words.append("no sound was written")
        raise Stopped("; ".join(words), INTERRUPTED if interrupted else FAILED) from None
    _finish(record, scenario, name, out, plot)
    if wav is not None:
        from .sounding import write_sound

        print(write_sound(record, scenario.system, wav))


def _check_wav(wav: str, name: str, out: str | None, plot: str | None, scenario: Scenario) -> None:
    from ..acoustics.hearable import check_hearable
    from .sounding import check_ending

    for option, other in (("--out", out), ("--plot", plot)):
        if other is not None and Path(other).resolve() == Path(wav).resolve():
            raise ArgumentError("--wav", f"be another file than {option}", wav, got=f"{wav!r} for both")
    if Path(name).is_file() and Path(name).resolve() == Path(wav).resolve():
        raise ArgumentError("--wav", "be another file than the scenario", wav, got=f"{wav!r} for both")
    check_writable(wav)
    check_ending(wav)
    check_hearable(scenario.system, scenario.surface_rate)
    if scenario.duration * scenario.sample_rate < 1.5:
        words = f"be at least {at_least(2.0 / scenario.sample_rate)} s, two samples, to be heard"
        raise ArgumentError("duration", words, scenario.duration)


def _finish(record: xr.Dataset, scenario: Scenario, name: str, out: str | None, plot: str | None) -> list[str]:
    """Write the outputs and print the summary, even if a file cannot be written; return the files written."""
    written: list[str] = []
    try:
        if out is not None:
            save(record, out)
            written.append(out)
        if plot is not None and record.sizes["time"] > 1:
            _draw(record, plot)
            written.append(plot)
    finally:
        print_card(record, scenario.title or name, written, doubts(scenario.system), scenario.system)
    return written


def _why(stop: Interrupted | Diverged) -> str:
    samples = stop.record.sizes["time"]
    return f": a figure needs two samples, got {samples}" if samples < 2 else ""


def _draw(record: xr.Dataset, path: str) -> None:
    from ..plot import overview
    from ..plot import save as save_figure

    save_figure(overview(record), path)


@contextmanager
def _progress(title: str) -> Iterator[Watcher]:
    """Show the simulated time and the speed against real time."""
    with bar(title) as show:

        def watch(report: Progress) -> None:
            speed = report.time / max(report.wall_time, 1e-9)
            words = f"{report.time:.3f} of {report.duration:.3f} s, {speed:.2f} x real time"
            show(report.time, report.duration, words)

        yield watch
