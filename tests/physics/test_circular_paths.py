"""Contacts that move round a body of revolution: against fixed ones, a plain march, the ledger and linear theory."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.acoustics.redriven import redriven
from stridula.bodies import Turning
from stridula.lowering import assemble
from stridula.verification.systems import discs
from stridula.verification.systems.discs import HERE, STEEL

from .checks import goes_on, same_side_by_side
from .test_equilibrium_starts import growth, starting
from .test_space import SCHEMES, reference

RADIUS = HERE[0]
UP = (0.0, 0.0, 1.0)
LEDGER = ["kinetic_and_elastic", "damping_loss", "drive_work", "contact_work"]
WORDS = {"step": 2e-6, "sample_rate": 1e5, "probes": []}


def disc(turning: float = 0.0, cutoff: float = 4000.0, **words) -> st.AxisymmetricBody:
    return discs.disc(turning, cutoff, **{"damping": 0.002, **words})


def ways(abscissa: float = 0.0) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Directions along the circle and across it."""
    along = disc().circle(HERE).direction(abscissa)
    return tuple(along), tuple(np.cross(along, UP))


def riders(track, friction=0.3, stiffness: float = 1e6, abscissas=(0.0,), mass: float = 0.2, **words) -> st.System:
    """Masses on springs, pressed onto a disc; `track` gives what each slides on, and words of the contact."""
    law = friction if isinstance(friction, st.contact.FrictionLaw) else st.Coulomb(friction)
    contacts, drives, springs = [], [], []
    for k, abscissa in enumerate(abscissas):
        pad = st.RigidBody(mass, points={"tip": (0.0, 0.0, 0.0)}, name=f"pad {k}")
        met, more = track(abscissa)
        contacts.append(st.PointContact(pad.at("tip"), met, friction=law, normal=UP, name=f"c{k}", **more, **words))
        if stiffness:
            springs += [st.Spring(pad.at("tip"), direction=way, stiffness=stiffness) for way in ways(abscissa)]
        drives.append(st.Force(pad.at("tip"), z=-50.0))
    return st.System(contacts, drives, springs)


def on_a_circle(turning: float = 0.0, velocity: float = 0.0, history=None, **words):
    plate = disc(turning, **words)
    return lambda abscissa: (plate.circle(HERE, velocity, history), {"at": abscissa})


def on_a_circle_at(velocity: float):
    return on_a_circle(velocity=velocity)


def fixed(turning: float = 0.0, **words):
    plate, circle = disc(turning, **words), disc().circle(HERE)
    return lambda abscissa: (
        plate.at(circle.point_at(abscissa).position),
        {"at": abscissa, "tangent": ways(abscissa)[0]},
    )


def carried_past(velocity: float):
    """The same disc under a rider at rest, its waves carried past with the material, without Coriolis forces."""
    plate = disc(1.0)
    modes, point = plate.modes(), plate.at(HERE)
    turning = Turning(-velocity / RADIUS, modes.turning.pairs, modes.turning.order, modes.turning.order)
    speed = -velocity * plate.circle(HERE).direction(0.0)
    rows = {"here": plate.trace(HERE)}
    words = {"turning": turning, "velocities": {"here": speed}, "name": "disc"}
    body = st.ModalBody(modes.angular_frequency, rows, modes.damping_rate, modes.translation, **words)
    return lambda abscissa: (
        st.BodyPoint(body, "here"),
        {"tangent": tuple(plate.circle(point.position).direction(0.0))},
    )


def forces(run) -> np.ndarray:
    """Forces of all contacts, normal and along both tangents."""
    normal = run.normal_force.values.reshape(run.time.size, -1)
    return np.concatenate([normal, run.tangential_force.values.reshape(run.time.size, -1)], axis=1)


