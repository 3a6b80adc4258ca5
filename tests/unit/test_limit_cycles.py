"""The search for limit cycles: states as vectors, its linear algebra against dense matrices, arguments, branches."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.cycles.floquet import multipliers_of
from stridula.cycles.linearised import Condition, Linearised
from stridula.cycles.newton import closed_orbit
from stridula.cycles.returning import Orbit, Return
from stridula.cycles.starts import Asked, beginning_of
from stridula.integration.period_map import PeriodMap
from stridula.integration.settings import Settings
from stridula.integration.state_vectors import StateVectors
from stridula.lowering import assemble
from stridula.verification.systems.cycles import LiftingMass, Stopped, Weakening

SETTINGS = Settings()


def begun(system: st.System, start: xr.Dataset | None = None):
    return beginning_of(system, Asked(start, SETTINGS, None, None))


def returned(system: st.System) -> Return:
    """Return an orbit near the limit cycle of a system after a period."""
    near = begun(system)
    return Return.of(near.of_period, near.vectors, near.orbit)


@pytest.fixture(scope="module")
def lifting() -> Return:
    return returned(LiftingMass().system())


def by_differences(now: Return) -> np.ndarray:
    """Return the derivative of the state after a period, for modes alone, column by column."""
    count = 2 * now.vectors.count
    columns = []
    for k in range(count):
        unit = np.zeros(count)
        unit[k] = 1.0
        direction = now.vectors.moved(unit[: count // 2], unit[count // 2 :], now.orbit.vector)
        columns.append(now.product(direction)[:count])
    return np.array(columns).T


def test_a_state_survives_as_a_vector_at_any_step(lifting):
    state, step = lifting.passed.state, lifting.step
    vectors = lifting.vectors
    again = vectors.state(vectors.vector(state, step), step, vectors.status(state))
    np.testing.assert_allclose(again.modal, state.modal, rtol=1e-14)
    np.testing.assert_allclose(again.carried, state.carried, rtol=1e-12, atol=1e-14)
    half = vectors.state(vectors.vector(state, step), 0.5 * step, vectors.status(state))
    np.testing.assert_allclose(half.modal[1], 0.5 * state.modal[1], rtol=1e-14)
    np.testing.assert_allclose(half.modal[0], state.modal[0], rtol=1e-14)


def test_the_norm_is_twice_the_energy_of_modes():
    flat = assemble(Stopped(0.5).system())
    vectors = StateVectors(flat, 1e3)
    position, velocity = np.random.default_rng(0).standard_normal((2, flat.mode_count))
    vector = vectors.of_modes(np.stack([position, velocity * 1e-6]), 1e-6)
    energy = 0.5 * (velocity @ velocity + position @ flat.all_stiffness @ position)
    # Motions have at least the stiffness of the period, which is long here.
    assert vectors.norm(vector) ** 2 == pytest.approx(2.0 * energy, rel=1e-4)


def test_a_period_is_that_of_a_run():
    """A run of the same steps passes the same states; the belt goes on beside it."""
    system = Weakening(1.0).system()
    run = st.simulate(system, 2.0, step=0.01, sample_rate=100.0, probes=[])
    longer = st.simulate(system, 3.0, step=0.01, sample_rate=100.0, probes=[])
    near = begun(system, run.assign(period=1.0))
    passed = PeriodMap(near.of_period.arrays, SETTINGS.scheme, SETTINGS.solve, 100).after(
        near.vectors.state(near.orbit.vector, 0.01, near.orbit.status), 1.0
    )
    np.testing.assert_allclose(passed.state.modal, longer["state_modal"].values, rtol=1e-9, atol=1e-12)


def test_the_step_is_that_of_dense_matrices(lifting):
    """With as many directions as unknowns, the step solves the equations of Newton's method."""
    count, counted = 2 * lifting.vectors.count, lifting.vectors.counted
    by_period = lifting.by_period()
    step = Linearised.of(lifting, [by_period], [Condition(lifting.flow, [0.0])]).step()
    moved = step.vector[:count] - lifting.orbit.vector[:count]
    jacobian = by_differences(lifting)
    matrix = np.block(
        [
            [jacobian - np.eye(count), by_period[:count, None]],
            [np.array([counted(lifting.flow) @ counted(_modes(lifting, k)) for k in range(count)]), np.zeros(1)],
        ]
    )
    dense = np.linalg.solve(matrix, np.append(-lifting.missing[:count], 0.0))
    np.testing.assert_allclose(moved, dense[:-1], rtol=2e-2, atol=1e-3 * np.abs(dense[:-1]).max())
    assert step.amounts[0] == pytest.approx(dense[-1], rel=2e-2)


