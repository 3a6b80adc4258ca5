"""Every public callable with arguments of all kinds, some of them valid."""

from __future__ import annotations

import inspect
import os
import random
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import pyplot

import stridula as st
from stridula import analysis, plot, scenarios, studies

from .numbers import number, plain
from .outcomes import folder, outcome, watcher

# A name, and for each argument a word of `THINGS` or a plain value.
Given = tuple[str, dict[str, tuple[str, Any]]]

MODULES = {"": st, "analysis.": analysis, "plot.": plot, "scenarios.": scenarios, "studies.": studies}
# Results, which users do not call.
RESULTS = {
    "Case", "CalibrationProgress", "Diverged", "DoubtfulValue", "Film", "Interrupted", "Modes", "NoCycle", "Progress",
    "Report", "Scenario", "ScenarioError", "SoundFile", "SweepProgress",
}  # fmt: skip
# Functions of extras that are not installed.
if find_spec("openturns") is None:
    RESULTS.add("mode_surrogate")
# Films and models of hearing take seconds for valid arguments.
SLOW = {
    "animate",
    "animate_mode",
    "animate_surface",
    "bodies",
    "loudness",
    "loudness_over_time",
    "prominent_tones",
    "roughness",
    "sharpness",
    "view",
    "view_mode",
}


# Arguments that shorten long calls.
FEW = {
    "sensitivity": {"samples": 2, "resamples": 1, "duration": 1e-3},
    "sweep": {"duration": 1e-3},
    "squeal_survey": {"duration": 1e-3},
    "ensemble": {"runs": 2},
    "mode_sensitivity": {"parameters": ["coefficient"]},
    "mode_probability": {"samples": 2},
    "mode_surrogate": {"samples": 10, "checks": 10},
    "smallest_change": {"most": 50, "points": 2},
    "report": {"run": False, "effects": False, "check": False},
    "calibrate": {"population": 5, "generations": 1, "duration": 1e-3},
    "calibrate_to": {"population": 5, "generations": 1, "duration": 1e-3},
}


def inputs(seed: int, count: int) -> Iterator[Given]:
    """Return names of callables and their arguments."""
    names = list(_callables())
    for k in range(count):
        dice = random.Random(f"calls {seed} {k}")
        name = dice.choice(names)
        yield name, _arguments(dice, name)


def check(given: Given) -> str:
    """Return the outcome of a call."""
    name, arguments = given
    with folder():
        Path("file.txt").write_text("x")
        Path("table.csv").write_text("t [s],a [N]\n0.0,1\n0.1,2\n")
        values = {word: _thing(kind, value) for word, (kind, value) in arguments.items()}
        try:
            return outcome(lambda: _callables()[name](**values))
        finally:
            pyplot.close("all")
            for open_ever in range(3):
                os.fstat(open_ever)


@cache
def _callables() -> dict[str, Callable[..., Any]]:
    found = {f"{prefix}{name}": getattr(module, name) for prefix, module in MODULES.items() for name in module.__all__}
    return {name: one for name, one in found.items() if callable(one) and name.rpartition(".")[2] not in RESULTS}


def _arguments(dice: random.Random, name: str) -> dict[str, tuple[str, Any]]:
    parameters = inspect.signature(_callables()[name]).parameters.values()
    wrong = 1.0 if name.rpartition(".")[2] in SLOW else dice.choice((0.1, 0.3, 0.7))
    given = {}
    for one in parameters:
        if one.kind is one.VAR_KEYWORD:
            continue
        if one.default is one.empty or dice.random() < 0.3:
            fitting = FITTING.get(one.name)
            fits = fitting is not None and dice.random() >= wrong
            given[one.name] = dice.choice(fitting) if fitting is not None and fits else _anything(dice)
    name = name.rpartition(".")[2]
    if name in FEW:
        given |= {word: ("plain", value) for word, value in FEW[name].items() if word not in given}
    if "watchers" in {one.name for one in parameters} and given.get("watchers", ("", 0))[0] != "plain":
        given["watchers"] = ("watchers", None)
    return given


def _anything(dice: random.Random) -> tuple[str, Any]:
    draw = dice.random()
    if draw < 0.25:
        return "plain", number(dice)
    if draw < 0.5:
        return "plain", plain(dice)
    return dice.choice(list(THINGS)), None


def _thing(kind: str, value: Any) -> Any:
    return value if kind == "plain" else THINGS[kind]()


@cache
def _record() -> xr.Dataset:
    return st.load_scenario("squeal").simulate(duration=0.06)


@cache
def _two_contacts() -> xr.Dataset:
    return xr.concat([_record(), _record()], "contact", data_vars="all", coords="minimal", compat="override").transpose(
        "time", ...
    )


@cache
def _system() -> st.System:
    return st.load_scenario("squeal").system


@cache
def _sound() -> xr.DataArray:
    return st.radiate(_record(), _system().track)


@cache
def _loci() -> xr.Dataset:
    return st.root_loci("squeal", "coefficient", [1.0, 1.5])


@cache
def _effects() -> xr.Dataset:
    return st.mode_sensitivity("weak-pressure", ["friction"])


