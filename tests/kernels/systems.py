"""Systems of all kinds: bodies, connections, tracks, laws, several contacts; each with the time step."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
from physics.cases import dragged, slider, track

import stridula as st
from stridula.verification.systems.on_belts import Slider

BELT = st.RigidTrack(velocity=0.02, name="belt")
WEAK = st.Stribeck(0.6, 0.35, 0.01)
MEASURED = st.TabulatedFriction([0.0, 0.01, 0.02, 0.05, 0.1, 0.3], [0.5, 0.48, 0.4, 0.36, 0.33, 0.36], 0.6)


def oscillator(friction, belt=BELT, load=5.0, **changes) -> st.System:
    """A mass on a belt, held by a spring and a dashpot along x, pressed down: the textbook's stick-slip."""
    return Slider(0.4, 3e3, load, friction, dashpot=1.5).system(belt, **changes)


def jointed(system: st.System, stiffness: float, damping: float = 0.0) -> st.System:
    """The same with a joint along the tangents of each contact whose law has no state."""
    contacts = [
        one if one.friction.has_state else replace(one, tangential_stiffness=stiffness, tangential_damping=damping)
        for one in system.contacts
    ]
    return replace(system, contact=contacts)


def heated(system: st.System, layers: dict[int, st.HeatedLayers | st.TemperatureHistory]) -> st.System:
    """The same with layers, or a history, under some contacts, whose friction fades from 20 to 60 degC to a half."""

    def half(law):
        return replace(law, **{name: 0.5 * getattr(law, name) for name in vars(law)})

    contacts = list(system.contacts)
    for number, heating in layers.items():
        law = st.FrictionOverTemperature([20.0, 60.0], [contacts[number].friction, half(contacts[number].friction)])
        contacts[number] = replace(contacts[number], friction=law, heating=heating)
    return replace(system, contact=contacts)


def chain() -> st.System:
    """Two masses in a row, coupled by springs and a dashpot, each on the belt with its own law."""
    one, two = st.PointMass(0.3, "one"), st.PointMass(0.5, "two")
    contacts = [
        st.PointContact(one.centre, BELT, friction=WEAK, name="first"),
        st.PointContact(two.centre, BELT, friction=st.ExponentialWeakening(0.7, 0.3, 0.1), name="second"),
    ]
    joints = [
        st.Spring(one.centre, stiffness=2e3),
        st.Spring(one.centre, two.centre, stiffness=4e3),
        st.Dashpot(one.centre, two.centre, coefficient=3.0),
    ]
    return st.System(contacts, [st.Gravity(), st.Force(two.centre, y=-3.0)], joints)


def bent_chain() -> st.System:
    """The same with springs that harden, that soften, and that have a play with kinks on both sides of the start."""
    one, two = st.PointMass(0.3, "one"), st.PointMass(0.5, "two")
    contacts = [
        st.PointContact(one.centre, BELT, friction=st.StaticKinetic(0.6, 0.4), name="first"),
        st.PointContact(two.centre, BELT, friction=st.Coulomb(0.3), name="second"),
    ]
    joints = [
        st.CubicSpring(one.centre, stiffness=1e3, cubic=4e8),
        st.TabulatedSpring(one.centre, two.centre, displacement=[-4e-4, 0.0, 3e-4, 5e-4], force=[-3.0, 0.0, 0.5, 2.5]),
        st.CubicSpring(two.centre, direction="y", stiffness=5e4, cubic=-2e9),
        st.TabulatedSpring(two.centre, displacement=[-1e-3, -2e-4, 2e-4, 1e-3], force=[-1.1, -0.1, 0.2, 1.8]),
        st.Dashpot(one.centre, two.centre, coefficient=1.0),
    ]
    return st.System(contacts, [st.Gravity(), st.Force(two.centre, y=-3.0, x=0.2)], joints)