def _modes(now: Return, number: int) -> np.ndarray:
    vector = np.zeros_like(now.orbit.vector)
    vector[number] = 1.0
    return vector


@pytest.mark.parametrize("share", [0.5, 0.1, 1e-3])
def test_a_damped_step_has_its_length_and_leaves_more(lifting, share):
    linearised = Linearised.of(lifting, [lifting.by_period()], [Condition(lifting.flow, [0.0])])
    whole = linearised.step()
    damped = linearised.step(share * whole.length)
    assert damped.length == pytest.approx(share * whole.length, rel=1e-3)
    assert whole.left < damped.left <= lifting.residual


def test_multipliers_are_eigenvalues_of_the_derivative():
    near = begun(LiftingMass().system())
    cycle = closed_orbit(near.of_period, near.vectors, near.orbit, False, 1e-11, lambda *_: None).best
    dense = np.linalg.eigvals(by_differences(cycle))
    found = multipliers_of(cycle, False).values
    for one in dense[np.abs(dense) > 0.1]:
        assert np.abs(found - one).min() < 2e-3


def test_the_period_of_drives_is_not_doubled_by_chance():
    """Distances are compared at whole periods of the drive, which no step of the run need hit."""
    for angular, step in ((0.5, 0.005), (0.65, 0.005), (0.5, 0.0123)):
        cycle = st.limit_cycle(Stopped(angular).system(), step=step)
        assert float(cycle["period"]) == pytest.approx(2.0 * np.pi / angular, rel=1e-12)


def test_a_cycle_is_a_record_that_files_and_runs_take(tmp_path):
    system = Weakening(1.0).system()
    cycle = st.limit_cycle(system, step=0.05)
    st.save(cycle, tmp_path / "cycle.nc")
    assert st.load(tmp_path / "cycle.nc").identical(cycle)
    step, period = cycle.attrs["step"], float(cycle["period"])
    probes = [st.Displacement(system.contacts[0].tip, axis) for axis in "xy"]
    run = st.simulate(system, 3.0 * period, start=cycle, step=step, sample_rate=1.0 / step, probes=probes)
    again = run["displacement"].values[-cycle.sizes["time"] :]
    np.testing.assert_allclose(again, cycle["displacement"].values, atol=1e-9)
    # A cycle of a neighbouring system begins there.
    other = st.limit_cycle(Weakening(1.02).system(), cycle)
    assert int(other["newton_steps"]) <= 3
    assert float(other["period"]) != period


def test_a_repeated_cycle_is_a_run_of_many_periods():
    """A run from the cycle passes the same states; sums since the start go on."""
    system = Weakening(1.0).system()
    cycle = st.limit_cycle(system, step=0.05)
    again = st.repeat_cycle(cycle, 2.5 * float(cycle["period"]))
    assert again.sizes["time"] == 3 * cycle.sizes["time"]
    step = cycle.attrs["step"]
    probes = [st.Displacement(system.contacts[0].tip, axis) for axis in "xy"]
    run = st.simulate(system, again.sizes["time"] * step, start=cycle, step=step, sample_rate=1.0 / step, probes=probes)
    for name in ("displacement", "normal_force", "tangential_force", "slip_velocity"):
        np.testing.assert_allclose(again[name].values, run[name].values, atol=1e-8)
    for name in ("drive_work", "friction_loss", "damping_loss"):
        passed = float(cycle[name][-1])
        np.testing.assert_allclose(again[name].values + passed, run[name].values, rtol=1e-7)
    np.testing.assert_allclose(np.diff(again["time"].values), step, rtol=1e-9)
    assert str(st.regime(st.repeat_cycle(cycle, 200.0))["regime"].item()) == "stick-slip"
    with pytest.raises(ValueError, match="duration must be"):
        st.repeat_cycle(cycle, 0.0)
    with pytest.raises(ValueError, match="cycle must be the result of limit_cycle"):
        st.repeat_cycle(run, 1.0)


