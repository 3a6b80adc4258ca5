"""Meshed discs that turn under a face: against bodies of revolution, and point by point."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

import stridula as st

STEEL, LINING = st.Material(2.1e11, 7800.0, 0.3), st.Material(5e9, 2500.0, 0.3)
INNER, OUTER, THICK = 0.05, 0.15, 0.01
AROUND, CUTOFF, DAMPING = 24, 3e3, 1e-3
AXIS, ORIGIN = (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)


@cache
def meshed():
    mesh = st.SolidMesh.sector((INNER, OUTER), (0.0, 2.0 * math.pi), THICK, (4, AROUND, 1))
    return st.SolidBody(
        mesh, STEEL, fixed=["inner"], cutoff=CUTOFF, damping=DAMPING, contact_faces={"top": "integration"}, name="disc"
    )


def revolved(turning):
    profile = st.RectangleProfile({"disc": ((INNER, OUTER), (0.0, THICK))})
    return st.AxisymmetricBody(
        profile, STEEL, CUTOFF, "inner", damping=DAMPING, axis=AXIS, origin=ORIGIN, turning=turning, name="disc"
    )


def braked(track, angle=0.0, friction=0.3, **words):
    """Return a pad pressed on a disc, at an angle about its axis."""
    mesh = (
        st.SolidMesh.block((0.03, 0.015, 0.02), (2, 1, 2))
        .moved((0.095, THICK, -0.01))
        .moved(rotation=(0.0, angle, 0.0))
    )
    pad = st.SolidBody(
        mesh, LINING, fixed={"top": "xz"}, cutoff=2e4, damping=1e-3, contact_faces=["bottom"], name="pad"
    )
    face = st.SurfaceContact(
        pad, "bottom", track, "top" if track.kind == "solid" else "", st.Coulomb(friction), stiffness=5e11, **words
    )
    return st.System(face, [st.Force(pad.at("top"), y=-200.0)])


def taken_by_friction(theory):
    """Return the mean frequency [Hz] and the decay by friction [1/s] of each group of modes of the disc.

    A body of revolution couples the modes of a pair, which changes their rates but not the sum of them.
    """
    rates = rates_of(theory)
    frequency = rates.imag / (2.0 * np.pi)
    own = -rates.real - rates.imag * DAMPING
    # Orders 0 and 1, then 2 and 3.
    groups = (slice(0, 3), slice(3, 5), slice(5, 7))
    return np.array([(frequency[one].mean(), own[one].sum()) for one in groups]).T


def test_friction_takes_as_much_from_a_meshed_disc_as_from_a_body_of_revolution():
    speed = 5.0
    ours = taken_by_friction(st.sliding_stability(braked(meshed(), turning=(AXIS, ORIGIN, speed))))
    theirs = taken_by_friction(st.sliding_stability(braked(revolved(speed))))
    # Frequencies of so coarse a mesh are 3 to 4 % too high.
    np.testing.assert_allclose(ours[0], theirs[0], rtol=0.04)
    np.testing.assert_allclose(ours[1], theirs[1], rtol=0.12)
    across = taken_by_friction(st.sliding_stability(braked(meshed(), tangent=(1.0, 0.0, 0.0)), velocity=0.55))
    assert np.abs(across[1] / theirs[1] - 1.0).max() > 0.5


def rates_of(theory):
    """Return the exponents of the modes of the disc.

    Those of the pad on its lining, which friction damps by up to 1e9 1/s, are known to fewer digits.
    """
    frequency, growth = theory["frequency"].values, theory["growth_rate"].values
    vibrates = (frequency > 1.0) & (frequency < CUTOFF)
    assert vibrates.sum() > 5
    return growth[vibrates] + 2j * np.pi * frequency[vibrates]


@pytest.mark.parametrize("turns", [1, 7, 12])
def test_a_pad_turned_with_the_elements_of_the_disc_is_the_same(turns):
    plain, turned = (
        st.sliding_stability(braked(meshed(), angle=angle, turning=(AXIS, ORIGIN, 3.0)))
        for angle in (0.0, 2.0 * math.pi * turns / 24)
    )
    np.testing.assert_allclose(rates_of(turned), rates_of(plain), rtol=1e-6)


def test_the_sense_of_turning_matters_as_the_mirrored_pad():
    speeds = [st.sliding_stability(braked(meshed(), turning=(AXIS, ORIGIN, one))) for one in (3.0, -3.0)]
    # The pad is symmetric about the plane of x and y, as is the disc.
    np.testing.assert_allclose(*map(rates_of, speeds), rtol=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_points_slide_at_the_speed_of_the_material_under_them(seed):
    dice = np.random.default_rng(seed)
    speed = dice.choice([-1.0, 1.0]) * dice.uniform(30.0, 60.0)
    origin = (*dice.uniform(-0.02, 0.02, 2), 0.01)
    system = braked(meshed(), turning=((0.0, dice.uniform(0.5, 2.0), 0.0), origin, speed))
    run = st.simulate(system, 1e-3, surface_rate="all")
    places = np.array([one.tip.place for one in system.contacts]) - origin
    velocity = speed * np.cross((0.0, 1.0, 0.0), places)
    sizes = np.linalg.norm(velocity, axis=1)
    tangents = np.array([one.frame[1] for one in system.contacts])
    np.testing.assert_allclose(tangents * sizes[:, None], velocity, rtol=1e-9, atol=1e-12)
    # The pad moves little in comparison, and friction has the direction of the material.
    first = run["slip_velocity"].values[..., 0].mean(axis=0)
    np.testing.assert_allclose(np.abs(first), sizes, rtol=0.1)
    friction, normal = run["tangential_force"].values[-1], run["normal_force"].values[-1]
    closed = normal > 1e-3
    assert closed.any()
    # Means over a sample in which the direction of the slip hardly changes.
    np.testing.assert_allclose(np.linalg.norm(friction[closed], axis=1), 0.3 * normal[closed], rtol=1e-3)
    # The pad holds the disc back.
    assert (friction[closed, 0] < 0.0).all()
    assert "turning meshes whose waves are not carried round: " in run.attrs["notes"]


def test_a_mode_decays_in_time_as_in_theory():
    system = braked(meshed(), turning=(AXIS, ORIGIN, 5.0))
    theory = st.sliding_stability(system)
    vibrating = np.flatnonzero(theory["frequency"].values > 1.0)
    mode = int(vibrating[theory["growth_rate"].values[vibrating].argmin()])
    growth, frequency = float(theory["growth_rate"][mode]), float(theory["frequency"][mode])
    drives = [*system.drives, st.InitialEquilibrium(mode=mode, amplitude=1e-9)]
    cycles = max(2, round(frequency / abs(growth) / 2.0))
    probe = st.Velocity(system.track.at((0.11, THICK, 0.0)), "y")
    run = st.simulate(st.System(system.contact, drives), 2.0 * cycles / frequency, probes=[probe], sample_rate=1e5)
    signal = run["velocity"].values[:, 0]
    first, second = np.array_split(signal[: signal.size // 2 * 2], 2)
    measured = math.log(np.std(second) / np.std(first)) / (first.size * run.attrs["sample_interval"])
    assert measured == pytest.approx(growth, rel=0.02)


def test_a_mesh_without_a_direction_of_sliding_is_refused():
    system = braked(meshed())
    message = r"^velocity must be left out for surface, .*; give its .* turning=\(axis, origin, speed\), or a tangent$"
    with pytest.raises(ValueError, match=message):
        st.sliding_stability(system, velocity=1.0)
    started = st.System(system.contact, [*system.drives, st.InitialEquilibrium(velocity=1.0)])
    with pytest.raises(ValueError, match=message):
        st.simulate(started, 1e-4)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"turning": 3.0}, "^turning must be an axis, an origin and a speed, got 3.0"),
        ({"turning": (AXIS, ORIGIN, 0.0)}, r"^turning\[2\] must not be 0"),
        ({"turning": ((0.0, 0.0, 0.0), ORIGIN, 1.0)}, r"^turning\[0\] must be a direction"),
        ({"turning": (AXIS, (0.0, 0.0), 1.0)}, r"^turning\[1\] must be three numbers"),
        ({"turning": ((1.0, 0.0, 0.0), (0.0, 0.0, 0.5), 1.0)}, "^turning must move the track along its surface"),
        ({"turning": (AXIS, ORIGIN, 1.0), "tangent": (1.0, 0.0, 0.0)}, "^tangent must be left out with turning"),
    ],
)
def test_turnings_out_of_range_are_refused(words, message):
    with pytest.raises(ValueError, match=message):
        braked(meshed(), **words)


def test_tracks_that_turn_themselves_take_no_turning():
    with pytest.raises(ValueError, match=r"^turning must be left out except on a SolidBody: .*"):
        braked(revolved(1.0), turning=(AXIS, ORIGIN, 1.0))
