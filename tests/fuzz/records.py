"""Damaged or altered records in the functions that read them: load, regime, figures, continuation, comparison."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import stridula as st
from stridula import analysis, plot

from .numbers import flipped, number, plain
from .outcomes import folder, outcome

Given = tuple[str, str, int]
CASES = ("squeal", "belt")
DAMAGES = ("bytes", "drop", "rename", "values", "slice", "dims", "type", "attribute", "no attribute", "time", "scalar")


def inputs(seed: int, count: int) -> Iterator[Given]:
    """Return a damage, a use, and the seed of the damage."""
    for k in range(count):
        dice = random.Random(f"records {seed} {k}")
        yield dice.choice(DAMAGES), dice.choice(list(USES)), dice.randrange(2**32)


def check(given: Given) -> str:
    """Return the outcome of a damaged record."""
    damage, use, seed = given
    dice = random.Random(seed)
    case = dice.choice(CASES)
    whole = _record(case)
    with folder():

        def done() -> None:
            run = _from_bytes(dice, whole) if damage == "bytes" else _altered(dice, whole.copy(), damage)
            USES[use](run, case)

        return outcome(done)


@cache
def _scenario(case: str) -> Any:
    return st.load_scenario(case)


@cache
def _record(case: str) -> xr.Dataset:
    return _scenario(case).simulate(duration=0.02)


@cache
def _bytes(case: str) -> bytes:
    with folder():
        st.save(_record(case), "a.nc")
        return Path("a.nc").read_bytes()


def _from_bytes(dice: random.Random, whole: xr.Dataset) -> xr.Dataset:
    case = next(name for name in CASES if _record(name) is whole)
    Path("b.nc").write_bytes(flipped(dice, _bytes(case)))
    return st.load("b.nc")


def _altered(dice: random.Random, run: xr.Dataset, damage: str) -> xr.Dataset:
    name = dice.choice(list(run.variables))
    variable, words = run[name], dice.choice(list(run.attrs))
    if damage == "drop":
        return run.drop_vars(dice.sample(list(run.variables), dice.choice((1, 2, 5))))
    if damage == "rename":
        return run.rename({name: dice.choice(("x", "run", "音"))})
    if damage == "values" and variable.dtype.kind == "f" and variable.size:
        values = variable.values.copy()
        values[tuple(dice.randrange(size) for size in values.shape)] = number(dice)
        return run.assign({name: (variable.dims, values)})
    if damage == "slice":
        dimension = dice.choice(list(run.sizes))
        size = run.sizes[dimension]
        kept = [
            slice(0, 0),
            slice(0, 1),
            slice(0, size // 2),
            slice(1, None),
            slice(None, None, -1),
            *([0] * bool(size)),
        ]
        return run.isel({dimension: dice.choice(kept)})
    if damage == "dims" and variable.ndim:
        return run.assign({name: variable.variable.set_dims({"extra": 2, **variable.sizes})})
    if damage == "type" and name not in run.dims:
        kind = dice.choice((complex, str, bool, object, "datetime64[ns]", "int8"))
        with np.errstate(all="ignore"):
            return run.assign({name: (variable.dims, np.zeros(variable.shape).astype(kind))})
    if damage == "attribute":
        return run.assign_attrs({words: plain(dice)})
    if damage == "no attribute":
        del run.attrs[words]
        return run
    if damage == "time":
        time = run["time"].values
        others = (0.0 * time, time[::-1], time * number(dice), np.sort(np.abs(np.sin(1e6 * time))), time.astype(str))
        with np.errstate(all="ignore"):
            return run.assign_coords(time=("time", dice.choice(others)))
    return run.assign({name: number(dice)}) if name not in run.dims else run


def _go_on(run: xr.Dataset, case: str) -> None:
    st.simulate(_scenario(case).system, 0.001, start=run)


def _analyse(run: xr.Dataset, case: str) -> None:
    for status in ("sticking", "sliding"):
        analysis.phases(run, status)
        analysis.status_share(run, status)
    analysis.stops(run)
    analysis.settling_time(run)
    analysis.longest_unchanged(run)
    analysis.advance(run)


def _forces(run: xr.Dataset, case: str) -> None:
    force = run.get("normal_force", run)
    analysis.spectrum(force)
    analysis.dominant_frequency(force)
    analysis.tones(force)
    analysis.peak_level(force)
    analysis.largest_jump(force)
    analysis.envelope(force)


def _again(run: xr.Dataset, case: str) -> None:
    st.load_scenario(run)
    st.scenario_text(run)


def _kept(run: xr.Dataset, case: str) -> None:
    st.save(run, "c.nc")
    st.load("c.nc")


def _sound(run: xr.Dataset, case: str) -> None:
    st.radiate(run, _scenario("squeal").system.track)


USES: dict[str, Callable[[xr.Dataset, str], None]] = {
    "regime": lambda run, case: str(st.regime(run)["regime"].item()),
    "overview": lambda run, case: plot.save(plot.overview(run), "a.png"),
    "timeline": lambda run, case: plot.timeline(run, ["normal_force", "status"], (0.0, 0.01)),
    "bursts": lambda run, case: analysis.bursts(run),
    "phases": _analyse,
    "forces": _forces,
    "start": _go_on,
    "compare": lambda run, case: st.compare(_record(case), run),
    "compare to": lambda run, case: st.compare(run, _record(case)),
    "again": _again,
    "save": _kept,
    "csv": lambda run, case: st.export(run, "a.csv"),
    "mat": lambda run, case: st.export(run, "a.mat"),
    "sound": _sound,
    "spectrogram": lambda run, case: plot.spectrogram(run.get("normal_force", run), run, window=0.005),
}
