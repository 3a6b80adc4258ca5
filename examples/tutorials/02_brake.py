"""
A brake from a mesh
===================

A disc turns under a pad. The pad is a mesh of finite elements, the disc a body of revolution; they touch over a whole
face. The mesh is small, so that this page takes seconds.
"""

# %%
# The pad
# -------
# :meth:`stridula.SolidMesh.read` takes files of gmsh, Abaqus, Nastran and VTK. To keep this page without files, the
# mesh is created here: a sector of a ring, two elements across and four along. Faces have the names of groups in the
# file, or of the sides of the sector. Modes up to the cutoff are computed from sparse matrices; all modes above it
# contribute their static flexibility at the points of the contact face.

import stridula as st
from stridula import analysis, plot

mesh = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), 0.014, (2, 4, 1), axis="y")
lining = st.Material(young=8e9, density=2500.0, poisson=0.25)
pad = st.SolidBody(mesh, lining, cutoff=10e3, damping=0.005, contact_faces=["bottom"], name="pad")
print(", ".join(mesh.faces))
pad

# %%
# The disc
# --------
# A body of revolution needs its profile only: a ring from 70 mm to 130 mm, 12 mm thick, held inside. It turns at 20
# rad/s.

ring = st.RectangleProfile({"ring": ((0.07, 0.13), (-0.012, 0.0))})
disc = st.AxisymmetricBody(
    ring,
    st.Material(young=1.1e11, density=7100.0, poisson=0.28),
    cutoff=8e3,
    held="inner",
    damping=0.002,
    axis=(0.0, 1.0, 0.0),
    turning=20.0,
    name="disc",
)

# %%
# Contact, load, springs
# ----------------------
# A ``SurfaceContact`` finds the points of the face with their areas, the opposite points of the disc, and the velocity
# of the disc there. Its ``stiffness`` is that of the rough surface, per area. A force of 2 kN presses on the back of
# the pad; springs hold its corners.


def brake(friction: float) -> tuple[st.System, st.SurfaceContact]:
    """The pad on the disc."""
    face = st.SurfaceContact(pad, "bottom", disc, friction=st.Coulomb(friction), stiffness=1e12, name="lining")
    back = pad.face_points("top")
    shares = (back.area / back.area.sum()).tolist()
    loads = [st.Force(pad.at(place), y=-2e3 * share) for place, share in zip(back.place.tolist(), shares, strict=True)]
    rates = {"x": 2e7, "y": 2e5, "z": 2e7}
    springs = [
        st.Spring(pad.at(place), stiffness=rate, direction=way)
        for place in back.place[:: len(back.place) - 1].tolist()
        for way, rate in rates.items()
    ]
    return st.System(face, loads, springs), face


# %%
# Which modes grow?
# -----------------
# Linear theory over friction. A growing mode needs two modes that meet, and friction that couples them.

for friction in (0.2, 0.4, 0.6):
    theory = st.sliding_stability(brake(friction)[0])
    growing = theory.isel(mode=theory.unstable.values & (theory.frequency.values < 8e3))
    words = ", ".join(
        f"{hertz:.0f} Hz by {growth:.0f} /s"
        for hertz, growth in zip(growing.frequency.values, growing.growth_rate.values, strict=True)
    )
    print(f"friction {friction}: {theory.attrs['equilibrium']}, {words or 'no mode grows'}")

# %%
# In time
# -------
# The run starts in sliding equilibrium with 0.1 µm of the fastest growing mode added.

system, face = brake(0.6)
start = st.InitialEquilibrium(mode="most unstable", amplitude=1e-7)
system = st.System(face, [*system.drives, start], system.connections)
run = st.simulate(system, 0.03, probes=[st.Velocity(disc.at((0.13, 0.0, 0.0)), "y")])
print(f"{len(system.contacts)} points of contact, {run.modes} modes and residual shapes, {run.wall_time:.1f} s")
plot.timeline(run, ["velocity", "normal_force", "status"])

# %%
# The vibration grows, points of the lining lift off, and the growth ends: a limit cycle.
#
# How the pad presses
# -------------------
# :func:`stridula.analysis.surface` combines the points of a face: forces, areas, pressure.

found = analysis.surface(run, face)
late = (0.02, 0.03)
print(f"mean normal force {float(found.force.sel(axis='y').sel(time=slice(*late)).mean()):.0f} N")
plot.surface(found, span=late)

# %%
# The disc enters under the lining at one end, and there the pressure is largest. ``plot.bodies`` draws an instant of
# the motion, magnified, and ``plot.animate`` a film.

plot.bodies(system, 0.0295)

# %%
# The tone that you hear is near the growing mode:

frequencies, levels = analysis.tones(run.velocity.isel(velocity_probe=0).sel(time=slice(*late)))
for hertz, level in zip(frequencies[:3], levels[:3], strict=True):
    print(f"{hertz:.0f} Hz, {level:.0f} dB")

# %%
# :doc:`../brake` has two pads with backing plates and a disc with a hat, shipped as the scenario ``brake``.
