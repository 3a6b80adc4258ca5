"""Runs through the kernel of the graphics card, by numba's simulator of one, against the same runs one by one.

As a program it needs ``NUMBA_ENABLE_CUDASIM=1`` and prints, for each case, the largest difference by kind of number.
"""

from __future__ import annotations

import json

import numpy as np
from physics.cases import dragged, pair, slider, track, transverse
from physics.test_circular_paths import on_a_circle, riders

import stridula as st
from stridula._kernels.layout import columns as at
from stridula.integration.cuda_march import CudaMarch
from stridula.integration.marches import March, imposed_on
from stridula.integration.start import state_at_start
from stridula.lowering import assemble
from stridula.lowering.blocks import blocks_of

STEP, RATIO = 5e-6, 3
# Two chunks of samples, of unlike lengths.
CHUNKS = (5, 3)
BAR = {"cutoff": 1.5e3}
ROD = {"cutoff": 4e3}


def coulomb_on_a_beam() -> list[st.System]:
    return [
        pair(transverse(force), mu, angle, gap=1e-9, rod=slider(angle, **ROD), bar=track(**BAR))
        for mu, angle, force in ((0.4, 30.0, 5.0), (1.5, 45.0, 20.0), (0.9, -20.0, 9.0))
    ]


def shaken_force() -> list[st.System]:
    return [
        pair(transverse(9.0, history=st.Harmonic(f)), 0.8, gap=1e-9, rod=slider(**ROD), bar=track(**BAR))
        for f in (4e3, 7e3, 9e3)
    ]


def on_a_belt(friction, velocities=(0.02, -0.05, 0.3)) -> list[st.System]:
    found = []
    for angle, velocity in zip((20.0, 35.0, -50.0), velocities, strict=True):
        rod = slider(angle, **ROD)
        belt = st.RigidTrack(velocity=velocity, history=st.Ramp(1e-4))
        found.append(
            st.System(st.PointContact(rod.tip, belt, friction=friction, gap=1e-9), [st.Force(rod.root, y=-30.0)])
        )
    return found


def on_a_table() -> list[st.System]:
    """Masses in space on bristles, pressed and dragged along both tangents."""
    found = []
    for velocity, load in ((2.0, 100.0), (-5.0, 300.0), (3.0, 900.0)):
        mass = st.RigidBody(0.1)
        table = st.RigidTrack(velocity=velocity, lateral_velocity=1.0, history=st.Ramp(1e-4))
        contact = st.PointContact(mass.centre, table, friction=st.LuGre(0.6, 0.4, 0.01, 1e5, 10.0), gap=1e-9)
        springs = [st.Spring(mass.centre, stiffness=1e6, direction=way) for way in ("x", "z")]
        found.append(st.System(contact, [st.Force(mass.centre, y=-load)], springs))
    return found


def off_the_track() -> list[st.System]:
    """The second run leaves its track, the others continue."""
    return [
        pair(dragged(0.5, 5.0), 0.6, gap=1e-9, at=at, rod=slider(**ROD), bar=track(**BAR))
        for at in (0.2, 0.8 - 2e-5, 0.5)
    ]


def round_a_disc() -> list[st.System]:
    return [
        riders(on_a_circle(turning, velocity, cutoff=1500.0), abscissas=(0.0, 0.1), gap=1e-9)
        for turning, velocity in ((0.0, 20.0), (30.0, 5.0), (-40.0, 0.0))
    ]


def on_three_feet() -> list[st.System]:
    """A block whose feet touch a belt in a different order in each run, the last one never in one run."""
    stiffness, points = np.zeros((8, 8)), {"back": np.eye(2, 8)}
    for number in range(3):
        own = slice(2 + 2 * number, 4 + 2 * number)
        stiffness[own, own] = [[4e4, 1e4], [1e4, 9e4]]
        points[f"foot {number}"] = np.eye(2, 8) + np.eye(2, 8, 2 + 2 * number)
    mass = np.diag([0.2, 0.2] + [0.02] * 6)
    found = []
    for gaps, velocity, load in (
        ((0.0, 1e-9, 2e-9), 0.02, 2e3),
        ((2e-9, 0.0, 1.0), 0.5, 9e3),
        ((1e-9, 2e-9, 0.0), -0.1, 5e2),
    ):
        block = st.ReducedBody(mass, stiffness, points, damping=0.02, translation=points["back"], name="block")
        feet = [block.at(f"foot {number}") for number in range(3)]
        belt = st.RigidTrack(velocity=velocity)
        contacts = [
            st.PointContact(foot, belt, friction=st.Coulomb(0.4), gap=gap, name=foot.position)
            for foot, gap in zip(feet, gaps, strict=True)
        ]
        forces = [st.Force(foot, y=-load) for foot in feet]
        found.append(st.System(contacts, forces, [st.Spring(block.at("back"), stiffness=5e3)]))
    return found


def on_rough_belts() -> list[st.System]:
    """Masses on belts with profiles of unlike lengths."""
    found = []
    for profile in (
        st.Profile.random(1e-6, 1e-4, 2e-3),
        st.Profile.sine(1e-6, 1e-3),
        st.Profile([-1e-3, 0.0], [0.0, 1e-6]),
    ):
        mass = st.PointMass(0.1)
        belt = st.RigidTrack(velocity=2.0, profile=profile)
        contact = st.PointContact(mass.centre, belt, friction=st.Coulomb(0.4), stiffness=1e7)
        found.append(st.System(contact, [st.Force(mass.centre, y=-30.0)]))
    return found