@cache
def _probability() -> xr.Dataset:
    return st.mode_probability("weak-pressure", {"friction": (0.8, 1.0)}, samples=4)


@cache
def _swept() -> xr.Dataset:
    points = st.Grid({"coefficient": [1.0, 1.5], "contact.at": [0.3, 0.4]})
    return st.sweep("squeal", points, ["regime"], duration=0.005)


def _measured() -> st.MeasuredModes:
    return st.MeasuredModes([412.0], 0.004, [[[0.0], [0.0], [1.5]]], ["tip"], "unit modal mass", [[0.0, 0.0, 0.1]])


def _mobilities() -> xr.DataArray:
    frequency = np.arange(100.0, 800.0)
    row = st.mobility(_measured().body().at("tip"), direction="z", frequency=frequency).values
    names = {"response": ["tip +Z"], "excitation": ["tip +Z"], "frequency": frequency}
    return xr.DataArray(row[None, None], names, ("response", "excitation", "frequency"))


def _mass() -> st.PointMass:
    return st.PointMass(1.0)


THINGS: dict[str, Callable[[], Any]] = {
    "None": lambda: None,
    "object": object,
    "bytes": lambda: b"abc",
    "type": lambda: st.System,
    "function": lambda: len,
    "complex": lambda: 1j,
    "digits": lambda: 10**5000,
    "array": lambda: np.arange(6.0),
    "matrix": lambda: np.eye(4),
    "empty": lambda: np.empty(0),
    "not finite": lambda: np.array([np.nan, np.inf]),
    "texts": lambda: np.array(["a", "b"]),
    "objects": lambda: np.array([object()], dtype=object),
    "numpy number": lambda: np.float32(0.5),
    "numpy whole": lambda: np.int64(3),
    "numpy true": lambda: np.bool_(True),
    "generator": lambda: (k for k in range(3)),
    "set": lambda: {1, 2},
    "pair": lambda: (0.1, 0.2),
    "intervals": lambda: np.array([[0.0, 0.01], [0.02, 0.05]]),
    "record": _record,
    "cut record": lambda: _record().isel(time=slice(0, 3)),
    "empty record": lambda: _record().isel(time=slice(0, 0)),
    "two contacts": _two_contacts,
    "dataset": lambda: xr.Dataset({"a": 1.0}),
    "signal": lambda: _record()["normal_force"],
    "shares": lambda: _record()["status_share"],
    "constant signal": lambda: _record()["normal_force"] * 0.0,
    "bare signal": lambda: xr.DataArray(np.ones(50), dims="time"),
    "scalar signal": lambda: xr.DataArray(1.0),
    "sound": _sound,
    "speed": lambda: (_record()["normal_force"] * 0.0 + 1e4).assign_attrs(units="rpm"),
    "one sound": lambda: _sound().isel(listener=0),
    "loci": _loci,
    "effects": _effects,
    "swept": _swept,
    "probability": _probability,
    "stability": lambda: st.sliding_stability(_system()),
    "system": _system,
    "systems": lambda: [_system(), _system()],
    "track": lambda: _system().track,
    "plate": lambda: st.ModalPlate(st.Material(2e11, 7800.0), 0.002, 0.4, 0.3, (3, 3)),
    "rigid track": lambda: st.RigidTrack(0.1),
    "slider": lambda: _system().slider,
    "mass": _mass,
    "tip": lambda: _system().slider.tip,
    "root": lambda: _system().slider.root,
    "centre": lambda: _mass().centre,
    "contact": lambda: _system().contacts[0],
    "drives": lambda: list(_system().drives),
    "material": lambda: st.Material(2e11, 7800.0),
    "section": lambda: st.Rectangle(0.02, 0.004),
    "law": lambda: st.Coulomb(0.5),
    "stribeck": lambda: st.Stribeck(0.5, 0.3, 0.01),
    "history": lambda: st.Ramp(0.01),
    "line": lambda: st.Line((0.0, 0.1)),
    "air": st.Air,
    "rayleigh": lambda: st.Rayleigh(1.0, 1e-6),
    "scheme": st.ExactModal,
    "solve": st.GaussSeidel,
    "probes": lambda: [st.Velocity(_system().slider.tip)],
    "figure": lambda: plot.friction(st.Coulomb(0.5)),
    "thresholds": analysis.Thresholds,
    "grid": lambda: st.Grid({"coefficient": [1.0, 1.5]}),
    "random points": lambda: st.RandomPoints({"coefficient": (1.0, 1.5)}, 2),
    "hypercube": lambda: st.LatinHypercube({"coefficient": (1.0, 1.5)}, 2),
    "range": lambda: st.Range(0.1, 1.0),
    "measure": lambda: {"mean": lambda run: 1.0},
    "failing measure": lambda: {"mean": lambda run: 1 / 0},
    "target": lambda: {"regime": "squeal"},
    "points": lambda: {"tip": (0, 1)},
    "measured modes": _measured,
    "mobilities": _mobilities,
    "mac": lambda: st.mac(_measured(), _measured()),
    "events": lambda: st.squeal_events(_sound().isel(listener=0)),
    "watchers": lambda: [watcher()],
    "path": lambda: Path("file.txt"),
    "folder": lambda: Path("."),
}


