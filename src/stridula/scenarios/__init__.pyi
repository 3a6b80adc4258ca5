"""Types of the public names, which `__init__.py` imports on first use."""

from .errors import ScenarioError as ScenarioError
from .load import Scenario as Scenario
from .load import load_scenario as load_scenario
from .shipped import Case as Case
from .shipped import list_scenarios as list_scenarios
from .show import scenario_schema as scenario_schema
from .show import scenario_text as scenario_text
