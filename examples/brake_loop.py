"""
A design loop on a brake
========================

From a brake that squeals to one that does not: where a mass helps, how small it may be, and whether the brake is quiet.

The brake is the shipped scenario ``brake``; :doc:`../brake` explains it. A mass is bolted to the back of its upper pad,
near the corner where the disc enters, or elsewhere. :func:`stridula.smallest_change` searches for the least mass with
which no mode grows at any friction up to that given, and runs from a kick show that the vibration then decays, as fast
as in linear theory.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import stridula as st

case = st.load_scenario("brake")
brake, FRICTION, SQUEAL, BACK = case.system, 0.45, 2822.0, 0.0259999
pad = next(body for body in brake.bodies if body.name == "upper pad")
disc = next(body for body in brake.bodies if body.name == "disc")
# Places on the back of the pad [m], with the first one where the disc enters.
PLACES = {"entry": (-0.045, BACK, 0.114), "middle": (0.0, BACK, 0.114), "exit": (0.045, BACK, 0.114)}
LARGEST, FRICTIONS = 0.12, (0.05, FRICTION)


def with_mass(mass: float, place: str = "entry", friction: float = FRICTION) -> st.System:
    """The brake with a mass [kg] on its upper pad."""
    added = [(pad.at(PLACES[place]), mass)] if mass > 0.0 else []
    return st.modify(brake, masses=added, friction=st.Coulomb(friction))


# %%
# Where a mass helps
# ------------------
#
# Growth of the fastest mode over the mass. In the middle of the pad each mass makes it worse; at the entry a larger
# mass than needed lets another mode grow, at 6.4 kHz.

masses = np.array([0.0, 0.03, 0.06, 0.09, LARGEST])
growth = {
    place: [float(st.sliding_stability(with_mass(mass, place)).growth_rate.max()) for mass in masses]
    for place in PLACES
}
for place, rates in growth.items():
    print(
        f"{place}: " + ", ".join(f"{1e3 * mass:.0f} g {rate:.1f} /s" for mass, rate in zip(masses, rates, strict=True))
    )

figure, axes = plt.subplots(figsize=(7.0, 3.6), layout="constrained")
for place, rates in growth.items():
    axes.plot(1e3 * masses, rates, "o-", label=place)
axes.axhline(0.0, color="k", linewidth=0.5)
axes.set(xlabel="mass on the back of the upper pad [g]", ylabel="fastest growth [1/s]")
axes.legend()
figure.savefig("brake-loop-growth.png", dpi=110)

# %%
# The smallest mass
# -----------------
#
# At the corner where the disc enters, and with every mode decaying by at least 1 /s at all frictions up to that given.

found = st.smallest_change(
    with_mass, {"mass": (0.0, LARGEST)}, {"friction": FRICTIONS}, start={"mass": 0.0}, margin=1.0, points=3, most=50
)
least = float(found.changed[0])
print(found.attrs["verdict"])
print(f"least mass: {1e3 * least:.1f} g on a pad of {1e3 * pad.total_mass:.0f} g")

# %%
# In time
# -------
#
# Each brake starts in equilibrium, kicked by 0.1 um of the mode of its squeal: that near 2.8 kHz which grows fastest or
# decays least. The vibration of the heavier brake decays at each friction, at the rate of linear theory.

rim = [st.Velocity(disc.at((0.13, 0.0, 0.0)), "y")]
runs, rates = {}, {}


def rate_in_time(run: xr.Dataset, frequency: float) -> float:
    """Growth rate [1/s] of a vibration from its size in the first and the last quarter of a run."""
    sizes, count = [], run.sizes["time"] // 4
    for part in (slice(0, count), slice(-count, None)):
        time, motion = run.time.values[part], run.velocity.values[part, 0]
        phase = 2.0 * np.pi * frequency * time
        basis = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)
        sizes.append((time.mean(), np.hypot(*np.linalg.lstsq(basis, motion, rcond=None)[0][:2])))
    (first, early), (last, late) = sizes
    return float(np.log(late / early) / (last - first))


for mass, frictions in ((0.0, (FRICTION,)), (least, (0.15, 0.3, FRICTION))):
    for friction in frictions:
        theory = st.sliding_stability(with_mass(mass, friction=friction), time=0.0)
        mode = int(np.argmax(theory.growth_rate.where(abs(theory.frequency - SQUEAL) < 200.0, -np.inf).values))
        drives = [one for one in brake.drives if isinstance(one, st.Force)]
        start = st.InitialEquilibrium(mode=mode, amplitude=1e-7)
        system = with_mass(mass, friction=friction)
        run = st.simulate(st.System(system.contact, [*drives, start], system.connections), 0.03, probes=rim)
        runs[mass, friction] = run
        rate, frequency = float(theory.growth_rate[mode]), float(theory.frequency[mode])
        in_time = rate_in_time(run, frequency)
        rates[mass, friction] = rate, in_time
        print(f"{1e3 * mass:.1f} g, friction {friction}: {rate:.2f} /s at {frequency:.0f} Hz, in time {in_time:.2f} /s")

figure, axes = plt.subplots(figsize=(7.0, 3.6), layout="constrained")
for mass, words in ((0.0, "as it is"), (least, f"with {1e3 * least:.0f} g")):
    run = runs[mass, FRICTION]
    axes.plot(1e3 * run.time, 1e3 * run.velocity[:, 0], linewidth=0.5, label=words)
axes.set(xlabel="time [ms]", ylabel="velocity of the rim [mm/s]")
axes.legend()
figure.savefig("brake-loop-time.png", dpi=110)

# %%
# Both on one page
# ----------------
#
# ``stridula report`` does the same with two scenarios. The runs are those above.

options = {"sound": False, "effects": False, "check": False, "values": [0.15, 0.3, FRICTION]}
titles = ["Brake as it is", f"Brake with {1e3 * least:.0f} g on its upper pad"]
page = st.report(runs[0.0, FRICTION], runs[least, FRICTION], titles=titles, key="friction.coefficient", **options)
page.save("brake-loop.html")
print(f"{len(page.html) / 1e6:.1f} MB on {' and '.join(page.titles)}")