# Against fixed contacts.


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    "tracks", [(on_a_circle, fixed, 30.0), (on_a_circle_at, carried_past, 55.0)], ids=["held", "moved"]
)
def test_without_travel_of_its_own_a_circle_is_a_fixed_point(tracks, scheme):
    """The two differ in proportion to the travel of the tip due to friction: of first order."""
    apart, travels = [], []
    circle, point, speed = tracks
    for friction in (4e-3, 2e-3, 1e-3):
        runs = [
            st.simulate(riders(track(speed), friction=friction), 4e-3, scheme=scheme, **WORDS)
            for track in (circle, point)
        ]
        apart.append(np.abs(forces(runs[0]) - forces(runs[1]))[:, 0].max())
        carried = (speed if circle is on_a_circle_at else 0.0) * runs[0].time.values
        travels.append(np.abs(runs[0].contact_position.values.reshape(-1, 2)[:, 0] - carried).max())
    assert apart[2] > 1e-7
    for k in (0, 1):
        assert travels[k] / travels[k + 1] == pytest.approx(2.0, rel=0.01)
        assert apart[k] / apart[k + 1] == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_rider_moving_round_equals_one_standing_on_a_turning_disc(scheme):
    """Three times round: nothing ends the run, and forces are those of the disc that turns the other way."""
    velocity, duration = 55.0, 0.05
    tracks = on_a_circle(velocity=velocity), carried_past(velocity)
    runs = [st.simulate(riders(one, friction=0.0), duration, scheme=scheme, **WORDS) for one in tracks]
    assert [run.attrs["ended"] for run in runs] == ["finished"] * 2
    place = runs[0].contact_position.values.reshape(-1, 2)[-1, 0]
    assert place == pytest.approx(velocity * duration)
    assert place > 3.0 * disc().circle(HERE).length
    seen, known = (forces(run)[:, 0] for run in runs)
    np.testing.assert_allclose(seen, known, atol=1e-9 * known.max())
    assert np.ptp(known) > 0.2 * known.mean()
    # The work of the slope of the waves on the arm is that of the turning disc.
    given = [float((run.drive_work + run.convection_work)[-1]) for run in runs]
    assert given[0] == pytest.approx(given[1], rel=1e-6)
    assert abs(float(runs[0].convection_work[-1])) > 0.02 * given[1]


def test_a_sticking_mass_is_carried_round_with_the_disc():
    """A free mass reaches the speed of the disc and stays at its place on it for two turns."""
    turning, friction, mass = 20.0, 1.0, 0.02
    system = riders(on_a_circle(turning), friction=friction, stiffness=0.0, mass=mass)
    run = st.simulate(system, 0.7, step=4e-6, sample_rate=1e4, probes=[])
    assert run.attrs["ended"] == "finished"
    status, place = run.status.values.ravel(), run.contact_position.values.reshape(-1, 2)
    held = int(np.flatnonzero(status != 1)[-1]) + 1
    speed = turning * RADIUS
    assert run.time.values[held] == pytest.approx(speed * mass / (friction * 50.0), abs=2e-4)
    assert place[-1, 0] > 2.0 * disc().circle(HERE).length
    passed = place[held:, 0] - place[held, 0] - speed * (run.time.values[held:] - run.time.values[held])
    # Up to the vibration of the disc itself, and no more at the end.
    assert np.abs(passed).max() < 1e-6
    assert np.abs(passed[-100:]).max() < 2.0 * np.abs(passed[:100]).max()


# Against a plain march.


