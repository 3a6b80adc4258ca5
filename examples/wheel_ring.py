"""
A damping ring on a wheel
=========================

A steel ring on rubber inside the rim of a railway wheel: which modes it keeps from growing, and how heavy it must be.

The wheel is that of the shipped scenario ``wheel``, which creeps sideways over the rail, with friction that falls less:
from 0.3 at rest to 0.25. It stands, since connections join bodies that do not turn; rolling changes its growth little
(:doc:`../wheel`).
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import stridula as st

CHANGES = {
    "turning": 0.0,
    "contacts.0.surface_velocity.1": 0.0,
    "contacts.0.friction.static": 0.3,
    "contacts.0.friction.kinetic": 0.25,
}
bare = st.load_scenario("wheel", CHANGES).system
wheel = bare.contact.tip.body
STEEL = st.Material(young=210e9, density=7850.0, poisson=0.3)
FREQUENCY = np.geomspace(200.0, 3200.0, 5)
# The rubber: a material with this loss factor grows stiffer with the frequency.
LOSS = 0.8
STIFFER = 2.0 / np.pi * np.arctan(LOSS)
RIM, OUTER, MIDDLE, SPRINGS = 0.390, 0.388, -0.05, 16
ANGLES = np.linspace(0.0, 2.0 * np.pi, SPRINGS, endpoint=False)


def with_ring(height: float, tuned: float) -> tuple[st.System, float]:
    """The wheel with a ring of a height [m] that vibrates on its rubber at a frequency [Hz], and its mass [kg]."""
    profile = st.RectangleProfile({"ring": ((OUTER - height, OUTER), (MIDDLE - 0.015, MIDDLE + 0.015))})
    ring = st.AxisymmetricBody(profile, STEEL, cutoff=3e3, damping=1e-3, name="ring")
    stiffness = ring.total_mass * (2.0 * np.pi * tuned) ** 2 * (FREQUENCY / tuned) ** STIFFER
    rubber = st.viscoelastic_layer(
        [wheel.at((RIM, angle, MIDDLE)) for angle in ANGLES],
        [ring.at((OUTER, angle, MIDDLE)) for angle in ANGLES],
        frequency=FREQUENCY,
        stiffness=dict.fromkeys("xyz", stiffness),
        loss_factor=np.full(FREQUENCY.size, LOSS),
    )
    return replace(bare, connections=(*bare.connections, *rubber)), ring.total_mass


def growing(system: st.System) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] and growth rates [1/s] of the modes that vibrate, by linear theory."""
    theory = st.sliding_stability(system)
    vibrates = theory.frequency.values > 100.0
    return theory.frequency.values[vibrates], theory.growth_rate.values[vibrates]


designs = {"without a ring": (bare, 0.0)}
designs |= {f"{1e3 * height:.0f} mm": with_ring(height, 350.0) for height in (0.01, 0.02, 0.04)}
theory = {name: growing(system) for name, (system, _) in designs.items()}
for name, (hertz, growth) in theory.items():
    worst = int(growth.argmax())
    print(f"{name}, {designs[name][1]:.1f} kg: {growth[worst]:.1f} /s at {hertz[worst]:.0f} Hz")

probes = [st.Velocity(wheel.at((0.46, -np.pi / 2.0, 0.0)), "z")]
compared = ("without a ring", "40 mm")
runs = {name: st.simulate(designs[name][0], 0.3, sample_rate=2e4, probes=probes) for name in compared}
# The largest velocity in every 3 ms.
peaks = {name: np.abs(run.velocity.values[:, 0]).reshape(100, -1).max(axis=1) for name, run in runs.items()}

figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.8), layout="constrained")
for name, (hertz, growth) in theory.items():
    left.plot(hertz, growth, "o", markersize=4, label=name)
left.axhline(0.0, color="k", linewidth=0.5)
left.set(xlabel="frequency [Hz]", ylabel="growth [1/s]", ylim=(-60.0, 50.0), xlim=(0.0, 5e3))
left.legend(fontsize="small")
for name, peak in peaks.items():
    right.semilogy(np.linspace(0.003, 0.3, 100), peak, label=name)
right.set(xlabel="time [s]", ylabel="velocity of the rim [m/s]")
right.legend(fontsize="small")
figure.savefig("wheel-ring.png", dpi=110)
