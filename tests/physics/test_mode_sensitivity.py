"""Derivatives of modes: closed forms, central differences of modes found again, merging and double modes."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment
from scipy.spatial.transform import Rotation

import stridula as st
from stridula.verification.systems import mode_coupling

from .into_space import IntoSpace

# Where Hoffmann's frequencies merge.
ONSET = 0.75


def slopes(found, key) -> np.ndarray:
    one = found.sel(parameter=key)
    return one.d_growth_rate.values + 2j * pi * one.d_frequency.values


def complex_of(found, name, key) -> np.ndarray:
    parts = found[name].sel(parameter=key)
    return parts.sel(part="real").values + 1j * parts.sel(part="imaginary").values


def values(found) -> np.ndarray:
    return found.growth_rate.values + 2j * pi * found.frequency.values


def hoffmann_squares(friction: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the eigenvalues of Hoffmann's stiffness and their derivatives by friction."""
    matrix = mode_coupling.hoffmann().sliding(friction).astype(complex)
    (a, b), (c, d) = matrix
    slope = -mode_coupling.AT_CONTACT
    root = np.sqrt((a - d) ** 2 / 4.0 + b * c)
    signs = np.array([-1.0, 1.0])
    return (a + d) / 2.0 + signs * root, signs * slope * c / (2.0 * root)


@pytest.mark.parametrize("friction", [0.3, 0.5, 0.74, 0.76, 0.9, 1.3])
@pytest.mark.parametrize("turn", [None, 5], ids=["plane", "space"])
def test_hoffmann_in_closed_form(friction, turn):
    system = mode_coupling.hoffmann().system(friction)
    if turn is not None:
        system, _ = IntoSpace(Rotation.random(random_state=turn).as_matrix()).system(system)
    found = st.mode_sensitivity(system, ["friction.coefficient"], modes=8)
    squares, rates = hoffmann_squares(friction)
    known = np.sqrt(-squares)
    known = np.where(known.imag < 0.0, -known, known)
    by_friction = -rates / (2.0 * known)
    for exponent, slope in zip(known, by_friction, strict=True):
        number = int(np.abs(values(found) - exponent).argmin())
        assert slopes(found, "friction.coefficient")[number] == pytest.approx(slope, rel=1e-9, abs=1e-9)


def test_right_vectors_in_place_of_left_ones_fall_short(monkeypatch):
    """Negative control: matrices with friction are not symmetric."""
    made, given = drawn(0, space=False)
    key = "connections.0.stiffness"
    right = st.mode_sensitivity(made(given), [key], modes=5, status="sliding")
    monkeypatch.setattr("stridula.linear.invariant_pairs._About.left", lambda self, vectors: self.right(vectors))
    wrong = st.mode_sensitivity(made(given), [key], modes=5, status="sliding")
    assert np.abs(slopes(wrong, key) / slopes(right, key) - 1.0).max() > 0.01


@pytest.mark.parametrize("friction", [ONSET - 1e-3, ONSET - 1e-9, ONSET, ONSET + 1e-9, ONSET + 1e-3])
def test_sum_and_product_of_merging_modes_in_closed_form(friction):
    """Sum and product of both exponents follow from trace and determinant of the stiffness, across the merge."""
    found = st.mode_sensitivity(mode_coupling.hoffmann().system(friction), ["friction.coefficient"], modes=2, near=0.22)
    matrix = mode_coupling.hoffmann().sliding(friction)
    product = -sqrt(np.linalg.det(matrix))
    by_product = mode_coupling.AT_CONTACT * matrix[1, 0] / (2.0 * product)
    total = 1j * sqrt(np.trace(matrix) - 2.0 * product)
    assert found.kind.values.tolist() == ["merging"] * 2
    assert found.partner.values.tolist() == found["mode"].values.tolist()[::-1]
    assert complex_of(found, "d_product", "friction.coefficient") == pytest.approx([by_product] * 2, rel=1e-7)
    assert complex_of(found, "d_sum", "friction.coefficient") == pytest.approx([by_product / total] * 2, rel=1e-7)
    is_merged = abs(friction - ONSET) < 1e-12
    assert bool(np.isnan(slopes(found, "friction.coefficient")).all()) == is_merged


def test_a_mode_far_from_others_is_alone():
    found = st.mode_sensitivity(mode_coupling.hoffmann().system(0.2), ["friction.coefficient"], modes=2, near=0.2)
    assert found.kind.values.tolist() == ["alone"] * 2
    assert np.isnan(found.d_sum).all()


