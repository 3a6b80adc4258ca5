"""
A mass on a belt
================

Stick-slip of a mass on a moving belt, held by a spring, under four laws of friction.

If friction falls with the slip velocity, the mass sticks to the belt until its spring tears it off, slides back and
sticks again. With equal static and kinetic friction it swings with an amplitude of belt velocity over angular
frequency, as it would after any start without damping, and hardly sticks.
"""

import stridula as st
from stridula import plot

mass = st.PointMass(1.0)
belt = st.RigidTrack(velocity=0.5)
laws = {
    "Coulomb": st.Coulomb(0.3),
    "static and kinetic": st.StaticKinetic(static=0.4, kinetic=0.25),
    "Stribeck": st.Stribeck(static=0.4, kinetic=0.25, velocity=0.1),
    "LuGre": st.LuGre(static=0.4, kinetic=0.25, velocity=0.1, stiffness=1e4, damping=10.0),
}
for name, law in laws.items():
    system = st.System(
        st.PointContact(mass.centre, belt, friction=law),
        drives=[st.Force(mass.centre, y=-10.0)],
        connections=[st.Spring(mass.centre, stiffness=4.0)],
    )
    run = st.simulate(system, duration=40.0, step=1e-3, sample_rate=1e3)
    late = run.sel(time=slice(20.0, None))
    swing = float(late.contact_position.max() - late.contact_position.min())
    stuck = float(late.status_share.sel(contact_status="sticking").mean())
    print(f"{name}: swings over {swing:.4f} m, sticks {100 * stuck:.0f} % of the time")
    plot.save(plot.timeline(late, ["contact_position", "tangential_force", "status"]), f"{name.replace(' ', '-')}.png")
