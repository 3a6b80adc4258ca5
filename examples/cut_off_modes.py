"""
Modes beyond a cutoff
=====================

Effect of the modes beyond a cutoff: a block on five feet, and a slender beam that judders. :doc:`../cutoffs` explains
it.

A block presses on a moving floor with the nodes of its lower face. Modes up to a cutoff are kept; those left out are
dropped, or yield statically (`residual_flexibility`). Equilibrium and squeal with all modes show which is right. The
second system is the slider of the paper's judder, a beam so slender that a displacement of its tip runs away as waves.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import stridula as st
from stridula.studies import share_of

LENGTH, HEIGHT, THICKNESS, ACROSS, UP = 0.15, 0.05, 0.05, 24, 8
YOUNG, DENSITY, POISSON = 3e9, 2500.0, 0.3
SPRINGS = {"x": 4e7, "y": 2e7}
CUTOFFS = (5e3, 7e3, 10e3, 14e3, 20e3, 40e3)
WAYS = {"left out": False, "yielding statically": True}


def element() -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness of a bilinear element in plane stress, corners counter-clockwise."""
    sides = np.array([LENGTH / ACROSS, HEIGHT / UP])
    shear = (1.0 - POISSON) / 2.0
    law = YOUNG / (1.0 - POISSON**2) * np.array([[1.0, POISSON, 0.0], [POISSON, 1.0, 0.0], [0.0, 0.0, shear]])
    corners = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    mass, stiffness = np.zeros((8, 8)), np.zeros((8, 8))
    for place in corners / np.sqrt(3.0):
        lines = 1.0 + corners * place
        slopes = corners * lines[:, ::-1] / (2.0 * sides)
        moved, strain = np.zeros((2, 8)), np.zeros((3, 8))
        moved[0, ::2] = moved[1, 1::2] = lines.prod(axis=1) / 4.0
        strain[0, ::2] = strain[2, 1::2] = slopes[:, 0]
        strain[1, 1::2] = strain[2, ::2] = slopes[:, 1]
        weight = THICKNESS * sides.prod() / 4.0
        mass += weight * DENSITY * moved.T @ moved
        stiffness += weight * strain.T @ law @ strain
    return mass, stiffness


def block() -> tuple[np.ndarray, np.ndarray, dict]:
    """Mass and stiffness of the block, and its points: five feet below, three places above."""
    nodes = np.arange((ACROSS + 1) * (UP + 1)).reshape(ACROSS + 1, UP + 1)
    mass, stiffness = np.zeros((2, 2 * nodes.size, 2 * nodes.size))
    for i in range(ACROSS):
        for j in range(UP):
            chosen = nodes[[i, i + 1, i + 1, i], [j, j, j + 1, j + 1]]
            freedoms = np.stack([2 * chosen, 2 * chosen + 1], axis=1).ravel()
            for whole, part in zip((mass, stiffness), element(), strict=True):
                whole[np.ix_(freedoms, freedoms)] += part
    feet = {f"foot {k}": (2 * n, 2 * n + 1) for k, n in enumerate(nodes[::6, 0].tolist())}
    return mass, stiffness, feet | {f"back {k}": (2 * n, 2 * n + 1) for k, n in enumerate(nodes[::12, -1].tolist())}


MASS, STIFFNESS, POINTS = block()


def pressed(cutoff: float | None, residual: bool = True) -> st.System:
    """The block, held by springs and pressed by 600 N on a floor that moves at 2 m/s."""
    body = st.ReducedBody(
        MASS, STIFFNESS, POINTS, damping=0.003, cutoff=cutoff, residual_flexibility=residual, name="block"
    )
    feet, backs = ([point for point in POINTS if point.startswith(word)] for word in ("foot", "back"))
    contacts = [
        st.PointContact(body.at(foot), st.RigidTrack(velocity=2.0, name=foot), friction=st.Coulomb(0.5))
        for foot in feet
    ]
    springs = [st.Spring(body.at(back), stiffness=k, direction=way) for back in backs for way, k in SPRINGS.items()]
    return st.System(contacts, [st.Force(body.at(back), y=-200.0) for back in backs], springs)


