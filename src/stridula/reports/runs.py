"""Sections of the report of a design: its run and its sound."""

from __future__ import annotations

import base64
from typing import Any

import xarray as xr

from ..acoustics.hearable import WHOLE, why_silent
from ..acoustics.level_words import level_columns, level_lines, loudest
from ..acoustics.listening import listen
from ..acoustics.radiate import radiate
from ..acoustics.squeals import THRESHOLD, squeal_events, squeal_words
from ..analysis.record_card import facts_of
from ..integration import Diverged
from ..integration.watchers import Watcher
from ..plot.bands import third_octaves
from ..plot.timelines import overview
from ..studies.step_checks import check_step, growth_in_forces
from .blocks import Facts, Lines, Player, Section, Table
from .designs import Design
from .sections import Pictures

RUN, SOUND, STEP = "Run in time", "Sound", "Check of the step"
NOT_ASKED = "Not asked for."
# Facts of the card that answer the questions of a report.
ANSWERS = ("squeals", "pitch", "sound level")


def run_of(design: Design, watcher: Watcher) -> xr.Dataset | None:
    """Return the run of a design, with what was recorded if it failed; None if none is asked for."""
    if not design.options.run:
        return None
    if design.record is not None:
        return design.record
    try:
        return design.scenario.simulate(watchers=[watcher])
    except Diverged as stop:
        return stop.record


def sound_of(design: Design, run: xr.Dataset | None) -> xr.DataArray | str:
    """Return the sound of a run at two ears a metre away, or the reason why there is none."""
    if run is None or not design.options.sound:
        return NOT_ASKED
    if run.attrs["ended"] not in WHOLE:
        return "None: the run failed."
    if reason := why_silent(design.system, design.scenario.surface_rate):
        return f"None: {reason}."
    try:
        return radiate(run, design.system)
    except ValueError as error:
        return f"None: {error}."


def run_section(design: Design, run: xr.Dataset | None, sound: xr.DataArray | str, pictures: Pictures) -> Section:
    """Return the card of a run, the growth of its forces, and a figure over time."""
    if run is None:
        return Section(RUN, [Lines([NOT_ASKED])])
    level = loudest(sound) if isinstance(sound, xr.DataArray) else ""
    facts = facts_of(run, design.system, f"at 1 m, {level}" if level else "")
    growth = growth_in_forces(run)
    facts["growth in time"] = (
        f"{growth:.5g} 1/s of the forces" if growth == growth else "not determined from the forces"
    )
    blocks: list[Any] = [Facts(facts)]
    if run.sizes["time"] > 1:
        blocks.append(pictures.of(overview(run), "The run over time."))
    return Section(RUN, blocks, {name: facts[name] for name in ANSWERS if name in facts})


def sound_section(design: Design, sound: xr.DataArray | str, pictures: Pictures) -> Section:
    """Return levels, third octaves, squeal events and a player of a sound."""
    if isinstance(sound, str):
        return Section(SOUND, [Lines([sound])])
    blocks: list[Any] = []
    answers = {}
    try:
        verdict = squeal_words(squeal_events(sound))
        answers["squeal by SAE J2521"] = verdict
    except ValueError as error:
        verdict = f"not decided: {error}"
    blocks.append(Facts({"squeal by SAE J2521": verdict}))
    blocks.append(Table(level_columns(sound)))
    notes = [*level_lines(sound), *filter(None, str(sound.attrs.get("notes", "")).split("; "))]
    try:
        picture = pictures.of(third_octaves(sound, limit=THRESHOLD), "Third-octave levels at the listeners.")
        blocks.append(picture)
    except ValueError as error:
        notes.append(f"Without third octaves: {error}.")
    played = listen(sound)
    player = Player(base64.b64encode(played.wav).decode("ascii"), str(played))
    return Section(SOUND, [*blocks, player, Lines(notes)], answers)


def step_section(design: Design, run: xr.Dataset | None, watcher: Watcher) -> Section:
    """Return how far results move at half the step."""
    if run is None or not design.options.check:
        return Section(STEP, [Lines([NOT_ASKED])])
    try:
        return Section(STEP, [Lines(str(check_step(run, watchers=[watcher])).splitlines())])
    except ValueError as error:
        return Section(STEP, [Lines([f"Not checked: {error}."])])
