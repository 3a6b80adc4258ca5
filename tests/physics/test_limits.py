"""Quasi-static limits, imposed velocity, reactions and static shapes, against closed forms."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np
import pytest

import stridula as st
from physics.cases import SCHEME_NAMES, SCHEMES, STEEL, STEP, STRIP, dragged, every_step, pair, slider, track
from stridula.verification.systems.bars import GAP, VELOCITY, WALL

STICKING, SLIDING = 1, 2
BOTH = pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)


def pushed(angle: float, mu: float, along: bool, scheme):
    """Run 0.4 s of a slow push of 0.5 N across (trailing) or along (digging in) the slider, and return the run and
    the steady acceleration (F_x - mu F_y) / M that Coulomb allows at least."""
    a = radians(angle)
    push = {"axial": -0.5} if along else {"transverse": 0.5}
    rod, bar = slider(angle, damping=0.1), track(damping=0.1)
    system = pair(
        lambda _: [st.Force(rod.root, **push, history=st.Ramp(0.1))],
        mu,
        rod=rod,
        bar=bar,
        gap=0.0,
        at=0.6 if along else 0.2,
    )
    across, down = (0.5 * sin(a), 0.5 * cos(a)) if along else (0.5 * cos(a), 0.5 * sin(a))
    return every_step(system, 80_000, scheme), (across - mu * down) / rod.total_mass


@BOTH
@pytest.mark.parametrize("along", [False, True], ids=["trailing", "digging in"])
@pytest.mark.parametrize("angle", [30.0, 45.0, 60.0])
def test_quasi_static_limit(angle, along, scheme):
    """The contact carries the whole push, its root being free to move: N = F sin a and T = F cos a for a push across
    (trailing, cot a), N = F cos a and T = F sin a for one along the axis (digging in, tan a).

    10 % below the limit the tangential force cannot hold: |T| <= mu N, so the momentum along x grows at least by
    (F_x - mu F_y) T less the bounce. 10 % above, the stuck state is the only equilibrium and the slow push reaches it.
    """
    limit = tan(radians(angle)) if along else 1 / tan(radians(angle))
    below, acceleration = pushed(angle, 0.9 * limit, along, scheme)
    # From rest under a ramp of 0.1 s then 0.3 s steady; half of it allows for losses by bouncing.
    travel = acceleration * (0.1**2 / 6 + 0.1 / 2 * 0.3 + 0.3**2 / 2)
    moved = below.contact_position.values[-1] - below.contact_position.values[0]
    assert (-1 if along else 1) * moved > 0.5 * travel
    above, _ = pushed(angle, 1.1 * limit, along, scheme)
    moved = above.contact_position.values[-1] - above.contact_position.values[0]
    assert abs(moved) < 0.01 * travel
    assert np.all(above.status.values[-20_000:] == STICKING)


def test_limit_harness_distinguishes_the_two_leans():
    """Negative control: at 30 degrees and mu = 1 a trailing slider slides (cot 30 = 1.73) and a digging one holds
    (tan 30 = 0.58); with either limit in the other's place the test above would fail."""
    slides, _ = pushed(30.0, 1.0, False, SCHEMES[1])
    holds, _ = pushed(30.0, 1.0, True, SCHEMES[1])
    assert abs(slides.contact_position.values[-1] - slides.contact_position.values[0]) > 1e-3
    assert np.all(holds.status.values[-20_000:] == STICKING)


@BOTH
@pytest.mark.parametrize("velocity", [0.01, -0.01])
def test_dragged_steadily_friction_is_mu_times_load_and_the_root_carries_it(velocity, scheme):
    """Trailing, mu = 0.3: slides for good; then N = load and T = +-mu load, reaction along x = T, none along y."""
    mu, load = 0.3, 2.0
    # The cutoff leaves out static compliance, which the reaction must not miss.
    rod = slider(45.0 if velocity > 0 else -45.0, damping=0.2, elements=4)
    system = pair(dragged(velocity, load), mu, rod=rod, bar=track(damping=0.2))
    run = every_step(system, 400_000, scheme, probes=[st.Reaction(rod, c) for c in ("x", "y", "moment")])
    last = run.isel(time=slice(-40_000, None))
    assert np.all(last.status == SLIDING)
    normal, tangential = float(last.normal_force.mean()), float(last.tangential_force.mean())
    assert normal == pytest.approx(load, rel=1e-3)
    assert tangential == pytest.approx(np.sign(velocity) * mu * normal, rel=1e-12)
    x, y, moment = last.reaction.mean("time").values
    assert x == pytest.approx(tangential, rel=1e-3)
    assert y == 0.0
    # Slope-wise moment of the tip's force (-T, N) across the axis, at L from the root: see the static test below.
    across = -tangential * cos(rod.angle) - normal * sin(rod.angle)
    assert moment == pytest.approx(across * rod.length, rel=1e-3)
    # The load goes down with the tip on the bent track: height -N x² (L - x)² / 3 E I L, 1 % of the power.
    at = float(last.contact_position.mean())
    rigidity = STEEL.young * STRIP.second_moment
    descent = load * at**2 * (0.8 - at) ** 2 / (3 * rigidity * 0.8) * (2 / at - 2 / (0.8 - at)) * velocity
    power = np.diff(last.drive_work.values[[0, -1]])[0] / (39_999 * STEP)
    assert power == pytest.approx(tangential * velocity + load * descent, rel=1e-3)


