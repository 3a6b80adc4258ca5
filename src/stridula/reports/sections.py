"""Sections of the report of a design: the system, linear theory, and what changes it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from ..analysis.doubts import doubts
from ..analysis.mode_effects import NEITHER, effect_columns, effects_title
from ..analysis.stability import highest_cutoff, sliding_stability
from ..analysis.stability_words import contact_lines, mode_columns, shown_modes, verdict_lines
from ..plot.effects import mode_sensitivity as draw_effects
from ..plot.inline import inline
from ..plot.loci import root_loci as draw_loci
from ..plot.probabilities import mode_probability as draw_probability
from ..plot.systems import system as draw_system
from ..records.packed import PACKED
from ..scenarios import outline
from ..studies.growth_probability import mode_probability
from ..studies.loci import critical_value, critical_values, root_loci
from ..studies.loci_words import lines_of_changes
from ..studies.mode_derivatives import mode_sensitivity
from ..studies.probability_words import probability_columns, probability_lines
from ..studies.smallest_changes import smallest_change
from ..studies.values_by_key import units_of
from .blocks import Facts, Lines, Picture, Section, Table
from .designs import COEFFICIENT, Design
from .fates import fate_columns

# Largest number of rows of a table, and of lines for contacts.
MOST_ROWS, MOST_CONTACTS = 30, 12
# Texts about a scenario, which are no inputs, and largest number of entries of a list that are shown.
TEXTS, MOST_NUMBERS = ("title", "description", "source"), 12
# Lowest friction of the search for a remedy, relative to twice that given, and most changes tried.
LEAST_FRICTION, MOST_CHANGES = 0.05, 600
# Factor of the cutoffs on trial.
HIGHER = 1.5


@dataclass
class Pictures:
    """Figures of a page, each with names of its own.

    Attributes
    ----------
    count : int
        Number of figures so far.
    """

    count: int = field(default=0)

    def of(self, figure: Any, words: str) -> Picture:
        """Return a figure as a part of a report."""
        self.count += 1
        return Picture(inline(figure, f"figure{self.count}", words), words)


def system_section(design: Design, pictures: Pictures) -> Section:
    """Return the drawing of the system, and doubtful values."""
    blocks: list[Any] = []
    about = [design.scenario.description, str(design.tables.get("source", ""))]
    blocks.append(Lines([words for words in about if words]))
    try:
        blocks.append(pictures.of(draw_system(design.system), "The system before its run."))
    except ValueError as error:
        blocks.append(Lines([f"Not drawn: {error}."]))
    blocks += [Lines([f"Doubtful: {words}" for words in doubts(design.system)])]
    return Section("System", blocks)


def inputs_section(design: Design, pictures: Pictures) -> Section:
    """Return the inputs with their units."""
    tables = {name: value for name, value in design.si.items() if name not in TEXTS}
    return Section("Inputs", [Facts(dict(_inputs(design, tables, ())))])


def _inputs(design: Design, value: Any, path: outline.Path) -> Iterator[tuple[str, str]]:
    """Yield the key and the words of each number, text or list of numbers below a place in the tables."""
    if isinstance(value, dict):
        for name, one in value.items():
            yield from _inputs(design, one, (*path, name))
    elif isinstance(value, list) and any(isinstance(one, (dict, list)) for one in value):
        for number, one in enumerate(value):
            yield from _inputs(design, one, (*path, number))
    else:
        listed = value if isinstance(value, list) else [value]
        places = [(*path, number) for number in range(len(listed))] if isinstance(value, list) else [path]
        words = [_input_words(design, one, place) for one, place in zip(listed, places, strict=True)]
        more = f" and {len(words) - MOST_NUMBERS} more" if len(words) > MOST_NUMBERS else ""
        yield ".".join(map(str, path)), ", ".join(words[:MOST_NUMBERS]) + more


def _input_words(design: Design, value: Any, path: outline.Path) -> str:
    """Return an input with its unit, as it is written or in SI."""
    if isinstance(value, np.ndarray):
        return f"an array of {' x '.join(map(str, value.shape))}"
    written = outline.look_up(design.tables, path)
    if isinstance(value, str):
        return "an array" if PACKED.fullmatch(value) else value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(written, str):
        return written
    units = units_of(path, design.si)
    return f"{value:.6g} {'' if units == '1' else units}".rstrip()


def modes_section(design: Design, pictures: Pictures) -> Section:
    """Return equilibrium and modes of sliding by linear theory."""
    title = "Modes of sliding"
    try:
        modes = design.modes
    except ValueError as error:
        return _without(title, error, "linear theory")
    verdict = verdict_lines(modes, design.options.status is not None)
    lines = contact_lines(modes)
    if len(lines) > MOST_CONTACTS:
        lines = [*lines[:MOST_CONTACTS], f"and {len(lines) - MOST_CONTACTS} other contacts"]
    notes = [f"Note: {words}." for words in str(modes.attrs["notes"]).split("; ") if words]
    blocks: list[Any] = [Lines(verdict)]
    if modes.sizes["mode"]:
        shown = shown_modes(modes)
        columns, strong = mode_columns(modes), modes["unstable"].values[shown].tolist()
        if design.options.fates and any(strong):
            fates, words = fate_columns(design, modes, shown)
            columns, notes = columns | fates, [*notes, *filter(None, [words])]
        blocks.append(Table(_first_rows(columns), strong=strong[:MOST_ROWS]))
    answers = {"linear theory": verdict[0].removeprefix("Equilibrium: ").rstrip(".")}
    return Section(title, [*blocks, Lines([*lines, *notes])], answers | _fastest(modes))


def _fastest(modes: xr.Dataset) -> dict[str, str]:
    if not bool(modes["unstable"].any()):
        return {}
    one = modes.isel(mode=int(modes["growth_rate"].values.argmax()))
    return {"fastest mode": f"{float(one['frequency']):.5g} Hz, growth {float(one['growth_rate']):.5g} 1/s"}


def _first_rows(columns: dict[str, list[str]]) -> dict[str, list[str]]:
    return {head: cells[:MOST_ROWS] for head, cells in columns.items()}


def loci_section(design: Design, pictures: Pictures) -> Section:
    """Return frequency and growth of the modes over friction, or another parameter."""
    title = "Modes over friction" if design.options.values is None else f"Modes over {design.options.key}"
    over = design.over()
    if over is None:
        return Section(title, [Lines(["No contact has a coefficient of friction to vary."])])
    key, values, units, system = over
    try:
        loci = root_loci(system, key, values, units=units, **design.given)
        critical = critical_values(
            loci, lambda low, high: critical_value(system, key, low, high, units=units, **design.given)
        )
    except ValueError as error:
        return _without(title, error, "linear theory")
    changes = lines_of_changes(loci, critical, units)
    limit = highest_cutoff(design.system)
    words = f"Modes over {key}; those that grow are thick. Those that decay within a period"
    words += f" or above the highest cutoff, {limit:.5g} Hz," if np.isfinite(limit) else ""
    picture = pictures.of(draw_loci(_below(limit, loci), critical), f"{words} are left out.")
    blocks: list[Any] = [Lines(changes), picture]
    if bool(loci["unstable"].any()):
        blocks.append(_over_table(loci, key))
    return Section(title, blocks, {f"over {key}": changes[0]})


def _below(limit: float, loci: xr.Dataset) -> xr.Dataset:
    """Return root loci without modes that decay above a frequency [Hz]."""
    seen = loci["unstable"] | (loci["frequency"] <= limit)
    return loci.assign({name: loci[name].where(seen) for name in ("frequency", "growth_rate")})


def _over_table(loci: xr.Dataset, key: str) -> Table:
    """Return the number of growing modes, and the fastest one, at each value of the parameter."""
    grown = np.where(loci["unstable"].values, loci["growth_rate"].values, -np.inf)
    rows, fastest = np.arange(len(grown)), grown.argmax(axis=1)
    grows = np.isfinite(grown[rows, fastest])
    units = loci[key].attrs.get("units", "")
    columns = {
        f"{key} [{units}]" if units else key: [f"{one:.4g}" for one in loci[key].values],
        "equilibrium": [str(one) for one in loci["equilibrium"].values],
        "growing modes": [str(int(one)) for one in loci["unstable_modes"].values],
    }
    for head, name in (("frequency [Hz]", "frequency"), ("growth rate [1/s]", "growth_rate")):
        numbers = loci[name].values[rows, fastest]
        columns[head] = [f"{one:.5g}" if grown else "" for one, grown in zip(numbers, grows, strict=True)]
    return Table(columns, "The mode that grows fastest at each value", grows.tolist())


def effects_section(design: Design, pictures: Pictures) -> Section:
    """Return what changes the growth of the fastest mode most."""
    title = "What helps most"
    if not design.options.effects:
        return Section(title, [Lines(["Not asked for."])])
    try:
        found = mode_sensitivity(design.source, overrides=design.options.overrides, **design.given)
    except ValueError as error:
        return _without(title, error, "effects of parameters")
    columns = effect_columns(found)
    blocks: list[Any] = [Table(_first_rows(columns), effects_title(found))]
    if found["growth_rate_change"].notnull().any():
        blocks.append(pictures.of(draw_effects(found), "Changes of the growth rate and of the frequency."))
    left_out = [f"Left out: {words}" for words in str(found.attrs["left_out"]).split("; ") if words]
    best = next((k for k, word in enumerate(columns["for less growth"]) if word != NEITHER), None)
    answers = {}
    if best is not None and bool(found["unstable"].any()):
        answers[title.lower()] = f"{columns['for less growth'][best]} {columns['parameter'][best]}"
    return Section(title, [*blocks, Lines(left_out)], answers)


def remedy_section(design: Design, pictures: Pictures) -> Section:
    """Return the smallest change with which no mode grows, up to the friction given where that is one number."""
    title, asked = "What silences it", design.options
    if asked.remedies is None:
        return Section(title, [Lines(["No parameter was named that may change."])])
    over = design.over()
    conditions = {}
    if over is not None and over[0] == COEFFICIENT and COEFFICIENT not in asked.remedies:
        conditions = {COEFFICIENT: (over[1][-1] * LEAST_FRICTION, 0.5 * over[1][-1])}
    found = smallest_change(
        design.source, asked.remedies, conditions, overrides=asked.overrides, velocity=asked.velocity, most=MOST_CHANGES
    )
    names = ("given", "changed", "low", "high")
    columns = {"parameter": [str(one) for one in found["parameter"].values]}
    columns |= {name: [f"{one:.5g}" for one in found[name].values] for name in names}
    columns["units"] = [str(one) for one in found["units"].values]
    verdict = str(found.attrs["verdict"])
    low, high = conditions.get(COEFFICIENT, (0.0, 0.0))
    where = f"over {COEFFICIENT} from {low:.4g} to {high:.4g}" if conditions else "at the friction given"
    return Section(title, [Lines([f"{verdict}.", f"Searched {where}."]), Table(columns)], {title.lower(): verdict})


def probability_section(design: Design, pictures: Pictures) -> Section:
    """Return the probability of growth when parameters scatter."""
    title, asked = "Probability of growth", design.options
    if asked.uncertain is None:
        return Section(title, [Lines(["No parameter is uncertain."])])
    if not design.is_written:
        return Section(title, [Lines(["Only for scenarios, whose parameters have keys."])])
    found = mode_probability(
        design.source,
        asked.uncertain,
        samples=asked.samples,
        overrides=asked.overrides,
        velocity=asked.velocity,
    )
    lines = probability_lines(found)
    picture = pictures.of(draw_probability(found), "Probability of growth in each band of frequency.")
    table = Table(probability_columns(found), f"with {', '.join(asked.uncertain)} uncertain")
    return Section(title, [table, Lines(lines), picture], {title.lower(): lines[0].removesuffix(".")})


def cutoff_section(design: Design, pictures: Pictures) -> Section:
    """Return the modes that grow with higher cutoffs."""
    title, cutoffs = "Check of the cutoffs", design.numbers(("cutoff",))
    if not design.options.check:
        return Section(title, [Lines(["Not asked for."])])
    if not cutoffs:
        return Section(title, [Lines(["No body has a cutoff."])])
    try:
        both = {
            "as given": design.modes,
            f"cutoffs {100.0 * (HIGHER - 1.0):.0f} % higher": sliding_stability(
                design.scaled(cutoffs, HIGHER), **design.given
            ),
        }
    except ValueError as error:
        return _without(title, error, "higher cutoffs")
    facts = {}
    for name, modes in both.items():
        facts[name] = "; ".join([verdict_lines(modes, design.options.status is not None)[0], *_fastest(modes).values()])
    limit = f"Highest cutoff: {highest_cutoff(design.system):.5g} Hz."
    return Section(title, [Lines([limit]), Facts(facts)])


def _without(title: str, error: ValueError, what: str) -> Section:
    return Section(title, [Lines([f"Without {what}: {error}."])])