class PlainMarch:
    """Central differences of a rider on a disc, rows anew from the body in each step; contact forces by brute force."""

    def __init__(self, plate: st.AxisymmetricBody, mass: float, stiffness: float, friction: float, step: float) -> None:
        self.plate, self.step, self.friction, self.mass = plate, step, friction, mass
        modes = plate.modes()
        self.squared, self.damping = modes.angular_frequency**2, modes.damping_rate
        self.springs, self.load = np.array([0.0, stiffness, stiffness]), np.array([-50.0, 0.0, 0.0])
        self.q = self.before = np.zeros(modes.count)
        self.pad, self.pad_before, self.slips, self.velocity = np.zeros(3), np.zeros(3), [np.zeros(2)] * 2, 0.0

    def rows(self, travel: float) -> np.ndarray:
        """Displacements of the disc along the normal, the circle and across it, from its modes."""
        along, across = ways(travel)
        turned = HERE[1] + travel / RADIUS
        return np.array([UP, along, across]) @ self.plate.trace((RADIUS, turned, HERE[2]))

    def advance(self, n: int) -> np.ndarray:
        h = self.step
        share = 1.0 / (1.0 + 0.5 * h * self.damping)
        free = share * (2.0 * self.q - (1.0 - 0.5 * h * self.damping) * self.before - h**2 * self.squared * self.q)
        pad = 2.0 * self.pad - self.pad_before + h**2 / self.mass * (self.load - self.springs * self.pad)
        rows = self.rows(self.velocity * (n + 1) * h + pad[1])
        gap = pad[0] - rows[0] @ free
        carried = np.array([self.velocity * h, 0.0])
        slip = pad[1:] - self.pad[1:] + carried - rows[1:] @ (free - self.q)
        compliance = rows @ (h**2 * share * rows).T + h**2 / self.mass * np.eye(3)
        found = np.zeros(3)
        if gap < 0.0:
            found[0], found[1:] = reference(
                gap, slip, compliance, self.friction, (6.0 * self.slips[0] + self.slips[1]) / 9.0
            )
        push = found * [1.0, -1.0, -1.0]
        self.slips = [slip + compliance[1:] @ push, self.slips[0]]
        self.q, self.before = free - h**2 * share * (push @ rows), self.q
        self.pad, self.pad_before = pad + h**2 / self.mass * push, self.pad
        return found


def test_the_march_equals_a_plain_one():
    """A rider on soft springs, carried round at 60 m/s: a sixth of a turn, and as far as its springs let it."""
    step, count, velocity = 4e-6, 600, 60.0
    plate = disc(cutoff=2500.0)
    system = riders(
        lambda abscissa: (plate.circle(HERE, velocity), {}), friction=0.3, stiffness=1e4, mass=0.02, gap=1e-9
    )
    run = st.simulate(system, count * step, step=step, sample_rate=1.0 / step, scheme=st.CentralDifference(), probes=[])
    twin = PlainMarch(plate, 0.02, 1e4, 0.3, step)
    twin.velocity, twin.slips = velocity, [np.array([velocity * step, 0.0])] * 2
    twin.pad = np.array([1e-9, 0.0, 0.0])
    twin.pad_before = twin.pad + 0.5 * step**2 / 0.02 * twin.load
    known = np.array([twin.advance(n) for n in range(count)])
    assert (known[:, 0] > 0.0).sum() > 100
    assert abs(twin.pad[1]) > 1e-4
    scale = known[:, 0].max()
    np.testing.assert_allclose(forces(run), known, atol=1e-9 * scale)


# Energy, laws, several contacts.


THREE = (0.0, 0.06, 0.2)
CASES = {
    "turning": (on_a_circle(200.0, residual_at=[(RADIUS, 0.01)]), THREE),
    "moved": (on_a_circle(velocity=8.0), THREE),
    "both": (on_a_circle(60.0, velocity=-4.0), (0.0,)),
}


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("case", CASES)
def test_energy_is_conserved_and_laws_hold_in_every_step(case, scheme):
    track, abscissas = CASES[case]
    friction = st.Stribeck(0.4, 0.3, 0.5)
    system = riders(track, friction=friction, stiffness=2e4, abscissas=abscissas, mass=0.05)
    run = st.simulate(system, 0.01, scheme=scheme, step=2e-6, sample_rate=5e5, probes=[])
    largest = max(float(np.abs(run[term]).max()) for term in LEDGER)
    assert float(np.abs(run.ledger_residual).max()) < 1e-10 * largest
    normal = run.normal_force.values.reshape(run.time.size, -1)
    pulled = np.hypot(*np.moveaxis(run.tangential_force.values.reshape(*normal.shape, 2), -1, 0))
    gap = run.gap.values.reshape(normal.shape)
    assert (normal >= 0.0).all()
    assert (pulled <= 0.4 * normal * (1.0 + 1e-9) + 1e-9).all()
    assert (np.abs(gap) * normal).max() < 1e-12 * normal.max()
    assert (np.diff(run.friction_loss) >= -1e-12 * largest).all()
    # Travel matters: tips are carried by millimetres.
    travelled = run.contact_position.values.reshape(*normal.shape, 2)[..., 0] - abscissas
    assert np.abs(travelled).max() > 1e-4