def squeal(system: st.System, below: float = 10e3) -> tuple[np.ndarray, float, float]:
    """Normal forces in equilibrium, frequency and growth of the mode that grows fastest below a frequency."""
    found = st.sliding_stability(system)
    heard = found.growth_rate.where(found.frequency < below, -np.inf)
    fastest = int(np.argmax(heard.values))
    return found.normal_force.values, float(found.frequency[fastest]), float(found.growth_rate[fastest])


def judder(cutoff: float, residual: bool) -> tuple[float, float]:
    """Share of the time for which the slider of the paper's judder is off the track, and half of its 95 % interval."""
    shipped = st.load_scenario("judder").system
    beam, contact = replace(shipped.slider, cutoff=None), shipped.contact
    modes, damping = beam.modes(), 0.003
    body = st.ReducedBody(
        np.eye(modes.count),
        np.diag(modes.angular_frequency**2),
        {"tip": beam.trace(0.0), "root": beam.trace(beam.length)},
        damping=damping,
        translation=modes.translation,
        cutoff=cutoff,
        residual_flexibility=residual,
    )
    touching = replace(contact, tip=body.at("tip"), track=replace(contact.track, cutoff=cutoff, damping=damping))
    push = shipped.drives[0].axial * beam.axes[0]
    system = st.System(touching, [st.Force(body.at("root"), x=push[0], y=push[1])])
    found = st.ensemble(system, 0.5, {"apart": share_of("separated")}, runs=8, step=1e-6, probes=[])
    return float(found.apart_mean), float(found.apart_interval[1] - found.apart_mean)


truth = squeal(pressed(None))
print(f"all modes: {truth[1]:.0f} Hz grows by {truth[2]:.0f} /s, feet press with {np.round(truth[0], 1)} N")
found = {(cutoff, way): squeal(pressed(cutoff, way)) for cutoff in CUTOFFS for way in WAYS.values()}
for (cutoff, way), (forces, frequency, growth) in found.items():
    words = "yielding statically" if way else "left out"
    print(
        f"beyond {cutoff / 1e3:.0f} kHz {words}: {frequency:.0f} Hz grows by {growth:.0f} /s, {np.round(forces, 1)} N"
    )

figure, panels = plt.subplots(1, 3, figsize=(12.0, 3.8), layout="constrained")
feet = np.arange(1, 6)
for word, way in WAYS.items():
    values = [found[cutoff, way] for cutoff in CUTOFFS]
    panels[0].plot(feet, found[CUTOFFS[0], way][0], "o-", label=f"modes beyond cutoff {word}")
    for axes, number in zip(panels[1:], (1, 2), strict=True):
        axes.semilogx(np.divide(CUTOFFS, 1e3), [one[number] for one in values], "o-")
panels[0].plot(feet, truth[0], "k--", label="all modes")
for axes, number in zip(panels[1:], (1, 2), strict=True):
    axes.axhline(truth[number], color="k", linestyle="--")
    axes.set_xticks(np.divide(CUTOFFS, 1e3), [f"{cutoff / 1e3:.0f}" for cutoff in CUTOFFS])
    axes.minorticks_off()
    axes.set(xlabel="cutoff [kHz]", ylim=(0.0, None))
panels[0].set(xlabel="foot", ylabel="normal force [N]", xticks=feet, title="Equilibrium, cutoff at 5 kHz")
panels[1].set(ylabel="frequency [Hz]", title="Fastest growing mode: frequency")
panels[2].set(ylabel="growth [1/s]", title="Fastest growing mode: growth")
panels[0].legend(fontsize=8)
figure.savefig("cut-off-modes.png", dpi=110)

for cutoff in (7.5e3, 60e3):
    for word, way in WAYS.items():
        apart, interval = judder(cutoff, way)
        print(
            f"judder, modes beyond {cutoff / 1e3:g} kHz {word}: off the track {apart:.3f} +- {interval:.3f} of the time"
        )
