"""Systems of every kind that slide steadily."""

from __future__ import annotations

from math import radians

import numpy as np

import stridula as st
from stridula.verification.systems.on_belts import Slider

STEEL, SQUARE = st.Material(2.1e11, 7800.0), st.Rectangle(0.01, 0.01)


def rod(degrees: float = 20.0, **words) -> st.FiniteElementBeam:
    return st.FiniteElementBeam(STEEL, SQUARE, 0.15, angle=radians(degrees), **{"elements": 4, "damping": 0.01} | words)


def bar(cutoff: float | None = None, **words) -> st.ModalBeam:
    kept = {"bending_modes": 6, "axial_modes": 3} if cutoff is None else {"cutoff": cutoff}
    return st.ModalBeam(STEEL, SQUARE, 0.4, **{"damping": 0.01} | kept | words)


def sheet(**words) -> st.ModalPlate:
    return st.ModalPlate(STEEL, 0.003, 0.3, 0.2, **{"bending_modes": (4, 3), "damping": 0.01} | words)


def dragged(track, at: float = 0.0, velocity: float = 0.05, degrees: float = 20.0, friction: float = 0.3, **words):
    """A rod whose root is drawn along x under 2 N."""
    slider = rod(degrees, **words)
    contact = st.PointContact(slider.tip, track, at=at, friction=st.Coulomb(friction))
    return st.System(contact, [st.ImposedVelocity(slider.root, velocity, 2.0)])


def hinged_on_a_belt() -> st.System:
    slider = rod(root_support="pinned")
    contact = st.PointContact(slider.tip, st.RigidTrack(velocity=-0.5), friction=st.Coulomb(0.3))
    return st.System(contact, [st.Force(slider.tip, y=-5.0)])


def up_a_slope() -> st.System:
    slider = rod()
    contact = st.PointContact(slider.tip, st.RigidTrack(), friction=st.Coulomb(0.2), inclination=0.2)
    return st.System(contact, [st.ImposedVelocity(slider.root, 0.01, 2.0)])


def pushed() -> st.System:
    """A rod that a force accelerates along a beam from rest."""
    slider, track = rod(), bar()
    contact = st.PointContact(slider.tip, track, at=0.17, friction=st.Coulomb(0.3))
    return st.System(contact, [st.Force(slider.root, x=1.0, y=-2.0)])


def mass_on_a_belt(law=None, stiffness: float = 1e3, braking: float = 5.0) -> st.System:
    return Slider(1.0, stiffness, 10.0, law or st.Coulomb(0.3), belt=0.5, dashpot=braking).system()


def mass_on_a_rising_belt() -> st.System:
    """A belt that leans and rises; spring and dashpot between the mass and the ground act along x alone."""
    belt = st.RigidTrack(velocity=0.5, normal_velocity=1e-3)
    return Slider(1.0, 1e3, 10.0, st.Coulomb(0.3), dashpot=5.0).system(belt, inclination=0.3)


def on_a_belt(body) -> st.System:
    """A beam or a plate pressed on a belt at one of its points."""
    point = body.at(0.12)
    contact = st.PointContact(point, st.RigidTrack(velocity=0.3), friction=st.Coulomb(0.3))
    return st.System(contact, [st.Force(point, y=-5.0)])


def reduced(law=None, damping=None) -> st.System:
    """A body given by matrices on two belts, one of them inclined."""
    half = np.random.default_rng(3).standard_normal((4, 4))
    stiffness = 1e4 * (half @ half.T + np.eye(4))
    points = {"p": (0, 1), "q": (2, 3)}
    body = st.ReducedBody(
        np.diag([1.0, 2.0, 0.5, 0.5]), stiffness, points, damping=2e-4 * stiffness if damping is None else damping
    )
    law = law or st.Coulomb(0.2)
    contacts = [
        st.PointContact(body.at("p"), st.RigidTrack(velocity=-1.0, name="u"), friction=law),
        st.PointContact(body.at("q"), st.RigidTrack(velocity=1.0, name="v"), friction=law, inclination=0.4),
    ]
    return st.System(contacts, [st.Force(body.at("p"), y=-300.0), st.Force(body.at("q"), x=200.0, y=-300.0)])


def block_on_two_feet() -> st.System:
    feet = {f"foot {k}": np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 2.0 * k - 1.0]]) for k in (0, 1)}
    body = st.ReducedBody(
        np.diag([1.0, 1.0, 0.3]), np.zeros((3, 3)), feet | {"centre": (0, 1)}, translation=np.eye(3)[:2]
    )
    contacts = [
        st.PointContact(body.at(foot), st.RigidTrack(velocity=1.0, name=f"under {foot}"), friction=st.Coulomb(0.3))
        for foot in feet
    ]
    joined = [st.Spring(body.at("centre"), stiffness=100.0), st.Dashpot(body.at("centre"), coefficient=1.0)]
    return st.System(contacts, [st.Gravity(10.0)], joined)


def two_rods() -> st.System:
    """One drawn over a beam, one hinged on a belt and sprung to the beam."""
    drawn, hinged, track = rod(name="drawn"), rod(-20.0, name="hinged", root_support="pinned"), bar()
    contacts = [
        st.PointContact(drawn.tip, track.at(0.1), friction=st.Coulomb(0.3)),
        st.PointContact(hinged.tip, st.RigidTrack(velocity=0.4), friction=st.Coulomb(0.2)),
    ]
    drives = [st.ImposedVelocity(drawn.root, 0.05, 2.0), st.Force(hinged.tip, y=-3.0)]
    return st.System(contacts, drives, [st.Spring(hinged.at(0.1), track.at(0.3), stiffness=1e4, direction="y")])


# Contacts that do not move along a bent track: nothing in them changes from step to step.
STEADY = {
    "hinged rod on a belt": hinged_on_a_belt,
    "rod drawn over a floor": lambda: dragged(st.RigidTrack()),
    "rod drawn up a slope": up_a_slope,
    "rod against a point of a beam": lambda: dragged(bar().at(0.17)),
    "rod against a point of a plate": lambda: dragged(sheet(in_plane=True, in_plane_modes=(3, 3)).at((0.1, 0.08))),
    "mass on a belt": mass_on_a_belt,
    "mass on a rising belt": mass_on_a_rising_belt,
    "mass on a belt, LuGre": lambda: mass_on_a_belt(st.LuGre(0.35, 0.3, 0.01, 1e4, 1.0, 0.05)),
    "mass on a belt, rate and state": lambda: mass_on_a_belt(st.RateAndState(0.5, 0.02, 0.01, 1e-2, 0.1)),
    "body given by matrices on two belts": reduced,
    "body with a damping of its own": lambda: reduced(damping=np.diag([3.0, 40.0, 8.0, 20.0])),
    "beam on a belt": lambda: on_a_belt(bar()),
    "plate on a belt": lambda: on_a_belt(sheet(in_plane=True, in_plane_modes=(3, 3))),
    "block on two feet": block_on_two_feet,
    "two rods, a beam and a spring": two_rods,
}
# Contacts that travel along a bent track.
TRAVELLING = {
    "rod drawn along a beam": lambda: dragged(bar(), 0.17),
    "rod drawn along a plate": lambda: dragged(sheet(), 0.17),
    "rod pushed along a beam": pushed,
}
