"""
Disc brake in Python
====================

Two lined pads press on a turning disc with a hat: the growing modes, their limit cycle, and the pressure of the pads.
:doc:`../brake` explains it. The shipped case ``brake``, which the page plays, has a softer surface of the linings and
64 contacts, and squeals at 2.8 kHz; the growing modes of this one are others.

The disc is made of cast iron and held at the flange of its hat. Each pad is a backing plate of steel with a lining. All
points of the lining's face touch the disc through the stiffness of its rough surface; springs hold the backing plates.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import stridula as st
from stridula import plot
from stridula.analysis import surface

HALF, TURNS, LOAD = 0.010, 20.0, 2000.0
IRON, STEEL, LINING = (
    st.Material(1.1e11, 7100.0, 0.28),
    st.Material(2.1e11, 7800.0, 0.3),
    st.Material(4e9, 2500.0, 0.25),
)

disc = st.AxisymmetricBody(
    st.RectangleProfile(
        [
            ("disc", ((0.07, 0.13), (-HALF, HALF))),
            ("hat", ((0.06, 0.07), (-HALF, 0.05))),
            ("hat", ((0.03, 0.06), (0.044, 0.05))),
        ]
    ),
    IRON,
    cutoff=7e3,
    held="hat.inner",
    damping=0.002,
    residual_at=[(0.095, -HALF), (0.095, HALF), (0.115, -HALF), (0.115, HALF)],
    axis=(0.0, 1.0, 0.0),
    turning=TURNS,
    name="disc",
)


def pad(side: float, name: str) -> st.SolidBody:
    """A pad above (side 1) or below (side -1) the disc: lining first, then backing plate."""
    mesh = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), 0.016, (2, 3, 2), axis="y")
    height = mesh.nodes[mesh.elements, 1].mean(axis=1)
    mesh = replace(mesh, volumes={"lining": np.flatnonzero(height < 0.008), "plate": np.flatnonzero(height > 0.008)})
    # Turned upside down about z for the other side.
    turn = np.array([side, side, 1.0])
    mesh = replace(mesh, nodes=turn * (mesh.nodes + np.array([0.0, HALF, 0.0])))
    materials = {"lining": LINING, "plate": STEEL}
    return st.SolidBody(mesh, materials, cutoff=12e3, damping=0.01, contact_faces=["bottom"], name=name)


def brake(friction: float) -> tuple[st.System, list[st.SurfaceContact]]:
    """The brake, pressed from both sides."""
    faces, loads, springs = [], [], []
    for side, name in ((1.0, "upper"), (-1.0, "lower")):
        body = pad(side, f"{name} pad")
        faces.append(
            st.SurfaceContact(
                body, "bottom", disc, friction=st.Coulomb(friction), stiffness=3e12, name=f"{name} lining"
            )
        )
        back = body.face_points("top")
        for place, area in zip(back.place.tolist(), back.area.tolist(), strict=True):
            loads.append(st.Force(body.at(place), y=-side * LOAD * area / back.area.sum()))
        for place in back.place[::6].tolist():
            for way, rate in {"x": 2e7, "y": 5e5, "z": 2e7}.items():
                springs.append(st.Spring(body.at(place), stiffness=rate, direction=way))
    return st.System(faces, loads, springs), faces


for friction in (0.3, 0.5):
    theory = st.sliding_stability(brake(friction)[0])
    growing = theory.unstable.values & (theory.frequency.values < 7e3)
    words = [
        f"{f:.0f} Hz by {g:.0f}/s" for f, g in zip(theory.frequency[growing], theory.growth_rate[growing], strict=True)
    ]
    print(f"friction {friction}: {theory.equilibrium}, growing below 7 kHz: {', '.join(words) or 'none'}")

system, faces = brake(0.5)
plot.save(plot.system(system), "bodies.png")
run = st.simulate(
    st.System(faces, [*system.drives, st.InitialEquilibrium(mode="most unstable", amplitude=1e-8)], system.connections),
    0.02,
    probes=[st.Velocity(disc.at((0.13, 0.0, 0.0)), "y")],
)
found = [surface(run, face) for face in faces]
print(f"{len(system.contacts)} contacts, {run.modes} modes")

figure, panels = plt.subplots(1, 3, figsize=(12.0, 3.6), layout="constrained")
panels[0].plot(1e3 * run.time, run.velocity[:, 0])
panels[0].set(xlabel="time [ms]", ylabel="velocity of the rim along the axis [m/s]")
for one in found:
    panels[1].plot(1e3 * run.time, 1e-3 * np.abs(one.force.sel(axis="y")), label=one.surface)
panels[1].set(xlabel="time [ms]", ylabel="force on the pad [kN]")
panels[1].legend()
pressure = found[0].pressure.isel(time=slice(-200, None)).mean("time")
x, z = found[0].place.sel(axis=["x", "z"]).values.T
shown = panels[2].tricontourf(1e3 * x, 1e3 * z, 1e-6 * pressure, levels=12)
panels[2].plot(1e3 * x, 1e3 * z, "k.", markersize=3)
panels[2].set(xlabel="x [mm]", ylabel="z [mm]", aspect="equal", title="mean pressure of the upper lining [MPa]")
figure.colorbar(shown, ax=panels[2])
figure.savefig("brake.png", dpi=110)
