"""`stridula cycle` and `stridula follow`: limit cycles of a scenario, and their branches over a parameter."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..checks import ArgumentError
from ..cycles import NoCycle, limit_cycle
from ..drives import MOST_UNSTABLE, InitialEquilibrium
from ..integration import Diverged
from ..integration.bars import bar, told_of_time
from ..records.files import load
from ..records.files import save as save_file
from ..scenarios.load import Scenario, load_scenario
from ..scenarios.quantities import parts, quantity
from ..studies.branches import follow_cycle
from ..studies.points import Range
from .consoles import wide_console
from .exits import FAILED, Stopped
from .outputs import check_outputs, check_record
from .points import ranges_of

# Multipliers that are printed.
SHOWN = 6


class Begin(NamedTuple):
    """Options of the start of a search.

    Attributes
    ----------
    record : str or None
        File of a record.
    amplitude : str or None
        Amplitude of the mode that grows fastest.
    """

    record: str | None
    amplitude: str | None


class Over(NamedTuple):
    """Options of the parameter of a branch.

    Attributes
    ----------
    words : str
        Its key and range.
    value : str or None
        Value at the first cycle.
    points : int
        Most points in each direction.
    """

    words: str
    value: str | None
    points: int


def print_cycle(
    name: str, overrides: dict[str, Any], begin: Begin, frequency: str | None, out: str | None, plot: str | None
) -> None:
    """Find a limit cycle of a scenario, print it, and optionally write its record or draw its multipliers."""
    check_outputs(out, plot)
    check_record(out)
    scenario = load_scenario(name, overrides)
    begun = _start(scenario, name, begin)
    try:
        cycle = limit_cycle(
            scenario.system,
            begun,
            frequency=None if frequency is None else quantity(frequency, "Hz", "--frequency"),
            scheme=scenario.scheme,
            step=scenario.step,
            contact_solve=scenario.contact_solve,
            title=scenario.title or name,
            progress=True,
        )
    except NoCycle as error:
        raise Stopped(str(error), FAILED) from None
    console = wide_console()
    console.print(_table(cycle, scenario.title or name))
    if out is not None:
        save_file(cycle, out)
    if plot is not None:
        from ..plot import multipliers, save

        save(multipliers(cycle), plot)


def print_branch(
    name: str,
    overrides: dict[str, Any],
    over: Over,
    begin: Begin,
    out: str | None,
    plot: str | None,
) -> None:
    """Follow a limit cycle over a parameter, print its events, and optionally draw or write the branch."""
    check_outputs(out, plot)
    check_record(out)
    key, span = _range(over.words)
    low, high = span.number(0.0), span.number(1.0)
    first = low if over.value is None else _number(over.value, span.unit)
    scenario = load_scenario(name, overrides | {key: f"{first!r} {span.unit}" if span.unit else first})
    try:
        branch = follow_cycle(
            name,
            key,
            low,
            high,
            _start(scenario, name, begin),
            value=first,
            units=span.unit,
            overrides=overrides,
            points=over.points,
            scheme=scenario.scheme,
            step=scenario.step,
            contact_solve=scenario.contact_solve,
            out=out,
            progress=True,
        )
    except NoCycle as error:
        raise Stopped(str(error), FAILED) from None
    for line in _branch_lines(branch, key, span.unit):
        print(line)
    if plot is not None:
        from ..plot import bifurcation, save

        save(bifurcation(branch), plot)


def _range(words: str) -> tuple[str, Range]:
    """Return the key and the range of the option ``--over``."""
    try:
        ((key, span),) = ranges_of([words]).items()
    except ArgumentError as error:
        raise error.renamed("--over") from None
    if span.logarithmic:
        raise ArgumentError("--over", "be KEY=LOW:HIGH", words)
    return key, span


def _number(value: str, unit: str) -> float:
    """Return a value of the parameter in the unit of its range."""
    known = parts(value)
    if known is None or known[1] != unit:
        raise ArgumentError("--at", f"be a number in {unit}" if unit else "be a number without a unit", value)
    return known[0]


def _start(scenario: Scenario, name: str, begin: Begin) -> xr.Dataset | InitialEquilibrium:
    """Return the start of a search: a record, the mode that grows fastest, or the end of a run of the scenario."""
    if begin.record is not None and begin.amplitude is not None:
        raise ArgumentError("--amplitude", "be left out with --from", begin.amplitude)
    if begin.record is not None:
        return load(begin.record)
    if begin.amplitude is not None:
        return InitialEquilibrium(mode=MOST_UNSTABLE, amplitude=quantity(begin.amplitude, "m", "--amplitude"))
    try:
        with bar(scenario.title or name) as show:
            return scenario.simulate(watchers=[told_of_time(show)])
    except Diverged as error:
        raise Stopped(error.reason, FAILED) from None


def _table(cycle: xr.Dataset, title: str) -> Table:
    """Return a table of a limit cycle."""
    table = Table(title=escape(title), show_header=False, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    frequency, residual = float(cycle["frequency"]), float(cycle["residual"])
    rows = {
        "limit cycle": f"{frequency:.6g} Hz, period {float(cycle['period']):.6g} s, residual {residual:.1e}",
        "stability": str(cycle.attrs["verdict"]),
        "multipliers": "; ".join(_multiplier(*one) for one in cycle["multiplier"].values[:SHOWN]),
    }
    for name in map(str, cycle.data_vars):
        if name.endswith("_amplitude"):
            one, units = cycle[name], cycle[name].attrs["units"]
            labels = one[one.dims[0]].values.tolist()
            sizes = [f"{size:.4g} {units} at {label}" for label, size in zip(labels, one.values, strict=True)]
            rows[f"amplitude of {name.removesuffix('_amplitude').replace('_', ' ')}"] = "; ".join(sizes)
    energy = cycle["period_energy"]
    terms = zip(energy["energy_term"].values.tolist(), energy.values.tolist(), strict=True)
    rows["energy in a period"] = "; ".join(f"{word.replace('_', ' ')} {value:.4g} J" for word, value in terms)
    share = cycle["status_share"].mean([name for name in cycle["status_share"].dims if name != "contact_status"])
    states = zip(share["contact_status"].values.tolist(), share.values.tolist(), strict=True)
    rows["contact"] = ", ".join(f"{100.0 * part:.3g} % {word}" for word, part in states)
    step = float(cycle.attrs["step"])
    rows["computed"] = (
        f"{int(cycle['newton_steps'])} steps of Newton's method, {float(cycle['periods_marched']):.0f} periods "
        f"marched, {cycle.sizes['time']} steps of {step:.3g} s in a period"
    )
    for word, text in rows.items():
        table.add_row(word, escape(text))
    return table


def _multiplier(real: float, imaginary: float) -> str:
    """Return a multiplier in words."""
    if not imaginary:
        return f"{real:.4g}"
    return f"{real:.4g} {'+' if imaginary > 0.0 else '-'} {abs(imaginary):.4g}i"


def _branch_lines(branch: xr.Dataset, key: str, unit: str) -> list[str]:
    """Return the events of a branch in lines."""
    values, stable = branch[key].values, branch["stable"].values
    lines = [
        f"{values.size} points from {key} = {values[0]:.6g} to {values[-1]:.6g} {unit}".rstrip()
        + f", {int(np.count_nonzero(stable))} of them stable"
    ]
    events = zip(*(branch[f"event_{word}"].values.tolist() for word in ("kind", "value", "frequency")), strict=True)
    for kind, value, frequency in events:
        lines.append(f"{kind} at {key} = {f'{value:.6g} {unit}'.rstrip()}, {frequency:.5g} Hz")
    return [*lines, f"begins: {branch.attrs['begins']}", f"ends: {branch.attrs['ends']}"]
