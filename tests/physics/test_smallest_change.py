"""The smallest change that silences: closed-form flutter of two degrees of freedom, brute force, and refusals."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

FRICTION = (0.3, 0.8)
# Points of brute force along each parameter.
FINE = 401


class Mass:
    """A mass of 1 kg on two springs at angles, and on a belt under a contact spring."""

    def __init__(self, seed: int) -> None:
        dice = np.random.default_rng(seed)
        self.angles = dice.uniform([0.2, 1.8], [1.2, 2.8])
        self.contact = dice.uniform(0.8, 1.6)
        self.springs = dice.uniform(0.6, 1.6, 2)

    def way(self, number: int) -> tuple[float, float]:
        return float(np.cos(self.angles[number])), float(np.sin(self.angles[number]))

    def system(self, first: float, second: float, friction: float, dashpot: float = 0.0) -> st.System:
        mass = st.PointMass(1.0, "mass")
        pairs = enumerate((first, second))
        parts = [st.Spring(mass.centre, stiffness=size, direction=(*self.way(k), 0.0)) for k, size in pairs]
        parts += [st.Dashpot(mass.centre, coefficient=dashpot, direction=way) for way in "xy" if dashpot]
        belt = st.RigidTrack(velocity=100.0)
        stiffness = st.LinearStiffness(self.contact)
        contact = st.PointContact(mass.centre, belt, friction=st.Coulomb(friction), stiffness=stiffness)
        return st.System(contact, drives=[st.Force(mass.centre, y=-10.0)], connections=parts)

    def matrix(self, first, second, friction):
        """Stiffness of the sliding mass: the friction is that of the contact spring, along the belt."""
        ways = [np.outer(self.way(k), self.way(k)) for k in (0, 1)]
        found = first[..., None, None] * ways[0] + second[..., None, None] * ways[1]
        found[..., 1, 1] += self.contact
        found[..., 0, 1] += friction * self.contact
        return found

    def slack(self, first, second):
        """Distance of both exponents from a merge and from divergence, at either end of the friction, in closed form.

        Both are affine in the friction, so that the ends decide.
        """
        least = np.inf
        for friction in FRICTION:
            k = self.matrix(np.asarray(first, dtype=float), np.asarray(second, dtype=float), friction)
            apart = 0.25 * (k[..., 0, 0] - k[..., 1, 1]) ** 2 + k[..., 0, 1] * k[..., 1, 0]
            least = np.minimum(least, np.minimum(apart, np.linalg.det(k)))
        return least


def flutters() -> list[int]:
    """Seeds of masses that flutter as given and are silenced by some change within 0.2 to 2 of each spring."""
    grid = np.meshgrid(*[np.linspace(0.2, 2.0, 60)] * 2, indexing="ij")
    masses = {seed: Mass(seed) for seed in range(60)}
    return [k for k, one in masses.items() if one.slack(*one.springs) < -1e-3 and (one.slack(*grid) > 0.0).any()]


SEEDS = flutters()
RANGES = {"first": (0.2, 2.0), "second": (0.2, 2.0)}


def test_the_closed_form_is_that_of_linear_theory():
    for seed in SEEDS[:4]:
        one = Mass(seed)
        for friction in FRICTION:
            modes = st.sliding_stability(one.system(*one.springs, friction))
            squares = np.linalg.eigvals(one.matrix(*map(np.asarray, one.springs), friction))
            expected = np.sqrt(-squares.astype(complex))
            expected = np.where(expected.imag < 0.0, -expected, expected)
            found = modes["growth_rate"].values + 2.0j * np.pi * modes["frequency"].values
            assert np.sort_complex(np.round(found, 9)) == pytest.approx(np.sort_complex(np.round(expected, 9)))


@pytest.mark.parametrize("seed", SEEDS[:4])
def test_two_springs_are_changed_as_little_as_the_flutter_boundary_allows(seed):
    one = Mass(seed)
    start = dict(zip(RANGES, map(float, one.springs), strict=True))
    found = st.smallest_change(one.system, RANGES, {"friction": FRICTION}, start=start, points=3)
    axes = [np.linspace(*RANGES[name], FINE) for name in RANGES]
    first, second = np.meshgrid(*axes, indexing="ij")
    sizes = np.hypot((first - start["first"]) / 1.8, (second - start["second"]) / 1.8)
    brute = sizes[one.slack(first, second) >= 0.0].min()
    cell = np.sqrt(2.0) / (FINE - 1)
    assert bool(found["found"])
    assert brute - cell - 1e-3 < float(found["size"]) < brute + 1e-3
    assert one.slack(*found["changed"].values) > -1e-6
    assert "no mode grows with first from" in found.attrs["verdict"]


def test_damped_growth_is_that_of_brute_force():
    """A spring and a dashpot, with a margin, against the eigenvalues on a grid."""
    one = Mass(SEEDS[0])
    margin, start = 0.02, {"first": float(one.springs[0]), "dashpot": 0.01}
    ranges = {"first": (0.2, 2.0), "dashpot": (0.01, 0.6)}

    def made(first, dashpot, friction):
        return one.system(first, one.springs[1], friction, dashpot)

    found = st.smallest_change(made, ranges, {"friction": FRICTION}, start=start, margin=margin, points=4, most=600)
    axes = [np.linspace(*ranges[name], 91) for name in ranges]
    first, dashpot = np.meshgrid(*axes, indexing="ij")
    worst = np.full(first.shape, -np.inf)
    for friction in np.linspace(*FRICTION, 13):
        k = one.matrix(first, np.full_like(first, one.springs[1]), friction)
        whole = np.zeros((*first.shape, 4, 4))
        whole[..., :2, 2:], whole[..., 2:, :2] = np.eye(2), -k
        whole[..., 2:, 2:] = -dashpot[..., None, None] * np.eye(2)
        worst = np.maximum(worst, np.linalg.eigvals(whole).real.max(axis=-1))
    sizes = np.hypot((first - start["first"]) / 1.8, (dashpot - 0.01) / 0.59)
    brute = sizes[worst <= -margin].min()
    assert bool(found["found"])
    assert brute - np.sqrt(2.0) / 90.0 - 1e-3 < float(found["size"]) < brute + 1e-3
    assert float(found["growth_rate"].max()) == pytest.approx(-margin, abs=1e-3)
    assert "decays by 0.02 1/s or more" in found.attrs["verdict"]


def test_keys_of_a_system_change_it_as_a_function_does():
    one = Mass(SEEDS[1])
    start = {"first": float(one.springs[0])}

    def made(first, friction):
        return one.system(first, one.springs[1], friction)

    options = {"points": 3, "most": 300}
    over = st.smallest_change(made, {"first": (0.05, 4.0)}, {"friction": FRICTION}, start=start, **options)
    system = one.system(*one.springs, 0.5)
    keys = {"connections.0.stiffness": (0.05, 4.0)}
    found = st.smallest_change(system, keys, {"friction.coefficient": FRICTION}, **options)
    assert bool(found["found"]) == bool(over["found"])
    assert float(found["size"]) == pytest.approx(float(over["size"]), abs=1e-4)


def test_a_mass_may_be_added():
    """Of a mass at the only body, the given one and the added one count alike."""
    one = Mass(SEEDS[0])
    system = one.system(*one.springs, 0.5)
    found = st.smallest_change(system, {}, masses={"lump": (("mass", "centre"), 2.0)}, most=100)
    # Both squares of frequencies scale alike, so that flutter stays.
    assert not bool(found["found"])
    assert found["units"].values.tolist() == ["kg"]
    assert "no change within the ranges was found" in found.attrs["verdict"]


def test_what_is_quiet_is_not_changed():
    one = Mass(SEEDS[0])
    quiet = one.system(1.0, 1.0, 0.0)
    found = st.smallest_change(quiet, {"connections.0.stiffness": (0.5, 2.0)}, most=100)
    assert float(found["size"]) == 0.0
    assert found.attrs["verdict"].startswith("no mode grows as given")


@pytest.mark.parametrize(
    ("words", "given"),
    [
        ("ranges must hold at least one key", {"ranges": {}, "start": {}}),
        ("must rise", {"ranges": {"first": (2.0, 1.0)}}),
        ("must contain the present value", {"start": {"first": 9.0}}),
        ("start must have a value for each", {"start": {}}),
        ("over must have other keys", {"over": {"first": (0.5, 1.0)}}),
        ("points must be", {"points": 1}),
        ("margin must be", {"margin": -1.0}),
        ("masses must be left out for a function", {"masses": {"a": (("mass", "centre"), 1.0)}}),
    ],
)
def test_wrong_arguments_are_refused(words, given):
    one = Mass(SEEDS[0])
    asked = {"source": one.system, "ranges": {"first": (0.2, 2.0)}, "start": {"first": 1.0}}
    with pytest.raises(ValueError, match=words):
        st.smallest_change(**(asked | given))
