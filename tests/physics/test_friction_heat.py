"""Heat of friction and friction over the temperature, against integrations of the same equations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st
from stridula.integration.live import LiveMarch

AREA = 2e-4


def random_law(random, fades=True):
    """A law at three temperatures, of each of the kinds that may be given so."""
    temperature = (20.0 + np.cumsum(random.uniform(5.0, 30.0, 3))).tolist()
    share = np.sort(random.uniform(0.4, 1.0, 3))[::-1] if fades else np.ones(3)
    kinetic, static, velocity = random.uniform(0.2, 0.4), random.uniform(0.4, 0.6), random.uniform(0.05, 0.3)
    speeds, values = [0.0, *np.sort(random.uniform(0.0, 1.0, 4)).tolist()], random.uniform(0.2, 0.5, 5)
    of = (
        lambda k: st.Coulomb(k * static),
        lambda k: st.StaticKinetic(k * static, k * kinetic),
        lambda k: st.Stribeck(k * static, k * kinetic, velocity, viscous=0.01 * k),
        lambda k: st.ExponentialWeakening(k * static, k * kinetic, velocity),
        lambda k: st.TabulatedFriction(speeds, (k * values).tolist(), float(k * values[0] + 0.1)),
    )[random.integers(5)]
    return st.FrictionOverTemperature(temperature, [of(float(k)) for k in share])


def random_layers(random, load, speed):
    """Layers that warm through the temperatures of `random_law` within a second or so."""
    count = int(random.integers(1, 4))
    capacity = 0.3 * load * speed / random.uniform(40.0, 120.0) * random.uniform(0.5, 2.0, count)
    conductance = capacity[:-1] * random.uniform(0.5, 20.0, count - 1)
    start = random.uniform(10.0, 40.0, count) if random.random() < 0.5 else None
    return st.HeatedLayers(
        capacity.tolist(),
        conductance.tolist(),
        cooling=float(capacity[-1] * random.uniform(0.0, 2.0)),
        ambient=float(random.uniform(10.0, 30.0)),
        initial=None if start is None else start.tolist(),
        share=float(random.uniform(0.2, 1.0)),
    )


def on_a_belt(law, layers, mass, stiffness, load, belt, **words):
    body = st.PointMass(mass)
    contact = st.PointContact(body.centre, st.RigidTrack(velocity=belt), friction=law, heating=layers, **words)
    return st.System(contact, [st.Force(body.centre, y=-load)], [st.Spring(body.centre, stiffness=stiffness)])


def rates_of_layers(layers, values, power):
    matrix, constant = layers.rates
    found = matrix @ values + constant
    found[0] += layers.share * power / layers.capacity[0]
    return found


def from_event_to_event(law, layers, mass, stiffness, load, belt, times):
    """Place, temperatures and loss to friction of a mass at rest on a belt, by DOP853 from stop to start to stop."""
    state, time, stuck, sense = np.concatenate([[0.0, 0.0, 0.0], layers.start]), 0.0, False, -1.0
    found = np.full((state.size, times.size), np.nan)

    def friction(speed, temperature):
        return float(law.at(temperature).coefficient_at(speed)) * load

    while time < times[-1] * (1.0 - 1e-12):
        begun = time

        def rates(now, y, stuck=stuck, sense=sense):
            if stuck:
                return np.concatenate([[belt, 0.0, 0.0], rates_of_layers(layers, y[3:], 0.0)])
            slip = max(abs(y[1] - belt), 1e-300)
            force = friction(slip, y[3])
            moved = [y[1], (-stiffness * y[0] - sense * force) / mass, force * slip]
            return np.concatenate([moved, rates_of_layers(layers, y[3:], force * slip)])

        def changes(now, y, stuck=stuck, sense=sense, begun=begun):
            if stuck:
                return abs(stiffness * y[0]) - friction(0.0, y[3])
            return (y[1] - belt) * sense if now > begun + 1e-9 else 1.0

        changes.terminal, changes.direction = True, 1 if stuck else -1
        part = solve_ivp(
            rates, (time, times[-1]), state, "DOP853", events=changes, dense_output=True, rtol=1e-10, atol=1e-12,
            max_step=0.05 * np.sqrt(mass / stiffness),
        )  # fmt: skip
        here = (times >= time) & (times <= part.t[-1])
        if here.any():
            found[:, here] = part.sol(times[here])
        state, time = part.y[:, -1].copy(), part.t[-1]
        state[1] = belt
        stuck, sense = not stuck and abs(stiffness * state[0]) <= friction(0.0, state[3]), -np.sign(state[0])
    return found


@pytest.mark.parametrize("seed", range(10))
def test_a_block_warms_and_slides_as_its_equations_say(seed):
    """Sliding and sticking, under every kind of law that may be given over the temperature, at the default step."""
    random = np.random.default_rng(seed)
    law, mass, stiffness = random_law(random), random.uniform(0.5, 2.0), 10.0 ** random.uniform(2.5, 4.0)
    load, belt = random.uniform(20.0, 200.0), random.uniform(0.05, 0.6)
    layers = random_layers(random, load, belt)
    run = st.simulate(on_a_belt(law, layers, mass, stiffness, load, belt), 1.0)
    times = run["time"].values
    place, _, lost, *temperatures = from_event_to_event(law, layers, mass, stiffness, load, belt, times)
    rise = np.ptp(temperatures[0])
    assert rise > 0.5
    assert np.abs(run["temperature"].values - temperatures[0]).max() < 5e-4 * rise
    assert np.abs(run["friction_loss"].values - lost).max() < 5e-4 * lost[-1]
    assert np.abs(run["contact_position"].values - place).max() < 2e-3 * np.ptp(place)
    stored = np.array(layers.capacity) @ (np.array(temperatures) - layers.start[:, None])
    assert np.abs(run["stored_heat"].values - stored).max() < 5e-4 * np.abs(stored).max()
    np.testing.assert_allclose(run["heat"], layers.share * run["friction_loss"], rtol=1e-9, atol=1e-9 * lost[-1])


def test_a_shorter_step_comes_nearer():
    """At least of first order: the loss in a step takes the force at its beginning."""
    law, layers = random_law(np.random.default_rng(3)), st.HeatedLayers([5.0, 9.0], [3.0], cooling=1.0)
    given = law, layers, 1.0, 400.0, 80.0, 0.5
    errors = []
    for step in (4e-4, 2e-4, 1e-4):
        run = st.simulate(on_a_belt(*given), 1.0, step=step, sample_rate=1000.0)
        known = from_event_to_event(*given, run["time"].values)[3]
        errors.append(np.abs(run["temperature"].values - known).max())
    assert errors[1] < 0.6 * errors[0]
    assert errors[2] < 0.6 * errors[1]


@pytest.mark.parametrize("joint", [{}, {"tangential_stiffness": 3e4}])
@pytest.mark.parametrize("kind", ["coulomb", "stribeck", "tabulated", "static-kinetic"])
def test_equal_laws_at_all_temperatures_are_that_law_to_the_last_bit(kind, joint):
    law = {
        "coulomb": st.Coulomb(0.4),
        "stribeck": st.Stribeck(0.4, 0.4 if joint else 0.25, 0.1),
        "tabulated": st.TabulatedFriction([0.0, 0.1, 0.5], [0.4, 0.3, 0.25]),
        "static-kinetic": st.StaticKinetic(0.4, 0.4 if joint else 0.3),
    }[kind]
    layers = st.HeatedLayers(0.1)
    warm = on_a_belt(st.FrictionOverTemperature([20.0, 21.0, 23.0], [law] * 3), layers, 1.0, 900.0, 50.0, 0.2, **joint)
    plain = on_a_belt(law, layers, 1.0, 900.0, 50.0, 0.2, **joint)
    without = on_a_belt(law, None, 1.0, 900.0, 50.0, 0.2, **joint)
    runs = [st.simulate(one, 0.5, sample_rate=2000.0, step=1e-4) for one in (warm, plain, without)]
    assert np.ptp(runs[0]["temperature"].values) > 3.0
    for name in ("tangential_force", "slip_velocity", "status_share"):
        np.testing.assert_array_equal(runs[0][name], runs[1][name])
        # Without heating it marches as the only contact, by other operations.
        np.testing.assert_allclose(runs[1][name], runs[2][name], atol=1e-6 * float(np.abs(runs[2][name]).max()))
    assert "temperature" not in runs[2]


def test_friction_over_speed_pressure_and_temperature_is_interpolated_in_all_of_them():
    """In steady sliding under two loads, between temperatures that are held."""
    speeds, pressures, temperatures = [0.0, 0.5, 2.0], [1e4, 1e5, 4e5], [20.0, 100.0, 300.0]
    values = np.random.default_rng(5).uniform(0.2, 0.6, (3, 3, 3))
    tables = [st.TabulatedFriction(speeds, one.tolist(), pressure=pressures) for one in values]
    law = st.FrictionOverTemperature(temperatures, tables)
    for load, held in ((AREA * 5e4, 60.0), (AREA * 2e5, 220.0), (AREA * 9e5, 400.0)):
        history = st.TemperatureHistory([0.0, 1.0], [held, held])
        body = st.PointMass(1.0)
        contact = st.PointContact(
            body.centre, st.RigidTrack(velocity=1.2), friction=law, heating=history, area=AREA, tangential_damping=0.0
        )
        system = st.System(
            contact,
            [st.Force(body.centre, y=-load), st.InitialEquilibrium("sliding")],
            [st.Spring(body.centre, stiffness=1e4), st.Dashpot(body.centre, coefficient=5.0)],
        )
        run = st.simulate(system, 0.05, sample_rate=1000.0)
        at_speed = [[float(one.coefficient_at(1.2)) for one in table.sections] for table in tables]
        over_pressure = [np.interp(load / AREA, pressures, one) for one in at_speed]
        expected = float(np.interp(held, temperatures, over_pressure)) * load
        np.testing.assert_allclose(-run["tangential_force"], expected, rtol=1e-9)
        np.testing.assert_allclose(run["temperature"], held)


def test_a_history_is_followed_and_goes_on_in_a_record_that_is_continued():
    times, temperatures = [0.02, 0.05, 0.2], [50.0, 150.0, 80.0]
    law = st.FrictionOverTemperature([50.0, 150.0], [st.Coulomb(0.5), st.Coulomb(0.2)])
    history = st.TemperatureHistory(times, temperatures)
    system = on_a_belt(law, history, 1.0, 100.0, 10.0, 5.0)
    whole = st.simulate(system, 0.3, sample_rate=1000.0, step=1e-4)
    known = np.interp(whole["time"], times, temperatures)
    np.testing.assert_allclose(whole["temperature"], known, atol=1e-9)
    middle = np.interp(whole["time"] - 0.5e-3, times, temperatures)
    np.testing.assert_allclose(-whole["tangential_force"] / 10.0, np.interp(middle, [50, 150], [0.5, 0.2]), atol=2e-3)
    first = st.simulate(system, 0.1, sample_rate=1000.0, step=1e-4)
    rest = st.simulate(system, 0.2, sample_rate=1000.0, step=1e-4, start=first)
    np.testing.assert_array_equal(rest["temperature"], whole["temperature"][100:])
    np.testing.assert_array_equal(rest["tangential_force"], whole["tangential_force"][100:])


def test_a_record_that_is_continued_keeps_its_temperatures_to_the_last_bit():
    law, layers = random_law(np.random.default_rng(1)), st.HeatedLayers([1.0, 4.0], [2.0], cooling=0.5)
    system = on_a_belt(law, layers, 1.0, 900.0, 50.0, 0.3)
    whole, first = (st.simulate(system, time, sample_rate=1000.0) for time in (0.4, 0.15))
    rest = st.simulate(system, 0.25, sample_rate=1000.0, start=first)
    for name in ("temperature", "heat", "stored_heat", "tangential_force"):
        np.testing.assert_array_equal(rest[name], whole[name][150:])


def test_runs_side_by_side_are_those_alone():
    systems = []
    for seed in range(10):
        random = np.random.default_rng(40 + seed)
        law = st.FrictionOverTemperature([20.0, 60.0], [st.Stribeck(0.5, 0.3, 0.1), st.Stribeck(0.3, 0.1, 0.1)])
        layers = st.HeatedLayers([random.uniform(1.0, 3.0), 5.0], [random.uniform(0.5, 5.0)], share=0.9)
        systems.append(on_a_belt(law, layers, 1.0, random.uniform(500.0, 2000.0), 50.0, 0.2))
    many = st.simulate_many(systems, 0.3, sample_rate=1000.0, step=1e-4)
    for system, found in zip(systems, many, strict=True):
        alone = st.simulate(system, 0.3, sample_rate=1000.0, step=1e-4)
        for name in ("temperature", "tangential_force", "stored_heat"):
            np.testing.assert_allclose(found[name], alone[name], rtol=1e-9, atol=1e-9)


def test_contacts_have_their_own_temperatures():
    """Two feet of a rigid body, of which one is heated, beside each alone; the other has no temperature."""
    feet = st.RigidBody(2.0, inertia=np.eye(3), points={"a": (0.1, 0.0, 0.0), "b": (-0.1, 0.0, 0.0)})
    track, law = (
        st.RigidTrack(velocity=1.0),
        st.FrictionOverTemperature([20.0, 60.0], [st.Coulomb(0.5), st.Coulomb(0.1)]),
    )
    layers = st.HeatedLayers(0.4)
    normal = {"normal": (0.0, 1.0, 0.0)}
    contacts = [
        st.PointContact(feet.at("a"), track, friction=law, heating=layers, stiffness=1e6, **normal),
        st.PointContact(feet.at("b"), track, friction=st.Coulomb(0.3), stiffness=1e6, **normal),
    ]
    held = [st.Spring(feet.at(name), stiffness=1e5, direction=way) for name in ("a", "b") for way in ("x", "z")]
    system = st.System(contacts, [st.Force(feet.at(name), y=-50.0) for name in ("a", "b")], held)
    run = st.simulate(system, 0.2, sample_rate=1000.0)
    warm, cold = run["temperature"].values.T
    assert np.isnan(cold).all()
    assert warm[-1] > 25.0
    forces = run["tangential_force"].isel(tangent=0)
    sizes = np.hypot(*run["tangential_force"].values.transpose(2, 0, 1)) / run["normal_force"].values
    late = slice(100, None)
    np.testing.assert_allclose(sizes[late, 0], np.interp(warm[late], [20.0, 60.0], [0.5, 0.1]), atol=2e-3)
    np.testing.assert_allclose(sizes[late, 1], 0.3, atol=1e-9)
    assert float(forces.max()) < 0.0


def test_linear_theory_takes_friction_at_the_temperature_of_the_start():
    law = st.FrictionOverTemperature([20.0, 100.0], [st.Stribeck(0.5, 0.3, 0.2), st.Stribeck(0.3, 0.2, 0.2)])
    layers = st.HeatedLayers(5.0, initial=60.0)
    warm = on_a_belt(law, layers, 1.0, 900.0, 50.0, 0.2)
    plain = on_a_belt(law.at(60.0), None, 1.0, 900.0, 50.0, 0.2)
    middle = on_a_belt(st.Stribeck(0.4, 0.25, 0.2), None, 1.0, 900.0, 50.0, 0.2)
    found = [st.sliding_stability(one) for one in (warm, plain, middle)]
    np.testing.assert_allclose(found[0]["growth_rate"], found[1]["growth_rate"], rtol=1e-12)
    np.testing.assert_allclose(found[0]["growth_rate"], found[2]["growth_rate"], rtol=1e-9)
    assert float(found[0]["growth_rate"].max()) > 0.0


def test_a_note_names_the_temperature_beyond_those_of_the_law():
    law = st.FrictionOverTemperature([20.0, 30.0], [st.Coulomb(0.5), st.Coulomb(0.4)])
    run = st.simulate(on_a_belt(law, st.HeatedLayers(0.1), 1.0, 900.0, 50.0, 0.5), 0.3, sample_rate=1000.0)
    assert "its friction was measured from 20 to 30 degC and is taken as that at 30 degC beyond" in run.attrs["notes"]
    within = st.simulate(on_a_belt(law, st.HeatedLayers(1e6), 1.0, 900.0, 50.0, 0.5), 0.3, sample_rate=1000.0)
    assert "degC" not in within.attrs["notes"]


def test_a_face_shares_its_layers_by_the_areas_of_its_points():
    """Without a rest of heat: the whole face has the capacity that it was given."""
    layers = st.HeatedLayers([30.0, 50.0], [4.0], cooling=2.0)
    parts = [layers.of_part(share) for share in (0.2, 0.3, 0.5)]
    np.testing.assert_allclose(np.sum([one.capacity for one in parts], axis=0), layers.capacity)
    assert sum(one.cooling for one in parts) == pytest.approx(2.0)
    for one in parts:
        np.testing.assert_allclose(one.rates[0], layers.rates[0])
        np.testing.assert_allclose(one.rates[1], layers.rates[1])


def test_a_face_warms_where_it_rubs():
    """A block pressed aside on a belt: each point by its own force, in a map; the face, in all, by the whole loss."""
    material = st.Material(young=1e9, density=2000.0, poisson=0.3)
    pad = st.SolidBody.block(
        (0.06, 0.02, 0.03), (3, 1, 2), material, cutoff=1e4, damping=0.2, contact_faces=["bottom"], name="pad"
    )
    held = [st.Spring(pad.at((0.0, 0.01, side)), stiffness=1e6, direction=way) for side in (0.0, 0.03) for way in "xz"]
    law = st.FrictionOverTemperature([20.0, 120.0], [st.Coulomb(0.5), st.Coulomb(0.3)])
    layers = st.HeatedLayers(0.05, share=0.8)
    face = st.SurfaceContact(
        pad, "bottom", st.RigidTrack(velocity=2.0), friction=law, stiffness=2e11, heating=layers, name="lining"
    )
    system = st.System([face], [st.Force(pad.at("top"), y=-500.0), st.InitialEquilibrium()], held)
    run = st.simulate(system, 5e-3, surface_rate=1000.0)
    points = st.simulate(system, 5e-3, surface_rate="all")
    temperature, pressed = points["temperature"].values, points["normal_force"].values
    expected = np.interp(temperature, [20.0, 120.0], [0.5, 0.3]) * pressed
    pulled = np.linalg.norm(points["tangential_force"].values, axis=-1)
    np.testing.assert_allclose(pulled[5:], expected[5:], rtol=2e-3)
    assert np.ptp(temperature[-1]) > 1.0
    shares = face.areas / face.areas.sum()
    stored = 0.05 * (shares * (temperature[-1] - 20.0)).sum()
    assert float(run["heat"][-1]) == pytest.approx(0.8 * float(run["friction_loss"][-1]), rel=1e-9)
    assert stored == pytest.approx(float(run["heat"][-1]), rel=1e-9)
    np.testing.assert_allclose(run["temperature"][-1], temperature[-1].mean(), rtol=1e-9)
    np.testing.assert_allclose(
        run["map_temperature"][-1], temperature[-len(temperature) // 5 :].mean(axis=0), rtol=1e-3
    )
    again = st.load_scenario(points).simulate()
    np.testing.assert_array_equal(again["temperature"], points["temperature"])


def test_a_played_contact_stays_warm_when_its_friction_changes():
    """With other friction, with other bodies, and cold again under other layers."""
    law = st.FrictionOverTemperature([20.0, 60.0], [st.Coulomb(0.5), st.Coulomb(0.3)])
    given = 1.0, 900.0, 50.0, 0.5
    system = on_a_belt(law, st.HeatedLayers(0.05), *given)
    for other, is_warm in (
        (on_a_belt(law, st.HeatedLayers(0.1), *given), True),
        (on_a_belt(law, st.HeatedLayers([0.2, 0.2], 1.0), *given), False),
    ):
        live = LiveMarch(system, (), sample_rate=1000.0)
        warm = float(live.advance(200)[0].contact["temperature"][-1])
        assert warm > 30.0
        assert live.change(other, ())
        after = float(live.advance(1)[0].contact["temperature"][-1])
        assert (abs(after - warm) < 2.0) == is_warm
        assert is_warm or after < 25.0


def test_cycles_refuse_temperatures():
    system = on_a_belt(st.Coulomb(0.4), st.HeatedLayers(0.5), 1.0, 900.0, 50.0, 0.2)
    with pytest.raises(ValueError, match="contacts without heating"):
        st.limit_cycle(system, start=st.simulate(system, 1.0))
