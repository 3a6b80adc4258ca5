"""
Pad on a disc, node by node
===========================

The growing modes of a brake pad on a sliding disc, and the first hundredth of a second of their growth.

A disc of cast iron, clamped inside, turns under a pad of friction material, which is held by springs and pressed with
600 N. Both are elastic bodies in space; the pad touches with fifteen of its nodes, each of which slides, sticks or
lifts off by itself. The disc has a frame at rest: its surface moves under the pad, and its vibration does not turn with
it.
"""

import matplotlib.pyplot as plt
import numpy as np

import stridula as st
from stridula import plot

THICKNESS, TURNS = 0.012, 30.0
IRON, LINING = st.Material(1.1e11, 7100.0, 0.28), st.Material(5e9, 2500.0, 0.3)
RADII, ANGLES = (0.08, 0.10, 0.12), np.linspace(-0.35, 0.35, 5)

disc = st.AxisymmetricBody(
    st.RectangleProfile({"ring": ((0.04, 0.13), (-THICKNESS / 2, THICKNESS / 2))}),
    IRON,
    cutoff=8e3,
    held=["inner"],
    damping=0.001,
    residual_at=[(radius, THICKNESS / 2) for radius in RADII],
    axis=(0.0, 1.0, 0.0),
    name="disc",
)
mesh = st.SolidMesh.sector((RADII[0], RADII[-1]), (ANGLES[0], ANGLES[-1]), 0.015, (2, 4, 2), axis="y")


def node(radius: float, angle: float, height: float) -> tuple[float, float, float]:
    """Place of a node of the pad, its angle from z towards x."""
    return radius * np.sin(angle), height, radius * np.cos(angle)


feet = {f"foot {k}": node(r, a, 0.0) for k, (r, a) in enumerate((r, a) for r in RADII for a in ANGLES)}
backs = {f"back {k}": node(r, a, 0.015) for k, (r, a) in enumerate((r, a) for r in RADII[::2] for a in ANGLES[::4])}
pad = st.SolidBody(mesh, LINING, points=feet | backs, cutoff=12e3, damping=0.004, name="pad")


def brake(friction: float) -> st.System:
    """The pad, pressed on the turning disc."""
    first, second = disc.frame[:2]
    contacts = []
    for name, place in feet.items():
        radius, angle = np.hypot(place[0], place[2]), np.arctan2(np.dot(place, second), np.dot(place, first))
        contacts.append(
            st.PointContact(
                pad.at(name),
                disc.at((radius, angle, THICKNESS / 2)),
                friction=st.Coulomb(friction),
                normal=(0.0, 1.0, 0.0),
                tangent=np.cross((0.0, 1.0, 0.0), place),
                surface_velocity=TURNS * radius,
                name=name,
            )
        )
    rates = {"x": 2e7, "y": 2e5, "z": 2e7}
    springs = [st.Spring(pad.at(back), stiffness=rate, direction=way) for back in backs for way, rate in rates.items()]
    return st.System(contacts, [st.Force(pad.at(back), y=-150.0) for back in backs], springs)


for friction in (0.2, 0.4, 0.6):
    theory = st.sliding_stability(brake(friction))
    growing = theory.frequency.values[theory.unstable.values]
    open_feet = int((theory.status == "separated").sum())
    words = ", ".join(f"{frequency:.0f}" for frequency in growing) or "none"
    print(f"friction {friction}: {open_feet} feet lift off, growing modes [Hz]: {words}")

system = brake(0.6)
plot.save(plot.system(system), "bodies.png")
run = st.simulate(system, 0.01, sample_rate=1e5, probes=[st.Velocity(disc.at((0.12, 0.0, THICKNESS / 2)), "y")])
share = run.status_share.mean(("time", "contact")).values
print(
    f"{run.wall_time:.2f} s for 0.01 s, {len(feet)} contacts, {run.modes} modes; shares of the states {share.round(2)}"
)

figure, panels = plt.subplots(2, 1, figsize=(9.0, 5.0), sharex=True, layout="constrained")
panels[0].plot(1e3 * run.time, run.normal_force)
panels[0].set_ylabel("normal forces [N]")
panels[1].plot(1e3 * run.time, run.velocity[:, 0])
panels[1].set(xlabel="time [ms]", ylabel="velocity of the disc's rim [m/s]")
figure.savefig("brake-pad.png", dpi=110)
