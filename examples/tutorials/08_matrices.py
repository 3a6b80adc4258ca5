"""
A pad as matrices of CalculiX
=============================

A supplier hands on matrices instead of a mesh with its materials. Here CalculiX has written those of a pad: from the
deck :download:`pad.inp </_generated/examples/tutorials/pad.inp>`, with the step ``*FREQUENCY, SOLVER=MATRIXSTORAGE``,
it made :download:`pad.sti </_generated/examples/tutorials/pad.sti>` (stiffness),
:download:`pad.mas </_generated/examples/tutorials/pad.mas>` (mass) and
:download:`pad.dof </_generated/examples/tutorials/pad.dof>` (the names of their rows). Units are SI. The pad is pressed
on a disc that turns.
"""

# %%
# The pad
# -------
# Files of one job stand beside each other: reading the stiffness finds the others. The deck gives the places of the
# nodes and the faces by name; held degrees of freedom are not in the matrices, which a warning says. The face that rubs
# is divided into patches.

from pathlib import Path

import numpy as np

import stridula as st
from stridula import plot

HERE = Path(__file__).parent if "__file__" in globals() else Path()
pad = st.ReducedBody.read(
    HERE / "pad.sti",
    mesh=HERE / "pad.inp",
    cutoff=30e3,
    damping=0.005,
    faces={"RUB": 12},
    points={"back": (0.0, 0.016, 0.105)},
    name="pad",
)
print(
    pad.modes().frequency[3:6].round(0), "Hz after the three rigid motions of a pad whose back is held along the disc"
)

# %%
# The same pad from its mesh
# --------------------------
# With the materials at hand, the deck makes the same body: a check of what came through the files.

materials = {"LINING": st.Material(4e9, 2500.0, 0.25), "PLATE": st.Material(2.1e11, 7800.0, 0.3)}
solid = st.SolidBody.read(HERE / "pad.inp", materials, fixed={"BACK": "xz"}, cutoff=30e3)
apart = pad.modes().frequency[3:6] / solid.modes().frequency[3:6] - 1.0
print(f"frequencies apart by at most {np.abs(apart).max():.0e}")

# %%
# A disc under it
# ---------------

disc = st.AxisymmetricBody(
    st.RectangleProfile({"disc": ((0.06, 0.13), (-0.012, 0.0))}),
    st.Material(1.1e11, 7100.0, 0.28),
    cutoff=9e3,
    held="inner",
    damping=0.001,
    residual_at=[(0.095, 0.0), (0.115, 0.0)],
    axis=(0.0, 1.0, 0.0),
    turning=20.0,
    name="disc",
)
face = st.SurfaceContact(pad, "RUB", disc, friction=st.Coulomb(0.5), stiffness=2e11, name="lining")
load = st.Force(pad.at("back"), y=-1e3)
plot.system(st.System(face, [load]))

# %%
# Stability
# ---------

theory = st.sliding_stability(st.System(face, [load]))
for hertz, growth in zip(theory.frequency.values, theory.growth_rate.values, strict=True):
    if growth > 0.0:
        print(f"{hertz:.0f} Hz grows by {growth:.0f} /s")

# %%
# In time
# -------

start = st.InitialEquilibrium(mode="most unstable", amplitude=1e-8)
run = st.simulate(st.System(face, [load, start]), 0.05)
print(st.card(run))

# %%
# Report
# ------

st.report(run, check=False).save("pad.html")
