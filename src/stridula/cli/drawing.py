"""`stridula show --plot`: a system before its run."""

from __future__ import annotations

from ..scenarios.load import load_scenario
from .outputs import check_outputs


def draw_system(name: str, plot: str, out: str | None) -> None:
    """Draw the system of a scenario, and print the name of the file.

    Raises
    ------
    ValueError
        If the scenario or the format of the figure is not usable.
    OSError
        If the file cannot be written.
    """
    check_outputs(out, plot)
    scenario = load_scenario(name)
    from ..plot import save, system

    save(system(scenario.system, title=scenario.title or name), plot)
    print(plot)
