"""Files that pages assume, and checks of the results of their code."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import stridula as st

from .growing import unstable_frequencies
from .pages import ROOT, blocks

SCENARIOS = ROOT / "docs" / "scenarios.rst"


def pad(file: Path, first: str, second: str) -> None:
    """Write the body, with two points, that pages read from a file."""
    stiffness = np.kron([[1e6, -1e6], [-1e6, 1.1e6]], np.eye(2))
    st.ReducedBody(0.1 * np.eye(4), stiffness, {first: (0, 1), second: (2, 3)}).save(file)


def record(*names: str) -> None:
    """Write the records that pages assume."""
    run = st.load_scenario("squeal", {"duration": "20 ms"}).simulate()
    for name in names:
        st.save(run, name)


def recordings() -> None:
    """Write the recordings and the modes that pages assume."""
    shutil.copy(ROOT / "tests" / "unit" / "modes" / "block.frd", "block.frd")
    time = np.arange(int(25.6e3)) / 25.6e3
    tone = 0.3 * np.sin(2.0 * np.pi * 2300.0 * time)
    sound = xr.DataArray(tone, {"time": time}, ("time",), "microphone", {"units": "Pa"})
    st.write_signal("stop.wav", sound, full_scale=2.0)
    st.write_signal("rig.uff", sound)


# Files assumed in the folder of a reader.
GIVEN: dict[str, Callable[[], object]] = {
    "README.md": lambda: record("other.nc"),
    "command-line.rst": lambda: record("before.nc", "after.nc"),
    "measured.rst": recordings,
    "mesh-files.rst": lambda: shutil.copy(ROOT / "examples" / "tutorials" / "brake.inp", "brake.inp"),
    "scenarios.rst": lambda: (
        record("squeal.nc"),
        Path("my-squeal.toml").write_text(blocks(SCENARIOS, "toml")[0][1], encoding="utf-8"),
    ),
    "python.rst": lambda: pad(Path("pad.npz"), "tip", "back"),
}


def check_readme(names: Mapping[str, Any], printed: str) -> None:
    """The load adds a growing mode, through the slope of the bent track."""
    grows = unstable_frequencies(names["system"], sense=1.0).size + 1
    assert f"\n{grows} modes grow\n" in printed
    assert len(names["forces"]) == 4
    back, heard = st.read_wav("squeal.wav"), names["heard"]
    assert back.sizes["listener"] == 2
    # The file ends at 24 kHz, where little of the sound is left.
    assert float((back**2).mean()) == pytest.approx(float((heard**2).mean()), rel=0.05)


def check_python(names: Mapping[str, Any], printed: str) -> None:
    """The wall and its spring of 0.1 MN/m together hold the drag: at least the kinetic, at most the static friction."""
    reach = 1e5 * 1e-4
    stop = names["braked"].normal_force.sel(contact="stop", time=slice(0.02, None))
    assert 0.3 * 200.0 - reach < float(stop.mean()) < 0.5 * 200.0
    assert 0.0 < names["found"].sliding_mean <= 1.0
    assert names["swept"].sizes == {"friction": 3, "angle": 3}
    assert len(names["shares"]) == 20
    assert names["shares"][0] > names["shares"][-1]
    assert names["whole"].sizes["time"] == 2 * names["second"].sizes["time"]
    # Progress of the last run is shown to its end.
    assert printed.rstrip().endswith(" s of 1 s")


def check_start(names: Mapping[str, Any], printed: str) -> None:
    """More friction makes it squeal, and linear theory has the stated mode."""
    assert re.search(r"modes grow, at \[[\d. \n]*\b28\d\d\.", printed)
    assert re.findall(r"^(0\.8|1\.1) squeal$", printed, re.MULTILINE) == ["0.8", "1.1"]
    assert names["found"].sizes == {"friction": 4, "angle": 3}


def check_coming_from(names: Mapping[str, Any], printed: str) -> None:
    """The rig has one growing mode; a chain of springs is read back from its file."""
    assert re.findall(r"^(\d+) Hz, real part", printed, re.MULTILINE) == ["2273"]
    np.testing.assert_allclose(names["body"].modes().angular_frequency, [100.0, 200.0])
    assert names["run"].attrs["ended"] == "finished"


def check_maps(names: Mapping[str, Any], printed: str) -> None:
    """The travel in 50 ms falls by 2.8 mm per unit of friction, from 2.1 mm at 0.4."""
    assert names["table"].parameter.values[0] == "contact.friction.coefficient"
    assert 0.877 < float(names["onset"].value) < 0.878
    assert int(names["counts"].compared) == 12
    assert names["best"].met.values.tolist() == [True, True]
    assert 0.45 < float(names["best"].friction) < 0.53
    assert float(names["shares"].probability.sum()) == pytest.approx(1.0)
    growth = names["growth"]
    # The critical friction rises from 0.8779 to 0.8891 over the range of the damping.
    critical = np.interp(growth["slider.damping.ratio"].values, [0.003, 0.007], [0.8779, 0.8891])
    assert np.mean((growth.friction.values > critical) == (growth.unstable_modes.values > 0.0)) > 0.98
    assert int(names["lining"].failed) == 0


def check_measures(names: Mapping[str, Any], printed: str) -> None:
    """Each complete stop ends, and between stops it squeals."""
    assert len(names["lengths"]) > 0
    assert (names["lengths"] > 0.0).all()
    assert names["loudest"] > 1e3


def check_scenarios(names: Mapping[str, Any], printed: str) -> None:
    """The value that is set is in the system."""
    assert names["scenario"].system.contact.friction == st.Coulomb(1.2)


def check_sound(names: Mapping[str, Any], printed: str) -> None:
    """Two listeners hear a second."""
    assert dict(names["heard"].sizes) == {"time": 48_000, "listener": 2}


def check_surveys(names: Mapping[str, Any], printed: str) -> None:
    """The mode grows in time as in theory, up to the effect of the travel of the contact point."""
    this = names["this"]
    assert float(this.seen_growth_rate) == pytest.approx(float(this.growth_rate), rel=0.03)
    assert names["found"].verdict.sel(friction=0.6, angle=-60.0) == "stable"
    np.testing.assert_allclose(names["kicked"].kick.values, [0.46, 1.33, np.nan], rtol=0.01)


def check_cycles(names: Mapping[str, Any], printed: str) -> None:
    """Both cycles have their known periods, and the branch ends where sliding loses its stability."""
    assert float(names["cycle"].period) == pytest.approx(6.431383, rel=1e-4)
    assert float(names["other"].period) == pytest.approx(6.285167, rel=1e-4)
    assert printed.splitlines()[-3:-1] == ["grazing at 1.837 m/s", "Hopf at 1.151 m/s"]
    levels = st.harmonic_levels(names["pressure"]).isel(listener=0)
    assert float(levels[1]) == pytest.approx(17.8, abs=1.0)


def check_dynamics(names: Mapping[str, Any], printed: str) -> None:
    """The unstable cycle is that of the known branch, and both motions are found between the limits."""
    assert float(names["between"].displacement_amplitude[0]) == pytest.approx(1.2526, rel=1e-3)
    assert {"stable sliding", "stick-slip"} == set(names["found"].attractor_regime.values)


# Checks of at least one number, for pages that print any.
CHECKS: dict[str, Callable[[Mapping[str, Any], str], None]] = {
    "README.md": check_readme,
    "cycles.rst": check_cycles,
    "dynamics.rst": check_dynamics,
    "maps.rst": check_maps,
    "measures.rst": check_measures,
    "scenarios.rst": check_scenarios,
    "sound.rst": check_sound,
    "start.rst": check_start,
    "coming-from.rst": check_coming_from,
    "python.rst": check_python,
    "surveys.rst": check_surveys,
}
WRITTEN = {
    "cycles.rst": {"branch.png", "glass.wav"},
    "dynamics.rst": {"basin.png", "orbits.png"},
    "hearing.rst": {"ears.wav", "spectrogram.png", "spectrum.png", "squeal.gif"},
    "maps.rst": {"effects.png", "map.png", "probability.png", "root-loci.png"},
    "surveys.rst": {"survey.nc", "survey.png"},
}