@BOTH
@pytest.mark.parametrize("angle", [30.0, -50.0])
@pytest.mark.parametrize("direction", ["y", "transverse"])
def test_static_reaction_and_deflection(direction, angle, scheme):
    """A slider pressed on and stuck, its root guided: N and T balance the push, the support gives only a moment.

    The tip's force has the component P across the axis, at L from the root. Turning the root so that the slope of w
    rises by d theta moves the tip by -L d theta: virtual work M d theta - P L d theta = 0,
    M = P L. The track is bent by N at x to N x² (L - x)² / 3 E I L, and the tip's height is that with the gap closed.
    """
    a, force = radians(angle), 2.0
    rod = slider(angle, damping=0.5, cutoff=None, elements=4)
    bar = track(damping=0.5, cutoff=None, bending_modes=40, axial_modes=20)
    size = force * np.sign(angle) if direction == "transverse" else -force
    push = {direction: size}
    system = pair(lambda _: [st.Force(rod.root, **push, history=st.Ramp(0.05))], 5.0, rod=rod, bar=bar, gap=0.0, at=0.3)
    probes = [st.Reaction(rod, c) for c in ("x", "y", "moment")]
    run = st.simulate(system, 1.0, scheme=scheme, probes=probes, sample_rate=1e4)
    assert run.status.values[-1] == STICKING
    world = np.array([cos(a), -sin(a)]) * size if direction == "transverse" else np.array([0.0, size])
    # 1 s is some 20 periods of the slowest mode at half the critical damping; 1e-6 of the load is left at most.
    normal, tangential = run.normal_force.values[-1], run.tangential_force.values[-1]
    np.testing.assert_allclose([tangential, -normal], world, atol=1e-4 * force)
    across = -world @ [cos(a), -sin(a)]
    np.testing.assert_allclose(run.reaction.values[-1], [0.0, 0.0, across * 0.5], atol=1e-4 * force)
    x = run.contact_position.values[-1]
    height = -normal * x**2 * (0.8 - x) ** 2 / (3 * STEEL.young * STRIP.second_moment * 0.8)
    # 40 modes leave a tail of about 1/40³ of the first one's share.
    assert run.contact_height.values[-1] == pytest.approx(height, rel=1e-4)


@BOTH
def test_reaction_harness_rejects_a_clamped_root_for_a_guided_one(scheme):
    """Negative control: clamped, the root takes the push itself and little reaches the contact."""
    rod = slider(30.0, damping=0.5, root_support="clamped", elements=4, cutoff=None)
    system = pair(
        lambda _: [st.Force(rod.root, y=-2.0, history=st.Ramp(0.05))],
        5.0,
        rod=rod,
        bar=track(damping=0.5),
        gap=0.0,
        at=0.3,
    )
    run = st.simulate(
        system, 0.3, scheme=scheme, probes=[st.Reaction(rod, "y"), st.Reaction(rod, "moment")], sample_rate=1e4
    )
    assert run.normal_force.values[-1] < 1e-9
    np.testing.assert_allclose(run.reaction.values[-1], [2.0, 0.0], atol=1e-9)


@BOTH
def test_steady_acceleration_bends_the_slider_like_its_weight(scheme):
    """Root dragged with a steady acceleration A, upright: clamped-free under -rho S A per length, its tip lags by
    rho S A L^4 / 8 E I behind the root."""
    acceleration = 0.8
    rod = slider(0.0, damping=0.4, cutoff=None, elements=4)
    system = pair(
        lambda _: [st.ImposedVelocity(rod.root, acceleration * 0.6, history=st.Ramp(0.6))], 0.0, rod=rod, gap=1.0
    )
    probes = [st.Displacement(rod.tip, "x"), st.Displacement(rod.root, "x"), st.Reaction(rod, "x"), st.Reaction(rod)]
    run = st.simulate(system, 0.6, scheme=scheme, probes=probes, sample_rate=1e4)
    at = slice(-200, -50)
    tip, root = run.displacement.values[at].T
    line = STEEL.density * STRIP.area
    lag = line * acceleration * 0.5**4 / (8 * STEEL.young * STRIP.second_moment)
    # The low-pass adds to A t²/2 half of A times its second moment, 1e-10 s² or less at 10 kHz.
    np.testing.assert_allclose(root, acceleration * run.time.values[at] ** 2 / 2, atol=1e-10)
    np.testing.assert_allclose(tip - root, -lag, rtol=1e-5)
    force, moment = run.reaction.values[at].T
    np.testing.assert_allclose(force, line * 0.5 * acceleration, rtol=1e-5)
    # The inertia force acts at L/2 from the root, towards -x, which is -t1: M = P L / 2 with P = -rho S L A.
    np.testing.assert_allclose(moment, -line * acceleration * 0.5**2 / 2, rtol=1e-5)