def test_a_change_across_the_merge_is_that_of_both_modes():
    """At 0.74 the derivative misses the flutter at 0.814, that of the pair has it to a percent."""
    friction = 0.74
    found = st.mode_sensitivity(mode_coupling.hoffmann().system(friction), ["friction.coefficient"], modes=2, near=0.22)
    after = values(st.sliding_stability(mode_coupling.hoffmann().system(1.1 * friction)))
    growth = float(after.real.max())
    assert growth > 0.05
    assert found.growth_rate_change.values.max() == pytest.approx(growth, rel=0.01)
    assert abs(found.d_growth_rate.values).max() < 1e-6


def drawn(seed: int, space: bool) -> tuple:
    """Return a function that makes a random system from values by key, and the values."""
    rng = np.random.default_rng(seed)
    size = int(rng.integers(4, 8))
    draw = rng.standard_normal((size, size))
    mass = np.diag(rng.uniform(0.5, 2.0, size))
    stiffness = 4e4 * (draw @ draw.T / size + 0.3 * np.eye(size))
    damping = 1e-4 * stiffness + np.diag(rng.uniform(0.0, 2.0, size))
    rows = {name: rng.standard_normal((2, size)) for name in ("foot 1", "foot 2", "one", "other")}
    yields = [None, "linear", "hertz"][seed % 3]
    law = ["coulomb", "stribeck", "rate"][(seed // 3) % 3]
    given = {
        "left.friction.coefficient" if law == "coulomb" else "left.friction.kinetic": rng.uniform(0.2, 0.5),
        "connections.0.stiffness": rng.uniform(1e3, 4e4),
        "connections.1.coefficient": rng.uniform(1.0, 20.0),
        "connections.2.stiffness": rng.uniform(1e3, 4e4),
        "drives.0.y": -rng.uniform(200.0, 400.0),
        "drives.1.y": -rng.uniform(200.0, 400.0),
    }
    if law == "stribeck":
        given |= {"left.friction.velocity": 0.3, "left.track.velocity": -rng.uniform(0.2, 0.5)}
    if yields:
        given["right.stiffness.stiffness" if yields == "linear" else "right.stiffness.radius"] = (
            rng.uniform(1e4, 1e5) if yields == "linear" else rng.uniform(1e-3, 1e-2)
        )

    def made(now: dict) -> st.System:
        body = st.ReducedBody(mass, stiffness, points=rows, damping=damping, name="body")
        if law == "coulomb":
            friction = st.Coulomb(now["left.friction.coefficient"])
        elif law == "stribeck":
            friction = st.Stribeck(0.6, now["left.friction.kinetic"], now["left.friction.velocity"])
        else:
            friction = st.ExponentialWeakening(0.6, now["left.friction.kinetic"], 0.4)
        stiff = {
            None: lambda: None,
            "linear": lambda: st.LinearStiffness(now["right.stiffness.stiffness"], 3.0),
            "hertz": lambda: st.HertzStiffness(radius=now["right.stiffness.radius"], modulus=1e8),
        }[yields]()
        belt = now.get("left.track.velocity", -0.3)
        contacts = [
            st.PointContact(body.at("foot 1"), st.RigidTrack(velocity=belt, name="a"), friction=friction, name="left"),
            st.PointContact(
                body.at("foot 2"),
                st.RigidTrack(velocity=-0.4, name="b"),
                friction=st.Coulomb(0.3),
                name="right",
                stiffness=stiff,
            ),
        ]
        joints = [
            st.Spring(body.at("one"), stiffness=now["connections.0.stiffness"], direction="y"),
            st.Dashpot(body.at("one"), body.at("other"), coefficient=now["connections.1.coefficient"]),
            st.Spring(body.at("other"), body.at("one"), stiffness=now["connections.2.stiffness"]),
        ]
        drives = [st.Force(body.at("foot 1"), y=now["drives.0.y"]), st.Force(body.at("foot 2"), y=now["drives.1.y"])]
        system = st.System(contacts, drives, joints)
        return IntoSpace(Rotation.from_rotvec([0.0, 0.0, 0.0]).as_matrix()).system(system)[0] if space else system

    return made, given


def around(made, given, key, share: float = 1e-3, **words) -> tuple[list[np.ndarray], float]:
    """Return all exponents, conjugates included, at four values about one, and the step between these."""
    step = share * abs(given[key])
    found = []
    for place in (-2, -1, 1, 2):
        there = values(st.sliding_stability(made(given | {key: given[key] + place * step}), **words))
        found.append(np.concatenate([there, there[there.imag > 0.0].conj()]))
    return found, step


def nearest(found, known) -> np.ndarray:
    """Return of some exponents those nearest to known ones, each once."""
    rows, columns = linear_sum_assignment(np.abs(np.asarray(known)[:, None] - found))
    return found[columns[np.argsort(rows)]]


def difference(four, step: float):
    """Return the central difference of the fourth order."""
    low2, low, high, high2 = four
    return (8.0 * (high - low) - (high2 - low2)) / (12.0 * step)


@pytest.mark.parametrize("seed", range(18))
@pytest.mark.parametrize("space", [False, True], ids=["plane", "space"])
def test_derivatives_are_those_of_modes_found_again(seed, space):
    """Random bodies on two belts under three laws, rigid, on a spring and on a ball, with springs and a dashpot.

    Of modes that merge, which may meet within the difference, sum and product are compared.
    """
    made, given = drawn(seed, space)
    system = made(given)
    words = {"status": "sliding"}
    found = st.mode_sensitivity(system, list(given), modes=5, **words)
    every, known = values(st.sliding_stability(system, **words)), values(found)
    for key in given:
        four, step = around(made, given, key, **words)
        size = np.abs(every).max()
        rounding = 1e-13 * size / step
        for number, (kind, partner) in enumerate(zip(found.kind.values, found.partner.values, strict=True)):
            one = known[number]
            if kind == "alone":
                by_value = difference([nearest(each, [one])[0] for each in four], step)
                assert slopes(found, key)[number] == pytest.approx(by_value, rel=1e-6, abs=rounding)
                continue
            other = one.conj() if every[partner] == one else every[partner]
            pairs = [nearest(each, [one, other]) for each in four]
            for name, of, scale in (("d_sum", np.sum, 1.0), ("d_product", np.prod, abs(one))):
                by_value = difference([of(pair) for pair in pairs], step)
                got = complex_of(found, name, key)[number]
                assert got == pytest.approx(by_value, rel=1e-6, abs=4.0 * scale * rounding)


def heavier(system: st.System, name: str, mass: float) -> st.System:
    """Return a system of one body given by matrices, with a mass more at a point of it."""
    body = system.slider
    other = replace(body, mass=body.mass + mass * body.points[name].T @ body.points[name])

    def moved(point):
        return None if point is None else other.at(point.position)

    return st.System(
        [replace(one, tip=moved(one.tip)) for one in system.contacts],
        [replace(one, point=moved(one.point)) for one in system.drives],
        [replace(one, first=moved(one.first), second=moved(one.second)) for one in system.connections],
    )


@pytest.mark.parametrize("seed", range(3))
def test_an_added_mass_is_that_of_another_matrix(seed):
    """The derivative in closed form against modes with the mass in the matrix of the body."""
    made, given = drawn(seed, space=False)
    system = made(given)
    found = st.mode_sensitivity(system, [], masses={"one": system.slider.at("one")}, modes=5, status="sliding")
    around_it, step = around(lambda now: heavier(system, "one", now["m"] - 0.05), {"m": 0.05}, "m", status="sliding")
    by_mass = difference([nearest(each, values(found)) for each in around_it], step)
    np.testing.assert_allclose(slopes(found, "mass at one"), by_mass, rtol=1e-6)
    assert np.isnan(found.growth_rate_change).all()


def test_a_double_mode_is_split_as_by_each_spring():
    """A mass on equal springs along x and y: a spring moves one of both modes, and a mass both."""
    mass, stiffness = 2.0, 5e3
    body = st.PointMass(mass)
    springs = [st.Spring(body.centre, stiffness=stiffness, direction=way) for way in "xy"]
    system = st.System(st.PointContact(body.centre, st.RigidTrack(), gap=1.0), connections=springs)
    keys = [f"connections.{number}.stiffness" for number in (0, 1)]
    found = st.mode_sensitivity(system, keys, masses={"centre": body.centre}, status="separated", modes=2)
    frequency = sqrt(stiffness / mass) / (2.0 * pi)
    assert found.kind.values.tolist() == ["double"] * 2
    for key in keys:
        both = sorted(found.d_frequency.sel(parameter=key).values)
        assert both == pytest.approx([0.0, frequency / (2.0 * stiffness)], rel=1e-9, abs=1e-12)
    heavier_by = found.d_frequency.sel(parameter="mass at centre").values
    assert heavier_by == pytest.approx([-frequency / (2.0 * mass)] * 2, rel=1e-9)
    assert slopes(found, keys[0]).real == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_mass_on_a_rim_splits_the_double_modes_of_a_disc():
    """Each pair has one mode with a node there: the derivatives follow from shapes of the disc, -f/2 w^2 and 0."""
    profile = st.RectangleProfile({"disc": ((0.02, 0.15), (-0.005, 0.005))})
    disc = st.AxisymmetricBody(profile, st.Material(2.1e11, 7800.0, 0.3), 3e3, "inner", name="disc")
    rim, foot = disc.at((0.15, 0.0, 0.0)), st.RigidBody(1.0, name="foot")
    flying = st.PointContact(foot.centre, disc.at((0.1, 0.5, 0.005)), normal=(0, 0, 1), gap=1.0)
    held = [st.Spring(foot.centre, stiffness=1e3, direction=way) for way in "xyz"]
    system = st.System(flying, connections=held)
    found = st.mode_sensitivity(system, [], masses={"rim": ("disc", (0.15, 0.0, 0.0))}, status="separated", modes=60)
    modes = disc.modes()
    rows = disc.trace(rim.position)
    doubles = found.isel(mode=np.flatnonzero((found.kind == "double") & (found.frequency > 100.0)))
    assert doubles.sizes["mode"] >= 4
    for rounded in np.unique(np.round(doubles.frequency.values, 3)):
        pair = np.abs(modes.frequency - rounded) < 1e-2
        squares = np.linalg.eigvalsh(rows[:, pair].T @ rows[:, pair])
        there = np.abs(doubles.frequency.values - rounded) < 1e-2
        frequency = doubles.frequency.values[there].mean()
        got = np.sort(doubles.d_frequency.values[0, there])
        assert got == pytest.approx(np.sort(-0.5 * frequency * squares), rel=1e-6, abs=1e-6 * np.abs(got).max())


def test_several_contacts_change_in_proportion():
    """The derivative by the mean of all coefficients is the sum of those by each, weighed by their share."""
    made, given = drawn(0, space=False)
    keys = ["friction.coefficient", "left.friction.coefficient", "right.friction.coefficient"]
    found = st.mode_sensitivity(made(given), keys, modes=5, status="sliding")
    whole, left, right = (slopes(found, key) for key in keys)
    share = found.value.values[1:] / found.value.values[0]
    np.testing.assert_allclose(whole, share[0] * left + share[1] * right, rtol=1e-9)
    listed = st.mode_sensitivity(made(given), ["contacts.friction.coefficient"], modes=5, status="sliding")
    np.testing.assert_array_equal(slopes(listed, "contacts.friction.coefficient"), whole)
    with pytest.raises(ValueError, match="key must be a number that an entry of contacts has"):
        st.mode_sensitivity(made(given), ["contacts.shape"], status="sliding")


def test_contacts_on_one_track_share_its_speed():
    """A default key of the speed of all contacts stands for those of each."""
    found = st.mode_sensitivity("pin-on-disc")
    names = found.parameter.values.tolist()
    assert "contacts.surface_velocity" in names
    assert not any(name.startswith("node") and name.endswith("surface_velocity") for name in names)
    open_nodes = found.sel(parameter=["node 1.friction.coefficient", "node 3.friction.coefficient"])
    assert st.what_helps(open_nodes).better.values.tolist() == ["neither"] * 2


def test_a_changed_basis_of_modes_is_turned_back():
    """Modes of equal frequency of another mesh take any orientation: a pin on a disc by its modulus and density."""
    keys = ["bodies.pin.materials.young", "bodies.disc.material.density"]
    found = st.mode_sensitivity("pin-on-disc", keys, modes=3, near=2273.0, status="sliding")
    number = int(np.abs(found.frequency.values - 2273.1).argmin())
    one = values(found)[number]
    for key in keys:
        given = {"value": float(found.value.sel(parameter=key))}
        four, step = around(
            lambda now, key=key: st.load_scenario("pin-on-disc", {key: now["value"]}).system,
            given,
            "value",
            status="sliding",
        )
        by_value = difference([nearest(each, [one])[0] for each in four], step)
        assert slopes(found, key)[number] == pytest.approx(by_value, rel=1e-6)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (["coefficient of friction"], "key"),
        (["left.friction.shape"], "number"),
        (["contacts.0.gap"], "0"),
        (["connections.0.direction"], "number"),
        ([3], "be keys"),
        (["left.friction.coefficient", "left.friction.coefficient"], "twice"),
    ],
)
def test_what_has_no_derivative_is_refused_in_a_line(keys, words):
    made, given = drawn(0, space=False)
    with pytest.raises(ValueError, match=words) as refused:
        st.mode_sensitivity(made(given), keys, status="sliding")
    assert "\n" not in str(refused.value)