def test_energy_of_a_period_balances():
    cycle = st.limit_cycle(LiftingMass().system())
    energy = cycle["period_energy"]
    assert float(energy.sel(energy_term="drive_work")) > 0.0
    assert abs(float(energy.sel(energy_term="sum"))) < 1e-9 * float(energy.sel(energy_term="drive_work"))


def test_harmonics_add_up_to_the_motion():
    cycle = st.limit_cycle(Stopped(0.5).system())
    values = cycle["displacement"].values[:, 1]
    first = float(cycle["displacement_harmonic"].values[0, 1])
    # Without contact the motion is the first harmonic alone.
    assert first == pytest.approx(float(cycle["displacement_amplitude"][1]), rel=1e-4)
    assert np.ptp(values) / 2.0 == pytest.approx(first, rel=1e-4)


def test_sliding_that_is_stable_has_no_cycle():
    with pytest.raises(st.NoCycle, match="no cycle near the start: the motion dies away to rest or to steady sliding"):
        st.limit_cycle(Weakening(3.0).system(), frequency=0.159, settle=600)


def test_a_tip_that_travels_along_a_beam_has_no_cycle():
    system = st.load_scenario("weak-pressure").system
    with pytest.raises(ValueError, match="system must keep its contacts in place, got contact 1, which travels along"):
        st.limit_cycle(system)


def test_drives_without_a_common_period_are_refused():
    body = st.PointMass(1.0)
    forces = [st.Force(body.centre, x=1.0, history=st.Harmonic(frequency)) for frequency in (1.0, np.sqrt(2.0))]
    contact = st.PointContact(body.centre, st.RigidTrack(), friction=st.Coulomb(0.1))
    system = st.System(contact, [st.Force(body.centre, y=-1.0), *forces], [st.Spring(body.centre, stiffness=1.0)])
    with pytest.raises(ValueError, match=r"system must have drives with a common period, got 1 and 1\.41421 Hz"):
        st.limit_cycle(system)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"frequency": 0.0}, "frequency must be"),
        ({"settle": -1}, "settle must be"),
        ({"tolerance": 1.0}, "tolerance must be"),
        ({"step": -1.0}, "step must be"),
        ({"start": "belt"}, "start must be"),
        ({"start": st.InitialEquilibrium()}, "start must have a mode and its amplitude"),
        ({"progress": 1}, "progress must be"),
    ],
)
def test_arguments_out_of_range_are_refused_in_one_line(arguments, words):
    with pytest.raises(ValueError, match=words) as caught:
        st.limit_cycle(Weakening(1.0).system(), **arguments)
    assert "\n" not in str(caught.value)


def test_a_record_of_another_system_is_refused():
    run = st.simulate(Weakening(1.0).system(), 1.0, step=0.01, sample_rate=100.0)
    with pytest.raises(ValueError, match="start must have the same number of modes as this system, 4, got 2"):
        st.limit_cycle(Stopped(0.5).system(), run)


def weakening_over(velocity: float) -> st.System:
    return Weakening(velocity).system()


@pytest.fixture(scope="module")
def branch() -> xr.Dataset:
    return st.follow_cycle(weakening_over, "velocity", 0.9, 2.0, value=1.1, step=0.02)


def test_a_branch_passes_the_corner_at_grazing_and_ends_in_sliding(branch):
    """Known: stick-slip up to 1.836601 m/s, the unstable cycle from there down to 1.151293 m/s."""
    events = dict(zip(branch["event_kind"].values.tolist(), branch["event_value"].values.tolist(), strict=True))
    assert events == {
        "grazing": pytest.approx(1.836601, abs=5e-4),
        "Hopf": pytest.approx(1.151293, abs=1e-4),
    }
    assert (branch.attrs["begins"], branch.attrs["ends"]) == ("end of the range", "steady sliding")
    stable = branch["stable"].values
    # Stable cycles stick, unstable ones slide.
    sticking = branch["mean_status_share"].sel(contact_status="sticking").values
    assert stable[: stable.argmin()].all()
    assert not stable[stable.argmin() :].any()
    assert (sticking[~stable] == 0.0).all()
    assert (sticking[stable][:-1] > 0.0).all()


