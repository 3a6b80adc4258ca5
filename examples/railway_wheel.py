"""
Railway wheel
=============

A railway wheel that squeals in a curve: the growing modes, standing and rolling, and the limit cycle. :doc:`../wheel`
explains it.

This is the shipped scenario ``wheel``. The rim creeps sideways over a rail point; it does not slip along the rail,
because the rail moves below the hub as the wheel turns.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.signal import butter, hilbert, sosfiltfilt

import stridula as st
from stridula import plot

RADIUS, CREEP = 0.46, "contacts.0.surface_velocity.0"
# Pressure of a plane wave over the velocity of the air [Pa s/m].
WAVE = 413.0
STANDING = {"turning": 0.0, "contacts.0.surface_velocity.1": 0.0}
case = st.load_scenario("wheel")
system, wheel = case.system, case.system.contact.tip.body
frequency, numbers = wheel.modes().frequency, wheel.numbers
plot.save(plot.system(system), "bodies.png")


def growing(changes: dict[str, object], near: float) -> str:
    """The growing modes near a frequency, as text."""
    theory = st.sliding_stability(st.load_scenario("wheel", changes).system)
    here = theory.unstable.values & (np.abs(theory.frequency.values / near - 1.0) < 0.02)
    found = zip(theory.frequency.values[here], theory.growth_rate.values[here], strict=True)
    return ", ".join(f"{hertz:.0f} Hz by {growth:.0f} /s" for hertz, growth in found) or "none"


print(f"{wheel.total_mass:.0f} kg")
for order in range(2, 6):
    mode = int(np.flatnonzero((numbers == (order, 0, 0)).all(axis=1))[0])
    hertz = frequency[mode]
    print(f"{order} nodal diameters: {hertz:.0f} Hz; standing {growing(STANDING, hertz)}; rolling {growing({}, hertz)}")

# Limit cycle below the hub, and a quarter of a wavelength further round for two nodal diameters.
angles = -np.pi / 2.0, -np.pi / 4.0
probes = [st.Velocity(wheel.at((RADIUS, angle, 0.0)), "z") for angle in angles]
run = st.simulate(system, 1.5, sample_rate=5e4, probes=probes)
time, velocity = run.time.values, run.velocity.values
late = time > 0.5
spectrum = np.abs(np.fft.rfft(velocity[late, 0] * np.hanning(late.sum()), 1 << 18))
hertz = np.fft.rfftfreq(1 << 18, 2e-5)
tone = float(hertz[spectrum.argmax()])
band = butter(4, [0.8 * tone, 1.2 * tone], "bandpass", fs=5e4, output="sos")
here, further = (hilbert(sosfiltfilt(band, one))[late][2500:-2500] for one in velocity.T)
ahead, back = (np.abs(here + sign * 1j * further).mean() / 2.0 for sign in (1.0, -1.0))
print(f"it squeals at {tone:.1f} Hz: a wave of {back:.3f} m/s against the turning, one of {ahead:.3f} m/s with it")

figure, panels = plt.subplots(1, 3, figsize=(12.0, 3.6), layout="constrained")
loci = st.root_loci("wheel", CREEP, np.linspace(0.05, 1.5, 30), highest=3000.0)
for mode in loci.mode.values:
    one = loci.sel(mode=mode)
    if float(one.growth_rate.max()) > 12.0:
        panels[0].plot(loci[CREEP], one.growth_rate, label=f"{float(one.frequency.mean()):.0f} Hz")
panels[0].axhline(0.0, color="k", linewidth=0.5)
panels[0].set(xlabel="lateral creep [m/s]", ylabel="growth [1/s]", ylim=(-10.0, None))
panels[0].legend(fontsize="small")
early = time < 0.15
growth = float(st.sliding_stability(system).growth_rate.max())
panels[1].semilogy(time[early], np.abs(velocity[early, 0]), linewidth=0.4, label="run")
first = (time > 0.02) & (time < 0.03)
peak = int(np.abs(velocity[first, 0]).argmax())
size = np.abs(velocity[first, 0])[peak] * np.exp(-growth * time[first][peak])
panels[1].semilogy(time[early], size * np.exp(growth * time[early]), "k--", label="linear theory")
panels[1].set(xlabel="time [s]", ylabel="velocity of the rim [m/s]", ylim=(0.1 * size, 1.0))
panels[1].legend()
panels[2].plot(hertz / 1e3, 20.0 * np.log10(spectrum / spectrum.max()), linewidth=0.6)
panels[2].set(xlabel="frequency [kHz]", ylabel="limit cycle [dB]", xlim=(0.0, 5.0), ylim=(-60.0, 5.0))
figure.savefig("wheel.png", dpi=110)

# %%
# The sound beside the wheel, as of a plane wave from its wall.

pressure = (WAVE * run.velocity[:, 0]).assign_attrs(units="Pa")
st.listen(pressure)
