"""
A shim that silences a brake
============================

A damping shim between pad and piston: which stiffness, how much loss, and what a stiffness alone does.

The brake is the shipped scenario ``brake``, whose pads are pressed by a force. Here a piston presses each pad through a
shim, steel sheets with a layer of rubber between them, whose stiffness and loss factor are measured over frequency. The
rubber is softer in shear than across. :doc:`../brake` explains the brake.
"""

import matplotlib.pyplot as plt
import numpy as np

import stridula as st

case = st.load_scenario("brake")
bare, LOAD, BACK = case.system, 2000.0, 25.9999e-3
PLACES = [
    (r * np.sin(angle), r * np.cos(angle)) for angle in np.radians(np.linspace(-20.0, 20.0, 5)) for r in (0.092, 0.118)
]
FREQUENCY = np.geomspace(500.0, 10e3, 6)


def piston_of(pad: object, side: float, mass: float = 0.4) -> st.RigidBody:
    """A piston behind a pad, with the points of the shim."""
    points = np.array([(x, side * BACK, z) for x, z in PLACES])
    arms = points - points.mean(axis=0)
    squares = mass * np.mean(arms**2, axis=0)
    names = {f"shim {k}": tuple(arm) for k, arm in enumerate(arms)}
    return st.RigidBody(mass, inertia=squares.sum() - squares, points=names, name=pad.name.replace("pad", "piston"))


def with_shims(stiffness: float, loss: float, shear: float = 0.1) -> st.System:
    """The brake with a shim of a stiffness [N/m] and a loss factor on each pad; that along it is a share of it."""
    # A material with this loss factor grows stiffer with the frequency.
    measured = stiffness * (FREQUENCY / 3e3) ** (2.0 / np.pi * np.arctan(loss))
    connections = [one for one in bare.connections if one.direction != "y"]
    drives = [one for one in bare.drives if not isinstance(one, st.Force)]
    for pad, side in zip((body for body in bare.bodies if body.kind == "solid"), (1.0, -1.0), strict=True):
        piston = piston_of(pad, side)
        connections.append(st.Bushing(piston.centre, stiffness=[1e7, 1e6, 1e7], rotational_stiffness=[1e3] * 3))
        drives.append(st.Force(piston.centre, y=-side * LOAD))
        connections += st.viscoelastic_layer(
            [pad.at((x, side * BACK, z)) for x, z in PLACES],
            [piston.at(f"shim {k}") for k in range(len(PLACES))],
            frequency=FREQUENCY,
            stiffness={"y": measured, "x": shear * measured, "z": shear * measured},
            loss_factor=np.full(6, loss),
        )
    return st.System(bare.contacts, drives, connections)


def growth(system: st.System) -> tuple[float, float]:
    """Growth rate [1/s] and frequency [Hz] of the mode that grows fastest."""
    theory = st.sliding_stability(system)
    fastest = int(theory.growth_rate.values.argmax())
    return float(theory.growth_rate[fastest]), float(theory.frequency[fastest])


STIFFNESSES, LOSSES = (5e7, 1e8, 3e8), (0.0, 0.05, 0.1, 0.2, 0.3)
found = {stiffness: [growth(with_shims(stiffness, loss)) for loss in LOSSES] for stiffness in STIFFNESSES}
rate, hertz = growth(bare)
print(f"without a shim: {rate:.0f} /s at {hertz:.0f} Hz")
for stiffness, modes in found.items():
    for loss in (0, 4):
        rate, hertz = modes[loss]
        print(f"{stiffness:.0e} N/m, loss factor {LOSSES[loss]}: {rate:.1f} /s at {hertz:.0f} Hz")

probes = [st.Velocity(next(body for body in bare.bodies if body.name == "disc").at((0.13, 0.0, 0.0)), "y")]
quiet = st.simulate(with_shims(1e8, 0.3), 0.03, probes=probes)
loud = st.simulate(bare, 0.03, probes=probes)

figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.8), layout="constrained")
for stiffness, modes in found.items():
    left.plot(LOSSES, [rate for rate, _ in modes], "o-", label=f"{stiffness / 1e6:.0f} N/µm")
left.axhline(0.0, color="k", linewidth=0.5)
left.axhline(growth(bare)[0], color="k", linestyle="--", linewidth=0.8, label="without a shim")
left.set(xlabel="loss factor of the shim", ylabel="fastest growth [1/s]")
left.legend(fontsize="small")
for run, words in ((loud, "without a shim"), (quiet, "100 N/µm, loss factor 0.3")):
    right.plot(1e3 * run.time, 1e6 * run.velocity[:, 0], linewidth=0.6, label=words)
right.set(xlabel="time [ms]", ylabel="velocity of the disc [µm/s]")
right.legend(fontsize="small")
figure.savefig("brake_shim.png", dpi=110)