def braked_chain() -> st.System:
    """The same with dashpots that yield, that are stiffer in one direction, and that are preloaded."""
    chained = bent_chain()
    one, two = (contact.tip.body for contact in chained.contacts)
    brakes = [
        st.TabulatedDashpot(one.centre, two.centre, velocity=[-1.0, -2e-3, 2e-3, 1.0], force=[-2.0, -0.1, 0.1, 1.5]),
        st.TabulatedDashpot(two.centre, direction="y", velocity=[-1.0, 0.0, 1.0], force=[-4.0, 0.0, 40.0]),
        st.TabulatedDashpot(one.centre, velocity=[0.01, 0.02], force=[0.05, 0.08]),
    ]
    return st.System(chained.contacts, chained.drives, [*chained.connections, *brakes])


def stop_of_a_beam() -> st.System:
    """Slider on a beam that meets a stop, and hangs on a hardening spring."""
    bar, rod = track(cutoff=3e3), slider(cutoff=6e3)
    contact = st.PointContact(rod.tip, bar, at=0.2, friction=st.Coulomb(1.3), gap=1e-8)
    joints = [
        st.TabulatedSpring(bar.at(0.35), direction="y", displacement=[-1e-7, -5e-8, 0.0], force=[-0.05, 0.0, 0.0]),
        st.CubicSpring(rod.root, stiffness=2e3, cubic=1e14),
    ]
    return st.System(contact, [st.Force(rod.root, transverse=0.5)], joints)


def pad(points=2, name="pad", **changes) -> st.ReducedBody:
    """A block of 0.2 kg: x, y and turn of its middle, and two inner freedoms at each foot, damped together."""
    half, height = 0.03, 0.02
    size = 3 + 2 * points
    mass, stiffness, damping = (
        np.diag([0.2, 0.2, 8e-5] + [0.02] * (2 * points)),
        np.zeros((size, size)),
        np.zeros((size, size)),
    )
    where = {"back": np.zeros((2, size))}
    # Turned by a small angle, a point at (x, y) moves by (-y, x) times it.
    where["back"][:, :3] = [[1.0, 0.0, -height], [0.0, 1.0, 0.0]]
    for n, x in enumerate(np.linspace(-half, half, points)):
        own = slice(3 + 2 * n, 5 + 2 * n)
        stiffness[own, own] = [[4e4, 1e4], [1e4, 9e4]]
        damping[own, own] = [[4.0, 2.0], [2.0, 6.0]]
        foot = np.zeros((2, size))
        foot[:, :3], foot[:, own] = [[1.0, 0.0, height], [0.0, 1.0, x]], np.eye(2)
        where[f"foot {n}"] = foot
    translation = np.zeros((2, size))
    translation[0, 0] = translation[1, 1] = 1.0
    return st.ReducedBody(mass, stiffness, where, damping=damping, translation=translation, name=name, **changes)


def pad_on(track, laws, at=0.0, gap=0.0, drives=()) -> st.System:
    """A block pressed on its feet, one law each, held by springs and a dashpot at its back; `drives` has its block."""
    block = pad(len(laws))
    spread = np.linspace(-0.03, 0.03, len(laws)) if at else np.zeros(len(laws))
    contacts = [
        st.PointContact(block.at(f"foot {n}"), track, at=at + spread[n], friction=law, gap=gap, name=f"foot {n}")
        for n, law in enumerate(laws)
    ]
    joints = [
        st.Spring(block.at("back"), stiffness=5e3),
        st.Dashpot(block.at("back"), coefficient=2.0),
        st.Spring(block.at("back"), stiffness=2e3, direction="y"),
    ]
    return st.System(contacts, [st.Force(block.at("back"), y=-6.0), *(drive(block) for drive in drives)], joints)


def on_a_beam(friction, angle=-30.0) -> st.System:
    """A leaning slider dragged over a beam, under another law than Coulomb's."""
    rod = slider(angle)
    contact = st.PointContact(rod.tip, track(), at=0.2, friction=friction, gap=1e-8)
    return st.System(contact, dragged(0.05, 3.0)(rod))


def sprung_beam() -> st.System:
    """Slider on a beam that a spring and a dashpot couple to the ground: the moving trace on coupled modes."""
    bar, rod = track(cutoff=3e3), slider(cutoff=6e3)
    contact = st.PointContact(rod.tip, bar, at=0.2, friction=st.Coulomb(1.3), gap=1e-8)
    joints = [
        st.Spring(bar.at(0.35), stiffness=2e4, direction="y"),
        st.Dashpot(bar.at(0.5), coefficient=5.0, direction="y"),
    ]
    return st.System(contact, [st.Force(rod.root, transverse=0.5)], joints)


