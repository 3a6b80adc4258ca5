"""A script as users write it: the ten lines, then scenarios, a sweep, linear theory and sound, each with its type."""

from math import radians
from typing import Any, assert_type

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

import stridula as st
from stridula import analysis, plot

SHORT = 0.06

steel, strip = st.Material(young=2.1e11, density=7800.0), st.Rectangle(width=0.020, height=0.0092)
rod = st.FiniteElementBeam(steel, strip, length=0.572, angle=radians(-45), damping=0.0075, cutoff=15e3)
track = st.ModalBeam(steel, strip, length=1.386, damping=0.0075, cutoff=15e3)
contact = st.PointContact(rod.tip, track, at=0.369, friction=st.Coulomb(1.1))
system = st.System(contact, [st.ImposedVelocity(rod.root, velocity=0.01, normal_load=50.0)])
run = assert_type(st.simulate(system, duration=SHORT), xr.Dataset)
assert_type(analysis.bursts(run), NDArray[Any])
assert_type(analysis.dominant_frequency(run.normal_force), float)
assert_type(plot.overview(run), Figure)
plot.save(plot.overview(run), "run.png")
assert_type(st.regime(run), xr.Dataset)
assert_type(st.sliding_stability(system), xr.Dataset)
assert_type(rod.tip, st.BodyPoint)
assert_type(track.modes().angular_frequency, NDArray[Any])

runs = st.simulate_many([system, system], SHORT)
assert_type(runs, list[xr.Dataset])
peaks = st.simulate_many([system, system], SHORT, lambda one: float(one.normal_force.max()))
assert_type(peaks, list[float])

scenario = assert_type(st.load_scenario("squeal", {"contact.friction.coefficient": 1.2}), st.Scenario)
again = assert_type(scenario.simulate(duration=SHORT), xr.Dataset)
st.save(again, "again.nc")
assert_type(st.load("again.nc"), xr.Dataset)
assert_type([case.title for case in st.list_scenarios()], list[str])


def pulled(friction: float) -> st.System:
    touching = st.PointContact(rod.tip, track, at=0.369, friction=st.Coulomb(friction))
    return st.System(touching, [st.ImposedVelocity(rod.root, velocity=0.01, normal_load=50.0)])


swept = assert_type(
    st.sweep(pulled, {"friction": np.array([0.4, 0.8])}, ["mean_force"], duration=SHORT, workers=1), xr.Dataset
)
st.sweep("squeal", st.Grid({"friction": [0.5, 1.0]}), ["regime"], duration=SHORT, workers=1)

heard = assert_type(st.radiate(run, track), xr.DataArray)
written = assert_type(st.write_wav("run.wav", heard), st.SoundFile)
assert_type(written.sample_rate, int)
assert_type(st.read_wav("run.wav"), xr.DataArray)
assert_type(st.sound_level(heard), xr.DataArray)
st.write_signal("heard.csv", heard.isel(listener=0))
assert_type(st.read_signals("heard.csv"), xr.Dataset)
measured = assert_type(st.read_signal("heard.csv"), xr.DataArray)
assert_type(st.squeal_events(measured, highest=8e3, threshold=20.0), xr.Dataset)
assert_type(analysis.vibration_bursts(measured), NDArray[Any])

try:
    st.Coulomb(-1.0)
except st.ArgumentError as refused:
    assert_type(refused.argument, str)
