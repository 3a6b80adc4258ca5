"""
Pin on disc
===========

A pin rubs on a disc and squeals: one unstable mode, its growth, and its limit cycle.
:doc:`../pin-on-disc` explains it.

The rig of Allgaier, Gaul, Keiper and Willner (1999), as in verification case VM275 of Ansys: a disc of aluminium, 25 mm
thick, held at its shaft, and a pin of 10 mm x 10 mm x 149 mm that leans by 4 degrees, held at its far end, with five
nodes of one edge on the disc. The rig and Ansys have one unstable mode, at 2215 Hz.
"""

import matplotlib.pyplot as plt
import numpy as np

import stridula as st
from stridula import plot

ALUMINIUM, LEAN, SPEED = st.Material(7e10, 2700.0, 0.33), np.radians(4.0), 1.0
EDGE = 0.0025 * np.arange(5)
# The pin stands upright; the disc leans under it.
NORMAL = np.array([np.sin(LEAN), np.cos(LEAN), 0.0])

disc = st.AxisymmetricBody(
    st.RectangleProfile({"disc": ((0.008, 0.179), (-0.0125, 0.0125))}),
    ALUMINIUM,
    cutoff=6e3,
    held=["inner"],
    residual_at=[(0.157 + place, 0.0125) for place in EDGE],
    axis=NORMAL,
    name="disc",
)
pin = st.SolidBody.block(
    (0.010, 0.149, 0.010),
    (2, 16, 2),
    ALUMINIUM,
    points={f"node {k}": (0.0, 0.0, place) for k, place in enumerate(EDGE)},
    fixed={"top": "xyz"},
    cutoff=20e3,
    name="pin",
)


def rig(friction: float, sense: float = 1.0) -> st.System:
    """The pin on the disc, pressed by 500 N; the disc turns one way or the other."""
    first, second = disc.frame[:2]
    angle = np.arctan2(second[2], first[2])
    contacts = [
        st.PointContact(
            pin.at(f"node {k}"),
            disc.at((0.157 + place, angle, 0.0125)),
            friction=st.Coulomb(friction),
            normal=NORMAL,
            tangent=np.cross(NORMAL, (0.0, 0.0, 1.0)),
            surface_velocity=sense * SPEED,
            name=f"contact {k}",
        )
        for k, place in enumerate(EDGE)
    ]
    push = -100.0 * NORMAL
    return st.System(contacts, [st.Force(one.tip, x=push[0], y=push[1]) for one in contacts])


def audible(system: st.System) -> list[tuple[float, float]]:
    """Frequency and growth of the modes that grow from 0.5 to 4 kHz, all five nodes sliding."""
    theory = st.sliding_stability(system, status="sliding")
    found = zip(theory.frequency.values, theory.growth_rate.values, theory.unstable.values, strict=True)
    return [(float(hertz), float(growth)) for hertz, growth, grows in found if grows and 500.0 < hertz < 4000.0]


print("disc alone [Hz]:", np.unique(disc.modes().frequency[:12].round()))
found = {friction: audible(rig(friction)) for friction in (0.05, 0.1, 0.152, 0.2, 0.3)}
for friction, modes in found.items():
    words = ", ".join(f"{hertz:.0f} Hz grows by {growth:.0f} /s" for hertz, growth in modes) or "no mode grows"
    print(f"friction {friction}: {words}")
backwards = audible(rig(0.152, -1.0))
print("backwards:", backwards or "no mode grows")

# Some nodes of the edge are open in equilibrium; the run starts there, with ten nanometres of the growing mode.
system = rig(0.152)
plot.save(plot.system(system), "bodies.png")
theory = st.sliding_stability(system)
status = [str(word) for word in theory.status.values]
fastest = int(theory.growth_rate.argmax("mode"))
frequency, growth = float(theory.frequency[fastest]), float(theory.growth_rate[fastest])
start = st.InitialEquilibrium(status=status, mode="most unstable", amplitude=1e-8)
run = st.simulate(
    st.System(system.contact, [*system.drives, start]),
    0.06,
    sample_rate=1e5,
    probes=[st.Velocity(pin.at("node 0"), "x")],
)
late = run.velocity.values[run.time.values > 0.03, 0]
spectrum = np.abs(np.fft.rfft(late * np.hanning(late.size)))
cycle = float(np.fft.rfftfreq(late.size, 1e-5)[spectrum.argmax()])
print(f"theory at rest: {frequency:.0f} Hz grows by {growth:.0f} /s")
print(f"limit cycle at {cycle:.0f} Hz, {np.ptp(late):.1f} m/s from end to end")

figure, panels = plt.subplots(1, 2, figsize=(11.0, 3.8), layout="constrained")
panels[0].semilogy(1e3 * run.time, np.abs(run.velocity[:, 0]), linewidth=0.5, label="run")
rise = np.array([0.0, 0.03])
size = 1e-8 * 2.0 * np.pi * frequency
panels[0].semilogy(1e3 * rise, size * np.exp(growth * rise), "k--", label="linear theory")
panels[0].set(xlabel="time [ms]", ylabel="velocity of the pin's edge [m/s]", ylim=(0.1 * size, None))
panels[0].legend()
hertz = np.fft.rfftfreq(late.size, 1e-5) / 1e3
panels[1].semilogy(hertz, spectrum / spectrum.max())
panels[1].axvline(2.215, color="k", linestyle=":", label="2215 Hz, published")
panels[1].set(xlabel="frequency [kHz]", ylabel="limit cycle, relative", xlim=(0.0, 12.0), ylim=(1e-5, 2.0))
panels[1].legend()
figure.savefig("pin-on-disc.png", dpi=110)
