"""Bodies given by matrices and point masses: modes against closed forms, all kinds of damping, refused arguments."""

from __future__ import annotations

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from stridula.bodies import (
    Body,
    BodyPoint,
    FiniteElementBeam,
    Material,
    ModalBeam,
    PointMass,
    Rayleigh,
    Rectangle,
    ReducedBody,
)
from stridula.bodies.beams_and_plates.finite_elements import assemble, element_mass, element_stiffness
from stridula.bodies.matrix_input import ROUND_OFF

STEEL, STRIP = Material(2.1e11, 7800.0), Rectangle(0.020, 0.004)
NAN, INF = float("nan"), float("inf")

# Two masses of 1 kg, each held by k, coupled by c: w² = k and k + 2 c, in phase and out of phase.
K, C = 400.0, 250.0
M2 = np.eye(2)
K2 = np.array([[K + C, -C], [-C, K + C]])
POINTS = {"a": (0, None), "b": (None, 1)}


def pair(**changes):
    return ReducedBody(**({"mass": M2, "stiffness": K2, "points": POINTS} | changes))


def beam_matrices(elements=8, angle=0.4, mass="consistent", length=0.5):
    section, le = STRIP, length / elements
    stiffness = element_stiffness(STEEL.young * section.area, STEEL.young * section.second_moment, le)
    inertia = element_mass(STEEL.density * section.area, le, mass)
    return assemble(inertia, angle, elements), assemble(stiffness, angle, elements)


def beam_translation(elements=8):
    rows = np.zeros((2, 3 * (elements + 1)))
    rows[0, 0::3] = rows[1, 1::3] = 1.0
    return rows


def test_two_masses_have_the_frequencies_and_shapes_of_the_closed_form():
    body = pair()
    np.testing.assert_allclose(body.modes().angular_frequency, np.sqrt([K, K + 2 * C]), rtol=1e-14)
    np.testing.assert_allclose(np.abs(body.shapes), np.sqrt(0.5), rtol=1e-14)
    assert body.shapes[0, 0] * body.shapes[1, 0] > 0 > body.shapes[0, 1] * body.shapes[1, 1]
    np.testing.assert_array_equal(body.trace("a"), [body.shapes[0], [0.0, 0.0]])
    np.testing.assert_array_equal(body.trace("b"), [[0.0, 0.0], body.shapes[1]])
    np.testing.assert_array_equal(body.axes, np.eye(2))


def test_two_free_masses_have_one_exactly_rigid_mode():
    """Masses m and M on a spring k: w = 0 and w² = k (m + M) / (m M)."""
    m, big, k = 0.3, 7.0, 1e5
    body = pair(
        mass=np.diag([m, big]), stiffness=k * np.array([[1.0, -1.0], [-1.0, 1.0]]), translation=[[1, 1], [0, 0]]
    )
    assert body.modes().angular_frequency[0] == 0.0
    assert body.modes().angular_frequency[1] == pytest.approx(np.sqrt(k * (m + big) / (m * big)), rel=1e-14)
    assert body.total_mass == pytest.approx(m + big)
    np.testing.assert_allclose(np.abs(body.modes().translation), [[np.sqrt(m + big), 0], [0, 0]], atol=1e-12)


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
@pytest.mark.parametrize("support", ["free", "clamped", "guided", "pinned"])
def test_matrices_of_a_beam_give_the_modes_of_the_beam(support, mass):
    m, k = beam_matrices(mass=mass)
    fixed = {"free": [], "clamped": [24, 25, 26], "guided": [26], "pinned": [24, 25]}[support]
    free = np.setdiff1d(np.arange(27), fixed)
    tip = np.eye(27)[:2][:, free]
    body = ReducedBody(m[np.ix_(free, free)], k[np.ix_(free, free)], {"tip": tip, "middle": (12, 13)})
    beam = FiniteElementBeam(STEEL, STRIP, 0.5, angle=0.4, elements=8, root_support=support, mass=mass)
    wanted = beam.modes()
    rigid = {"free": 3, "clamped": 0, "guided": 2, "pinned": 1}[support]
    assert np.count_nonzero(body.modes().frequency == 0.0) == rigid
    np.testing.assert_allclose(body.modes().frequency, wanted.frequency, rtol=1e-7)
    # The receptance between two points does not depend on the signs of modes nor on the basis of the rigid ones.
    for point, s in (("tip", 0.0), ("middle", 0.25)):
        ours, theirs = (
            t / (modes.angular_frequency**2 + 1e6) @ t.T
            for t, modes in ((body.trace(point), body.modes()), (beam.trace(s), wanted))
        )
        np.testing.assert_allclose(ours, theirs, rtol=1e-7, atol=1e-12 * np.abs(theirs).max())


