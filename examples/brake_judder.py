"""
Judder of a brake
=================

Why does the steering wheel shake at one speed of a stop? The thickness of the disc varies by a few micrometres, twice
in a turn. The force on the pad varies with it, and so does the torque, which finds the resonance of the axle on its
rubber. Here the disc slows down from 100 to 20 rad/s in two seconds, and the axle vibrates at 16 Hz.
"""

import matplotlib.pyplot as plt
import numpy as np

import stridula as st

STEEL, LINING = st.Material(2.1e11, 7800.0, 0.3), st.Material(4e9, 2500.0, 0.25)
FAST, SLOW, STOP, LOAD, FRICTION = 100.0, 20.0, 2.0, 2e3, 0.4
CALIPER, AXLE_MASS, AXLE = 2e7, 20.0, 2e5  # Stiffness along the axis [N/m]; mass [kg] and stiffness [N/m] of the axle.
RADIUS = 0.105

disc = st.AxisymmetricBody(
    st.RectangleProfile({"disc": ((0.06, 0.13), (-0.02, 0.0))}),
    STEEL,
    cutoff=5e3,
    held="inner",
    damping=0.01,
    axis=(0.0, 1.0, 0.0),
    turning=FAST,
    turning_history=st.Sampled((0.0, STOP), (1.0, SLOW / FAST)),
    name="disc",
)
lining = st.SolidMesh.block((0.06, 0.012, 0.04), (3, 1, 2)).moved((-0.03, 0.0, RADIUS - 0.02))
pad = st.SolidBody(lining, LINING, cutoff=6e3, damping=0.05, contact_faces={"bottom": (3, 2)}, name="pad")
axle = st.PointMass(AXLE_MASS, "axle")


def braked(variation: float) -> st.System:
    """The brake with a disc whose thickness varies by an amplitude [m], twice in a turn."""
    face = st.SurfaceContact(
        pad,
        "bottom",
        disc,
        friction=st.Coulomb(FRICTION),
        stiffness=3e10,
        run_out=st.RunOut.waves({2: variation}) if variation else None,
        name="lining",
    )
    back, ends = pad.at("top"), [pad.at((x, 0.012, RADIUS)) for x in (-0.025, 0.025)]
    guides = [st.Spring(end, axle.centre, stiffness=3e7) for end in ends]
    guides += [st.Spring(end, stiffness=3e7, direction="z") for end in ends]
    # Rubber that keeps the brake from squealing.
    guides += [st.Dashpot(end, coefficient=4e3, direction=axis) for end in ends for axis in "yz"]
    caliper = [st.Spring(back, stiffness=CALIPER, direction="y"), st.Dashpot(back, coefficient=2e3, direction="y")]
    mount = [st.Spring(axle.centre, stiffness=AXLE), st.Dashpot(axle.centre, coefficient=2e2)]
    drives = [st.Force(back, y=-LOAD), st.InitialEquilibrium()]
    return st.System(face, drives, [*guides, *caliper, *mount])


probes = [st.Displacement(axle.centre, "x")]
runs = {
    f"{1e6 * variation:.0f} µm": st.simulate(braked(variation), STOP, step=2e-5, sample_rate=2e3, probes=probes)
    for variation in (0.0, 15e-6)
}
even, uneven = runs.values()
time = uneven.time.values
speed = FAST + (SLOW - FAST) * time / STOP
torque = {name: RADIUS * np.abs(run.tangential_force.values[:, 0]) for name, run in runs.items()}
moved = 1e3 * (uneven.displacement.values[:, 0] - even.displacement.values[:, 0])
worst = float(speed[np.abs(moved).argmax()])
places = worst / np.pi
print(f"the axle shakes most at {worst:.0f} rad/s, {places:.1f} thick places a second: {np.abs(moved).max():.2f} mm")

figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.8), layout="constrained")
for name, values in torque.items():
    left.plot(time, values, linewidth=0.8, label=name)
left.set(xlabel="time [s]", ylabel="torque of one pad [N m]", ylim=(42.0, 68.0))
left.legend(title="variation", fontsize="small", loc="upper right", ncols=2)
right.plot(speed, moved, linewidth=0.8)
right.axvline(0.5 * np.sqrt(AXLE / AXLE_MASS), color="k", linewidth=0.8, linestyle=":")
right.set(xlabel="speed of the disc [rad/s]", ylabel="motion of the axle [mm]")
right.invert_xaxis()
figure.savefig("brake-judder.png", dpi=110)