def test_a_change_of_status_is_refused():
    """A block that friction just lets slide: a bit more holds it. By default such parameters are left out."""
    with pytest.raises(
        ValueError, match=r"leave the statuses of contacts as they are, got 0\.49\d+ for friction.coefficient"
    ):
        st.mode_sensitivity(leaning(0.99999), ["friction.coefficient"])
    assert st.mode_sensitivity(leaning(0.9), ["friction.coefficient"]).sizes["parameter"] == 1
    found = st.mode_sensitivity(leaning(0.99999))
    assert found.parameter.values.tolist() == ["bodies.slider.mass", "contacts.0.stiffness.stiffness"]
    assert "for contacts.0.friction.coefficient, of which" in found.attrs["left_out"]
    frequency = float(found.frequency[0])
    assert found.d_frequency.values[:, 0] == pytest.approx([-frequency / 2.0, frequency / 2e4], rel=1e-9)


def leaning(share: float) -> st.System:
    """Return a mass that a force pulls over a floor, with a friction of a share of that which holds it."""
    body = st.PointMass(1.0)
    contact = st.PointContact(
        body.centre, st.RigidTrack(), friction=st.Coulomb(0.5 * share), stiffness=st.LinearStiffness(1e4)
    )
    return st.System(contact, [st.Force(body.centre, x=5.0, y=-10.0)])


