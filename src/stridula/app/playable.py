"""Scenarios that the page can play, small enough to be simulated while you watch."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from ..records import Acceleration, Probe
from ..records.provenance import is_pair, scenario_tables, toml
from ..scenarios.errors import ScenarioError
from ..scenarios.keys import overridden
from ..scenarios.load import Scenario, scenario_of_tables, tables_in_si
from ..scenarios.outline import TAGS, look_up
from ..scenarios.read import names_files, read_tables, tables_of_text
from ..system import System
from .controls import KEYS, Turned, turned_of_pair
from .sources import Source, sources_of
from .turned import expanded, turned_of_system

# Cases with one beam on another, with other systems in the plane, and with systems in space.
PRESETS = ("squeal", "judder", "weak-pressure", "strong-pressure", "stable-sliding", "axial-sliding")
SYSTEMS = ("violin", "squeal-on-plate", "judder-on-plate", "belt", "lugre")
IN_SPACE = ("glass", "wheel", "pin-on-disc", "pad-on-disc", "brake")
CASES = (*PRESETS, *SYSTEMS, *IN_SPACE)
MOST_ELEMENTS, MOST_MODES, MOST_CONTACTS = 100, 400, 100
# Largest number of modes of a system other than a pair of beams; such systems may play slower than real time.
MOST_OF_SYSTEMS = 1500
# Largest numbers of elements of a generated mesh, and of nodes of a mesh or a profile, with modes that are computed
# within a minute.
MOST_OF_MESH, MOST_NODES = 4000, 20_000
# Largest numbers of degrees of freedom of a body of revolution in all orders, and of nodes of a mesh times the square
# of its modes, with modes that are computed within a minute.
MOST_UNKNOWNS, MOST_SEARCHED = 500_000, 2e9
# Shortest step allowed in a scenario [s].
SHORTEST_STEP = 1e-7


@dataclass(frozen=True)
class Playable:
    """A scenario that can be played.

    Attributes
    ----------
    scenario : Scenario
        The scenario to play.
    tables : dict
        Complete tables of the scenario in SI.
    origin : str
        Name of the shipped scenario, or the text, before values were set.
    before : dict or None
        Complete tables before values were set, None for a pair of beams.
    """

    scenario: Scenario
    tables: dict[str, Any]
    origin: str
    before: dict[str, Any] | None = None

    @property
    def system(self) -> System:
        """The system."""
        return self.scenario.system

    @cached_property
    def probes(self) -> tuple[Probe, ...]:
        """The probes: an acceleration, and for systems also those of the scenario."""
        contact = self.system.contacts[0]
        if contact.path_body is not None:
            first = Acceleration(contact.path_body.centre, "transverse" if self.system.is_spatial else "y")
        else:
            first = Acceleration(contact.tip, "xyz"[int(np.argmax(np.abs(contact.frame[1])))])
        own = () if self.before is None else self.scenario.probes or ()
        return (first, *(probe for probe in own if probe != first))

    @cached_property
    def sources(self) -> dict[str, Source]:
        """Sources of sound by name."""
        return sources_of(self.system, self.probes)

    @cached_property
    def turned(self) -> Turned:
        """Controls of the scenario."""
        return turned_of_pair(self.tables) if self.before is None else turned_of_system(self.tables, self.before)

    @property
    def is_fast(self) -> bool:
        """Whether any otherwise idle machine plays it in real time."""
        return self.before is None and self.scenario.step is None

    def stepped(self, step: float) -> Playable:
        """Return the same scenario with another time step [s]."""
        simulation = {**self.tables["simulation"], "step": step}
        return replace(
            self, scenario=replace(self.scenario, step=step), tables={**self.tables, "simulation": simulation}
        )

    @cached_property
    def toml(self) -> str:
        """The scenario as TOML, to run with `stridula run`."""
        return toml({"title": self.scenario.title} | self.tables)


def playable(case: str, text: str | None, overrides: Mapping[str, Any]) -> Playable:
    """Return a checked scenario with values set by key.

    Parameters
    ----------
    case : str
        Name of a shipped scenario, ignored if there is a text.
    text : str or None
        A scenario as TOML; it cannot name files.
    overrides : mapping
        Values by key, as in `load_scenario`; for a system also by keys of several places.

    Raises
    ------
    ScenarioError
        With every problem found.
    """
    if text is None and case not in CASES:
        raise ScenarioError([f"case must be one of {', '.join(CASES)}, got {case!r}"])
    tables, before = _given(case, text)
    if before is not None:
        overrides = expanded(overrides, before)
    unknown = [key for key in overrides if before is None and key not in KEYS]
    if unknown:
        raise ScenarioError([f"key must be a key of the page, got {unknown[0]!r}"])
    # Setting a kind clears its table, so that the other keys come after it.
    kinds_first = sorted(overrides.items(), key=lambda item: item[0].rpartition(".")[2] not in TAGS)
    changed, problems = overridden(tables, dict(kinds_first))
    _check_no_files(changed)
    _check_size(changed)
    scenario = scenario_of_tables(changed, problems, _check_system)
    _check_step(scenario)
    _check_modes(scenario.system)
    return Playable(scenario, _in_full(scenario, changed), case if text is None else text, before)


@lru_cache(maxsize=32)
def _given(case: str, text: str | None) -> tuple[dict[str, Any], dict[str, Any] | None]:
    """Return the tables in which values are set, and for a system, other than a pair of beams, the complete ones."""
    tables = read_tables(case) if text is None else tables_of_text(text, "the scenario")
    _check_size(tables)
    try:
        scenario = scenario_of_tables(tables, [], _check_system)
    except ScenarioError:
        # Problems are reported after values are set.
        return tables, None
    if _is_pair(scenario.system):
        return tables, None
    _check_modes(scenario.system)
    full = {"title": scenario.title, "description": scenario.description} | _in_full(scenario, tables)
    return full, full


def _is_pair(system: System) -> bool:
    """Return whether a system is one beam on another, in the plane."""
    return is_pair(system) and not system.is_spatial


def _in_full(scenario: Scenario, tables: dict[str, Any]) -> dict[str, Any]:
    """Return the complete tables of a scenario in SI; in space as described, without the resulting modes of bodies."""
    simulation: dict[str, Any] = {"duration": scenario.duration, "scheme": scenario.scheme.name}
    if scenario.step is not None:
        simulation["step"] = scenario.step
    if scenario.system.is_spatial:
        described = tables_in_si(tables)
        return described | {"simulation": described.get("simulation", {}) | simulation}
    return scenario_tables(scenario.system, scenario.probes or (), simulation)


def _check_no_files(tables: dict[str, Any]) -> None:
    """Raise ScenarioError if a body names a file, since a page must not choose files to read."""
    bodies = tables.get("bodies")
    named = [name for name, body in (bodies if isinstance(bodies, dict) else {}).items() if names_files(body)]
    if named:
        raise ScenarioError([f"bodies must not name files to be played, got those of {', '.join(named)}"])


def _check_step(scenario: Scenario) -> None:
    """Raise ScenarioError if the step of a scenario is so short that a part would take forever."""
    if scenario.step is not None and scenario.step < SHORTEST_STEP:
        told = f"simulation.step must be at least {SHORTEST_STEP:g} s to be played, got {scenario.step!r}"
        raise ScenarioError([told])


def _check_size(tables: dict[str, Any]) -> None:
    """Raise ScenarioError before a body of too many elements is built."""
    bodies = tables.get("bodies")
    named: dict[str, Any] = {"slider": tables.get("slider")} | (bodies if isinstance(bodies, dict) else {})
    for name, body in named.items():
        elements = body.get("elements", 1) if isinstance(body, dict) else 1
        if isinstance(elements, (int, float)) and elements > MOST_ELEMENTS:
            raise ScenarioError([f"{name}.elements must be at most {MOST_ELEMENTS} to be played, got {elements!r}"])
        parts = look_up(body, ("mesh", "parts"))
        for path in (("mesh",), *(("mesh", "parts", part) for part in (parts if isinstance(parts, dict) else ()))):
            divisions = look_up(body, (*path, "divisions"))
            counts = [one for one in divisions if isinstance(one, (int, float))] if isinstance(divisions, list) else []
            if math.prod(counts) > MOST_OF_MESH:
                key = ".".join((name, *path))
                told = f"{key}.divisions must make at most {MOST_OF_MESH} elements to be played, got {divisions!r}"
                raise ScenarioError([told])


def _check_system(system: System) -> None:
    """Raise ScenarioError if a system is too large, before the modes of its bodies are computed."""
    if len(system.contacts) > MOST_CONTACTS:
        many = len(system.contacts)
        raise ScenarioError([f"contacts must be at most {MOST_CONTACTS} to be played, got {many}"])
    if _is_pair(system):
        modes = sum(system.track.harmonics)
        if modes > MOST_MODES:
            raise ScenarioError([f"track must have at most {MOST_MODES} modes to be played, got {modes}: lower cutoff"])
        return
    for body in system.bodies:
        nodes = len(body.mesh.nodes) if hasattr(body, "mesh") else 0
        if nodes > MOST_NODES:
            name = system.body_name(body)
            told = f"{name} must have at most {MOST_NODES} nodes to be played, got {nodes}: take a coarser mesh"
            raise ScenarioError([told])
        unknowns = getattr(body, "unknowns", 0)
        if unknowns > MOST_UNKNOWNS:
            told = f"must have at most {MOST_UNKNOWNS} degrees of freedom in all orders to be played, got {unknowns}"
            raise ScenarioError([f"{system.body_name(body)} {told}: lower cutoff"])
        modes = getattr(body, "expected_modes", 0.0)
        most = min(MOST_OF_SYSTEMS, math.sqrt(MOST_SEARCHED / max(nodes, 1)))
        if modes > most:
            told = f"must have at most {most:.0f} modes to be played, got {modes:.0f} or more: lower cutoff"
            raise ScenarioError([f"{system.body_name(body)} {told}"])


def _check_modes(system: System) -> None:
    """Raise ScenarioError if the bodies of a system have too many modes."""
    if _is_pair(system):
        return
    modes = sum(body.modes().count for body in system.bodies)
    if modes > MOST_OF_SYSTEMS:
        raise ScenarioError([f"bodies must have at most {MOST_OF_SYSTEMS} modes to be played, got {modes}"])
