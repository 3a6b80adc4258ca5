"""
Ten lines
=========

One steel strip is dragged along another at 1 cm/s under 50 N. It sticks, lets go, squeals for some 20 ms, and sticks
again.
"""

from math import radians

import stridula as st
from stridula import plot

steel, strip = st.Material(young=2.1e11, density=7800.0), st.Rectangle(width=0.020, height=0.0092)
rod = st.FiniteElementBeam(steel, strip, length=0.572, angle=radians(-45), damping=0.0075, cutoff=15e3)
track = st.ModalBeam(steel, strip, length=1.386, damping=0.0075, cutoff=15e3)
contact = st.PointContact(rod.tip, track, at=0.369, friction=st.Coulomb(1.1))
system = st.System(contact, [st.ImposedVelocity(rod.root, velocity=0.01, normal_load=50.0)])
run = st.simulate(system, duration=1.0)
print(run.status_share.mean("time").to_series())
pitch = st.regime(run).frequency
print(f"squeals at {pitch:.0f} Hz under a mean normal force of {run.normal_force.mean():.2f} N")
plot.save(plot.overview(run), "squeal.png")
