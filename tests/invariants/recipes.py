"""Random systems as plain numbers, which can be mirrored and scaled before they are built.

A recipe is two or three masses in a row, a block on one to three feet, or a leaning slider on a beam; with springs,
dashpots, rigid tracks that move and every law of friction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np
from hypothesis import strategies as some
from physics.cases import STEEL, STRIP

import stridula as st

BEAM_LENGTH = 0.8
WAVELENGTH, WAVE_PHASE = 3e-3, 0.7
KINDS = ["coulomb", "static", "stribeck", "exponential", "linear", "tabulated", "lugre", "aging", "slip"]


@dataclass(frozen=True)
class Foot:
    """One contact: its law and its rigid track, whose surface has waves; lengths in m, velocities in m/s."""

    law: object
    gap: float
    inclination: float
    belt: float
    lift: float
    frequency: float
    wave: float = 0.0


@dataclass(frozen=True)
class Recipe:
    """A system: kind is "chain", "block" or "slider"."""

    kind: str
    feet: tuple[Foot, ...]
    masses: tuple[float, ...]
    springs: tuple[float, ...]
    dashpots: tuple[float, ...]
    load: float
    speed: float
    angle: float

    @property
    def step(self) -> float:
        return 5e-6 if self.kind == "slider" else 5e-5


def span(low, high):
    """Numbers spread evenly on a logarithmic scale, rounded so that a failing example can be read."""
    return some.floats(np.log10(low), np.log10(high)).map(lambda e: float(f"{10**e:.3g}"))


def number(low, high):
    return some.floats(low, high).map(lambda x: round(x, 4))


@some.composite
def laws(draw):
    kinetic = draw(number(0.05, 0.8))
    static = round(kinetic + draw(number(0.0, 0.6)), 4)
    velocity = draw(span(1e-3, 0.3))
    kind = draw(some.sampled_from(KINDS))
    if kind == "coulomb":
        return st.Coulomb(draw(some.sampled_from((0.0, kinetic, static))))
    if kind == "static":
        return st.StaticKinetic(static, kinetic)
    if kind == "stribeck":
        return st.Stribeck(static, kinetic, velocity, draw(number(0.5, 2.0)), draw(number(0.0, 1.0)))
    if kind == "exponential":
        return st.ExponentialWeakening(static, kinetic, velocity)
    if kind == "linear":
        return st.LinearWeakening(static, draw(number(0.0, 2.0)), kinetic)
    if kind == "tabulated":
        speeds = [0.0, round(velocity, 6), round(3.0 * velocity, 6), 2.0]
        return st.TabulatedFriction(
            speeds, [draw(number(0.05, 0.8)) for _ in speeds], 0.8 if draw(some.booleans()) else None
        )
    if kind == "lugre":
        return st.LuGre(static, kinetic, velocity, draw(span(1e3, 1e6)), draw(number(0.0, 2.0)), draw(number(0.0, 1.0)))
    a, b = draw(number(0.005, 0.03)), draw(number(0.005, 0.03))
    return st.RateAndState(static, a, b, draw(span(1e-6, 1e-3)), velocity, kind)


@some.composite
def recipes(draw, kinds=("chain", "block", "slider"), law=None, closed=False):
    kind = draw(some.sampled_from(kinds))
    count = 1 if kind == "slider" else draw(some.integers(1, 3))
    feet = tuple(
        Foot(
            law=draw(law if law is not None else laws()),
            gap=0.0 if closed else draw(some.sampled_from((0.0, 1e-6, 3e-5))),
            inclination=draw(number(-0.5, 0.5)) if kind == "chain" and not closed else 0.0,
            belt=draw(some.sampled_from((0.0, 0.03, -0.2))),
            lift=0.0 if closed else draw(some.sampled_from((0.0, 0.02))),
            frequency=draw(number(30.0, 200.0)),
            wave=0.0 if closed else draw(some.sampled_from((0.0, 2e-6))),
        )
        for _ in range(count)
    )
    return Recipe(
        kind=kind,
        feet=feet,
        masses=tuple(draw(span(0.05, 2.0)) for _ in range(count)),
        springs=tuple(draw(span(1e2, 1e6)) for _ in range(count)),
        dashpots=tuple(draw(span(0.01, 100.0)) for _ in range(count)),
        load=draw(span(0.5, 50.0)),
        speed=draw(some.sampled_from((0.0, 0.1, -0.3))),
        angle=draw(number(-50.0, 50.0)),
    )


@dataclass(frozen=True)
class Units:
    """Size of a metre, a kilogram and a second in new units; `sense` is -1 in the mirror image along x."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0
    sense: float = 1.0

    @property
    def velocity(self):
        return self.length / self.time

    @property
    def force(self):
        return self.mass * self.length / self.time**2

    @property
    def energy(self):
        return self.force * self.length


def converted(law, units: Units):
    """The law of friction in other units."""
    v = units.velocity
    if isinstance(law, (st.Coulomb, st.StaticKinetic)):
        return law
    if isinstance(law, st.TabulatedFriction):
        return replace(law, velocity=[speed * v for speed in law.velocity])
    if isinstance(law, st.LinearWeakening):
        return replace(law, slope=law.slope / v)
    if isinstance(law, st.Stribeck):
        return replace(law, velocity=law.velocity * v, viscous=law.viscous / v)
    if isinstance(law, st.ExponentialWeakening):
        return replace(law, velocity=law.velocity * v)
    if isinstance(law, st.LuGre):
        return replace(
            law,
            velocity=law.velocity * v,
            stiffness=law.stiffness / units.length,
            damping=law.damping / v,
            viscous=law.viscous / v,
        )
    return replace(law, velocity=law.velocity * v, slip_distance=law.slip_distance * units.length)


