"""`stridula survey`: check the arguments, compute under a progress bar, and print the fate of each mode."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich import box
from rich.markup import escape
from rich.table import Table

from ..checks import ArgumentError, counted
from ..disk import check_writable, write
from ..linear.equilibrium import AT_LEAST_ONE, SEVERAL
from ..scenarios.read import read_tables
from ..studies.fates import CHANGES, JOINS, LIVES, VIBRATES
from ..studies.surveys import squeal_survey
from ..studies.tables import survey_table
from .consoles import wide_console
from .outputs import check_outputs, check_record
from .points import Points
from .sweeping import check_two_keys, closing, computing

# Formats of levels, forces and other numbers.
LEVEL, FORCE, NUMBER = ".1f", ".3g", ".4g"
# Fates of one mode listed on separate lines.
MOST_FATES = 3


def survey_scenario(
    name: str,
    points: Points,
    out: str,
    plot: str | None,
    table: str | None,
    scheduler: str | None,
    **options: Any,
) -> str:
    """Survey a scenario, write the results, print a table of its modes, and return the closing lines.

    Raises
    ------
    ValueError
        If an argument is invalid; then nothing is written.
    OSError
        If an output cannot be written; finished parts are kept.
    Stopped
        On Ctrl-C, or if other machines fail; finished parts are kept.
    """
    check_outputs(out, plot)
    check_record(out)
    if table is not None:
        _check_table(table, out, plot)
    if plot is not None:
        check_two_keys(points)
    title = str(read_tables(name).get("title", name))
    with computing(title, out, scheduler) as machinery:
        found = squeal_survey(name, points, out=out, **options, **machinery)
    if plot is not None:
        from ..plot import save, squeal_map

        save(squeal_map(found), plot)
    if table is not None:
        write(table, survey_table(found).encode())
    console = wide_console()
    if found.sizes["mode"]:
        console.print(_modes(found, title))
    console.print(escape(_verdicts(found)), highlight=False)
    if quiet := _kicks(found):
        console.print(escape(quiet), highlight=False)
    return closing(found, out)


def _check_table(table: str, out: str, plot: str | None) -> None:
    for option, other in (("--out", out), ("--plot", plot)):
        if other is not None and Path(other).resolve() == Path(table).resolve():
            raise ArgumentError("--table", f"differ from {option}", table, got=f"{table!r} for both")
    if not table.lower().endswith(".csv"):
        raise ArgumentError("--table", "end in .csv", table)
    check_writable(table)


def _modes(found: xr.Dataset, title: str) -> Table:
    """Return a table of the modes that grow at any point, by increasing frequency, with their most frequent fates."""
    table = Table(title=escape(title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    heads = ("mode", "frequency [Hz]", "growth [1/s]", "in time [1/s]", "first unstable at")
    slopes = _slopes(found)
    for head in (*heads, *slopes, "becomes", "points", "tone [Hz]", "force [N rms]", "sound [dB(A)]"):
        table.add_column(escape(head), justify="left" if head in (heads[-1], "becomes") else "right", overflow="fold")
    flat = found.stack(at=found["verdict"].dims)
    for number in found["mode"].values.tolist():
        one = flat.sel(mode=number)
        there = np.flatnonzero(np.isfinite(one["frequency"].values))
        rates = [_span(one[word].values[there], NUMBER) for word in ("frequency", "growth_rate", "seen_growth_rate")]
        first = [str(number), *rates, _place(found, int(there[0]))]
        first += [_span(values.sel(mode=number).values, NUMBER) for values in slopes.values()]
        for fate in _fates(one.isel(at=there)):
            table.add_row(*map(escape, (*first, *fate)))
            first = [""] * len(first)
    return table


def _slopes(found: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the derivatives of the growth rate by the parameters, by their heads in the table."""
    if "d_growth_rate" not in found:
        return {}
    units = [str(one) for one in found["parameter_units"].values]
    heads = [
        f"d growth by {key} [1/s{'' if unit in ('', '1') else f' per {unit}'}]"
        for key, unit in zip(found["parameter"].values, units, strict=True)
    ]
    return {head: found["d_growth_rate"].isel(parameter=number) for number, head in enumerate(heads)}


