"""Bodies of revolution that turn: against waves carried round, a march in the material, and linear theory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.verification.systems.discs import HERE, PLATE, STEEL, disc, ring, struck

from .checks import goes_on, same_side_by_side
from .test_equilibrium_starts import growth, starting
from .test_space import SCHEMES, reference

SLIDING = 2


def rubbed(turning: float, friction=0.3, mass: float = 0.2, stiffness: float = 1e6, held: str = "xy", **words):
    """A mass on springs, pressed onto the face of a turning disc."""
    plate = disc(turning, **words)
    pad = st.RigidBody(mass, points={"tip": (0.0, 0.0, 0.0)}, name="pad")
    law = friction if isinstance(friction, st.contact.FrictionLaw) else st.Coulomb(friction)
    contact = st.PointContact(pad.at("tip"), plate.at(HERE), friction=law, normal=(0.0, 0.0, 1.0))
    springs = [st.Spring(pad.at("tip"), direction=way, stiffness=stiffness) for way in held]
    return st.System(contact, [st.Force(pad.at("tip"), z=-50.0)], springs)


# Waves.


def test_waves_of_a_ring_lag_as_bryan_found():
    """Coriolis forces let the waves of an inextensible ring turn by (n² - 1) / (n² + 1) of its own turn (1890)."""
    turning = ring(10.0).modes().turning
    for order, drag in zip(turning.order[1:], turning.drag[1:], strict=True):
        # The hoop is not thin against waves of high order.
        assert drag / order == pytest.approx((order**2 - 1.0) / (order**2 + 1.0), rel=1e-4 * order)
    # Rigid translation does not turn at all.
    assert turning.order[0] == 1.0
    assert abs(turning.drag[0]) < 1e-9


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_struck_disc_is_heard_beating_where_it_was_struck(scheme):
    """Each pair rings at its frequency, its waves carried round: in a fixed frame at f ± drag W / 2 pi."""
    turning, step = 100.0, 1e-6
    system, plate = struck(turning)
    probes = [
        st.Displacement(plate.at(HERE), "z"),
        st.Velocity(plate.at(HERE), "z"),
        st.Acceleration(plate.at(HERE), "z"),
    ]
    run = st.simulate(system, 0.05, scheme=scheme, step=step, sample_rate=5e4, probes=probes)
    time, row, modes = run.time.values, plate.trace(HERE)[2], plate.modes()
    drag = np.zeros(modes.count)
    for pair, by in zip(modes.turning.pairs, modes.turning.drag, strict=True):
        drag[list(pair)] = by * turning
    # The response to the blow is the sum of those to its force at every time.
    known = np.zeros((3, time.size))
    width, points = 4e-4, (np.arange(400) + 0.5) / 400 * 4e-4
    weights = (1.0 - np.abs(points / (width / 2) - 1.0)) * width / points.size
    for w, shape, by in zip(modes.angular_frequency, row, drag, strict=True):
        for sign in (1.0, -1.0):
            seen = w + sign * by
            wave = np.exp(1j * seen * (time[:, None] - points)) @ weights * shape**2 / (2.0 * w)
            known += [wave.imag, (1j * seen * wave).imag, (-(seen**2) * wave).imag]
    after = time > 1e-3
    seen = [run.displacement.values.ravel(), run.velocity.values.ravel(), run.acceleration.values.ravel()]
    for found, expected in zip(seen, known, strict=True):
        assert np.abs(found - expected)[after].max() < 0.02 * np.abs(expected[after]).max()
    # Turning matters: a disc at rest sounds different.
    still, _ = struck(0.0)
    rest = st.simulate(still, 0.05, scheme=scheme, step=step, sample_rate=5e4, probes=probes_of(still))
    assert np.abs(rest.displacement.values.ravel() - known[0])[after].max() > 0.5 * np.abs(known[0]).max()


def probes_of(system: st.System) -> list:
    return [st.Displacement(system.track.at(HERE), "z")]


def deflection(plate: st.AxisymmetricBody, load: float, turning: float) -> float:
    """Deflection under a standing load, mode by mode; damping turns with the material."""
    modes, row = plate.modes(), plate.trace(HERE)[2]
    matrix = np.diag(modes.angular_frequency**2)
    for (k, j), drag in zip(disc(1.0).modes().turning.pairs, disc(1.0).modes().turning.drag, strict=True):
        by = drag * turning
        matrix[[k, j], [k, j]] -= by**2
        matrix[k, j], matrix[j, k] = modes.damping_rate[k] * by, -modes.damping_rate[k] * by
    return float(row @ np.linalg.solve(matrix, load * row))


@pytest.mark.parametrize("turning", [20.0, 900.0])
def test_a_standing_load_sees_waves_that_stand(turning):
    system = rubbed(turning, friction=0.0, damping=0.002)
    theory = st.sliding_stability(system)
    assert theory.track_displacement.values.ravel()[-1] == pytest.approx(
        deflection(system.track, -50.0, turning), rel=1e-10
    )


def test_a_wave_stands_still_where_the_disc_turns_at_its_speed():
    """At W = w_n / n only damping resists a standing load, which otherwise bends the disc without limit."""
    modes = disc(1.0).modes()
    k = modes.turning.order.index(3.0)
    critical = modes.angular_frequency[modes.turning.pairs[k][0]] / modes.turning.drag[k]
    heights = [
        abs(st.sliding_stability(rubbed(share * critical, friction=0.0)).track_displacement.values.ravel()[-1])
        for share in (0.0, 0.99, 0.9999, 0.999999)
    ]
    assert heights[1] > 2.0 * heights[0]
    np.testing.assert_allclose(heights[3] / heights[2], 100.0, rtol=0.02)


# A march in the material.


class InTheMaterial:
    """A rider on a disc that turns, in coordinates of the material: its waves are oscillators, the contact's rows turn.

    Explicit, a mass on springs along x and y; the contact's forces by brute force.
    """

    def __init__(self, system: st.System, turning: float, friction: float, step: float) -> None:
        plate, self.step, self.friction, self.turning = system.track, step, friction, turning
        modes, self.rows = plate.modes(), plate.trace(HERE)
        self.stiffness = modes.angular_frequency**2
        self.damping = modes.damping_rate
        self.pairs = np.array(modes.turning.pairs)
        self.drag, self.order = np.array(modes.turning.drag), np.array(modes.turning.order)
        self.speed = plate.at(HERE).turning_velocity
        self.q = self.before = np.zeros(modes.count)
        self.pad = self.pad_before = np.zeros(3)
        self.springs, self.mass, self.load = np.array([1e6, 1e6, 0.0]), 0.2, np.array([0.0, 0.0, -50.0])
        self.frame = system.contact.frame
        self.slips = [-step * self.frame[1:] @ self.speed] * 2

    def turned(self, numbers: np.ndarray, by: np.ndarray) -> np.ndarray:
        out = numbers.copy()
        first, second = self.pairs.T
        out[..., first] = np.cos(by) * numbers[..., first] - np.sin(by) * numbers[..., second]
        out[..., second] = np.sin(by) * numbers[..., first] + np.cos(by) * numbers[..., second]
        return out

    def advance(self, n: int) -> np.ndarray:
        h, frame = self.step, self.frame
        angle = self.turning * (n + 1) * h
        # Rows at the next time, on waves that lag behind the material.
        rows = frame @ self.turned(self.rows, -self.drag * angle)
        share = 1.0 / (1.0 + 0.5 * h * self.damping)
        free = share * (2.0 * self.q - (1.0 - 0.5 * h * self.damping) * self.before - h**2 * self.stiffness * self.q)
        pad = 2.0 * self.pad - self.pad_before + h**2 / self.mass * (self.load - self.springs * self.pad)
        # The material under the tip was elsewhere one step ago.
        passed = self.turned(self.turned(self.q, self.drag * self.turning * n * h), self.order * self.turning * h)
        was = frame[1:] @ (self.rows @ passed)
        gap = frame[0] @ pad - rows[0] @ free
        slip = frame[1:] @ (pad - self.pad) - (rows[1:] @ free - was) - h * frame[1:] @ self.speed
        compliance = rows @ (h**2 * share * rows).T + h**2 / self.mass * np.eye(3)
        forces = np.zeros(3)
        if gap < 0.0:
            carried = (6.0 * self.slips[0] + self.slips[1]) / 9.0
            forces[0], forces[1:] = reference(gap, slip, compliance, self.friction, carried)
        push = forces * [1.0, -1.0, -1.0]
        self.slips = [slip + (compliance[1:] @ push), *self.slips[:1]]
        self.q, self.before = free - h**2 * share * (push @ rows), self.q
        self.pad, self.pad_before = pad + h**2 / self.mass * (push @ frame), self.pad
        return forces


def test_the_march_is_that_in_the_material():
    turning, friction, step, count = 300.0, 0.3, 4e-6, 250
    system = rubbed(turning, friction=friction, damping=0.01)
    # Apart at first: then the motion before the start is known in both.
    apart = replace(system.contact, gap=1e-9)
    system = replace(system, contact=apart)
    words = {"step": step, "sample_rate": 1.0 / step, "scheme": st.CentralDifference(), "probes": []}
    run = st.simulate(system, count * step, **words)
    twin = InTheMaterial(system, turning, friction, step)
    twin.pad = np.array([0.0, 0.0, 1e-9])
    twin.pad_before = twin.pad + 0.5 * step**2 / 0.2 * twin.load
    forces = np.array([twin.advance(n) for n in range(count)])
    assert (forces[:, 0] > 0.0).sum() > 100
    scale = forces[:, 0].max()
    np.testing.assert_allclose(run.normal_force.values.ravel()[:count], forces[:, 0], atol=1e-7 * scale)
    np.testing.assert_allclose(run.tangential_force.values.reshape(-1, 2)[:count], forces[:, 1:], atol=1e-7 * scale)


# Energy, restart, side by side.


@pytest.mark.parametrize("scheme", SCHEMES)
def test_energy_is_conserved_and_the_drive_supplies_the_losses(scheme):
    system = rubbed(200.0, friction=st.Stribeck(0.4, 0.3, 0.5), damping=0.002, residual_at=[(0.14, 0.01)])
    ring_force = st.Force(system.track.at((0.1, 1.0, 0.01)), z=3.0, history=st.Harmonic(700.0))
    system = replace(system, drives=[*system.drives, ring_force])
    run = st.simulate(system, 0.02, scheme=scheme, probes=[])
    terms = ["kinetic_and_elastic", "damping_loss", "drive_work", "contact_work"]
    largest = max(float(np.abs(run[term]).max()) for term in terms)
    assert float(np.abs(run.ledger_residual).max()) < 1e-11 * largest
    # The drive supplies the loss of friction: force times the travel of the disc.
    assert float(run.friction_loss[-1]) == pytest.approx(float(run.drive_work[-1]), rel=0.05)


def test_a_run_continues_to_the_last_bit_and_runs_again(tmp_path):
    system = rubbed(300.0, friction=0.4, damping=0.002)
    probes = [st.Velocity(system.track.at(HERE), "z"), st.Acceleration(system.track.at(HERE), "x")]
    words = {"step": 4e-6, "sample_rate": 5e4, "probes": probes}
    names = ("normal_force", "tangential_force", "drive_work", "slip_velocity")
    whole, half, rest, scenario = goes_on(system, 2e-3, names, tmp_path, **words)
    np.testing.assert_array_equal(whole.velocity[half.time.size + 1 :], rest.velocity[1:])
    again = scenario.simulate()
    for name in ("normal_force", "tangential_force", "velocity", "acceleration"):
        np.testing.assert_array_equal(again[name], whole[name])
    # A body given by its modes is written as it was read.
    assert again.attrs["scenario"] == whole.attrs["scenario"]


def test_runs_side_by_side_are_those_alone():
    history = st.Ramp(1e-3)
    systems = [rubbed(40.0 * k, friction=0.3, damping=0.002, turning_history=history) for k in range(1, 10)]
    same_side_by_side(systems, 2e-3, step=4e-6, sample_rate=5e4, probes=[])


def test_discs_at_rest_march_beside_those_that_turn():
    systems = [rubbed(speed, friction=0.3, damping=0.002) for speed in (0.0, 40.0) for _ in range(8)]
    words = {"step": 4e-6, "sample_rate": 5e4, "probes": []}
    together = st.simulate_many(systems, 1e-3, workers=1, **words)
    for k in (0, 8):
        alone = st.simulate(systems[k], 1e-3, **words)
        np.testing.assert_allclose(together[k].normal_force, alone.normal_force, rtol=1e-9)


def test_an_accelerated_disc_ends_like_one_at_constant_speed():
    """After the transient of the acceleration has decayed."""
    words = {"step": 4e-6, "sample_rate": 1e4, "probes": []}
    rising = rubbed(30.0, friction=0.0, damping=0.05, turning_history=st.Ramp(0.02))
    steady = rubbed(30.0, friction=0.0, damping=0.05)
    runs = [st.simulate(one, 0.1, **words) for one in (rising, steady)]
    heights = [float(run.contact_height[-20:].mean()) for run in runs]
    assert heights[0] == pytest.approx(heights[1], rel=1e-6)
    slips = [run.slip_velocity.values.reshape(-1, 2)[-1] for run in runs]
    np.testing.assert_allclose(slips[0], slips[1], rtol=1e-6)
    assert np.hypot(*slips[1]) == pytest.approx(30.0 * 0.14, rel=1e-4)


# Linear theory.


def squealing(law) -> st.System:
    return rubbed(30.0, friction=law, stiffness=2e6, mass=0.3)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    "law", [st.Coulomb(0.5), st.Stribeck(0.5, 0.3, 5.0), st.RateAndState(0.4, 0.01, 0.03, 1e-3, 1e-3)], ids=str
)
def test_growth_in_time_is_that_of_linear_theory(law, scheme):
    """Waves carried round under a pad: faster than at rest where the disc turns against its lag."""
    system = squealing(law)
    probe = st.Displacement(system.track.at(HERE), "z")
    known, seen, _ = growth(system, probe, 2e-6, 6e-3, 20, scheme, amplitude=1e-10)
    assert known.real > 1.0
    assert seen == pytest.approx(known, rel=2e-3)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_start_in_equilibrium_stays_there(scheme):
    system = rubbed(150.0, friction=0.2, damping=0.01)
    theory = st.sliding_stability(system)
    swings = []
    for step in (2e-6, 1e-6):
        run = st.simulate(starting(system), 0.02, scheme=scheme, step=step, probes=[])
        assert (run.status == SLIDING).all()
        swings.append(float(np.abs(run.normal_force / theory.normal_force - 1.0).max()))
    # A step has the contact where the material is at its end: W h further round.
    assert swings[0] < 150.0 * 2e-6
    assert swings[0] == pytest.approx(2.0 * swings[1], rel=0.02)


# Errors.


BAD = {
    "tilts": (lambda: st.AxisymmetricBody(PLATE, STEEL, 4000.0, turning=1.0).modes(), "free to tilt"),
    "normal": (
        lambda: st.PointContact(st.RigidBody(1.0).centre, disc(1.0).at(HERE), normal=(0.0, 0.1, 1.0)),
        "at right angles to the velocity",
    ),
    "twice": (
        lambda: st.PointContact(
            st.RigidBody(1.0).centre, disc(1.0).at(HERE), normal=(0.0, 0.0, 1.0), surface_velocity=1.0
        ),
        "surface_velocity must be 0 against a body that turns",
    ),
    "spring": (
        lambda: st.System(
            st.PointContact(st.RigidBody(1.0).centre, disc(1.0).at(HERE), normal=(0.0, 0.0, 1.0)),
            connections=[st.Spring(disc(1.0).at(HERE), stiffness=1.0)],
        ),
        "not act on a body that turns",
    ),
    "fast": (lambda: st.simulate(rubbed(4e4), 1e-3, step=4e-6), "turn by at most 0.5 rad"),
    "number": (lambda: disc(float("nan")), "turning must be"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_are_refused(name):
    make, words = BAD[name]
    with pytest.raises(ValueError, match=words):
        make()
