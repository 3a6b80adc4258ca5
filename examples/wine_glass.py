"""
Wine glass
==========

A wet finger on the rim of a wine glass: the growing mode, its limit cycle, and the beats that you hear. :doc:`../glass`
explains it.

This is the shipped scenario ``glass``. The glass turns below a finger at rest, as in Franklin's armonica; seen from the
glass, the finger goes round.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.signal import hilbert

import stridula as st
from stridula import plot

RIM, HEIGHT = 0.0325, 0.170
# Pressure of a plane wave over the velocity of the air [Pa s/m].
WAVE = 413.0
case = st.load_scenario("glass")
system = case.system
finger, glass = system.bodies
plot.save(plot.system(system), "bodies.png")
frequency, numbers = glass.modes().frequency, glass.numbers
for order in range(2, 5):
    rows = np.abs(glass.trace((RIM, 0.0, HEIGHT)))
    k, j = (int(np.flatnonzero((numbers == (order, 0, side)).all(axis=1))[0]) for side in (0, 1))
    print(f"{order} waves: {frequency[k]:.0f} Hz, along the rim over across it {rows[1, j] / rows[0, k]:.3f}")

# Linear theory: growth of the mode of two waves over the load.
for load in (0.1, 0.2, 0.5, 1.0):
    theory = st.sliding_stability(st.load_scenario("glass", {"drives.0.z": -load}).system)
    fastest = int(theory.growth_rate.values[theory.frequency.values > 0.0].argmax())
    grows = theory.isel(mode=theory.frequency.values > 0.0).isel(mode=fastest)
    print(f"{load} N: {float(grows.frequency):.1f} Hz grows by {float(grows.growth_rate):.1f} /s")
onset = st.critical_value("glass", "drives.0.z", -1.0, -0.05)
print(f"from {-float(onset.value):.3f} N on it grows, at {float(onset.frequency):.1f} Hz")

# In time: the finger is lifted after 1.2 s. Radial velocity where the rim vibrates most, and at a node.
places = [glass.at((RIM, angle, HEIGHT)) for angle in (0.0, np.pi / 4.0)]
probes = [st.Velocity(places[0], "x"), st.Velocity(places[1], "x"), st.Velocity(places[1], "y")]
lifted = st.Force(finger.centre, z=-1.0, history=st.Sampled((0.0, 1.2, 1.21), (1.0, 1.0, -0.3)))
run = st.simulate(st.System(system.contact, [lifted, system.drives[1]], system.connections), 2.0, probes=probes)
time, velocity = run.time.values, run.velocity.values
most, node = velocity[:, 0], (velocity[:, 1] + velocity[:, 2]) / np.sqrt(2.0)
rubbed = (time > 0.6) & (time < 1.2)
spectrum = np.abs(np.fft.rfft(most[rubbed] * np.hanning(rubbed.sum()), 1 << 20))
tone = float(np.fft.rfftfreq(1 << 20, time[1] - time[0])[spectrum.argmax()])
print(f"it sings at {tone:.1f} Hz; the rim moves by {np.abs(most[rubbed]).max():.2f} m/s")

# A point of the glass turns with it: its velocity is a combination of both modes of the pair.
turned = 2.0 * glass.turning * time
on_the_glass = np.cos(turned) * most + np.sin(turned) * node
sizes = {word: np.abs(hilbert(one)) for word, one in (("space", most), ("node", node), ("glass", on_the_glass))}

figure, panels = plt.subplots(1, 3, figsize=(12.0, 3.6), layout="constrained")
theory = st.sliding_stability(system)
growth = float(theory.growth_rate.max())
early = time < 0.2
panels[0].semilogy(time[early], np.abs(most[early]), linewidth=0.3, label="run")
first = (time > 0.04) & (time < 0.05)
size = np.abs(most[first]).max() * np.exp(-growth * time[first][np.abs(most[first]).argmax()])
panels[0].semilogy(time[early], size * np.exp(growth * time[early]), "k--", label="linear theory")
panels[0].set(xlabel="time [s]", ylabel="velocity across the rim [m/s]", ylim=(0.1 * size, 1.0))
panels[0].legend()
few = (time > 1.0) & (time < 1.005)
panels[1].plot(1e3 * (time[few] - 1.0), run.slip_velocity.values.reshape(time.size, -1)[few, 0])
panels[1].set(xlabel="time [ms]", ylabel="slip of the finger [m/s]")
panels[2].plot(time, sizes["glass"], label="point of the glass")
panels[2].plot(time, sizes["space"], label="point in space, eighth of a turn on")
panels[2].axvline(1.2, color="k", linestyle=":", label="finger lifted")
panels[2].set(xlabel="time [s]", ylabel="velocity across the rim [m/s]", ylim=(0.0, 0.42))
panels[2].legend(loc="upper right", fontsize="small")
figure.savefig("glass.png", dpi=110)

# %%
# The sound beside the glass, as of a plane wave from its wall.

pressure = (WAVE * run.velocity[:, 0]).assign_attrs(units="Pa")
st.listen(pressure)