def two_on_a_beam() -> st.System:
    """Two sliders on one beam, leaning against each other."""
    bar = track(cutoff=8e3)
    left, right = slider(35.0, cutoff=8e3, name="left"), slider(-50.0, cutoff=8e3, name="right")
    contacts = [
        st.PointContact(left.tip, bar, at=0.25, friction=st.Coulomb(0.8), gap=1e-8, name="a"),
        st.PointContact(right.tip, bar, at=0.5, friction=st.StaticKinetic(0.9, 0.5), gap=2e-8, name="b"),
    ]
    return st.System(contacts, [st.Force(left.root, transverse=0.5), st.Force(right.root, axial=-0.6)])


def plate(line=None, **changes) -> st.ModalPlate:
    """A sheet of steel of 0.3 m x 0.2 m x 1 mm."""
    words = {"damping": 0.01, "cutoff": 4e3, "line": line} | changes
    return st.ModalPlate(st.Material(2.1e11, 7800.0, 0.28), 0.001, 0.3, 0.2, **words)


def on_a_plate(line=None, angle=30.0, **changes) -> st.System:
    """A slider dragged over a plate."""
    sheet, rod = plate(line, **changes), slider(angle, cutoff=8e3)
    contact = st.PointContact(rod.tip, sheet, at=0.1, friction=st.Coulomb(0.9), gap=1e-8)
    return st.System(contact, dragged(0.05, 3.0)(rod))


def soft(line=None, **changes) -> st.ModalPlate:
    """A soft thick sheet whose modes in its plane are as low as those of bending, 0.3 m x 0.2 m x 40 mm."""
    words = {"damping": 0.02, "cutoff": 1.5e3, "line": line, "in_plane": True} | changes
    return st.ModalPlate(st.Material(2e7, 1000.0, 0.4), 0.04, 0.3, 0.2, **words)


def on_a_soft_plate(line=None, angle=-30.0, **changes) -> st.System:
    """A slider dragged over a plate that also moves in its plane."""
    sheet, rod = soft(line, **changes), slider(angle, cutoff=8e3)
    contact = st.PointContact(rod.tip, sheet, at=0.1, friction=st.Coulomb(0.9), gap=1e-8)
    return st.System(contact, dragged(0.05, 3.0)(rod))


def sprung_plate(sheet=None, direction="y") -> st.System:
    """A pad on three feet thrown along a diagonal of a plate that a spring and a dashpot hold."""
    sheet = sheet or plate(st.Line((0.05, 0.04), 0.5), cutoff=2e3)
    block = pad(3)
    laws = (st.Coulomb(0.6), st.StaticKinetic(0.5, 0.3), st.Coulomb(0.4))
    contacts = [
        st.PointContact(block.at(f"foot {n}"), sheet, at=0.1 + x, friction=law, gap=1e-8, name=f"foot {n}")
        for n, (x, law) in enumerate(zip((-0.03, 0.0, 0.03), laws, strict=True))
    ]
    joints = [
        st.Spring(block.at("back"), stiffness=5e3),
        st.Spring(block.at("back"), stiffness=2e3, direction="y"),
        st.Spring(sheet.at((0.2, 0.05)), stiffness=1e4, direction=direction),
        st.Dashpot(sheet.at(0.15), coefficient=2.0, direction=direction),
    ]
    return st.System(contacts, [st.InitialVelocity(block, x=0.2), st.Gravity()], joints)


def frozen() -> st.System:
    """A dragged slider against a point of a sprung block."""
    rod, block = slider(25.0, cutoff=8e3), pad()
    contact = st.PointContact(rod.tip, block.at("back"), friction=st.Coulomb(0.6), gap=1e-8)
    joints = [
        st.Spring(block.at("back"), stiffness=8e4, direction="y"),
        st.Spring(block.at("foot 0"), stiffness=3e4),
        st.Spring(block.at("foot 1"), stiffness=3e4),
    ]
    return st.System(contact, [st.ImposedVelocity(rod.root, 0.02, normal_load=3.0)], joints)