@pytest.mark.parametrize(
    ("name", "key"), [("wheel", "turning"), ("glass", "young"), ("lugre", "floor.friction.stiffness")]
)
def test_shipped_cases_whose_matrices_bend_or_carry_rounding(name, key):
    """A slip of a hundredth of the speed of a wheel, modes of a mesh, a law with a state."""
    found = st.mode_sensitivity(name, [key], modes=3, near=800.0 if name != "lugre" else 0.0)
    given = {key: float(found.value[0])}
    place = key.replace("floor", "contacts.0")
    # The slip of the wheel bends within a thousandth of its speed.
    four, step = around(lambda now: st.load_scenario(name, {place: now[key]}).system, given, key, 1e-4)
    by_value = np.array([difference([nearest(each, [one])[0] for each in four], step) for one in values(found)])
    size = np.abs(by_value).max()
    np.testing.assert_allclose(slopes(found, key), by_value, atol=1e-4 * size)


def test_what_helps_most_comes_first():
    found = st.mode_sensitivity("weak-pressure")
    table = st.what_helps(found)
    size = np.abs(table.growth_rate_change.values)
    assert (np.diff(size) <= 0.0).all()
    assert table.parameter.values[0] == "contact.friction.coefficient"
    assert table.better.values[0] == "lower"
    with pytest.raises(ValueError, match="mode"):
        st.what_helps(found, 3)


def test_a_figure_has_a_bar_for_each_parameter():
    found = st.mode_sensitivity("weak-pressure", ["friction", "slider.damping.rise", "slider.damping.ratio"])
    left, right = st.plot.mode_sensitivity(found, most=2).axes
    assert [label.get_text() for label in left.get_yticklabels()] == ["friction", "slider.damping.rise"]
    effects = st.what_helps(found)
    for axes, name in ((left, "growth_rate_change"), (right, "frequency_change")):
        assert [bar.get_width() for bar in axes.patches] == effects[name].values[:2].tolist()
    with pytest.raises(ValueError, match="found must be the result of mode_sensitivity"):
        st.plot.mode_sensitivity(found.drop_vars("d_frequency"))
    alone = st.mode_sensitivity("weak-pressure", [], masses={"tip": ("slider", "tip")})
    with pytest.raises(ValueError, match="found must have changes by parameters, got none"):
        st.plot.mode_sensitivity(alone)