def _place(found: xr.Dataset, at: int) -> str:
    """Return the values of the keys at a point as text."""
    verdict = found["verdict"]
    where = verdict.isel(dict(zip(verdict.dims, np.unravel_index(at, verdict.shape), strict=True)))
    keys = [str(name) for name in where.coords if name != "point"]
    return ", ".join(f"{key} = {_value(where[key])}" for key in keys)


def _value(one: xr.DataArray) -> str:
    units = str(one.attrs.get("units", ""))
    word = format(one.item(), NUMBER) if one.dtype.kind in "fiu" else str(one.item())
    return f"{word} {units}" if units not in ("", "1") else word


def _fates(one: xr.Dataset) -> Iterator[tuple[str, ...]]:
    """Yield the fates of a mode and their levels as text, the most frequent first."""
    names = ("fate", "joined", "regime")
    words = np.array([_group(*told) for told in zip(*(one[name].values.tolist() for name in names), strict=True)])
    kinds, counts = np.unique(words, return_counts=True)
    order = np.argsort(-counts, kind="stable")
    for kind in kinds[order[:MOST_FATES]]:
        some = one.isel(at=np.flatnonzero(words == kind))
        vibrates = some["fate"].values[0] in VIBRATES
        tones, forces, levels = some["tone_frequency"].isel(tone=0), some["normal_force_rms"], some["sound_level"]
        numbers = [(tones, NUMBER), (forces, FORCE), (levels, LEVEL)] if vibrates else []
        yield kind, str(some.sizes["at"]), *(_span(values.values, form) for values, form in numbers)
    left = int(counts[order[MOST_FATES:]].sum())
    if left:
        yield "otherwise", str(left)


def _group(fate: str, joined: float, regime: str) -> str:
    """Return the fate of a mode as text, without numbers."""
    if fate == JOINS:
        return f"joins mode {joined:.0f}, {regime}" if np.isfinite(joined) else f"joins another mode, {regime}"
    return {LIVES: regime, CHANGES: f"{regime}, other tone"}.get(fate, fate)


def _span(values: Any, form: str) -> str:
    """Return the range of some numbers as text, a single number if both ends read the same."""
    known = values[np.isfinite(values)]
    if not known.size:
        return "-"
    low, high = format(float(known.min()), form), format(float(known.max()), form)
    return low if low == high else f"{low} to {high}"


def _kicks(found: xr.Dataset) -> str:
    """Return the quiet points that a kick lets squeal, nothing without any."""
    kicks = found["kick"].values.ravel()
    least = np.flatnonzero(np.isfinite(kicks))
    if not least.size:
        return ""
    least = least[np.argsort(kicks[least], kind="stable")]
    tones = found["kick_tone"].values.ravel()[least]
    return (
        f"kicked into squeal: {counted(least.size, 'stable point')}, at {_span(tones, NUMBER)} Hz; the smallest kick "
        f"is {kicks[least[0]]:.3g} m, at {_place(found, int(least[0]))}"
    )


def _verdicts(found: xr.Dataset) -> str:
    """Return the number of points with each verdict of linear theory."""
    kinds, counts = np.unique(found["verdict"].values.astype(str), return_counts=True)
    order = np.argsort(-counts, kind="stable")
    verdicts = "linear theory: " + ", ".join(f"{kinds[k]} at {counted(int(counts[k]), 'point')}" for k in order)
    others = {word: int((found["equilibria"] == word).sum()) for word in (SEVERAL, AT_LEAST_ONE)}
    return verdicts + "".join(f"; {word} equilibria at {counted(n, 'point')}" for word, n in others.items() if n)
