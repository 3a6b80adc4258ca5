"""
A tribometer, from its files to a model
=======================================

A pin on a flexible holder rubs on a disc. The laboratory has a folder with three files: slip tests, a modal test of the
holder, and a recording of a run that judders. From these alone comes a model that judders as the rig does, with the
uncertainty of what the files do not tell.
"""

# %%
# The folder
# ----------
# Here a rig with a known friction writes it: static coefficient 0.45, falling to 0.3 over 0.04 m/s. The rest of the
# page reads files only.

import numpy as np
import xarray as xr

import stridula as st
from stridula import analysis, plot

TRUE, noise = st.Stribeck(0.45, 0.3, 0.04), np.random.default_rng(0)
SHAPES = [[[2.2, -0.2, 2.5], [0.15, 3.0, 0.4], [0.0, 0.0, 0.0]], [[1.3, -0.1, 1.5], [0.1, 1.8, 0.2], [0.0, 0.0, 0.0]]]
test = st.MeasuredModes(
    [86.0, 412.0, 655.0],
    [0.004, 0.006, 0.005],
    SHAPES,
    ["1", "2"],
    "unit modal mass",
    [(0.0, 0.0, 0.0), (0.0, 0.05, 0.0)],
)
test.write("holder.unv")


def rig(holder: st.ModalBody, law: st.FrictionLaw, speed: float = 0.05, load: float = 12.0) -> st.System:
    """The pin on the disc."""
    contact = st.PointContact(holder.at("pin"), st.RigidTrack(velocity=speed), friction=law)
    return st.System(contact, [st.Force(holder.at("pin"), y=-load)])


POINTS = {"pin": "1", "accelerometer": "2"}
holder = st.ModalBody.read("holder.unv", points=POINTS)
settings = {"duration": 1.5, "sample_rate": 10e3, "probes": [st.Acceleration(holder.at("accelerometer"), "x")]}
run = st.simulate(rig(holder, TRUE), **settings)
shaking = run["acceleration"].isel(acceleration_probe=0)[3000:]
shaking = shaking + 0.02 * float(shaking.std()) * noise.standard_normal(shaking.size)
shaking = xr.DataArray(shaking.values, {"time": shaking["time"].values}, ("time",), attrs={"units": "m/s2"})
st.write_signal("run.wav", shaking, full_scale=500.0)
speed = np.linspace(0.06, 0.4, 200)
pull = 12.0 * np.array([TRUE.coefficient_at(one) for one in speed]) + 0.05 * noise.standard_normal(200)
columns = {"speed": ("time", speed, {"units": "m/s"}), "pull": ("time", pull, {"units": "N"})}
st.write_signal("slip.csv", xr.Dataset(columns, {"time": np.arange(200) / 10.0}))

# %%
# Friction from the slip tests
# ----------------------------
# Steady sliding is possible above 0.06 m/s only. There the curve has nearly fallen: the fit knows the kinetic
# coefficient, and extrapolates the static one.

slip = st.read_signals("slip.csv")
fit = st.fit_friction(slip["speed"].values, slip["pull"].values / 12.0)
print(fit.law)

# %%
# The holder, and the recording
# -----------------------------
# The modes of the holder come from its test. The accelerometer hears the seventh harmonic of some cycles best; a
# vibration alone does not tell for certain whether that is squeal.

holder = st.ModalBody.read("holder.unv", points=POINTS)
recording = st.read_signal("run.wav")
regime = analysis.vibration_regime(recording)
print(f"{regime.regime.item()}, confidence {regime.confidence.item():.2f}; unknown: {regime.attrs['unknown']}")

# %%
# The model held against the recording
# ------------------------------------
# The static coefficient and the speed over which friction falls are sought, the kinetic coefficient is that of the slip
# tests.


def model(static: float, velocity: float) -> tuple[st.System, dict[str, object]]:
    """The rig with a friction that is sought."""
    return rig(holder, st.Stribeck(static, fit.law.kinetic, velocity)), settings


found = st.calibrate_to(recording, model, {"static": (0.31, 0.8), "velocity": (0.01, 0.15)}, signal="acceleration")
print(found[["value", "low", "high", "determined"]].to_dataframe().round(3))
print(found[["measured", "computed", "error"]].to_dataframe().round(2))
plot.calibration(found)

# %%
# What the model says beyond the recording: the speed of the disc from which the rig slides steadily.

best = st.Stribeck(float(found["value"][0]), fit.law.kinetic, float(found["value"][1]))
regimes = {}
for speed in (0.02, 0.04, 0.06, 0.08, 0.1, 0.2):
    runs = [st.simulate(rig(holder, law, speed), **settings) for law in (best, TRUE)]
    regimes[speed] = [analysis.regime(one).regime.item() for one in runs]
    print(f"{speed:.2f} m/s: {regimes[speed][0]}; the rig itself: {regimes[speed][1]}")