@BOTH
def test_kinks_of_an_imposed_velocity_keep_its_momentum(scheme):
    """Brought to 0.6 m/s in 0.1 s and held, off every contact: M v is the impulse of the reaction, to round-off.

    The kinks stand a third and two thirds into a step; a rate sampled at the steps would miss 2e-5 of the impulse.
    """
    rod = slider(60.0, elements=1, cutoff=1.0)
    late = st.Sampled((0.02 + STEP / 3, 0.12 + 2 * STEP / 3), (0.0, 1.0))
    system = pair(lambda _: [st.ImposedVelocity(rod.root, 0.6, history=late)], 0.0, rod=rod, gap=1.0)
    run = st.simulate(system, 0.13, scheme=scheme, step=STEP, sample_rate=1 / STEP, probes=[st.Reaction(rod, "x")])
    assert float(run.reaction.sum()) * STEP == pytest.approx(rod.total_mass * 0.6, rel=1e-9)


def test_a_reaction_needs_a_free_tip():
    rod = slider(30.0, tip_support="guided")
    system = pair(lambda _: [st.Force(rod.root, y=-1.0)], 0.5, rod=rod)
    with pytest.raises(ValueError, match=r"^tip_support must be free where a Reaction is recorded, got 'guided'"):
        st.simulate(system, 1e-3, probes=[st.Reaction(rod)])


@BOTH
def test_weight_of_the_slider_rests_on_the_contact(scheme):
    """Stuck under gravity: N = M g; the moment at the guided root is that of M g at half-length and N at the tip."""
    rod = slider(30.0, damping=0.5, cutoff=None, elements=4)
    system = pair(lambda _: [st.Gravity(9.81)], 5.0, rod=rod, bar=track(damping=0.5), gap=0.0, at=0.3)
    run = st.simulate(system, 1.0, scheme=scheme, probes=[st.Reaction(rod)], sample_rate=1e4)
    weight = rod.total_mass * 9.81
    assert run.normal_force.values[-1] == pytest.approx(weight, rel=1e-4)
    # Across the axis: N at the tip -weight sin a over L, the weight +weight sin a over L/2.
    assert run.reaction.values[-1, 0] == pytest.approx(-weight * sin(rod.angle) * 0.5 / 2, rel=1e-4)


def impact(scheme, courant):
    """The elastic bar of the verification dropped on a wall: a track a million million times heavier."""
    bar = WALL.body("lumped")
    wall = st.ModalBeam(st.Material(1.0, 1e18), st.Section(1.0, 1.0), 1.0, bending_modes=1, axial_modes=0)
    system = pair(lambda _: [st.InitialVelocity(bar, y=-VELOCITY)], 0.0, rod=bar, bar=wall, at=0.5, gap=GAP)
    step = WALL.step(courant)
    probes = [st.Velocity(bar.tip), st.Velocity(bar.root)]
    run = st.simulate(system, 1.2e-3, scheme=scheme, step=step, sample_rate=1 / step, probes=probes)
    return run, WALL.plateau(VELOCITY), WALL.crossing


@BOTH
def test_bar_hits_a_wall(scheme):
    """Force rho c S v = 1270.8 N during 2 L / c = 385.4 us from 5e-5 / 0.1 = 0.5 ms on; impulse 2 M v = 0.48984 N s.

    With lumped mass at Courant number 1 central differences carry the front without error. Just below 1 (the limit
    itself is refused) the plateau stays within 1 %. The exact scheme has no such luck: its elements disperse the front
    by themselves, with an overshoot of some 8 to 20 %, and the impulse, a balance of momentum, stays.
    """
    run, force, contact_time = impact(scheme, 0.9999)
    assert force == pytest.approx(1270.83, abs=0.005)
    assert contact_time == pytest.approx(3.854e-4, abs=5e-8)
    step = run.attrs["step"]
    pressing = run.time.values[run.normal_force.values > 0]
    assert pressing[0] == pytest.approx(5e-4, abs=2 * step)
    impulse = run.normal_force.values.sum() * step
    assert impulse == pytest.approx(0.489840, rel=1e-2 if scheme.name == "central difference" else 0.05)
    if scheme.name == "central difference":
        assert pressing[-1] == pytest.approx(8.854e-4, abs=3 * step)
        plateau = run.normal_force.values[(run.time.values > 5.1e-4) & (run.time.values < 8.7e-4)]
        np.testing.assert_allclose(plateau, force, rtol=1e-2)
        rebound = run.velocity.values[run.time.values > 9.2e-4][0]
        np.testing.assert_allclose(rebound, 0.1, rtol=0.1)


@pytest.mark.parametrize(("courant", "overshoot"), [(0.9, 0.026), (0.5, 0.079)])
def test_overshoot_of_the_bar_below_courant_one(courant, overshoot):
    """Central differences, lumped mass, 100 elements: peak 2.6 % above the plateau at 0.9, 7.9 % at 0.5 (printed)."""
    run, force, _ = impact(SCHEMES[0], courant)
    assert float(run.normal_force.max()) / force - 1 == pytest.approx(overshoot, abs=0.005)