def test_impact_losses_are_small_without_lift_off():
    """The work of the contact is that of the slope of the waves minus that of friction, to the order of the scheme."""
    lost = []
    for step in (4e-6, 2e-6):
        run = st.simulate(
            riders(on_a_circle(velocity=30.0), friction=0.3, stiffness=1e5),
            0.01,
            step=step,
            sample_rate=5e4,
            probes=[],
        )
        assert (run.normal_force > 0.0).all()
        lost.append(float(np.abs(run.impact_loss).max()))
        share = float(np.abs(run.convection_work).max())
    assert share > 10.0 * lost[1]
    assert lost[0] / lost[1] == pytest.approx(2.0, rel=0.01)


def test_several_contacts_on_a_circle_may_be_turned_by_any_angle():
    """Turning all of them by any angle changes nothing."""
    abscissas = np.array(THREE)
    runs = [
        st.simulate(riders(on_a_circle(velocity=30.0), stiffness=2e4, abscissas=abscissas + by), 4e-3, **WORDS)
        for by in (0.0, 0.3)
    ]
    found = [forces(run) for run in runs]
    np.testing.assert_allclose(*found, atol=1e-7 * found[0].max())
    # Neighbours have an influence.
    alone = forces(st.simulate(riders(on_a_circle(velocity=30.0), stiffness=2e4), 4e-3, **WORDS))
    assert np.abs(alone[:, 0] - found[0][:, 0]).max() > 0.01 * found[0].max()


def test_a_fixed_contact_beside_one_that_moves_round():
    """A pad at a point of the disc and a rider on a circle: without travel the same as two fixed contacts."""
    plate, circle = disc(30.0), disc(30.0).circle(HERE)
    there = plate.at(circle.point_at(0.1).position)

    def mixed(abscissa):
        if abscissa:
            return there, {"tangent": ways(0.1)[0]}
        return circle, {}

    both = riders(mixed, friction=0.0, abscissas=(0.0, 0.1))
    still = riders(fixed(30.0), friction=0.0, abscissas=(0.0, 0.1))
    found, known = (forces(st.simulate(one, 4e-3, **WORDS)) for one in (both, still))
    np.testing.assert_allclose(found, known, atol=1e-9 * known.max())


# Side by side, continuation, coupled modes.


def test_runs_side_by_side_are_those_alone():
    speeds = [5.0 * k for k in range(1, 10)]
    systems = [riders(on_a_circle(velocity=v, history=st.Ramp(1e-3)), stiffness=2e4, abscissas=THREE) for v in speeds]
    same_side_by_side(systems, 1e-3, ("normal_force", "tangential_force", "slip_velocity", "convection_work"), **WORDS)


