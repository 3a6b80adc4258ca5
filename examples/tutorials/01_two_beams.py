"""
Two beams that squeal
=====================

Build a system, run it, and look at the result: a steel strip is dragged along another one and squeals. You need no
scenario file.
"""

# %%
# Bodies
# ------
# A body is a description: material, section, length, damping. The *slider* is a beam of finite elements that leans on
# the *track*, a beam whose modes are known exactly. Modes above ``cutoff`` are left out. All numbers are SI, and
# angles are in radians.

from dataclasses import replace
from math import radians

import stridula as st
from stridula import analysis, plot

steel = st.Material(young=2.1e11, density=7800.0)
strip = st.Rectangle(width=0.020, height=0.0092)
rod = st.FiniteElementBeam(steel, strip, length=0.572, angle=radians(-45), damping=0.0075, cutoff=15e3)
track = st.ModalBeam(steel, strip, length=1.386, damping=0.0075, cutoff=15e3)
rod

# %%
# Contact, drive, system
# ----------------------
# The tip of the rod touches the track 369 mm from its left end. The driven end, the *root*, moves at 1 cm/s under a
# load of 50 N. The angle is negative: the root is behind the tip, so the rod *digs in*, as chalk does when you push
# it.

contact = st.PointContact(rod.tip, track, at=0.369, friction=st.Coulomb(1.1))
drive = st.ImposedVelocity(rod.root, velocity=0.01, normal_load=50.0)
system = st.System(contact, [drive])
system

# %%
# Run
# ---
# ``simulate`` returns an ``xarray.Dataset`` with named variables, coordinates and units. ``overview`` draws its most
# useful part.

run = st.simulate(system, duration=1.0)
plot.overview(run)

# %%
# The tip sticks to the track while the rod bends, lets go, squeals for some 20 ms, and sticks again.
# :func:`stridula.regime` names that, with the numbers that decide.

found = st.regime(run)
print(f"{found.regime.item()} at {found.frequency.item():.0f} Hz, confidence {found.confidence.item():.2f}")

# %%
# One burst
# ---------
# Measures of ``stridula.analysis`` find the bursts between two stops. Below are 4 ms about the highest force.

bursts = analysis.bursts(run)
lengths = bursts[:, 1] - bursts[:, 0]
print(f"{len(bursts)} bursts of {1e3 * lengths.mean():.0f} ms on average")
highest = float(run.time[run.normal_force.argmax("time")])
shown = run.sel(time=slice(highest - 0.002, highest + 0.002))
plot.timeline(shown, ["normal_force", "tangential_force", "status"])

# %%
# In each period the tip lands, sticks or slides, and leaves the track again. The normal force is zero in between, and
# it is never negative.
#
# Linear theory
# -------------
# Which modes *could* squeal? :func:`stridula.sliding_stability` linearises about steady sliding, with the same exact
# contact.

theory = st.sliding_stability(system)
growing = theory.isel(mode=theory.unstable.values)
for frequency, growth in zip(growing.frequency.values, growing.growth_rate.values, strict=True):
    print(f"{frequency:7.0f} Hz grows by {growth:6.0f} /s")

# %%
# Several modes grow. The run shows which one you hear: the mode near 2.8 kHz, slightly lower, because the contact is
# open for part of each period.

shake = run.acceleration.isel(acceleration_probe=0)
plot.spectrum(shake, system, theory, highest=8e3)

# %%
# Listen
# ------
# The sound pressure at two ears a metre above the track, in pascals.

heard = st.radiate(run, system)
st.listen(heard)

# %%
# Change something
# ----------------
# Descriptions are frozen. ``replace`` makes a changed copy, and the original stays as it is.

for friction in (0.3, 0.7, 0.9, 1.1):
    changed = replace(system, contact=replace(contact, friction=st.Coulomb(friction)))
    named = st.regime(st.simulate(changed, duration=1.0))
    print(f"friction {friction}: {named.regime.item()}")

# %%
# Next: :doc:`02_brake` has bodies from meshes. :doc:`../python` explains records, probes and long runs.
