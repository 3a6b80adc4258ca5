"""Linear theory eliminates residual shapes: exponents are those of the plain form, in which each keeps its equation."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import stridula as st
from physics import plain_massless
from stridula.linear.equilibrium import find_equilibrium
from stridula.linear.given import given_status, given_velocity
from stridula.linear.massless import massless_exponents
from stridula.linear.structure import Structure
from stridula.linear.vibration import vibration

LAWS = {
    "coulomb": st.Coulomb(0.3),
    "static and kinetic": st.StaticKinetic(0.4, 0.3),
    "stribeck": st.Stribeck(0.4, 0.2, 0.5, viscous=0.1),
    "exponential": st.ExponentialWeakening(0.4, 0.2, 0.5),
    "linear": st.LinearWeakening(0.4, 0.1, 0.2),
    "lugre": st.LuGre(0.4, 0.3, 0.2, 1e3, 1.0, 0.1),
    "aging": st.RateAndState(0.5, 0.02, 0.03, 0.1, 0.5),
    "slip": st.RateAndState(0.5, 0.02, 0.03, 0.1, 0.5, evolution="slip"),
    "none": st.Coulomb(0.0),
}
POINTS = ("p", "q", "r")
STATUSES = {
    "sliding": ["sliding"] * 4,
    "mixed": ["sliding", "sticking", "separated", "sliding"],
    "sticking": ["sticking"] * 4,
}


def body(seed: int, size: int, name: str, axes: int) -> st.ReducedBody:
    """A random body of which half of the modes are cut off."""
    random = np.random.default_rng(seed)
    half = random.standard_normal((size, size))
    stiffness = 1e4 * (half @ half.T + np.eye(size))
    mass = np.diag(random.uniform(1.0, 2.0, size))
    middle = np.sqrt(np.median(scipy.linalg.eigvalsh(stiffness, mass))) / (2.0 * np.pi)
    points = {word: random.standard_normal((axes, size)) for word in POINTS}
    return st.ReducedBody(mass, stiffness, points, damping=0.01, cutoff=float(middle), name=name)


def system(law: st.FrictionLaw, stiffness: float | None, axes: int, dashpot: bool) -> st.System:
    """Two bodies on belts of different speeds, in contact with each other and joined by a spring."""
    first, second = body(1, 24, "first", axes), body(2, 18, "second", axes)
    ways = {"normal": (0.0, 1.0, 0.0), "tangent": (1.0, 0.0, 0.0)} if axes == 3 else {}
    lateral = {"lateral_velocity": 0.3} if axes == 3 else {}
    belts = [st.RigidTrack(velocity=-0.2 * (k + 1), **lateral, name=f"belt {k}") for k in range(3)]
    words = {"friction": law, "stiffness": stiffness, **ways}
    contacts = [
        st.PointContact(first.at("p"), belts[0], **words),
        st.PointContact(first.at("q"), belts[1], **words),
        st.PointContact(second.at("p"), belts[2], **words),
        st.PointContact(first.at("r"), second.at("q"), **words | {"friction": st.Coulomb(0.2)}),
    ]
    loads = [st.Force(one.at("r"), x=3.0, y=-500.0) for one in (first, second)]
    joined = [st.Spring(first.at("p"), second.at("r"), stiffness=1e4, direction="x")]
    joined += [st.Dashpot(second.at("p"), coefficient=20.0, direction="y")] if dashpot else []
    return st.System(contacts, loads, joined)


def motion_of(found: st.System, status: list[str]):
    """The small motions about the equilibrium with some statuses, the last contact slides at a given velocity."""
    structure = Structure(found)
    chosen = given_status(status, found)
    given = [0.0, 0.0, 0.0, 0.4 if status[3] == "sliding" else 0.0]
    velocity = given_velocity(given if any(given) else None, structure, chosen)
    return vibration(structure, find_equilibrium(structure, velocity, chosen))


def assert_same(found, known) -> None:
    """Both have the same exponents in any order, to the rounding of an eigenvalue problem of a few dozen unknowns."""
    assert found.size == known.size
    # Overdamped motions without mass have exponents of any size, each with its own rounding.
    distance = np.abs(found[:, None] - known) / (np.abs(known) + np.median(np.abs(known)))
    rows, columns = scipy.optimize.linear_sum_assignment(distance)
    assert distance[rows, columns].max() < 1e-8


@pytest.mark.parametrize("axes", [2, 3])
@pytest.mark.parametrize(("name", "stiffness"), list(product(LAWS, [None, 2e4])))
def test_condensed_exponents_are_those_of_the_plain_form(name, stiffness, axes):
    for word, status in STATUSES.items():
        if word != "sliding" and not LAWS[name].set_valued:
            continue
        motion = motion_of(system(LAWS[name], stiffness, axes, word == "mixed"), status)
        assert (motion.mass == 0.0).sum() > 5
        found, alone = massless_exponents(motion), massless_exponents(motion, shapes=False)
        known = plain_massless.exponents(motion)
        assert_same(found.values, known)
        assert_same(alone.values, known)
        solves(motion, found)
        if (axes, name, word) == (3, "coulomb", "sliding"):
            # Across their slip, residual shapes creep: one more exponent for each contact.
            assert found.values.size == (motion.mass > 0.0).sum() + 4


def solves(motion, found) -> None:
    """Every shape satisfies the equations of motion with some forces on its constraints."""
    for value, shape in zip(found.values, found.shapes.T, strict=True):
        moved = motion.from_displacement @ shape + value * (motion.from_velocity @ shape)
        states = moved / (value - motion.state)
        terms = [motion.mass * value**2 * shape, value * (motion.damping @ shape), motion.stiffness @ shape]
        terms.append(motion.by_state @ states)
        size = max(np.abs(one).max() for one in terms)
        left = sum(terms)
        pushes = motion.pushes.T
        left = left - pushes @ np.linalg.lstsq(pushes, left, rcond=None)[0] if len(motion.held) else left
        assert np.abs(left).max() < 1e-7 * size
        assert np.abs(motion.held @ shape).max(initial=0.0) < 1e-9 * np.abs(shape).max()


@pytest.mark.parametrize("word", ["damping", "stiffness"])
def test_the_plain_form_distinguishes_other_forces(word):
    """Negative control: a hundredth more of a matrix gives other exponents."""
    motion = motion_of(system(LAWS["coulomb"], 2e4, 3, False), STATUSES["sliding"])
    known = plain_massless.exponents(motion)
    getattr(motion, word)[:] *= 1.01
    with pytest.raises(AssertionError):
        assert_same(massless_exponents(motion).values, known)
