"""
A brake from a deck
===================

A disc between two pads, as Abaqus/CAE writes an assembly: parts, their instances, materials and surfaces in one deck,
:download:`brake.inp </_generated/examples/tutorials/brake.inp>`, in millimetres and tonnes. The disc turns, and both
pads are pressed on it.
"""

# %%
# Parts
# -----
# :func:`stridula.read_parts` returns the parts that share no node, here the instances, each where the deck places it,
# with its groups and materials. ``stridula mesh brake.inp --scale 0.001`` prints them.

from pathlib import Path

import stridula as st
from stridula import analysis, plot

HERE = Path(__file__).parent if "__file__" in globals() else Path()
parts = st.read_parts(HERE / "brake.inp", scale=1e-3)
for part in parts.values():
    print(part)

# %%
# Bodies
# ------
# The hub of the disc is held, and the backs of the pads along the disc. Faces in contact are divided into patches, by
# default some 30; a mapping sets their number.

held = {"DISC-1": ["HUB"], "PAD-UPPER": {"BACK": "xz"}, "PAD-LOWER": {"BACK": "xz"}}
faces = {"DISC-1": {"UPPER": 48, "LOWER": 48}, "PAD-UPPER": {"RUB": 12}, "PAD-LOWER": {"RUB": 12}}
disc, upper, lower = (
    st.SolidBody(
        part.mesh, part.materials, fixed=held[name], contact_faces=faces[name], cutoff=9e3, damping=0.004, name=name
    )
    for name, part in parts.items()
)

# %%
# Contacts and loads
# ------------------
# The disc turns about the y axis by 20 rad/s. Each pad is pressed by 1 kN and has a rough surface of 100 N/mm³.

turning = ((0.0, 1.0, 0.0), (0.0, 0.0, 0.0), 20.0)
contacts = [
    st.SurfaceContact(pad, "RUB", disc, face, st.Coulomb(0.4), stiffness=1e11, turning=turning, name=pad.name)
    for pad, face in ((upper, "UPPER"), (lower, "LOWER"))
]
loads = [st.Force(upper.at("BACK"), y=-1e3), st.Force(lower.at("BACK"), y=1e3)]
plot.system(st.System(contacts, loads))

# %%
# Stability
# ---------

theory = st.sliding_stability(st.System(contacts, loads))
for hertz, growth in zip(theory.frequency.values, theory.growth_rate.values, strict=True):
    if growth > 0.0:
        print(f"{hertz:.0f} Hz grows by {growth:.0f} /s")

# %%
# In time
# -------
# From the sliding equilibrium with 0.1 µm of the growing mode the vibration grows until patches lift off.

start = st.InitialEquilibrium(mode="most unstable", amplitude=1e-7)
run = st.simulate(st.System(contacts, [*loads, start]), 0.03)
print(f"{float(analysis.regime(run).separated):.0%} of the patches are open in the mean")
plot.timeline(run, ["gap", "normal_force", "landings"])

# %%
plot.surface(analysis.surface(run, contacts[0]), span=(0.025, 0.03))

# %%
# Report
# ------
# A page to hand on: drawing, inputs, modes over friction, this run and its sound, and which parameters matter.

st.report(run, check=False).save("deck.html")
print(f"{len(Path('deck.html').read_bytes()) // 1000} kB")