CASES = {
    "coulomb on a beam": coulomb_on_a_beam,
    "shaken force": shaken_force,
    "stribeck on a belt": lambda: on_a_belt(st.Stribeck(0.6, 0.35, 0.01)),
    "lugre on a belt": lambda: on_a_belt(st.LuGre(0.6, 0.4, 0.01, stiffness=1e5, damping=10.0)),
    "lugre in space": on_a_table,
    "off the track": off_the_track,
    "rough belts": on_rough_belts,
    "round a disc": round_a_disc,
    "on three feet": on_three_feet,
}


class Prepared:
    """A system about to march."""

    def __init__(self, system: st.System) -> None:
        scheme = st.ExactModal()
        rigid = isinstance(system.contacts[0].track, st.RigidTrack)
        probes = [] if rigid else [st.Acceleration(system.contacts[0].tip, "y")]
        self.arrays = assemble(system, probes)
        self.blocks = blocks_of(self.arrays, scheme, STEP)
        self.state = state_at_start(self.arrays, scheme, STEP, self.blocks, st.GaussSeidel())

    def imposed(self, first: int, samples: int):
        return imposed_on(self.arrays, self.blocks.used, first * RATIO, samples * RATIO, STEP)


def marched(kind, prepared) -> list[dict[str, np.ndarray]]:
    """Return the results of each run."""
    march = kind([one.blocks for one in prepared], [one.state for one in prepared], STEP, RATIO)
    # A copy does not affect the original.
    march.copy().advance([one.imposed(0, 1) for one in prepared], 1)
    left, first = [], 0
    for samples in CHUNKS:
        left.append(march.advance([one.imposed(first, samples) for one in prepared], samples))
        first += samples
    return [summary(chunks, state) for chunks, state in zip(zip(*left, strict=True), march.states, strict=True)]


def summary(chunks, state) -> dict[str, np.ndarray]:
    """Return the results of a run by kind, up to the end of each chunk."""
    done = [chunk.completed for chunk in chunks]
    return {
        "energies": np.concatenate([chunk.energies[:n] for chunk, n in zip(chunks, done, strict=True)]),
        "record": np.concatenate([chunk.contacts[:n, 0] for chunk, n in zip(chunks, done, strict=True)]),
        "probes": np.concatenate([chunk.raw[: n * RATIO] for chunk, n in zip(chunks, done, strict=True)]),
        "ended": np.array([[*done, *(chunk.ended for chunk in chunks)]], dtype=float),
        "modal": state.modal.T,
        "carried": state.carried,
    }


# Below these lengths [m] and this velocity [m/s] a number that should be zero is round-off.
LENGTH, VELOCITY = 1e-9, 1e-4
FLOORS = {
    "record": {
        at.CONTACT_POSITION: LENGTH,
        at.CONTACT_HEIGHT: LENGTH,
        at.CONTACT_GAP: LENGTH,
        at.SLIP_VELOCITY: VELOCITY,
        at.CONTACT_POSITION_B: LENGTH,
        at.SLIP_VELOCITY_B: VELOCITY,
    },
    "carried": dict.fromkeys(
        (
            at.MATERIAL,
            at.ANCHOR,
            at.ABSCISSA,
            at.LAST_SLIP,
            at.EARLIER_SLIP,
            at.LAST_GAP,
            at.EARLIER_GAP,
            at.EARLIEST_GAP,
            at.LAST_HEIGHT,
            at.EARLIER_HEIGHT,
            at.PUSHED,
            at.MATERIAL_B,
            at.ANCHOR_B,
            at.ABSCISSA_B,
            at.LAST_SLIP_B,
            at.EARLIER_SLIP_B,
        ),
        LENGTH,
    ),
}


def difference(kind, one, other) -> float:
    """Return the largest difference of numbers of a kind, relative to the largest; energies to the largest of any."""
    if one.shape != other.shape:
        return float("inf")
    scale = np.abs(other).max(axis=0, initial=0.0)
    if kind == "energies":
        scale[:] = scale.max()
    for column, floor in FLOORS.get(kind, {}).items():
        scale[column] = max(scale[column], floor)
    return float((np.abs(one - other) / np.where(scale > 0.0, scale, 1.0)).max(initial=0.0))


def columns(prepared) -> dict[str, int]:
    """Return the number of columns recorded for contacts."""
    contacts = CudaMarch([one.blocks for one in prepared], [one.state for one in prepared], STEP, RATIO).contacts
    return {name: getattr(contacts, name).shape[-1] for name in ("faces", "scratch", "places", "now", "sums")}


def compare(systems) -> dict[str, object]:
    """Return the largest differences by kind, the smallest from the neighbouring run, and the end of each run."""
    prepared = [Prepared(system) for system in systems]
    together = marched(CudaMarch, prepared)
    alone = [marched(March, [one])[0] for one in prepared]
    beside = alone[1:] + alone[:1]
    return {
        "differences": {
            kind: max(difference(kind, a[kind], b[kind]) for a, b in zip(together, alone, strict=True))
            for kind in alone[0]
        },
        "beside": min(
            difference("energies", a["energies"], b["energies"]) for a, b in zip(together, beside, strict=True)
        ),
        "columns": columns(prepared),
        "apart": [float(one["record"][:, at.SEPARATED].mean()) for one in alone],
        "ended": [int(one["ended"][0, -1]) for one in alone],
    }


if __name__ == "__main__":
    print(json.dumps({name: compare(systems()) for name, systems in CASES.items()}))
