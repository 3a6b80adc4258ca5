"""Scenarios by name or from files, ready to simulate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr
from pydantic import ValidationError

from ..checks import ArgumentError, by_key
from ..integration import SCHEMES, simulate
from ..integration.settings import NAMES, Settings, shows_settings
from ..ordinary import NotOrdinary
from ..records.provenance import body_table, mesh_tables
from ..system import System
from .build import Builder, out_of_range
from .errors import MOST_PROBLEMS, ScenarioError, as_written, explain, wrong_form
from .inheritance import shared_out
from .keys import overridden
from .read import names_files, read_tables
from .schema import ScenarioTable

# Settings that tables describe otherwise than the Python API.
BUILT = ("scheme", "probes", "contact_solve")


@dataclass(frozen=True)
class _Described:
    """The first fields of a scenario."""

    title: str
    description: str
    system: System
    duration: float


@shows_settings
@dataclass(frozen=True)
class Scenario(Settings, _Described):
    """A system and the settings of its simulation.

    Attributes
    ----------
    title, description : str
        Title in one line, and description.
    system : System
        System to simulate.
    duration : float
        Time to simulate [s].
    **settings
        Settings of the run.
    """

    @property
    def settings(self) -> Settings:
        """The settings alone."""
        return Settings(**{name: getattr(self, name) for name in NAMES})

    def simulate(self, **kwargs: Any) -> xr.Dataset:
        """Simulate the system in time and return its record.

        Parameters
        ----------
        **kwargs
            Arguments of `simulate` that replace, or add to, those of the scenario.

        Raises
        ------
        ScenarioError
            If the scenario's step, duration or sample rate is out of its range, or its coupled modes overflow.
        """
        own = {"duration": self.duration, "title": self.title, **vars(self.settings)}
        try:
            return simulate(self.system, **(own | kwargs))
        except NotOrdinary as error:
            raise ScenarioError([out_of_range("")]) from error
        except ArgumentError as error:
            if error.argument not in own or error.argument in kwargs:
                raise
            raise ScenarioError([str(error.renamed(f"simulation.{error.argument}"))]) from error


def load_scenario(name_or_path: str | Path | xr.Dataset, overrides: Mapping[str, Any] | None = None) -> Scenario:
    """Read and check a scenario.

    Parameters
    ----------
    name_or_path : str, Path or xarray.Dataset
        Name of a shipped case, a TOML file, or a record to run again, as a dataset or as the file written by `save`;
        ``-`` for TOML from standard input.
    overrides : mapping, optional
        Values to set by key: a full path such as ``contact.friction.coefficient``, or any unique ending of one.

    Returns
    -------
    Scenario

    Raises
    ------
    ScenarioError
        With every problem found: each names the key, the value and the allowed values.
    OSError
        If the file cannot be read.
    """
    written, problems = overridden(read_tables(name_or_path), by_key("overrides", overrides))
    return scenario_of_tables(written, problems)


def scenario_of_tables(
    written: dict[str, Any], problems: Sequence[str] = (), check: Callable[[System], None] | None = None
) -> Scenario:
    """Check the tables of a scenario and return the scenario.

    Parameters
    ----------
    written : dict
        The tables as in a file, those of its base merged in.
    problems : sequence of str, optional
        Problems of the tables known beforehand.
    check : callable, optional
        Raises if a system is refused, before the modes of its bodies are computed.

    Raises
    ------
    ScenarioError
        With every problem found.
    """
    checked, builder = _checked(written, problems)
    system = builder.system(check)
    simulation = checked.simulation
    return Scenario(
        title=checked.title,
        description=checked.description,
        system=system,
        duration=simulation.duration,
        **{name: getattr(simulation, name) for name in NAMES if name not in BUILT},
        scheme=SCHEMES[simulation.scheme](),
        probes=builder.probes(system),
        contact_solve=builder.contact_solve(),
    )


def tables_in_si(written: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a scenario with numbers in SI, and with shared values copied into each body or contact.

    Parameters
    ----------
    written : dict
        The tables as in a file, those of its base merged in.

    Raises
    ------
    ScenarioError
        With every problem of form.
    """
    checked, _ = _checked(written)
    found: dict[str, Any] = checked.model_dump(exclude_unset=True)
    return found


def with_matrices(written: dict[str, Any], usable: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a scenario with matrices and meshes of bodies in place of the names of their files.

    Parameters
    ----------
    written : dict
        Tables, which may be incomplete.
    usable : dict
        The same tables, completed.

    Raises
    ------
    ScenarioError
        With every problem found.
    """
    bodies: dict[str, Any] = written.get("bodies") or {}
    files = {name for name, body in bodies.items() if names_files(body)}
    if not files:
        return written
    _, builder = _checked(usable)
    builder.system()
    filled = {name: _filled(body, builder.bodies[name]) if name in files else body for name, body in bodies.items()}
    return written | {"bodies": filled}


def _filled(table: dict[str, Any], body: Any) -> dict[str, Any]:
    """Return the table of a body with the contents of its files."""
    return table | mesh_tables(body) if hasattr(body, "mesh") else body_table(body)


def _checked(written: dict[str, Any], problems: Sequence[str] = ()) -> tuple[ScenarioTable, Builder]:
    tables = shared_out(written)
    found = [*problems, *wrong_form(written)]
    try:
        checked = ScenarioTable.model_validate(tables)
    except ValidationError as error:
        raise ScenarioError(found + explain(error, tables, written), error.error_count() - MOST_PROBLEMS - 1) from None
    if found:
        raise ScenarioError(found)
    return checked, Builder(
        {"drives": []} | checked.model_dump(exclude_unset=True), partial(as_written, written=written)
    )