@pytest.mark.parametrize("turning", [0.0, 40.0])
def test_a_run_continues_to_the_last_bit_and_runs_again(turning, tmp_path):
    track = on_a_circle(turning, velocity=20.0, history=st.Ramp(5e-4))
    system = riders(track, friction=0.4, stiffness=2e4, abscissas=(0.0, 0.1))
    words = {"step": 4e-6, "sample_rate": 5e4, "probes": [st.Velocity(system.track.at(HERE), "z")]}
    names = ("normal_force", "tangential_force", "slip_velocity", "contact_position", "convection_work")
    whole, *_, scenario = goes_on(system, 2e-3, names, tmp_path, **words)
    again = scenario.simulate()
    for name in ("normal_force", "tangential_force", "velocity"):
        np.testing.assert_array_equal(again[name], whole[name])
    assert again.attrs["scenario"] == whole.attrs["scenario"]


SCENARIO = """
[bodies.disc]
kind = "axisymmetric"
profile = { shape = "rectangle", inner = "30 mm", outer = "150 mm", bottom = 0.0, top = "10 mm" }
material = { young = "210 GPa", density = 7850, poisson = 0.3 }
cutoff = "4 kHz"
held = ["inner"]
damping = 0.002

[bodies."pad 0"]
kind = "rigid body"
mass = 0.2
points = { tip = [0, 0, 0] }

[[contacts]]
tip = { body = "pad 0", point = "tip" }
at = 0.1
normal = [0, 0, 1]
friction = { law = "coulomb", coefficient = 0.3 }

[contacts.track]
kind = "circle"
body = "disc"
point = [0.14, 0.3, 0.01]
velocity = "20 m/s"
history = { kind = "ramp", duration = "0.5 ms" }

[[drives]]
kind = "force"
body = "pad 0"
point = "tip"
z = -50.0

[simulation]
duration = "1 ms"
step = "2 us"
"""


def test_scenarios_have_circles(tmp_path):
    file = tmp_path / "round.toml"
    file.write_text(SCENARIO)
    system = riders(on_a_circle(velocity=20.0, history=st.Ramp(5e-4)), stiffness=0.0, abscissas=(0.1,))
    found = st.load_scenario(file).simulate()
    known = st.simulate(system, 1e-3, step=2e-6, sample_rate=1.0 / float(np.diff(found.time.values)[0]), probes=[])
    np.testing.assert_allclose(forces(found), forces(known), rtol=1e-12)
    block = '[bodies.disc]\nkind = "rigid body"\nmass = 1.0\npoints = { tip = [0, 0, 0] }\n'
    file.write_text(block + SCENARIO[SCENARIO.index('[bodies."pad 0"]') :])
    with pytest.raises(st.ScenarioError, match=r"track\.body must be a body of revolution"):
        st.load_scenario(file)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_contact_moves_round_a_disc_on_springs(scheme):
    """A spring of negligible stiffness couples the modes of the disc, which then march with matrices."""
    plain = riders(on_a_circle(velocity=20.0), friction=0.3, stiffness=2e4)
    disc_point = plain.track.at((0.1, 1.0, 0.0))
    soft = st.Spring(disc_point, direction="z", stiffness=1.0)
    joined = st.System(plain.contacts, plain.drives, [*plain.connections, soft])
    found, known = (forces(st.simulate(one, 2e-3, scheme=scheme, **WORDS)) for one in (joined, plain))
    np.testing.assert_allclose(found, known, atol=1e-5 * known.max())
    assert not np.array_equal(found, known)


# Linear theory.


@pytest.mark.parametrize("scheme", SCHEMES)
def test_growth_in_time_is_that_of_linear_theory(scheme):
    """On soft springs the shift of the contact point along the bent disc has an influence."""
    system = riders(on_a_circle(30.0), friction=0.5, stiffness=2e6, mass=0.3)
    probe = st.Displacement(system.track.at(HERE), "z")
    known, seen, _ = growth(system, probe, 2e-6, 6e-3, 20, scheme, amplitude=1e-10)
    assert seen == pytest.approx(known, rel=2e-3)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_start_in_equilibrium_stays_there(scheme):
    system = riders(on_a_circle(60.0, damping=0.01), friction=0.2, stiffness=1e5)
    theory = st.sliding_stability(system)
    swings = []
    for step in (2e-6, 1e-6):
        run = st.simulate(starting(system), 0.01, scheme=scheme, step=step, probes=[])
        swings.append(float(np.abs(run.normal_force / theory.normal_force - 1.0).max()))
    assert swings[0] < 60.0 * 2e-6
    assert swings[0] == pytest.approx(2.0 * swings[1], rel=0.02)