def test_translation_is_that_of_the_beam():
    m, k = beam_matrices()
    body = ReducedBody(m, k, {"tip": (0, 1)}, translation=beam_translation())
    beam = FiniteElementBeam(STEEL, STRIP, 0.5, angle=0.4, elements=8, root_support="free")
    assert body.total_mass == pytest.approx(beam.total_mass, rel=1e-12)
    ours, theirs = (t @ t.T for t in (body.modes().translation, beam.modes().translation))
    np.testing.assert_allclose(ours, theirs, atol=1e-12 * beam.total_mass)
    still = ReducedBody(m, k, {"tip": (0, 1)})
    assert (body.has_translation, still.has_translation) == (True, False)
    assert np.isnan(still.total_mass)
    np.testing.assert_array_equal(still.modes().translation, np.zeros((2, 27)))


def test_modal_coordinates_bring_a_displacement_back():
    m, k = beam_matrices()
    body = ReducedBody(m, k, {"tip": (0, 1)}, translation=beam_translation())
    shape = np.random.default_rng(1).normal(size=27)
    np.testing.assert_allclose(body.shapes @ body.modal_coordinates(shape), shape, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(body.modal_coordinates(beam_translation()[0]), body.modes().translation[0], atol=1e-14)
    np.testing.assert_allclose(body.shapes.T @ m @ body.shapes, np.eye(27), atol=1e-10)


def test_rigid_modes_are_separated_from_elastic_ones_with_margins():
    """The zero of a free beam stays far below the bound; the first mode of a fine clamped beam far above it."""
    for mass in ("consistent", "lumped"):
        for elements in (1, 5, 60):
            m, k = beam_matrices(elements, mass=mass)
            scale = 1 / np.sqrt(np.diag(m))
            squared = scipy.linalg.eigvalsh(k * np.outer(scale, scale), m * np.outer(scale, scale))
            assert np.abs(squared[:3]).max() < 0.2 * ROUND_OFF * squared[-1]
            body = ReducedBody(m[3:, 3:], k[3:, 3:], {"root": (-3 + 3 * elements, None)})
            assert (body.modes().frequency > 0).all()


def test_a_cutoff_keeps_the_modes_up_to_it_and_the_rigid_ones():
    m, k = beam_matrices()
    whole = ReducedBody(m, k, {"tip": (0, 1)})
    third = float(whole.modes().frequency[5])
    cut = replace(whole, cutoff=third * (1 + 1e-9), residual_flexibility=False)
    np.testing.assert_array_equal(cut.modes().frequency, whole.modes().frequency[:6])
    np.testing.assert_array_equal(cut.trace("tip"), whole.trace("tip")[:, :6])
    assert replace(cut, cutoff=1e-3).modes().count == 3
    # Residual shapes come after them, at most one for each row of a point.
    soft = replace(cut, residual_flexibility=True)
    assert soft.modes().massless.tolist() == [False] * 6 + [True] * 2
    np.testing.assert_array_equal(soft.trace("tip")[:, :6], cut.trace("tip"))
    with pytest.raises(ValueError, match=r"^cutoff must leave at least one mode \(first at 3.18.* Hz\), got 1.0 Hz"):
        pair(cutoff=1)


# Damping.


def test_one_ratio_is_that_of_every_elastic_mode():
    m, k = beam_matrices()
    damping = ReducedBody(m, k, {"tip": (0, 1)}, damping=0.02).modes().damping
    np.testing.assert_allclose(damping, [0.0] * 3 + [0.02] * 24, rtol=1e-15)


def test_ratios_of_single_modes_go_by_rising_frequency():
    assert pair(damping=[0.01, 0.3]).modes().damping.tolist() == pytest.approx([0.01, 0.3], rel=1e-15)
    assert pair(damping=[0.01], cutoff=4.0).modes().damping[:1].tolist() == pytest.approx([0.01], rel=1e-15)
    with pytest.raises(ValueError, match=r"^damping must have one ratio or 1, one for each mode kept, got 2"):
        pair(damping=[0.01, 0.3], cutoff=4.0)


@pytest.mark.parametrize("as_matrix", [False, True])
@pytest.mark.parametrize(("alpha", "beta"), [(3.0, 0.0), (0.0, 2e-8), (3.0, 2e-8)])
def test_rayleigh_ratios(alpha, beta, as_matrix):
    m, k = (part[3:, 3:] for part in beam_matrices())
    damping = alpha * m + beta * k if as_matrix else Rayleigh(alpha, beta)
    modes = ReducedBody(m, k, {"root": (21, 22)}, damping=damping).modes()
    w = modes.angular_frequency
    assert modes.damping_matrix is None
    np.testing.assert_allclose(modes.damping, alpha / (2 * w) + beta * w / 2, rtol=1e-6)


@pytest.mark.parametrize("as_matrix", [False, True])
def test_rigid_modes_are_braked_and_fast_ones_overdamped_without_a_matrix(as_matrix):
    m, k = beam_matrices()

    def damping(alpha, beta):
        return alpha * m + beta * k if as_matrix else Rayleigh(alpha, beta)

    # A rigid mode that is braked.
    braked = ReducedBody(m, k, {"tip": (0, 1)}, damping=damping(3.0, 0.0)).modes()
    assert braked.damping_matrix is None
    np.testing.assert_allclose(braked.damping_rate, 3.0, rtol=1e-9)
    np.testing.assert_array_equal(braked.damping[:3], 0.0)
    # Stiffness alone brakes no rigid mode, but overdamps fast ones.
    slow = ReducedBody(m, k, {"tip": (0, 1)}, damping=damping(0.0, 1e-9)).modes()
    assert slow.damping_matrix is None
    fast = ReducedBody(m, k, {"tip": (0, 1)}, damping=damping(0.0, 1e-4)).modes()
    assert fast.damping.max() > 1
    assert fast.damping_matrix is None
    np.testing.assert_allclose(fast.damping_rate, 1e-4 * fast.angular_frequency**2, rtol=1e-6)


def test_a_damper_between_modes_gives_the_modal_matrix():
    """A damper at one of the two masses couples both modes with half its constant each."""
    modes = pair(damping=[[6.0, 0.0], [0.0, 0.0]]).modes()
    np.testing.assert_allclose(np.abs(modes.damping_matrix), 3.0, rtol=1e-13)
    np.testing.assert_array_equal(modes.damping_matrix, modes.damping_matrix.T)
    np.testing.assert_allclose(modes.damping, 3.0 / (2 * modes.angular_frequency))
    cut = pair(damping=[[6.0, 0.0], [0.0, 0.0]], cutoff=4.0).modes()
    assert cut.damping_matrix is None
    # Residual shapes are not damped.
    assert cut.damping.tolist() == [*modes.damping[:1].tolist(), 0.0]


def test_weak_coupling_counts_down_to_a_ten_billionth():
    """The modal matrix of diag(6 + e, 6 - e) has e beside the diagonal."""
    assert pair(damping=np.diag([6 + 1e-8, 6 - 1e-8])).modes().damping_matrix is not None
    assert pair(damping=np.diag([6 + 1e-10, 6 - 1e-10])).modes().damping_matrix is None


def test_a_damping_matrix_gives_the_eigenvalues_of_the_whole_system():
    """State matrix of the modes against that of the degrees of freedom."""
    m, k = (part[3:, 3:] for part in beam_matrices(3))
    damping = np.zeros((9, 9))
    damping[6:8, 6:8] = [[4.0, 1.0], [1.0, 2.0]]
    modes = ReducedBody(m, k, {"root": (6, 7)}, damping=damping).modes()
    state = np.block([[np.zeros((9, 9)), np.eye(9)], [-np.linalg.solve(m, k), -np.linalg.solve(m, damping)]])
    modal = np.block([[np.zeros((9, 9)), np.eye(9)], [-np.diag(modes.angular_frequency**2), -modes.damping_matrix]])
    np.testing.assert_allclose(*(np.sort_complex(np.linalg.eigvals(s)) for s in (modal, state)), rtol=1e-7, atol=1e-4)


# Being immutable, equal by content.


def test_bodies_are_equal_and_hashed_by_content():
    body = pair()
    rows = {"b": (None, 1), "a": [[1.0, -0.0], [-0.0, 0]]}
    same = pair(mass=[[1, 0], [-0.0, 1]], stiffness=scipy.sparse.csr_array(K2), points=rows)
    assert body == same
    assert hash(body) == hash(same) == hash(replace(body))
    changes = [
        {"mass": 2 * M2},
        {"stiffness": np.nextafter(K2, INF)},
        {"points": {"a": (0, None)}},
        {"points": {"a": (0, None), "c": (None, 1)}},
        {"damping": 0.1},
        {"damping": [0.1, 0.1]},
        {"damping": Rayleigh(0.1, 0.0)},
        {"damping": 0.1 * M2},
        {"translation": [[1, 1], [0, 0]]},
        {"cutoff": 1e3},
        {"residual_flexibility": False},
        {"name": "left"},
    ]
    bodies = [body, *(pair(**change) for change in changes)]
    assert len(set(bodies)) == len(bodies)
    assert body != "body"


def test_bodies_are_immutable_and_copy_their_arguments():
    mass, points = M2.copy(), dict(POINTS)
    body = pair(mass=mass, points=points, damping=0.1 * M2, translation=[[1, 1], [0, 0]])
    mass[0, 0] = 9.0
    points["c"] = (0, 1)
    assert body.mass[0, 0] == 1.0
    assert tuple(body.points) == ("a", "b")
    for array in (body.mass, body.stiffness, body.damping, body.translation, body.points["a"], body.shapes):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 5.0
    with pytest.raises(TypeError):
        body.points["c"] = (0, 1)
    with pytest.raises(AttributeError):
        body.mass = M2


def test_bodies_are_copied_and_pickled_whole():
    body = pair(damping=Rayleigh(0.1, 1e-5), translation=[[1, 1], [0, 0]], cutoff=50, name="left")
    for other in (pickle.loads(pickle.dumps(body)), copy.deepcopy(body), copy.copy(body)):
        assert other == body
        assert not other.mass.flags.writeable
    assert repr(body) == "ReducedBody(2 degrees of freedom, points a, b, name='left')"


def test_small_asymmetry_is_averaged_away():
    bent = K2 + np.array([[0.0, 1e-6], [0.0, 0.0]])
    body = pair(stiffness=bent)
    np.testing.assert_array_equal(body.stiffness, body.stiffness.T)
    assert body.stiffness[0, 1] == pytest.approx(-C + 5e-7, rel=1e-15)


# Refused arguments.

LARGE = scipy.sparse.eye_array(10**6, format="csr")
BAD = {
    "mass 1-D": ({"mass": [1.0, 1.0]}, r"^mass must be a square matrix, got the shape \(2,\)"),
    "mass not square": ({"mass": np.ones((2, 3))}, r"^mass must be a square matrix, got the shape \(2, 3\)"),
    "mass number": ({"mass": 1.0}, r"^mass must be a square matrix, got the shape \(\)"),
    "mass none": ({"mass": None}, r"^mass must be an array of numbers, got a NoneType"),
    "mass ragged": ({"mass": [[1.0], [1.0, 2.0]]}, "^mass must be an array of numbers, got a ragged list"),
    "mass text": ({"mass": [["1", "0"], ["0", "1"]]}, "^mass must be an array of numbers, got a list of <U1"),
    "mass truth": ({"mass": np.eye(2, dtype=bool)}, "^mass must be an array of numbers, got a ndarray of bool"),
    "mass complex": ({"mass": M2 * (1 + 0j)}, "^mass must be real, got complex numbers"),
    "stiffness complex": ({"stiffness": scipy.sparse.csr_array(K2 * 1j)}, "^stiffness must be real"),
    "mass empty": ({"mass": np.zeros((0, 0))}, "^mass must have at least one degree of freedom, got an empty matrix"),
    "mass nan": ({"mass": [[1.0, NAN], [NAN, 1.0]]}, r"^mass must be finite, got nan at row 0, column 1 \(from 0\)"),
    "stiffness inf": ({"stiffness": np.diag([1.0, -INF])}, "^stiffness must be finite, got -inf at row 1, column 1"),
    "mass singular": ({"mass": np.diag([1.0, 0.0])}, "^mass must be positive definite, got the smallest eigenvalue 0;"),
    "mass rank": ({"mass": np.ones((2, 2))}, "^mass must be positive definite, got the smallest eigenvalue"),
    "mass indefinite": ({"mass": [[1.0, 2.0], [2.0, 1.0]]}, "^mass must be positive definite.* eigenvalue -1;"),
    "mass negative": ({"mass": np.diag([1.0, -3.0])}, "^mass must be positive definite.* eigenvalue -3;"),
    "mass skew": (
        {"mass": [[1.0, 0.25], [0.5, 1.0]]},
        r"^mass must be symmetric, got 0.25 at row 0, column 1 \(from 0\) but 0.5 at row 1, column 0",
    ),
    "stiffness skew": ({"stiffness": K2 + np.diag([1e-4], 1)}, "^stiffness must be symmetric, got -249.9999 at row 0"),
    "stiffness size": ({"stiffness": np.eye(3)}, "^stiffness must have as many degrees of freedom as mass, 2, got 3"),
    "stiffness indefinite": (
        {"stiffness": [[0.0, 5.0], [5.0, 0.0]]},
        "^stiffness must be positive semidefinite, got the smallest eigenvalue -5,",
    ),
    "damping skew": ({"damping": [[1.0, 0.5], [0.0, 1.0]]}, "^damping must be symmetric, got 0.5 at row 0"),
    "damping size": ({"damping": np.eye(3)}, "^damping must have as many degrees of freedom as mass, 2, got 3"),
    "damping indefinite": ({"damping": -M2}, "^damping must be positive semidefinite.* eigenvalue -1"),
    "damping hidden": ({"damping": [[0, 1], [1, 9]]}, "^damping must be positive semidefinite.* eigenvalue -0.1"),
    "damping nan": ({"damping": [[NAN, 0], [0, 1]]}, "^damping must be finite, got nan at row 0, column 0"),
    "damping one": ({"damping": 1.0}, r"^damping must be below 1 \(critical\), got 1.0"),
    "damping negative": ({"damping": -0.1}, "^damping must be 0 or above, got -0.1"),
    "damping text": ({"damping": "high"}, "^damping must be a number, got 'high'"),
    "damping none": ({"damping": None}, "^damping must be a number, got None"),
    "damping true": ({"damping": True}, "^damping must be a number, got True"),
    "damping ratio": ({"damping": [0.1, 1.0]}, r"^damping\[1\] must be below 1 \(critical\), got 1.0"),
    "damping ratio negative": ({"damping": [-0.1, 0.1]}, r"^damping\[0\] must be 0 or above, got -0.1"),
    "damping ratio nan": ({"damping": [0.1, NAN]}, r"^damping\[1\] must be finite, got nan"),
    "damping count": ({"damping": [0.1]}, "^damping must have one ratio or 2, one for each mode kept, got 1"),
    "damping 3-D": ({"damping": np.zeros((2, 2, 2))}, r"^damping must be a square matrix, got the shape \(2, 2, 2\)"),
    "points none": ({"points": None}, "^points must be a Mapping, got None"),
    "points empty": ({"points": {}}, "^points must have at least one point, got none"),
    "points name": ({"points": {3: (0, 1)}}, "^points must have names that are text, got 3"),
    "points no name": ({"points": {"": (0, 1)}}, "^points must have names that are text, got ''"),
    "point range": ({"points": {"a": (0, 2)}}, r"^points\['a'\] must name degrees of freedom from 0 to 1, got 2"),
    "point below": ({"points": {"a": (-1, 0)}}, r"^points\['a'\] must name degrees of freedom from 0 to 1, got -1"),
    "point truth": ({"points": {"a": (True, 0)}}, r"^points\['a'\] must name degrees of freedom from 0 to 1, got True"),
    "point four": (
        {"points": {"a": (0, 1, 1, 0)}},
        r"^points\['a'\] must have the shape \(2, 2\) or \(3, 2\), got \(4,\)",
    ),
    "point floats": (
        {"points": {"a": (0.0, 1.0)}},
        r"^points\['a'\] must have the shape \(2, 2\) or \(3, 2\), got \(2,\)",
    ),
    "point shape": (
        {"points": {"a": np.ones((4, 2))}},
        r"^points\['a'\] must have the shape \(2, 2\) or \(3, 2\), got \(4, 2\)",
    ),
    "point nan": ({"points": {"a": [[1, 0], [0, NAN]]}}, r"^points\['a'\] must be finite, got nan at row 1, column 1"),
    "point text": ({"points": {"a": "tip"}}, r"^points\['a'\] must be an array of numbers, got a str"),
    "translation": ({"translation": np.ones(2)}, r"^translation must have the shape \(2, 2\), got \(2,\)"),
    "translation inf": ({"translation": [[1, 0], [INF, 1]]}, "^translation must be finite, got inf at row 1, column 0"),
    "cutoff": ({"cutoff": 0.0}, "^cutoff must be above 0, got 0.0"),
    "name": ({"name": 3}, "^name must be a str, got 3"),
    "mass large": ({"mass": LARGE}, "^mass must have at most 300000 degrees of freedom, got 1000000: reduce the model"),
    "stiffness large": ({"stiffness": LARGE}, "^stiffness must have at most 4000 degrees of freedom, got 1000000"),
    "damping large": ({"damping": LARGE}, "^damping must have at most 4000 degrees of freedom, got 1000000"),
    "dense large": ({"mass": np.broadcast_to(1.0, (4001, 4001))}, "^mass must have at most 4000 .* got 4001"),
}


@pytest.mark.parametrize(("change", "message"), BAD.values(), ids=BAD)
def test_bad_arguments_are_named_with_value_and_range(change, message):
    with pytest.raises(ValueError, match=message) as caught:
        pair(**change)
    assert "\n" not in str(caught.value)


def test_unknown_points_suggest_the_nearest():
    body = pair(points={"tip": (0, 1), "root": (None, 1)})
    for ask in (body.at, body.trace, body.check_position):
        with pytest.raises(ValueError, match=r"^position must be one of tip, root, got 'tipp'; did you mean 'tip'\?"):
            ask("tipp")
    with pytest.raises(ValueError, match=r"^position must be one of tip, root, got 0.0"):
        body.at(0.0)


def test_bad_vectors_and_held_ends():
    body = pair()
    with pytest.raises(ValueError, match=r"^vector must have the shape \(2,\), got \(3,\)"):
        body.modal_coordinates([1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"^vector must be finite, got nan at number 1"):
        body.modal_coordinates([1.0, NAN])
    for ask in (body.modes, lambda held_x: body.trace("a", held_x)):
        with pytest.raises(ValueError, match=r"^held_x must be False for a ReducedBody"):
            ask(held_x=True)
    for value in (-1.0, NAN, "1"):
        with pytest.raises(ValueError, match=r"^mass must be"):
            Rayleigh(value, 0.0)
        with pytest.raises(ValueError, match=r"^stiffness must be"):
            Rayleigh(0.0, value)


# Points, names and point masses.


def test_a_point_mass_is_two_rigid_modes():
    ball = PointMass(4.0, name="ball")
    modes = ball.modes()
    np.testing.assert_array_equal(modes.angular_frequency, [0.0, 0.0])
    np.testing.assert_array_equal(modes.damping, [0.0, 0.0])
    np.testing.assert_array_equal(modes.translation, 2.0 * np.eye(2))
    np.testing.assert_array_equal(ball.trace("centre"), 0.5 * np.eye(2))
    np.testing.assert_array_equal(ball.modal_coordinates([3.0, -1.0]), [6.0, -2.0])
    np.testing.assert_array_equal(ball.trace("centre") @ ball.modal_coordinates([3.0, -1.0]), [3.0, -1.0])
    np.testing.assert_array_equal(ball.axes, np.eye(2))
    assert ball.total_mass == 4.0
    assert ball.centre == ball.at("centre") == BodyPoint(ball, "centre")
    assert ball != PointMass(4.0)


@pytest.mark.parametrize("value", [0.0, -1.0, NAN, INF, True, "1", None])
def test_a_bad_mass_is_named(value):
    with pytest.raises(ValueError, match=r"^mass must "):
        PointMass(value)


def test_a_point_mass_has_one_point_and_no_driven_end():
    ball = PointMass(1.0)
    for ask in (ball.at, ball.trace, lambda name: BodyPoint(ball, name)):
        with pytest.raises(ValueError, match=r"^position must be one of centre, got 'center'; did you mean 'centre'"):
            ask("center")
    with pytest.raises(ValueError, match=r"^held_x must be False for a PointMass"):
        ball.modes(held_x=True)
    for vector in ([1.0], [1.0, NAN], "xy", [[1.0, 2.0]], [1.0, 2j]):
        with pytest.raises(ValueError, match=r"^vector must be two finite numbers"):
            ball.modal_coordinates(vector)


def test_a_body_of_matrices_of_a_point_mass_is_the_point_mass():
    ball = PointMass(4.0)
    body = ReducedBody(4.0 * np.eye(2), np.zeros((2, 2)), {"centre": (0, 1)}, translation=np.eye(2))
    np.testing.assert_array_equal(body.modes().angular_frequency, ball.modes().angular_frequency)
    np.testing.assert_allclose(np.abs(body.trace("centre")), ball.trace("centre"))
    assert body.total_mass == ball.total_mass


def bodies() -> list[Body]:
    words = {"material": STEEL, "section": STRIP, "length": 0.5}
    return [FiniteElementBeam(**words), ModalBeam(**words), PointMass(1.0), pair(translation=[[1, 1], [0, 0]])]


def test_every_body_implements_the_protocol():
    for body, position in zip(bodies(), (0.2, 0.2, "centre", "a"), strict=True):
        assert body.trace(position).shape == (2, body.modes().count)
        assert BodyPoint(body, position).position == position
        assert body.axes.shape == (2, 2)
        assert body.total_mass > 0.0
        assert body.name == ""
        named = replace(body, name="left")
        assert named.name == "left"
        assert named != body
        with pytest.raises(ValueError, match=r"^name must be a str, got None"):
            replace(body, name=None)


@pytest.mark.parametrize("body", [None, "slider", FiniteElementBeam, np.zeros((2, 2)), STEEL])
def test_a_point_needs_a_body(body):
    with pytest.raises(ValueError, match=r"^body must be a body of stridula, got ") as caught:
        BodyPoint(body, 0.0)
    assert "\n" not in str(caught.value)


def test_a_beam_has_no_named_points():
    for body in bodies()[:2]:
        with pytest.raises(ValueError, match=r"^position must be a number, got 'tip'"):
            BodyPoint(body, "tip")