def groove() -> st.System:
    """A mass thrown into a groove of two walls at right angles, one of them shaken."""
    mass = st.PointMass(0.1)
    shaken = st.RigidTrack(velocity=0.05, normal_velocity=0.02, normal_history=st.Harmonic(60.0), name="shaken")
    contacts = [
        st.PointContact(mass.centre, shaken, inclination=-pi / 4, friction=st.Coulomb(0.4), gap=1e-4, name="left"),
        st.PointContact(
            mass.centre,
            st.RigidTrack(name="fixed"),
            inclination=pi / 4,
            friction=st.StaticKinetic(0.5, 0.3),
            gap=2e-4,
            name="right",
        ),
    ]
    return st.System(contacts, [st.Gravity(), st.InitialState(mass, (0.0, 1e-4), (0.1, -0.2))])


def inclined_pin() -> st.System:
    """A slider dragged over an inclined rigid plane that moves."""
    rod = slider(20.0, cutoff=8e3)
    plane = st.RigidTrack(velocity=-0.03, history=st.Ramp(0.01))
    contact = st.PointContact(rod.tip, plane, friction=st.Stribeck(0.5, 0.3, 0.02, 1.0, 0.4), inclination=0.3, gap=1e-8)
    return st.System(contact, [st.ImposedVelocity(rod.root, 0.02, 3.0, history=st.Harmonic(40.0, mean=0.5))])


def thrown_block() -> st.System:
    """Overdamped and free modes together: a block thrown at the floor, held by a strong dashpot."""
    block = pad()
    contacts = [
        st.PointContact(block.at(f"foot {n}"), st.RigidTrack(), friction=law, gap=1e-5, name=f"c{n}")
        for n, law in enumerate((st.Coulomb(0.5), st.LuGre(0.6, 0.4, 0.01, 2e4, 5.0)))
    ]
    drives = [st.InitialState(block, velocity=(0.1, -0.3, 2.0, 0.0, 0.1, 0.0, 0.0)), st.Gravity()]
    return st.System(contacts, drives, [st.Dashpot(block.at("back"), coefficient=300.0)])


SHAKEN = st.RigidTrack(0.03, 0.01, st.Constant(), st.Harmonic(90.0), name="shaken")
BRISTLES = st.LuGre(0.6, 0.4, 0.02, 2e4, 20.0, 0.1)
AGING = st.RateAndState(0.5, 0.01, 0.015, 1e-4, 1e-3)


def block_on_a_plane() -> st.System:
    """A block in space that slides along one side."""
    size, steel = (0.04, 0.01, 0.02), st.Material(2.1e11, 7800.0, 0.3)
    block = st.SolidBody.block(size, (2, 1, 1), steel, cutoff=30e3, name="block")
    contact = st.PointContact(block.at((0.02, 0.0, 0.01)), st.RigidTrack(velocity=0.1), normal=(0.0, 1.0, 0.0))
    return st.System(contact, [st.Force(block.at("top"), y=-10.0)])


ROUGH = st.RigidTrack(velocity=0.02, profile=st.Profile.random(1e-6, 3e-4, 0.01, seed=1), name="rough belt")
DIP = [0.0, 0.0, -2e-5, -3e-5, -1e-5, 0.0, 0.0]
DIPPED = st.RigidTrack(profile=st.Profile(np.linspace(1e-3, 7e-3, 7), DIP), name="floor with a dip")
WAVES = st.RigidTrack(0.1, 0.01, st.Ramp(0.02), profile=st.Profile.sine(2e-5, 6e-3, 1.0), name="corrugated belt")