def test_points_of_a_branch_are_cycles_of_their_systems(branch):
    unstable = np.flatnonzero(~branch["stable"].values)
    number = int(unstable[len(unstable) // 2])
    one = branch.isel(point=number)
    known = Weakening(float(one["velocity"])).around_sliding(0.1, 1.5)
    assert float(one["period"]) == pytest.approx(known.period, rel=1e-4)
    assert float(one["leading_multiplier"][0]) == pytest.approx(float(known.multipliers[0].real), rel=1e-3)


def test_a_branch_is_continued_from_its_file(tmp_path):
    path = tmp_path / "branch.nc"
    arguments = {"value": 1.1, "step": 0.05, "out": path}
    begun = st.follow_cycle(weakening_over, "velocity", 0.9, 1.5, points=3, **arguments)
    assert begun.attrs["ends"] == "most points"
    again = st.follow_cycle(weakening_over, "velocity", 0.9, 1.5, points=3, **arguments)
    xr.testing.assert_equal(again, begun)
    whole = st.follow_cycle(weakening_over, "velocity", 0.9, 1.5, points=40, **arguments)
    assert whole.attrs["ends"] == whole.attrs["begins"] == "end of the range"
    assert whole.sizes["point"] > begun.sizes["point"]
    assert set(begun["velocity"].values) <= set(whole["velocity"].values)
    values = whole["velocity"].values
    assert (np.diff(values) > 0.0).all()
    with pytest.raises(ValueError, match=r"out must be a new file, or that of the same branch with high 1\.4"):
        st.follow_cycle(weakening_over, "velocity", 0.9, 1.4, **arguments)


def test_a_fold_and_its_change_of_stability_are_one_event():
    """A driven hardening oscillator against a spring with a gap: amplitude jumps up and down at two folds."""
    angular = np.linspace(0.62, 0.72, 3)
    found = st.follow_cycle(
        lambda value: Stopped(value).system(), "angular", float(angular[0]), float(angular[-1]), value=0.65, points=60
    )
    folds = found["event_value"].values[found["event_kind"].values == "fold"]
    values, stable = found["angular"].values, found["stable"].values
    turns = np.flatnonzero(np.diff(np.sign(np.diff(values))) != 0.0).size
    assert folds.size == turns
    if turns:
        assert not stable.all()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"low": 2.0, "high": 1.0}, "high must be above low"),
        ({"value": 3.0}, "value must be"),
        ({"points": 0}, "points must be"),
    ],
)
def test_wrong_ranges_are_refused(arguments, words):
    given = {"low": 0.9, "high": 1.5, "value": 1.1} | arguments
    with pytest.raises(ValueError, match=words):
        st.follow_cycle(weakening_over, "velocity", given.pop("low"), given.pop("high"), **given)


def test_figures_show_branches_and_multipliers(branch):
    figure = st.plot.bifurcation(branch)
    labels = {text.get_text() for text in figure.axes[0].get_legend().get_texts()}
    assert labels == {"stable", "unstable", "grazing", "Hopf"}
    with pytest.raises(ValueError, match="amplitude must be one of"):
        st.plot.bifurcation(branch, "elsewhere")
    with pytest.raises(ValueError, match="branch must be the result of follow_cycle"):
        st.plot.bifurcation(xr.Dataset())
    cycle = st.limit_cycle(Weakening(1.2).system(), st.InitialEquilibrium(mode="most unstable", amplitude=0.45))
    drawn = st.plot.multipliers(cycle)
    assert {text.get_text() for text in drawn.axes[0].get_legend().get_texts()} == {"depart", "along the cycle"}
    with pytest.raises(ValueError, match="cycle must be the result of limit_cycle"):
        st.plot.multipliers(xr.Dataset())


def test_an_orbit_is_a_value():
    first = Orbit(np.zeros(3), 1.0, np.zeros(1))
    assert first._replace(period=2.0).period == 2.0
