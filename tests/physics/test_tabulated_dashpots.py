"""Dashpots by a table against integrations of the same equations, linear dashpots, and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import stridula as st

FAST = st.RigidTrack(velocity=50.0)


def held_by(connections, mass, friction=0.0, load=1.0, drives=(), track=FAST):
    """A mass on a belt that never sticks, with connections along it."""
    contact = st.PointContact(mass.centre, track, friction=st.Coulomb(friction))
    return st.System(contact, [st.Force(mass.centre, y=-load), *drives], connections)


def random_table(random):
    """Velocities and forces of a damper that brakes: kinks on both sides of rest, and one at rest in every other."""
    at = np.sort(random.uniform(-0.8, 0.8, random.integers(2, 7)))
    if random.random() < 0.5:
        at[np.abs(at).argmin()] = 0.0
    force = np.cumsum(np.append(0.0, np.diff(at) * random.uniform(0.2, 6.0, at.size - 1)))
    return {"velocity": at, "force": force - random.choice([force[0], np.interp(0.0, at, force)])}


def motion(rates, start, times, most=1e-3):
    return solve_ivp(
        rates, (0.0, times[-1]), start, method="DOP853", rtol=1e-11, atol=1e-13, t_eval=times, max_step=most
    ).y


@pytest.mark.parametrize("seed", range(12))
def test_a_mass_moves_as_its_equation_says(seed):
    """On a spring under a constant friction, at the default step, in both schemes."""
    random = np.random.default_rng(seed)
    mass, load, velocity = st.PointMass(random.uniform(0.5, 2.0)), random.uniform(1.0, 5.0), random.uniform(-1.0, 1.0)
    spring = st.Spring(mass.centre, stiffness=random.uniform(20.0, 400.0))
    dashpots = [st.TabulatedDashpot(mass.centre, **random_table(random)) for _ in range(1 + seed % 2)]
    system = held_by([spring, *dashpots], mass, 0.3, load, [st.InitialVelocity(mass, x=velocity)])
    scheme = [st.ExactModal(), st.CentralDifference()][seed % 2]
    run = st.simulate(system, 1.0, scheme=scheme, probes=[st.Displacement(mass.centre, "x")])

    def rates(_, y):
        pull = spring.stiffness * y[0] + sum(one.pull(y[1]) for one in dashpots)
        return [y[1], (0.3 * load - pull) / mass.mass]

    place, speed = motion(rates, [0.0, velocity], run["time"].values)
    assert np.abs(run["displacement"].values[:, 0] - place).max() < 1e-5 * np.abs(place).max()
    # The work of friction on the mass, less the energy that is left, is what the dashpots have taken; losses are those
    # until half a step ago, since half a step before the start.
    left = 0.5 * mass.mass * speed**2 + 0.5 * spring.stiffness * place**2
    given = 0.5 * mass.mass * velocity**2 + (0.3 * load - sum(one.pull(0.0) for one in dashpots)) * place
    taken = (given - left)[-2:].mean() - (given - left)[99:101].mean()
    lost = float(run["damping_loss"][-1] - run["damping_loss"][100])
    assert lost == pytest.approx(taken, rel=1e-5)
    assert np.abs(run["ledger_residual"]).max() < 1e-9 * run["kinetic_and_elastic"].max()
    assert (np.diff(run["damping_loss"]) > -1e-9 * lost).all()


def test_the_error_falls_with_the_square_of_the_step():
    mass, spring = st.PointMass(1.0), 200.0
    table = {"velocity": np.linspace(-2.0, 2.0, 81)}
    dashpot = st.TabulatedDashpot(mass.centre, **table, force=3.0 * table["velocity"] * np.abs(table["velocity"]))
    joints = [dashpot, st.Spring(mass.centre, stiffness=spring)]
    system = held_by(joints, mass, drives=[st.InitialVelocity(mass, x=1.0)])
    errors = []
    for step in (8e-4, 4e-4, 2e-4):
        run = st.simulate(system, 0.4, step=step, sample_rate=1.0 / step, probes=[st.Displacement(mass.centre, "x")])
        exact = motion(lambda _, y: [y[1], -spring * y[0] - dashpot.pull(y[1])], [0.0, 1.0], run["time"].values, 1e-4)[
            0
        ]
        errors.append(np.abs(run["displacement"].values[:, 0] - exact).max())
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.15)


@pytest.mark.parametrize("friction", [st.Coulomb(0.4), st.StaticKinetic(0.8, 0.3)])
def test_a_straight_table_is_a_linear_dashpot(friction):
    """Bit by bit, with stick-slip: nothing is left beyond the linear part."""
    mass = st.PointMass(1.0)

    def run(dashpot):
        contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.05), friction=friction)
        # Of no other stiffness, it lets both march with the same code.
        springs = [st.CubicSpring(mass.centre, stiffness=300.0, cubic=0.0), dashpot]
        return st.simulate(st.System(contact, [st.Force(mass.centre, y=-10.0)], springs), 1.0)

    linear = run(st.Dashpot(mass.centre, coefficient=2.0))
    table = run(st.TabulatedDashpot(mass.centre, velocity=[-1.0, 2.0], force=[-2.0, 4.0]))
    assert float(linear["status_share"].sel(contact_status="sticking").mean()) > 0.1
    np.testing.assert_allclose(table["tangential_force"], linear["tangential_force"], atol=1e-12 * 5.0)


def test_stick_slip_of_two_masses_with_a_damper_that_yields():
    """Both on a belt, with a kinked damper between them: against SciPy from event to event."""
    one, two = st.PointMass(1.0, "one"), st.PointMass(1.5, "two")
    damper = st.TabulatedDashpot(
        one.centre, two.centre, velocity=[-1.0, -0.05, 0.05, 1.0], force=[-3.0, -1.0, 1.0, 2.0]
    )
    springs = [st.Spring(one.centre, stiffness=400.0), st.Spring(two.centre, stiffness=900.0)]
    belt, load = 0.1, 10.0
    contacts = [
        st.PointContact(one.centre, st.RigidTrack(velocity=belt), friction=st.StaticKinetic(0.6, 0.3), name="one"),
        st.PointContact(two.centre, FAST, friction=st.Coulomb(0.2), name="two"),
    ]
    drives = [st.Force(body.centre, y=-load) for body in (one, two)]
    run = st.simulate(st.System(contacts, drives, [damper, *springs]), 1.5, probes=[st.Displacement(one.centre, "x")])

    def second(y):
        return (0.2 * load - 900.0 * y[2] + damper.pull(y[1] - y[3])) / two.mass

    def pull_on_first(y):
        return -400.0 * y[0] - damper.pull(y[1] - y[3])

    def stuck(_, y):
        return [belt, 0.0, y[3], second([y[0], belt, *y[2:]])]

    def slipping(_, y):
        return [y[1], (pull_on_first(y) + 0.3 * load) / one.mass, y[3], second(y)]

    times, now, state, sticks = run["time"].values, 0.0, np.zeros(4), False
    found = np.zeros_like(times)
    while now < times[-1]:
        leaves = (
            (lambda _, y: -pull_on_first([y[0], belt, *y[2:]]) - 0.6 * load) if sticks else (lambda _, y: y[1] - belt)
        )
        leaves.terminal, leaves.direction = True, 1.0
        part = solve_ivp(
            stuck if sticks else slipping,
            (now, times[-1] + 1e-9),
            state,
            method="DOP853",
            rtol=1e-11,
            atol=1e-13,
            events=leaves,
            dense_output=True,
            max_step=1e-3,
        )
        seen = (times >= now) & (times <= part.t[-1])
        found[seen] = part.sol(times[seen])[0]
        if now == part.t[-1]:
            break
        now, state, sticks = part.t[-1], part.y[:, -1], not sticks
        state[1] = belt
        if not sticks:
            state[1] -= 1e-12
    share = float(run["status_share"].sel(contact_status="sticking")[:, 0].mean())
    assert 0.05 < share < 0.95
    assert np.abs(run["displacement"].values[:, 0] - found).max() < 2e-4 * np.abs(found).max()


@pytest.mark.parametrize("seed", range(4))
def test_linear_theory_has_the_slope_at_rest(seed):
    """Growth of a slider on a belt with a falling law, against that with a linear dashpot of the mean slope."""
    random = np.random.default_rng(seed)
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.5), friction=st.ExponentialWeakening(0.5, 0.3, 0.4))
    below, above = random.uniform(0.5, 4.0, 2)
    dashpots = (
        st.Dashpot(mass.centre, coefficient=0.5 * (below + above)),
        st.TabulatedDashpot(mass.centre, velocity=[-1.0, 0.0, 2.0], force=[-below, 0.0, 2.0 * above]),
    )
    spring = st.Spring(mass.centre, stiffness=random.uniform(50.0, 500.0))
    linear, table = (
        st.sliding_stability(st.System(contact, [st.Force(mass.centre, y=-10.0)], [spring, one])) for one in dashpots
    )
    np.testing.assert_allclose(table["growth_rate"], linear["growth_rate"], rtol=1e-10)
    np.testing.assert_allclose(table["frequency"], linear["frequency"], rtol=1e-10)


def test_growth_in_a_run_is_that_of_linear_theory():
    """A small vibration about sliding decays as with the mean of the slopes at rest."""
    mass = st.PointMass(1.0)
    damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, 0.0, 1.0], force=[-0.5, 0.0, 1.5])
    joints = [st.Spring(mass.centre, stiffness=400.0), damper]
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=5.0), friction=st.Coulomb(0.3))
    drives = [st.Force(mass.centre, y=-10.0), st.InitialEquilibrium(), st.InitialVelocity(mass, x=1e-3)]
    system = st.System(contact, drives, joints)
    growth = float(st.sliding_stability(system)["growth_rate"].max())
    run = st.simulate(system, 4.0, probes=[st.Velocity(mass.centre, "x")])
    speed, times = run["velocity"].values[:, 0], run["time"].values
    tops = np.flatnonzero((speed[1:-1] > speed[:-2]) & (speed[1:-1] >= speed[2:])) + 1
    slope = np.polyfit(times[tops], np.log(speed[tops]), 1)[0]
    assert slope == pytest.approx(growth, rel=5e-3)


def test_a_preloaded_damper_moves_the_equilibrium():
    mass = st.PointMass(1.0)
    damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, 1.0], force=[-1.0, 3.0])
    system = held_by([st.Spring(mass.centre, stiffness=200.0), damper], mass, 0.3, 10.0, [st.InitialEquilibrium()])
    run = st.simulate(system, 0.1, probes=[st.Displacement(mass.centre, "x")])
    np.testing.assert_allclose(run["displacement"], (3.0 - 1.0) / 200.0, rtol=1e-9)


def test_runs_continue_bit_by_bit_and_side_by_side():
    mass = st.PointMass(1.0)
    systems = []
    for valve in (0.1, 0.3):
        table = {"velocity": [-1.0, 0.0, valve, 1.0], "force": [-5.0, 0.0, 8.0 * valve, 8.0 * valve + 1.0]}
        contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.3), friction=st.StaticKinetic(0.5, 0.3))
        joints = [st.Spring(mass.centre, stiffness=300.0), st.TabulatedDashpot(mass.centre, **table)]
        systems.append(st.System(contact, [st.Force(mass.centre, y=-10.0)], joints))
    whole = [st.simulate(one, 1.0, step=1e-4, sample_rate=1e3) for one in systems]
    first = st.simulate(systems[0], 0.4, step=1e-4, sample_rate=1e3)
    rest = st.simulate(systems[0], 0.6, step=1e-4, sample_rate=1e3, start=first)
    np.testing.assert_array_equal(rest["tangential_force"], whole[0]["tangential_force"][400:])
    beside = st.simulate_many(systems, 1.0, step=1e-4, sample_rate=1e3)
    for one, alone in zip(beside, whole, strict=True):
        np.testing.assert_allclose(one["tangential_force"], alone["tangential_force"], atol=1e-9)


def test_a_cycle_is_that_of_the_run():
    """A driven mass with a damper that yields: the search for its cycle finds the steady vibration."""
    mass = st.PointMass(1.0)
    damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, -0.1, 0.1, 1.0], force=[-1.9, -1.0, 1.0, 1.9])
    push = st.Force(mass.centre, x=3.0, y=-5.0, history=st.Harmonic(2.0))
    contact = st.PointContact(mass.centre, st.RigidTrack(), friction=st.Coulomb(0.02))
    system = st.System(
        contact, [push, st.Force(mass.centre, y=-20.0)], [st.Spring(mass.centre, stiffness=200.0), damper]
    )
    cycle = st.limit_cycle(system)
    run = st.simulate(system, 20.0, probes=[st.Displacement(mass.centre, "x")])
    last = run["displacement"].values[run["time"].values > 19.5, 0]
    assert float(cycle["period"]) == pytest.approx(0.5)
    found = cycle["displacement"].values[:, 0]
    assert np.ptp(found) == pytest.approx(np.ptp(last), rel=1e-3)
    taken = np.interp([19.5, 20.0], run["time"], run["damping_loss"])
    assert float(cycle["damping_loss"][-1]) == pytest.approx(np.diff(taken)[0], rel=2e-3)


def test_a_step_too_long_for_a_dashpot_is_refused():
    mass = st.PointMass(1.0)
    damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, 0.0, 1.0], force=[-1.0, 0.0, 500.0])
    system = held_by([damper], mass, drives=[st.InitialVelocity(mass, x=1.0)])
    with pytest.raises(st.Diverged, match="too long for the slope that a nonlinear spring or dashpot has reached"):
        st.simulate(system, 0.01, step=1e-3, sample_rate=1e3)
    run = st.simulate(system, 0.01, probes=[st.Velocity(mass.centre, "x")])
    exact = np.exp(-500.0 * run["time"].values)
    np.testing.assert_allclose(run["velocity"].values[5:, 0], exact[5:], atol=2e-3)


def test_a_dashpot_of_a_body_that_is_carried_along_is_refused_in_linear_theory():
    mass = st.PointMass(1.0)
    damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, 0.0, 1.0], force=[-1.0, 0.0, 5.0])
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.1), friction=st.Coulomb(0.9))
    system = st.System(contact, [st.Force(mass.centre, y=-10.0), st.InitialEquilibrium()], [damper])
    with pytest.raises(ValueError, match=r"connections must (be linear where they brake|not brake)"):
        st.simulate(system, 0.1)


def test_a_dashpot_of_a_body_beside_one_that_is_carried_along_is_allowed():
    """A mass that sticks to a belt moves with it; the other one slides, on a spring and a dashpot."""
    still, carried = st.PointMass(1.0, "still"), st.PointMass(1.0, "carried")
    contacts = [
        st.PointContact(still.centre, FAST, friction=st.Coulomb(0.2), name="still"),
        st.PointContact(carried.centre, st.RigidTrack(velocity=0.1), friction=st.Coulomb(0.9), name="carried"),
    ]
    table = {"velocity": [-1.0, 0.0, 1.0], "force": [-1.0, 0.0, 5.0]}
    joints = [st.Spring(still.centre, stiffness=100.0), st.TabulatedDashpot(still.centre, **table)]
    drives = [st.Force(body.centre, y=-10.0) for body in (still, carried)]
    theory = st.sliding_stability(st.System(contacts, drives, joints), status=["sliding", "sticking"])
    assert float(theory["growth_rate"].max()) == pytest.approx(-0.5 * 3.0, rel=1e-9)


def test_energy_of_a_cycle_is_the_area_of_the_table():
    """Under an imposed amplitude the loss of a cycle is the integral of force over displacement."""
    mass, stiffness = st.PointMass(1e5), 1e5 * (2.0 * np.pi) ** 2
    damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, -0.2, 0.0, 0.3, 1.0], force=[-3.0, -2.0, 0.0, 1.0, 5.0])
    start = st.InitialVelocity(mass, x=0.5)
    system = held_by([st.Spring(mass.centre, stiffness=stiffness), damper], mass, drives=[start])
    run = st.simulate(system, 1.0)
    expected = quad(lambda t: damper.pull(0.5 * np.cos(t)) * 0.5 * np.cos(t) / (2.0 * np.pi), 0.0, 2.0 * np.pi)[0]
    assert float(run["damping_loss"][-1]) == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("scheme", [st.ExactModal(), st.CentralDifference()])
def test_a_beam_with_a_damper_that_yields_moves_as_its_modes_do(scheme):
    """The modes of a track with a damper, under a force, integrated by SciPy."""
    beam = st.ModalBeam(st.Material(2.1e11, 7800.0, 0.3), st.Rectangle(0.02, 0.009), 1.1, damping=0.01, cutoff=1.5e3)
    table = {"velocity": [-0.05, -0.01, 0.01, 0.05], "force": [-0.6, -0.4, 0.2, 0.5]}
    damper = st.TabulatedDashpot(beam.at(0.4), direction="y", **table)
    mass = st.PointMass(0.1)
    push = st.Force(beam.at(0.3), y=-20.0, history=st.Harmonic(60.0))
    system = st.System(st.PointContact(mass.centre, beam, at=0.5, gap=1.0), [push], [damper])
    run = st.simulate(system, 0.1, scheme=scheme, probes=[st.Displacement(beam.at(0.4), "y")])
    modes = beam.modes()
    w, d = modes.angular_frequency, modes.damping_rate
    at_damper, at_push = (beam.trace(x)[1] for x in (0.4, 0.3))

    def rates(t, y):
        q, v = y.reshape(2, -1)
        pulled = damper.pull(at_damper @ v) * at_damper
        return np.concatenate([v, -d * v - w**2 * q - pulled - 20.0 * np.sin(2.0 * np.pi * 60.0 * t) * at_push])

    exact = at_damper @ motion(rates, np.zeros(2 * w.size), run["time"].values, 1e-4)[: w.size]
    assert np.abs(run["displacement"].values[:, 0] - exact).max() < 1e-4 * np.abs(exact).max()


def test_a_dashpot_where_residual_shapes_yield_is_refused():
    """Its force would follow from the motion that it causes at once, the more so the shorter the step."""
    mesh = st.SolidMesh.block((0.04, 0.02, 0.02), (4, 2, 2))
    block = st.SolidBody(mesh, st.Material(4e9, 2500.0, 0.25), cutoff=10e3, damping=0.01, contact_faces={"bottom": 4})
    face = st.SurfaceContact(block, "bottom", st.RigidTrack(velocity=1.0), friction=st.Coulomb(0.2), stiffness=1e11)
    place = block.face_points("bottom").place[0].tolist()
    hard = st.TabulatedDashpot(block.at(place), direction="x", velocity=[-1.0, 0.0, 1.0], force=[-1.0, 0.0, 1e4])
    with pytest.raises(ValueError, match=r"^connections must have tabulated dashpots only where residual shapes"):
        st.simulate(st.System(face, [st.Force(block.at(place), y=-10.0)], [hard]), 1e-4)


def test_drawings_name_the_velocities_of_the_table():
    mass = st.PointMass(1.0)
    damper = st.TabulatedDashpot(mass.centre, velocity=[-1.0, 0.0, 2.0], force=[-1.0, 0.0, 5.0])
    figure = st.plot.system(held_by([damper], mass))
    words = " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))
    assert "tabulated dashpot from -1 to 2 m/s" in words