def _plain(*values: Any) -> tuple[tuple[str, Any], ...]:
    return tuple(("plain", value) for value in values)


def _things(*names: str) -> tuple[tuple[str, Any], ...]:
    return tuple((name, None) for name in names)


_NUMBERS = _plain(0.1, 1.0, 0.5, 1e-3)
_RUNS = _things("record", "cut record", "two contacts")
_SIGNALS = _things("signal", "one sound", "constant signal")
_NAMES = _plain(
    "file.txt",
    "new.nc",
    "new.csv",
    "new.mat",
    "new.png",
    "new.wav",
    "new.flac",
    "new.uff",
    "table.csv",
    "missing/new.nc",
    "squeal",
    "",
)
_SYSTEMS = _things("system")
_STATUS = _plain("sticking", "sliding", "separated")
# Kinds of arguments by name, valid in at least one function.
FITTING: dict[str, tuple[tuple[str, Any], ...]] = {
    **dict.fromkeys(("young", "density", "stiffness"), _plain(2.1e11, 7800.0, 1e6) + _things("matrix")),
    **dict.fromkeys(("length", "width", "thickness", "height", "diameter", "area", "second_moment"), _NUMBERS),
    **dict.fromkeys(("static", "kinetic", "velocity", "coefficient", "slope", "gap", "at", "window"), _NUMBERS),
    **dict.fromkeys(("run", "a", "b"), _RUNS),
    **dict.fromkeys(("signal", "first", "second"), _SIGNALS + _things("tip", "centre")),
    **dict.fromkeys(("path", "out"), _NAMES),
    **dict.fromkeys(("body", "track"), _things("track", "plate", "slider", "mass", "rigid track")),
    **dict.fromkeys(("point", "tip"), _things("tip", "root", "centre")),
    **dict.fromkeys(("name_or_path", "scenario", "source"), _plain("squeal", "belt", "file.txt") + _RUNS),
    **dict.fromkeys(("measures",), _plain("regime", ["mean_force"]) + _things("measure", "failing measure")),
    **dict.fromkeys(("duration", "start"), _plain(1e-3, 0.0) + _things("record")),
    **dict.fromkeys(("samples", "runs", "workers", "resamples", "population", "generations"), _plain(1, 2)),
    **dict.fromkeys(
        ("overrides", "ranges", "uncertain", "distributions"), _plain({"coefficient": (0.5, 1.0)}, {"coefficient": 1.0})
    ),
    "measured": _things("measured modes", "mobilities"),
    "computed": _things("measured modes", "slider", "mass", "plate"),
    "scaling": _plain("unit modal mass", "unit modal A", 2.0),
    "system": _SYSTEMS,
    "systems": _things("systems"),
    "material": _things("material"),
    "section": _things("section"),
    "friction": _things("law", "stribeck"),
    "law": _things("law", "stribeck"),
    "history": _things("history"),
    "line": _things("line"),
    "air": _things("air"),
    "damping": _NUMBERS + _things("rayleigh"),
    "points": _things("points", "grid", "hypercube", "random points"),
    "mass": _plain(1.0) + _things("matrix"),
    "contact": _things("contact"),
    "drives": _things("drives"),
    "probes": _things("probes"),
    "scheme": _things("scheme"),
    "contact_solve": _things("solve"),
    **dict.fromkeys(("pressure", "sound"), _things("sound", "one sound")),
    "speed": _things("speed"),
    "stops": _things("intervals"),
    "units": _plain("Pa", {"a": "N"}),
    "calibration": _plain(2.0, {"a": 1.0}),
    "channel": _plain("a"),
    "channels": _plain(["a"]),
    "decimal": _plain(".", ","),
    "correlations": _plain({("coefficient", "at"): 0.5}),
    "band": _plain((1e3, 5e3)),
    "kind": _plain("chaos", "kriging"),
    "intervals": _things("intervals"),
    "status": _STATUS,
    "limits": _things("thresholds"),
    "figure": _things("figure"),
    "found": _things("swept", "effects", "probability", "mac", "events", "mobilities"),
    "parameters": _plain(["coefficient"], ["friction"], ["slider.material.young"]),
    "masses": _plain({"tip": ("slider", "tip")}),
    "loci": _things("loci"),
    "stability": _things("stability"),
    "targets": _things("target"),
    "key": _plain("coefficient", "at"),
    "values": _plain([1.0, 1.2], {"coefficient": [1.0]}) + _things("array"),
    "variables": _plain(["normal_force"], ["normal_force", "status"]),
    "span": _plain((0.0, 0.01)),
    "listener": _plain((0.1, 0.2, 1.0), [(0.1, 0.2, 1.0)]),
    "frequency": _plain(1000.0),
    "rate": _plain(10e3),
    "sample_rate": _plain(100e3, 48000),
    "low": _plain(0.1),
    "high": _plain(2.0),
    "count": _plain(2),
    "direction": _plain("x", "y", 0.1),
    "position": _plain("tip", "centre", 0.1, (0.1, 0.1)),
}