def rigid(foot: Foot, units: Units) -> st.RigidTrack:
    shaking = st.Harmonic(foot.frequency / units.time)
    phase = WAVE_PHASE if units.sense > 0.0 else pi - WAVE_PHASE
    wave = st.Profile.sine(foot.wave * units.length, WAVELENGTH * units.length, phase) if foot.wave else None
    return st.RigidTrack(
        units.sense * foot.belt * units.velocity,
        foot.lift * units.velocity,
        normal_history=shaking,
        name="track",
        profile=wave,
    )


def build(recipe: Recipe, units: Units | None = None) -> st.System:
    """The system of a recipe in given units."""
    units = units or Units()
    return {"chain": chain, "block": block, "slider": slider}[recipe.kind](recipe, units)


def chain(recipe, units):
    bodies = [st.PointMass(m * units.mass, f"mass {n}") for n, m in enumerate(recipe.masses)]
    contacts, joints, drives = [], [], []
    for n, (body, foot) in enumerate(zip(bodies, recipe.feet, strict=True)):
        contacts.append(
            st.PointContact(
                body.centre,
                rigid(foot, units),
                friction=converted(foot.law, units),
                gap=foot.gap * units.length,
                inclination=units.sense * foot.inclination,
                name=f"contact {n}",
            )
        )
        stiffness = recipe.springs[n] * units.mass / units.time**2
        joints.append(st.Spring(body.centre, bodies[n - 1].centre if n else None, stiffness=stiffness))
        coefficient = recipe.dashpots[n] * units.mass / units.time
        joints.append(st.Dashpot(body.centre, bodies[n - 1].centre if n else None, coefficient=coefficient))
        drives.append(st.Force(body.centre, y=-recipe.load * units.force))
    if recipe.speed:
        drives.append(st.InitialVelocity(bodies[0], x=units.sense * recipe.speed * units.velocity))
    return st.System(contacts, drives, joints)


def block(recipe, units):
    """x, y and turn of a rigid block, its turn as the motion of its edge at half its length, and compliant feet."""
    count = len(recipe.feet)
    size = 3 + 2 * count
    mass = np.diag([recipe.masses[0]] * 2 + [recipe.masses[0] / 3] + [0.05 * recipe.masses[0]] * (2 * count))
    stiffness, damping = np.zeros((size, size)), np.zeros((size, size))
    places = np.linspace(-1.0, 1.0, count) if count > 1 else np.zeros(1)
    points = {"back": np.zeros((2, size))}
    points["back"][:, :3] = [[1.0, 0.0, -0.5], [0.0, 1.0, 0.0]]
    for n, place in enumerate(places):
        own = slice(3 + 2 * n, 5 + 2 * n)
        k, c = recipe.springs[n], recipe.dashpots[n]
        cross = 0.3 * units.sense
        stiffness[own, own] = k * np.array([[1.0, cross], [cross, 2.0]])
        damping[own, own] = c * np.array([[1.0, -cross], [-cross, 0.5]])
        row = np.zeros((2, size))
        row[:, :3] = [[1.0, 0.0, 0.5], [0.0, 1.0, units.sense * place]]
        row[:, own] = np.eye(2)
        points[f"foot {n}"] = row
    translation = np.zeros((2, size))
    translation[0, 0] = translation[1, 1] = 1.0
    body = st.ReducedBody(
        mass * units.mass,
        stiffness * units.mass / units.time**2,
        points,
        damping=damping * units.mass / units.time,
        translation=translation,
        name="block",
    )
    contacts = [
        st.PointContact(
            body.at(f"foot {n}"),
            rigid(foot, units),
            friction=converted(foot.law, units),
            gap=foot.gap * units.length,
            name=f"contact {n}",
        )
        for n, foot in enumerate(recipe.feet)
    ]
    joints = [st.Spring(body.at("back"), stiffness=0.1 * recipe.springs[0] * units.mass / units.time**2)]
    drives = [st.Force(body.at("back"), y=-recipe.load * units.force)]
    if recipe.speed:
        drives.append(st.InitialVelocity(body, x=units.sense * recipe.speed * units.velocity))
    return st.System(contacts, drives, joints)


def slider(recipe, units):
    foot = recipe.feet[0]
    material = st.Material(
        STEEL.young * units.mass / units.length / units.time**2, STEEL.density * units.mass / units.length**3
    )
    strip = st.Rectangle(STRIP.width * units.length, STRIP.height * units.length)
    words = {"damping": 0.02, "cutoff": 6e3 / units.time}
    rod = st.FiniteElementBeam(
        material, strip, 0.5 * units.length, angle=units.sense * recipe.angle * pi / 180, elements=6, **words
    )
    bar = st.ModalBeam(material, strip, BEAM_LENGTH * units.length, **words)
    at = 0.3 if units.sense > 0 else BEAM_LENGTH - 0.3
    contact = st.PointContact(
        rod.tip, bar, at=at * units.length, friction=converted(foot.law, units), gap=foot.gap * units.length
    )
    velocity = units.sense * (recipe.speed or 0.05) * units.velocity
    joints = [st.Dashpot(bar.centre, coefficient=recipe.dashpots[0] * units.mass / units.time, direction="y")]
    drives = [st.ImposedVelocity(rod.root, velocity, normal_load=recipe.load * units.force)]
    return st.System(contact, drives, joints if foot.lift else [])


def run_of(recipe: Recipe, scheme, steps: int, units: Units | None = None, **words):
    """Every step of a recipe."""
    step = recipe.step * (units.time if units else 1.0)
    return st.simulate(
        build(recipe, units), steps * step, scheme=scheme, step=step, sample_rate=1 / step, probes=[], **words
    )
