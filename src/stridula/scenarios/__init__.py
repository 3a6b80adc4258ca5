"""Ready cases as TOML, in the same words as the Python API, and their loader."""

from .errors import ScenarioError
from .load import Scenario, load_scenario
from .show import Case, list_scenarios, scenario_schema, scenario_text

__all__ = ["Case", "Scenario", "ScenarioError", "list_scenarios", "load_scenario", "scenario_schema", "scenario_text"]
