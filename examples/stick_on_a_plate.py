"""
A stick on a plate
==================

A steel stick is pushed across a plate of steel and squeals: the sound of the plate in time, and its directions. This is
the shipped scenario ``squeal-on-plate``.
"""

import numpy as np

import stridula as st
from stridula import plot

scenario = st.load_scenario("squeal-on-plate")
system, plate = scenario.system, scenario.system.track
plot.save(plot.system(system), "bodies.png")
run = scenario.simulate(duration=0.4)
print(f"{st.regime(run).regime.item()}; plate with {plate.modes().count} modes")
plot.save(plot.overview(run), "stick-on-a-plate.png")

# %%
# The sound at two ears a metre above the plate, in a wall flush with it.

heard = st.radiate(run, system)
print(f"{float(st.equivalent_level(heard, 'A').max()):.0f} dB")
st.listen(heard)

# %%
# Levels on a half-circle of 2 m about the middle of the plate.

middle = np.array([plate.length / 2.0, plate.width / 2.0, 0.0])
angles = np.radians(np.arange(15.0, 180.0, 15.0))
listeners = middle + 2.0 * np.stack([np.cos(angles), 0.0 * angles, np.sin(angles)], axis=1)
around = st.radiate(run, system, listeners.tolist())
levels = st.equivalent_level(around, "A").values
print(f"from {levels.min():.0f} to {levels.max():.0f} dB at 2 m")
shown = plot.directivity(around, centre=middle.tolist(), plane="xz", bands=(500.0, 1000.0, 2000.0, 4000.0))
plot.save(shown, "directivity.png")
