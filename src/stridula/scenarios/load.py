"""Scenarios by name or from files, ready to simulate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr
from pydantic import ValidationError

from ..integration import SCHEMES, CentralDifference, ExactModal, GaussSeidel, simulate
from ..records import Probe
from ..system import System
from .build import NOT_FINITE, Builder, out_of_range
from .errors import ScenarioError, as_written, explain, wrong_form
from .inheritance import shared_out
from .keys import overridden
from .read import read_tables
from .schema import ScenarioTable


@dataclass(frozen=True)
class Scenario:
    """A system, and how to simulate it.

    Attributes
    ----------
    title, description : str
        What it is.
    system : System
        What to simulate.
    duration : float
        Time to simulate [s].
    scheme : ExactModal or CentralDifference
        Time scheme.
    step : float or None
        Time step [s]; the scheme's default if None.
    sample_rate : float
        Samples recorded per second [Hz].
    probes : tuple of probes or None
        What else to record; the acceleration of the track's centre if None.
    contact_solve : GaussSeidel or None
        How several contacts are solved together; the default if None.
    """

    title: str
    description: str
    system: System
    duration: float
    scheme: ExactModal | CentralDifference
    step: float | None
    sample_rate: float
    probes: tuple[Probe, ...] | None
    contact_solve: GaussSeidel | None = None

    def simulate(self, **kwargs: Any) -> xr.Dataset:
        """March the system in time and return its record.

        Parameters
        ----------
        **kwargs
            Arguments of `simulate` to use instead of, or beside, the scenario's.

        Raises
        ------
        ScenarioError
            If the scenario's step, duration or sample rate is out of its range, or its coupled modes overflow.
        """
        names = ("duration", "scheme", "step", "sample_rate", "probes", "contact_solve", "title")
        own = {name: getattr(self, name) for name in names}
        try:
            return simulate(self.system, **(own | kwargs))
        except ValueError as error:
            if NOT_FINITE in str(error):
                raise ScenarioError([out_of_range("")]) from error
            word = str(error).partition(" ")[0]
            if word not in own or word in kwargs:
                raise
            raise ScenarioError([f"simulation.{error}"]) from error


def load_scenario(name_or_path: str | Path | xr.Dataset, overrides: Mapping[str, Any] | None = None) -> Scenario:
    """Read a scenario and check it.

    Parameters
    ----------
    name_or_path : str, Path or xarray.Dataset
        Name of a shipped case, a TOML file, or a record to be run again, itself or the file that `save` wrote.
    overrides : mapping, optional
        Values to set by key: a full path such as ``contact.friction.coefficient``, or any unique ending of one.

    Returns
    -------
    Scenario

    Raises
    ------
    ScenarioError
        With every problem found: each names the key, the value and what is allowed.
    OSError
        If the file cannot be read.
    """
    written, problems = overridden(read_tables(name_or_path), overrides or {})
    tables = shared_out(written)
    problems += wrong_form(written)
    try:
        checked = ScenarioTable.model_validate(tables)
    except ValidationError as error:
        raise ScenarioError(problems + explain(error, tables, written)) from None
    if problems:
        raise ScenarioError(problems)
    builder = Builder({"drives": []} | checked.model_dump(exclude_unset=True), partial(as_written, written=written))
    system = builder.system()
    simulation = checked.simulation
    return Scenario(
        title=checked.title,
        description=checked.description,
        system=system,
        duration=simulation.duration,
        scheme=SCHEMES[simulation.scheme](),
        step=simulation.step,
        sample_rate=simulation.sample_rate,
        probes=builder.probes(system),
        contact_solve=builder.contact_solve(),
    )
