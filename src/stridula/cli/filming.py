"""`stridula animate`: a film of a scenario or of a record in slow motion."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..checks import ArgumentError
from ..disk import check_writable
from ..integration import Diverged, Interrupted
from ..integration.bars import bar
from ..plot.films import animate
from ..plot.moved_bodies import has_surfaces
from ..records.files import is_record, load
from ..scenarios.load import load_scenario
from ..scenarios.quantities import quantity
from .exits import FAILED, INTERRUPTED, Stopped


def film_scenario(
    name: str, out: str, start: str, duration: str, slowdown: float, exaggeration: float | None, view: tuple[str, str]
) -> str:
    """Film a scenario or a record, and return the path of the film.

    Parameters
    ----------
    name : str
        Name of a shipped scenario, a TOML file or a record.
    out : str
        File to write.
    start, duration : str
        Start and length of the time window, in s or with a unit.
    slowdown : float
        Factor of slow motion.
    exaggeration : float or None
        Factor by which the vibration is enlarged.
    view : tuple of str
        Elevation and azimuth of the viewpoint in space, in rad or with a unit.

    Raises
    ------
    ValueError
        If an argument is out of its range, or the record continues another one.
    OSError
        If the file cannot be written.
    """
    check_writable(out)
    is_a_record = Path(name).is_file() and is_record(name)
    if is_a_record:
        _check_beginning(name)
    scenario = load_scenario(name)
    if is_a_record and scenario.system.is_spatial and not has_surfaces(scenario.system):
        words = "be the scenario that was run: this record has no surfaces of bodies"
        raise ArgumentError("name", words, name)
    with _stopped(), bar(scenario.title or name) as show:
        film = animate(
            scenario.system,
            out,
            start=quantity(start, "s", "--from"),
            duration=quantity(duration, "s", "--duration"),
            slowdown=slowdown,
            exaggeration=exaggeration,
            view=(quantity(view[0], "rad", "--elevation"), quantity(view[1], "rad", "--azimuth")),
            scheme=scenario.scheme,
            step=scenario.step,
            sample_rate=scenario.sample_rate,
            title=scenario.title or name,
            progress=lambda frame, frames: show(frame, frames, f"{frame} of {frames} frames"),
        )
    return str(film)


def _check_beginning(name: str) -> None:
    """Raise ValueError for a record that continues another one: the film, run from its start, would differ."""
    run = load(name)
    interval, first = float(run.attrs["sample_interval"]), float(run["time"][0])
    if first > 1.5 * interval:
        raise ArgumentError(
            "name",
            "be a record from its start",
            name,
            got=f"{name!r}, which continues another one from {first - interval:g} s",
        )


@contextmanager
def _stopped() -> Iterator[None]:
    """Turn an unfinished run into a one-line message."""
    try:
        yield
    except Diverged as error:
        raise Stopped(f"{error}; no film was written", FAILED) from None
    except (Interrupted, KeyboardInterrupt):
        raise Stopped("interrupted; no film was written", INTERRUPTED) from None
