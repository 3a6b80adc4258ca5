"""What the page can play: a scenario of a slider on a beam, small enough to march faster than sound."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ..bodies import FiniteElementBeam, ModalBeam
from ..records import Acceleration, Probe
from ..records.provenance import scenario_toml, toml
from ..scenarios.errors import ScenarioError
from ..scenarios.keys import overridden
from ..scenarios.load import Scenario, scenario_of_tables
from ..scenarios.outline import TAGS
from ..scenarios.read import read_tables, tables_of_text
from ..system import System
from .controls import KEYS

PRESETS = ("squeal", "judder", "weak-pressure", "strong-pressure", "stable-sliding", "axial-sliding")
MOST_ELEMENTS, MOST_MODES = 100, 400


@dataclass(frozen=True)
class Playable:
    """A scenario that can be played.

    Attributes
    ----------
    scenario : Scenario
        What is played.
    tables : dict
        The scenario in full and in SI.
    origin : str
        Name of the shipped scenario, or the text, that it was before values were set.
    """

    scenario: Scenario
    tables: dict[str, Any]
    origin: str

    @property
    def system(self) -> System:
        """The system."""
        return self.scenario.system

    @property
    def probes(self) -> tuple[Probe, ...]:
        """What is recorded beside the contact."""
        return (Acceleration(self.system.track.centre, "y"),)

    @cached_property
    def toml(self) -> str:
        """The scenario as TOML, to run with `stridula run`."""
        return toml({"title": self.scenario.title} | self.tables)


def playable(case: str, text: str | None, overrides: Mapping[str, Any]) -> Playable:
    """Return a scenario with values set by key, checked.

    Parameters
    ----------
    case : str
        Name of a shipped scenario, of no meaning where there is a text.
    text : str or None
        A scenario as TOML; it cannot name files.
    overrides : mapping
        Values by key, as in `load_scenario`.

    Raises
    ------
    ScenarioError
        With every problem found.
    """
    if text is None and case not in PRESETS:
        raise ScenarioError([f"case must be one of {', '.join(PRESETS)}, got {case!r}"])
    unknown = [key for key in overrides if key not in KEYS]
    if unknown:
        raise ScenarioError([f"key must be one of the page's, got {unknown[0]!r}"])
    tables = read_tables(case) if text is None else tables_of_text(text, "the scenario")
    # A kind starts a table afresh: what belongs to it comes after it.
    kinds_first = sorted(overrides.items(), key=lambda item: item[0].rpartition(".")[2] not in TAGS)
    changed, problems = overridden(tables, dict(kinds_first))
    _check_size(changed)
    scenario = scenario_of_tables(changed, problems)
    _check_kind(scenario.system)
    simulation = {"duration": scenario.duration, "scheme": scenario.scheme.name}
    full = tomllib.loads(scenario_toml(scenario.system, scenario.probes or (), simulation))
    return Playable(scenario, full, case if text is None else text)


def _check_size(tables: dict[str, Any]) -> None:
    """Raise ScenarioError before a body of too many elements is built."""
    bodies = tables.get("bodies")
    named: dict[str, Any] = {"slider": tables.get("slider")} | (bodies if isinstance(bodies, dict) else {})
    for name, body in named.items():
        elements = body.get("elements", 1) if isinstance(body, dict) else 1
        if isinstance(elements, (int, float)) and elements > MOST_ELEMENTS:
            raise ScenarioError([f"{name}.elements must be at most {MOST_ELEMENTS} to be played, got {elements!r}"])


def _check_kind(system: System) -> None:
    contacts, kinds = len(system.contacts), [type(system.slider).__name__, type(system.track).__name__]
    if contacts != 1 or kinds != [FiniteElementBeam.__name__, ModalBeam.__name__] or system.connections:
        raise ScenarioError(
            [
                "scenario must be one finite-element beam on one modal beam to be played, got "
                f"{contacts} contact{'s' * (contacts > 1)} of a {kinds[0]} on a {kinds[1]}"
                f"{' and connections' if system.connections else ''}; run it with `stridula run`"
            ]
        )
    modes = sum(system.track.harmonics)
    if modes > MOST_MODES:
        raise ScenarioError([f"track must have at most {MOST_MODES} modes to be played, got {modes}: lower cutoff"])
