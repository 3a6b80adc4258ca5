"""Viscoelastic springs against closed forms over the frequency, and against integrations of their relaxation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st
from stridula.integration.live import LiveMarch

FAST = st.RigidTrack(velocity=50.0)
STEEL = st.Material(2.1e11, 7800.0, 0.3)


def random_table(random, low=20.0, high=2000.0, size=1e4, loss=0.0):
    """A table of a material with a least loss factor: a power of the frequency, or springs in parallel that relax."""
    frequency = np.geomspace(low, high, random.integers(4, 12))
    if random.random() < 0.5:
        moduli = size * (1j * frequency / low) ** random.uniform(0.02, 0.4)
    else:
        rates = np.exp(random.uniform(np.log(low), np.log(high), 2))
        relaxing = sum(random.uniform(0.2, 2.0) * 1j * frequency / (1j * frequency + rate) for rate in rates)
        moduli = size * (1.0 + relaxing)
    if (moduli.imag / moduli.real).min() < loss:
        return random_table(random, low, high, size, loss)
    return {"frequency": frequency, "stiffness": moduli.real, "loss_factor": moduli.imag / moduli.real}, moduli


def sliding(mass, springs, drives=(), load=1.0, friction=0.0):
    """A mass on a belt that never sticks, held along it."""
    contact = st.PointContact(mass.centre, FAST, friction=st.Coulomb(friction))
    return st.System(contact, [st.Force(mass.centre, y=-load), *drives], springs)


@pytest.mark.parametrize("seed", range(12))
def test_a_spring_has_the_stiffness_and_the_loss_of_a_material(seed):
    random = np.random.default_rng(seed)
    table, moduli = random_table(random)
    spring = st.ViscoelasticSpring(st.PointMass(1.0).centre, **table)
    found = spring.complex_stiffness(table["frequency"])
    np.testing.assert_allclose(found.real, moduli.real, rtol=0.03)
    np.testing.assert_allclose(found.imag / found.real, moduli.imag / moduli.real, rtol=0.03, atol=1e-3)
    everywhere = spring.complex_stiffness(np.geomspace(1e-3, 1e6, 500))
    assert everywhere.imag.min() >= 0.0
    assert everywhere.real.min() >= 0.5 * table["stiffness"].min() * (1.0 - 1e-9)


def test_a_single_frequency_is_met():
    spring = st.ViscoelasticSpring(st.PointMass(1.0).centre, frequency=[2e3], stiffness=[1e8], loss_factor=[0.3])
    assert complex(spring.complex_stiffness(2e3)) == pytest.approx(1e8 * (1.0 + 0.3j), rel=1e-6)


def test_a_spring_without_loss_is_a_spring():
    mass = st.PointMass(1.0)
    spring = st.ViscoelasticSpring(mass.centre, frequency=[10.0, 100.0], stiffness=[5e3, 5e3], loss_factor=[0.0, 0.0])
    assert spring.relaxation.branches == ()
    assert float(spring.complex_stiffness(50.0).real) == pytest.approx(5e3, rel=1e-12)


def test_a_table_of_no_material_is_named():
    """A loss factor of 0.3 over two decades at a stiffness that stays: the stiffness of a material would double."""
    frequency = np.geomspace(100.0, 1e4, 9)
    with pytest.warns(st.DoubtfulValue, match="no passive spring has these stiffnesses and loss factors within"):
        st.ViscoelasticSpring(
            st.PointMass(1.0).centre, frequency=frequency, stiffness=np.full(9, 1e8), loss_factor=np.full(9, 0.3)
        )


@pytest.mark.parametrize("seed", range(6))
def test_modes_are_the_roots_of_the_complex_stiffness(seed):
    """At each exponent p of linear theory ``m p² + k(p) = 0``, with the stiffness continued to complex frequencies."""
    random = np.random.default_rng(20 + seed)
    mass = st.PointMass(random.uniform(0.5, 2.0))
    table, _ = random_table(random)
    spring = st.ViscoelasticSpring(mass.centre, **table)
    found = st.sliding_stability(sliding(mass, [spring]))
    exponents = found["growth_rate"].values + 2j * np.pi * found["frequency"].values
    along = np.abs(exponents) > 1e-6
    assert along.sum() >= len(spring.relaxation.branches) + 1
    left = mass.mass * exponents[along] ** 2
    dynamic = spring.relaxation.stiffness(-1j * exponents[along])
    np.testing.assert_allclose(dynamic, -left, rtol=1e-5)


@pytest.mark.parametrize("seed", range(6))
def test_a_driven_mass_has_the_amplitude_of_the_complex_stiffness(seed):
    """Steady vibration ``x = F / (k - m w²)`` and the energy ``pi Im k |x|²`` lost in a period, in both schemes."""
    random = np.random.default_rng(40 + seed)
    mass, scheme = st.PointMass(random.uniform(0.5, 2.0)), [st.ExactModal(), st.CentralDifference()][seed % 2]
    table, moduli = random_table(random, loss=0.15)
    spring = st.ViscoelasticSpring(mass.centre, **table)
    place = random.integers(len(moduli) // 2, len(moduli) - 1)
    frequency = round(float(table["frequency"][place]))
    push = st.Force(mass.centre, x=1.0, history=st.Harmonic(frequency))
    # Free vibration at some 20 Hz has died away in three quarters of it.
    whole = round(1.5 * frequency) / frequency
    run = st.simulate(sliding(mass, [spring], [push]), whole, scheme=scheme, probes=[st.Displacement(mass.centre, "x")])
    times, x = run["time"].values, run["displacement"].values[:, 0]
    late = times > 0.75 * whole
    angular = 2.0 * np.pi * frequency
    basis = np.stack([np.exp(1j * angular * times[late]).real, np.exp(1j * angular * times[late]).imag], axis=1)
    cosine, sine = np.linalg.lstsq(basis, x[late], rcond=None)[0]
    dynamic = complex(spring.complex_stiffness(frequency)) - mass.mass * angular**2
    # The force is a sine.
    expected = 1.0 / dynamic
    assert complex(sine, cosine) == pytest.approx(expected, rel=5e-3)
    lost = np.interp([0.75 * whole, whole], times, run["damping_loss"].values)
    periods = 0.25 * whole * frequency
    per_period = np.pi * complex(spring.complex_stiffness(frequency)).imag * abs(expected) ** 2
    assert (lost[1] - lost[0]) / periods == pytest.approx(per_period, rel=0.02)
    assert np.abs(run["ledger_residual"]).max() < 1e-9 * run["kinetic_and_elastic"].max()


@pytest.mark.parametrize("seed", range(4))
def test_a_kicked_pair_relaxes_as_its_equations_say(seed):
    """Two masses with a spring between them, whose branches are integrated by SciPy beside them."""
    random = np.random.default_rng(60 + seed)
    one, two = st.PointMass(random.uniform(0.5, 2.0), "one"), st.PointMass(random.uniform(0.5, 2.0), "two")
    between = st.ViscoelasticSpring(one.centre, two.centre, **random_table(random)[0])
    ground = st.Spring(two.centre, stiffness=5e3)
    contacts = [st.PointContact(body.centre, FAST, friction=st.Coulomb(0.2), name=body.name) for body in (one, two)]
    drives = [st.Force(one.centre, y=-2.0), st.Force(two.centre, y=-3.0), st.InitialVelocity(one, x=0.8)]
    system = st.System(contacts, drives, [between, ground])
    run = st.simulate(system, 0.3, probes=[st.Displacement(body.centre, "x") for body in (one, two)])
    branches, rest = between.relaxation.branches, between.relaxation.at_rest

    def rates(_, y):
        (x1, x2, v1, v2), (inner, speed) = y[:4], y[4:].reshape(2, -1)
        stretch = x1 - x2
        pulls = [b.stiffness * (stretch - own) for b, own in zip(branches, inner, strict=True)]
        pull = rest * stretch + sum(pulls)
        # Each branch ends at an inner point with the mass ``stiffness / frequency²``.
        faster = [
            pull_of * b.angular_frequency**2 / b.stiffness - b.damping_rate * own
            for b, pull_of, own in zip(branches, pulls, speed, strict=True)
        ]
        return [v1, v2, (0.4 - pull) / one.mass, (0.6 + pull - 5e3 * x2) / two.mass, *speed, *faster]

    start, times = np.zeros(4 + 2 * len(branches)), run["time"].values
    start[2] = 0.8
    exact = solve_ivp(rates, (0.0, times[-1]), start, method="LSODA", rtol=1e-10, atol=1e-12, t_eval=times).y[:2]
    assert np.abs(run["displacement"].values.T - exact).max() < 1e-4 * np.abs(exact).max()


def test_a_beam_on_a_damping_layer_has_the_mobility_of_its_complex_stiffness():
    """A track on two springs, one with a loss: its mobility from that of the free beam and the stiffness there."""
    random = np.random.default_rng(5)
    beam = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.009), 1.1, damping=0.01, cutoff=3e3)
    layer = st.ViscoelasticSpring(beam.at(0.4), direction="y", **random_table(random, size=1e5)[0])
    mass = st.PointMass(0.1)
    system = st.System(st.PointContact(mass.centre, beam, at=0.5), [], [layer])
    frequency = np.geomspace(30.0, 1500.0, 60)
    angular, stiffness = 2.0 * np.pi * frequency, layer.complex_stiffness(frequency)
    here, there = beam.at(0.4), beam.at(0.7)
    free = [st.mobility(*pair, frequency=frequency).values for pair in ((there, there), (there, here), (here, here))]
    pull = stiffness / (1j * angular)
    expected = free[0] - free[1] ** 2 * pull / (1.0 + free[2] * pull)
    found = st.mobility(there, there, frequency=frequency, system=system).values
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_an_equilibrium_is_that_of_the_stiffness_at_rest():
    mass = st.PointMass(1.0)
    spring = st.ViscoelasticSpring(mass.centre, frequency=[50.0, 500.0], stiffness=[1e4, 1.4e4], loss_factor=[0.2, 0.2])
    system = sliding(mass, [spring], [st.InitialEquilibrium()], load=20.0, friction=0.3)
    run = st.simulate(system, 0.05, probes=[st.Displacement(mass.centre, "x")])
    np.testing.assert_allclose(run["displacement"].values, 6.0 / spring.relaxation.at_rest, rtol=1e-9)


def layered(k=0):
    """A mass that sticks and slips on a belt, on a viscoelastic spring."""
    mass = st.PointMass(1.0)
    frequency = np.geomspace(2.0, 200.0, 5)
    moduli = (800.0 + 50.0 * k) * (1j * frequency) ** 0.1
    spring = st.ViscoelasticSpring(
        mass.centre, frequency=frequency, stiffness=moduli.real, loss_factor=moduli.imag / moduli.real
    )
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=0.02), friction=st.StaticKinetic(0.6, 0.3))
    return st.System(contact, [st.Force(mass.centre, y=-10.0)], [spring])


def test_a_run_continues_bit_by_bit_and_can_be_run_again():
    system = layered()
    words = {"step": 1e-4, "probes": [st.Displacement(system.bodies[0].centre, "x")]}
    whole = st.simulate(system, 0.4, **words)
    first = st.simulate(system, 0.2, **words)
    rest = st.simulate(system, 0.2, start=first, **words)
    np.testing.assert_array_equal(whole["displacement"].values[-rest.sizes["time"] :], rest["displacement"].values)
    again = st.load_scenario(whole).simulate()
    np.testing.assert_array_equal(again["displacement"], whole["displacement"])


def test_runs_side_by_side_are_those_alone():
    systems = [layered(k) for k in range(4)]
    together = st.simulate_many(systems, 0.2, step=1e-4)
    for system, found in zip(systems, together, strict=True):
        alone = st.simulate(system, 0.2, step=1e-4)
        np.testing.assert_allclose(found["tangential_force"], alone["tangential_force"], atol=1e-9)


def test_the_cycle_is_that_of_a_long_run():
    system = layered()
    run = st.simulate(system, 6.0, step=1e-4)
    cycle = st.limit_cycle(system, run)
    late = run.sel(time=slice(3.0, None))
    slips = np.flatnonzero(np.diff((late["status"].values.ravel() == 2).astype(int)) == 1)
    period = np.diff(late["time"].values[slips]).mean()
    assert 1.0 / float(cycle["frequency"]) == pytest.approx(period, rel=2e-3)


def test_a_played_run_keeps_the_relaxation_through_a_change():
    system, probes = layered(), (st.Velocity(layered().bodies[0].centre, "x"),)
    still, live = (LiveMarch(system, probes, step=1e-4, sample_rate=1e4) for _ in range(2))
    still.advance(1000)
    live.advance(1000)
    assert live.change(layered(), probes, step=1e-4)
    one, other = (march.advance(500)[0].contact["tangential_force"] for march in (still, live))
    assert np.abs(one - other).max() < 1e-6 * np.abs(one).max()


def test_a_table_is_read(tmp_path):
    file = tmp_path / "layer.csv"
    file.write_text("f/kHz,k/(N/um),eta\n0.5,10,0.2\n2,13,0.25\n", encoding="utf-8")
    mass = st.PointMass(1.0)
    spring = st.ViscoelasticSpring.read(file, mass.centre, frequency_unit=1e3, stiffness_unit=1e6)
    assert spring.frequency == (500.0, 2000.0)
    assert spring.stiffness == (10e6, 13e6)
    assert spring.loss_factor == (0.2, 0.25)
    file.write_text("0.5,10,x\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"layer.csv, line 1"):
        st.ViscoelasticSpring.read(file, mass.centre)


def test_a_scenario_reads_a_table_and_a_drawing_names_it(tmp_path):
    (tmp_path / "layer.csv").write_text("0.1,10,0.2\n0.4,13,0.25\n", encoding="utf-8")
    (tmp_path / "mass.toml").write_text(
        """
