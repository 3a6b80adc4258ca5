"""Springs, dashpots and general damping against closed forms and the matrix exponential."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

import stridula as st
from physics.cases import SCHEME_NAMES, SCHEMES, STEEL, STRIP, track

BOTH = pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
ONE, TWO = st.PointMass(0.4, "one"), st.PointMass(0.4, "two")
K, BETWEEN = 900.0, 350.0


def apart(point):
    """A contact that never closes."""
    return st.PointContact(point, st.RigidTrack(), gap=1.0)


def row(*joints, x=(0.0, 0.0), v=(0.0, 0.0)) -> st.System:
    """Two masses joined in a row, released at `x` with `v`."""
    starts = [st.InitialState(b, (x[n], 0.0), (v[n], 0.0)) for n, b in enumerate((ONE, TWO))]
    return st.System(apart(ONE.centre), starts, joints)


def springs():
    return (
        st.Spring(ONE.centre, stiffness=K),
        st.Spring(ONE.centre, TWO.centre, stiffness=BETWEEN),
        st.Spring(TWO.centre, stiffness=K),
    )


def along_x(system, duration, scheme, step):
    """The run and the displacements of both masses."""
    probes = [st.Displacement(ONE.centre, "x"), st.Displacement(TWO.centre, "x")]
    run = st.simulate(system, duration, scheme=scheme, step=step, sample_rate=1 / step, probes=probes)
    return run, run.displacement.values


@pytest.mark.parametrize("step", [1e-4, 2e-3, 1.5e-2])
@pytest.mark.parametrize(("shape", "stiffness"), [((1.0, 1.0), K), ((1.0, -1.0), K + 2 * BETWEEN)])
def test_two_masses_swing_in_their_normal_modes(shape, stiffness, step):
    """Together at sqrt(k/m), against each other at sqrt((k + 2 k')/m): exact at any step below the limit."""
    angular = np.sqrt(stiffness / 0.4)
    system = row(*springs(), x=np.array(shape) * 1e-3)
    run, moved = along_x(system, 2.0, st.ExactModal(), step)
    time = run.time.values
    np.testing.assert_allclose(moved, 1e-3 * np.outer(np.cos(angular * time), shape), atol=1e-13)


@BOTH
def test_a_wrong_spring_is_detected(scheme):
    """Negative control: the middle spring left out, and central differences at a long step."""
    shape, step = np.array([1.0, -1.0]), 2e-3
    angular = np.sqrt((K + 2 * BETWEEN) / 0.4)
    without = row(springs()[0], springs()[2], x=shape * 1e-3)
    run, moved = along_x(without, 0.5, scheme, step)
    expected = 1e-3 * np.outer(np.cos(angular * run.time.values), shape)
    assert np.abs(moved - expected).max() > 1e-4
    if scheme.name == "central difference":
        _, moved = along_x(row(*springs(), x=shape * 1e-3), 0.5, scheme, step)
        assert np.abs(moved - expected).max() > 1e-6


@pytest.mark.parametrize("step", [1e-4, 3e-3])
@pytest.mark.parametrize("coefficient", [0.5, 40.0])
def test_a_dashpot_between_free_masses_stops_what_is_between_them(coefficient, step):
    """Their middle moves on, their distance grows by v m / 2c (1 - exp(-2 c t / m)): exact, overdamped as it is."""
    system = row(st.Dashpot(ONE.centre, TWO.centre, coefficient=coefficient), v=(0.3, 0.1))
    run, moved = along_x(system, 0.6, st.ExactModal(), step)
    time, rate = run.time.values, 2 * coefficient / 0.4
    np.testing.assert_allclose(moved.mean(axis=1), 0.2 * time, atol=1e-12)
    np.testing.assert_allclose(moved[:, 0] - moved[:, 1], 0.2 / rate * -np.expm1(-rate * time), atol=1e-12)


@BOTH
def test_order_of_a_coupled_chain_is_two(scheme):
    """Springs, dashpots and a harmonic force: against the matrix exponential with the force as an oscillator."""

    def error(step):
        joints = (
            *springs(),
            st.Dashpot(ONE.centre, TWO.centre, coefficient=2.0),
            st.Dashpot(ONE.centre, coefficient=1),
        )
        system = row(*joints, x=(1e-3, 0.0), v=(0.0, 0.1))
        pushed = st.System(
            system.contact,
            [*system.drives, st.Force(TWO.centre, x=2.0, history=st.Harmonic(9.0, phase=0.4))],
            system.connections,
        )
        run, moved = along_x(pushed, 0.3, scheme, step)
        stiffness = np.array([[K + BETWEEN, -BETWEEN], [-BETWEEN, K + BETWEEN]])
        damping = np.array([[3.0, -2.0], [-2.0, 2.0]])
        angular = 2 * np.pi * 9.0
        rate = np.zeros((6, 6))
        rate[:2, 2:4] = np.eye(2)
        rate[2:4, :2], rate[2:4, 2:4] = -stiffness / 0.4, -damping / 0.4
        rate[3, 4], rate[4, 5], rate[5, 4] = 2.0 / 0.4, angular, -angular
        last = run.time.values[-1]
        expected = expm(rate * last) @ [1e-3, 0.0, 0.0, 0.1, np.sin(0.4), np.cos(0.4)]
        return np.abs(moved[-1] - expected[:2]).max()

    assert np.log2(error(1e-3) / error(5e-4)) == pytest.approx(2.0, abs=0.1)


def damped_block(damping, seed=3):
    """Six degrees of freedom with a damping matrix that no modes make diagonal."""
    random = np.random.default_rng(seed)
    mass, stiffness = (a @ a.T + np.eye(6) for a in random.normal(size=(2, 6, 6)))
    stiffness *= 1e4
    dashes = random.normal(size=(6, 3))
    start = random.normal(size=(2, 6)) * [[1e-3], [0.1]]
    c = damping * dashes @ dashes.T
    body = st.ReducedBody(mass, stiffness, {"tip": (0, 1)}, damping=c)
    return body, (mass, stiffness, c), start


@pytest.mark.parametrize("fraction", [0.03, 0.3, 0.95])
@pytest.mark.parametrize("damping", [1.0, 60.0, 800.0])
def test_general_damping_is_exact_at_any_step(damping, fraction):
    """Free motion of a body whose C couples its modes, under- and overdamped: expm of the state matrix."""
    body, (mass, stiffness, c), start = damped_block(damping)
    inverse = np.linalg.inv(mass)
    state = np.block([[np.zeros((6, 6)), np.eye(6)], [-inverse @ stiffness, -inverse @ c]])
    fastest = np.abs(np.linalg.eigvals(state).imag).max()
    step = fraction * np.pi / fastest
    system = st.System(apart(body.at("tip")), [st.InitialState(body, *start)])
    steps = 200
    if damping >= 60.0 and fraction > 0.9:
        # Close to half the shortest period, a force on strongly damped modes may move them against its sense.
        with pytest.raises(ValueError, match=r"^step must be shorter for the coupled modes"):
            st.simulate(system, steps * step, step=step, sample_rate=1 / step, probes=[])
        return
    run = st.simulate(system, steps * step, step=step, sample_rate=1 / step, probes=[])
    damped = np.abs(body.modes().damping_matrix).sum(axis=1).max() * step
    if damped > 2.0:
        # A motion that a step damps so much starts with a centred velocity: it is exact from the second step on.
        second = st.simulate(system, 2 * step, step=step, sample_rate=1 / step, probes=[])
        two, last = (body.shapes @ row for row in second.state_modal.values)
        passed = expm(state * step)
        one = two - last
        start = np.array([one, np.linalg.solve(passed[:6, 6:], two - passed[:6, :6] @ one)])
    expected = (expm(state * (steps - (damped > 2.0)) * step) @ start.ravel())[:6]
    shapes = body.shapes
    peak = np.abs(expm(state * step) @ start.ravel())[:6].max()
    np.testing.assert_allclose(shapes @ run.state_modal.values[0], expected, atol=1e-9 * peak)
    assert np.abs(run.ledger_residual.values).max() < 1e-11 * run.attrs["initial_energy"]
    # Over a single step the damping loss of the exact scheme may have any sign; in total it is not negative.
    assert run.damping_loss.values.min() >= 0.0


def test_damping_of_central_differences_never_adds_energy():
    """Step by step, at any damping."""
    for damping in (1.0, 60.0, 800.0):
        body, _, start = damped_block(damping)
        system = st.System(apart(body.at("tip")), [st.InitialState(body, *start)])
        run = st.simulate(system, 0.1, scheme=st.CentralDifference(), step=1e-4, sample_rate=1e4, probes=[])
        assert np.all(np.diff(run.damping_loss.values) >= 0.0)


def test_the_diagonal_of_a_damping_matrix_is_not_the_matrix():
    """Negative control: projected on its diagonal, the same damping ends elsewhere."""
    body, (mass, stiffness, c), start = damped_block(60.0)
    inverse = np.linalg.inv(body.shapes)
    own = np.diag(np.diag(body.shapes.T @ c @ body.shapes))
    diagonal = st.ReducedBody(mass, stiffness, {"tip": (0, 1)}, damping=inverse.T @ own @ inverse)
    ends = []
    for one in (body, diagonal):
        system = st.System(apart(one.at("tip")), [st.InitialState(one, *start)])
        run = st.simulate(system, 0.05, step=5e-5, probes=[])
        ends.append(one.shapes @ run.state_modal.values[0])
    assert np.abs(ends[0] - ends[1]).max() > 0.05 * np.abs(ends[0]).max()


@BOTH
def test_a_beam_on_a_spring_sags_as_the_two_in_parallel(scheme):
    """Deflection under a force at mid-span with a spring there: F / (k + 48 E I / L³), after it has settled."""
    bar = track(damping=0.5, cutoff=3e4)
    rod = st.PointMass(1.0)
    contact = st.PointContact(rod.centre, bar, at=0.3, gap=1.0)
    joints = [
        st.Spring(bar.centre, stiffness=2e3, direction="y"),
        st.Spring(rod.centre, stiffness=1.0, direction="y"),
    ]
    system = st.System(contact, [st.Force(bar.centre, y=-1.0)], joints)
    run = st.simulate(system, 0.6, scheme=scheme, probes=[st.Displacement(bar.centre)], sample_rate=1e4)
    stiffness = 48 * STEEL.young * STRIP.second_moment / 0.8**3 + 2e3
    # Modes to 30 kHz, the 33rd odd one: 1/k^4 left.
    assert run.displacement.values[-1, 0] == pytest.approx(-1.0 / stiffness, rel=1e-4)


@BOTH
def test_a_chain_of_connected_masses_is_one_body_given_by_its_matrices(scheme):
    """Springs and dashpots between masses, or the same numbers as a ReducedBody: the same motion on a belt."""
    step, c = 1e-4, 3.0
    belt = st.RigidTrack(velocity=0.02)
    joined = st.System(
        st.PointContact(ONE.centre, belt, friction=st.Coulomb(0.4)),
        [st.Force(ONE.centre, y=-4.0)],
        [*springs(), st.Dashpot(ONE.centre, TWO.centre, coefficient=c)],
    )
    # Freedoms: x of both masses, y of the first.
    stiffness = np.array([[K + BETWEEN, -BETWEEN, 0.0], [-BETWEEN, K + BETWEEN, 0.0], [0.0, 0.0, 0.0]])
    damping = c * np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    body = st.ReducedBody(0.4 * np.eye(3), stiffness, {"tip": (0, 2)}, damping=damping)
    whole = st.System(
        st.PointContact(body.at("tip"), belt, friction=st.Coulomb(0.4)), [st.Force(body.at("tip"), y=-4.0)]
    )
    words = {"scheme": scheme, "step": step, "sample_rate": 1 / step, "probes": []}
    one, other = (st.simulate(system, 0.3, **words) for system in (joined, whole))
    assert np.unique(one.status.values).size == 2
    np.testing.assert_array_equal(one.status.values, other.status.values)
    np.testing.assert_allclose(one.tangential_force, other.tangential_force, atol=1e-8)
    np.testing.assert_allclose(one.kinetic_and_elastic, other.kinetic_and_elastic, atol=1e-12)
