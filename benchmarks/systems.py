"""The systems to time, and their march without a record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import radians

import numpy as np
import xarray as xr

import stridula as st
from ratios import must_agree, sized
from stridula._kernels.layout import columns as at
from stridula.integration.marches import Excitation, March, imposed_on
from stridula.integration.start import state_at_start
from stridula.lowering import assemble
from stridula.lowering.blocks import Blocks, blocks_of
from stridula.records.state import State
from stridula.scenarios import load_scenario

SCHEME = st.ExactModal()
REGIMES = ("separated", "sticking", "sliding")
STEEL, STRIP = st.Material(2.1e11, 7800.0), st.Rectangle(0.020, 0.008)
# Elements of the slider, bending and axial modes of the track, by the resulting number of modes.
SIZES = {
    30: (4, 10, 6),
    60: (9, 18, 12),
    100: (19, 25, 17),
    160: (30, 40, 26),
    200: (39, 50, 30),
    400: (80, 100, 60),
}
FEET = 8
# Lines on a plate: along a side, where each mode is one wave, and across, where it is two.
LINES = {"along a side": None, "across": st.Line((0.05, 0.05), 0.4)}
# Time over which runs agree that differ by round-off alone [s], and tolerance relative to the largest force.
BEFORE_CHAOS, TOLERANCE = 0.02, 1e-6
FORCES = [at.NORMAL_FORCE, at.TANGENTIAL_FORCE]
# Number and options of the runs marched side by side.
RUNS, GIVEN = sized(64, 8), {"duration": sized(1.0, 0.05), "sample_rate": 1e3, "probes": ()}


def beams(size: tuple[int, int, int], regime: str) -> st.System:
    """Return a slider on a track that stays in a regime."""
    elements, bending, axial = size
    rod = st.FiniteElementBeam(STEEL, STRIP, 0.5, radians(20.0), elements=elements, damping=0.2)
    track = st.ModalBeam(STEEL, STRIP, 1.3, bending_modes=bending, axial_modes=axial, damping=0.2)
    choices = {"separated": (0.5, 0.5, 0.0), "sticking": (3.0, 0.0, 0.1), "sliding": (0.1, 0.0, 0.3)}
    friction, gap, push = choices[regime]
    contact = st.PointContact(rod.tip, track, at=0.3, friction=st.Coulomb(friction), gap=gap)
    return st.System(contact, [st.Force(rod.root, y=-1.0, x=push)])


def on_a_beam(modes: int) -> st.System:
    """Return a short rod that slides on a beam with bending modes only, like a plate."""
    return sliding_on(st.ModalBeam(STEEL, STRIP, 0.5, bending_modes=modes, axial_modes=0, damping=0.2))


def on_a_plate(modes: int, line: str) -> st.System:
    """Return the same rod on a plate of some number of modes, along a line on it."""
    count = next(n for n in range(2, modes) if n * -(-modes // n) >= modes and n * n >= 0.4 * modes)
    material = st.Material(2.1e11, 7800.0, poisson=0.3)
    sheet = st.ModalPlate(
        material, 0.004, 0.5, 0.3, bending_modes=(-(-modes // count), count), damping=0.2, line=LINES[line]
    )
    return sliding_on(sheet)


def sliding_on(track: st.ModalBeam | st.ModalPlate) -> st.System:
    """Return a rod that slides on a track."""
    rod = st.FiniteElementBeam(STEEL, STRIP, 0.5, radians(20.0), elements=9, damping=0.2)
    contact = st.PointContact(rod.tip, track, at=0.1, friction=st.Coulomb(0.1))
    return st.System(contact, [st.Force(rod.root, y=-1.0, x=0.3)])


@cache
def shipped_squeal() -> st.System:
    """Return the shipped squeal case, read once."""
    return load_scenario("squeal").system


def squeal(angle: float, friction: float) -> st.System:
    """Return the shipped squeal case at another angle [rad] and friction."""
    shipped = shipped_squeal()
    rod = replace(shipped.slider, angle=angle)
    contact = replace(shipped.contact, tip=rod.tip, friction=st.Coulomb(friction))
    return st.System(contact, [st.Force(rod.root, transverse=shipped.drives[0].transverse)])


def squeals(runs: int) -> list[st.System]:
    """Return variants of the squeal case, friction by angle."""
    frictions = np.linspace(0.5, 2.0, 8)
    angles = np.radians(np.linspace(30.0, 60.0, -(-runs // frictions.size)))
    return [squeal(angle, friction) for angle in angles for friction in frictions][:runs]


def same_start(found: Sequence[xr.Dataset], expected: Sequence[xr.Dataset]) -> None:
    """Exit if the forces of two lists of runs differ before chaos separates them."""
    here, there = ([run.normal_force.sel(time=slice(0.0, BEFORE_CHAOS)) for run in runs] for runs in (found, expected))
    must_agree("normal forces of the same runs at the start", here, there, TOLERANCE)


def pad(contacts: int) -> st.System:
    """Return a block on eight springy feet, some of them on a belt: the same modes for any number of contacts."""
    size = 2 + 2 * FEET
    stiffness, both = np.zeros((size, size)), np.zeros((2, size))
    both[:, :2] = np.eye(2)
    points = {"back": both}
    for number in range(FEET):
        own = slice(2 + 2 * number, 4 + 2 * number)
        stiffness[own, own] = [[4e4, 1e4], [1e4, 9e4]]
        points[f"foot {number}"] = both.copy()
        points[f"foot {number}"][:, own] = np.eye(2)
    mass = np.diag([0.2, 0.2] + [0.02] * (2 * FEET))
    block = st.ReducedBody(mass, stiffness, points, damping=0.02, translation=both, name="pad")
    belt = st.RigidTrack(velocity=0.02)
    feet = [block.at(f"foot {number}") for number in range(contacts)]
    touching = [
        st.PointContact(foot, belt, friction=st.Coulomb(0.4), name=f"foot {number}") for number, foot in enumerate(feet)
    ]
    held = [st.Spring(block.at("back"), stiffness=5e3)]
    return st.System(touching, [st.Force(foot, y=-2.0) for foot in feet], held)


def slab(contacts: int, modes: int) -> st.System:
    """Return a body of given modes, pressed on a belt at points along it: every mode moves every point both ways."""
    order = np.arange(modes) // 2
    lean = np.where(np.arange(modes) % 2, 1.2, 0.3)
    positions = (np.arange(contacts) + 0.5) / contacts
    waves = np.cos(np.pi * order * positions[:, None]) * np.sqrt(2.0 / 0.5)
    points = {f"point {j}": np.stack([np.sin(lean), np.cos(lean)]) * wave for j, wave in enumerate(waves)}
    stiffness = np.diag((2.0 * np.pi * (300.0 + 150.0 * order)) ** 2 * (1.0 + 0.3 * (np.arange(modes) % 2)))
    body = st.ReducedBody(np.eye(modes), stiffness, points, damping=0.02, name="slab")
    belt, feet = st.RigidTrack(velocity=0.02), [body.at(name) for name in points]
    touching = [st.PointContact(foot, belt, friction=st.Coulomb(0.4), name=foot.position) for foot in feet]
    return st.System(touching, [st.Force(foot, y=-2.0) for foot in feet])


@dataclass(frozen=True)
class Case:
    """A run prepared to march, with constant loads and imposed motion.

    Attributes
    ----------
    blocks : Blocks
        The system in the arrays of the march.
    state : State
        Initial state.
    imposed : Excitation
        Signals and motion: one row where they are constant and the march accepts one.
    """

    blocks: Blocks
    state: State
    imposed: Excitation


def limit_of(system: st.System) -> float:
    """Return the largest step of a system [s]."""
    arrays = assemble(system, [])
    return SCHEME.limit(arrays.angular_frequency, arrays.damping_rate)


def case_of(system: st.System, step: float, steps: int = 1) -> Case:
    """Return a system prepared to march; imposed motion has several steps where the march does not accept one row."""
    arrays = assemble(system, [])
    blocks = blocks_of(arrays, SCHEME, step)
    whole = imposed_on(arrays, blocks.used, 0, steps, step)
    imposed = Excitation(whole.signals, whole.motion[:1], whole.angles[:1]) if steps == 1 else whole
    return Case(blocks, state_at_start(arrays, SCHEME, step, blocks, st.GaussSeidel()), imposed)


def marching(march: March, some: Sequence[Case], samples: int) -> Callable[[], object]:
    """Return a function that marches runs by a number of samples, from the same state in each call."""
    imposed = [one.imposed for one in some]
    return lambda: march.copy().advance(imposed, samples)