# Name -> function that makes the system, and the step [s].
SYSTEMS = {
    "mass on a belt, static and kinetic": (lambda: oscillator(st.StaticKinetic(0.6, 0.4)), 2e-4),
    "mass on a belt, weakening linearly": (lambda: oscillator(st.LinearWeakening(0.6, 1.5, 0.3)), 2e-4),
    "mass on a belt, tabulated": (lambda: oscillator(MEASURED), 2e-4),
    "mass on a belt, bristles": (lambda: oscillator(BRISTLES), 2e-4),
    "mass on a belt, aging": (lambda: oscillator(AGING), 2e-4),
    "mass on a belt, slip law": (
        lambda: oscillator(st.RateAndState(0.5, 0.015, 0.01, 1e-4, 1e-3, "slip", 0.3), inclination=-0.2),
        2e-4,
    ),
    "mass on a belt, fading": (
        lambda: heated(oscillator(st.StaticKinetic(0.6, 0.4)), {0: st.HeatedLayers([2e-4, 3e-4], 1e-3, 2e-3)}),
        2e-4,
    ),
    "pad on a belt, fading": (
        lambda: heated(
            pad_on(SHAKEN, [st.Coulomb(0.4), WEAK, st.StaticKinetic(0.5, 0.3)]),
            {0: st.TemperatureHistory([0.0, 0.05], [20.0, 50.0]), 2: st.HeatedLayers(1e-3, share=1.0)},
        ),
        1e-4,
    ),
    "mass on a belt, joint": (lambda: jointed(oscillator(st.Coulomb(0.6)), 1e4), 2e-4),
    "mass on a belt, damped joint": (lambda: jointed(oscillator(WEAK), 2e4, 3.0), 2e-4),
    "chain on a belt": (chain, 2e-4),
    "chain of nonlinear springs": (bent_chain, 2e-4),
    "chain of nonlinear dashpots": (braked_chain, 2e-4),
    "beam with a stop": (stop_of_a_beam, 5e-6),
    "pad on a shaken belt": (lambda: pad_on(SHAKEN, [st.Coulomb(0.4), WEAK, st.StaticKinetic(0.5, 0.3)]), 1e-4),
    "mass on a rough belt": (lambda: oscillator(st.StaticKinetic(0.6, 0.4), ROUGH), 2e-4),
    "mass thrown over a dip": (
        lambda: pad_on(DIPPED, [st.Coulomb(0.2)], drives=[lambda block: st.InitialVelocity(block, x=0.3)]),
        1e-4,
    ),
    "pad on a corrugated belt": (
        lambda: pad_on(WAVES, [st.Coulomb(0.4), WEAK, st.StaticKinetic(0.5, 0.3)], 2e-3),
        1e-4,
    ),
    "pad on a beam": (
        lambda: pad_on(
            track(cutoff=8e3), [st.Coulomb(0.6)] * 2, 0.3, 1e-8, [lambda block: st.InitialVelocity(block, x=0.2)]
        ),
        5e-6,
    ),
    "pad on a belt, bristles and age": (lambda: pad_on(BELT, [BRISTLES, AGING]), 1e-4),
    "pad on a belt, joints and age": (lambda: jointed(pad_on(BELT, [st.Coulomb(0.4)] * 2 + [AGING]), 2e4, 1.0), 1e-4),
    "slider, joint": (lambda: jointed(on_a_beam(st.ExponentialWeakening(1.2, 0.6, 0.05)), 1e7), 5e-6),
    "slider, exponential": (lambda: on_a_beam(st.ExponentialWeakening(1.2, 0.6, 0.05)), 5e-6),
    "slider, viscous": (lambda: on_a_beam(st.Stribeck(0.9, 0.5, 0.01, 0.8, 2.0), angle=40.0), 5e-6),
    "slider, bristles": (lambda: on_a_beam(st.LuGre(1.0, 0.7, 0.01, 1e5, 10.0)), 5e-6),
    "beam on a spring": (sprung_beam, 5e-6),
    "two sliders": (two_on_a_beam, 5e-6),
    "plate": (on_a_plate, 5e-6),
    "diagonal of a plate": (lambda: on_a_plate(st.Line((0.25, 0.03), 2.3), -30.0), 5e-6),
    "sprung plate": (sprung_plate, 5e-6),
    "plate soft in its plane": (on_a_soft_plate, 5e-6),
    "diagonal of a plate soft in its plane": (lambda: on_a_soft_plate(st.Line((0.25, 0.03), 2.3)), 5e-6),
    "sprung plate soft in its plane": (lambda: sprung_plate(soft(st.Line((0.05, 0.04), 0.5), cutoff=800.0), "x"), 5e-6),
    "frozen contact": (frozen, 5e-6),
    "groove": (groove, 1e-4),
    "inclined plane": (inclined_pin, 5e-6),
    "thrown block": (thrown_block, 1e-4),
}
