"""`stridula stability`: equilibrium and modes of sliding by linear theory, at one set of parameters."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..analysis.stability import sliding_stability
from ..checks import ArgumentError, counted
from ..scenarios.load import load_scenario
from ..scenarios.quantities import quantity
from .consoles import wide_console

# Modes shown where none grows.
FEWEST = 5
KINDS = {
    "sliding": "slides steadily",
    "held": "held by friction",
    "lifted off": "lifted off",
    "jammed": "jammed: it neither slides on nor opens",
}
EQUILIBRIA = {
    "several": "Several equilibria exist; this is the one nearest to that without friction.",
    "none": "Nothing stays at rest: the bodies move apart, or friction cannot hold them.",
    "none found": "No equilibrium that satisfies every inequality was found.",
}


def print_stability(name: str, overrides: dict[str, Any], status: str | None, velocity: str | None) -> None:
    """Print the equilibrium and modes of a scenario: those that grow, or the few nearest to growth."""
    scenario = load_scenario(name, overrides)
    given = statuses(status)
    modes = sliding_stability(scenario.system, status=given, velocity=velocities(velocity))
    console = wide_console()
    console.print(_table(modes, scenario.title or name))
    for line in _closing(modes, given is not None):
        console.print(escape(line), highlight=False)


def statuses(status: str | None) -> list[str] | None:
    """Return the statuses given by an option, separated by commas."""
    return None if status is None else [word.strip() for word in status.split(",")]


def velocities(velocity: str | None) -> float | list[float] | None:
    """Return the slip velocities [m/s] given by an option: one for all contacts, or a list separated by commas."""
    if velocity is None:
        return None
    try:
        numbers = [quantity(word, "m/s") for word in velocity.split(",")]
    except ArgumentError as error:
        raise ArgumentError("--velocity", error.allowed, velocity) from None
    return numbers[0] if len(numbers) == 1 else numbers


def _table(modes: xr.Dataset, title: str) -> Table:
    table = Table(title=escape(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    bodies = [str(name) for name in modes["body"].values]
    for head in ("frequency [Hz]", "growth rate [1/s]", "damping ratio", *(f"energy in {body}" for body in bodies)):
        table.add_column(head, justify="right", overflow="fold")
    growth = modes["growth_rate"].values
    grows = int(modes["unstable"].sum())
    for k in np.argsort(-growth)[: max(grows, FEWEST)]:
        one = modes.isel(mode=int(k))
        style = "bold" if bool(one["unstable"]) else None
        numbers = [f"{float(one[word]):.5g}" for word in ("frequency", "growth_rate", "damping_ratio")]
        shares = [f"{100.0 * share:.0f} %" for share in one["energy_share"].values]
        table.add_row(*numbers, *shares, style=style)
    return table


def _closing(modes: xr.Dataset, given: bool) -> list[str]:
    several = "contact" in modes.dims
    lines = []
    for name in [str(word) for word in modes["contact"].values] if several else ["contact"]:
        one = modes.sel(contact=name) if several else modes
        forces = [f"{_size(one[word]):.4g} N {word.partition('_')[0]}" for word in ("normal_force", "tangential_force")]
        lines.append(f"{name}: {one['status'].item()}, {', '.join(forces)}{_motion(one)}")
    grows, kind = int(modes["unstable"].sum()), KINDS[modes.attrs["equilibrium"]]
    if modes.attrs["equilibrium"] == "jammed" and not modes.sizes["mode"]:
        return [*lines, f"No equilibrium to linearise about; {kind}."]
    about = " about the contacts as given" if given else ""
    growing = f"{counted(grows, 'mode')} {'grows' if grows == 1 else 'grow'}" if grows else "no mode grows"
    lines.append(f"Equilibrium: {kind}; {growing} (of {modes.sizes['mode']}){about}.")
    if count := int((modes["unstable"] & modes["beyond_cutoff"]).sum()):
        lies = "lies" if count == 1 else "lie"
        lines.append(
            f"{counted(count, 'growing mode')} {lies} above the cutoff of every body, without the modes left out."
        )
    if modes.attrs["equilibria"] in EQUILIBRIA:
        lines.append(EQUILIBRIA[modes.attrs["equilibria"]])
    return [*lines, *([f"Violated: {modes.attrs['violated']}."] if modes.attrs["violated"] else [])]


def _size(component: xr.DataArray) -> float:
    """Return a number, or in space the magnitude of its components along both tangents."""
    return float(component) if component.ndim == 0 else float(np.hypot(*component.values))


def _motion(one: xr.Dataset) -> str:
    slip, acceleration = _size(one["slip_velocity"]), _size(one["slip_acceleration"])
    if np.isfinite(slip) and slip:
        return f", slip {slip:.4g} m/s"
    return f", slip accelerates by {acceleration:.4g} m/s²" if acceleration else ""
