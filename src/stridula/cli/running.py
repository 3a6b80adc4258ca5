"""`stridula run`: check the outputs, simulate under a progress bar, write the outputs and print a summary."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from ..analysis.doubts import doubts
from ..checks import ArgumentError, at_least
from ..disk import check_writable
from ..integration import Diverged, Interrupted
from ..integration.bars import bar, told_of_time
from ..records.files import save
from ..scenarios.load import Scenario, load_scenario
from .card import print_card
from .exits import FAILED, INTERRUPTED, Stopped
from .outputs import check_outputs, check_record
from .warned import doubts_on_the_card


def run_scenario(
    name: str,
    overrides: dict[str, Any],
    out: str | None,
    plot: str | None,
    wav: str | None = None,
    check_step: bool = False,
) -> None:
    """Run a scenario, write the requested files, print a summary and, if asked for, how far half the step moves it.

    Raises
    ------
    ValueError
        If the scenario, an override or an output is invalid; then nothing is written.
    OSError
        If an output cannot be written.
    Stopped
        On Ctrl-C, or if the run failed, after the samples recorded so far are written.
    """
    check_outputs(out, plot)
    check_record(out)
    with doubts_on_the_card():
        scenario = load_scenario(name, overrides)
    if wav is not None:
        _check_wav(wav, name, out, plot, scenario)
    try:
        with bar(scenario.title or name) as show:
            record = scenario.simulate(watchers=[told_of_time(show)])
    except (Interrupted, Diverged) as stop:
        interrupted = isinstance(stop, KeyboardInterrupt)
        kept = _finish(stop.record, scenario, name, out, None if interrupted else plot)
        words = [stop.reason]
        words.append("nothing was kept (no --out)" if out is None else f"the record so far is in {out}")
        if plot is not None:
            words.append(f"it is drawn in {plot}" if plot in kept else f"no figure was drawn{_why(stop)}")
        if wav is not None:
            words.append("no sound was written")
        raise Stopped("; ".join(words), INTERRUPTED if interrupted else FAILED) from None
    _finish(record, scenario, name, out, plot, wav)
    if check_step:
        _print_check(record)


def _print_check(record: xr.Dataset) -> None:
    from ..studies import check_step

    try:
        with bar("at half the step") as show:
            found = check_step(record, watchers=[told_of_time(show)])
    except Interrupted:
        raise Stopped("the check of the step was interrupted", INTERRUPTED) from None
    print(found)


def _check_wav(wav: str, name: str, out: str | None, plot: str | None, scenario: Scenario) -> None:
    from ..acoustics.hearable import check_hearable
    from .sounding import check_ending

    for option, other in (("--out", out), ("--plot", plot)):
        if other is not None and Path(other).resolve() == Path(wav).resolve():
            raise ArgumentError("--wav", f"differ from {option}", wav, got=f"{wav!r} for both")
    if Path(name).is_file() and Path(name).resolve() == Path(wav).resolve():
        raise ArgumentError("--wav", "differ from the scenario", wav, got=f"{wav!r} for both")
    check_writable(wav)
    check_ending(wav)
    check_hearable(scenario.system, scenario.surface_rate)
    if scenario.duration * scenario.sample_rate < 1.5:
        words = f"be at least {at_least(2.0 / scenario.sample_rate)} s, two samples, for its sound"
        raise ArgumentError("duration", words, scenario.duration)


def _finish(
    record: xr.Dataset, scenario: Scenario, name: str, out: str | None, plot: str | None, wav: str | None = None
) -> list[str]:
    """Write the outputs and print the card, which also comes when one of them fails; return the files written."""
    written: list[str] = []
    replaced = {str(Path(path)) for path in (out, plot, wav) if path is not None and Path(path).exists()}
    level, notes = how_to_get_the_level(record, scenario, out), ""
    try:
        if out is not None:
            save(record, out)
            written.append(out)
        if plot is not None and record.sizes["time"] > 1:
            _draw(record, plot)
            written.append(plot)
        if wav is not None:
            from .sounding import write_sound

            sound, loud, notes = write_sound(record, scenario.system, wav)
            level = f"at 1 m, {loud}" if loud else "none: too short, or its sample rate too low, for a level"
            written.append(sound)
    finally:
        files = [f"{path}, replaced" if str(Path(path)) in replaced else path for path in written]
        print_card(record, scenario.title or name, files, doubts(scenario.system), scenario.system, level)
    if notes:
        print(notes)
    return written


def how_to_get_the_level(record: xr.Dataset, scenario: Scenario, out: str | None) -> str:
    """Return how the level of a run is found; nothing of one that failed."""
    from ..acoustics.hearable import WHOLE, why_silent

    if record.attrs["ended"] not in WHOLE:
        return ""
    if reason := why_silent(scenario.system, scenario.surface_rate):
        return f"none: {reason}"
    return f"not computed: {f'`stridula sound {out}` prints it' if out else '--wav FILE.wav computes it'} at 1 m"


def _why(stop: Interrupted | Diverged) -> str:
    samples = stop.record.sizes["time"]
    return f": a figure needs two samples, got {samples}" if samples < 2 else ""


def _draw(record: xr.Dataset, path: str) -> None:
    from ..plot import overview
    from ..plot import save as save_figure

    save_figure(overview(record), path)
