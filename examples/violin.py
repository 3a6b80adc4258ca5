"""
Violin
======

The G string of a violin under a bow: Helmholtz motion, and Schelleng's diagram of the bow forces that sustain it.
:doc:`../violin` explains it.

The shipped scenario ``violin`` has a bow 8 mm wide; the diagram is that of a narrow one, to which the theory applies.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import stridula as st
from stridula import analysis, plot

scenario = st.load_scenario("violin")
string, law = scenario.system.contacts[0].track.body, scenario.system.contacts[0].friction
FUNDAMENTAL, SPEED = float(string.modes().frequency[0]), 0.2
IMPEDANCE = string.tension / (2.0 * string.length * FUNDAMENTAL)
CONTRAST = law.static - law.kinetic
# Loss of a corner in a period as a resistance at the bridge, from the damping of the fundamental.
DECAY = 0.5 * float(string.modes().damping_rate[0])
RESISTANCE = 2.0 * IMPEDANCE * FUNDAMENTAL / DECAY
# Torsional waves, 5.2 times as fast as transverse ones, on a round string.
TORSION = 0.5 * 5.2 * IMPEDANCE

plot.save(plot.system(scenario.system), "bodies.png")

# The scenario: its motion, its sound, and where the string slips.
run = scenario.simulate()
found = analysis.bowed_motion(run, FUNDAMENTAL)
print(f"{found.motion.item()} motion at {float(found.frequency):.1f} Hz, of a string of {FUNDAMENTAL:.1f} Hz")
print(f"{float(found.slips_per_period):.3f} slips a period, for {float(found.slip_share):.3f} of the time")
late = run.sel(time=slice(0.5, None))
slips = late.status_share.sel(contact="hair 3", contact_status="sliding").values > 0.99
slip = float(np.median(late.velocity.values[slips, 0]))
print(f"velocity in the slips {slip:.3f} m/s, theory {-SPEED * (1.0 - 0.12) / 0.12:.3f} m/s")
# The force on the bridge drives a flat top of spruce, which a listener hears a metre above it.
top = st.ModalPlate(st.Material(8e9, 430.0, 0.3), 3e-3, 0.35, 0.2, cutoff=10e3, damping=0.01, name="top")
heard = st.radiate(run, st.Bridge(top.at((0.19, 0.1))), (0.17, 0.1, 1.0))
st.write_wav("violin.wav", heard)
print(f"through a top of spruce {float(st.equivalent_level(heard, 'A').max()):.0f} dB at a metre")
st.listen(heard)

# %%
# Schelleng's diagram: the bow force changes slowly from that of a note to another value, and stays there.


def most(place: float) -> float:
    """Schelleng's maximal bow force [N]."""
    return 2.0 * IMPEDANCE * SPEED / (place * CONTRAST)


def least(place: float) -> float:
    """Schelleng's minimal bow force [N]."""
    return IMPEDANCE**2 * SPEED / (2.0 * RESISTANCE * place**2 * CONTRAST)


def bowed(place: float, before: float, after: float) -> st.System:
    """The string under a narrow bow at a fraction of its length, whose force [N] changes from 0.4 s to 0.6 s."""
    hair = st.PointMass(1e-6, name="hair")
    point = string.at(place * string.length)
    contact = st.PointContact(
        hair.centre, point, friction=law, inclination=np.pi / 2.0, surface_velocity=-SPEED, name="hair"
    )
    twist = TORSION * 5.2 * 2.0 * FUNDAMENTAL * (1.0 / place + 1.0 / (1.0 - place))
    held = [
        st.Spring(hair.centre, stiffness=twist, direction="y"),
        st.Dashpot(hair.centre, coefficient=2.0 * TORSION, direction="y"),
    ]
    history = st.Sampled([0.0, 0.4, 0.6, 1.0], [before / after, before / after, 1.0, 1.0])
    return st.System(contact, [st.Force(hair.centre, x=after, history=history)], held)


def note(place: float) -> tuple[float, xr.Dataset]:
    """Bow force [N] and record of an attack that settles in Helmholtz motion."""
    for share in (0.6, 0.5, 0.55, 0.65, 0.45, 0.4, 0.7, 0.3, 0.8):
        force = share * most(place)
        played = st.simulate(bowed(place, force, force), 0.4, sample_rate=48e3, probes=[])
        if analysis.bowed_motion(played, FUNDAMENTAL).motion == analysis.MOTIONS[0]:
            return force, played
    raise RuntimeError(f"no attack at {place:g} of the length settles in Helmholtz motion")


PLACES, SHARES = np.geomspace(0.06, 0.2, 7), np.geomspace(0.004, 4.0, 13)
motions = []
for place in PLACES:
    before, played = note(place)
    for share in SHARES:
        system = bowed(place, before, share * most(place))
        kept = st.simulate(system, 0.6, start=played, sample_rate=48e3, probes=[])
        motions.append((place, share * most(place), analysis.bowed_motion(kept, FUNDAMENTAL).motion.item()))

helmholtz = [(place, force) for place, force, motion in motions if motion == "Helmholtz"]
below = [(place, force) for place, force, _ in motions if force < most(place)]
between = [(place, force) for place, force in below if force > least(place)]
right = sum(one in between for one in helmholtz)
print(f"{len(helmholtz)} of {len(motions)} notes in Helmholtz motion, {right} of them between Schelleng's limits")
print(f"{right} of {len(between)} notes between the limits are in Helmholtz motion")
highest = [max(force for at, force in helmholtz if at == place) / most(place) for place in PLACES]
lowest = [min(force for at, force in helmholtz if at == place) / least(place) for place in PLACES]
print(f"highest force of Helmholtz motion over Schelleng's: {min(highest):.2f} to {max(highest):.2f}")
print(f"lowest force of Helmholtz motion over Schelleng's: {min(lowest):.1f} to {max(lowest):.1f}")

figure, panels = plt.subplots(1, 2, figsize=(11.0, 4.2), layout="constrained")
last = run.sel(time=slice(1.0 - 4.0 / FUNDAMENTAL, None))
panels[0].plot(1e3 * last.time, last.velocity[:, 0], linewidth=0.8, label="string under the bow [m/s]")
panels[0].plot(1e3 * last.time, last.support_force[:, 0], linewidth=0.8, label="force on the bridge [N]")
panels[0].axhline(SPEED, color="k", linestyle=":", linewidth=0.8)
panels[0].set(xlabel="time [ms]", title="Bow 8 mm wide, at 0.12 of the length")
panels[0].legend(loc="center left", fontsize="small")
marks = {"Helmholtz": "o", "double slip": "v", "multiple slip": "1", "raucous": "x", "anomalous low": "s"}
for word, mark in marks.items():
    chosen = np.array([(place, force) for place, force, motion in motions if motion == word])
    if chosen.size:
        panels[1].loglog(*chosen.T, mark, markersize=5, label=word)
panels[1].loglog(PLACES, [most(place) for place in PLACES], "k-", linewidth=1.0, label="Schelleng, most")
panels[1].loglog(PLACES, [least(place) for place in PLACES], "k--", linewidth=1.0, label="Schelleng, least")
panels[1].set(
    xlabel="place of the bow [lengths]", ylabel="bow force [N]", title="Narrow bow, 0.2 m/s", ylim=(2e-3, 1e2)
)
panels[1].set_xticks([0.06, 0.1, 0.2], ["0.06", "0.1", "0.2"], minor=False)
panels[1].xaxis.set_minor_formatter("")
panels[1].legend(loc="upper right", ncols=2, fontsize="small")
figure.savefig("violin.png", dpi=110)
