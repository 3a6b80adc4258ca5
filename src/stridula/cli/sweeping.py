"""`stridula sweep`: check the arguments, compute under a progress bar, and print a summary of the points."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import xarray as xr

from ..checks import ArgumentError
from ..integration.bars import bar
from ..scenarios.read import read_tables
from ..studies.computed import SweepProgress, Watcher, told_of_points
from ..studies.machines import client_of
from ..studies.measures import asked_for
from ..studies.points import Grid
from ..studies.sweeps import sweep
from ..studies.swept import failures, usual_failure
from .exits import FAILED, INTERRUPTED, Stopped
from .outputs import check_outputs, check_record
from .points import Points
from .regimes import print_agreement


def sweep_scenario(
    name: str,
    points: Points,
    measures: Sequence[str],
    overrides: dict[str, Any],
    *,
    duration: str | None,
    out: str,
    plot: str | None,
    workers: int | None,
    scheduler: str | None,
) -> str:
    """Sweep a scenario, write the results, and return the closing lines.

    Raises
    ------
    ValueError
        If an argument is invalid; then nothing is written.
    OSError
        If an output cannot be written; finished parts are kept.
    Stopped
        On Ctrl-C, or if other machines fail; finished parts are kept.
    """
    check_outputs(out, plot)
    check_record(out)
    asked = asked_for(list(measures))
    if plot is not None:
        _check_plot(points, [measure.name for measure in asked.measures])
    title = str(read_tables(name).get("title", name))
    with computing(title, out, scheduler) as machinery:
        found = sweep(
            name,
            points,
            list(measures),
            overrides=overrides,
            duration=duration,
            out=out,
            workers=workers,
            **machinery,
        )
    if plot is not None:
        _draw(found, plot)
    if "regime" in found:
        print_agreement(found)
    return closing(found, out)


def _check_plot(points: Points, measures: Sequence[str]) -> None:
    check_two_keys(points)
    if "regime" not in measures:
        raise ArgumentError("--plot", "be used with --measure regime, which it shows", got=", ".join(measures))


def check_two_keys(points: Points) -> None:
    """Raise ValueError unless points can be drawn as a map."""
    if not isinstance(points, Grid) or len(points.values) != 2 or min(map(len, points.values.values())) < 2:
        raise ArgumentError(
            "--plot", "be used with a grid of two keys of at least 2 values each, given by --vary twice"
        )


def _draw(found: xr.Dataset, path: str) -> None:
    from ..plot import regime_map, save

    save(regime_map(found), path)


def closing(found: xr.Dataset, out: str) -> str:
    """Return the closing lines of a study: the number of points done, and the most frequent failure."""
    messages = failures(found)
    points, failed = found["message"].size, len(messages)
    if not failed:
        return f"{points} points: {points} done; written to {out}"
    counts = f"{points} points: {points - failed} done, {failed} failed (messages in 'message' of {out})"
    return f"{usual_failure(messages)}\n{counts}"


@contextmanager
def computing(title: str, out: str, scheduler: str | None) -> Iterator[dict[str, Any]]:
    """Yield the arguments ``client`` and ``watchers`` of a study, and report how to resume if it is interrupted.

    Raises
    ------
    Stopped
        On Ctrl-C, or if other machines fail; finished parts are kept.
    """
    reached = SweepProgress(0, 0, 0.0)

    def follow(progress: SweepProgress) -> None:
        nonlocal reached
        reached = progress

    try:
        with _client(scheduler) as client, points_done(title) as watch:
            yield {"client": client, "watchers": [follow, watch]}
    except KeyboardInterrupt:
        if not reached.done:
            raise Stopped(
                "interrupted before any point was saved; the same command starts again", INTERRUPTED
            ) from None
        words = f"interrupted; {reached.done} of {reached.points} points are saved in {out}.parts"
        raise Stopped(f"{words}; the same command resumes from there", INTERRUPTED) from None
    except RuntimeError as error:
        # Raised by other machines; failed points raise nothing.
        raise Stopped(f"{error} in {out}.parts", FAILED) from None


@contextmanager
def _client(address: str | None) -> Iterator[Any]:
    if address is None:
        yield None
        return
    # Its messages about lost machines are replaced by one line of our own.
    logging.disable(logging.CRITICAL)
    try:
        with client_of(address) as client:
            yield client
    finally:
        logging.disable(logging.NOTSET)


@contextmanager
def points_done(title: str) -> Iterator[Watcher]:
    """Show the number of points done."""
    with bar(title) as show:
        yield told_of_points(show)
