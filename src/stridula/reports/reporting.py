"""Reports: will it squeal, how surely, and what helps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import xarray as xr

from ..arrays import Array
from ..bars.line_bars import Show
from ..checks import ArgumentError, by_key, count, instance
from ..disk import check_ending, check_writable, write
from ..integration.bars import bar_if, told_of_time
from ..linear.given import Status, Velocity
from ..studies.loci import rising
from ..system import System
from .blocks import Section
from .designs import FRICTION, Design, Options, design_of
from .pages import page_of
from .runs import run_of, run_section, sound_of, sound_section, step_section
from .sections import (
    Pictures,
    cutoff_section,
    effects_section,
    inputs_section,
    loci_section,
    modes_section,
    probability_section,
    remedy_section,
    system_section,
)

ENDINGS = (".html", ".htm")
# Sections that need no run: those shown before it and its sound, and those shown after.
BEFORE = (system_section, modes_section, loci_section)
AFTER = (effects_section, remedy_section, probability_section, cutoff_section)


@dataclass(frozen=True)
class Report:
    """A report as a page of HTML that needs no other file.

    Attributes
    ----------
    titles : tuple of str
        Titles of the designs.
    html : str
        The page.
    """

    titles: tuple[str, ...]
    html: str = field(repr=False)

    def save(self, path: str | Path) -> None:
        """Write the page, whole or not at all.

        Raises
        ------
        ValueError
            If the file has the ending of another format.
        OSError
            If it cannot be written.
        """
        check_page("path", path)
        write(path, self.html.encode())


def report(
    source: str | Path | xr.Dataset | System,
    other: str | Path | xr.Dataset | System | None = None,
    *,
    titles: Sequence[str] | None = None,
    overrides: Mapping[str, Any] | None = None,
    duration: float | str | None = None,
    key: str = FRICTION,
    values: Sequence[float] | Array | None = None,
    units: str = "",
    run: bool = True,
    sound: bool = True,
    effects: bool = True,
    check: bool = True,
    fates: bool = False,
    remedies: Mapping[str, tuple[float, float]] | None = None,
    uncertain: Mapping[str, Any] | None = None,
    samples: int = 1000,
    status: Status | None = None,
    velocity: Velocity | None = None,
    progress: bool = False,
) -> Report:
    """Return a report on a system, or on two designs side by side, as a page of HTML.

    It has the system drawn, its inputs, the modes of sliding and their loci over friction, the run with its regime,
    pitch and growth, its sound with third octaves, the verdict by level and band of SAE J2521 and a player, effects of
    parameters, probabilities of growth, and checks of step and cutoffs. Sections that do not apply give the reason.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or System
        A scenario, as for `load_scenario`; a record, whose run is shown and not computed again; or a system.
    other : optional
        A second design. Words that differ are marked.
    titles : sequence of str, optional
        A title for each design, in place of that of its scenario.
    overrides : mapping, optional
        Values to set by key, in both.
    duration : float or str, optional
        Time to simulate [s]; by default that of the scenario, 1 s for a system.
    key : str, optional
        Parameter of the root loci, by default all coefficients of friction in proportion, from none to twice those
        given.
    values : sequence of float, optional
        Its values, rising, in `units`; needed with a `key`.
    units : str, optional
        Unit of the values, SI if left out.
    run, sound, effects, check : bool, optional
        Whether the report has a run, its sound, effects of parameters, and the checks of step and cutoffs.
    fates : bool, optional
        Whether a run follows each growing mode to its limit cycle, as in `squeal_survey`: the table of modes then has
        its regime, its pitch and its level. Seconds to minutes for each mode.
    remedies : mapping, optional
        Lowest and highest value, by key, of parameters that may change, as for `smallest_change`, so that no mode grows
        at any friction up to that given; by default none.
    uncertain : mapping, optional
        Distribution of each uncertain parameter by key, as for `mode_probability`; by default none.
    samples : int, optional
        Number of random points.
    status, velocity : optional
        As for `sliding_stability`.
    progress : bool, optional
        Whether a bar on standard error shows the progress.

    Returns
    -------
    Report
        The page; ``save`` writes it.

    Raises
    ------
    ScenarioError
        If a scenario or an override cannot be used.
    ValueError
        If an argument is out of its range.
    OSError
        If a file cannot be read.
    ImportError
        If jinja2 or matplotlib is not installed.

    Examples
    --------
    >>> import stridula as st
    >>> page = st.report("belt", duration=1.0, check=False)
    >>> page.titles
    ('Stick-slip on a belt',)
    """
    words = {"run": run, "sound": sound, "effects": effects, "check": check, "fates": fates, "progress": progress}
    for name, word in words.items():
        instance(name, word, bool)
    instance("key", key, str)
    instance("units", units, str)
    options = Options(
        overrides=by_key("overrides", overrides),
        duration=duration,
        key=key,
        values=None if values is None else rising(values),
        units=units,
        run=run,
        sound=sound,
        effects=effects,
        check=check,
        fates=fates,
        remedies=None if remedies is None else by_key("remedies", remedies),
        uncertain=None if uncertain is None else by_key("uncertain", uncertain),
        samples=count("samples", samples),
        status=status,
        velocity=velocity,
    )
    designs = [design_of(one, options) for one in (source, other) if one is not None]
    named = _titles(designs) if titles is None else _given(titles, len(designs))
    with bar_if(progress, "report") as show:
        pictures = Pictures()
        sections = [sections_of(design, pictures, show) for design in designs]
        return Report(named, page_of(named, sections))


def sections_of(design: Design, pictures: Pictures, show: Show) -> list[Section]:
    """Return the sections of a design.

    Parameters
    ----------
    design : Design
        The design.
    pictures : Pictures
        Figures of the page.
    show : callable
        Shows how much is done.
    """
    makes = (*BEFORE, *AFTER)
    total, watcher, found = float(len(makes) + 3), told_of_time(show), list[Section]()
    # Wrong keys of options are refused before the run.
    for make in makes:
        show(float(len(found)), total, f"{design.title}: {_words(make)}")
        found.append(make(design, pictures))
    record = run_of(design, watcher)
    show(total - 2.0, total, f"{design.title}: sound")
    heard = sound_of(design, record)
    of_run = [run_section(design, record, heard, pictures), sound_section(design, heard, pictures)]
    last = [step_section(design, record, watcher), inputs_section(design, pictures)]
    return [*found[: len(BEFORE)], *of_run, *found[len(BEFORE) :], *last]


def _words(make: Any) -> str:
    return str(make.__name__).removesuffix("_section")


def _given(titles: Sequence[str], number: int) -> tuple[str, ...]:
    """Return given titles, one for each design."""
    if isinstance(titles, str) or len(titles) != number or not all(isinstance(one, str) and one for one in titles):
        raise ArgumentError("titles", f"have a title for each design, {number}", titles)
    return tuple(titles)


def _titles(designs: Sequence[Design]) -> tuple[str, ...]:
    """Return the titles of designs, with the names of their files if they are the same."""
    titles = [design.title for design in designs]
    if len(set(titles)) == len(titles):
        return tuple(titles)
    names = [Path(design.name).stem for design in designs]
    if len(set(names)) < len(names):
        names = [f"{name}, {number}" for number, name in enumerate(names, 1)]
    return tuple(f"{title} ({name})" for title, name in zip(titles, names, strict=True))


def check_page(name: str, path: str | Path) -> None:
    """Raise ValueError or OSError unless a page can be written at a path."""
    check_ending(name, path, ENDINGS, "page of HTML")
    check_writable(path)
