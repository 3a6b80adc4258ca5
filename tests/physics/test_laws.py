"""Laws that every run satisfies at each step, in every regime, with every drive, under both schemes."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from physics.cases import CASES, SCHEME_NAMES, SCHEMES, STEP, every_step, pair, slider, track, transverse
from stridula._kernels.layout import columns as layout

STEPS = 60_000
EPS = np.finfo(float).eps
# A gap or a slip is a sum over some 60 modes, of terms no larger than the largest displacement.
SUM = 60 * EPS
SEPARATED, STICKING, SLIDING = 0, 1, 2

_kept: dict = {}


def run_of(name, scheme):
    """The run of a case, made once in each worker."""
    key = (name, scheme.name)
    if key not in _kept:
        _kept[key] = every_step(CASES[name](), STEPS, scheme)
    return _kept[key]


def violations(run, mu: float) -> set[str]:
    """Names of the laws that a record of every step breaks."""
    status, normal, tangential = run.status.values, run.normal_force.values, run.tangential_force.values
    gap, slip = run.gap.values, run.slip_velocity.values * STEP
    # A height is a sum of displacements up to the tip's travel; an abscissa is a number up to the track's length.
    small_gap = SUM * np.abs(run.contact_height.values).max()
    small_slip = SUM * np.abs(run.contact_position.values).max()
    closed, stuck, sliding = normal > 0, status == STICKING, status == SLIDING
    # In a step in which the slip reverses, forces are means over both senses.
    sliding &= ~np.concatenate([[False], sliding[:-1] & (slip[1:] * slip[:-1] < 0)])
    laws = {
        "normal force below zero": normal.min() < 0,
        "gap below zero": gap.min() < -small_gap,
        "force at a distance": np.any(np.abs(gap[closed]) > small_gap),
        "outside the cone": np.any(np.abs(tangential) > mu * normal * (1 + 2 * EPS)),
        "slip while sticking": np.any(np.abs(slip[stuck]) > small_slip),
        "slides inside the cone": np.any(np.abs(tangential[sliding]) < mu * normal[sliding] * (1 - 2 * EPS)),
        "slides the wrong way": np.any((tangential * slip)[sliding] < -np.abs(tangential[sliding]) * small_slip),
        "force while separated": np.any(normal[status == SEPARATED] != 0) or np.any(tangential[status == SEPARATED]),
        "friction gives energy": np.any(
            np.diff(run.friction_loss.values)
            < -np.abs(tangential[1:]) * small_slip - 2 * EPS * np.abs(run.friction_loss.values[1:])
        ),
        "share is not a state": np.any(run.status_share.values.sum(axis=1) != 1),
    }
    return {law for law, broken in laws.items() if broken}


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
@pytest.mark.parametrize("name", CASES)
def test_laws_hold_at_every_step(name, scheme):
    run = run_of(name, scheme)
    assert run.attrs["ended"] == "finished"
    assert run.sizes["time"] == STEPS
    assert violations(run, CASES[name]().contact.friction.coefficient) == set()


def test_the_cases_visit_all_states():
    """Each state must fill a tenth of some case, or its laws are not tested."""
    shares = np.array([run_of(name, SCHEMES[1]).status_share.values.mean(axis=0) for name in CASES])
    assert np.all(shares.max(axis=0) > 0.1)


@pytest.mark.parametrize(
    ("change", "law"),
    [
        ("less friction", "outside the cone"),
        ("more friction", "slides inside the cone"),
        ("turned friction", "slides the wrong way"),
        ("penetration", "gap below zero"),
        ("penetration", "force at a distance"),
        ("creep", "slip while sticking"),
        ("leak", "friction gives energy"),
        ("pull", "normal force below zero"),
    ],
)
def test_harness_rejects_a_broken_law(change, law):
    """Negative control: a slightly changed record of squeal breaks exactly the expected law."""
    run, mu = run_of("squeal", SCHEMES[1]).copy(deep=True), 1.5
    if change == "less friction":
        mu *= 1 - 1e-12
    elif change == "more friction":
        mu *= 1 + 1e-12
    elif change == "turned friction":
        run["tangential_force"] *= -1
    elif change == "penetration":
        run["gap"] -= 1e-13
    elif change == "creep":
        run["slip_velocity"] += 1e-13 / STEP
    elif change == "leak":
        run["friction_loss"] -= 1e-12 * run.time
    else:
        run["normal_force"] *= -1
    assert law in violations(run, mu)


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
@pytest.mark.parametrize("name", ["stable", "squeal", "judder"])
def test_impulse_is_the_change_of_momentum(name, scheme):
    """Root free in x and y: ``M v_y(T) = (mean N - F_y) T``, an identity of the rigid modes' recurrence.

    The start is from rest: ``v(0) = 0``, so that the momentum half a step before the end is the sum of the impulses up
    to then; the drive's first impulse counts half (the centred velocity at the start is zero).
    """
    system = CASES[name]()
    run = run_of(name, scheme)
    force = system.drives[0]
    along, across = system.slider.axes
    world = force.axial * along + force.transverse * across
    modes = system.slider.modes()
    speed = run.state_modal.values[1, : modes.count] / STEP
    momentum = modes.translation @ speed
    contact = np.array([-run.tangential_force.values.sum(), run.normal_force.values.sum()]) * STEP
    drive = world * (STEPS - 0.5) * STEP
    scale = np.abs(contact) + np.abs(drive)
    # Sums of 6e4 impulses in the march and here, each rounded at the size of the sum.
    np.testing.assert_allclose(momentum, contact + drive, atol=STEPS * EPS * scale.max(), rtol=0)
    assert not np.allclose(momentum, -contact + drive, atol=1e-3 * scale.max()), "control: forces turned over"


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_mean_normal_force_of_a_long_stable_run_is_the_load(scheme):
    """0.2 N across at 45 degrees press with 0.2 sin 45 N; it then advances as a rigid body, a = (F_x - mu F_y) / M.

    Damping 0.3: at 0.02 the slider still bounces on its own bending at 7.7 Hz, 4 mm/s, after a second, which is 1 % of
    the load over a second. The mean misses the load by M (change of v_y) / T; v_y at the root bounds that of the rest.
    """
    system = pair(transverse(0.2), mu=0.5, rod=slider(damping=0.3), bar=track(damping=0.3))
    probes = [st.Velocity(system.slider.root, "y"), st.Velocity(system.slider.root, "x")]
    run = every_step(system, 300_000, scheme, probes=probes)
    assert np.all(run.status.values[100_000:] == SLIDING)
    upward, forward = run.velocity.values[200_000:].T
    duration = upward.size * STEP
    load = 0.2 * np.sin(np.pi / 4)
    bounce = system.slider.total_mass * np.ptp(upward) / duration
    assert bounce < 0.01 * load
    assert run.normal_force.values[200_000:].mean() == pytest.approx(load, abs=bounce)
    acceleration = (forward[-1] - forward[0]) / duration
    expected = 0.2 * np.cos(np.pi / 4) * (1 - 0.5) / system.slider.total_mass
    assert acceleration == pytest.approx(expected, abs=2 * np.ptp(upward) / duration)


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_frictionless_upright_contact_only_takes_energy(scheme):
    """Dropped on its end without friction: a closed contact does the work N (gap[n+1] - gap[n-1]) / 2 <= 0 a step.

    The tip does not move along x, so the traces stay where they are, and the gap at n - 1 was not below zero.
    """
    system = pair(lambda rod: [st.Gravity()], mu=0.0, angle=0.0, gap=1e-4, at=0.31)
    run = every_step(system, 200_000, scheme)
    assert len(np.flatnonzero(np.diff((run.normal_force.values > 0).astype(int)) == 1)) > 10, "it must bounce"
    largest = np.abs(run.drive_work.values).max()
    assert np.diff(run.contact_work.values).max() <= SUM * largest
    mechanical = (run.kinetic_and_elastic - run.drive_work).values
    assert np.diff(mechanical).max() <= SUM * largest
    assert np.abs(run.friction_loss.values).max() == 0.0
    assert np.abs(run.convection_work.values).max() <= SUM * largest


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_a_stick_does_not_creep(scheme):
    """A million steps stuck under a shaking that stays in the cone: the material point moves less than 1e-12 of L.

    Round-off of an abscissa of 0.2 m is 3e-17 m a step: a walk of 1e6 steps would still pass; a creep of one part
    in 1e8 of the 1 um/step elastic motion (a penalty's or a drifting anchor's) would not.
    """

    def pressed(rod):
        return [
            st.Force(rod.root, y=-5.0, history=st.Ramp(0.05)),
            st.Force(rod.at(0.25), x=0.5, history=st.Harmonic(60.0)),
        ]

    system = pair(pressed, mu=1.2, angle=20.0, gap=0.0)
    words = {"scheme": scheme, "step": STEP, "sample_rate": 1e4}
    settling = st.simulate(system, 0.5, **words)
    run = st.simulate(system, 1e6 * STEP, start=settling, **words)
    assert np.all(run.status_share.values[:, STICKING] == 1.0)
    # It works: the tangential force swings, and the tip moves with the track.
    assert np.ptp(run.tangential_force.values) > 0.1
    travelled = run.slip_velocity.values * run.attrs["sample_interval"]
    before, after = (r.state_carried.values[0, layout.MATERIAL] for r in (settling, run))
    assert abs(after - before) <= 1e-12 * system.track.length
    assert np.abs(np.cumsum(travelled)).max() <= 1e-12 * system.track.length


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_a_stick_returns_to_its_anchor(scheme):
    """Moved off its anchor by 1 nm in the state handed on, a stuck tip is back on it after one step.

    This prevents round-off from accumulating: a stick held at the last step would stay displaced.
    """
    system = pair(lambda rod: [st.Force(rod.root, y=-5.0, history=st.Ramp(0.05))], mu=1.2, angle=20.0, gap=0.0)
    stuck = every_step(system, 60_000, scheme)
    assert stuck.status.values[-1] == STICKING
    anchor = stuck.state_carried.values[0, layout.ANCHOR]
    assert stuck.state_carried.values[0, layout.MATERIAL] == pytest.approx(anchor, abs=1e-15)
    stuck.state_carried.values[0, layout.ANCHOR] = anchor + 1e-9
    run = every_step(system, 1, scheme, start=stuck)
    # 1 nm in one step takes some 0.2 N of the 7 N that the cone allows.
    assert run.status.values[0] == STICKING
    assert run.state_carried.values[0, layout.MATERIAL] == pytest.approx(anchor + 1e-9, abs=1e-15)


def test_creep_harness_rejects_a_slider_that_slips_now_and_then():
    """Negative control: with less friction the same shaking makes it walk."""

    def pressed(rod):
        return [
            st.Force(rod.root, y=-5.0, history=st.Ramp(0.05)),
            st.Force(rod.at(0.25), x=3.0, history=st.Harmonic(60.0)),
        ]

    system = pair(pressed, mu=0.3, angle=20.0, gap=0.0)
    run = st.simulate(system, 0.5, step=STEP, sample_rate=1e4)
    assert abs(run.state_carried.values[0, layout.MATERIAL] - 0.2) > 1e-9