title = "Mass on a layer"
[bodies.mass]
kind = "point mass"
mass = 1.0
[[contacts]]
tip = { body = "mass", point = "centre" }
track = { kind = "rigid", velocity = 50.0 }
friction = 0.3
[[connections]]
kind = "viscoelastic spring"
first = { body = "mass", point = "centre" }
file = "layer.csv"
frequency_unit = 1e3
stiffness_unit = 1e3
[simulation]
duration = 0.01
""",
        encoding="utf-8",
    )
    system = st.load_scenario(tmp_path / "mass.toml").system
    (spring,) = system.connections
    assert spring.frequency == (100.0, 400.0)
    assert spring.stiffness == (10e3, 13e3)
    figure = st.plot.system(system)
    words = " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))
    assert "viscoelastic spring 1e+04 to 1.3e+04 N/m" in words


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (((), (), ()), "frequency must have one value or more"),
        (((2.0, 1.0), (1.0, 1.0), (0.1, 0.1)), "frequency"),
        (((1.0,), (1.0, 2.0), (0.1,)), "stiffness must have as many values as frequency, 1"),
        (((1.0,), (1.0,), (-0.1,)), "loss_factor"),
        (((1.0,), (0.0,), (0.1,)), "stiffness"),
    ],
)
def test_tables_are_checked(table, words):
    frequency, stiffness, loss = table
    with pytest.raises(ValueError, match=words):
        st.ViscoelasticSpring(st.PointMass(1.0).centre, frequency=frequency, stiffness=stiffness, loss_factor=loss)
