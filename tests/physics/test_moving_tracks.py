"""Masses on belts and on shaken ground, loads that jump: closed forms, in both schemes."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.lowering import assemble

G, MASS, STEP = 9.80665, 2.0, 1e-4
BOTH = pytest.mark.parametrize("scheme", [st.ExactModal(), st.CentralDifference()], ids=lambda scheme: scheme.name)


def on_a_track(track, *drives, friction=0.3, **words):
    block = st.PointMass(MASS)
    contact = st.PointContact(block.centre, track, friction=st.Coulomb(friction))
    system = st.System(contact, [st.Gravity(G), *(drive(block) for drive in drives)])
    probes = [st.Displacement(block.centre, axis) for axis in "xy"]
    words = {"step": STEP, "sample_rate": 1.0 / STEP, "probes": probes, **words}
    return st.simulate(system, words.pop("duration", 0.3), **words)


# Ground given by its acceleration.


@BOTH
def test_ground_that_rises_with_constant_acceleration_presses_harder(scheme):
    run = on_a_track(st.RigidTrack(normal_velocity=0.5, normal_acceleration=3.0), scheme=scheme)
    time = run.time.values
    # Places are rounded, and the force is in their second differences.
    rounding = MASS * 4.0 * np.finfo(float).eps * (0.5 * 0.3 + 1.5 * 0.3**2) / STEP**2
    np.testing.assert_allclose(run.normal_force.values[1:], MASS * (G + 3.0), rtol=1e-12, atol=rounding)
    np.testing.assert_allclose(run.displacement.values[:, 1], 0.5 * time + 1.5 * time**2, rtol=1e-12)


@BOTH
def test_ground_of_an_accelerogram_is_exact_between_its_samples(scheme):
    """Piecewise linear acceleration: the force is that at the centre of each step, its second difference."""
    shaken = st.Sampled((0.0, 0.1, 0.2, 0.25), (0.0, 5.0, -4.0, 0.0))
    run = on_a_track(st.RigidTrack(normal_acceleration=1.0, normal_history=shaken), scheme=scheme)
    time = run.time.values
    # The force of a step holds it at the end: it is that of the step's start.
    felt = shaken.factor(time - STEP)
    kinks = np.any(np.abs((time - STEP)[:, None] - np.array(shaken.time)) < 1.5 * STEP, axis=1)
    np.testing.assert_allclose(run.normal_force.values[~kinks], MASS * (G + felt[~kinks]), rtol=1e-8)
    late = time > 0.25
    # By hand: areas of the triangles, and their first moments about the end.
    velocity = 0.1 * 5.0 / 2.0 + 0.1 * (5.0 - 4.0) / 2.0 - 0.05 * 4.0 / 2.0
    np.testing.assert_allclose(np.diff(run.displacement.values[late, 1]) / STEP, velocity, rtol=1e-8)


@BOTH
def test_a_mass_lifts_off_where_the_ground_falls_faster_than_it_can(scheme):
    """Downward acceleration that grows linearly to 3 g in 0.3 s exceeds g from 0.1 s on."""
    history = st.Sampled((0.0, 0.3), (0.0, 1.0))
    run = on_a_track(st.RigidTrack(normal_acceleration=-3.0 * G, normal_history=history), scheme=scheme, duration=0.25)
    time, lost = run.time.values, run.status.values == 0
    first = time[np.flatnonzero(lost)[0]]
    assert first == pytest.approx(0.1, abs=2.0 * STEP * (1.0 + 1e-9))
    assert lost[time > first].all()
    since = time[lost] - 0.1
    # Ground at 0.1 s: x'' = -10 G t, x' = -5 G t², x = -5 G t³ / 3; then the mass falls freely from there.
    height = -5.0 / 3.0 * G * 0.1**3 - 5.0 * G * 0.1**2 * since - 0.5 * G * since**2
    ground = -5.0 / 3.0 * G * time[lost] ** 3
    # A step's share of the acceleration that is missing at lift-off, 10 G h, over a step, then for as long as it flies.
    allowed = 10.0 * G * STEP * STEP * (since + STEP)
    assert np.all(np.abs(run.displacement.values[lost, 1] - height) <= allowed + 1e-15)
    assert np.all(np.abs(run.gap.values[lost] - (height - ground)) <= allowed + 1e-15)


@BOTH
@pytest.mark.parametrize(("acceleration", "slides"), [(2.0, False), (5.0, True)])
def test_a_belt_that_gathers_speed_drags_up_to_the_limit_of_friction(scheme, acceleration, slides):
    """It holds below mu g = 2.94 m/s²."""
    run = on_a_track(st.RigidTrack(acceleration=acceleration), scheme=scheme)
    dragged = min(acceleration, 0.3 * G)
    time, place = run.time.values, run.displacement.values[:, 0]
    np.testing.assert_allclose(run.tangential_force.values[1:], -MASS * dragged, rtol=1e-8)
    np.testing.assert_allclose(place, 0.5 * dragged * time**2, rtol=1e-9, atol=dragged * STEP**2)
    np.testing.assert_allclose(
        run.slip_velocity.values[1:], ((dragged - acceleration) * (time - STEP / 2))[1:], atol=1e-9
    )
    assert run.status.values[-1] == (2 if slides else 1)


@BOTH
def test_a_belt_at_a_speed_is_shaken_along_itself(scheme):
    """The velocity is that at the start: a cosine of acceleration shakes about it, without a drift."""
    history = st.Harmonic(10.0, phase=np.pi / 2.0)
    track = st.RigidTrack(velocity=0.4, acceleration=1.0, history=history)
    run = on_a_track(track, lambda block: st.InitialVelocity(block, x=0.4), scheme=scheme)
    angular, time = 20.0 * np.pi, run.time.values
    swing = 0.4 * time + (1.0 - np.cos(angular * time)) / angular**2
    assert (run.status.values == 1).all()
    np.testing.assert_allclose(run.displacement.values[:, 0], swing, atol=2.0 * STEP**2)
    np.testing.assert_allclose(track.speed(time), 0.4 + np.sin(angular * time) / angular, rtol=1e-12)


# Jumps.


@BOTH
@pytest.mark.parametrize("steps", [1, 7])
def test_a_force_that_is_switched_off_gives_its_impulse(scheme, steps):
    """Switched off at a step it gives F t to round-off; between two steps a whole step counts or not."""
    step = 0.2 / 1000 if steps == 1 else 0.2 / 1000.37
    history = st.Sampled((0.0, 0.2, 0.2), (1.0, 1.0, 0.0))
    run = on_a_track(
        st.RigidTrack(),
        lambda block: st.Force(block.centre, x=4.0, history=history),
        friction=0.0,
        scheme=scheme,
        step=step,
        sample_rate=1.0 / step,
        duration=0.4,
    )
    velocity = np.diff(run.displacement.values[:, 0]) / step
    after = run.time.values[1:] > 0.2 + 2.0 * step
    missing = 1e-9 if steps == 1 else 0.5 * step * 4.0 / MASS + 1e-9
    assert np.abs(velocity[after] - 4.0 * 0.2 / MASS).max() <= missing


@BOTH
@pytest.mark.parametrize("late", [0.0, 0.5, 0.3])
def test_a_jump_of_the_root_velocity_acts_fully_on_its_body(scheme, late):
    """A free beam dragged without contact: the imposed impulses add up to the change of velocity."""
    step = 1e-5
    jump = (100 + late) * step
    system = st.load_scenario("weak-pressure").system
    history = st.Sampled((0.0, jump, jump), (1.0, 1.0, 3.0))
    drive = st.ImposedVelocity(system.slider.root, 0.2, 2.0, history)
    arrays = assemble(st.System(system.contacts[0], [drive]))
    time = np.arange(200) * step
    assert arrays.signals.acceleration(time, step).sum() * step == pytest.approx(0.4, rel=1e-12)
    np.testing.assert_allclose(
        arrays.signals.displacement(time, step)[-1], 0.2 * (3.0 * time[-1] - 2.0 * jump), rtol=1e-12
    )


@BOTH
def test_a_belt_that_jumps_to_another_speed_continues_in_place(scheme):
    """It slides throughout, so friction does not change at the jump; its slip changes at once."""
    history = st.Sampled((0.0, 0.1, 0.1), (1.0, 1.0, -2.0))
    run = on_a_track(st.RigidTrack(velocity=5.0, history=history), scheme=scheme, duration=0.2)
    time, slip = run.time.values, run.slip_velocity.values
    dragged = 0.3 * G * np.where(time < 0.1 + STEP / 2, time, 0.2 - time)
    belt = np.where(time < 0.1 + STEP / 2, 5.0, -10.0)
    np.testing.assert_allclose(slip, dragged - belt, atol=2.0 * 0.3 * G * STEP)


# Belts that change from one run to the next.

LAWS = {
    "coulomb": st.Coulomb(0.3),
    "static-kinetic": st.StaticKinetic(0.4, 0.25),
    "stribeck": st.Stribeck(0.4, 0.25, 0.05),
    "lugre": st.LuGre(0.4, 0.25, 0.05, stiffness=1e4, damping=10.0),
    "rate and state": st.RateAndState(0.3, a=0.01, b=0.02, slip_distance=1e-4, velocity=0.01),
}


def held_by_a_spring(track, law, other=False):
    """A mass on a belt, on a spring; with another contact beside it, of another body, where asked for."""
    block, beside = st.PointMass(MASS), st.PointMass(1.0)
    contacts = [st.PointContact(block.centre, track, friction=law)]
    connections = [st.Spring(block.centre, stiffness=400.0), st.Dashpot(block.centre, coefficient=2.0)]
    if other:
        floor = st.RigidTrack(velocity=-0.02, name="floor")
        contacts.append(st.PointContact(beside.centre, floor, friction=st.Coulomb(0.1), name="beside"))
        connections.append(st.Spring(beside.centre, block.centre, stiffness=300.0))
    return st.System(contacts, [st.Gravity(G)], connections)


@BOTH
@pytest.mark.parametrize("other", [False, True], ids=["one contact", "two"])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("before", "after"), [(0.1, -0.3), (0.1, 0.0), (0.0, 0.1), (0.1, 0.13)])
def test_two_runs_equal_one_whose_belt_jumps(scheme, other, law, before, after):
    """It sticks to the belt, or slides on it, at the change: the anchor and the bristles move with the belt."""
    words = {"scheme": scheme, "step": STEP, "sample_rate": 1.0 / STEP, "probes": []}
    half = 0.0973
    history = st.Sampled((0.0, half, half), (before, before, after))

    def on_a_belt(track):
        return held_by_a_spring(track, LAWS[law], other)

    whole = st.simulate(on_a_belt(st.RigidTrack(velocity=1.0, history=history)), 0.3, **words)
    first = st.simulate(on_a_belt(st.RigidTrack(velocity=before)), half, **words)
    second = st.simulate(on_a_belt(st.RigidTrack(velocity=after)), 0.3 - half, start=first, **words)
    assert_joined(first, second, whole)


def assert_joined(first, second, whole):
    """Places are rounded and forces are in their second differences: by some m eps x / h², 1e-9 of the forces here."""
    names = [name for name in whole.data_vars if "time" in whole[name].dims and name != "ledger_residual"]
    for name in names:
        parts = np.concatenate([first[name].values, second[name].values])
        # A contact without a state of its law has none.
        values, expected = np.nan_to_num(parts), np.nan_to_num(whole[name].values)
        # A share of a step is a ratio of the distances of forces from the cone, down to a thousandth of them, and so is
        # the time of a break, after which the force falls.
        share = {"status_share": 1e-5, "tangential_force": 2e-7}.get(name, 1e-8)
        # Sweeps end at a tolerance, which rounding may just miss.
        least = 1.0 if name == "contact_sweeps" else 1e-16
        assert np.abs(values - expected).max() <= share * np.abs(expected).max() + least, name
    assert np.abs(second.ledger_residual.values).max() < 1e-10 * np.abs(second.drive_work.values).max()


@BOTH
def test_ground_and_belt_continue_under_other_histories_and_accelerations(scheme):
    """From a sine of both to an acceleration of both from the velocities that they have."""
    words = {"scheme": scheme, "step": STEP, "sample_rate": 1.0 / STEP, "probes": []}
    half, sine = 0.1, st.Harmonic(3.0, phase=0.4)
    now, angular = np.array([half]), 6.0 * np.pi
    before = st.RigidTrack(0.2, 0.1, sine, sine)
    # In the time of the run, whose start is also that of the second history.
    turned = st.Sampled((0.0, half, half, 0.2), (0.0, 0.0, 1.0, -1.0))
    speed, lift = (float(found(now)[0]) for found in (before.speed, before.normal_speed))
    after = st.RigidTrack(speed, lift, turned, turned, acceleration=-3.0, normal_acceleration=2.0)

    class Both(st.RigidTrack):
        """One history, then the other."""

        def travel(self, time):
            later = before.travel(now) + after.travel(time) - after.travel(now)
            return np.where(time < half, before.travel(time), later)

        def normal_travel(self, time):
            later = before.normal_travel(now) + after.normal_travel(time) - after.normal_travel(now)
            return np.where(time < half, before.normal_travel(time), later)

    assert speed == pytest.approx(0.2 * np.sin(angular * half + 0.4))
    first, whole = (
        st.simulate(held_by_a_spring(track, st.Coulomb(0.3)), duration, **words)
        for track, duration in ((before, half), (Both(velocity=1.0), 0.3))
    )
    second = st.simulate(held_by_a_spring(after, st.Coulomb(0.3)), 0.2, start=first, **words)
    assert_joined(first, second, whole)


@pytest.mark.parametrize("velocities", [(0.1, 0.2, 0.2), (0.1, 0.0, 0.0), (0.1, 0.1, 0.1)])
def test_a_run_continues_to_the_last_bit_after_a_change(velocities, tmp_path):
    """In two parts, one of them from a file, or in one."""
    first, second, third = velocities
    words = {"step": STEP, "sample_rate": 1.0 / STEP, "probes": []}
    runs = [st.simulate(held_by_a_spring(st.RigidTrack(velocity=first), st.Coulomb(0.3)), 0.05, **words)]
    for number, velocity in enumerate((second, third)):
        path = tmp_path / f"{number}.nc"
        st.save(runs[-1], path)
        system = held_by_a_spring(st.RigidTrack(velocity=velocity), st.Coulomb(0.3))
        runs.append(st.simulate(system, 0.05, start=st.load(path), **words))
    both = st.simulate(system, 0.1, start=runs[0], **words)
    for name in ("normal_force", "tangential_force", "slip_velocity", "contact_position", "drive_work"):
        parts = np.concatenate([run[name].values for run in runs[1:]])
        np.testing.assert_array_equal(parts, both[name].values)


def test_a_record_without_belt_positions_continues_only_with_the_same_belt():
    words = {"step": STEP, "sample_rate": 1.0 / STEP, "probes": []}
    systems = [held_by_a_spring(st.RigidTrack(velocity=velocity), st.Coulomb(0.3)) for velocity in (0.1, 0.2)]
    old = st.simulate(systems[0], 0.01, **words).drop_vars("state_motion")
    assert st.simulate(systems[0], 0.01, start=old, **words).attrs["ended"] == "finished"
    message = r"^start must have the same contacts\.0\.track\.velocity as this run, 0\.2, got 0\.1$"
    with pytest.raises(ValueError, match=message):
        st.simulate(systems[1], 0.01, start=old, **words)
    renamed = held_by_a_spring(st.RigidTrack(velocity=0.1, name="belt"), st.Coulomb(0.3))
    with pytest.raises(ValueError, match=r"contacts\.0\.track\.name as this run, 'belt', got None"):
        st.simulate(renamed, 0.01, start=st.simulate(systems[0], 0.01, **words), **words)


@BOTH
def test_a_run_continues_after_all_energy_is_lost(scheme):
    """After shaken ground has come to rest only rounding of the energy remains, which is not a fault."""
    shaken = st.Sampled((0.0, 0.1, 0.1, 0.2, 0.2), (1.0, 1.0, -1.0, -1.0, 0.0))
    track = st.RigidTrack(normal_acceleration=5.0, normal_history=shaken)
    first = on_a_track(track, scheme=scheme, duration=0.25)
    left, met = (np.abs(first.kinetic_and_elastic.values[k]) for k in (-1, 1000))
    assert left < 1e-6 * met
    second = on_a_track(track, scheme=scheme, duration=0.25, start=first)
    assert second.attrs["ended"] == "finished"
    assert second.attrs["largest_energy"] == first.attrs["largest_energy"] >= met
