"""
A lining, from the bench to the squeal
======================================

Friction measured over speed and temperature, the temperatures at which a brake squeals, and a stop through them.

The bench gives :download:`lining.csv </_generated/examples/gallery/lining.csv>`: the lining grips best when it is warm,
and fades when it is hot. The brake is the smallest that squeals by mode coupling, after Hoffmann, Fischer, Allgaier and
Gaul (2002): a pad on two inclined springs, pressed on a surface through the stiffness of its lining.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import stridula as st
from stridula import plot

HERE = Path(__file__).parent if "__file__" in globals() else Path()
lining = st.FrictionOverTemperature.read(HERE / "lining.csv", ("speed [m/s]", "coefficient", "temperature [degC]"))
plot.save(plot.friction(lining, np.linspace(0.0, 6.0, 200)), "lining.png")

UNIT, SPEED, LOAD = 4.4e6, 3.0, 2000.0
# Pressure of a plane wave over the velocity of the air [Pa s/m].
WAVE = 413.0
pad = st.PointMass(1.0, name="pad")


def brake(start: float) -> st.System:
    """The pad in steady sliding, its lining at a temperature [degC] at the start; a third of the heat goes into it."""
    layers = st.HeatedLayers.slab(
        2e-3,
        thickness=0.01,
        conductivity=1.2,
        density=2500.0,
        specific_heat=900.0,
        transfer=30.0,
        initial=start,
        share=0.3,
    )
    contact = st.PointContact(
        pad.centre, st.RigidTrack(velocity=-SPEED), friction=lining, stiffness=11.0 * UNIT, heating=layers
    )
    held = [
        st.Spring(pad.centre, stiffness=factor * UNIT, direction=(np.cos(angle), np.sin(angle), 0.0))
        for factor, angle in ((11.0, np.radians(150.0)), (20.0, np.radians(30.0)))
    ]
    held += [st.Dashpot(pad.centre, coefficient=30.0, direction=way) for way in ("x", "y")]
    return st.System(contact, [st.Force(pad.centre, y=-LOAD), st.InitialEquilibrium("sliding")], held)


# Linear theory takes the friction of the temperature at the start.
temperatures = np.linspace(20.0, 400.0, 39)
growth = np.array([float(st.sliding_stability(brake(one)).growth_rate.max()) for one in temperatures])
squeals = temperatures[growth > 0.0]
print(f"a mode grows from {squeals[0]:.0f} to {squeals[-1]:.0f} degC")

# A drag stop warms the lining through them. A push of 1 N keeps the pad moving, as the road does.
warming = brake(20.0)
rumble = st.Force(pad.centre, y=1.0, history=st.Harmonic(frequency=80.0))
run = st.simulate(st.System(warming.contact, [*warming.drives, rumble], warming.connections), 4.0)

figure, (theory, stop, warmth) = plt.subplots(3, 1, figsize=(7.0, 8.0), layout="constrained")
theory.plot(temperatures, growth)
theory.axhline(0.0, color="0.6", linewidth=0.6)
theory.set(xlabel="temperature of the lining [degC]", ylabel="largest growth rate [1/s]")
stop.plot(run["time"], run["normal_force"], linewidth=0.3)
stop.set(ylabel="normal force [N]", xlim=(0.0, 4.0))
warmth.plot(run["time"], run["temperature"])
warmth.axhspan(squeals[0], squeals[-1], alpha=0.2, label="a mode grows")
warmth.set(xlabel="time [s]", ylabel="temperature of the face [degC]", xlim=(0.0, 4.0))
warmth.legend(loc="lower right")
figure.savefig("stop.png")
for begin, end in ((0.0, 0.1), (0.5, 0.6), (1.5, 1.6), (3.9, 4.0)):
    part = run.sel(time=slice(begin, end))
    print(f"{begin} to {end} s, {float(part.temperature.mean()):.0f} degC: {st.regime(part).regime.item()}")

# %%
# The squeal comes and goes with the temperature: the sound before the pad, as of a plane wave from its end.

pressure = (WAVE * (run.slip_velocity - run.slip_velocity.mean("time"))).assign_attrs(units="Pa")
st.listen(pressure)