# Sound.


def test_a_disc_under_a_moving_contact_is_driven_again_as_it_moved():
    """From the forces and the places of a record, the acceleration of a point of the disc."""
    system = riders(on_a_circle(velocity=20.0), friction=0.3, stiffness=1e5)
    plate, place = system.track, (0.1, 2.0, 0.01)
    run = st.simulate(system, 0.03, step=2e-6, sample_rate=1e5, probes=[st.Acceleration(plate.at(place), "z")])
    known, late = run.acceleration.values.ravel(), slice(400, -200)

    def again(record):
        moved = redriven(record, system).of(system.body_name(plate))
        found = plate.trace(place)[2] @ moved.accelerations(np.arange(plate.modes().count))
        return np.interp(run.time.values, moved.first + moved.interval * np.arange(found.size), found)

    assert np.abs(again(run) - known)[late].max() < 0.05 * np.abs(known[late]).max()
    # Forces at fixed places would move it differently.
    stays = run.assign(contact_position=0.0 * run.contact_position)
    assert np.abs(again(stays) - known)[late].max() > 0.2 * np.abs(known[late]).max()


# Errors.


def contact(track, **words):
    pad = st.RigidBody(1.0, points={"tip": (0.0, 0.0, 0.0)}, name="pad")
    return st.PointContact(pad.at("tip"), track, **{"normal": UP, **words})


BAD = {
    "tangent": (lambda: contact(disc().circle(HERE), tangent=(1.0, 0.0, 0.0)), "tangent must be left out on a circle"),
    "normal": (
        lambda: contact(disc().circle(HERE), normal=(1.0, 0.0, 0.0)),
        "normal must be at right angles to the circle",
    ),
    "surface": (
        lambda: contact(disc().circle(HERE), surface_velocity=1.0),
        "surface_velocity must be 0 except against",
    ),
    "axis": (
        lambda: st.AxisymmetricBody(
            st.RectangleProfile({"disc": ((0.0, 0.1), (0.0, 0.01))}), STEEL, 4000.0, "outer"
        ).circle((0.0, 0.0, 0.01)),
        "position must be off the axis",
    ),
    "outside": (lambda: disc().circle((0.5, 0.0, 0.01)), "position must be .* in the profile"),
    "velocity": (lambda: disc().circle(HERE, np.inf), "velocity must be finite"),
    "step": (
        lambda: st.simulate(riders(on_a_circle(velocity=3e4)), 1e-4, step=2e-6),
        "step must be at most .* s: a contact passes over waves by at most 0.5 rad",
    ),
    "linear": (
        lambda: st.sliding_stability(riders(on_a_circle(velocity=1.0))),
        "must not be carried along its circle .* in linear theory",
    ),
    "damping": (
        lambda: st.simulate(riders(on_a_circle(damping=[0.01 * k for k in range(disc().modes().count)])), 1e-4),
        "damping must be the same for both modes of each pair",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_arguments_are_refused(case):
    make, words = BAD[case]
    with pytest.raises(st.ArgumentError, match=words):
        make()


def test_contacts_of_a_record_may_be_in_another_order():
    system = riders(on_a_circle(20.0, 3.0, cutoff=2e3), abscissas=(0.0, 0.1))
    run = st.simulate(system, 2e-3, sample_rate=5e4, probes=[])
    modes = np.arange(assemble(system).mode_count)
    expected = redriven(run, system).accelerations(modes)
    np.testing.assert_array_equal(redriven(run.isel(contact=[1, 0]), system).accelerations(modes), expected)
    assert np.abs(expected).max() > 0.0
